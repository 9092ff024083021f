"""heyoka is an extra: without it all is there but the solver `taylor`, which says how to install it."""

from __future__ import annotations

from pathlib import Path

from builders.lacking import lacking
from builders.processes import on_one_core

from taylor_verify.solvers.taylor.package import INSTALL
from taylor_verify_reports.studies.registry import STUDIES

HEYOKA = ("heyoka",)
# The environments of the other libraries have none of this package; `__main__` is a run.
EVERY_MODULE = """
import importlib, pkgutil, types, taylor_verify
names = [m.name for m in pkgutil.walk_packages(taylor_verify.__path__, "taylor_verify.")]
names = [n for n in names if ".outside" not in n and not n.endswith("__main__")]
assert "taylor_verify.solvers.taylor.plain" in names
for name in names:
    importlib.import_module(name)
calls = [n for n in taylor_verify.__all__ if n[0].islower()]
print(*(n for n in calls if type(getattr(taylor_verify, n)) is not types.FunctionType))
"""
STILL = """
import taylor_verify
from taylor_verify import check, exact, explain, load, run, run_many, solve
SCENE = load("euler/spherical")
def still(problem):
    return [problem.given.initial.omega] * len(problem.times)
"""
USES = {
    "load and exact": STILL + "assert exact(SCENE, [0, '1/2'], 20)['omega'].shape == (2, 3)",
    "check of a callable": STILL + "assert check(SCENE, still)",
    "check of a file": STILL
    + """
with open("mine.csv", "w") as file:
    print("t,w1,w2,w3", file=file)
    for t in SCENE.clock.instants:
        print(*map(float, (t, *SCENE.initial.omega)), sep=",", file=file)
assert check(SCENE, "mine.csv")
""",
    "another solver": STILL
    + """
assert run("euler/rest", "geometric:splitting?step=1/4").record is not None
assert run("euler/rest", "scipy:DOP853").record is not None
import pathlib, shlex, sys
rk4 = pathlib.Path(taylor_verify.__file__).parent / "solvers" / "outside" / "rk4.py"
assert run("euler/spherical", f"process:{shlex.join([sys.executable, str(rk4), 'step=0.05'])}")
""",
    "runs that are unavailable": STILL
    + f"""
lack = {INSTALL!r}
assert lack in solve(SCENE).detail
for found in [run(SCENE), *run_many(["euler/rest", "euler/spherical"], rungs=["f64"])]:
    assert [v.verdict.value for v in found.verdicts] == ["unavailable"]
    assert lack in found.verdicts[0].because
    assert not found
""",
    "explain": STILL
    + """
document = explain("kirchhoff/constant-loads")
assert document["equations"] and document["truth_digits"] and document["cost"]["steps"] is None
assert {gate["verdict"] for gate in document["gates"]} == {"pass"}
""",
    "a trade-off": f"""
from taylor_verify import tradeoff
from taylor_verify.numbers.precision import rung
from taylor_verify.tradeoff.setting import setting
names = ["taylor", "geometric:splitting?step=1/4"]
found = tradeoff("euler/spherical", [setting(n, rung("f64")) for n in names], repeats=1)
absent, present = found.document()["points"]
assert (absent["standing"], present["standing"]) == ("not run", "sound")
assert {INSTALL!r} in absent["because"]
""",
    "the ledger": "from taylor_verify_reports import claims; assert claims('hydromechanics 49 (11)')",
}


# To start and to import takes longer than most of these uses: one process goes through all of them, each
# with names of its own, and says which ones end in an error.
IN_TURN = """
import traceback
for name, use in {uses!r}.items():
    try:
        exec(use, {{}})
    except Exception:
        print(name)
        traceback.print_exc()
"""


def test_every_module_loads_without_heyoka(tmp_path: Path) -> None:
    """No module needs heyoka to be imported, and none takes the name of a public function."""
    done = lacking(tmp_path, HEYOKA, "-c", EVERY_MODULE)
    assert (done.returncode, done.stdout.strip()) == (0, ""), done.stderr


def test_what_works_without_heyoka(tmp_path: Path) -> None:
    """Scenes, truths, checks, other solvers, a trade-off and the ledger work."""
    broken = {"broken on purpose": "import heyoka"}
    done = lacking(tmp_path, HEYOKA, "-c", IN_TURN.format(uses={**USES, **broken}))
    assert done.stdout.splitlines() == list(broken), done.stderr


def command(folder: Path, *words: str) -> tuple[int, str, str]:
    """The exit status of a verb without heyoka, and its two streams."""
    done = lacking(folder, HEYOKA, "-m", "taylor_verify", *words)
    return done.returncode, done.stdout, done.stderr


def test_run_names_the_command_that_installs_it(tmp_path: Path) -> None:
    """The exit status is 2, and one sentence says what is missing, however many scenes were asked for."""
    # On one core no pool is started for it.
    with on_one_core():
        status, out, err = command(tmp_path, "run", "euler/generic", "euler/rest", "--rung", "f64")
    assert status == 2
    (counts, why) = out.splitlines()
    assert counts.endswith(" unavailable: not judged (exit status 2)")
    assert why == f"nothing was judged: expected heyoka, got no such package: {INSTALL}"
    assert err.splitlines()[-1] == f"taylor-verify: {why}"


def test_a_broken_heyoka_is_told_from_a_missing_one(tmp_path: Path) -> None:
    """A broken heyoka is named with the reason, and the same command mends it."""
    (tmp_path / "heyoka.py").write_text("raise ImportError('no libLLVM')\n")
    done = lacking(tmp_path, (), "-m", "taylor_verify", "run", "euler/rest")
    assert done.returncode == 2
    expected = f"expected heyoka, got one that cannot be imported (no libLLVM): {INSTALL}"
    assert done.stdout.splitlines()[-1] == f"nothing was judged: {expected}"


def test_nothing_is_published_without_heyoka(tmp_path: Path) -> None:
    """Measurements stay as they are: for each of them exit status 2, one sentence, and no file."""
    measured = [study.name for study in STUDIES if study.needs_heyoka]
    assert len(measured) > 5
    script = (
        "from taylor_verify.cli import main\n"
        "from taylor_verify_reports.verbs import checkout\n"
        "checkout._checkout = lambda place: place\n"
        f"for name in {measured}:\n"
        "    print(main(['publish', name, '--from', 'reports']))"
    )
    done = lacking(tmp_path, HEYOKA, "-c", script)
    assert done.stdout.split() == ["2"] * len(measured)
    expected = f"expected heyoka, got no such package: {INSTALL}"
    assert done.stderr.splitlines() == [
        f"taylor-verify: {expected} @ publish {name}" for name in measured
    ]
    assert not (tmp_path / "reports").exists()


def test_no_library_of_a_solver_is_imported(tmp_path: Path) -> None:
    """heyoka, matplotlib and SciPy are there, and are not imported to check or to tell the truth."""
    slow = {"heyoka", "matplotlib", "scipy", "pyarrow", "sympy"}
    names = ("check of a file", "check of a callable", "load and exact")
    uses = IN_TURN.format(uses={name: USES[name] for name in names})
    done = lacking(
        tmp_path, (), "-c", f"{uses}\nimport sys\nprint(sorted({slow!r} & set(sys.modules)))"
    )
    assert (done.returncode, done.stdout) == (0, "[]\n"), done.stderr
