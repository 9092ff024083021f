"""The study of the worst: a search for the largest error over attainable in families of extremes."""

from __future__ import annotations

from contextlib import suppress
from math import inf
from pathlib import Path
from typing import Final

from taylor_verify.studies.study import Measured, Option, Progress, Study
from taylor_verify.studies.worst import page
from taylor_verify.studies.worst.page import WORST


def _measure(folder: Path, progress: Progress, seconds: float = 600.0, seed: int = 1) -> Measured:
    """Search; the scenes that are found take the place of those that are shipped."""
    from taylor_verify.scenes.library import WORST as SCENES
    from taylor_verify.scenes.library import cases_directory
    from taylor_verify.studies.worst.measure import FAMILIES, hunt, study

    found = hunt(FAMILIES, seconds, seed, progress.counting(len(FAMILIES)))
    scenes = {one.family.name: one.scene_text for one in found}
    shipped = page.store_scenes(cases_directory() / SCENES, scenes)
    return Measured([*WORST.write(folder, study(found, seconds, seed)), *shipped])


def _seconds(text: str) -> float:
    with suppress(ValueError):
        if 0 < float(text) < inf:
            return float(text)
    raise ValueError(f"expected a time in seconds above 0, got {text}")


def _seed(text: str) -> int:
    with suppress(ValueError):
        return int(text)
    raise ValueError(f"expected a whole number, got {text}")


STUDY: Final = Study(
    name="worst",
    title="the worst that a search has found, family by family",
    duration="ten minutes",
    measure=_measure,
    find=WORST.find,
    page=lambda study, folder: page.page(study),
    sheet=page.sheet,
    options=(
        Option("seconds", "the time of the search; default: 600", _seconds, "S"),
        Option("seed", "the seed of the search; default: 1", _seed),
    ),
)
