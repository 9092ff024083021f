"""The certificate of pieces: bounds for all times, and what is wrong with the pieces."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import partial
from itertools import groupby
from math import asin, atan, hypot, inf, pi, sqrt
from typing import Any, Final

from flint import ctx

from taylor_verify.certify.certificate import Certificate
from taylor_verify.certify.enclosed_error import (
    QUATERNION,
    ROTATION,
    Errors,
    Measured,
    between,
    errors_of,
    measured_of,
)
from taylor_verify.certify.interpolant_faults import Node, findings, nodes_of
from taylor_verify.certify.largest import Largest, largest
from taylor_verify.certify.pieces import Pieces
from taylor_verify.exact.enclosure.operations import Domain
from taylor_verify.exact.enclosure.stopping import Coarse
from taylor_verify.exact.solution import Unsettled
from taylor_verify.records.certificate import Gap, GapKind
from taylor_verify.records.faults import refusal
from taylor_verify.scenes.scene import Scene

_FIRST_BITS: Final = 100
_MOST_BITS: Final = 1600
# The truth is narrow enough where it widens a bound by less than this, or where nothing is left to see.
_NARROW: Final = 1.05
_NOTHING: Final = 1e-28
_GAIN: Final = 0.9
_ROOT_OF_EIGHT: Final = sqrt(8)


def certificate_of(scene: Scene, pieces: Pieces, tolerance: float | None) -> Certificate:
    """Return what is proven of the pieces of an answer."""
    measured, missing = measured_of(scene, pieces.columns)
    begin, end = sorted((scene.clock.start, scene.clock.instants[-1]))
    gaps = [
        Gap(GapKind.NOT_ANSWERED, quantity.name, float(begin), float(end)) for quantity in missing
    ]
    gaps += [
        Gap(GapKind.NOT_COVERED, "time", float(a), float(b)) for a, b in between(pieces, begin, end)
    ]
    if not measured:
        needed = " ".join(column for group in scene.groups for column in group.columns)
        raise refusal(f"columns of the scene ({needed})", " ".join(pieces.columns), "answer")
    until = _reached(scene, pieces, scene.clock.instants[-1])
    nothing = Certificate(scene.name, {}, {}, gaps=tuple(gaps), tolerance=tolerance)
    if until == scene.clock.start:
        return nothing
    try:
        errors, worst, nodes = _settled(scene, pieces, measured, until)
    except (Unsettled, Domain) as doubt:
        return replace(nothing, because=f"undecided: {doubt} @ {scene.name}")
    gaps += list(_jumps(errors, nodes))
    bound = {name: each.bound for name, each in worst.items()}
    return Certificate(
        scene.name,
        bound,
        {name: each.at for name, each in worst.items()},
        {name: each.reached for name, each in worst.items()},
        _most(errors, partial(_rounding, pieces)),
        tuple(gaps),
        findings(errors, nodes, bound),
        tolerance,
    )


def _settled(
    scene: Scene, pieces: Pieces, measured: Sequence[Measured], until: Fraction
) -> tuple[list[Errors], Mapping[str, Largest], list[list[Node]]]:
    """Return errors and their largest values, at a precision at which the truth is narrow enough."""
    bits, stuck, earlier = _FIRST_BITS, False, inf
    while True:
        try:
            with ctx.workprec(bits):
                errors = errors_of(scene, pieces, measured, until, bits)
                worst = _most(errors, _largest)
                nodes = [list(nodes_of(pieces, each)) for each in errors]
        except Coarse as reason:
            if bits > _MOST_BITS or (stuck and reason.stuck is not None):
                raise Unsettled(reason.because or "the motion is lost before its end") from None
            bits, stuck = reason.bits, reason.stuck is not None
            continue
        # What more bits do not narrow is the size of an interval, and no doubt about the truth.
        widest = max(f.bound / max(f.reached, _NOTHING) for f in worst.values())
        if widest <= _NARROW or widest > _GAIN * earlier or bits > _MOST_BITS:
            return errors, worst, nodes
        bits, earlier = 2 * bits, widest


def _reached(scene: Scene, pieces: Pieces, last: Fraction) -> Fraction:
    """The end of the span, or that of the pieces where they end before; the start where none is."""
    begin = scene.clock.start
    if not (each := pieces.between(*sorted((begin, last)))):
        return begin
    return min(last, each[-1].end) if last > begin else max(last, each[0].begin)


def _most(errors: Sequence[Errors], of: Callable[[Errors], Any]) -> dict[str, Any]:
    """Return the largest value ``of`` the groups of each quantity, by its name."""
    by_quantity = groupby(errors, lambda each: each.quantity.name)
    return {name: max(map(of, groups)) for name, groups in by_quantity}


def _largest(errors: Errors) -> Largest:
    """The largest error of a group of columns, in the measure of its quantity."""
    bound, reached, at = largest(errors.intervals)
    return Largest(_measure(errors, bound), _measure(errors, reached), at)


def _measure(errors: Errors, size: float) -> float:
    """Divide an error by its scale, or turn it into the angle that it is, for an attitude."""
    columns, error = tuple(errors.columns), size / errors.scale
    if columns == QUATERNION:
        return 2 * atan(error)
    if columns == ROTATION:
        return 2 * asin(min(1.0, error / _ROOT_OF_EIGHT)) if error < _ROOT_OF_EIGHT else pi
    return error


def _rounding(pieces: Pieces, errors: Errors) -> float:
    """A bound of what Horner's rule in float64 adds to a value, its argument rounded once."""
    worst = 0.0
    for piece in pieces.each:
        columns = [enumerate(piece.sizes[column]) for column in errors.columns]
        lost = [sum((3 * k + 2) * size for k, size in column) for column in columns]
        worst = max(worst, hypot(*lost) * 2.0**-53 / errors.scale)
    return worst


def _jumps(errors: Sequence[Errors], nodes: Sequence[Sequence[Node]]) -> Iterator[Gap]:
    for each, its_nodes in zip(errors, nodes, strict=True):
        for node in its_nodes:
            if node.jump > node.rounding:
                size = node.jump / each.scale
                yield Gap(GapKind.JUMP, each.quantity.name, node.time, size=size)
