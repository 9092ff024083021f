"""The tests that run each line of some rooms, measured once and kept until code or tests change."""

from __future__ import annotations

import hashlib
import json
import os
import subprocess
import sys
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Final

import coverage

from mutants.mutant import PACKAGE, VERIFY, Mutant

ROOT: Final = VERIFY.parent
TESTS: Final = ROOT / "tests"
# An ignored folder, which `make clean` removes.
KEPT: Final = ROOT / ".pytest_cache" / "mutants"


@dataclass(frozen=True)
class Trace:
    """What was measured: a file of coverage with a context for each test, and the seconds of each."""

    folder: Path

    @cached_property
    def seconds(self) -> Mapping[str, float]:
        found: dict[str, float] = json.loads((self.folder / "seconds.json").read_text("utf-8"))
        return found

    @cached_property
    def _lines(self) -> coverage.CoverageData:
        data = coverage.CoverageData(str(self.folder / "lines"))
        data.read()
        return data

    def tests_of(self, mutant: Mutant) -> list[str]:
        """Return the tests that run the line of a mutant, the likeliest files to notice it first.

        A line of a module's own level runs when it is imported: then all tests of the module.
        """
        by_line = self._lines.contexts_by_lineno(str(PACKAGE / mutant.path))
        running = {name for name in by_line.get(mutant.line, ()) if name}
        if "" in by_line.get(mutant.line, ()) or mutant.line not in by_line:
            running |= {name for names in by_line.values() for name in names if name}
        by_file: dict[str, list[str]] = defaultdict(list)
        for name in self.seconds:
            if name in running:
                by_file[name.partition("::")[0]].append(name)
        order = sorted(
            by_file, key=lambda file: (not _is_about(file, mutant), self._cost(by_file[file]))
        )
        return [name for file in order for name in by_file[file]]

    def _cost(self, names: Sequence[str]) -> float:
        return sum(self.seconds[name] for name in names)


def _is_about(file: str, mutant: Mutant) -> bool:
    """Return True if a test file imports the module."""
    source = (ROOT / file).read_text(encoding="utf-8")
    return f"{mutant.module} import" in source


def trace(rooms: Sequence[str], tests: Sequence[str]) -> Trace:
    """Return the trace of the quick tests of these folders; it is measured where none is kept."""
    folder = KEPT / _digest(rooms, tests)
    if not (folder / "seconds.json").exists():
        folder.mkdir(parents=True, exist_ok=True)
        environment = {
            **os.environ,
            "PYTHONPATH": os.pathsep.join(
                (str(VERIFY), str(TESTS), os.environ.get("PYTHONPATH", ""))
            ),
            "MUTANTS_TRACES": str(folder),
            "MUTANTS_ROOMS": " ".join(rooms),
        }
        command = [
            *(sys.executable, "-m", "pytest", "-q", "-p", "mutants.tracing"),
            *("-p", "no:cacheprovider", "-m", "not slow", *tests),
        ]
        subprocess.run(command, cwd=ROOT, env=environment, check=True, stdout=sys.stderr)
    return Trace(folder)


def _digest(rooms: Sequence[str], tests: Sequence[str]) -> str:
    text = hashlib.sha256(repr((sorted(rooms), sorted(tests))).encode())
    for file in _files(tests):
        text.update(str(file.relative_to(ROOT)).encode() + file.read_bytes())
    return text.hexdigest()[:16]


def _files(tests: Sequence[str]) -> Iterator[Path]:
    for place in (VERIFY, TESTS / "builders", *(ROOT / name for name in tests)):
        yield from sorted(place.rglob("*.py"))
