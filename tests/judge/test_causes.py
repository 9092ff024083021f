"""Likely causes: each defect has its own name, and sound integrators have none."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from fractions import Fraction
from itertools import product
from pathlib import Path

import numpy as np
import pytest
from builders.integrators import engine, none
from builders.trajectories import (
    QUATERNION,
    VECTORS,
    Columns,
    columns_at,
    conjugate,
    file_judgement,
    in_space_axes,
    scalar_last,
    write_csv,
)
from builders.turns import by_turns
from builders.wrong_dynamics import (
    Array,
    Numbers,
    Rate,
    Turn,
    causes,
    euler,
    simulated,
    turned,
    turned_by_space,
)
from scipy.spatial.transform import Rotation

import taylor_verify
from taylor_verify.judge.causes.replayed_methods import OF_SECOND_ORDER
from taylor_verify.judge.files.judgement import FileJudgement
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene
from taylor_verify.words.causes import sentence, with_numbers

FREE, FULL, WHEELS = "euler/with-attitude", "euler/full-tensor", "euler/gyrostat"
FORCED, FLUID, LOADED = "euler/moment-oblique", "kirchhoff/general-body", "kirchhoff/constant-loads"


def judged(path: Path, scene: str | Scene, columns: Columns) -> FileJudgement:
    return file_judgement(write_csv(path / "mine.csv", columns), scene)


def names(path: Path, scene: str | Scene, columns: Columns) -> set[str]:
    """The names of the causes of a file that is judged."""
    return {cause.name for cause in judged(path, scene, columns).causes}


# Wrong equations of the states.


def cut(n: Numbers) -> None:
    n.tensor = np.diag(np.diag(n.tensor))


def cut_inverse(n: Numbers) -> None:
    n.tensor = np.diag(1 / np.diag(np.linalg.inv(n.tensor)))


def eigenvalues_alone(n: Numbers) -> None:
    n.tensor = np.diag(np.linalg.eigvalsh(n.tensor)[::-1])


def axes_backwards(n: Numbers) -> None:
    moments, axes = np.linalg.eigh(n.tensor)
    n.tensor = axes.T @ np.diag(moments) @ axes


def reordered(n: Numbers) -> None:
    n.tensor = n.tensor[::-1, ::-1].copy()


def narrowed(n: Numbers) -> None:
    n.tensor = n.tensor.astype(np.float32).astype(float)


def slightly_other(n: Numbers) -> None:
    change = np.random.default_rng(1).standard_normal(n.tensor.shape)
    n.tensor = n.tensor + 4e-9 * (change + change.T)


def unloaded(n: Numbers) -> None:
    n.load = 0 * n.load


def otherwise_loaded(n: Numbers) -> None:
    n.load = -n.load


def uncoupled(n: Numbers) -> None:
    n.tensor = n.tensor.copy()
    n.tensor[:3, 3:] = n.tensor[3:, :3] = 0


@pytest.mark.parametrize(
    ("scene", "change", "name"),
    by_turns(
        [
            (FULL, cut, "products of inertia left out"),
            (FULL, cut_inverse, "products of the inverse tensor left out"),
            (FULL, eigenvalues_alone, "principal axes dropped"),
            (FULL, axes_backwards, "principal axes turned the wrong way"),
            (FREE, reordered, "moments of inertia in another order (3 2 1)"),
            (FULL, narrowed, "inertia in float32"),
            (FULL, slightly_other, "inertia tensor"),
            (FREE, slightly_other, "inertia tensor"),
            (FORCED, unloaded, "moment left out"),
            (FORCED, otherwise_loaded, "moment with the other sign"),
            (FLUID, cut, "inverse masses cut to their diagonal"),
            (FLUID, uncoupled, "coupling B of the energy left out"),
            (FLUID, slightly_other, "coefficients of the energy"),
            (LOADED, unloaded, "loads left out"),
            (LOADED, otherwise_loaded, "loads with the other sign"),
        ],
        7,
        lambda scene, change, name: scene,
    ),
)
def test_another_body_or_load_is_named(
    scene: str, change: Callable[[Numbers], None], name: str
) -> None:
    """A sound integrator of a misread body has the name of the misreading, and no other."""
    assert set(causes(load(scene), simulated(load(scene), change=change))) == {name}


def weighted(
    turning: float = 1, gyroscopic: float = 1, munk: float = 1, damping: float = 0
) -> Rate:
    """Kirchhoff's equations with weights of their terms, and damping."""

    def rate(z: Array, q: Array, n: Numbers) -> Array:
        x, y, velocity = z[:3], z[3:], n.tensor @ z
        U, W = velocity[:3], velocity[3:]
        y_rate = gyroscopic * np.cross(y, W) + munk * np.cross(x, U)
        return np.concatenate([turning * np.cross(x, W), y_rate]) - damping * z + n.load

    return rate


def back(w: Array, q: Array, n: Numbers) -> Array:
    return -euler(w, q, n)


def damped(w: Array, q: Array, n: Numbers) -> Array:
    return euler(w, q, n) - 0.01 * w


def dragged(w: Array, q: Array, n: Numbers) -> Array:
    return euler(w, q, n) - 0.01 * np.linalg.solve(n.tensor, w)


def by_the_speed(power: float = 1, axes: tuple[int, ...] = (1, 1, 1)) -> Rate:
    """Euler's equations with a drag by a power of the speed of turn, on some axes."""

    def rate(w: Array, q: Array, n: Numbers) -> Array:
        drag = 0.01 * np.linalg.norm(w) ** power * w * axes
        return euler(w, q, n) - np.linalg.solve(n.tensor, drag)

    return rate


def without_wheels(w: Array, q: Array, n: Numbers) -> Array:
    return np.linalg.solve(n.tensor, np.cross(n.tensor @ w, w))


def wheels_turned_round(w: Array, q: Array, n: Numbers) -> Array:
    return np.linalg.solve(n.tensor, np.cross(n.tensor @ w - n.rotor, w))


def of_tensor(factor: float, of_rotor: float = 1.0) -> Rate:
    """Euler's equations with a factor of the tensor in the gyroscopic term, and of the wheels in it."""

    def rate(w: Array, q: Array, n: Numbers) -> Array:
        momentum = factor * n.tensor @ w + of_rotor * n.rotor
        return np.linalg.solve(n.tensor, np.cross(momentum, w))

    return rate


def damped_alone(w: Array, q: Array, n: Numbers) -> Array:
    return -0.05 * w


def single(i: int, j: int, k: int, power: int = 0) -> Rate:
    """Kirchhoff's equations with one product of velocities more, or a power that no Coriolis term has."""

    def rate(z: Array, q: Array, n: Numbers) -> Array:
        nu = n.tensor @ z
        term = 0.2 * nu[j] * nu[k] * np.abs(nu[k]) ** power
        return weighted()(z, q, n) + term * np.eye(6)[i]

    return rate


@pytest.mark.parametrize(
    ("scene", "rate", "name"),
    by_turns(
        [
            (FREE, back, "gyroscopic term with the other sign"),
            (FREE, damped, "damping"),
            (FREE, dragged, "one drag on all rates of turn"),
            (FREE, by_the_speed(), "moment -k |w| w, with k"),
            (FREE, by_the_speed(1.5), None),
            (FREE, by_the_speed(1, (1, 2, 3)), None),
            (FREE, damped_alone, "tensor of a sphere and one drag on all rates of turn"),
            (WHEELS, without_wheels, "wheels left out"),
            (WHEELS, wheels_turned_round, "wheels with the other sign"),
            (WHEELS, of_tensor(1.05), "factor of the tensor in the gyroscopic term"),
            (WHEELS, of_tensor(1.05, of_rotor=1.05), "factor of the gyroscopic term"),
            (FLUID, weighted(munk=0), "no Munk moment"),
            (FLUID, weighted(munk=-1), "Munk moment with the other sign"),
            (FLUID, weighted(gyroscopic=0), "no term y x W"),
            (FLUID, weighted(-1, -1, -1), "Coriolis terms with the other sign"),
            (FLUID, weighted(damping=0.02), "damping"),
            (FLUID, single(0, 1, 5), "u2*w3 in force 1 (C_16)"),
            (FLUID, single(3, 1, 2), "u2*u3 in couple 1 (C_42 or C_43)"),
            (FLUID, single(4, 3, 5), "w1*w3 in couple 2 (C_54 or C_56)"),
            (FLUID, single(0, 1, 5, power=1), None),
        ],
        8,
    ),
)
def test_a_wrong_term_is_named(scene: str, rate: Rate, name: str | None) -> None:
    """A term left out, of the other sign, or one too many has its name, and a near miss has none."""
    assert set(causes(load(scene), simulated(load(scene), rate))) == {name} - {None}


def test_the_sentence_has_the_number() -> None:
    """The constant of a damping and the entries of a body are those that the simulator had."""
    (sentence,) = causes(load(FREE), simulated(load(FREE), damped)).values()
    assert sentence.startswith("damping = 0.01; leaves ")
    (sentence,) = causes(load(LOADED), simulated(load(LOADED), change=heavier)).values()
    assert sentence.startswith("M_11 = 1.02278481 for 1.01265823 (+1 %); leaves ")


def test_the_entries_that_agree_are_said_together() -> None:
    """The sentence on a fitted body has the entry that changed, and how well the others agree."""
    labels, right, fitted = ("M_11", "M_22", "M_33"), (1.0, 2.0, 4.0), (1.01, 2.0, 4.0 + 4e-9)
    words = "mass matrix: M_11 = 1.01 for 1 (+1 %), the other entries agree to 1e-09"
    assert with_numbers("mass matrix", labels, right, fitted) == words


def test_an_error_that_a_cause_leaves_is_not_explained() -> None:
    """A quantity of which the cause leaves more than half is named without a number."""
    words = sentence("Euler", {"omega": 1e-9, "centre": 2.1}, {"omega": 1.0, "centre": 0.003})
    assert words == "Euler; leaves 1e-09 of 1 of omega; does not explain the error of centre"


def heavier(n: Numbers) -> None:
    mass = np.linalg.inv(n.tensor)
    mass[0, 0] *= 1.01
    n.tensor = np.linalg.inv(mass)


# Attitudes and axes.


@pytest.mark.parametrize(
    ("turn", "name"),
    [
        (turned_by_space, "attitude kinematics in the wrong axes"),
        (lambda q, w: -turned(q, w), "attitude turned backwards"),
        (lambda q, w: 0 * q, "attitude stands still"),
        (lambda q, w: 2 * turned(q, w), "attitude turns twice as fast"),
        (lambda q, w: 0.5 * turned(q, w), "attitude turns half as fast"),
    ],
)
@pytest.mark.parametrize("rate", by_turns([euler, damped], 2))
def test_wrong_kinematics_are_named(turn: Turn, name: str, rate: Rate) -> None:
    """A wrong turn of the attitude has its name, beside whatever is wrong with omega."""
    named = set(causes(load(FREE), simulated(load(FREE), rate, turn)))
    assert named == {name} | ({"damping"} if rate is damped else set())


@pytest.mark.parametrize(
    ("spoil", "expected"),
    by_turns(
        [
            (in_space_axes, {"omega is in space axes"}),
            (conjugate, {"attitude is transposed"}),
            (scalar_last, {"attitude is scalar last"}),
            (
                lambda c: conjugate(in_space_axes(c)),
                {"omega is in space axes", "attitude is transposed"},
            ),
            (lambda c: scalar_last(conjugate(c)), {"attitude is scalar last and transposed"}),
        ],
        5,
    ),
)
def test_conventions_are_named_beside_wrong_dynamics(
    spoil: Callable[[Columns], Columns], expected: set[str], tmp_path: Path
) -> None:
    """The row at the start tells the axes where the second row is wrong already."""
    columns = spoil(engine(FREE, none, 0.01, 41, 50))
    assert names(tmp_path, FREE, columns) == expected | {"no gyroscopic term"}


def test_omega_in_space_axes_is_told_without_the_start() -> None:
    """The motion back in time tells the axes apart where the attitude at the start is 1."""
    scene = load(FREE)
    scene = replace(
        scene, initial=replace(scene.initial, attitude=(Fraction(1), *[Fraction(0)] * 3))
    )
    columns = in_space_axes(simulated(scene, back))
    named = set(causes(scene, columns))
    assert named == {"omega is in space axes", "gyroscopic term with the other sign"}


@pytest.mark.parametrize("factor", by_turns([10.0, 57.0, 0.16]))
def test_a_factor_near_that_of_a_unit_is_no_unit(factor: float, tmp_path: Path) -> None:
    """A factor of 10 is not the 9.55 of turns per minute: the factor is said, and no unit."""
    scene = load(FREE)
    columns = columns_at(scene, scene.clock.instants)
    scaled = {name: [factor * float(value) for value in columns[name]] for name in VECTORS["omega"]}
    judgement = judged(tmp_path, scene, columns | scaled)
    assert judgement.conventions == ()
    assert [cause.name for cause in judgement.causes] == [f"omega has the factor {factor:g}"]


# Rows.


def late(columns: Columns) -> Columns:
    return columns | {"t": [t + 0.005 for t in columns["t"]]}


def without_start(columns: Columns) -> Columns:
    return {name: values[1:] for name, values in columns.items()}


def turned_by_steps(columns: Columns) -> Columns:
    """The columns with an attitude that the rate at each row turns up to the next."""
    w, q = (np.array([columns[name] for name in v]).T for v in (VECTORS["omega"], QUATERNION))
    steps = w[:-1] * np.diff(columns["t"])[:, None]
    turn = Rotation.from_quat(np.roll(q[0], -1))
    turns = [turn] + [turn := turn * Rotation.from_rotvec(step) for step in steps]
    rows = np.roll([each.as_quat() for each in turns], 1, axis=1)
    return columns | dict(zip(QUATERNION, rows.T.tolist(), strict=True))


@pytest.mark.parametrize(
    ("rate", "spoil", "words"),
    [
        (back, late, "with the clock late by 0.005, as the first row shows: gyroscopic term with"),
        (back, without_start, "gyroscopic term with the other sign; leaves"),
        (
            euler,
            lambda c: without_start(turned_by_steps(c)),
            "attitude turned by the rate at the b",
        ),
    ],
    ids=["late", "without-start", "attitude-without-start"],
)
def test_rows_that_begin_late_have_their_cause(
    rate: Rate, spoil: Callable[[Columns], Columns], words: str
) -> None:
    """The start is integrated to the first row, unless that row is the start at another time."""
    (sentence,) = causes(load(FREE), spoil(simulated(load(FREE), rate))).values()
    assert sentence.startswith(words)


@pytest.mark.parametrize(
    ("sign", "count", "shift"),
    by_turns(
        [(-1, 401, 1), (1, 1601, 2), (-1, 1601, 2), (1, 1601, 4), (-1, 1601, 4), (1, 401, 1)], 6
    ),
)
def test_rows_are_counted_in_the_file(sign: int, count: int, shift: int, tmp_path: Path) -> None:
    """A file of which every second row is examined, or that ends at its start, is off by its own rows."""
    every = [sign * Fraction(k, 200) for k in range(count + shift)]
    exact = columns_at(load(FREE), every)
    columns = {k: v[:count] if k == "t" else v[shift:] for k, v in exact.items()}
    if sign < 0:
        columns = {name: values[::-1] for name, values in columns.items()}
    (cause,) = judged(tmp_path, FREE, columns).causes
    assert f"row k holds the state of row k{sign * shift:+d};" in cause.sentence


def test_a_body_that_drifts_is_not_at_rest() -> None:
    """Rows that no longer turn but still move are the same, and not said to have no velocity."""
    scene = load(FLUID)
    columns = simulated(scene)
    half = len(columns["t"]) // 2
    for name in columns.keys() - {"t"}:
        last = {"x": 0.1, "y": 0.0}.get(name[0], columns[name][half])
        columns[name] = [*columns[name][:half], *[last] * (len(columns["t"]) - half)]
    (sentence,) = causes(scene, columns).values()
    assert "all rows have the same numbers from there on" in sentence


# Answers that have no cause.


def false_words(names: Iterable[str]) -> list[str]:
    """The names of causes that say more of a sound method than its steps, of order two in the attitude."""
    steps = ("truncation of order", *(f"attitude {update}" for update in OF_SECOND_ORDER))
    return [name for name in names if not name.startswith(steps)]


SOUND = [("RK45", 1e-3), ("RK45", 1e-7), ("RK23", 1e-4), ("LSODA", 1e-6)]


@pytest.mark.parametrize(
    ("scene", "sound"), by_turns(product([FLUID, LOADED, "kirchhoff/whole-motion"], SOUND), 12)
)
def test_a_sound_method_has_no_cause_in_a_fluid(scene: str, sound: tuple[str, float]) -> None:
    """Coarse answers by Kirchhoff's equations are given no cause either."""
    method, tolerance = sound
    columns = simulated(load(scene), method=method, tolerance=tolerance)
    assert not false_words(causes(load(scene), columns))


@pytest.mark.parametrize(
    "name", by_turns(["moser-veselov", "splitting", "implicit-midpoint", "lie-rk4"])
)
def test_a_geometric_method_has_no_cause(name: str) -> None:
    """A method that conserves much, and whose error is all along the orbit, is given no other body."""
    judgement = taylor_verify.run(FREE, f"geometric:{name}?step=1/20")
    assert not judgement.passed
    assert not false_words(cause.name for cause in judgement.causes)


def test_two_rows_name_nothing() -> None:
    """Two rows have no cause: a single step may agree with anything by chance."""
    columns = simulated(load(FREE), damped, times=np.array([0.0, 0.5]))
    assert causes(load(FREE), columns) == {}


def test_noise_of_momenta_has_no_cause() -> None:
    """Momenta with noise in every row, the first one included, end in no error and no cause."""
    columns, draw = simulated(load(FLUID)), np.random.default_rng(5)
    for name in VECTORS["linear_impulse"] + VECTORS["angular_impulse"]:
        noise = 1e-4 * draw.standard_normal(len(columns["t"]))
        columns[name] = (np.array(columns[name]) * (1 + noise)).tolist()
    assert causes(load(FLUID), columns) == {}


@pytest.mark.parametrize("value", by_turns([np.nan, 1e200], 2))
def test_an_answer_that_runs_away_has_no_cause(value: float, tmp_path: Path) -> None:
    """Rows that are no numbers, or beyond float64's squares, end in no error and no cause."""
    columns = simulated(load(FREE))
    for name in (*VECTORS["omega"], *QUATERNION):
        columns[name] = columns[name][:1] + [value] * (len(columns["t"]) - 1)
    assert names(tmp_path, FREE, columns) == set()
