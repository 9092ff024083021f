"""An entry of an index: a page of a report folder, with its sheet where there is one."""

from __future__ import annotations

import posixpath
from dataclasses import dataclass
from pathlib import PurePosixPath


@dataclass(frozen=True)
class Page:
    """A file or folder below the report's own, and what it has."""

    path: str
    what: str
    has_sheet: bool = False

    def link(self, seen_from: str = ".") -> str:
        """Return a link to the page from a folder of the report."""
        place = posixpath.relpath(self.path, seen_from)
        return f"[{place}]({place})"

    @property
    def sheet(self) -> str:
        """The place of the page's own numbers with every digit; those of a page at the top too."""
        return f"tables/{PurePosixPath(self.path).stem}.csv"
