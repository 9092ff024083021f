"""Systems other than Unix: scenes, truths and checks work there; the rest is unavailable and says why."""

from __future__ import annotations

from pathlib import Path

import pytest
from builders.lacking import WITHOUT_UNIX, lacking
from builders.turns import by_turns

USES = {
    "load and exact": """
from taylor_verify import exact, load
assert exact(load("euler/generic"), [0, "1/2"], 20)["omega"].shape == (2, 3)
""",
    "check": """
from taylor_verify import check, load
scene = load("euler/spherical")
assert check(scene, lambda problem: [problem.given.initial.omega] * len(problem.times))
with open("mine.csv", "w") as file:
    print("t,w1,w2,w3", file=file)
    for t in scene.clock.instants:
        print(*map(float, (t, *scene.initial.omega)), sep=",", file=file)
assert check(scene, "mine.csv")
""",
    "explain": """
from taylor_verify import explain
found = explain("kirchhoff/constant-loads")
assert found["equations"] and found["truth_digits"]
assert {gate["verdict"] for gate in found["gates"]} == {"pass"}
""",
    "a solver in Python, and the reports of it": """
from taylor_verify.cli import main
call = ["run", "euler/rest", "--solver", "geometric:splitting?step=1/4", "--out", "out"]
assert main(call) == 0
from pathlib import Path
assert sorted(path.name for path in Path("out").iterdir()) == ["README.md", "data", "tables"]
assert main(["exact", "euler/generic", "--at", "1"]) == 0
assert main(["check", "--help"]) == 0
""",
}


def without_unix(folder: Path, use: str) -> None:
    """Run a script without heyoka and without what Unix alone has; it must succeed."""
    done = lacking(folder, ("heyoka",), "-c", WITHOUT_UNIX + use)
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("use", by_turns(USES.values(), 4), ids=USES)
def test_what_works_on_any_system(use: str, tmp_path: Path) -> None:
    """Scenes, truths, checks, explanations and solvers in Python need nothing that Unix alone has."""
    without_unix(tmp_path, use)


def test_the_rest_says_that_it_does_not_work_there(tmp_path: Path) -> None:
    """A program of a user and a library in its own environment are unavailable, and say why."""
    without_unix(
        tmp_path,
        """
from taylor_verify import run
for solver in ("process:./mine", "outside:cvode-bdf"):
    (verdict,) = run("euler/spherical", solver).verdicts
    assert verdict.verdict.value == "unavailable"
    assert "on Linux and macOS alone" in verdict.because
""",
    )


def test_what_is_missing_is_missing(tmp_path: Path) -> None:
    """The process above lacks them indeed: code that asks for one without care fails."""
    uses = ["import fcntl", "os.O_NONBLOCK", "signal.SIGKILL", "os.killpg"]
    done = lacking(
        tmp_path,
        (),
        "-c",
        f"""{WITHOUT_UNIX}
import os, signal
for use in {uses}:
    try:
        exec(use)
    except (ImportError, AttributeError):
        print(use)
""",
    )
    assert done.stdout.splitlines() == uses, done.stderr
