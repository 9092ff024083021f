"""The finished jobs of a run of many scenes, stored so that the run can go on after an interrupt.

A run, its folder of reports included, has a folder of its own in the user's cache, which no other run
reads or writes: a lock says who is in it. Each job's judgements are a file, written whole or not at
all: the digest of the rest, then JSON, which runs nothing when it is read. The name of a file is made of
all that its judgements depend on: scene, solver, rungs, tolerances, versions and the text of this package.
"""

from __future__ import annotations

import hashlib
import inspect
import json
import logging
import os
import shlex
import shutil
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any, Final

from msgspec import to_builtins
from platformdirs import user_cache_path

from taylor_verify.batch.job import Job
from taylor_verify.batch.lock import Occupied, alone_in
from taylor_verify.batch.pickling import dumps
from taylor_verify.judge.judgement import Judgement
from taylor_verify.judge.provenance import versions
from taylor_verify.records.faults import Refused
from taylor_verify.records.json_text import DOCUMENT, converted
from taylor_verify.records.regular_file import bounded_bytes
from taylor_verify.records.replacement import replace_files
from taylor_verify.scenes.reading.reader import as_scene
from taylor_verify.solvers.registry import PROCESS, PYTHON, solver_named
from taylor_verify.solvers.solver import Solver

_SUFFIX: Final = ".judged"
_log = logging.getLogger(__name__)


@dataclass(frozen=True)
class Unfinished:
    """The store of one run."""

    folder: Path

    def recall(self, job: Job) -> list[Judgement] | None:
        """Return the judgements of a job that was finished before; None if it is to be run.

        A file that was damaged since is removed, with a warning.
        """
        file = self._file(job)
        try:
            return from_bytes(bounded_bytes(file, "stored judgements", DOCUMENT))
        except OSError:
            return None
        except (ValueError, Refused):
            _log.warning("taylor-verify: warning: damaged, and run again: %s @ %s", job.name, file)
            with suppress(OSError):
                file.unlink()
            return None

    def keep(self, job: Job, judgements: Sequence[Judgement]) -> None:
        """Store the judgements of a job; where nothing can be written, nothing is stored."""
        with suppress(OSError):
            replace_files(self.folder, {self._file(job).name: to_bytes(judgements)})

    def forget(self) -> None:
        """Remove everything."""
        shutil.rmtree(self.folder, ignore_errors=True)

    def _file(self, job: Job) -> Path:
        question = (as_scene(job.scene).digest, *_words(job))
        depends = (question, program_digests(job.solver), versions(), package_digest())
        return self.folder / f"{_digest(repr(depends).encode())}{_SUFFIX}"


@contextmanager
def unfinished(asked: Sequence[Job], out: Path | None, resume: bool) -> Iterator[Unfinished | None]:
    """The store of a run, empty unless it is to be resumed.

    None where the user's cache cannot be written, and where the same run is going on elsewhere.
    """
    place = os.path.abspath(out) if out is not None else None
    run = _digest(repr(([_words(job) for job in asked], os.getcwd(), place)).encode())
    store = Unfinished(user_cache_path("taylor-verify") / "unfinished" / run[:32])
    with ExitStack() as stack:
        try:
            stack.enter_context(alone_in(store.folder))
            if not resume:
                for file in store.folder.glob(f"*{_SUFFIX}"):
                    file.unlink()
        except (Occupied, OSError):
            yield None
            return
        yield store


# The files.


def to_bytes(judgements: Sequence[Judgement]) -> bytes:
    """Return the content of a file: the digest of the rest, then JSON; of a judged file its verdicts."""
    rows = [judged.common for judged in judgements]
    # An error that is not finite stays what it is: Python reads its own NaN and Infinity.
    text = json.dumps(to_builtins(rows, enc_hook=tuple)).encode()
    return _digest(text).encode() + b"\n" + text


def from_bytes(content: bytes) -> list[Judgement]:
    """Return the judgements as they were; ValueError for any other content."""
    digest, _, text = content.partition(b"\n")
    if digest != _digest(text).encode():
        raise ValueError("expected the digest of the content")
    return converted(json.loads(text), list[Judgement])


# What a judgement depends on.


def _words(job: Job) -> tuple[object, ...]:
    """Return the scene's name, the solver, the rungs and the tolerances.

    A Scene itself has no fixed order in its text.
    """
    solver = job.solver if isinstance(job.solver, str) else job.solver.name
    return job.name, solver, job.rungs, job.tolerances


def program_digests(solver: Solver | str) -> list[str]:
    """The digests of a solver's own code: one that has changed is another solver.

    They are those of the files that a command names, and of the module of a function.
    """
    if not isinstance(solver, str):
        return _digests_of(solver)
    if solver.startswith(PYTHON):
        return _digests_of(solver_named(solver))
    if not solver.startswith(PROCESS):
        return []
    words = shlex.split(solver.removeprefix(PROCESS))
    files = [Path(place) for word in words if (place := shutil.which(word) or word)]
    return [_digest(file.read_bytes()) for file in files if file.is_file()]


def _digests_of(solver: Solver) -> list[str]:
    """The digests of a solver as it is sent to a process, and of the file with its function."""
    answer: Any = getattr(solver, "answer", solver)
    try:
        file = inspect.getsourcefile(inspect.unwrap(getattr(answer, "func", answer)))
    except TypeError:
        file = inspect.getsourcefile(type(answer))
    content = [Path(file).read_bytes()] if file and Path(file).is_file() else []
    return [_digest(part) for part in (dumps(solver), *content)]


@cache
def package_digest() -> str:
    """A digest of this package's own text: a judgement of other code is no judgement of this one."""
    digest = hashlib.sha256()
    package = Path(__file__).parents[1]
    for file in sorted(package.rglob("*.py")):
        digest.update(str(file.relative_to(package)).encode() + file.read_bytes())
    return digest.hexdigest()


def _digest(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()
