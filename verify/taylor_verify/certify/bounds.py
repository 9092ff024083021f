"""The certificate of pieces: bounds for all times, and what is wrong with the pieces."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from math import asin, atan, hypot, inf, pi, sqrt
from typing import Final

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
from taylor_verify.certify.interpolant_faults import Nodes, findings, nodes_of
from taylor_verify.certify.largest import Largest, largest
from taylor_verify.certify.pieces import Pieces
from taylor_verify.exact.enclosure.operations import Domain
from taylor_verify.exact.enclosure.stopping import Coarse
from taylor_verify.exact.solution import Unsettled
from taylor_verify.records.certificate import Gap, GapKind
from taylor_verify.records.faults import refusal
from taylor_verify.records.quantities import Measure
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
    gaps += list(_jumps(measured, nodes, errors))
    bound = {name: each.bound for name, each in worst.items()}
    return Certificate(
        scene.name,
        bound,
        {name: each.at for name, each in worst.items()},
        {name: each.reached for name, each in worst.items()},
        {m.quantity.name: _rounding(pieces, m, errors) for m in measured},
        tuple(gaps),
        findings(measured, nodes, bound, {m.quantity.name: _scales(m, errors) for m in measured}),
        tolerance,
    )


def _settled(
    scene: Scene, pieces: Pieces, measured: Sequence[Measured], until: Fraction
) -> tuple[Mapping[tuple[str, int], Errors], Mapping[str, Largest], Nodes]:
    """Return errors and their largest values, at a precision at which the truth is narrow enough."""
    bits, stuck, earlier = _FIRST_BITS, False, inf
    while True:
        try:
            with ctx.workprec(bits):
                errors = errors_of(scene, pieces, measured, until, bits)
                worst = {m.quantity.name: _largest(m, errors) for m in measured}
                nodes = nodes_of(pieces, measured, errors)
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


def _largest(of: Measured, errors: Mapping[tuple[str, int], Errors]) -> Largest:
    """The largest error of a quantity, in its measure."""
    every = []
    for k, (group, scale) in enumerate(zip(of.groups, _scales(of, errors), strict=True)):
        bound, reached, at = largest(errors[of.quantity.name, k].intervals)
        every.append(Largest(_measure(group, bound / scale), _measure(group, reached / scale), at))
    return max(every)


def _measure(group: Sequence[str], error: float) -> float:
    """Turn an error into the angle that it is, for an attitude."""
    if tuple(group) == QUATERNION:
        return 2 * atan(error)
    if tuple(group) == ROTATION:
        return 2 * asin(min(1.0, error / _ROOT_OF_EIGHT)) if error < _ROOT_OF_EIGHT else pi
    return error


def _scales(of: Measured, errors: Mapping[tuple[str, int], Errors]) -> list[float]:
    """The size of each group by which its errors are counted; 1 where nothing moves."""
    entries = [errors[of.quantity.name, k] for k, _ in enumerate(of.groups)]
    match of.quantity.measure:
        case Measure.VECTORS:
            return [entry.largest or 1.0 for entry in entries]
        case Measure.PATH:
            return [entry.way or 1.0 for entry in entries]
    return [1.0] * len(entries)


def _rounding(pieces: Pieces, of: Measured, errors: Mapping[tuple[str, int], Errors]) -> float:
    """A bound of what Horner's rule in float64 adds to a value, its argument rounded once."""
    worst = 0.0
    for group, scale in zip(of.groups, _scales(of, errors), strict=True):
        for piece in pieces.each:
            columns = [enumerate(piece.sizes[column]) for column in group]
            lost = [sum((3 * k + 2) * size for k, size in column) for column in columns]
            worst = max(worst, hypot(*lost) * 2.0**-53 / scale)
    return worst


def _jumps(
    measured: Sequence[Measured], nodes: Nodes, errors: Mapping[tuple[str, int], Errors]
) -> Iterator[Gap]:
    for m in measured:
        for k, scale in enumerate(_scales(m, errors)):
            for node in nodes[m.quantity.name, k]:
                if node.jump > node.rounding:
                    yield Gap(GapKind.JUMP, m.quantity.name, node.time, size=node.jump / scale)
