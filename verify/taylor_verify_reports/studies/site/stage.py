"""Source folder of Sphinx: pages of docs and of the report, and the files that they link to.

Paths are those of a checkout: ``docs/method.md``, ``reports/tables/hard.md``. So links that work in a
checkout work on the site.
"""

from __future__ import annotations

import lzma
import posixpath
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Final

from taylor_verify_reports.studies.archive import tar
from taylor_verify_reports.studies.site.links import relinked

DOCS: Final = "docs"
REPORTS: Final = "reports"
FRONT: Final = "index.md"
README: Final = "README.md"

# In bytes. Larger files are sheets and data, which are packed to a tenth of their size.
_LARGE: Final = 30_000
PACKED: Final = ".tar.xz"
# Parts of a drawing that its page does not need.
_FONTS: Final = re.compile(r"font-family: [^;\"}]*")
_METADATA: Final = re.compile(r"<metadata>.*?</metadata>\s*", re.DOTALL)
_FOLDERS: Final = ("tables", "reference", "upstream", "upstream/engines")
# The name of a sheet, which the site has and a clone makes.
_SHEET: Final = re.compile(r"`([\w/-]+\.csv)`")
_INCLUDED: Final = re.compile(r"^```\{include\} (\S+)\n```$", re.MULTILINE)
_TOCTREE: Final = re.compile(r"^```\{toctree\}\n.*?^```$", re.MULTILINE | re.DOTALL)
_ENTRY: Final = re.compile(r"^([a-z][\w/-]*)$", re.MULTILINE)


def docs_beside(folder: Path) -> Path | None:
    """Return the folder of docs in the checkout of the report ``folder``; None without a checkout."""
    docs = folder.resolve().parent / DOCS
    return docs if (docs / "conf.py").exists() else None


@dataclass
class Stage:
    """Files for Sphinx by path. ``folder`` has the report, ``docs`` the pages of the checkout, if any.

    ``motions`` are pages that Sphinx does not make, by the path that they have on the site.
    """

    folder: Path
    docs: Path | None
    files: dict[str, str | bytes] = field(default_factory=dict)
    motions: dict[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self._pages = dict(self._markdown())
        self._places = {*self._pages}
        # The front page replaces the list of docs, and a page replaces the file that it includes.
        self._stand_ins = {f"{DOCS}/index.md": FRONT, README: FRONT}
        for place, file in self._pages.items():
            for included in _INCLUDED.findall(file.read_text(encoding="utf-8")):
                self._stand_ins[_joined(place, included)] = place

    def _markdown(self) -> Iterator[tuple[str, Path]]:
        """Yield the path and the file of each page of the report and of docs."""
        for folder in (self.folder, *(self.folder / name for name in _FOLDERS)):
            for file in sorted(folder.glob("*.md")):
                yield f"{REPORTS}/{file.relative_to(self.folder).as_posix()}", file
        for file in sorted(self.docs.rglob("*.md")) if self.docs else ():
            place = file.relative_to(self.docs or file)
            if place.parts[0] != "_build" and place.as_posix() != "index.md":
                yield f"{DOCS}/{place.as_posix()}", file

    @property
    def report_pages(self) -> list[str]:
        """The pages of the report for a toctree, without pages that are listed below another page."""
        pages = [
            place.removesuffix(".md") for place in self._pages if place.startswith(f"{REPORTS}/")
        ]
        below = {page for parent in pages for page in self._below(parent)}
        return [page for page in pages if page not in below]

    def _below(self, parent: str) -> list[str]:
        """Return the pages below a page, such as tables/engines-mujoco below tables/engines."""
        pages = (place.removesuffix(".md") for place in self._pages)
        return [page for page in pages if page.startswith(f"{parent}-")]

    def text(self, place: str) -> str:
        """Return the text of a file of the checkout; empty if there is none, a title of a README."""
        file = self._origin(place)
        if file is not None and file.is_file():
            return file.read_text(encoding="utf-8")
        return "# taylor-verify\n" if place == README else ""

    def toctrees(self) -> str:
        """Return the lists of pages of docs/index.md, for the navigation; empty without docs."""
        if self.docs is None:
            return ""
        text = (self.docs / "index.md").read_text(encoding="utf-8")
        lists = (_ENTRY.sub(rf"{DOCS}/\1", match[0]) for match in _TOCTREE.finditer(text))
        return "\n\n".join(lists).replace(":maxdepth: 1", ":hidden:")

    def add_pages(self, made: Mapping[str, str]) -> None:
        """Add the stored pages and those of ``made``, by their paths, with the files that they link to.

        A page of ``made`` replaces the stored page of its path. Raises OSError for files that cannot be
        read, and ValueError for a page that includes a file outside the checkout.
        """
        stored = {place: file for place, file in self._pages.items() if place not in made}
        self._places |= made.keys()
        for place, file in stored.items():
            text = file.read_text(encoding="utf-8")
            self._add(place, _INCLUDED.sub(partial(self._included, place), text))
        for place, text in made.items():
            self._add(place, text)

    def _add(self, place: str, text: str) -> None:
        """Add a page, with a hidden list of the pages below it."""
        folder = posixpath.dirname(place)
        is_of_report = place.startswith(f"{REPORTS}/")
        if is_of_report and (below := self._below(place.removesuffix(".md"))):
            names = "\n".join(map(posixpath.basename, below))
            text = f"{text}\n```{{toctree}}\n:hidden:\n\n{names}\n```\n"
        linked = _SHEET.sub(partial(self._with_link, place), text)
        self.files[place] = relinked(linked, folder, folder, self._resolve)

    def _with_link(self, place: str, sheet: re.Match[str]) -> str:
        """Return the name of a sheet as a link to it, if it is there."""
        is_there = self._resolve(_joined(place, sheet[1])) is not None
        return f"[{sheet[1]}]({sheet[1]})" if is_there else sheet[0]

    def _included(self, place: str, block: re.Match[str]) -> str:
        """Return the file that a page includes, with links that work on that page."""
        included = _joined(place, block[1])
        file = self._origin(included)
        if file is None:
            raise ValueError(f"expected a file of the checkout, got {block[1]} @ {place}")
        text = file.read_text(encoding="utf-8")
        return relinked(text, posixpath.dirname(included), posixpath.dirname(place), lambda at: at)

    def _resolve(self, place: str) -> str | None:
        """Return the page or file that a link leads to, and add that file; None if there is neither."""
        for page in (self._stand_ins.get(place, place), f"{place}/README.md"):
            if page in self._places:
                return page
        if place in self.files:
            return _as_linked(place)
        file = self._origin(place)
        if file is None or not file.is_file():
            return None
        if file.suffix != ".svg" and file.stat().st_size > _LARGE:
            place += PACKED
        if place not in self.files:
            self.files[place] = _content(file, place.endswith(PACKED))
        return _as_linked(place)

    def _origin(self, place: str) -> Path | None:
        """Return the file that a path stands for; None outside the report and its checkout."""
        if place.startswith(f"{REPORTS}/"):
            return self.folder / place.removeprefix(f"{REPORTS}/")
        return None if self.docs is None or place.startswith("..") else self.docs.parent / place


def smaller(svg: str) -> str:
    """Return an SVG drawing without metadata, and with the font of its page."""
    return _FONTS.sub("font-family: sans-serif", _METADATA.sub("", svg))


def _as_linked(place: str) -> str:
    """Return the target of a link to a file; Markdown gets Sphinx's mark of a file that is no page."""
    return f"path:{place}" if place.endswith(".md") else place


def _content(file: Path, is_packed: bool) -> str | bytes:
    """Return the content of a file: packed, or with a drawing made smaller."""
    content = file.read_bytes()
    if is_packed:
        return lzma.compress(tar({file.name: content}))
    return smaller(content.decode()) if file.suffix == ".svg" else content


def _joined(place: str, path: str) -> str:
    """Return the path of a file that the page ``place`` names by a relative path."""
    return posixpath.normpath(posixpath.join(posixpath.dirname(place), path))
