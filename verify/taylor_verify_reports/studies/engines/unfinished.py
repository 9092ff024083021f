"""Answers of an unfinished measurement, one file for each run, so that a killed one can be continued."""

from __future__ import annotations

import hashlib
import shutil
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
        replace_files(self.folder, {_name(answer.row.key): answer.to_bytes()})

    def answers(self) -> list[Answer]:
        """Return the stored answers; damaged files are skipped."""
        answers = []
        for file in sorted(self.folder.glob("*.json")):
            with suppress(ValueError):
                answers.append(Answer.from_bytes(file.read_bytes()))
        return answers

    def forget(self) -> None:
        """Remove the folder."""
        shutil.rmtree(self.folder, ignore_errors=True)


def _name(key: str) -> str:
    return f"{hashlib.sha256(key.encode()).hexdigest()[:32]}.json"
