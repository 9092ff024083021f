"""The command line: verbs, JSON, exit statuses, and one clear message for whatever is wrong."""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import suppress
from itertools import product
from pathlib import Path
from typing import Any

import pytest
from builders.processes import PATIENCE, interruptible, is_alive, printed_by, wait_until
from builders.scenes import LISTED_INSTANTS, scene_file
from builders.turns import by_turns

from taylor_verify.batch.job import Job
from taylor_verify.cli import main
from taylor_verify.cli.arguments import OWN_VERBS
from taylor_verify.records.plugins import KINDS, plugins
from taylor_verify.records.precisions import LADDER
from taylor_verify.scenes import library
from taylor_verify.scenes.families.shipped import family_names
from taylor_verify.scenes.library import GUIDE
from taylor_verify.solvers import registry
from taylor_verify.solvers.files.formats.reading import FORMATS

ROOT = Path(__file__).resolve().parents[2]
REFUSED = sorted((library.cases_directory() / "refused").glob("*.toml"))
# Two instants that no double tells apart.
TOO_CLOSE = LISTED_INSTANTS.replace('["0.5", 1, 2]', '[1, "1.000000000000000000000001"]')

Captured = pytest.CaptureFixture[str]


@pytest.fixture
def short(tmp_path: Path) -> Path:
    """A scene file that is judged in a moment."""
    return scene_file(tmp_path, LISTED_INSTANTS)


def command(*arguments: str) -> list[str]:
    return [sys.executable, "-m", "taylor_verify", *arguments]


def environment(**changed: str) -> dict[str, str]:
    return {**os.environ, "PYTHONPATH": str(ROOT / "verify"), **changed}


# What is asked without a scene.


def test_list_names_what_there_is(capsys: Captured) -> None:
    """The shipped scenes, the solvers and the rungs, as JSON and as text."""
    assert main(["list", "--json"]) == 0
    document = json.loads(capsys.readouterr().out)
    assert document == {
        "scenes": list(library.names()),
        "extremes": list(library.names(library.EXTREMES, library.WORST)),
        "engines": list(library.names(library.ENGINES)),
        "families": list(family_names()),
        "solvers": list(registry.solver_names()),
        "rungs": list(LADDER),
        "guide": dict(GUIDE),
        "formats": list(FORMATS),
        "plugins": {kind: {p.name: p.package for p in plugins(kind)} for kind in KINDS},
    }
    assert main(["list"]) == 0
    text = capsys.readouterr().out
    brought = document.pop("plugins").values()
    assert all(name in text for names in [*document.values(), *brought] for name in names)


def test_the_guide_is_short_and_names_scenes_that_are_there(capsys: Captured) -> None:
    """`list` begins with at most ten lines on which scene tells what, each shipped."""
    assert len(GUIDE) <= 10
    assert all(
        set(library.named(name))
        <= {
            *library.names(),
            *library.named(library.EXTREMES),
        }
        for name in GUIDE
    )
    assert main(["list"]) == 0
    first, *rest = capsys.readouterr().out.splitlines()
    assert first == "which scene tells what"
    for line, (name, purpose) in zip(rest, GUIDE.items(), strict=False):
        assert line.split(maxsplit=1) == [name, purpose]


def test_help_imports_nothing_heavy() -> None:
    """`--help` answers before numpy, mpmath, heyoka or rich are imported."""
    script = (
        "import sys\nfrom taylor_verify.cli import main\n"
        "try: main(['run', '--help'])\nexcept SystemExit: pass\n"
        "print(sorted({'numpy', 'mpmath', 'heyoka', 'rich', 'flint', 'multiprocessing'}"
        " & set(sys.modules)))"
    )
    assert printed_by(script).splitlines()[-1] == "[]"


# run


@pytest.mark.parametrize(
    "arguments",
    [
        ["{scene}", "--rung", "f32", "f64"],
        ["--rung", "f32", "f64", "{scene}"],
        ["--rung", "f32,f64", "{scene}"],
        ["--rung", "f32", "--rung", "f64", "--json", "{scene}"],
        ["--rung", "f32", "{scene}", "--rung=f64"],
        ["--json", "--rung", "f32", "f64", "f32", "--solver", "taylor", "{scene}"],
    ],
)
def test_rungs_and_scenes_stand_in_any_order(
    capsys: Captured, short: Path, arguments: list[str]
) -> None:
    """`--rung` takes the rungs that follow it and no scene; a rung named twice is run once."""
    words = [word.format(scene=short) for word in arguments if word != "--json"]
    assert main(["run", "--json", *words]) == 0
    rows = json.loads(capsys.readouterr().out)["verdicts"]
    assert {row["scene"] for row in rows} == {str(short)}
    assert [row["rung"] for row in rows if row["quantity"] == "omega"] == ["f32", "f64"]


def test_several_scenes_run_in_processes_and_come_in_the_order_asked(
    capsys: Captured, short: Path
) -> None:
    """A scene by name and by path is two scenes; a scene named twice is run once."""
    scenes = ["euler/separatrix", str(short), str(library.find("euler/separatrix"))]
    assert main(["run", scenes[0], "--json", *scenes[1:], scenes[0]]) == 0
    out, error = capsys.readouterr()
    rows = json.loads(out)["verdicts"]
    assert [row["scene"] for row in rows if row["quantity"] == "omega"] == scenes
    assert len(error.splitlines()) == len(scenes)
    numbers = [[row["max"] for row in rows if row["scene"] == scene] for scene in scenes]
    assert numbers[0] == numbers[2] != numbers[1]


def test_with_no_scene_the_standard_set_is_run_on_all_rungs(
    monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    """`run` alone asks for every shipped scene on f32 f64 f80 f128 mp237, a named one for f64."""
    asked: list[Any] = []

    def judge(jobs: list[Job], progress: object, *others: object) -> list[Any]:
        # No number of processes, no executor, nothing resumed, and no folder to write to.
        assert not any(others)
        (how,) = {(job.solver, job.rungs) for job in jobs}
        asked.append((tuple(job.name for job in jobs), *how))
        return []

    monkeypatch.setattr("taylor_verify.batch.judging.judge_all", judge)
    # Nothing is judged here, and that is no pass.
    assert main(["run", "--json"]) == 3
    assert main(["run", "--json", "euler/generic"]) == 3
    assert asked == [
        (library.names(), "taylor", LADDER),
        (("euler/generic",), "taylor", ("f64",)),
    ]
    assert sum(json.loads(capsys.readouterr().out.split("}\n{")[0] + "}")["summary"].values()) == 0


def test_a_scene_that_a_rung_cannot_hold_is_refused_there_and_shown(
    capsys: Captured, tmp_path: Path
) -> None:
    """The rung's verdict is `refused` with its reason and no numbers; other rungs still pass."""
    file = tmp_path / "close.toml"
    file.write_text(TOO_CLOSE)
    assert main(["run", str(file), "--rung", "f64", "f128"]) == 3
    text = capsys.readouterr().out
    assert "refused" in text
    assert "two sample times" in text
    assert "3 pass, 1 refused" in text
    assert main(["explain", str(file)]) == 0
    assert "two sample times" in capsys.readouterr().out


def test_a_library_that_writes_on_stdout_does_not_spoil_the_document(
    monkeypatch: pytest.MonkeyPatch, capfd: Captured
) -> None:
    """Text that is printed during the work, by Python or below it, goes to stderr."""

    def noisy(*_: Any) -> list[Any]:
        os.write(1, b"noise from below\n")
        print("noise from Python")
        return []

    monkeypatch.setattr("taylor_verify.batch.judging.judge_all", noisy)
    assert main(["run", "euler/generic", "--json"]) == 3
    out, error = capfd.readouterr()
    assert set(json.loads(out)) == {"verdicts", "summary", "sha256"}
    assert "noise from below" in error
    assert "noise from Python" in error


# --out and publish


def test_out_makes_the_folder_and_publish_rebuilds_its_tables(
    capsys: Captured, short: Path, tmp_path: Path
) -> None:
    """`run --out` leaves data and tables in a new folder; `publish` makes the same tables."""
    folder = tmp_path / "new" / "nested"
    assert main(["run", str(short), "--out", str(folder), "--json"]) == 0
    out, error = capsys.readouterr()
    assert json.loads(out)["summary"]["pass"] == 3
    assert str(folder) in error
    made = [folder / "README.md", *(folder / "tables").iterdir()]
    tables = {file: file.read_bytes() for file in made}
    assert len(tables) > 1
    assert (folder / "data" / "verdicts.json").is_file()
    for file in tables:
        file.unlink()
    assert main(["publish", "--from", str(folder), "--json"]) == 0
    written = json.loads(capsys.readouterr().out)["written"]
    assert {Path(file) for file in written} == set(tables)
    assert all(file.read_bytes() == text for file, text in tables.items())


@pytest.mark.parametrize("place", ["a-file", "a-file/below", ""])
def test_a_folder_that_cannot_be_written_is_refused_before_the_work(
    monkeypatch: pytest.MonkeyPatch, capsys: Captured, tmp_path: Path, place: str
) -> None:
    """Exit 2 with one line that names --out; no run is started, nothing is made."""
    (tmp_path / "a-file").write_text("mine")
    monkeypatch.setattr(
        "taylor_verify.batch.judging.judge_all", lambda *_: pytest.fail("the work was begun")
    )
    folder = str(tmp_path / place) if place else ""
    assert main(["run", "euler/generic", "--out", folder]) == 2
    out, error = capsys.readouterr()
    assert out == ""
    assert error.count("\n") == 1
    assert "--out" in error
    assert [file.name for file in tmp_path.iterdir()] == ["a-file"]
    assert (tmp_path / "a-file").read_text() == "mine"


def test_reports_that_fail_at_the_end_cost_no_results(
    monkeypatch: pytest.MonkeyPatch, capsys: Captured, short: Path, tmp_path: Path
) -> None:
    """A disk that is full after the run ends with status 2 and a message, and shows the table."""

    def full(*_: Any) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("taylor_verify.records.store.write", full)
    assert main(["run", str(short), "--out", str(tmp_path / "out")]) == 2
    out, error = capsys.readouterr()
    assert "3 pass" in out
    assert "No space left" in error
    assert not (tmp_path / "out").exists()


# explain


@pytest.mark.parametrize("scene", ["euler/generic", "kirchhoff/planar-swing", "euler/separatrix"])
def test_explain_shows_the_equations_the_orbit_and_every_gate(capsys: Captured, scene: str) -> None:
    """The text and the document tell the same; each bound comes with its reason."""
    assert main(["explain", scene, "--json"]) == 0
    document = json.loads(capsys.readouterr().out)
    assert main(["explain", scene]) == 0
    text = capsys.readouterr().out
    assert all(line in text for line in document["equations"])
    assert document["regime"] in text
    for gate in document["gates"]:
        assert gate["max"] <= gate["bound"]
        assert gate["because"].split(";")[-1].strip() in text
    assert {gate["verdict"] for gate in document["gates"]} == {"pass"}
    cost = document["cost"]
    assert cost["states"] == len(document["equations"])
    assert cost["evaluations"] >= cost["steps"] > 0


# What is wrong.


@pytest.mark.parametrize(
    ("verb", "file"),
    by_turns(product(("run", "exact --at 1", "explain"), REFUSED), 3, lambda verb, file: verb),
    ids=lambda case: getattr(case, "stem", None),
)
def test_a_scene_that_is_refused_ends_with_2_and_a_message(
    capsys: Captured, verb: str, file: Path
) -> None:
    """Every fault is named on stderr, and in the document of --json."""
    verb, *options = verb.split()
    assert main([verb, str(file), *options, "--json"]) == 2
    out, error = capsys.readouterr()
    document = json.loads(out)
    assert error == f"taylor-verify: {document['error']}\n"
    assert document["error"].splitlines() == document["faults"]
    assert all(fault.startswith("expected ") for fault in document["faults"])


@pytest.mark.parametrize(
    "words",
    [
        *(
            f"{verb} nono"
            for verb in OWN_VERBS
            if verb not in ("list", "check", "certify", "scene")
        ),
        "check nono.csv --scene nono",
        "certify nono.csv --scene nono",
        "scene from nono.urdf",
        "list --nono",
        "run euler/rest --rung",
        "runs euler/rest",
        "claims nono",
        "publish nono",
        "",
    ],
)
def test_a_call_that_is_wrong_prints_one_document(
    words: str, capsys: Captured, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """All verbs print the sentences of stderr with --json, also where the options cannot be read."""
    monkeypatch.chdir(tmp_path)
    try:
        status = main([*words.split(), "--json"])
    except SystemExit as end:
        status = end.code
    assert status == 2
    out, error = capsys.readouterr()
    document = json.loads(out)
    assert document.keys() == {"error", "faults"}
    assert document["faults"]
    assert document["error"] == "\n".join(document["faults"])
    assert error.endswith(f": {document['error']}\n")


@pytest.mark.parametrize(
    "arguments",
    [
        ["run", "euler/generic", "--rung", "f65"],
        ["run", "--rung", "f64x", "euler/generic"],
        ["run", "euler/generic", "--solver", "tailor"],
        ["run", "x" * 5000],
        ["run", ""],
        ["run", "."],
        ["explain", "euler/generic", "--rung", "mp3"],
        ["exact", "euler/generic"],
    ],
)
def test_a_name_that_means_nothing_is_a_wrong_call(capsys: Captured, arguments: list[str]) -> None:
    """Exit 2, one line, nothing on stdout."""
    assert main(arguments) == 2
    out, error = capsys.readouterr()
    assert out == ""
    assert error.startswith("taylor-verify: expected ")
    assert error.count("\n") == 1


@pytest.mark.parametrize(
    ("arguments", "faults"),
    [
        ("run nono --tolerance -1 --rung f99,g1 --solver x --jobs 0", 6),
        ("check no.csv --scene nono --tolerance -1 --rung f99", 4),
        ("check no.csv --scene nono --steps 0.1", 3),
        ("exact nono --at x,1,y --digits 0", 4),
        ("explain nono --rung f99", 2),
        ("question nono --rung f99 --csv --json", 3),
        ("certify no.json --scene nono --tolerance 5", 2),
        ("sweep satellites --tolerance x --rung f99", 2),
        ("tradeoff nono --repeats 0 --target -1 --rung f99", 4),
        ("draw nono no.csv --rung f99 --out x.foo", 4),
    ],
)
def test_all_wrong_arguments_of_a_call_are_reported_at_once(
    capsys: Captured, arguments: str, faults: int
) -> None:
    """Each wrong option, scene and file has its line in the one message of a call."""
    assert main(arguments.split()) == 2
    lines = capsys.readouterr().err.splitlines()
    assert sum(", got " in line for line in lines) == faults


def test_an_error_nobody_foresaw_is_one_line_with_its_place(
    monkeypatch: pytest.MonkeyPatch, capsys: Captured, short: Path
) -> None:
    """It names the scene, the rung, the error and the file it rose in."""
    monkeypatch.setattr("taylor_verify.solvers.solver.pose", lambda *_: 1 // 0)
    assert main(["run", str(short)]) == 2
    error = capsys.readouterr().err
    assert error.count("\n") == 1
    for part in (str(short), "f64", "ZeroDivisionError", "solver.py:"):
        assert part in error


# Pipes, signals and lost workers.


def test_a_reader_that_goes_away_is_no_error() -> None:
    """`| head -1` ends without a word on stderr and with the status of the run."""
    for arguments in (["list"], ["--help"]):
        with subprocess.Popen(
            command(*arguments),
            env=environment(),
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
        ) as process:
            process.stdout.close()
            assert process.stderr.read() == b""
            assert process.wait(timeout=PATIENCE) == 0


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no /dev/full on this system")
@pytest.mark.parametrize("words", [["list", "--json"], ["--help"], ["--version"]])
def test_a_full_disk_under_stdout_is_one_message(words: list[str]) -> None:
    """Exit 2 and the system's reason."""
    with open("/dev/full", "w") as full:
        done = subprocess.run(
            command(*words), env=environment(), stdout=full, stderr=subprocess.PIPE
        )
    assert done.returncode == 2
    assert done.stderr.count(b"\n") == 1
    assert b"No space left on device' @ stdout\n" in done.stderr


def children(pid: int) -> list[int]:
    """The worker processes of a process, by Linux's own account."""
    workers = []
    for status in Path("/proc").glob("[0-9]*/stat"):
        try:
            parent = int(status.read_text().rpartition(")")[2].split()[1])
            words = (status.parent / "cmdline").read_bytes()
        except OSError:
            continue
        if parent == pid and b"spawn_main" in words:
            workers.append(int(status.parent.name))
    return workers


@pytest.fixture
def working(tmp_path: Path) -> Iterator[subprocess.Popen[str]]:
    """A run in two worker processes that would take many seconds, and its process group."""
    scenes = ["kirchhoff/whole-motion", "kirchhoff/general-body"]
    with interruptible():
        process = subprocess.Popen(
            command("run", *scenes, "--rung", "mp1000", "--json", "--out", str(tmp_path / "out")),
            env=environment(),
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            start_new_session=True,
        )
    with process:
        wait_until(lambda: len(children(process.pid)) == 2)
        yield process
        process.kill()


needs_processes = pytest.mark.skipif(
    not Path("/proc/self/stat").exists() or len(os.sched_getaffinity(0)) < 2,
    reason="needs two cores and Linux's list of processes",
)


@needs_processes
@pytest.mark.parametrize("after", [0.0, pytest.param(0.2, marks=pytest.mark.slow), 1.5])
def test_an_interrupt_ends_run_and_workers_with_one_line(
    working: subprocess.Popen[str], tmp_path: Path, after: float
) -> None:
    """Ctrl-C goes to the whole group; status 130, no traceback, no report, no process left.

    A second one changes nothing.
    """
    time.sleep(after)
    workers = children(working.pid)
    os.killpg(working.pid, signal.SIGINT)
    time.sleep(after / 20)
    with suppress(ProcessLookupError):
        os.killpg(working.pid, signal.SIGINT)
    # A run that did not hear it would end with 0.
    out, error = working.communicate(timeout=PATIENCE)
    assert working.returncode == 130
    assert out == ""
    assert re.fullmatch(r"taylor-verify: interrupted(: \d+ of \d+ scenes .* --resume .*)?\n", error)
    assert not (tmp_path / "out").exists()
    assert not any(is_alive(worker) for worker in workers)


@needs_processes
def test_workers_do_not_outlive_a_run_that_is_killed(working: subprocess.Popen[str]) -> None:
    """After kill -9 of the run its workers are gone, in the middle of work of a minute."""
    workers = children(working.pid)
    time.sleep(1.0)
    working.kill()
    wait_until(lambda: not any(map(is_alive, workers)), seconds=30)
