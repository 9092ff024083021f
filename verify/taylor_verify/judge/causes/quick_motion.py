"""The motion of a scene in float64: quick where an exact one is slow, to try many times or many scenes.

What is found by it is asked again of the exact motion.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final, final

import numpy as np

from taylor_verify.judge.causes.float_answer import Places
from taylor_verify.judge.causes.many_flows import Floats, flow
from taylor_verify.judge.causes.material import are_known, equations_of
from taylor_verify.judge.conventions.axis_orders import quaternion_columns
from taylor_verify.judge.conventions.meanings import rotations
from taylor_verify.records.quantities import MOMENTA
from taylor_verify.scenes.instants import evenly
from taylor_verify.scenes.scene import Scene

# An arc turns by at most so many radians, and has so many steps. They are doubled, as often as this, until
# the ends of some arcs, evenly chosen and the longest, change by less than this part.
_ARC: Final = 2.0
_STEPS: Final = 4
_DOUBLINGS: Final = 3
_SETTLED: Final = 1e-6
_SAMPLED: Final = 16
# Arcs one behind the other, from a row to the middle between two.
MOST_ARCS: Final = 1024


@final
class QuickMotion:
    """The motion of a rounded scene in float64, in arcs from known rows.

    ``known`` has the rows by quantity, as the motion that is returned, and ``since`` their times since the
    start. Not more than ``most_arcs`` lead from a row to a time, one behind the other.
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
        self._is_dense = True
        middles, count = (self._begins[1:] + self._begins[:-1]) / 2, len(since)
        both_sides = np.concatenate([np.arange(count - 1), np.arange(1, count)])
        self._extend(both_sides, np.tile(middles, 2))

    @staticmethod
    def is_possible(scene: Scene, known: Mapping[str, Any]) -> bool:
        """Return True for a body without written loads or terms of its own, whose momenta are known."""
        has_momenta = set(MOMENTA[scene.model]) <= set(known)
        return scene.body.loads is None and are_known(scene.body) and has_momenta

    def at(self, times: Floats) -> dict[str, Floats] | None:
        """Return the motion at times since the start; None where it takes too many arcs.

        It is NaN where float64 does not follow.
        """
        first, last = self._begins[0], self._begins[-1]
        until = np.array([min(np.min(times), first), max(np.max(times), last)])
        self._extend(np.array([0, len(self._begins) - 1]), until)
        if not self._is_dense:
            return None
        begins, last = self._begins, len(self._begins) - 1
        after = np.clip(np.searchsorted(begins, times), min(1, last), last)
        before = np.maximum(after - 1, 0)
        is_before = np.abs(times - begins[before]) <= np.abs(times - begins[after])
        nearest = np.where(is_before, before, after)
        rows = self._moved(begins[nearest], self._states[nearest], times - begins[nearest])
        motion = dict(zip(self._names, np.split(rows, self._edges, axis=1), strict=True))
        if "attitude" in motion:
            motion["attitude"] = rotations(motion["attitude"])
        return motion

    def _extend(self, places: Places, until: Floats) -> None:
        """Follow some of the known states until these times, less than an arc away."""
        begins, rows = [self._begins], [self._states]
        now, states = self._begins[places], self._states[places]
        for _ in range(self._most_arcs * self._is_dense):
            omega = self._right.velocities(now, states.T[None])[0, -3:]
            with np.errstate(divide="ignore", invalid="ignore"):
                arc = _ARC / np.linalg.norm(omega, axis=0)
            goes_on = np.abs(until - now) > arc
            if not np.any(goes_on):
                break
            now, states, until, arc = (part[goes_on] for part in (now, states, until, arc))
            spans = np.copysign(arc, until - now)
            now, states = now + spans, self._moved(now, states, spans)
            begins.append(now)
            rows.append(states)
        else:
            self._is_dense = False
        together = np.concatenate(begins)
        in_order = np.argsort(together, kind="stable")
        self._begins, self._states = together[in_order], np.concatenate(rows)[in_order]

    def _moved(self, begins: Floats, states: Floats, spans: Floats) -> Floats:
        """Return the states after arcs, in as many steps as some of them need; NaN where none suffice."""
        some = np.union1d(evenly(len(spans), _SAMPLED), np.argsort(np.abs(spans))[-_SAMPLED:])
        with np.errstate(all="ignore"):
            steps, ends = _STEPS, self._ends(begins[some], states[some], spans[some], _STEPS)
            for _ in range(_DOUBLINGS):
                finer = self._ends(begins[some], states[some], spans[some], 2 * steps)
                if np.all(np.abs(finer - ends) <= _SETTLED * np.max(np.abs(finer), axis=0)):
                    is_all = len(some) == len(spans)
                    return finer if is_all else self._ends(begins, states, spans, steps)
                steps, ends = 2 * steps, finer
        return np.full_like(states, np.nan)

    def _ends(self, begins: Floats, states: Floats, spans: Floats, steps: int) -> Floats:
        return np.asarray(flow(self._right.rates, states.T[None], begins, spans, steps)[0].T)
