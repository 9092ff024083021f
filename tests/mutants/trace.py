"""The tests that run each line of some rooms: measured by file, and kept until code or test changes."""

from __future__ import annotations

import hashlib
import json
import os
import subprocess
import sys
from collections import Counter, defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Final

import coverage
import pytest

from mutants.mutant import PACKAGE, VERIFY, Mutant, module_name

ROOT: Final = VERIFY.parent
TESTS: Final = ROOT / "tests"
# An ignored folder, which `make clean` removes.
KEPT: Final = ROOT / ".pytest_cache" / "mutants"


@dataclass(frozen=True)
class Part:
    """What was measured of one file of tests: the tests of each line, and the seconds of each test."""

    key: str

    @property
    def path(self) -> Path:
        return KEPT / f"{self.key}.json"

    def store(self, data: coverage.CoverageData, seconds: Mapping[str, float]) -> None:
        """Write the part at once, so that one that is there is whole."""
        lines = {
            Path(file).relative_to(PACKAGE).as_posix(): {
                line: [name for name in names if name]
                for line, names in data.contexts_by_lineno(file).items()
            }
            for file in data.measured_files()
        }
        whole = {"seconds": dict(seconds), "lines": lines}
        KEPT.mkdir(parents=True, exist_ok=True)
        aside = self.path.with_suffix(".part")
        aside.write_text(json.dumps(whole), encoding="utf-8")
        aside.replace(self.path)


@dataclass(frozen=True)
class Trace:
    """The parts together."""

    parts: Sequence[Part]

    @cached_property
    def _read(self) -> Sequence[Mapping[str, Mapping[str, object]]]:
        return [json.loads(part.path.read_text(encoding="utf-8")) for part in self.parts]

    @cached_property
    def seconds(self) -> Mapping[str, float]:
        return {name: took for part in self._read for name, took in part["seconds"].items()}

    @cached_property
    def _lines(self) -> Mapping[str, Mapping[int, set[str]]]:
        """The tests by module and line."""
        lines: dict[str, dict[int, set[str]]] = defaultdict(lambda: defaultdict(set))
        for part in self._read:
            for path, tests in part["lines"].items():
                for line, names in tests.items():
                    lines[path][int(line)].update(names)
        return lines

    def tests_of(self, mutant: Mutant) -> list[str]:
        """Return the tests that run the line of a mutant.

        Those of files about its module come first, the quick ones before the others. Of a test with
        parameters the quickest comes in the first round, and one more in each round.
        """
        about = {file for file in self._files if _imports(ROOT / file, module_name(mutant.path))}
        rank: Counter[str] = Counter()
        order = []
        for name in sorted(self._running(mutant, about), key=self.seconds.__getitem__):
            bare = name.partition("[")[0]
            order.append((name.partition("::")[0] not in about, rank[bare], len(order), name))
            rank[bare] += 1
        return [name for *_, name in sorted(order)]

    @cached_property
    def _files(self) -> set[str]:
        return {name.partition("::")[0] for name in self.seconds}

    def _running(self, mutant: Mutant, about: set[str]) -> set[str]:
        """Return the tests that run a line; of one that is run by an import, those of all who import it."""
        here = self._lines[mutant.path]
        if not mutant.is_imported:
            return here[mutant.line] or {name for line in mutant.statement for name in here[line]}
        users = (path for path in self._lines if _imports(PACKAGE / path, module_name(mutant.path)))
        modules = (self._lines[path] for path in (mutant.path, *users))
        running = {name for tests in modules for names in tests.values() for name in names}
        return running | {name for name in self.seconds if name.partition("::")[0] in about}


def _imports(file: Path, module: str) -> bool:
    return f"{module} import" in file.read_text(encoding="utf-8")


def trace(rooms: Sequence[str], tests: Sequence[str]) -> Trace:
    """Return the trace of the quick tests of these folders; files of which no part is kept are measured."""
    parts = {file: Part(key) for file, key in _keys(rooms, tests)}
    missing = {file: part.key for file, part in parts.items() if not part.path.exists()}
    if missing:
        environment = {
            **os.environ,
            "PYTHONPATH": os.pathsep.join(
                (str(VERIFY), str(TESTS), os.environ.get("PYTHONPATH", ""))
            ),
            "MUTANTS_PARTS": json.dumps(missing),
            "MUTANTS_ROOMS": " ".join(rooms),
        }
        command = [
            *(sys.executable, "-m", "pytest", "-q", "-p", "mutants.tracing"),
            *("-p", "no:cacheprovider", "-m", "not slow", *missing),
        ]
        ended = subprocess.run(command, cwd=ROOT, env=environment, check=False, stdout=sys.stderr)
        if ended.returncode not in (pytest.ExitCode.OK, pytest.ExitCode.NO_TESTS_COLLECTED):
            sys.exit("a test fails without a mutant: see above")
    return Trace([part for part in parts.values() if part.path.exists()])


def _keys(rooms: Sequence[str], tests: Sequence[str]) -> Iterator[tuple[str, str]]:
    """Yield each file of tests with a digest of it and of all that it may run."""
    shared = hashlib.sha256(repr(sorted(rooms)).encode())
    for place in (VERIFY, TESTS / "builders"):
        for file in sorted(place.rglob("*.py")):
            shared.update(str(file.relative_to(ROOT)).encode() + file.read_bytes())
    for folder in tests:
        for file in sorted((ROOT / folder).rglob("test_*.py")):
            name, own = file.relative_to(ROOT).as_posix(), shared.copy()
            own.update(name.encode() + file.read_bytes())
            yield name, own.hexdigest()[:16]
