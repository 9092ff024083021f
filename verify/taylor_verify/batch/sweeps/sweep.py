"""A sweep: many bodies and starts, solved and judged in chunks, resumable, in bounded memory."""

from __future__ import annotations

import logging
import tempfile
from collections.abc import Callable, Generator, Iterator
from concurrent.futures import Executor
from contextlib import closing, contextmanager
from dataclasses import dataclass, replace
from importlib.util import find_spec
from os import PathLike
from pathlib import Path
from typing import Any, Final, TypeVar

from taylor_verify.batch.failure import Failed
from taylor_verify.batch.finished_jobs import package_digest, program_digests
from taylor_verify.batch.judging import Interrupted
from taylor_verify.batch.lock import alone_in
from taylor_verify.batch.sweeps.chunk import Chunk, explain, judge
from taylor_verify.batch.sweeps.dataset import (
    MANIFEST,
    OWN_NAMES,
    TEMPLATE,
    Dataset,
    Manifest,
    read_manifest,
)
from taylor_verify.batch.sweeps.questions import Drawn, Questions, is_whole, questions
from taylor_verify.batch.sweeps.summary import summary
from taylor_verify.batch.sweeps.sweep_files import SUMMARY_NAMES, write_summary
from taylor_verify.batch.work import run_stream
from taylor_verify.judge.provenance import packages
from taylor_verify.judge.tolerances import Tolerance, Tolerances, tolerances
from taylor_verify.numbers.precision import Rung
from taylor_verify.numbers.precision import rung as rung_named
from taylor_verify.records.faults import Refused, refusal
from taylor_verify.records.status import Status
from taylor_verify.records.sweep import SweepSummary
from taylor_verify.solvers.registry import as_solver
from taylor_verify.solvers.solver import Lack, Solver
from taylor_verify.solvers.trajectory import Outcome

Result = TypeVar("Result")

# Chunks are many enough to go round and to lose little by an end, and long enough to be worth a message.
_CHUNKS: Final = 64
_LEAST_CHUNK: Final = 4
_LONGEST_CHUNK: Final = 1024
# So many causes are found in the time in which other processes start.
_MOST_EXPLAINED_HERE: Final = 10
_MOST_WORST: Final = 1000
_PROGRESS: Final = logging.getLogger("taylor_verify.progress")


def sweep(
    what: str | PathLike[str],
    *,
    count: int | None = None,
    seed: int | None = None,
    points: str | None = None,
    solver: Solver | Callable[..., Any] | str = "taylor",
    rung: str = "f64",
    tolerance: Tolerances | Tolerance = None,
    executor: Executor | None = None,
    jobs: int | None = None,
    out: str | PathLike[str] | None = None,
    resume: bool = False,
    worst: int = 10,
    ahead: int = 64,
) -> SweepSummary:
    """Solve and judge many scenes; arguments and errors are those of `taylor_verify.sweep`."""
    faults = list(_faults(jobs, worst, ahead, resume, out))
    try:
        asked = questions(str(what), count, seed, points)
        tolerated = tolerances(tolerance, asked.examples())
        chosen = _solver(solver)
        manifest = _manifest(asked, chosen, rung_named(rung), tolerated)
    except Refused:
        raise
    except ValueError as error:
        raise ValueError("\n".join([*faults, str(error)])) from None
    if faults:
        raise ValueError("\n".join(faults))
    with _folder(out) as folder, alone_in(folder):
        dataset = Dataset(folder, manifest)
        _begin(dataset, asked, resume)
        work = _Work(dataset, asked, chosen, tolerated, executor, jobs, ahead)
        try:
            _judge_all(work)
        except Interrupted:
            if out is None:
                # Nothing is left to go on from.
                raise KeyboardInterrupt from None
            raise
        except Failed as lost:
            if out is None:
                raise
            raise Failed(f"{lost}; what was judged is stored: go on with --resume") from lost
        made = _explained(work, summary(dataset, asked, worst))
        # Nothing is written to a folder that goes.
        return made if out is None else write_summary(folder, made, asked)


def _faults(
    jobs: object, worst: object, ahead: object, resume: object, out: object
) -> Iterator[str]:
    """Yield a sentence for each argument that is none."""
    wanted = {"jobs": (jobs, 1), "worst": (worst, 0), "ahead": (ahead, 1)}
    for name, (value, least) in wanted.items():
        if value is not None and not is_whole(value, least):
            yield f"expected a whole number of at least {least}, got {value!r} @ {name}"
    if isinstance(worst, int) and worst > _MOST_WORST:
        yield f"expected at most {_MOST_WORST} worst cases, got {worst} @ worst"
    if resume and out is None:
        yield "expected the folder of the sweep to go on with (--out), got none @ resume"
    if find_spec("pyarrow") is None:
        yield "expected pyarrow (pip install 'taylor-verify[parquet]'), got none"


def _solver(solver: Solver | Callable[..., Any] | str) -> Solver | str:
    """Return a name as it is, which a process looks up, and the Solver of a callable."""
    try:
        chosen = as_solver(solver)
    except ValueError as error:
        raise ValueError(f"{error} @ solver") from None
    return solver if isinstance(solver, str) else chosen


def _manifest(
    asked: Questions, solver: Solver | str, rung: Rung, tolerated: Tolerances
) -> Manifest:
    missing = as_solver(solver).unavailable(rung)
    if isinstance(missing, Lack) and missing.outcome is Outcome.NO_PACKAGE:
        raise ValueError(missing)
    length = min(max(asked.total // _CHUNKS, _LEAST_CHUNK), _LONGEST_CHUNK)
    return Manifest(
        name=asked.name,
        digest=asked.digest,
        total=asked.total,
        chunk=length,
        solver=solver if isinstance(solver, str) else solver.name,
        rung=rung.name,
        tolerance=tolerated.text,
        programs=tuple(program_digests(solver)),
        package=package_digest(),
        versions=packages(),
        **asked.described,
    )


@contextmanager
def _folder(out: str | PathLike[str] | None) -> Iterator[Path]:
    if out is not None:
        yield Path(out)
        return
    with tempfile.TemporaryDirectory(prefix="taylor-verify-sweep-") as folder:
        yield Path(folder)


def _begin(dataset: Dataset, asked: Questions, resume: bool) -> None:
    """Write what is asked, or compare it with what was asked. Raises Refused."""
    there = read_manifest(dataset.folder)
    if resume and there is None:
        raise refusal("a folder with a sweep to go on with", f"no {MANIFEST}", dataset.folder)
    if resume and there is not None:
        if differences := there.differences(dataset.manifest):
            raise Refused(differences)
        return
    if there is not None:
        mend = "go on with --resume, or name another folder"
        raise refusal("a folder without a sweep", "one", dataset.folder, mend)
    if others := [
        name for name in (*OWN_NAMES, *SUMMARY_NAMES) if (dataset.folder / name).exists()
    ]:
        expected, mend = "a folder without files of these names", "name another folder"
        raise refusal(expected, ", ".join(others), dataset.folder, mend)
    dataset.begin({TEMPLATE: asked.family.source} if isinstance(asked, Drawn) else {})


@dataclass(frozen=True)
class _Work:
    """The work of a sweep: its questions, and where they are answered."""

    dataset: Dataset
    asked: Questions
    solver: Solver | str
    tolerances: Tolerances
    executor: Executor | None
    jobs: int | None
    ahead: int

    def chunk(self, number: int, first: int, stop: int) -> Chunk:
        """Return the scenes with these numbers."""
        manifest, part = self.dataset.manifest, self.asked.part(first, stop)
        return Chunk(number, first, stop, part, self.solver, manifest.rung, self.tolerances)

    def part(self, number: int) -> Chunk:
        """Return the scenes of a part of the dataset."""
        manifest = self.dataset.manifest
        first = number * manifest.chunk
        return self.chunk(number, first, min(first + manifest.chunk, manifest.total))

    def results(
        self, work: Callable[[Chunk], Result], chunks: Iterator[Chunk], is_little: bool
    ) -> Generator[Result]:
        """Return the results of chunks as they end; without an executor, ``is_little`` is done here."""
        if self.executor is None and (is_little or self.jobs == 1):
            return (work(chunk) for chunk in chunks)
        return run_stream(
            work, chunks, self.executor, workers=self.jobs, ahead=self.ahead, raises=Failed
        )


def _judge_all(work: _Work) -> None:
    """Judge the chunks that are not there yet, and write each as it ends."""
    dataset = work.dataset
    finished = dataset.finished()
    length, total = dataset.manifest.chunk, dataset.manifest.total
    done = sum(min(length, total - number * length) for number in finished)
    left = [number for number in range(dataset.parts) if number not in finished]
    if not left:
        return
    _say(done, total)
    try:
        with closing(work.results(judge, map(work.part, left), len(left) == 1)) as answers:
            for answer in answers:
                if answer.package != dataset.manifest.package:
                    expected = "expected the same version of taylor-verify on every worker"
                    raise Failed(f"{expected}, got another one on a worker")
                dataset.write(answer.chunk, answer.columns)
                done += answer.scenes
                _say(done, total)
    except KeyboardInterrupt as interrupt:
        raise Interrupted(done, total) from interrupt


def _explained(work: _Work, result: SweepSummary) -> SweepSummary:
    """Return the summary with the likely causes of the worst cases that failed."""
    points = [case.point for case in result.worst if case.verdict is Status.FAIL]
    cases = (work.chunk(point, point, point + 1) for point in points)
    is_little = len(points) <= _MOST_EXPLAINED_HERE
    with closing(work.results(explain, cases, is_little)) as answers:
        causes = dict(answers)
    worst = (replace(case, causes=causes.get(case.point, ())) for case in result.worst)
    return replace(result, worst=tuple(worst))


def _say(done: int, total: int) -> None:
    _PROGRESS.info(f"{done} of {total} bodies", extra={"share": done / total})
