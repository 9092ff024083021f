"""The cause of a wrong angular velocity: an engine's treatment of the gyroscopic term omega x I omega.

Rigid-body engines leave the term out, or take it explicitly (forward Euler), or implicitly (one step of
Newton's method for backward Euler). Each treatment is a map of one step, and what it would give is
computed from every row of the file to the next one. The local defect of a row is

    defect = omega_k+1 - flow(omega_k),

with flow the motion by Euler's equations over the same time. A treatment is the cause if it leaves next
to nothing of all defects. Rows need not be the steps: the step h that fits best is looked for, since
the defect of a method of first order is nearly proportional to h.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import ceil
from typing import Any, Final

import numpy as np

from taylor_verify.exact.looks import evenly
from taylor_verify.exact.route import solution
from taylor_verify.judge.conventions.readings import readings, rotations
from taylor_verify.judge.conventions.search import Conventions
from taylor_verify.judge.shift import LEAVES
from taylor_verify.models.problem import adopt
from taylor_verify.records.answers import LikelyCause
from taylor_verify.scenes.bodies import RigidBody
from taylor_verify.scenes.precision import Rung
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.file import TrajectoryFile

Floats = np.ndarray[Any, np.dtype[np.float64]]

# So many pairs of rows, evenly chosen, stand for all; a single pair may agree by chance.
_MOST_PAIRS: Final = 24
_FEWEST_PAIRS: Final = 2
# The classical Runge-Kutta method with this part of a radian a step follows the flow to ten digits.
_FLOW_STEP: Final = 0.01
# The search for h begins with this part of a radian, where a method of first order is in its regime.
_FIRST_STEP: Final = 0.05
_SEARCHES: Final = 6
# Two steps that are as near as this are one.
_SAME_STEP: Final = 1e-3
# No more steps than this are made from one row to the next.
_MOST_STEPS: Final = 5_000
_DIGITS: Final = 20


@dataclass(frozen=True)
class _Body:
    """I, its inverse K and the constant moment M, in the scene's body axes."""

    inertia: Floats
    inverse: Floats
    moment: Floats

    @classmethod
    def of(cls, body: RigidBody) -> _Body:
        inertia, inverse = (
            np.array([[float(entry) for entry in row] for row in matrix])
            for matrix in (body.inertia, body.inverse_inertia)
        )
        return cls(inertia, inverse, np.array([float(entry) for entry in body.moment]))

    def torque(self, omega: Floats) -> Floats:
        """M - omega x I omega for every row."""
        found: Floats = self.moment - np.cross(omega, omega @ self.inertia)
        return found

    def rate(self, omega: Floats) -> Floats:
        found: Floats = self.torque(omega) @ self.inverse
        return found

    def pace(self, omega: Floats) -> float:
        """A bound of the rate of turn, in radians per unit of time."""
        ratio = np.linalg.norm(self.inertia, 2) * np.linalg.norm(self.inverse, 2)
        loads = np.sqrt(np.linalg.norm(self.inverse @ self.moment))
        return float(ratio * np.max(np.linalg.norm(omega, axis=1)) + loads)


# One step of length h (n, 1) from every row of omega (n, 3).
_Step = Callable[[_Body, Floats, Floats], Floats]


def _without(body: _Body, omega: Floats, h: Floats) -> Floats:
    return omega + h * (body.inverse @ body.moment)


def _explicit(body: _Body, omega: Floats, h: Floats) -> Floats:
    return omega + h * body.rate(omega)


def _explicit_of_fixed_size(body: _Body, omega: Floats, h: Floats) -> Floats:
    before = omega @ body.inertia
    after = before + h * body.torque(omega)
    old, new = (np.linalg.norm(rows, axis=1, keepdims=True) for rows in (before, after))
    found: Floats = (
        after * np.divide(old, new, out=np.ones_like(old), where=new > 0)
    ) @ body.inverse
    return found


def _implicit(body: _Body, omega: Floats, h: Floats) -> Floats:
    """(I + h ([omega]x I - [I omega]x)) (omega' - omega) = h (M - omega x I omega)."""
    slope = _cross(omega) @ body.inertia - _cross(omega @ body.inertia)
    right = (h * body.torque(omega))[:, :, None]
    found: Floats = omega + np.linalg.solve(body.inertia + h[:, :, None] * slope, right)[:, :, 0]
    return found


def _runge_kutta(body: _Body, omega: Floats, h: Floats) -> Floats:
    k1 = body.rate(omega)
    k2 = body.rate(omega + h / 2 * k1)
    k3 = body.rate(omega + h / 2 * k2)
    return omega + h / 6 * (k1 + 2 * k2 + 2 * k3 + body.rate(omega + h * k3))


def _cross(vectors: Floats) -> Floats:
    """The matrices [v]x with [v]x u = v x u."""
    matrices = np.zeros((len(vectors), 3, 3))
    for i, k, m in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        matrices[:, m, k], matrices[:, k, m] = vectors[:, i], -vectors[:, i]
    return matrices


_STEPS: Final[tuple[tuple[str, str, _Step], ...]] = (
    (
        "explicit gyroscopic step",
        "a step is omega + h I^-1 (M - omega x I omega), forward Euler on the gyroscopic term",
        _explicit,
    ),
    (
        "explicit gyroscopic step",
        "a step adds h (M - omega x I omega) to I omega, and restores its size",
        _explicit_of_fixed_size,
    ),
    (
        "implicit gyroscopic step",
        "a step is one of Newton's method for backward Euler on the gyroscopic term",
        _implicit,
    ),
)


def gyroscopic_cause(
    file: TrajectoryFile, scene: Scene, rung: Rung, conventions: Conventions
) -> tuple[LikelyCause, ...]:
    """Return the treatment of the gyroscopic term that explains the file's omega; nothing if none does."""
    body = scene.body
    if not isinstance(body, RigidBody) or body.manufactured or "omega" not in file.groups:
        return ()
    first = _paired(file)
    if len(first) < _FEWEST_PAIRS:
        return ()
    earlier, later = file.at(first), file.at([k + 1 for k in first])
    spans = [[float(t) for t in conventions.world.times(half.times)] for half in (earlier, later)]
    with np.errstate(all="ignore"):  # an answer that runs away has no cause here
        begin, end = (_angular_velocity(h, scene, rung, conventions) for h in (earlier, later))
        found = _cause(_Body.of(body), begin, end, np.subtract(spans[1], spans[0])[:, None])
    return () if found is None else (found,)


def _paired(file: TrajectoryFile) -> list[int]:
    """Return some rows, evenly chosen, that are finite as the next one is."""
    first = np.flatnonzero(file.finite[:-1] & file.finite[1:])
    return [int(first[k]) for k in evenly(len(first), _MOST_PAIRS)] if len(first) else []


def _angular_velocity(
    file: TrajectoryFile, scene: Scene, rung: Rung, conventions: Conventions
) -> Floats:
    """omega in body axes; from space axes it is taken by the file's own attitude, if it has one."""
    rows = _floats(file, "omega")
    reading = conventions.readings.get("omega")
    return (
        rows if reading is None else reading.read(rows, _attitudes(file, scene, rung, conventions))
    )


def _attitudes(file: TrajectoryFile, scene: Scene, rung: Rung, conventions: Conventions) -> Floats:
    for group in ("quaternion", "attitude"):
        if group in file.groups:
            reading = conventions.readings.get(group, readings(group)[0])
            read = reading.read(_floats(file, group), np.empty(0))
            return rotations(read) if group == "quaternion" else read
    given = adopt(scene, rung, conventions.world.times(file.times)).given
    tracked = replace(given, track=frozenset({"attitude"}))
    found: Floats = (
        solution(tracked).evaluate(given.clock.elapsed, _DIGITS)["attitude"].astype(float)
    )
    return found


def _floats(file: TrajectoryFile, group: str) -> Floats:
    return file.rows[group].doubles()


def _cause(body: _Body, begin: Floats, end: Floats, spans: Floats) -> LikelyCause | None:
    pace, longest = body.pace(begin), float(np.max(np.abs(spans)))
    steps = ceil(longest * pace / _FLOW_STEP) if np.isfinite(pace) else _MOST_STEPS + 1
    if steps > _MOST_STEPS:
        return None
    flow = _moved(_runge_kutta, body, begin, spans, np.full(len(spans), max(steps, 1)))
    defect = end - flow
    left = _left(_without(body, begin, spans) - flow, defect)
    if left <= LEAVES:
        why = "from row to row omega changes by I^-1 M alone, without omega x I omega"
        return _likely("no gyroscopic term", why, left)
    fits = [
        (*_best_step(step, body, begin, spans, flow, defect), words, why)
        for words, why, step in _STEPS
    ]
    left, h, words, why = min(fits)
    return _likely(words, f"{why}, with h = {h:.3g}", left) if left <= LEAVES else None


def _likely(name: str, why: str, left: float) -> LikelyCause:
    share = f"this explains {100 * (1 - left):.3g} % of the error of omega"
    return LikelyCause(name, "omega", left, f"{name}: {why}; {share}")


def _left(made: Floats, defect: Floats) -> float:
    """The part of the largest defect that is left without what a treatment makes of it."""
    largest = float(np.max(np.linalg.norm(defect, axis=1)))
    left = float(np.max(np.linalg.norm(defect - made, axis=1)))
    return left / largest if largest > 0 and np.isfinite(left) else np.inf


def _best_step(
    step: _Step, body: _Body, begin: Floats, spans: Floats, flow: Floats, defect: Floats
) -> tuple[float, float]:
    """What the best step leaves, and this step; the search ends where a step repeats itself."""
    longest = float(np.max(np.abs(spans)))
    h, best = min(longest, _FIRST_STEP / (body.pace(begin) or 1.0)), (np.inf, 0.0)
    for _ in range(_SEARCHES):
        counts = np.maximum(1, np.rint(np.abs(spans[:, 0]) / h)).astype(int)
        if np.max(counts) > _MOST_STEPS:
            break
        made = _moved(step, body, begin, spans, counts) - flow
        best = min(best, (_left(made, defect), longest / float(np.max(counts))))
        scale = float(np.sum(defect * made) / (np.sum(made**2) or np.inf))
        further = min(longest, h * scale)
        if not further > 0 or abs(further - h) <= _SAME_STEP * h:
            break
        h = further
    return best


def _moved(step: _Step, body: _Body, omega: Floats, spans: Floats, counts: Any) -> Floats:
    """omega after so many steps of each row, which together make its span."""
    h = spans / counts[:, None]
    for k in range(int(np.max(counts))):
        omega = np.where((k < counts)[:, None], step(body, omega, h), omega)
    return omega
