"""The load that explains a file's rows where no cause is proven: what acts on it that the scene lacks."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial
from pathlib import PurePath

import numpy as np

from taylor_verify.draw.caption import Document, NotDrawn
from taylor_verify.draw.components import Panel, Series, figure
from taylor_verify.draw.view import Numbers
from taylor_verify.plotting.picture import Picture
from taylor_verify.plotting.wording import stem_of
from taylor_verify.records.answers import MissingLoad


def series(loads: Sequence[MissingLoad]) -> Series:
    """Return the load at the ends of all steps, each kept until the next; zero where none is missing."""
    times: list[float] = []
    rows: list[Sequence[float]] = []
    for load, after in zip(loads, [*loads[1:], None], strict=True):
        times.append(load.t)
        rows.append(load.load)
        if after is None or load.until != after.t:
            times.append(load.until)
            rows.append([0.0] * len(load.load))
    return Series(np.array(times), tuple(_panels(np.array(rows))), (), None)


def _panels(rows: Numbers) -> Iterator[Panel]:
    """Yield the moment, or the force and the couple, in body axes."""
    if rows.shape[1] == 3:
        yield Panel("M", "missing moment, body axes", rows, is_held=True)
        return
    yield Panel("X", "missing force, body axes", rows[:, :3], is_held=True)
    yield Panel("L", "missing couple, body axes", rows[:, 3:], is_held=True)


def picture(
    document: Document, name: str, loads: Sequence[MissingLoad], causes: Sequence[str] = ()
) -> Picture:
    """Return the load that the rows of a file of this name ask for.

    ``document`` is the exact motion. Raises NotDrawn where nothing is missing, or some causes are proven.
    """
    if not loads:
        got = (
            f"rows that are explained: {', '.join(causes)}" if causes else "rows that ask for none"
        )
        raise NotDrawn(
            f"expected rows that ask for a load without a proven cause, got {got} @ {name}"
        )
    alt = (
        f"The load that the rows of {name} ask for and {document['scene']} does not have, from "
        f"t = {loads[0].t:g} to t = {loads[-1].until:g}, constant between two rows."
    )
    words = f"{PurePath(name).name}: constant between two rows; no cause is proven."
    drawn = partial(figure, series(loads), words)
    return Picture(stem_of(document, "load"), f"Missing load: {document['scene']}", alt, drawn)
