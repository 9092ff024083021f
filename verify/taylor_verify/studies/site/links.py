"""Where a link of the published folder leads in the site: to a page, to a file beside it, or nowhere.

Files that pages link to come along; one that is large comes packed, so that the site stays small, and
one whose numbers the pages have in their pictures does not come at all. What lies outside the folder,
such as a source file of the suite, is no part of the site and gets no link.
"""

from __future__ import annotations

import posixpath
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Final
from urllib.parse import quote

# Bytes. Above this only sheets and data are found, of which a packed one has a tenth.
_LARGE: Final = 30_000
_SHOWN: Final = ".svg"
PACKED: Final = ".tar.xz"
# What pages show already: samples and courses in their pictures, drawings in the other format.
_ON_PAGES: Final = ("data/records/", "data/portraits/")
_TWIN: Final = ".pdf"
# Exact trajectories: the two forms of one have the same digits, and share an archive.
_REFERENCE: Final = "reference/"
_TITLE: Final = re.compile(r"^# (.+)$", re.MULTILINE)
_ABROAD: Final = ("http://", "https://", "mailto:")


class Links:
    """The links of one site. ``pages`` has the page of each Markdown file, ``scenes`` of each scene."""

    def __init__(self, folder: Path, pages: Mapping[str, str], scenes: Mapping[str, str]) -> None:
        self._folder = folder
        self.pages = pages
        self.scenes = scenes
        self._files: dict[str, set[Path]] = {}

    @property
    def files(self) -> dict[str, list[Path]]:
        """The files that pages link to, by their place in the site: more than one in an archive."""
        return {name: sorted(files) for name, files in sorted(self._files.items())}

    def scene(self, name: str, page: str) -> str | None:
        """The way from a page to that of a scene; None for a name that is no scene."""
        found = self.scenes.get(name)
        return None if found is None else way(page, found)

    def resolved(self, link: str, source: str, page: str) -> str | None:
        """The link of a Markdown file ``source`` as it stands on ``page``; None where it leads out."""
        if link.startswith((*_ABROAD, "#")):
            return link
        markdown = self.markdown(link, source)
        if markdown is None:
            return self.file(_place(link, source), page)
        fragment = link.partition("#")[2]
        return way(page, self.pages[markdown]) + (f"#{fragment}" if fragment else "")

    def markdown(self, link: str, source: str) -> str | None:
        """The Markdown file that a link of ``source`` leads to; None where it is none with a page."""
        place = _place(link, source)
        return next((name for name in (place, f"{place}/README.md") if name in self.pages), None)

    def title(self, markdown: str) -> str:
        """The first heading of a Markdown file, without its marks."""
        return title_of((self._folder / markdown).read_text(encoding="utf-8"))

    def file(self, place: str, page: str) -> str | None:
        """The way from a page to a file of the published folder, which then comes along."""
        file = self._folder / place
        if place.startswith("..") or not file.is_file() or _has_a_page(place):
            return None
        name = _name(place, file)
        self._files.setdefault(name, set()).add(file)
        return way(page, name)

    def drawing(self, stem: str) -> str | None:
        """The place in the site of a published drawing, which then comes along."""
        return self.file(f"figures/{stem}.svg", "index.html")


def title_of(text: str) -> str:
    """The first heading of a Markdown text, without its marks."""
    found = _TITLE.search(text)
    return found[1].replace("`", "").replace("*", "") if found else "Untitled"


def _place(link: str, source: str) -> str:
    """Where in the published folder a link leads, without its anchor."""
    path = link.partition("#")[0]
    return posixpath.normpath(posixpath.join(posixpath.dirname(source), path))


def _has_a_page(place: str) -> bool:
    return place.startswith(_ON_PAGES) or place.endswith(_TWIN)


def _name(place: str, file: Path) -> str:
    """Where a file stands in the site, itself or packed."""
    if place.startswith(_REFERENCE) and file.suffix in (".csv", ".json"):
        return place.removesuffix(file.suffix) + PACKED
    large = file.stat().st_size > _LARGE and file.suffix != _SHOWN
    return f"{place}{PACKED}" if large else place


def way(page: str, target: str) -> str:
    """The relative link from one page of the site to another of its files."""
    return quote(posixpath.relpath(target, posixpath.dirname(page) or "."))
