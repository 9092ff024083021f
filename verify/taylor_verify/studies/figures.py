"""The pictures that stand beside the tables: drawn when something is measured, shown where they are.

A page shows the pictures that lie in ``figures`` already; without matplotlib none are drawn, and the
pages that are made of stored data are the same but for them.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Final

from taylor_verify.publish.markdown import prose
from taylor_verify.publish.pictures.picture import Picture, save
from taylor_verify.publish.pictures.ratio import Ratio
from taylor_verify.studies.prices import picture as prices
from taylor_verify.studies.prices.document import PricesStudy
from taylor_verify.studies.tradeoff.pictures import time_by_rung, trade
from taylor_verify.studies.tradeoff.stored import Trade

FOLDER: Final = "figures"

_BAREST: Final = {"omega": "a rigid body", "impulse": "a solid in an ideal fluid"}


def draw(place: Path, pictures: Iterable[Picture]) -> list[Path]:
    """Write pictures to ``place``/figures. Raises ImportError without matplotlib, and OSError."""
    return save(pictures, place / FOLDER)


def shown(place: Path, pictures: Iterable[Picture]) -> str:
    """Those that are there, as a page in ``place``/tables shows them, with what they show in words."""
    return "\n\n".join(
        f"![{prose(one.alt)}](../{FOLDER}/{one.stem}.svg)"
        for one in pictures
        if (place / FOLDER / f"{one.stem}.svg").exists()
    )


def of_trade(found: Trade) -> list[Picture]:
    """Error against time, evaluations and steps, and the digits asked for and left, of one scene."""
    return trade.pictures(found.document()) if found.sound else []


def of_rungs(found: Sequence[Trade]) -> list[Picture]:
    """Taylor's time at each rung's own tolerance, a line for each scene."""
    rows = [
        Ratio(one.scene, row.point.rung, row.timing.ratio, row.timing.low, row.timing.high)
        for one in found
        for row in one.sound
        if row.point.solver == "taylor"
    ]
    return [time_by_rung.picture("published", rows)] if rows else []


def of_prices(study: PricesStudy) -> list[Picture]:
    """Return the price of each thing that a scene may ask for on f64, a picture for each model."""
    found = []
    for root, words in _BAREST.items():
        rows = [
            Ratio(row.variant, row.rung, *row.step_ratio)
            for row in study.rows
            if row.against == root and row.rung == "f64" and row.variant != root
        ]
        if rows:
            found.append(prices.picture(words, f"{root} alone", rows))
    return found
