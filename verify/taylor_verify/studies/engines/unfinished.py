"""The answers of a measurement that has not ended: one file a run, so that it goes on after a kill."""

from __future__ import annotations

import hashlib
import shutil
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from taylor_verify.records.replacement import replace_files
from taylor_verify.studies.engines.answer import Answer


@dataclass(frozen=True)
class Unfinished:
    """The store of a measurement in a folder that is nobody else's."""

    folder: Path

    def keep(self, answer: Answer) -> None:
        """Store an answer, whole or not at all. Raises OSError."""
        replace_files(self.folder, {_name(answer.row.key): answer.to_bytes()})

    def answers(self) -> list[Answer]:
        """Return the answers that are stored; a file that is damaged is no answer."""
        answers = []
        for file in sorted(self.folder.glob("*.json")):
            with suppress(ValueError):
                answers.append(Answer.from_bytes(file.read_bytes()))
        return answers

    def forget(self) -> None:
        """Remove everything."""
        shutil.rmtree(self.folder, ignore_errors=True)


def _name(key: str) -> str:
    return f"{hashlib.sha256(key.encode()).hexdigest()[:32]}.json"
