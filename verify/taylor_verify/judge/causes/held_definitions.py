"""Definitions and vectors of [space] that read the time, taken now and then and held in between."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import Final

import numpy as np

from taylor_verify.judge.causes.arc_response import ArcResponse
from taylor_verify.judge.causes.arcs import Arcs
from taylor_verify.judge.causes.changed_texts import renamed
from taylor_verify.judge.causes.fit import Family, fault
from taylor_verify.judge.causes.float_answer import Answer
from taylor_verify.judge.causes.texts import decimal, each_named

# A simulator takes them so many times from row to row, or once in so many rows.
_TIMES: Final = (1, 2, 3, 4, 5, 8, 10, 1 / 2, 1 / 3, 1 / 4, 1 / 5, 1 / 10)
# So many are tried, which leave no more than this part.
_MOST: Final = 2
_LEFT: Final = 0.6


def likely_held(arcs: Arcs) -> list[Family]:
    """Return the few of such texts that explain most of the defects, by the response of the arcs."""
    right, of_right = arcs.answer.right, arcs.of_right[:, : len(arcs.first)]
    every = [*_held_definitions(arcs.answer)]
    other = [right.changed(family.changes(family.right)) for family in every]
    response = ArcResponse.of(arcs, other)
    left = [float(np.linalg.norm(of_right - response.compared(each))) for each in other]
    likely = [k for k in np.argsort(left)[:_MOST] if left[k] < _LEFT * arcs.size]
    return [every[k] for k in likely]


def _held_definitions(answer: Answer) -> Iterator[Family]:
    """Yield the scenes in which a text that reads the time reads that of the last sample."""
    loads, acting = answer.right.loads, answer.right.acting
    if loads is None or acting is None:
        return
    begin = decimal(loads.origin)
    for times in _TIMES:
        every = f"{answer.spacing / times:.9g}"
        last = {"t": f"({begin} + {every}*floor((t - {begin})/{every}))"}
        for name, other in each_named(loads, partial(renamed, names=last)):
            if next(other.faults(), None) is None:
                words = f"{name} taken every {every} and held in between"
                yield fault(words, "held definition", {"acting": acting.of(other)})
