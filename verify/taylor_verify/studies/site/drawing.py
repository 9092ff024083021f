"""Drawings of the site: published ones in fewer bytes, and those of single scenes, drawn here."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import Any, Final

from taylor_verify.batch.pool import LocalPool, available_cores
from taylor_verify.publish.pictures.picture import Picture, content
from taylor_verify.studies.gallery.pictures import errors_over_time, potential

_FONTS: Final = re.compile(r"font-family: [^;\"}]*")
# A process takes the time of some drawings to start.
_MANY: Final = 20
_METADATA: Final = re.compile(r"<metadata>.*?</metadata>\s*", re.DOTALL)


def smaller(svg: str) -> str:
    """Return the drawing in the font of its page and without metadata; title and text stay."""
    return _FONTS.sub("font-family: sans-serif", _METADATA.sub("", svg))


def pictures_of(
    scene: str, portrait: Mapping[str, Any], records: Mapping[str, Mapping[str, Any]]
) -> list[Picture]:
    """Return pictures of a scene that stand still: errors over time, and the quartic of its orbit."""
    runs, pictures = list(records.values()), []
    if errors_over_time.panels_of(errors_over_time.series(runs)):
        pictures.append(errors_over_time.picture(scene, runs))
    if portrait.get("potential"):
        pictures.append(potential.picture([portrait], scene))
    return pictures


def drawn(pictures: Sequence[Picture]) -> dict[str, str]:
    """Return the SVG of each picture by the name of its file, drawn on all cores where there are many."""
    names = [f"{picture.stem}.svg" for picture in pictures]
    if len(pictures) < _MANY:
        return dict(zip(names, map(_svg, pictures), strict=True))
    with LocalPool(available_cores()) as pool:
        return dict(zip(names, pool.map(_svg, pictures), strict=True))


def _svg(picture: Picture) -> str:
    return smaller(content(picture, "svg").decode())
