"""Simulators with one known fault, in plain code that shares nothing with the search for causes.

A simulator integrates M v' = (M v + h) x w + ... by SciPy's DOP853, or by steps of its own.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from taylor_verify_reports.studies.causes.bodies import Acting, Floats, Sample


class Rows(NamedTuple):
    """The rows of an answer: v, unit quaternions and the centre at some times.

    ``mass`` is the matrix of the simulator, by which it writes momenta; without it, that of the scene.
    """

    times: Floats
    v: Floats
    q: Floats
    c: Floats | None = None
    mass: Floats | None = None


@dataclass
class Law:
    """The numbers that a simulator uses; a fault changes some of them."""

    mass: Floats
    coriolis: Floats
    munk: Floats
    rotor: Floats
    load: Floats
    space: Floats
    linear: Floats
    quadratic: Floats
    acting: Acting
    clock: float = 1.0
    damping: float = 0.0
    from_time: float = -np.inf
    until_time: float = np.inf
    loads_of: Callable[[float, Floats], Floats] | None = None
    turn: Callable[[Floats, Floats], Floats] | None = field(default=None)
    # The rate of the centre by R, the velocity and the current, where it is another.
    path: Callable[[Floats, Floats, Floats], Floats] | None = field(default=None)


def law(sample: Sample) -> Law:
    """Return the right law of a sample."""
    n, zeros = sample.n, np.zeros(sample.n)
    mass = sample.mass.copy()
    return Law(
        mass,
        mass.copy(),
        mass[:3].copy(),
        sample.rotor.copy(),
        sample.load.copy() if n == 3 else zeros.copy(),
        zeros.copy(),
        zeros.copy(),
        zeros.copy(),
        sample.acting,
    )


def cross(a: Floats, b: Floats) -> Floats:
    """Return the product of two vectors; NumPy's, for arrays of any shape, takes twenty times as long."""
    (x, y, z), (u, v, w) = a.tolist(), b.tolist()
    return np.array([y * w - z * v, z * u - x * w, x * v - y * u])


def skew(a: Floats) -> Floats:
    """Return the matrix of a x."""
    return np.array([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]])


def rates(law: Law, t: float, v: Floats, q: Floats, own: Floats) -> Floats:
    """Return v' of omega or of U and Omega; ``own`` are the states of the scene's own."""
    n, w = len(v), v[-3:]
    momentum = law.coriolis @ v
    force = np.empty(n)
    force[-3:] = cross(momentum[-3:] + law.rotor, w)
    if n == 6:
        force[:3] = cross(momentum[:3], w)
        force[3:] += cross(law.munk @ v, v[:3])
    turn = rotation(q)
    extra = (
        law.load
        + law.acting.load(t, v, q / np.linalg.norm(q), own)
        - law.linear * v
        - law.quadratic * np.abs(v) * v
    )
    for i in range(0, n, 3):
        extra[i : i + 3] += turn.T @ law.space[i : i + 3]
    if law.loads_of is not None:
        extra = extra + law.loads_of(t, v)
    if not law.from_time <= t < law.until_time:
        extra = 0 * extra
    return np.asarray(law.clock * (np.linalg.solve(law.mass, force + extra) - law.damping * v))


def _rates_at(law: Law, t: float, q: Floats, v: Floats) -> Floats:
    return rates(law, t, v, q, law.acting.start)


def rotation(q: Floats) -> Floats:
    """Return the rotation matrix of a quaternion of any length."""
    a, b, c, d = q / np.linalg.norm(q)
    return np.array(
        [
            [a * a + b * b - c * c - d * d, 2 * (b * c - a * d), 2 * (b * d + a * c)],
            [2 * (b * c + a * d), a * a - b * b + c * c - d * d, 2 * (c * d - a * b)],
            [2 * (b * d - a * c), 2 * (c * d + a * b), a * a - b * b - c * c + d * d],
        ]
    )


def turned(q: Floats, w: Floats) -> Floats:
    """Return q' = q w / 2."""
    return 0.5 * np.array([-q[1:] @ w, *(q[0] * w + cross(q[1:], w))])


def integrated(
    sample: Sample,
    law: Law,
    times: Floats | None = None,
    method: str = "DOP853",
    rtol: float = 3e-14,
) -> Rows:
    """Return the rows of a fine integration of a law, or of a coarse one by another method.

    A motion that ends on the way has rows of NaN.
    """
    from scipy.integrate import solve_ivp

    n, times = sample.n, sample.times if times is None else times
    turn, path = law.turn or turned, law.path or (lambda turn, v, current: turn @ v + current)

    def slope(t: float, z: Floats) -> Floats:
        v, q, _, own = np.split(z, (n, n + 4, n + 7))
        turning = law.clock * turn(q, v[-3:])
        going = path(rotation(q), v[:3], sample.current) if n == 6 else np.zeros(3)
        own_rate = law.acting.rate(t, v, q / np.linalg.norm(q), own)
        return np.concatenate([rates(law, t, v, q, own), turning, law.clock * going, own_rate])

    q0 = sample.q0 / np.linalg.norm(sample.q0)
    z0 = np.concatenate([sample.v0, q0, np.zeros(3), law.acting.start])
    parts: list[Floats] = []
    for begin, end in pairwise(_edges(law, float(sample.times[0]), float(times[-1]))):
        v, q, _, own = np.split(z0, (n, n + 4, n + 7))
        z0[n + 7 :] = law.acting.taken(begin, v, q / np.linalg.norm(q), own)
        inside = times[(times > begin) & (times <= end)] if parts else times[times <= end]
        ask = np.union1d(inside, [end])
        solved = solve_ivp(slope, (begin, end), z0, method, t_eval=ask, rtol=rtol, atol=1e-3 * rtol)
        if not solved.success:
            return _rows(times, np.full((len(times), n + 7), np.nan), law)
        parts.append(solved.y.T[np.isin(ask, inside)])
        z0 = solved.y[:, -1]
    return _rows(times, np.vstack(parts)[:, : n + 7], law)


def _edges(law: Law, begin: float, end: float) -> list[float]:
    """Return the ends of the pieces in which the equations are smooth."""
    every = law.acting.every
    instants: Any = np.arange(begin, end, every) if every else ()
    inside = {
        t
        for t in (law.from_time, law.until_time, *law.acting.switches, *instants)
        if begin < t < end
    }
    return [begin, *sorted(map(float, inside)), end]


def stepped(
    sample: Sample,
    step: Callable[[Callable[[Floats], Floats], Floats, float], Floats],
    update: Callable[[Floats, Floats, Floats, float], Floats],
    steps: int,
    of: Law | None = None,
) -> Rows:
    """Return the rows of a one-step method, so many steps from row to row."""
    used = of or law(sample)
    v, q = sample.v0.copy(), sample.q0 / np.linalg.norm(sample.q0)
    rows = [np.concatenate([v, q])]
    for begin, end in zip(sample.times[:-1], sample.times[1:], strict=True):
        h = (end - begin) / steps
        for k in range(steps):
            now = begin + k * h
            after = step(partial(_rates_at, used, now, q), v, h)
            q = update(q, v[-3:], after[-3:], h)
            q, v = q / np.linalg.norm(q), after
        rows.append(np.concatenate([v, q]))
    return _rows(sample.times, np.array(rows), used)


def stepped_together(
    sample: Sample, step: Callable[[Callable[[Floats], Floats], Floats, float], Floats], steps: int
) -> Rows:
    """Return the rows of a one-step method of v, q and own states at once; q is a unit after each step."""
    used, n = law(sample), sample.n
    acting = used.acting

    def slope(z: Floats) -> Floats:
        t, v, q, own = z[0], *np.split(z[1:], (n, n + 4))
        own_rate = acting.rate(t, v, q / np.linalg.norm(q), own)
        return np.concatenate([[1.0], rates(used, t, v, q, own), turned(q, v[-3:]), own_rate])

    v, q, own = sample.v0, sample.q0 / np.linalg.norm(sample.q0), acting.start
    rows = [np.concatenate([v, q])]
    for begin, end in pairwise(sample.times):
        own, h = acting.taken(begin, v, q, own), (end - begin) / steps
        for k in range(steps):
            z = step(slope, np.concatenate([[begin + k * h], v, q, own]), h)
            v, q, own = np.split(z[1:], (n, n + 4))
            q = q / np.linalg.norm(q)
        rows.append(np.concatenate([v, q]))
    return _rows(sample.times, np.array(rows), used)


def _rows(times: Floats, z: Floats, law: Law) -> Rows:
    n = len(law.mass)
    q, c = z[:, n : n + 4], z[:, n + 4 :]
    return Rows(times, z[:, :n], q / np.linalg.norm(q, axis=1, keepdims=True), c, law.mass)


def printed(values: Floats, digits: int) -> tuple[Floats, Any]:
    """Return numbers rounded to so many digits, and half a unit of each column's last place."""
    largest = np.max(np.abs(values), axis=0)
    if digits >= 16:
        return values, 2.0**-53 * largest
    texts = np.array([[float(f"{x:.{digits}g}") for x in row] for row in values])
    unit = 10.0 ** (np.floor(np.log10(np.where(largest > 0, largest, 1.0))) + 1 - digits)
    return texts, 0.5 * unit
