"""Links in the Markdown of a page that is shown in another folder than its own."""

from __future__ import annotations

import posixpath
import re
from collections.abc import Callable
from typing import Final

# A link or a picture within the tree: its text, which may have escaped brackets, its path and its anchor.
_LINK: Final = re.compile(r"!?\[((?:\\.|[^\\\[\]])*)\]\((?!\w+:|#)([^()#\s]+)(#[^()\s]*)?\)")
# Sphinx does not read links to files in headings.
_HEADING: Final = re.compile(r"^#+ .*\]\(.*$", re.MULTILINE)


def relinked(
    text: str, written_in: str, shown_in: str, resolve: Callable[[str], str | None]
) -> str:
    """Return Markdown of the folder ``written_in`` with links that work in the folder ``shown_in``.

    ``resolve`` takes the target of a link as a path from the top of the tree, and returns the new target. A
    prefix ``path:`` of the new target is Sphinx's mark of a file that is no page. If the new target is
    None, only the text of the link stays. A link whose text is its own path shows the title of the page
    instead.
    """

    def moved(link: re.Match[str]) -> str:
        words, path, anchor = link[1], link[2], link[3] or ""
        place = resolve(posixpath.normpath(posixpath.join(written_in, path)))
        if place is None:
            return words
        prefix = "path:" if place.startswith("path:") else ""
        way = posixpath.relpath(place.removeprefix(prefix), shown_in or ".")
        mark = "!" if link[0].startswith("!") else ""
        if prefix:
            return f"[{words}]({prefix}{way})"
        is_named_by_path = words == path and place.endswith(".md")
        return f"{mark}[{'' if is_named_by_path else words}]({way}{anchor})"

    return _LINK.sub(moved, _HEADING.sub(_links_below, text))


def _links_below(heading: re.Match[str]) -> str:
    """Return a heading without links, with its links in a line below."""
    links = " ".join(link[0] for link in _LINK.finditer(heading[0]))
    return f"{_LINK.sub(lambda link: link[1], heading[0])}\n\n{links}" if links else heading[0]
