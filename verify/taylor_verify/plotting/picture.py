"""Pictures with a name and an alternative text, saved for pages and for print."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Callable, Collection, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from html import escape
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Final

from taylor_verify.plotting.compact_svg import compact
from taylor_verify.plotting.style import settings
from taylor_verify.records.replacement import replace_files

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_MAKER: Final = "taylor-verify"
# Without a date, two files of one picture are the same.
_METADATA: Final[dict[str, dict[str, str | None]]] = {
    "svg": {"Creator": _MAKER, "Date": None},
    "pdf": {"Creator": _MAKER, "CreationDate": None},
    "png": {"Software": _MAKER},
}
_PUBLISHED: Final = ("svg", "pdf")
ENDINGS: Final = tuple(f".{ending}" for ending in _METADATA)
# Pixels per inch of a PNG: legible on a screen, and in print at the width of a page.
_RESOLUTION: Final = 200


@dataclass(frozen=True)
class Picture:
    """A picture: the stem of its file, its title, and its alternative text for those who cannot see it.

    ``figure`` draws it, and must be called inside `plotting`. The alternative text needs no matplotlib.
    """

    stem: str
    title: str
    alt: str
    figure: Callable[[], Figure]

    def _repr_html_(self) -> str:
        """Return the drawing for a notebook, with its alternative text."""
        drawn = b64encode(content(self, "svg")).decode()
        return f'<p><img alt="{escape(self.alt)}" src="data:image/svg+xml;base64,{drawn}"/></p>'


def save(
    pictures: Iterable[Picture], folder: Path | str, formats: Collection[str] = _PUBLISHED
) -> list[Path]:
    """Write each picture as SVG and as PDF, in place of earlier ones; return the paths.

    ``formats`` may name other formats (svg, pdf, png). All pictures are drawn before the first is
    written, and each is replaced as a whole. Raises ImportError without matplotlib, OSError for a
    folder that cannot be written.
    """
    with plotting():
        contents = {name: file for picture in pictures for name, file in _files(picture, formats)}
    return list(replace_files(Path(folder), contents))


def content(picture: Picture, ending: str) -> bytes:
    """Return the file of a picture in one format. Raises ImportError without matplotlib."""
    with plotting():
        return dict(_files(picture, [ending]))[f"{picture.stem}.{ending}"]


@contextmanager
def plotting() -> Iterator[None]:
    """Let matplotlib draw with the settings of `style` instead of the user's own."""
    try:
        from matplotlib import style
    except ImportError as fault:
        raise ImportError(
            "expected matplotlib (pip install 'taylor-verify[plots]'), got none @ pictures"
        ) from fault
    with style.context(["default", settings()]):
        yield


def _files(picture: Picture, formats: Collection[str]) -> Iterator[tuple[str, bytes]]:
    """Yield name and content for each format."""
    figure = picture.figure()
    for ending in formats:
        metadata = {"Title": picture.title, **_METADATA[ending]}
        if ending == "svg":
            metadata["Description"] = picture.alt
        file = BytesIO()
        resolution = _RESOLUTION if ending == "png" else "figure"
        figure.savefig(file, format=ending, metadata=metadata, dpi=resolution)
        drawn = file.getvalue()
        yield (
            f"{picture.stem}.{ending}",
            compact(drawn.decode()).encode() if ending == "svg" else drawn,
        )
