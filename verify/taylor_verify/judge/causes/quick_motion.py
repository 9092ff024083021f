"""The motion of a scene in float64: quick where an exact one is slow, to try many times or many scenes.

What is found by it is asked again of the exact motion.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any, Final, final

import numpy as np

from taylor_verify.judge.causes.float_answer import Places
from taylor_verify.judge.causes.many_flows import Floats, cubic, flow
from taylor_verify.judge.causes.material import are_known, equations_of
from taylor_verify.judge.conventions.axis_orders import quaternion_columns
from taylor_verify.judge.conventions.meanings import rotations
from taylor_verify.records.quantities import MOMENTA
from taylor_verify.scenes.instants import evenly
from taylor_verify.scenes.scene import Scene

# The states at times.
Course = Callable[[Floats], Any]

# From a known row the motion is followed in arcs that turn by about so many radians, or change the momenta
# by as large a part. An arc has so many steps, doubled as often as this until the ends of some arcs, evenly
# chosen and the longest, change by less than this part.
_ARC: Final = 1.0
_STEPS: Final = 1
_DOUBLINGS: Final = 8
_SETTLED: Final = 1e-6
_SAMPLED: Final = 16
# Arcs one behind the other, from a row to the middle between two.
MOST_ARCS: Final = 1024
# Gaps between known states are halved until a cubic foretells the state in the middle to this part. Each
# halving makes a cubic 16 times better.
_FORETOLD: Final = 1e-6
_MOST_STATES: Final = 1 << 16
# What is taken for the size of quantities: a unit quaternion changes by half the angle of a turn, and the
# path follows from the others.
_SIZES: Final = {"attitude": 0.5, "centre": np.inf}


@final
class QuickMotion:
    """The motion of a rounded scene in float64, in arcs from known rows.

    ``known`` has the rows by quantity, as the motion that is returned, and ``since`` their times since the
    start. Between them runs a cubic, through more states where it needs them. Not more than ``most_arcs``
    lead from a row to a time, one behind the other.
    """

    def __init__(
        self,
        scene: Scene,
        known: Mapping[str, Any],
        since: Floats,
        most_arcs: int = MOST_ARCS,
    ) -> None:
        groups = (*MOMENTA[scene.model], "attitude", "centre")
        rows = {name: np.asarray(known[name].astype(float)) for name in groups if name in known}
        if "attitude" in rows:
            q = quaternion_columns(rows["attitude"])
            rows["attitude"] = q / np.linalg.norm(q, axis=1, keepdims=True)
        self._right = equations_of(scene, has_momenta=scene.model == "kirchhoff")
        self._names, self._most_arcs = [*rows], most_arcs
        self._edges = np.cumsum([part.shape[1] for part in rows.values()])[:-1]
        order = np.argsort(since)
        self._begins, self._states = since[order], np.hstack([*rows.values()])[order]
        largest = {name: np.max(np.linalg.norm(part, axis=1)) for name, part in rows.items()}
        self._sizes = [_SIZES.get(name, size or np.inf) for name, size in largest.items()]
        self._course: Course | None = None
        self._is_lost = not self._extend(*self._to_middles())

    @staticmethod
    def is_possible(scene: Scene, known: Mapping[str, Any]) -> bool:
        """Return True for a body without written loads or terms of its own, whose momenta are known."""
        has_momenta = set(MOMENTA[scene.model]) <= set(known)
        return scene.body.loads is None and are_known(scene.body) and has_momenta

    def at(self, times: Floats) -> dict[str, Floats] | None:
        """Return the motion at times since the start; None where it takes too many arcs.

        Nor is there one where float64 does not follow. The motion at other times is none the worse.
        """
        first, last = self._begins[0], self._begins[-1]
        until = np.array([min(np.min(times), first), max(np.max(times), last)])
        if self._is_lost:
            return None
        if self._course is None or np.any(until != (first, last)):
            before = self._begins, self._states, self._course
            is_reached = self._extend(np.array([0, len(self._begins) - 1]), until)
            self._course = self._through() if is_reached else None
            if self._course is None:
                self._begins, self._states, self._course = before
                return None
        rows = np.asarray(self._course(times))
        motion = dict(zip(self._names, np.split(rows, self._edges, axis=1), strict=True))
        if "attitude" in motion:
            motion["attitude"] = rotations(motion["attitude"])
        return motion

    def _to_middles(self) -> tuple[Places, Floats]:
        """Return the known states before and after each gap of several arcs, and its middle for both."""
        middles = (self._begins[1:] + self._begins[:-1]) / 2
        far = np.flatnonzero(
            np.diff(self._begins) > 2 * self._arcs(self._begins, self._states)[:-1]
        )
        return np.concatenate([far, far + 1]), np.tile(middles[far], 2)

    def _arcs(self, begins: Floats, states: Floats) -> Floats:
        """Return how long each state may be followed in one arc."""
        rates = np.split(self._rates(begins, states), self._edges, axis=1)
        parts = zip(rates, self._sizes, strict=True)
        paces = [np.linalg.norm(rate, axis=1) / size for rate, size in parts]
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.asarray(_ARC / np.max(paces, axis=0))

    def _rates(self, times: Floats, states: Floats) -> Floats:
        return np.asarray(self._right.rates(times, states.T[None])[0].T)

    def _extend(self, places: Places, until: Floats) -> bool:
        """Follow some of the known states until these times; False if that takes too many arcs."""
        begins, rows = [self._begins], [self._states]
        now, states = self._begins[places], self._states[places]
        for _ in range(self._most_arcs):
            goes_on = now != until
            if not np.any(goes_on):
                break
            now, states, until = now[goes_on], states[goes_on], until[goes_on]
            arcs = self._arcs(now, states)
            is_last = ~(np.abs(until - now) > arcs)
            then = np.where(is_last, until, now + np.copysign(arcs, until - now))
            now, states = then, self._moved(now, states, then - now)
            begins.append(now)
            rows.append(states)
        else:
            return False
        self._begins, places = np.unique(np.concatenate(begins), return_index=True)
        self._states = np.concatenate(rows)[places]
        return True

    def _through(self) -> Course | None:
        """Return the course through the known states, and through as many between them as it needs."""
        t, states, gaps = self._begins, self._states, np.arange(len(self._begins) - 1)
        if not np.all(np.isfinite(states)):
            return None
        if not len(gaps):
            return lambda times: np.repeat(states, len(times), axis=0)
        states, size = self._with_steady_signs(t, states), self._largest(states)
        while len(t) < _MOST_STATES:
            course = partial(cubic, t, states, self._rates(t, states))
            middles = (t[gaps] + t[gaps + 1]) / 2
            between = self._moved(t[gaps], states[gaps], middles - t[gaps])
            is_off = np.any(np.abs(between - course(middles)) > _FORETOLD * size, axis=1)
            is_off &= (t[gaps] < middles) & (middles < t[gaps + 1])
            if not np.all(np.isfinite(between)):
                return None
            if not np.any(is_off):
                self._begins, self._states = t, states
                return course
            gaps, middles, between = gaps[is_off], middles[is_off], between[is_off]
            t, states = (
                np.insert(t, gaps + 1, middles),
                np.insert(states, gaps + 1, between, axis=0),
            )
            gaps = gaps + np.arange(len(gaps))
            gaps = np.sort(np.concatenate([gaps, gaps + 1]))
        return None

    def _with_steady_signs(self, t: Floats, states: Floats) -> Floats:
        """Return states with the signs of quaternions to which the motion leads, one from the other."""
        if "attitude" not in self._names:
            return states
        begin = int(self._edges[self._names.index("attitude") - 1])
        q = np.s_[:, begin : begin + 4]
        ends = self._moved(t[:-1], states[:-1], np.diff(t))
        signs = np.where(np.sum(ends[q] * states[1:][q], axis=1) < 0, -1.0, 1.0)
        steady = states.copy()
        steady[1:][q] *= np.cumprod(signs)[:, None]
        return steady

    def _largest(self, states: Floats) -> Floats:
        """Return the largest component of each vector, once for each of its components."""
        parts = np.split(states, self._edges, axis=1)
        return np.concatenate([np.full(part.shape[1], np.max(np.abs(part))) for part in parts])

    def _moved(self, begins: Floats, states: Floats, spans: Floats) -> Floats:
        """Return the states after arcs, in as many steps as some of them need; NaN where none suffice."""
        some = np.union1d(evenly(len(spans), _SAMPLED), np.argsort(np.abs(spans))[-_SAMPLED:])
        with np.errstate(all="ignore"):
            steps, ends = _STEPS, self._ends(begins[some], states[some], spans[some], _STEPS)
            for _ in range(_DOUBLINGS):
                finer = self._ends(begins[some], states[some], spans[some], 2 * steps)
                if np.all(np.abs(finer - ends) <= _SETTLED * self._largest(finer)):
                    is_all = len(some) == len(spans)
                    return finer if is_all else self._ends(begins, states, spans, steps)
                steps, ends = 2 * steps, finer
        return np.full_like(states, np.nan)

    def _ends(self, begins: Floats, states: Floats, spans: Floats, steps: int) -> Floats:
        return np.asarray(flow(self._right.rates, states.T[None], begins, spans, steps)[0].T)
