"""The edges of what the search for causes measures, part by part."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from builders.verdicts import row
from scipy.spatial.transform import Rotation

from taylor_verify.judge.causes import answers, gyroscopic, kinematics, tensor, terms
from taylor_verify.judge.causes.equations import Equations
from taylor_verify.judge.causes.material import Material, Pairs
from taylor_verify.judge.causes.readings import omega_reading
from taylor_verify.judge.causes.search import likely_causes
from taylor_verify.judge.causes.single_precision import single_precision
from taylor_verify.numbers.precision import rung
from taylor_verify.records.status import Status
from taylor_verify.scenes.reading.reader import load


def test_the_turn_of_axes_is_an_angle() -> None:
    """A body that is turned by a thousandth of a radian is told to be."""
    right = Equations.of(load("euler/full-tensor").body)
    R = Rotation.from_rotvec([0, 0, 1e-3]).as_matrix()
    assert tensor._difference(right, R @ right.tensor @ R.T).endswith("turned by 0.001 rad")


@pytest.mark.parametrize("sign", [1, -1])
def test_a_turn_keeps_the_length_of_a_quaternion(sign: int) -> None:
    """Its rate is perpendicular to it, with omega in space axes and in those of the body."""
    omega, q = np.array([[1.0, 2.0, 3.0]]), np.array([[0.5, -0.5, 0.25, 1.0]])
    assert np.sum(q * kinematics._times(omega, q, sign)) == 0


@pytest.mark.parametrize("angle", [1e-3, 0.5, 3.0])
def test_attitudes_are_apart_by_their_angle(angle: float) -> None:
    """The angle is read from quaternions of any length and sign."""
    q = Rotation.from_rotvec([[0.1, -0.2, 0.3]] * 2)
    other = q * Rotation.from_rotvec([[0, 0, 0], [0, 0, angle]])
    rows = (one.as_quat(scalar_first=True) for one in (q, other))
    first, second = rows
    assert kinematics._angle(first, -2 * second) == pytest.approx(angle, rel=1e-12)


def test_a_file_of_one_impulse_has_no_cause_in_the_motion() -> None:
    """Without y no row is a state of the motion, the row at the start included."""
    scene = load("kirchhoff/general-body")
    x = np.ones((len(scene.clock.instants), 3))
    failed = row(quantity="impulse", verdict=Status.FAIL)
    material = answers._material(scene, {"x": x}, None, rung("f64"), [failed])
    assert "impulse" in material.failed
    assert likely_causes(material, scene) == ()


def test_sizes_are_those_of_the_largest_vectors() -> None:
    """A defect is relative to the motion, however small that is; to 1 where nothing moves."""
    right = Equations.of(load("kirchhoff/general-body").body)
    states = np.array([[3e-3, 4e-3, 0, 0, 0, 0], [1e-3, 0, 0, 0, 0, 0]])
    sizes = Pairs(right, states[:1], states[1:], np.ones(1)).sizes
    assert sizes == pytest.approx([5e-3] * 3 + [1] * 3)


@pytest.mark.parametrize("name", ["euler/gyrostat-moment", "kirchhoff/constant-loads"])
def test_rates_are_quadratic(name: str) -> None:
    """With the 1 in their last column, rates of twice the rows are four times as large, loads included."""
    right = replace(Equations.of(load(name).body), damping=0.5, drag=0.25)
    z = np.append(np.arange(1.0, right.moving + 1), 1.0)[None]
    assert np.any(right.load)
    assert right.rates(2 * z) == pytest.approx(4 * right.rates(z))


@pytest.mark.parametrize(("elapsed", "error"), [((0.0, 1.0), 0.5), ((1.0, 2.0), None)])
def test_the_error_at_the_start_is_that_of_its_row(
    elapsed: tuple[float, float], error: float | None
) -> None:
    """It is relative to the start of the scene; a file without a row there has none."""
    right, start = Equations.of(load("euler/generic").body), np.array([1.0, 2.0, 3.0])
    states = np.array([1.5 * start, start])
    material = Material(right, start, np.array([1.0, 0, 0, 0]), np.array(elapsed), states)
    assert material.start_error == error


@pytest.mark.parametrize(("size", "count"), [(4.0, 1), (100.0, 0)])
def test_roundings_of_float32_are_of_its_size(size: float, count: int) -> None:
    """A ball keeps its omega: float32 rows that walk by some roundings show float32, by a hundred not."""
    right = Equations(np.eye(3), np.zeros(3), damping=0.0)
    steps = np.random.default_rng(1).standard_normal((200, 3)) * size * 2.0**-24
    states = (np.array([1.0, 0.7, 0.3]) + np.cumsum(steps, axis=0)).astype(np.float32)
    failed = {"omega": row(max=1e-3)}
    times, still = np.arange(200.0), np.array([1.0, 0, 0, 0])
    material = Material(right, states[0], still, times, states.astype(float), failed=failed)
    with np.errstate(all="ignore"):  # as everywhere in a search for causes
        assert len(list(single_precision(material))) == count


def test_what_space_axes_leave_is_a_part_of_the_error() -> None:
    """At the start they leave one error over the other: here 1e-7 of the size of omega, over its own."""
    start, turn = np.array([1.0, 2.0, 3.0]), Rotation.from_rotvec([0.1, 0.2, -0.3])
    q = turn.as_quat(scalar_first=True)
    in_space = turn.apply(start) * (1 + 1e-7)
    right = Equations.of(load("euler/generic").body)
    material = Material(
        *(right, start, q, np.zeros(1), in_space[None], q[None]), failed={"omega": row()}
    )
    ((cause,), read, _) = omega_reading(material, lambda _: [])
    before = np.linalg.norm(in_space - start) / np.linalg.norm(start)
    assert read.start_error == pytest.approx(1e-7, abs=0, rel=1e-6)
    assert cause.leaves == pytest.approx(1e-7 / before, abs=0, rel=1e-6)


def test_an_implicit_step_is_one_of_newton() -> None:
    """It solves the linear part of backward Euler: the rest is h d x I d, with d the change of omega."""
    right, h = Equations.of(load("euler/gyrostat-moment").body), np.array([[0.25]])
    omega = np.array([[1.0, -2.0, 0.5]])
    after = gyroscopic._implicit(right, omega, h)
    change = after - omega
    rest = change @ right.tensor - h * gyroscopic._torque(right, after)
    assert rest == pytest.approx(h * np.cross(change, change @ right.tensor))


def test_what_is_along_the_motion_is_not_across() -> None:
    """Of a defect, the part in the direction of the exact motion is taken out, and that alone."""
    right = Equations.of(load("euler/generic").body)
    begin = np.array([[1.0, -2.0, 0.5], [0.3, 0.7, -1.0]])
    pairs = Pairs(right, begin, begin, np.full(2, 0.1))
    along = right.rates(np.column_stack([pairs.flow, np.ones(2)]))[:, :3]
    beside = np.cross(along, [1.0, 2.0, 3.0])
    assert tensor._across(pairs, 3 * along) == pytest.approx(0 * along, abs=1e-12)
    assert tensor._across(pairs, 3 * along + beside) == pytest.approx(beside)


@pytest.mark.parametrize("known", [terms._RIGID, terms._FLUID])
def test_a_term_of_the_other_sign_is_as_far_off_as_none(known: Any) -> None:
    """Rates with a term of the other sign and sound ones have those without the term in their middle."""
    name = "euler/full-tensor" if known is terms._RIGID else "kirchhoff/general-body"
    sound = Equations.of(load(name).body)
    z = np.append(np.arange(1.0, sound.moving + 1), 1.0)[None]
    rates = {words: replace(sound, **weights).rates(z) for words, _, weights in known}
    expected = sound.rates(z)
    back = rates.pop("motion back in time", -expected)
    assert back == pytest.approx(-expected)
    each = list(rates.values())
    for lacking, turned in zip(each[::2], each[1::2], strict=True):
        assert turned + expected == pytest.approx(2 * lacking)
        assert np.any(lacking != expected)


@pytest.mark.parametrize(
    ("weights", "name"),
    [
        ((0.0, 1.0), None),
        ((1.0, 0.0), "attitude kinematics in the wrong axes"),
        ((0.0, -1.0), "attitude turned backwards"),
        ((-1.0, 0.0), "transposed attitude"),
        ((0.0, 0.0), "attitude stands still"),
        ((0.0, 2.0), "attitude turns twice as fast"),
        ((0.0, 0.5), "attitude turns half as fast"),
    ],
)
def test_wrong_kinematics_explain_themselves_alone(
    weights: tuple[float, float], name: str | None
) -> None:
    """A ball keeps its omega: q' = (b W q + a q W) / 2 is a turn before q and one after it."""
    omega, times = np.array([0.3, -0.2, 0.6]), np.linspace(0.0, 2.0, 9)
    right = Equations(np.eye(3), np.zeros(3), damping=0.0)
    before, after = (Rotation.from_rotvec(np.outer(times, part * omega)) for part in weights)
    q = before * Rotation.from_rotvec([0.5, 0.4, 0.1]) * after
    states, rows = np.tile(omega, (9, 1)), q.as_quat(scalar_first=True)
    material = Material(right, omega, rows[0], times, states, rows)
    with np.errstate(all="ignore"):  # as everywhere in a search for causes
        leaves = {one.name: one.leaves for one in kinematics.kinematics(material)}
    assert [one for one, part in leaves.items() if part <= 1e-9] == [name] * bool(name)
    assert bool(leaves) == bool(name)
