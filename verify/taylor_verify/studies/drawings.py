"""Every picture of a report folder, made of the data that the folder holds."""

from __future__ import annotations

from pathlib import Path

from taylor_verify.publish.pictures.picture import Picture
from taylor_verify.studies import figures
from taylor_verify.studies.enclosure import page as widths
from taylor_verify.studies.enclosure import picture as pictured
from taylor_verify.studies.gallery import page as gallery
from taylor_verify.studies.growth import page as growth
from taylor_verify.studies.prices import page as prices
from taylor_verify.studies.reach import page as reach
from taylor_verify.studies.tradeoff import stored as trades


def pictures(folder: Path) -> list[Picture]:
    """Return the pictures whose data are there; the gallery asks for portraits and records.

    Raises OSError for files that cannot be read and ValueError for files that hold something else.
    """
    return [
        *(*_traded(folder), *_priced(folder), *_grown(folder)),
        *(*_reached(folder), *_enclosed(folder), *_shown(folder)),
    ]


def _traded(folder: Path) -> list[Picture]:
    stored = trades.load(folder)
    if stored is None:
        return []
    own = [picture for trade in stored.trades for picture in figures.of_trade(trade)]
    return [*own, *figures.of_rungs(stored.trades)]


def _priced(folder: Path) -> list[Picture]:
    has_prices = (folder / prices.PRICES).exists()
    return figures.of_prices(prices.load(folder)) if has_prices else []


def _grown(folder: Path) -> list[Picture]:
    runs = growth.load(folder).runs
    picture = growth.picture_of(runs) if runs else None
    return [picture] if picture else []


def _reached(folder: Path) -> list[Picture]:
    return reach.pictures(reach.load(folder)) if (folder / reach.REACH).exists() else []


def _enclosed(folder: Path) -> list[Picture]:
    if not (folder / widths.STORED).exists():
        return []
    return [pictured.picture(widths.load(folder))]


def _shown(folder: Path) -> list[Picture]:
    try:
        return [one.picture for one in gallery.shown(gallery.Stored(folder))]
    except FileNotFoundError:
        return []
