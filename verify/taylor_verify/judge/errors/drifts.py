"""Drifts of the conserved quantities, and the balances that replace them for a loaded body.

Both are the same sum over the samples. With Q a quantity and flow the exact motion over the time
between two samples,

    drift(t_n) = | sum over k < n of Q(state_k+1) - Q(flow(state_k)) |.

Where Q is conserved, Q(flow(state)) = Q(state), and the sum telescopes to Q(state_n) - Q(start). With loads
Q(flow(state)) - Q(state) is the work or impulse along the arc, and the sum is the balance.

Where no arc can begin at a sample, as under loads that read the sign of a quaternion or states of one's
own, Q is compared with that of the exact motion, which holds the work and the impulse of all loads.

For a damped body without loads Q is evaluated at e^{ct} times the momenta: T e^{2ct}, |H|^2 e^{2ct} and so
on are conserved. With loads or wheels they are not conserved, and Q itself has a balance.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any, Final

import numpy as np
from mpmath import mp

from taylor_verify.exact.conditioning.loaded import Linearised, truth
from taylor_verify.exact.conditioning.neighbours import neighbours
from taylor_verify.exact.damping import without_damping
from taylor_verify.exact.invariants import Invariant, decisive
from taylor_verify.exact.solution import Unsettled
from taylor_verify.exact.taylor import arcs
from taylor_verify.judge.errors.state import Errors, Floats, Series, joined
from taylor_verify.numbers.precision import exact_value
from taylor_verify.records.quantities import GROUPS
from taylor_verify.scenes.motion import Motion, State
from taylor_verify.scenes.mpfr import in_mpfr, precision, sqrt, to_mpf, to_mpfr
from taylor_verify.scenes.scene import Scene

Column = np.ndarray[Any, Any]
# Digits of arcs beside rows that are far from the exact motion, and the part of its scale for each row that
# a balance must be off by, to have four digits with such arcs.
_FEW_DIGITS: Final = 8
_CLEAR: Final = 1e-7


class Drifts:
    """The drifts of some quantities of an answer whose rows come in blocks, at one ambient precision.

    ``start`` is the exact initial state as a Motion of one row; ``digits`` is the precision of the arcs.
    ``arc_scene`` is the scene with the quantities that an arc can begin with. A quantity that is ``worked``
    is compared with its value along the exact motion.
    """

    def __init__(
        self,
        scene: Scene,
        start: Motion,
        digits: int,
        of: Sequence[Invariant],
        arc_scene: Scene | None = None,
        worked: Collection[str] = (),
    ) -> None:
        self._scene, self._digits = scene, digits
        self._arc_scene = scene if arc_scene is None else arc_scene
        self._worked = worked
        self._invariants = of
        self._series = {invariant.name: Series() for invariant in self._invariants}
        self._begin = in_mpfr(start)
        # The end of the last block, and the sums of all increments.
        self._end = _End(Fraction(0), scene.initial, self._begin, self._begin)
        self._sums: dict[str, Column] = {}
        # The signed drift of the last row over its scale, for scalar quantities.
        self._changes: dict[str, float] = {}
        # The rows of the exact motion so far from which the scales are computed.
        self._largest: Motion | None = None
        self._is_lost = False
        # True once an arc from a row has no end, as across the jump of an angle where the loads read it.
        self._is_unfollowed = False

    def add(
        self,
        elapsed: Sequence[Fraction],
        truth: Motion,
        answer: Motion,
        own: Mapping[str, Column],
    ) -> None:
        """Add the next rows.

        The scales come from the exact motion ``truth``, so that an answer that diverges does not hide its
        own drift. ``own`` are the answer's exact numbers with its quaternions, from which arcs start.
        """
        scene, quick = self._scene, in_mpfr(answer)
        is_steady = not any(self._is_balanced(invariant) for invariant in self._invariants)
        self._is_lost = self._is_lost or not (is_steady or _is_finite(answer))
        moved = in_mpfr(truth)
        has_arcs = not (is_steady or self._is_lost)
        with precision():
            self._widen(without_damping(scene, moved, elapsed))
        ends = self._ends_of_arcs(elapsed, moved, quick, own) if has_arcs else None
        with precision():
            quick = without_damping(scene, quick, elapsed)
            assert self._largest is not None
            for invariant in self._invariants:
                if invariant.name in self._worked:
                    change = invariant.value(quick) - invariant.value(moved)
                elif invariant.is_conserved:
                    change = invariant.value(quick) - invariant.value(self._begin)[0]
                elif ends is None:
                    change = to_mpfr(np.array([mp.nan] * len(elapsed), dtype=object))
                else:
                    change = self._balance(invariant, quick, ends)
                scale, is_vector = invariant.scale(self._largest), change.ndim > 1
                sizes = sqrt(np.sum(change * change, axis=1)) if is_vector else abs(change)
                self._series[invariant.name].add(sizes, scale)
                if not is_vector:
                    self._changes[invariant.name] = float(change[-1] / scale)

    def errors(self) -> list[tuple[Invariant, Errors]]:
        """Return the drifts of all rows; NaN for all rows if one row of a loaded body is not finite.

        Balances are known to no digit if an arc from a row has no end.
        """
        drifts = []
        for invariant in self._invariants:
            name = invariant.name
            with precision():
                values, scale = self._series[name].joined()
            if self._is_lost:
                values = np.full(len(values), np.nan)
            parts = {name: to_mpf(np.array([scale], dtype=object))[0]}
            widths, change = np.zeros(len(values)), self._changes.get(name)
            if self._is_unfollowed and not self._is_lost and self._is_balanced(invariant):
                values, widths, change = widths, np.full(len(values), np.inf), None
            errors = Errors(name, f"scale of {name}", values, widths, parts, change=change)
            drifts.append((invariant, errors))
        return drifts

    def _is_balanced(self, invariant: Invariant) -> bool:
        return not invariant.is_conserved and invariant.name not in self._worked

    def _widen(self, truth: Motion) -> None:
        rows = truth.at(decisive(self._scene, truth))
        if self._largest is not None:
            rows = joined(self._largest, rows)
        self._largest = rows.at(decisive(self._scene, rows))

    def _balance(self, invariant: Invariant, answer: Motion, ends: Motion) -> Column:
        increments = invariant.value(answer) - invariant.value(ends)
        if invariant.name in self._sums:
            increments[0] = self._sums[invariant.name] + increments[0]
        sums = np.cumsum(increments, axis=0)
        self._sums[invariant.name] = sums[-1]
        return sums

    def _ends_of_arcs(self, *rows: Any) -> Motion | None:
        """Return the ends of the arcs from row to row; None if one of them has none, for all rows."""
        if not self._is_unfollowed:
            with suppress(Unsettled):
                return self._arc_ends(*rows)
        self._is_unfollowed = True
        return None

    def _arc_ends(
        self,
        elapsed: Sequence[Fraction],
        truth: Motion,
        answer: Motion,
        own: Mapping[str, Column],
    ) -> Motion:
        """Return the exact motion at each sample that starts from the sample before, or from the start.

        It is computed as a neighbour of the scene's exact motion if it is close to it, or if every balance
        is so far from zero that few digits tell it; else enclosed.
        """
        scene, end, last = self._arc_scene, self._end, [len(elapsed) - 1]
        begins = (end.time, *elapsed[:-1])
        spans = [b - a for a, b in zip(begins, elapsed, strict=True)]
        with precision():
            earlier, beside = (
                joined(before, rows).at(range(len(elapsed)))
                for before, rows in ((end.truth, truth), (end.answer, answer))
            )
            derivatives = self._derivatives(begins, elapsed)
            near = neighbours(scene, spans, (earlier, truth), beside, derivatives)
            arc_ends = near.to(self._digits)
            if arc_ends is None:
                rough = near.to(_FEW_DIGITS)
                arc_ends = rough if rough is not None and self._is_clear(answer, rough) else None
        if arc_ends is None:
            states = _states(scene, own)
            starts = [end.state, *states[:-1]]
            arc_ends = in_mpfr(arcs(scene, starts, spans, self._digits, begins))
        (state,) = _states(scene, {name: rows[last] for name, rows in own.items()})
        self._end = _End(elapsed[-1], state, truth.at(last), answer.at(last))
        return arc_ends

    def _is_clear(self, answer: Motion, ends: Motion) -> bool:
        """Return True if every balance is far beyond the error of arcs of few digits."""
        assert self._largest is not None
        for invariant in filter(self._is_balanced, self._invariants):
            sums = np.cumsum(invariant.value(answer) - invariant.value(ends), axis=0)
            largest = max(abs(value) for value in sums.flat)
            if not largest > _CLEAR * len(sums) * invariant.scale(self._largest):
                return False
        return True

    def _derivatives(self, begins: Sequence[Fraction], ends: Sequence[Fraction]) -> Floats | None:
        """Return the derivatives of the motion over arcs under written loads; None where none are known."""
        exact = truth(self._scene, self._digits)
        return exact.derivatives(begins, ends) if isinstance(exact, Linearised) else None


# The arcs.


@dataclass(frozen=True)
class _End:
    """The last sample of a block: time, exact state of the answer, exact motion and answer."""

    time: Fraction
    state: State
    truth: Motion
    answer: Motion


def _states(scene: Scene, own: Mapping[str, Column]) -> list[State]:
    """Return the answer's samples as exact initial states."""
    columns = {
        GROUPS[name].start: [tuple(exact_value(value) for value in row) for row in rows]
        for name, rows in own.items()
    }
    samples = zip(*columns.values(), strict=True)
    return [replace(scene.initial, **dict(zip(columns, row, strict=True))) for row in samples]


def _is_finite(motion: Motion) -> bool:
    return all(
        not mp.isnan(sum(v - v for v in values.flat)) for values in motion.quantities.values()
    )
