"""The truth where no closed form is known: the equations of both texts, enclosed by Taylor series.

A motion is a set of balls that is proven to contain it (exact.enclosure): the rounding of the data and of
every operation, the truncation of each series, and what the motion makes of all these are bounded.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from math import ceil, log2
from typing import Any, Final, final

import numpy as np
from flint import arb, ctx
from mpmath import mp, mpf

from taylor_verify.exact import clocks
from taylor_verify.exact.balls import balls, max_or_nan, midpoint, upper
from taylor_verify.exact.enclosure.course import MOST_STEPS, Coarse, Course, Row
from taylor_verify.exact.enclosure.placing import Place, norm
from taylor_verify.exact.enclosure.system import System, moving, posed
from taylor_verify.exact.enclosure.tube import BOUND_BITS
from taylor_verify.exact.rotation import rotation_matrix
from taylor_verify.exact.solution import NO_CLOSED_FORM, Quantities, Solution, Unsettled
from taylor_verify.scenes.motion import Impulse, Motion, State
from taylor_verify.scenes.scene import Scene

_GUARD_BITS: Final = 40
_MORE_BITS: Final = 16
_ATTEMPTS: Final = 24
# Beyond twice the bits of the digits asked for: what a motion may lose.
_MOST_BITS: Final = 10_000
# A vector that may be zero has no relative digits. If it is smaller than this, in bits beyond the digits
# asked for, beside its own largest size, its error is told absolutely.
_NEGLIGIBLE_BITS: Final = 200


@dataclass(frozen=True)
class _Enclosing(Solution):
    """Motions in balls, at whatever precision makes them narrow enough."""

    scene: Scene

    route = "taylor"
    regime = NO_CLOSED_FORM

    def rows(self, elapsed: Sequence[Fraction], bits: int, most_bits: int) -> list[Row]:
        """A row of balls for each time, at ``bits`` bits, which are the ambient precision already."""
        raise NotImplementedError

    @final
    def motion(self, elapsed: Sequence[Fraction], digits: int) -> Motion:
        """The midpoints, and the proven radius of every vector and matrix relative to its norm.

        Raises Unsettled where more than a million steps, or ten thousand bits more than the digits
        take, would be needed.
        """
        target = ceil(digits * log2(10))
        was_stuck = False
        bits, most_bits = target + _GUARD_BITS, 2 * target + _MOST_BITS
        for _ in range(_ATTEMPTS):
            if bits > most_bits:
                break
            try:
                with ctx.workprec(bits):
                    rows = self.rows(elapsed, bits, most_bits)
                motion, missing = self._measured(rows, target)
            except Coarse as reason:
                if reason.stuck and was_stuck:
                    raise Unsettled("the bounds of no step close, however short it is") from reason
                bits, was_stuck = reason.bits, reason.stuck
                continue
            if missing <= 0:
                return motion
            bits += min(missing + _MORE_BITS, bits)
        raise Unsettled(
            f"the enclosure of the motion does not shrink to {digits} digits with {most_bits} bits"
        )

    @final
    def evaluate(self, elapsed: Sequence[Fraction], digits: int) -> Quantities:
        """The midpoints of the motion."""
        return self.motion(elapsed, digits).quantities

    def _measured(self, rows: Sequence[Row], target: int) -> tuple[Motion, int]:
        """The motion, and how many bits its widest vector lacks."""
        quantities, radii, missing = {}, {}, 0
        widest = [mpf(0)] * len(rows)
        for name, vectors in self._vectors(rows).items():
            widths = []
            for vector, largest in vectors:
                width, lacking = _width(list(np.ravel(vector)), largest, target)
                widths.append(width)
                missing = max(missing, lacking)
            values = np.array([vector for vector, _ in vectors], dtype=object)
            quantities[name] = np.frompyfunc(midpoint, 1, 1)(values)
            radii[name] = np.array(widths, dtype=object)
            widest = [max_or_nan(a, b) for a, b in zip(widest, widths, strict=True)]
        return Motion(quantities, np.array(widest, dtype=object), radii), missing

    def _vectors(self, rows: Sequence[Row]) -> dict[str, list[tuple[Any, float]]]:
        """Each tracked quantity at each time as balls, with log2 of its largest size so far."""
        found: dict[str, list[tuple[Any, float]]] = {}
        names = ("omega",) if self.scene.model == "euler" else ("linear_impulse", "angular_impulse")
        for k, name in enumerate(names):
            found[name] = [(row.state[3 * k : 3 * k + 3], row.largest[k]) for row in rows]
        if self.scene.track:
            found["attitude"] = [([row.turn[i : i + 3] for i in (0, 3, 6)], 0.0) for row in rows]
        if "centre" in self.scene.track:
            found["centre"] = [(row.centre, row.largest[-1]) for row in rows]
        return found


@final
@dataclass(frozen=True)
class TaylorSolution(_Enclosing):
    """The motion of any scene, free or loaded, in balls that are proven to contain it."""

    most_steps: int = MOST_STEPS

    def rows(self, elapsed: Sequence[Fraction], bits: int, most_bits: int) -> list[Row]:
        start, place = balls(self._system.start), _place(self.scene, self.scene.initial)
        course = Course.of(self._system, start, place, bits, most_bits)
        course = replace(course, most_steps=self.most_steps)
        later = sorted({t for t in elapsed if t > 0})
        earlier = sorted({t for t in elapsed if t < 0}, reverse=True)
        rows = {Fraction(0): course.first_row()}
        for times in filter(None, (later, earlier)):
            rows.update(course.rows(times))
        return [rows[t] for t in elapsed]

    @cached_property
    def _system(self) -> System:
        return posed(self.scene)


def arcs(
    scene: Scene,
    starts: Sequence[State],
    spans: Sequence[Fraction],
    digits: int,
    begins: Sequence[Fraction] = (),
) -> Motion:
    """Row k: where the scene's equations lead from the exact state starts[k] in the time spans[k].

    Enclosed to ``digits``, as Solution.motion is, and raises Unsettled likewise. The loads of a
    manufactured motion change with time: there each arc has to say when it begins, ``begins`` since the
    start of the scene. Elsewhere that changes nothing.
    """
    if scene.body.manufactured is not None and len(begins) != len(starts):
        raise ValueError(
            f"expected the times at which {len(starts)} arcs under loads that change with time begin, "
            f"got {len(begins)} @ {scene.name}"
        )
    return _Arcs(scene, tuple(starts), tuple(begins)).motion(spans, digits)


@final
@dataclass(frozen=True)
class _Arcs(_Enclosing):
    """Many short motions of one body, each from a state of its own, and by the clock from its time."""

    starts: tuple[State, ...]
    begins: tuple[Fraction, ...]

    def rows(self, elapsed: Sequence[Fraction], bits: int, most_bits: int) -> list[Row]:
        manufactured = self.scene.body.manufactured
        whole = Course.of(self._system, (), None, bits, most_bits)
        rows = []
        for k, (start, span) in enumerate(zip(self.starts, elapsed, strict=True)):
            state = balls(moving(start))
            if manufactured is not None:
                state += clocks.balls_at(manufactured, self.begins[k])
            arc = replace(whole, start=state, place=_place(self.scene, start))
            rows.append(next(arc.rows([span]))[1] if span else arc.first_row())
        return rows

    @cached_property
    def _system(self) -> System:
        return posed(self.scene)


def _place(scene: Scene, initial: State) -> Place | None:
    """The frame at the start in balls, at the ambient precision; None where it is not tracked."""
    if not scene.track:
        return None
    centre = initial.centre if "centre" in scene.track and isinstance(initial, Impulse) else None
    return Place.of(rotation_matrix(initial.attitude), centre)


def _width(vector: Sequence[arb], largest: float, target: int) -> tuple[mpf, int]:
    """A bound of the error of a vector relative to its norm, and how many bits it lacks.

    Absolute where the vector is zero, or may be zero and is negligible beside its own ``largest`` size.
    """
    with ctx.workprec(BOUND_BITS):
        error = norm([arb(entry.rad()) for entry in vector])
        size = sum((entry * entry for entry in vector), arb(0)).nonnegative_part().sqrt().lower()
        if error.is_zero():
            return mpf(0), 0
        if not error.is_finite():
            return mp.inf, target
        if size > 0:
            width = upper(error / size)
            return width, int(mp.mag(width)) + target
        width = upper(error)
        missing = int(mp.mag(width)) + target + _NEGLIGIBLE_BITS - int(max(largest, -1e9))
        return width, missing
