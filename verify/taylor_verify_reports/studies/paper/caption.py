"""Caption of a table or a picture: its subject, its data, and their machine."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from taylor_verify.records import store
from taylor_verify.words.markdown import code, prose
from taylor_verify_reports.studies.engines import stored as engines
from taylor_verify_reports.studies.tradeoff import stored as tradeoff

VERDICTS: Final = (f"{store.FOLDER}/{store.VERDICTS}",)
ENGINES: Final = (engines.ENGINES.name, engines.TIMINGS.name)
TRADEOFF: Final = (tradeoff.NUMBERS.name, tradeoff.TIMINGS.name)


@dataclass(frozen=True)
class Caption:
    """A sentence in Markdown on the subject, the files of data, and the processor."""

    words: str
    data: tuple[str, ...]
    machine: str

    @property
    def markdown(self) -> str:
        """The whole caption."""
        files = ", ".join(map(code, self.data))
        return f"{self.words} Data: {files}. Machine: {prose(self.machine) or 'unknown'}."
