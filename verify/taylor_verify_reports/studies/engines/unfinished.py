"""Answers of runs, one file for each, so that a killed measurement can be continued."""

from __future__ import annotations

import hashlib
import shutil
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from taylor_verify.records.replacement import replace_files
from taylor_verify_reports.studies.engines.answer import Answer


@dataclass(frozen=True)
class Unfinished:
    """The answers of a measurement so far, in a folder of their own."""

    folder: Path

    def keep(self, answer: Answer) -> None:
        """Store an answer, whole or not at all. Raises OSError."""
        replace_files(self.folder, {self.file_of(answer.row.key).name: answer.to_bytes()})

    def answers(self) -> list[Answer]:
        """Return the stored answers; damaged files are skipped."""
        return [answer for _, answer in self._stored()]

    def keep_only(self, is_good: Callable[[Answer], bool]) -> None:
        """Remove the answers that are not good. Raises OSError."""
        for file, answer in self._stored():
            if not is_good(answer):
                file.unlink()

    def file_of(self, key: str) -> Path:
        """Return the file of the answer to a run."""
        return self.folder / f"{hashlib.sha256(key.encode()).hexdigest()[:32]}.json"

    def forget(self) -> None:
        """Remove the folder."""
        shutil.rmtree(self.folder, ignore_errors=True)

    def _stored(self) -> Iterator[tuple[Path, Answer]]:
        for file in sorted(self.folder.glob("*.json")):
            with suppress(ValueError):
                yield file, Answer.from_bytes(file.read_bytes())
