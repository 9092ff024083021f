"""The folder in which a site is made, with what was finished before an interrupt.

A drawing has the digest of its picture for a name. What Sphinx has read of the pages is kept, as long as
all sources are the same; others begin anew.
"""

from __future__ import annotations

import hashlib
import shutil
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from taylor_verify.records.replacement import replace_files
from taylor_verify_reports.studies import finished_parts as folders
from taylor_verify_reports.studies.finished_parts import Parts

_STAMP: Final = "sources.sha256"


@dataclass(frozen=True)
class Work:
    """The folder of one site that is not finished; Sphinx writes its pages to ``made``."""

    folder: Path

    @property
    def drawings(self) -> Parts:
        """The drawings, each written as it is made, by the bytes of its picture."""
        return Parts(self.folder / "drawings", ".svg")

    @property
    def pages(self) -> Path:
        return self.folder / "pages"

    @property
    def made(self) -> Path:
        return self.pages / "made"

    @property
    def warnings(self) -> Path:
        """The warnings of Sphinx, which it gives once: it reads no page again that is finished."""
        return self.pages / "warnings.txt"

    def source(self, files: Mapping[str, str | bytes]) -> Path:
        """Return the folder with these files; pages that were made of others are removed."""
        source, stated, stamp = self.pages / "source", self.pages / _STAMP, _digest(files)
        if not stated.exists() or stated.read_text(encoding="utf-8") != stamp:
            shutil.rmtree(self.pages, ignore_errors=True)
            replace_files(source, files)
            replace_files(self.pages, {_STAMP: stamp})
        return source


def _digest(files: Mapping[str, str | bytes]) -> str:
    digest = hashlib.sha256()
    for name, content in sorted(files.items()):
        encoded = content.encode() if isinstance(content, str) else content
        digest.update(f"{name} {len(encoded)}\n".encode() + encoded)
    return digest.hexdigest()


@contextmanager
def unfinished(report: Path) -> Iterator[Work]:
    """Open the folder of the site of a report; after an interrupt it stays.

    After an error its drawings stay: Sphinx would not look at a page with a fault again. Raises Occupied if
    the same site is being made.
    """
    with folders.unfinished("site", report) as folder:
        work = Work(folder)
        try:
            yield work
        except Exception:
            shutil.rmtree(work.pages, ignore_errors=True)
            raise
