"""Faults of an interpolant by its errors at the nodes: their sizes, slopes, jumps and shifts of time."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise
from math import hypot
from typing import Final, NamedTuple

import numpy as np

from taylor_verify.certify.enclosed_error import QUATERNION, Errors, Floats, Interval
from taylor_verify.certify.pieces import Pieces, nearest
from taylor_verify.records.certificate import Fault, InterpolantFinding

# Errors between the nodes that are so much larger are those of the interpolant.
_BETWEEN: Final = 10.0
# A fault explains an error if it leaves a tenth.
_LEFT: Final = 0.1
_ROUNDINGS: Final = 2.0**-46
# An error within the rounding of a double is no fault.
_LEAST: Final = 2.0**-53
# The rounding of a time to float32 is at most 2^-24 of it; some rounding of the largest shifts is seen.
_SINGLE: Final = 2.0**-24
_LEAST_SHARE: Final = 2.0**-4
_FEW: Final = 4


class Node(NamedTuple):
    """The beginning of a piece: its jump from the piece before, and errors of both pieces there.

    ``error`` and ``before`` are those of this piece and of the piece before, ``rate`` is the true one and
    ``slope`` that of the piece.
    """

    time: float
    jump: float
    rounding: float
    error: Floats
    before: Floats
    rate: Floats
    slope: Floats


def nodes_of(pieces: Pieces, errors: Errors) -> Iterator[Node]:
    """Yield the nodes of a group of columns, where pieces meet inside the span."""
    group = tuple(errors.columns)
    starts, ends = _Ends(errors.intervals, -1), _Ends(errors.intervals, 1)
    for before, after in pairwise(pieces.each):
        time = float(after.begin)
        left, right = ends.near(time), starts.near(time)
        if before.end != after.begin or left is None or right is None:
            continue
        jump = hypot(*(nearest(after.polynomials[c][0] - before.last(c)) for c in group))
        size = sum(sum(piece.sizes[c]) for piece in (before, after) for c in group)
        slope = np.array([nearest(after.polynomials[c][1]) for c in group])
        error, derived = _ends(right, -1)
        yield Node(
            time, jump, _ROUNDINGS * size, error, _ends(left, 1)[0],
            slope - derived if group != QUATERNION else slope * np.nan, slope,
        )  # fmt: skip


class _Ends:
    """Intervals by the times at which they begin, or end."""

    def __init__(self, intervals: Sequence[Interval], side: int) -> None:
        times = np.array([each.middle + side * each.half for each in intervals])
        order = np.argsort(times)
        self._times, self._intervals = times[order], [intervals[k] for k in order]

    def near(self, time: float) -> Interval | None:
        """The interval whose end is a time but for its roundings; None where there is none."""
        k = int(np.searchsorted(self._times, time))
        places = [place for place in (k - 1, k) if 0 <= place < len(self._times)]
        close = min(places, key=lambda place: abs(self._times[place] - time))
        interval = self._intervals[close]
        return interval if abs(self._times[close] - time) <= interval.half / 2 else None


def _ends(interval: Interval, v: int) -> tuple[Floats, Floats]:
    """The errors at an end of an interval, and their rates."""
    orders = np.arange(interval.rows.shape[1])
    signs = float(v) ** orders
    rates = (interval.rows[:, 1:] * (orders[1:] * signs[:-1])).sum(axis=1) / interval.half
    return (interval.rows * signs).sum(axis=1), rates


def findings(
    errors: Sequence[Errors], nodes: Sequence[Sequence[Node]], bound: Mapping[str, float]
) -> tuple[InterpolantFinding, ...]:
    """Return the faults that the errors at the nodes show."""
    faults: dict[tuple[str, Fault], InterpolantFinding] = {}
    for of, each in zip(errors, nodes, strict=True):
        name = of.quantity.name
        if len(each) >= _FEW and (fault := _fault(each, bound[name], of.scale)):
            size = _at_nodes(each) / of.scale
            faults.setdefault((name, fault), InterpolantFinding(name, fault, size, bound[name]))
    return tuple(faults.values())


def _at_nodes(nodes: Sequence[Node]) -> float:
    return max(min(hypot(*node.error), hypot(*node.before)) for node in nodes)


def _fault(nodes: Sequence[Node], bound: float, scale: float) -> Fault | None:
    if bound <= _LEAST:
        return None
    if _is_single(nodes):
        return Fault.ABSCISSA
    jumps = [node.jump for node in nodes if node.jump > node.rounding]
    if jumps and max(jumps) / scale > _LEFT * bound:
        return Fault.NODES
    if bound <= _BETWEEN * _at_nodes(nodes) / scale:
        return None
    return Fault.SLOPES if _are_of_step_before(nodes) else Fault.BETWEEN


def _is_single(nodes: Sequence[Node]) -> bool:
    """True if the errors at the nodes are shifts of time as large as roundings to float32, and differ."""
    worst = max(nodes, key=lambda node: hypot(*node.error))
    shifts = []
    for node in nodes:
        square = float(node.rate @ node.rate)
        if not square > 0:
            return False
        shift = float(node.error @ node.rate) / square
        if hypot(*(node.error - shift * node.rate)) > _LEFT * hypot(*worst.error):
            return False
        shifts.append(shift / abs(node.time) if node.time else 0.0)
    sizes = np.abs(shifts)
    is_small = bool(sizes.max() <= 2 * _SINGLE)
    return (
        is_small and bool(sizes.max() >= _LEAST_SHARE * _SINGLE) and min(shifts) * max(shifts) < 0
    )


def _are_of_step_before(nodes: Sequence[Node]) -> bool:
    """True if the slopes at the nodes are wrong, and are the true rates at the nodes before."""
    wrong = max(hypot(*(node.slope - node.rate)) for node in nodes)
    shifted = max(hypot(*(after.slope - before.rate)) for before, after in pairwise(nodes))
    return shifted <= _LEFT * wrong
