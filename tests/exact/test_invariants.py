"""What a motion conserves: freely, and under written loads, found by polynomials."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from math import isqrt
from typing import Any

import numpy as np
import pytest
from builders.numbers import largest
from builders.scenes import (
    CLEBSCH,
    COUPLE,
    FORCE,
    GENERAL,
    MOMENT,
    TENSOR,
    read_scene,
    sample_scene,
    vector,
)
from builders.written_loads import Evaluated, euler, kirchhoff, rotation
from mpmath import mp, mpf

from taylor_verify.exact.conserved.conservation import Conservation, conservation
from taylor_verify.exact.conserved.polynomial import MOST_TERMS, TooLong, multiplied, symbols_of
from taylor_verify.exact.invariants import Invariant, invariants
from taylor_verify.exact.taylor import TaylorSolution
from taylor_verify.scenes.bodies import RigidBody
from taylor_verify.scenes.motion import Impulse, Motion, Spin
from taylor_verify.scenes.scene import Scene


def named(scene: Scene) -> dict[str, Invariant]:
    return {invariant.name: invariant for invariant in invariants(scene)}


def sampled(scene: Scene, times: Sequence[Fraction], digits: int = 40) -> Motion:
    return TaylorSolution(scene).motion(times, digits)


@pytest.mark.parametrize(
    ("scene", "names"),
    [
        (sample_scene(RigidBody(TENSOR), "attitude"), "T H2 H_space"),
        (sample_scene(GENERAL, "attitude", "centre"), "T F2 FG x_space y_space"),
        (sample_scene(CLEBSCH, "attitude", "centre"), "T F2 FG y3 x_space y_space"),
    ],
)
def test_a_free_motion_conserves_them(scene: Scene, names: str) -> None:
    """Each quantity that the tracking allows is there, and constant to the digits of the truth."""
    invariants_of = named(scene)
    assert list(invariants_of) == names.split()
    motion = sampled(scene, [Fraction(0), Fraction(2), Fraction(-1)])
    with mp.workdps(60):
        for invariant in invariants_of.values():
            value = invariant.value(motion)
            # The rows hold 40 digits; twice that error for products, and a norm or two.
            assert largest(value - value[0]) <= 10 * mpf(10) ** -40 * invariant.scale(motion)


def test_they_tell_one_motion_from_another() -> None:
    """Under loads every one of them changes: none is constant by its form."""
    rigid, solid = (
        sample_scene(RigidBody(TENSOR, MOMENT), "attitude"),
        sample_scene(replace(CLEBSCH, force=FORCE, couple=COUPLE), "attitude", "centre"),
    )
    for loaded in (rigid, solid):
        motion = sampled(loaded, [Fraction(0), Fraction(1)])
        for invariant in invariants(loaded):
            value = invariant.value(motion)
            # The loads are some tenths: in one unit of time they change each by more than 10^-3.
            assert largest(value[1:] - value[:1]) >= invariant.scale(motion) / 1000


@pytest.mark.parametrize(
    "scene",
    [sample_scene(RigidBody(TENSOR), "attitude"), sample_scene(CLEBSCH, "attitude", "centre")],
    ids=["euler", "kirchhoff"],
)
def test_sensitivity_is_the_derivative_or_its_norm(scene: Scene) -> None:
    """Difference quotients of the value, block by block, are what sensitivity states of them."""
    with mp.workdps(50):
        motion = sampled(scene, [Fraction(0), Fraction(2)])
        for invariant in invariants(scene):
            stated = invariant.sensitivity(motion)
            for block in blocks(scene):
                columns = [
                    (invariant.value(nudged(scene, motion, block, j)) - invariant.value(motion))
                    / STEP
                    for j in range(3)
                ]
                jacobian = np.stack([c.reshape(2, -1) for c in columns], axis=2).astype(float)
                expected = np.array(stated.get(block, [0, 0])).astype(float)
                by_component = expected.ndim == 2
                measured = jacobian[:, 0] if by_component else np.linalg.norm(jacobian, 2, (1, 2))
                # The quotient is right to STEP, the norms are float64.
                assert np.abs(measured - expected).max() <= 1e-12 * max(1, np.abs(expected).max())


STEP = Fraction(1, 10**20)


def blocks(scene: Scene) -> tuple[str, ...]:
    if scene.model == "euler":
        return ("momentum", "attitude")
    return ("linear_impulse", "angular_impulse", "attitude", "centre")


def nudged(scene: Scene, motion: Motion, block: str, j: int) -> Motion:
    """The motion with one component of a block moved by STEP in every row."""
    moved = {name: rows.copy() for name, rows in motion.quantities.items()}
    step = mp.convert(STEP)
    if block == "attitude":
        axis = np.array([int(i == j) for i in range(3)])
        moved["attitude"] = moved["attitude"] + step * np.stack(
            [np.cross(axis, turn, axisb=0, axisc=0) for turn in moved["attitude"]]
        )
    elif block == "momentum":
        assert isinstance(scene.body, RigidBody)
        inverse = [mp.convert(row[j]) for row in scene.body.inverse_inertia]
        moved["omega"] = moved["omega"] + step * np.array(inverse)
    else:
        moved[block][:, j] += step
    return Motion(moved, motion.radius)


def test_scales_do_not_vanish() -> None:
    """x.y = 0 leaves FG a scale, y3 = 0 leaves y3 one, and a body at rest has scale 1 for all."""
    crossed = Impulse(vector(1, 0, 0), vector(0, 2, 0))
    motion = sampled(sample_scene(CLEBSCH, start=crossed), [Fraction(0)])
    invariants_of = named(sample_scene(CLEBSCH))
    for name in ("FG", "y3"):
        assert invariants_of[name].value(motion)[0] == 0
        assert invariants_of[name].scale(motion) == 2
    nowhere = Impulse(vector(0, 0, 0), vector(0, 0, 0))
    for resting in (
        sample_scene(CLEBSCH, "attitude", "centre", start=nowhere),
        sample_scene(RigidBody(TENSOR), "attitude", start=Spin(vector(0, 0, 0))),
    ):
        motion = sampled(resting, [Fraction(0), Fraction(1)])
        assert [invariant.scale(motion) for invariant in invariants(resting)] == [1] * len(
            invariants(resting)
        )


# Written loads

HANGING = 'weight = { force = [1, 2, -2], at = [0, 0, "1/4"] }'
NEUTRAL = HANGING + "\nbuoyancy = { force = [-1, -2, 2] }"
NOTHING = ["0", "0", "0"]


def spun(*rotor: str) -> Scene:
    """A body whose wheels are driven; the third text is a moment, if there is one."""
    texts = ", ".join(f'"{text}"' for text in rotor[:2])
    moment = f'moment = ["0", "{rotor[2]}", "0"]' if len(rotor) > 2 else ""
    states = '[states]\nh = { start = [1, 0], rate = ["w1", "-h2 + t"] }'
    body = f"inertia = [1, 1, 1]\n{moment}\nrotor = [{texts}, 0]"
    return read_scene(body, tables=states, top='track = ["attitude", "h"]')


# By name: the scene, and the conserved quantities besides those of the free body.
FOUND: Mapping[str, tuple[Scene, set[str]]] = {
    "weight": (euler(["r32/3", "-r31/3", "0"]), {"T+V", "H_along"}),
    "gyroscopic": (euler(["w2/3", "-w1/3", "0"]), {"T"}),
    "spring": (
        kirchhoff(NOTHING, ["r32*r33", "-r31*r33", "0"]),
        {"T+V", "F2", "x_space", "y_along"},
    ),
    "neutral": (kirchhoff(NOTHING, NOTHING, more=NEUTRAL), {"T+V", "F2", "x_space", "y_along"}),
    "heavy": (kirchhoff(NOTHING, NOTHING, more=HANGING), {"T+V", "x_along", "y_along"}),
    "current": (
        kirchhoff(NOTHING, NOTHING, more="current = [1, 0, 2]"),
        {"T", "F2", "FG", "x_space", "y_along"},
    ),
    "drag": (euler(["-w1/3", "-w2/3", "0"]), set()),
    "clock": (euler(["sin(t)*r32", "-sin(t)*r31", "0"]), {"H_along"}),
    "switch": (euler(["r32/3 if t < 1/2 else r32/4", "-r31/3", "0"]), set()),
    "wheels": (spun("h1/2", "h2"), {"H2", "H_space"}),
    "wheels beyond a sum": (spun("tanh(h1)", "h2"), set()),
    "wheels under a moment": (spun("h1", "h2", "w1"), set()),
    "one of two fields": (euler(["r32/3 + r22/5", "-r31/3 - r21/5", "0"]), {"T+V", "H_along"}),
}


@pytest.mark.parametrize("name", FOUND)
def test_what_loads_conserve_is_found_and_no_more(name: str) -> None:
    """The names are those that follow by hand from each load."""
    scene, names = FOUND[name]
    assert {each.name for each in invariants(scene) if each.is_conserved} == names


@pytest.mark.parametrize(
    "name", [name for name, (_, names) in FOUND.items() if names and name != "wheels"]
)
def test_what_is_found_has_no_rate_along_the_equations_as_written(name: str) -> None:
    """The derivative of the value, by rates that read the texts by themselves, vanishes."""
    scene, _ = FOUND[name]
    conserved = [each for each in invariants(scene) if each.is_conserved]
    with mp.workdps(60):
        equations, step = Evaluated(scene), mpf(10) ** -20
        y = equations.start()
        rate = equations.rates(mpf(1) / 3, y)
        ends = [[a + sign * step * b for a, b in zip(y, rate, strict=True)] for sign in (1, -1)]
        motion = of_rows(scene, ends)
        for each in conserved:
            there, back = each.value(motion)
            change = np.max(np.abs(np.array(there - back)))
            assert change < mpf(10) ** -55, each.name


def test_the_sensitivity_of_the_energy_is_its_derivative() -> None:
    """T + V changes as its gradients say, by turns of the frame and by shifts of the centre."""
    scene, _ = FOUND["heavy"]
    (energy,) = (each for each in invariants(scene) if each.name == "T+V")
    with mp.workdps(40):
        step, y = mpf(10) ** -15, Evaluated(scene).start()
        here = of_rows(scene, [y])
        slopes = energy.sensitivity(here)
        for axis in range(3):
            assert near(slopes["centre"][0][axis], slope(scene, energy, y, shifted(y, axis, step)))
            assert near(slopes["attitude"][0][axis], slope(scene, energy, y, turned(y, axis, step)))


def near(a: Any, b: Any) -> bool:
    return bool(abs(a - b) < mpf(10) ** -12)


def slope(scene: Scene, energy: Any, y: list[Any], other: list[Any]) -> Any:
    first, second = energy.value(of_rows(scene, [y, other]))
    return (second - first) / mpf(10) ** -15


def shifted(y: list[Any], axis: int, step: Any) -> list[Any]:
    return [*y[:10], *(c + step * (k == axis) for k, c in enumerate(y[10:]))]


def turned(y: list[Any], axis: int, step: Any) -> list[Any]:
    """The state with its frame turned about an axis of space."""
    a, b, c, d = y[6:10]
    products = [(-b, a, -d, c), (-c, d, a, -b), (-d, -c, b, a)][axis]
    q = [p + step / 2 * more for p, more in zip((a, b, c, d), products, strict=True)]
    return [*y[:6], *q, *y[10:]]


def of_rows(scene: Scene, rows: list[list[Any]]) -> Motion:
    """The motion of states, quaternions and centres."""
    size = len(scene.initial.moving)
    columns = np.array([row[:size] for row in rows], dtype=object)
    groups = {name: columns[:, 3 * k : 3 * k + 3] for k, name in enumerate(scene.initial.MOVING)}
    groups["attitude"] = np.array([rotation(row[size : size + 4]) for row in rows], dtype=object)
    if scene.model == "kirchhoff":
        groups["centre"] = np.array([row[size + 4 :] for row in rows], dtype=object)
    return Motion(groups, np.array([mpf(0)] * len(rows), dtype=object))


# The algebra.


def test_a_product_without_end_is_refused() -> None:
    """Sums whose product has more terms than are looked at raise TooLong, and nothing is found there."""
    long = sum(symbols_of(f"a{k}" for k in range(isqrt(MOST_TERMS))).values())
    with pytest.raises(TooLong):
        multiplied(long, long)
    powers = " * ".join(f"(w1 + w2 + w3 + t + r1{1 + k % 3})" for k in range(9))
    assert conservation(euler([f"{powers} / 7", "0", "0"])) == Conservation()
