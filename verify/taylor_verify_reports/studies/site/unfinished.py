"""The folder in which a site is made: what was finished before an interrupt is there the next time.

It lies in the user's cache, one for each report and each text of this package. A drawing has the digest of
its picture for a name. What Sphinx has read of the pages is kept, as long as all sources are the same;
others begin anew. The folder is removed when the site is whole.
"""

from __future__ import annotations

import hashlib
import shutil
from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Final

from platformdirs import user_cache_path

from taylor_verify.batch.lock import alone_in
from taylor_verify.batch.pickling import dumps
from taylor_verify.batch.store import package_digest
from taylor_verify.plotting.picture import Picture
from taylor_verify.records.replacement import replace_files

_STAMP: Final = "sources.sha256"


@dataclass(frozen=True)
class Drawings:
    """Drawings by the digest of their picture, each written as it is made."""

    folder: Path

    def find(self, picture: Picture) -> str | None:
        file = self.folder / _name(picture)
        return file.read_text(encoding="utf-8") if file.exists() else None

    def keep(self, picture: Picture, svg: str) -> None:
        replace_files(self.folder, {_name(picture): svg})


def _name(picture: Picture) -> str:
    return f"{hashlib.sha256(dumps(picture)).hexdigest()}.svg"


@dataclass(frozen=True)
class Work:
    """The folder of one site that is not finished; Sphinx writes its pages to ``made``."""

    folder: Path

    @property
    def drawings(self) -> Drawings:
        return Drawings(self.folder / "drawings")

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

    After an error its drawings stay: Sphinx would not look at a page with a fault again. Where the cache
    cannot be written, nothing stays. Raises Occupied if the same site is being made.
    """
    own = hashlib.sha256(str(report.resolve()).encode()).hexdigest()[:32]
    place = user_cache_path("taylor-verify") / "site" / own
    with ExitStack() as stack:
        try:
            stack.enter_context(alone_in(place))
        except OSError:
            place = Path(stack.enter_context(TemporaryDirectory(prefix="taylor-verify-site-")))
        for old in place.iterdir():
            if old.is_dir() and old.name != package_digest():
                shutil.rmtree(old, ignore_errors=True)
        work = Work(place / package_digest())
        try:
            yield work
        except Exception:
            shutil.rmtree(work.pages, ignore_errors=True)
            raise
        shutil.rmtree(work.folder, ignore_errors=True)
