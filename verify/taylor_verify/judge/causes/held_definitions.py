"""Definitions and vectors of [space] that read the time, taken now and then and held in between."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from typing import Final

import numpy as np

from taylor_verify.judge.causes.arc_response import ArcResponse
from taylor_verify.judge.causes.arcs import Arcs
from taylor_verify.judge.causes.changed_texts import NAME, renamed
from taylor_verify.judge.causes.fit import Family, fault
from taylor_verify.judge.causes.float_answer import Answer
from taylor_verify.judge.causes.texts import with_entry
from taylor_verify.judge.causes.vectors_of_texts import decimal
from taylor_verify.scenes.loads.loads import Loads

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
    response = ArcResponse(arcs, max([arcs.compared, *(each.coupled for each in (right, *other))]))
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
        for name, other in _with_other_time(loads, last):
            if next(other.faults(), None) is None:
                words = f"{name} taken every {every} and held in between"
                yield fault(words, "held definition", {"acting": acting.of(other)})


def _with_other_time(loads: Loads, last: dict[str, str]) -> Iterator[tuple[str, Loads]]:
    """Yield the loads with another time in one definition, or in one vector of [space]."""
    change = partial(renamed, names=last)
    for k, (name, entry) in enumerate(loads.definitions):
        if _reads_time(str(entry)):
            definitions = with_entry(loads.definitions, k, (name, change(str(entry))))
            yield name, replace(loads, definitions=definitions)
    for k, (name, entries) in enumerate(loads.space):
        if any(_reads_time(str(entry)) for entry in entries):
            vector = tuple(change(decimal(entry)) for entry in entries)
            yield (
                f"{name} of [space]",
                replace(loads, space=with_entry(loads.space, k, (name, vector))),
            )


def _reads_time(text: str) -> bool:
    return "t" in NAME.findall(text)
