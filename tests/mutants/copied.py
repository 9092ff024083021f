"""A copy of code and tests, in which mutants are run: the tree itself is never changed."""

from __future__ import annotations

import ast
import json
import os
import shutil
import subprocess
import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

from mutants.mutant import Mutant
from mutants.trace import ROOT

# A test is ended after this many times its seconds of processor time, and what caches may have saved it.
PATIENCE, START = 8, 10


class ServerError(Exception):
    """The error for a process of tests that ended before its jobs."""


@dataclass(frozen=True)
class Copy:
    """The folder of a copy."""

    place: Path

    def noticing(
        self, mutants: Mapping[Mutant, Mapping[str, float]]
    ) -> Iterator[tuple[Mutant, str | None]]:
        """Yield each mutant with the first of its tests that notices it, or None.

        The tests are given with their seconds. Code that an import runs is changed in its file, other
        code in the process that has imported it.
        """
        tried = {mutant: limits(tests) for mutant, tests in mutants.items() if tests}
        yield from ((mutant, None) for mutant in mutants if mutant not in tried)
        shared = [mutant for mutant in tried if not mutant.is_imported]
        jobs = [((one.path, one.place), tried[one]) for one in shared]
        yield from zip(shared, self._ended(jobs), strict=True)
        for one in (mutant for mutant in tried if mutant.is_imported):
            with self._changed({one.path: one.text}):
                try:
                    yield one, next(self._ended([(None, tried[one])]))
                except ServerError:  # the import itself
                    yield one, next(iter(tried[one]))

    def failing(self, mutants: Sequence[Mutant], seconds: Mapping[str, float]) -> set[str]:
        """Return which of these tests fail by themselves without a mutant, or take half their limit.

        The modules of the mutants are without their comments here, too.
        """
        texts = {one.path: (self._package / one.path).read_text("utf-8") for one in mutants}
        with self._changed({path: ast.unparse(ast.parse(text)) for path, text in texts.items()}):
            jobs = [(None, {name: limit / 2}) for name, limit in limits(seconds).items()]
            return {name for name in self._ended(jobs) if name}

    @property
    def _package(self) -> Path:
        return self.place / "verify/taylor_verify"

    @contextmanager
    def _changed(self, texts: Mapping[str, str]) -> Iterator[None]:
        """Set other texts for modules, and bring the sound ones back."""
        files = [self._package / path for path in texts]
        for file, text in zip(files, texts.values(), strict=True):
            # Not written over: the file that comes back has the time of its compiled form.
            file.rename(file.with_suffix(".sound"))
            file.write_text(text, encoding="utf-8")
        try:
            yield
        finally:
            for file in files:
                file.with_suffix(".sound").replace(file)

    def _ended(
        self, jobs: Sequence[tuple[tuple[str, int] | None, Mapping[str, float]]]
    ) -> Iterator[str | None]:
        """Yield the test that ended each job, or None (``mutants.serving``)."""
        if not jobs:
            return
        written = [{"mutant": mutant, "limits": tests} for mutant, tests in jobs]
        (self.place / "jobs.json").write_text(json.dumps(written), encoding="utf-8")
        files = sorted({name.partition("::")[0] for _, tests in jobs for name in tests})
        sources = (self.place / "verify", self.place / "tests", os.environ.get("PYTHONPATH", ""))
        reading, writing = os.pipe()
        environment = {
            **os.environ,
            "PYTHONPATH": os.pathsep.join(map(str, sources)),
            # What is compiled of a mutant would be taken for the sound module.
            "PYTHONDONTWRITEBYTECODE": "1",
            "MUTANTS_PLACE": str(self.place),
            "MUTANTS_PIPE": str(writing),
        }
        command = (sys.executable, "-m", "pytest", "-q", "-p", "mutants.serving", *files)
        # pytest would rewrite the asserts of the package, which has a plugin: no code would be that of
        # the file, and none be swapped.
        with (
            (self.place / "log").open("w") as log,
            subprocess.Popen(
                (*command, "-p", "no:cacheprovider", "--assert=plain"),
                cwd=self.place,
                env=environment,
                stdout=log,
                stderr=log,
                pass_fds=(writing,),
            ),
        ):
            os.close(writing)
            with os.fdopen(reading, encoding="utf-8") as lines:
                number = 0
                for line in lines:
                    number += 1
                    yield json.loads(line)
        if number < len(jobs):
            raise ServerError((self.place / "log").read_text(encoding="utf-8"))


def limits(seconds: Mapping[str, float]) -> dict[str, float]:
    """Return the seconds of processor time after which each test is ended."""
    return {name: START + PATIENCE * took for name, took in seconds.items()}


@contextmanager
def copied() -> Iterator[Copy]:
    """Make a copy, and remove it in the end."""
    with TemporaryDirectory(prefix="mutants-") as name:
        place = Path(name)
        for entry in ROOT.iterdir():
            if entry.name in {"verify", "tests", "cases"}:
                shutil.copytree(entry, place / entry.name)
            elif not entry.name.startswith("."):
                (place / entry.name).symlink_to(entry)
        yield Copy(place)
