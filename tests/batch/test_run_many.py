"""`run_many`: any executor gives the verdicts of `run`; its result is a sequence that can be asked."""

from __future__ import annotations

import json
import threading
import time
from collections.abc import Callable
from concurrent.futures import (
    BrokenExecutor,
    Executor,
    Future,
    ProcessPoolExecutor,
    ThreadPoolExecutor,
)
from dataclasses import replace
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import pytest
from builders.processes import PATIENCE, Backwards
from builders.scenes import THREE_INSTANTS

import taylor_verify
from taylor_verify.batch.chosen_scenes import Selection, select
from taylor_verify.batch.failure import Failed
from taylor_verify.batch.job import Job
from taylor_verify.batch.judgements import Judgements
from taylor_verify.batch.judging import Interrupted
from taylor_verify.batch.work import run_all
from taylor_verify.chain import judge_scene
from taylor_verify.cli import main
from taylor_verify.judge.judgement import Judgement
from taylor_verify.records.faults import Refused
from taylor_verify.records.passing import NotPassed
from taylor_verify.records.precisions import LADDER
from taylor_verify.records.status import Status
from taylor_verify.scenes import library
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene

SCENES = ["euler/rest", "kirchhoff/whole-motion", "euler/generic"]
RUNGS = ["f32", "mp120"]


def numbers(judgements: Any) -> list[Any]:
    return [
        (v.scene, v.rung, v.quantity, v.verdict, v.max, v.bound)
        for judgement in judgements
        for v in judgement.verdicts
    ]


@pytest.fixture(scope="module")
def alone() -> list[Judgement]:
    """Every run by itself, one after the other."""
    return [taylor_verify.run(scene, "taylor", rung) for scene in SCENES for rung in RUNGS]


@pytest.fixture(scope="module")
def results(alone: list[Judgement]) -> Judgements:
    """Return the judgements as one result."""
    return Judgements(tuple(alone), select(SCENES, RUNGS), "taylor")


# Executors.


@pytest.mark.parametrize(
    "executor",
    [
        lambda: ThreadPoolExecutor(3),
        lambda: Backwards(len(SCENES)),
    ],
    ids=["threads", "backwards"],
)
def test_any_executor_gives_the_verdicts_of_run(executor: Any, alone: list[Judgement]) -> None:
    """Equal to the last bit, in the order asked for: threads do not share a precision."""
    progress: list[tuple[int, int, str]] = []
    with executor() as given:
        judgements = taylor_verify.run_many(
            SCENES,
            rungs=RUNGS,
            executor=given,
            progress=lambda finished, total, job: progress.append((finished, total, str(job))),
        )
    assert numbers(judgements) == numbers(alone)
    assert progress[0] == (0, 3, "None")
    assert [k for k, *_ in progress] == [0, 1, 2, 3]
    assert {name for *_, name in progress[1:]} == {f"{scene} on f32 mp120" for scene in SCENES}


def test_an_interrupted_run_with_an_executor_goes_on_where_it_was(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, alone: list[Judgement]
) -> None:
    """The caller stores each run that ended before an interrupt, and does not run it again."""
    monkeypatch.setattr(
        "taylor_verify.batch.finished_jobs.user_cache_path", lambda name: tmp_path / name
    )

    def interrupt(finished: int, total: int, job: Job | None) -> None:
        if finished == 2:
            raise KeyboardInterrupt

    asked: dict[str, Any] = {"scenes": SCENES, "rungs": RUNGS}
    with ThreadPoolExecutor(1) as executor:
        with pytest.raises(Interrupted) as interrupted:
            taylor_verify.run_many(**asked, executor=executor, progress=interrupt)
        assert (interrupted.value.finished, interrupted.value.jobs) == (2, 3)
        progress: list[int] = []
        submitted: list[Any] = []
        submit = executor.submit
        monkeypatch.setattr(
            executor, "submit", lambda *call: submitted.append(call) or submit(*call)
        )
        judgements = taylor_verify.run_many(
            **asked, executor=executor, resume=True, progress=lambda k, *_: progress.append(k)
        )
    assert numbers(judgements) == numbers(alone)
    assert progress == [0, 1, 2, 3]
    assert len(submitted) == 1
    assert [file for file in tmp_path.rglob("*") if file.is_file()] == []


def test_a_scene_that_breaks_the_code_stops_no_other(
    alone: list[Judgement], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its row is undecided and says what broke; the others are judged. A machine's fault ends the run."""
    error: list[Exception] = [ArithmeticError("on purpose")]

    def broken(scene: Scene, *asked: Any) -> Judgement:
        if scene.name == SCENES[1]:
            raise error[0]
        return judge_scene(scene, *asked)

    monkeypatch.setattr("taylor_verify.chain.judge_scene", broken)
    with ThreadPoolExecutor(1) as executor:
        results = taylor_verify.run_many(SCENES, rungs=RUNGS, executor=executor)
        assert numbers(results[:2] + results[4:]) == numbers(alone[:2] + alone[4:])
        for judged in results[2:4]:
            (row,) = judged.verdicts
            assert row.verdict is Status.UNDECIDED
            assert "ArithmeticError: on purpose" in row.because
        assert results.exit_status == 3
        error[0] = MemoryError()
        with pytest.raises(Failed, match="expected more memory"):
            taylor_verify.run_many(SCENES, rungs=RUNGS, executor=executor)


@pytest.mark.parametrize(
    ("wrong", "sentence"),
    [
        ({"jobs": "2"}, "expected jobs of at least 1, got '2' @ jobs"),
        ({"jobs": 0}, "expected jobs of at least 1, got 0 @ jobs"),
        ({"jobs": True}, "expected jobs of at least 1, got True @ jobs"),
        ({"jobs": 2, "executor": Backwards(1)}, "got both @ jobs"),
        ({"scenes": Selection((), ("f64",)), "rungs": ["f64"]}, "got others besides @ rungs"),
        ({"jobs": 1.5}, "expected jobs of at least 1, got 1.5 @ jobs"),
        ({"executor": 3}, "expected an executor with a method submit, got 3 @ executor"),
        ({"out": 3}, "expected the path of a folder, got 3 @ out"),
        ({"progress": 3}, r"expected a function \(finished, total, job\), got 3 @ progress"),
        ({"resume": "yes"}, "expected True or False, got 'yes' @ resume"),
        ({"solver": 3}, "expected a solver, the name of one or a callable, got 3 @ solver"),
        ({"rungs": 64}, "expected rungs or the name of one, got 64 @ rungs"),
        ({"scenes": 3}, "expected scenes or the name of one, got 3 @ scenes"),
        ({"scenes": b"euler/rest"}, "expected scenes or the name of one"),
        ({"out": 3, "resume": None}, "@ resume\nexpected the path of a folder"),
    ],
)
def test_an_argument_of_a_wrong_kind_is_refused(wrong: dict[str, Any], sentence: str) -> None:
    """All faults are named at once, in one sentence each, before anything runs."""
    with pytest.raises(ValueError, match=sentence):
        taylor_verify.run_many(**{"scenes": ["euler/rest"], **wrong})


def test_a_single_name_is_no_row_of_letters(tmp_path: Path) -> None:
    """A scene, a path, a Scene or a rung may stand for a list of one."""
    file = tmp_path / "made.toml"
    file.write_text(THREE_INSTANTS)
    for one, name in (
        ("euler/rest", "euler/rest"),
        (load("euler/rest"), "euler/rest"),
        (file, str(file)),
    ):
        selection = select(one, "f32")
        assert [scene.name for scene in selection.scenes] == [name]
        assert selection.rungs == ("f32",)
    assert len(select("extremes").scenes) > 10
    assert taylor_verify.run_many("euler/rest", rungs="f64").passed


# What is selected.


def test_no_scenes_are_the_standard_set() -> None:
    """Its rungs are the whole ladder, those of named scenes f64, unless others are asked for."""
    assert [scene.name for scene in select().scenes] == list(library.names())
    assert select().rungs == LADDER
    assert select(["euler/rest"]).rungs == ("f64",)
    assert select(None, ["f32"]).rungs == ("f32",)
    assert select([]).scenes == ()
    assert select().has("euler/gone", "f64")
    assert not select(["euler/rest"]).has("euler/gone", "f64")


def test_every_fault_of_every_scene_is_told(tmp_path: Path) -> None:
    """The faults of two scenes are told together, each below the name of its scene."""
    file = tmp_path / "bad.toml"
    file.write_text(THREE_INSTANTS.replace("omega", "omgea"))
    with pytest.raises(Refused) as refused:
        taylor_verify.run_many(["euler/rest", file, "euler/none"])
    text = str(refused.value)
    assert f"{file} is refused:\n" in text
    assert "euler/none is refused:\n" in text
    assert "euler/rest is refused" not in text


# The result.


def marred(results: Judgements, status: Status) -> Judgements:
    """Return the result with one verdict changed."""
    first, *others = results.judgements
    start, *rest = first.verdicts
    changed = replace(first, verdicts=(replace(start, verdict=status), *rest))
    return replace(results, judgements=(changed, *others))


@pytest.mark.parametrize(
    ("status", "exit_status"),
    [
        (Status.PASS, 0),
        (Status.FAIL, 1),
        (Status.UNDECIDED, 3),
        (Status.VACUOUS, 3),
        (Status.REFUSED, 3),
        (Status.UNAVAILABLE, 0),
    ],
)
def test_its_truth_value_is_whether_it_passed(
    results: Judgements, status: Status, exit_status: int
) -> None:
    """A single verdict among passes decides, as in the command; a failure is raised with its row."""
    judgements = marred(results, status)
    assert judgements.exit_status == exit_status
    assert judgements.passed is bool(judgements) is (exit_status == 0)
    if exit_status:
        with pytest.raises(NotPassed, match=rf"\n{status}  euler/rest f32 .*: "):
            judgements.raise_for_failure()
    else:
        judgements.raise_for_failure()
    assert judgements.summary[status.value] >= 1


def test_the_command_prints_its_document(
    capsys: pytest.CaptureFixture[str], alone: list[Judgement]
) -> None:
    """`run --json` and `document()` are one: but for times, the same keys and rows."""
    assert main(["run", "euler/rest", "--rung", "f32", "--json"]) == 0
    printed = json.loads(capsys.readouterr().out)
    made = json.loads(json.dumps(taylor_verify.run_many(["euler/rest"], rungs=["f32"]).document()))
    for document in (printed, made):
        assert document.pop("sha256")
        for row in document["verdicts"]:
            del row["seconds"], row["provenance"]
    assert printed == made


def test_its_repr_is_short_and_its_table_is_escaped(results: Judgements) -> None:
    """The repr is one line with the counts; a notebook shows a row for each run, and no more than forty."""
    assert repr(results) == (
        f"<Judgements of 6 runs by taylor: passed; {results.summary['pass']} pass>"
    )
    html = results._repr_html_()
    assert html.count("<tr>") == 7
    assert "<td>kirchhoff/whole-motion</td><td>mp120</td>" in html
    first, *rest = results.judgements
    evil = replace(first.verdicts[0], scene="<script>")
    many = replace(results, judgements=(replace(first, verdicts=(evil,)), *rest * 10))
    assert "<script>" not in many._repr_html_()
    assert "&lt;script&gt;" in many._repr_html_()
    assert many._repr_html_().count("<tr>") == 41
    assert "and 11 more runs" in many._repr_html_()


# Many pieces of work on any executor: the order asked for, one end for all, one thread at a time.


def square(number: int) -> int:
    return number * number


ASKED = [3, 1, 4, 1, 5]
EXECUTORS: dict[str, Callable[[], Executor]] = {
    "threads": lambda: ThreadPoolExecutor(3),
    "processes": lambda: ProcessPoolExecutor(2, get_context("spawn")),
    "backwards": lambda: Backwards(len(ASKED)),
}


@pytest.mark.parametrize("make", EXECUTORS.values(), ids=EXECUTORS)
def test_any_executor_gives_the_order_asked_for(make: Callable[[], Executor]) -> None:
    """Equal pieces too are each answered and each told of, and the executor is left open."""
    ended: list[tuple[int, int]] = []
    executor = make()
    results = run_all(
        square, ASKED, executor, ended=lambda one, result: ended.append((one, result))
    )
    assert results == [9, 1, 16, 1, 25]
    assert sorted(ended) == sorted(zip(ASKED, results, strict=True))
    if not isinstance(executor, Backwards):
        assert executor.submit(square, 7).result() == 49
        executor.shutdown()


def test_the_dearest_begins_first() -> None:
    """Work is submitted by expense, and the results keep their order."""
    started: list[int] = []
    with ThreadPoolExecutor(1) as executor:

        def work(one: int) -> int:
            started.append(one)
            return one

        assert run_all(work, ASKED, executor, expense=lambda one: -one) == ASKED
    assert started == sorted(ASKED, reverse=True)


def test_threads_of_one_process_take_turns() -> None:
    """mpmath and FLINT have one precision for a process: two runs at once would compute wrong numbers."""
    inside = 0
    most = 0

    def work(one: int) -> int:
        nonlocal inside, most
        inside += 1
        most = max(most, inside)
        time.sleep(0.01)
        inside -= 1
        return one

    with ThreadPoolExecutor(4) as one, ThreadPoolExecutor(4) as other:
        callers = [
            threading.Thread(target=run_all, args=(work, range(8), executor))
            for executor in (one, other)
        ]
        for caller in callers:
            caller.start()
        for caller in callers:
            caller.join()
    assert most == 1


@pytest.mark.parametrize("error", [ValueError("broken"), KeyboardInterrupt()])
@pytest.mark.parametrize("of_work", [True, False], ids=["in the work", "in this thread"])
def test_an_error_or_an_interrupt_cancels_what_has_not_begun(
    error: BaseException, of_work: bool
) -> None:
    """It is raised as it is, from the work or from the caller's own function."""
    started: list[int] = []
    first_has_ended = threading.Event()

    def work(one: int) -> int:
        started.append(one)
        if one:
            first_has_ended.wait(PATIENCE)
        elif of_work:
            raise error
        return one

    def ended(one: int, _: object) -> None:
        if not of_work:
            raise error

    with ThreadPoolExecutor(1) as executor:
        with pytest.raises(type(error)):
            run_all(work, range(50), executor, ended=ended)
        first_has_ended.set()
    # The second may have begun meanwhile.
    assert started in ([0], [0, 1])


class Losing(Executor):
    """An executor that loses each piece of work in one way."""

    def __init__(self, lose: Callable[[Future[Any]], Any]) -> None:
        self.lose = lose

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        future: Future[Any] = Future()
        self.lose(future)
        return future


def cancelled(future: Future[Any]) -> None:
    """Somebody else has shut the executor down."""
    future.cancel()
    future.set_running_or_notify_cancel()


def refused(future: Future[Any]) -> None:
    raise OSError(111, "connection refused")


REFUSED = r"3: .* an error of the executor: ConnectionRefusedError: .*refused"


@pytest.mark.parametrize(
    ("lose", "text"),
    [
        (lambda future: future.set_exception(BrokenExecutor("a process has gone")), "3: a process"),
        (cancelled, "3: expected a result, got .*cancelled"),
        (refused, REFUSED),
        (lambda future: future.set_exception(OSError(111, "connection refused")), REFUSED),
    ],
)
def test_an_executor_that_breaks_names_the_work(lose: Any, text: str) -> None:
    """Work raises Failed alone: another error is the executor's, and is told as Failed of its piece."""
    with pytest.raises(Failed, match=text):
        run_all(square, [3], Losing(lose), raises=Failed)
