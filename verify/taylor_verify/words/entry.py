"""Entry of an index: a page of a report folder, and its sheet if there is one."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import PurePosixPath


@dataclass(frozen=True)
class Page:
    """A file or folder of a report, and its contents in words."""

    path: str
    what: str
    has_sheet: bool = False

    @property
    def link(self) -> str:
        """A link to the page from the index of the report."""
        return f"[{self.path}]({self.path})"

    @property
    def sheet(self) -> str:
        """The path of the CSV with the page's numbers."""
        return f"tables/{PurePosixPath(self.path).stem}.csv"
