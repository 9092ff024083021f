"""Runs of steps that add nearly the same amount to a component, so that their roundings are alike.

A step rounds x + h x' to a multiple of the unit in the last place, 2 u |x|. The error depends on the
increment h x' modulo this unit. From step to step the increment changes by h^2 x''. Where this is far
below the unit, successive errors have one sign and nearly one size, and they add up in proportion to the
number of steps. They keep their sign until the increment has changed by half a unit:

    sum over the steps of the run of h^2 |x''| / (2 u |x|) = 1/2.

If one step changes the increment by more, its rounding is independent of the one before, as on a generic
orbit. The sum of k equal errors has the square k^2, so the k-th step of a run adds 2k - 1 squares.

A step does not lose more than it adds, so errors are alike only up to the size h |x'| where this is below
the rounding. With damping c a step of the answer adds up to h c |x| even where the exact motion rests.
"""

from __future__ import annotations

from typing import Any, Final, NamedTuple

import numpy as np

from taylor_verify.exact.conditioning.condition import Path
from taylor_verify.exact.conditioning.linearised import applied
from taylor_verify.exact.conditioning.loaded import is_of_run
from taylor_verify.exact.rates import rates
from taylor_verify.exact.route import solution
from taylor_verify.numbers.precision import floor_log2
from taylor_verify.scenes.loads.states import Held

Floats = np.ndarray[Any, np.dtype[np.float64]]

# Steps are independent from a change of half a unit on. A larger change than this makes no difference.
_MOST_UNITS: Final = 1e3
# The path is known in float64: terms that cancel leave less than this part of their sum.
_NOISE: Final = 2.0**-40
# A difference of differences shows a bend that is larger than this, over the noise.
_ROUGH: Final = 2.0**20
_FEWEST: Final = 3
# Digits of the centre's motion, whose derivatives are needed in float64.
_DIGITS: Final = 15


class Course(NamedTuple):
    """Components of a path with their ``rate`` and ``bend``, x' and x'', in units of the flow's time.

    All have the shape (n, components), in the path's units. A turn of the frame stands for a quaternion.
    """

    x: Floats
    rate: Floats
    bend: Floats


def with_repeats(rounded: Floats, path: Path, steps_at: Floats, steps: int, bits: int) -> Floats:
    """Return the size of each step's rounding, with the alike roundings before it.

    ``rounded`` is the size of one rounding, shape (n, components), in the path's units.
    """
    h = abs(float(path.elapsed[-1] / path.flow.time)) / steps
    x, rate, bend = (abs(np.hstack(columns)) for columns in zip(*_courses(path), strict=True))
    rate += abs(float(path.scene.body.damping * path.flow.time)) * x
    with np.errstate(all="ignore"):
        units = np.where(bend > 0, np.ldexp(h * h * bend / x, bits - 1), 0.0)
        alike = np.minimum(rounded, np.ldexp(h * rate, bits))
    changes = np.minimum(units, _MOST_UNITS).T
    more = np.column_stack([_squares(change, steps_at) for change in changes]) - 1
    sizes: Floats = np.sqrt(rounded**2 + more * alike**2)
    return sizes


def _squares(change: Floats, steps_at: Floats) -> Floats:
    """Return the squares that a step before each time adds, at least one.

    ``change`` is that of the increment from step to step at each time, in units in the last place.
    """
    steps = np.cumsum(steps_at) - steps_at[0]
    changed = np.cumsum(np.diff(steps, prepend=0.0) * (change + np.roll(change, 1)) / 2)
    run = steps - np.interp(changed - 0.5, changed, steps)
    squares: Floats = np.maximum(1.0, run + np.roll(run, 1))
    squares[0] = 1.0
    return squares


# The derivatives of the components.


def _courses(path: Path) -> list[Course]:
    """Return the courses of the momenta, of attitude and centre as far as tracked, and of own states.

    Under written loads derivatives are differences along the path.
    """
    scene = path.scene
    courses = [_momenta(path) if scene.body.loads is None else _differences(path, path.momentum)]
    if "attitude" in path.blocks:
        courses.append(_turns(path, courses[0]))
    if "centre" in path.blocks:
        courses.append(_centre(path))
    taken = {state.name for state in scene.own_states if isinstance(state, Held)}
    for name, rows in path.carried.own.items():
        x = rows / float(path.units[name])
        still = np.zeros_like(x)
        courses.append(Course(x, still, still) if name in taken else _differences(path, x))
    return courses


def _differences(path: Path, x: Floats) -> Course:
    if len(x) < _FEWEST:
        return Course(x, np.zeros_like(x), np.zeros_like(x))
    times = np.array([float(t / path.flow.time) for t in path.elapsed])
    # Instants and samples that are one in float64 are one point of the course.
    is_new = np.r_[True, np.diff(times) != 0]
    place = np.cumsum(is_new) - 1
    with np.errstate(all="ignore"):
        rate = np.gradient(x[is_new], times[is_new], axis=0)
        bend = np.gradient(rate, times[is_new], axis=0)[place]
    rate = rate[place]
    fastest = np.max(abs(rate), axis=0, initial=0.0)
    return Course(x, rate, _resolved(bend, fastest / abs(times[-1]) * _ROUGH))


def _momenta(path: Path) -> Course:
    """Return z, z' and z'' = J(z) z'."""
    flow, z = path.flow, path.momentum
    rate, equations = flow.rates(z), flow.equations
    jacobian = np.tensordot(abs(z), abs(equations.hessian), (1, 2)) + abs(equations.linear)
    terms = abs(equations.constant) + applied(jacobian, abs(z))
    bend = _resolved(applied(flow.jacobian(z), rate), applied(jacobian, terms))
    return Course(z, _resolved(rate, terms), bend)


def _turns(path: Path, momenta: Course) -> Course:
    """Return turns about each axis: q'' = q (-|omega|^2/4 + omega'/2), with a component as large as q."""
    spin = path.flow.equations.spin.T
    turn, turned = (np.linalg.norm(v @ spin, axis=1) for v in momenta[:2])
    columns = np.ones_like(turn), turn, np.hypot(turn**2 / 4, turned / 2)
    return Course(*(np.tile(column[:, None], 3) for column in columns))


def _centre(path: Path) -> Course:
    """Return c, c' and c'' in space axes; differences along a path of one run, which is close to it."""
    scene, length = path.scene, path.units["centre"]
    c = path.centre + [float(each / length) for each in scene.initial.parts()["centre"]]
    if is_of_run(scene):
        return _differences(path, c)
    exact = rates(scene, solution(scene).motion(path.elapsed, _DIGITS))
    unit, later = (
        exact.units["centre"] - floor_log2(length),
        floor_log2(path.flow.time) - exact.time,
    )
    rate = np.ldexp(exact.velocity["centre"], unit + later)
    bend = np.ldexp(exact.acceleration["centre"], unit + 2 * later)
    speed, turn, push = (
        np.linalg.norm(rows, axis=1)[:, None]
        for rows in (rate, path.momentum @ path.flow.equations.spin.T, bend)
    )
    return Course(c, _resolved(rate, speed), _resolved(bend, turn * speed + push))


def _resolved(values: Floats, terms: Floats) -> Floats:
    """Return the values, with zero for those that are no more than noise of their ``terms``."""
    return np.where(abs(values) > _NOISE * terms, values, 0.0)
