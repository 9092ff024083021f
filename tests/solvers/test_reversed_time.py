"""Time reversed: the solver against itself, bit by bit, without a truth."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from builders.scenes import LOADED, MOMENT, TENSOR, vector
from mpmath import mp

from taylor_verify.models.euler import euler_equations
from taylor_verify.models.form import Named
from taylor_verify.models.problem import pose
from taylor_verify.numbers.precision import rung
from taylor_verify.scenes.bodies import RigidBody
from taylor_verify.scenes.motion import Clock, Impulse, Motion, Spin
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.solver import Solver
from taylor_verify.solvers.taylor.driver import Taylor
from taylor_verify.solvers.trajectory import Outcome
from taylor_verify_reports.controls.defects import Defect

BITS = 300
INSTANTS = tuple(Fraction(k, 2) for k in range(17))
RIGID = Scene(
    "turned about",
    "",
    "euler",
    frozenset({"attitude"}),
    RigidBody(TENSOR, MOMENT),
    Spin(vector("0.3", 1, "0.2")),
    Clock(Fraction(0), INSTANTS),
)
IMMERSED = replace(
    RIGID,
    model="kirchhoff",
    track=frozenset({"attitude", "centre"}),
    body=LOADED,
    initial=Impulse(vector(2, -1, 3), vector(3, 4, -2)),
)


def drag(n: Named) -> Mapping[str, Any]:
    """Euler's equations with H' smaller by H/1024, which knows the direction of time."""
    rates = dict(euler_equations(n))
    return rates | {name: rates[name] - n[name] / 1024 for name in ("H1", "H2", "H3")}


def solved(asked: Scene, name: str, solver: Solver) -> Motion:
    trajectory = solver.solve(pose(asked, rung(name)))
    assert trajectory.outcome is Outcome.FINISHED
    return trajectory.motion(BITS)


def past_and_future(asked: Scene, name: str, solver: Solver) -> tuple[Motion, Motion]:
    """The motion at the negative times, and that of the body turned about at the positive ones."""
    past = replace(asked, clock=Clock(Fraction(0), tuple(-t for t in INSTANTS)))
    moving = tuple(-v for v in asked.initial.moving)
    future = replace(asked, initial=asked.initial.with_moving(moving))
    return solved(past, name, solver), solved(future, name, solver)


def turned_about(motion: Motion) -> Motion:
    """The momenta turned about; R and c, whose rates are linear in the momenta, are retraced."""
    with mp.workprec(BITS):
        quantities = {
            name: rows if name in ("attitude", "centre") else -rows
            for name, rows in motion.quantities.items()
        }
    return Motion(quantities, motion.radius)


def same_bits(one: Motion, other: Motion) -> bool:
    """Every number equal; a NaN equals nothing."""
    assert one.quantities.keys() == other.quantities.keys()
    return all(np.array_equal(one[name], other[name]) for name in one.quantities)


@pytest.mark.parametrize("asked", [RIGID, IMMERSED], ids=["rigid", "immersed"])
@pytest.mark.parametrize("name", ["f64", "f80"])
def test_past_is_the_reversed_future_bit_by_bit(name: str, asked: Scene) -> None:
    """Run to negative times, a body does what the body turned about does at positive ones.

    Z(s) = -H(-s) obeys H's own equation, since the free part is quadratic. Every term of every Taylor
    coefficient only changes its sign with that of time, and rounding to nearest is symmetric.
    """
    if missing := Taylor().unavailable(rung(name)):
        pytest.skip(missing)
    past, future = past_and_future(asked, name, Taylor())
    assert same_bits(past, turned_about(future))
    assert not same_bits(past, future)


def test_drag_knows_past_from_future() -> None:
    """A solver that loses momentum gains it at negative times."""
    past, future = past_and_future(RIGID, "f64", Defect("drag", "", "omega", equations=drag))
    assert not same_bits(past, turned_about(future))
