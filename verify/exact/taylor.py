"""The truth where no closed form is known: the equations of both texts, and their Taylor recursion.

The right-hand sides are written here from the texts and share nothing with models.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from typing import Any, final

import numpy as np
from mpmath import mp

from verify.exact import clocks
from verify.exact.clocks import Polynomial
from verify.exact.equations import (
    Triple,
    cross,
    dot,
    driven,
    euler_drift,
    euler_rates,
    impulse_rates,
)
from verify.exact.grid import STEP_DIGITS
from verify.exact.guided import crosswise, placed
from verify.exact.recursion import (
    Equations,
    Problem,
    Units,
    exponent,
    first_width,
    leap,
    march,
    problem,
)
from verify.exact.rotation import rotation_matrix
from verify.exact.solution import NO_CLOSED_FORM, Quantities, Settled
from verify.scenes import tensors
from verify.scenes.bodies import ImmersedBody, RigidBody
from verify.scenes.motion import Impulse, Motion, Spin, State
from verify.scenes.scene import Scene
from verify.scenes.tensors import Vector

# Most have one.
_STEPS_OF_AN_ARC = 8
# A clock is so much sharper than the arc that it drives that its rounding is none of the arc's.
_CLOCK_DIGITS = 10
# What a division by the impulse may cost the centre.
_MOST_LOST_BITS = 20


@final
@dataclass(frozen=True)
class TaylorSolution(Settled):
    """The motion of any scene, free or loaded, by recursion on the equations of motion."""

    scene: Scene

    route = "taylor"
    regime = NO_CLOSED_FORM
    step_digits = STEP_DIGITS

    def evaluate(self, elapsed: Sequence[Fraction], digits: int) -> Quantities:
        """The tracked quantities at these times, any order and either sign, to about ``digits``.

        The absolute error of a vector is that many digits below the smallest block of the initial
        state, times what the orbit makes of a rounding. Raises Unsettled when the span would take
        more than a million steps.
        """
        problem = self._problem
        grid = problem.grid(digits)
        later = sorted({t for t in elapsed if t > 0})
        earlier = sorted({t for t in elapsed if t < 0}, reverse=True)
        states = {Fraction(0): grid.integers(problem.start)}
        for times in filter(None, (later, earlier)):
            width = first_width(problem, times[-1], grid)
            states.update(march(problem, times, grid, width))
        rows = [problem.reals(states[t], grid) for t in elapsed]
        if not self._is_guided:
            return _quantities(self.scene, rows)
        with mp.workprec(grid.bits):
            return _guided_quantities(self.scene, elapsed, rows)

    @cached_property
    def _is_guided(self) -> bool:
        """Whether the impulse leads the frame: it is constant in space, and not too small to divide by."""
        start, body = self.scene.initial, self.scene.body
        if not (isinstance(start, Impulse) and isinstance(body, ImmersedBody)):
            return False
        if not (self.scene.track and body.is_free and any(start.linear)):
            return False
        units = _kirchhoff_units(body, start.linear + start.angular)
        impulse, moment, speed = units.variables[0], exponent(start.angular), units.variables[6]
        return moment is None or moment <= impulse + speed + units.time + _MOST_LOST_BITS

    @cached_property
    def _problem(self) -> Problem:
        return _guided_problem(self.scene) if self._is_guided else posed(self.scene)


def arcs(
    scene: Scene,
    starts: Sequence[State],
    spans: Sequence[Fraction],
    digits: int,
    begins: Sequence[Fraction] = (),
) -> Motion:
    """Row k: where the scene's equations lead from the exact state starts[k] in the time spans[k].

    Settled to ``digits`` by the agreement of two evaluations, as Solution.motion is, and raises
    Unsettled likewise. The loads of a manufactured motion change with time: there each arc has to say
    when it begins, ``begins`` since the start of the scene. Elsewhere that changes nothing.
    """
    if scene.body.manufactured is not None and len(begins) != len(starts):
        raise ValueError(
            f"expected the times at which {len(starts)} arcs under loads that change with time begin, "
            f"got {len(begins)} @ {scene.name}"
        )
    return _Arcs(scene, tuple(starts), tuple(begins)).motion(spans, digits)


@final
@dataclass(frozen=True)
class _Arcs(Settled):
    """Many short motions of one body, each from a state of its own, and by the clock from its time."""

    scene: Scene
    starts: tuple[State, ...]
    begins: tuple[Fraction, ...]

    route = "taylor"
    regime = NO_CLOSED_FORM
    step_digits = STEP_DIGITS

    def evaluate(self, elapsed: Sequence[Fraction], digits: int) -> Quantities:
        ends: list[list[Any]] = []
        for posed_arc, clock, span in zip(
            self._problems, self._clocks(digits), elapsed, strict=True
        ):
            grid = posed_arc.grid(digits, _STEPS_OF_AN_ARC)
            # The clock, in units of one, comes last.
            arc = (
                replace(posed_arc, start=posed_arc.start[: -len(clock)] + clock)
                if clock
                else posed_arc
            )
            ends.append(arc.reals(leap(arc, span, grid), grid))
        return _quantities(self.scene, ends)

    def _clocks(self, digits: int) -> list[Vector]:
        """The clock of a manufactured motion where each arc begins, to more digits than the arc has."""
        motion = self.scene.body.manufactured
        if motion is None:
            return [()] * len(self.starts)
        return [clocks.at(motion, begin, digits + _CLOCK_DIGITS) for begin in self.begins]

    @cached_property
    def _problems(self) -> list[Problem]:
        """One for every start, all in the units of the scene's own, the clock as at the start."""
        whole = posed(self.scene)
        return [whole.begun(_start(replace(self.scene, initial=start))) for start in self.starts]


# The equations.


def _euler(body: RigidBody, with_attitude: bool) -> Equations:
    """omega' = K((I omega) x omega + M); each row r of R obeys r' = r x omega.

    The clock of a manufactured motion comes last.
    """
    omega: Triple = (0, 1, 2)
    right = euler_rates(body)
    right = driven(right, body, 3 + 9 * with_attitude)
    if with_attitude:
        right[3:3] = [p for row in _rows_from(3) for p in cross(row, omega)]
    return Equations(euler_drift(body), (), tuple(right))


def _kirchhoff(body: ImmersedBody, with_attitude: bool, with_centre: bool) -> Equations:
    """Hydromechanics 48 (3), (4), (5); R' = R [Omega]x row by row, centre' = R U; last the clock."""
    clock = 6 + 9 * with_attitude + 3 * with_centre
    size = clock + clocks.count(body.manufactured)
    velocity: Triple = (size, size + 1, size + 2)
    omega: Triple = (size + 3, size + 4, size + 5)
    right = driven(impulse_rates(body), body, clock)
    frame: list[Polynomial] = []
    if with_attitude:
        frame += [p for row in _rows_from(6) for p in cross(row, omega)]
    if with_centre:
        frame += [dot(row, velocity) for row in _rows_from(6)]
    right[6:6] = frame
    # Only R and the centre ask for U and Omega themselves.
    forms = body.energy_matrix if with_attitude else ()
    return Equations(body.force + body.couple, forms, tuple(right))


def _euler_units(body: RigidBody, start: Vector) -> Units:
    """omega by its size, or what the moment makes of it; time by omega, or the fastest of its waves."""
    spun, motion = tensors.apply(body.inverse_inertia, body.moment), body.manufactured
    if motion is None:
        omega = _largest(exponent(start[:3]), _halved(exponent(spun)), default=0)
        return Units((omega,) * 3 + (0,) * (len(start) - 3), -omega)
    omega = _largest(exponent(motion.reach), default=0)
    rate = _largest(omega, clocks.exponent(motion), default=0)
    return Units((omega,) * 3 + (0,) * (len(start) - 3), -rate)


def _kirchhoff_units(body: ImmersedBody, start: Vector) -> Units:
    """Each block by its size, or by what the loads, and x x U, make of it in the unit of time."""
    x, y, force, couple = start[:3], start[3:6], body.force, body.couple
    a, b, c = body.linear, body.coupling, body.angular
    spun = tensors.plus(tensors.apply(tensors.transpose(b), force), tensors.apply(c, couple))
    pushed = tensors.plus(tensors.apply(a, force), tensors.apply(b, couple))
    omega = _largest(
        exponent(tensors.apply(tensors.transpose(b), x)),
        exponent(tensors.apply(c, y)),
        _halved(exponent(spun)),
        default=0,
    )
    time = -omega
    velocity = _largest(
        exponent(tensors.apply(a, x)),
        exponent(tensors.apply(b, y)),
        _later(exponent(pushed), time),
        default=omega,
    )
    if body.manufactured is not None:
        time = -_largest(omega, clocks.exponent(body.manufactured), default=0)
    linear = _largest(exponent(x), _later(exponent(force), time), default=0)
    angular = _largest(
        exponent(y), _later(exponent(couple), time), default=linear + velocity + time
    )
    angular = max(angular, linear + velocity + time)
    sizes: tuple[int, ...] = (linear,) * 3 + (angular,) * 3 + (0,) * 9 + (velocity + time,) * 3
    clock = (0,) * clocks.count(body.manufactured)
    sizes = sizes[: len(start) - len(clock)] + clock
    return Units(sizes + (velocity,) * 3 + (omega,) * 3, time)


def _halved(exponent: int | None) -> int | None:
    return None if exponent is None else exponent // 2


def _later(exponent: int | None, time: int) -> int | None:
    """The size of what grows at this rate, after one unit of time."""
    return None if exponent is None else exponent + time


def _largest(*exponents: int | None, default: int) -> int:
    return max((e for e in exponents if e is not None), default=default)


def posed(scene: Scene) -> Problem:
    """The scene's equations and initial state, in units of their size."""
    start, body = _start(scene), scene.body
    if isinstance(body, RigidBody):
        return problem(_euler(body, bool(scene.track)), _euler_units(body, start), start, moving=3)
    equations = _kirchhoff(body, bool(scene.track), "centre" in scene.track)
    motion = body.manufactured
    # What a manufactured motion reaches, not where it begins, is the size of its impulses.
    units = _kirchhoff_units(body, start if motion is None else motion.reach + start[6:])
    variables = units.variables[: len(start) + len(equations.forms)]
    return problem(equations, Units(variables, units.time), start, moving=6)


def _guided_problem(scene: Scene) -> Problem:
    """x, y, a row across x, and int x.U: what guided.placed makes attitude and centre of."""
    start, body = scene.initial, scene.body
    assert isinstance(start, Impulse)
    assert isinstance(body, ImmersedBody)
    x, row = (0, 1, 2), (6, 7, 8)
    velocity, omega = (10, 11, 12), (13, 14, 15)
    right = impulse_rates(body) + cross(row, omega) + [dot(x, velocity)]
    equations = Equations(body.force + body.couple, body.energy_matrix, tuple(right))
    moving = start.linear + start.angular
    units = _kirchhoff_units(body, moving)
    across = crosswise(start)
    linear, speed = units.variables[0], units.variables[6]
    sizes = units.variables[:6] + (exponent(across) or 0,) * 3 + (linear + speed + units.time,)
    return problem(
        equations,
        Units(sizes + units.variables[6:], units.time),
        moving + across + (Fraction(0),),
        moving=6,
    )


def _rows_from(first: int) -> tuple[Triple, Triple, Triple]:
    """The variables of the three rows of R."""
    a, b, c = ((i, i + 1, i + 2) for i in range(first, first + 9, 3))
    return a, b, c


def _start(scene: Scene) -> Vector:
    """The initial state in the order of the equations, exactly."""
    initial = scene.initial
    if isinstance(initial, Spin):
        moving: Vector = initial.omega
    else:
        moving = initial.linear + initial.angular
    if scene.track:
        moving += tuple(entry for row in rotation_matrix(initial.attitude) for entry in row)
    if "centre" in scene.track and isinstance(initial, Impulse):
        moving += initial.centre
    motion = scene.body.manufactured
    return moving if motion is None else moving + clocks.at(motion, Fraction(0), 0)


# The answer.


def _guided_quantities(
    scene: Scene, elapsed: Sequence[Fraction], states: Sequence[Sequence[Any]]
) -> Quantities:
    z = np.array(states, dtype=object)
    start = scene.initial
    assert isinstance(start, Impulse)
    found = placed(start, z)
    at_start = [k for k, t in enumerate(elapsed) if t == 0]
    # As told: a centre at the origin has no digits but exact ones.
    found["centre"][at_start] = [mp.convert(c) for c in start.centre]
    if "centre" not in scene.track:
        del found["centre"]
    return {"linear_impulse": z[:, :3], "angular_impulse": z[:, 3:6], **found}


def _quantities(scene: Scene, states: Sequence[Sequence[Any]]) -> Quantities:
    z = np.array(states, dtype=object).reshape(len(states), len(_start(scene)))
    if scene.model == "euler":
        parts, used = {"omega": z[:, :3]}, 3
    else:
        parts, used = {"linear_impulse": z[:, :3], "angular_impulse": z[:, 3:6]}, 6
    if scene.track:
        parts["attitude"] = z[:, used : used + 9].reshape(len(z), 3, 3)
    if "centre" in scene.track:
        parts["centre"] = z[:, used + 9 : used + 12]
    return parts
