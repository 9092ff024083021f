"""A copy of code and tests, in which mutants are run: the tree itself is never changed."""

from __future__ import annotations

import ast
import compileall
import json
import os
import shutil
import signal
import subprocess
import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest

from mutants.mutant import Mutant
from mutants.trace import ROOT

# A test is ended after this many times its seconds of processor time, and what caches may have saved it.
PATIENCE, START = 8, 20
# One that waits takes no processor time. It is ended too, but that says nothing of a mutant.
WAIT = 3600


@dataclass(frozen=True)
class Copy:
    """The folder of a copy."""

    place: Path

    @contextmanager
    def changed(self, texts: Mapping[str, str]) -> Iterator[None]:
        """Set other texts for modules, and bring the sound ones back."""
        files = [self.place / "verify/taylor_verify" / path for path in texts]
        for file, text in zip(files, texts.values(), strict=True):
            # Not written over: the file that comes back has the time of its compiled form.
            file.rename(file.with_suffix(".sound"))
            file.write_text(text, encoding="utf-8")
        try:
            yield
        finally:
            for file in files:
                file.with_suffix(".sound").replace(file)

    def failing(self, seconds: Mapping[str, float]) -> str | None:
        """Return the first of these tests that fails or takes too long.

        It is the first of all where an import fails.
        """
        chosen = self.place / "chosen.json"
        chosen.write_text(json.dumps(seconds), encoding="utf-8")
        running = chosen.with_suffix(".running")
        running.write_text(next(iter(seconds)), encoding="utf-8")
        sources = (self.place / "verify", self.place / "tests", os.environ.get("PYTHONPATH", ""))
        environment = {
            **os.environ,
            "PYTHONPATH": os.pathsep.join(map(str, sources)),
            # Compiled once, and never of a mutant.
            "PYTHONDONTWRITEBYTECODE": "1",
            "MUTANTS_CHOSEN": str(chosen),
        }
        files = dict.fromkeys(name.partition("::")[0] for name in seconds)
        command = [
            *(sys.executable, "-m", "pytest", "-x", "-q", "-p", "mutants.choosing"),
            *("-p", "no:cacheprovider", *files),
        ]
        with subprocess.Popen(
            command,
            cwd=self.place,
            env=environment,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            start_new_session=True,
        ) as process:
            try:
                ended = process.wait(WAIT)
            finally:
                if process.poll() is None:
                    os.killpg(process.pid, signal.SIGKILL)
        return None if ended == pytest.ExitCode.OK else running.read_text(encoding="utf-8")

    def noticing(self, mutant: Mutant, stages: Sequence[Mapping[str, float]]) -> str | None:
        """Return the test that notices a mutant, of some lots of tests with their seconds."""
        with self.changed({mutant.path: mutant.text}), suppress(subprocess.TimeoutExpired):
            for seconds in stages:
                limits = {name: START + PATIENCE * took for name, took in seconds.items()}
                if name := self.failing(limits):
                    return name
        return None

    def failing_without(self, mutants: Sequence[Mutant], seconds: Mapping[str, float]) -> set[str]:
        """Return which of these tests fail without a mutant, or take more than half their limit.

        The modules of the mutants are without their comments here, too.
        """
        paths = {mutant.path for mutant in mutants}
        files = {path: (self.place / "verify/taylor_verify" / path) for path in paths}
        sound = {
            path: ast.unparse(ast.parse(file.read_text("utf-8"))) for path, file in files.items()
        }
        left, failing = dict(seconds), set[str]()
        with self.changed(sound):
            while left:
                name = self.failing({test: (START + PATIENCE * left[test]) / 2 for test in left})
                if name is None:
                    return failing
                failing.add(name)
                del left[name]
        return failing


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
        compileall.compile_dir(place / "verify", quiet=2)
        yield Copy(place)
