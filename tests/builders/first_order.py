"""First-order engines in a few lines: semi-implicit Euler with each treatment of the gyroscopic term."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from builders.integrators import turned
from builders.numbers import cross
from builders.trajectories import QUATERNION, VECTORS, Columns, named
from taylor_verify.scenes.reading.reader import load

Array = np.ndarray[Any, Any]
# omega after a step of length h, from I, the momentum of the wheels, omega, the moment M and h.
Kick = Callable[[Array, Array, Array, Array, float], Array]


def none(inertia: Array, rotor: Array, w: Array, moment: Array, h: float) -> Array:
    return w + h * np.linalg.solve(inertia, moment)


def explicit(inertia: Array, rotor: Array, w: Array, moment: Array, h: float) -> Array:
    return w + h * np.linalg.solve(inertia, moment - cross(w, inertia @ w + rotor))


def without_wheels(inertia: Array, rotor: Array, w: Array, moment: Array, h: float) -> Array:
    """An implicit step that knows nothing of the wheels."""
    return implicit(inertia, 0 * rotor, w, moment, h)


def implicit(inertia: Array, rotor: Array, w: Array, moment: Array, h: float) -> Array:
    """One step of Newton's method for I (w' - w) = h (M - w' x (I w' + rotor))."""
    momentum = inertia @ w + rotor
    slope = np.column_stack([cross(e, momentum) + cross(w, inertia @ e) for e in np.eye(3)])
    return w + h * np.linalg.solve(inertia + h * slope, moment - cross(w, momentum))


def engine(scene: str, kick: Kick, h: float, rows: int, every: int = 1) -> Columns:
    """Rows of t, omega in body axes and a unit quaternion; a row after every so many steps."""
    given = load(scene)
    inertia = np.array(given.body.inertia, dtype=float)
    moment = np.array(given.body.moment, dtype=float)
    rotor = np.array(given.body.rotor, dtype=float)
    w = np.array(given.initial.omega, dtype=float)
    q = np.array(given.initial.attitude, dtype=float)
    q /= np.linalg.norm(q)
    start, states = float(given.clock.start), []
    for step in range((rows - 1) * every + 1):
        if step % every == 0:
            states.append([start + step * h, *w, *q])
        w = kick(inertia, rotor, w, moment, h)
        q = turned(q, h * w)
        q /= np.linalg.norm(q)
    table = np.array(states)
    columns = named(("t",), table[:, :1])
    return columns | named(VECTORS["omega"], table[:, 1:4]) | named(QUATERNION, table[:, 4:])
