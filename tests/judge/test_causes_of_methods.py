"""Likely causes of methods: of few printed digits, of two steps, of added mass by past accelerations."""

from __future__ import annotations

from collections.abc import Callable
from copy import deepcopy
from functools import partial
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from builders.caused_rows import Array, columns, rows, titles
from builders.integrators import step
from builders.scenes import text_of
from builders.trajectories import Columns
from builders.turns import by_turns
from builders.wrong_dynamics import turned
from scipy.spatial.transform import Rotation

TENSOR = np.array([[2.6, 0.3, -0.45], [0.3, 3.4, 0.2], [-0.45, 0.2, 1.9]])
SPIN = {"omega": [0.6, -0.5, 0.9], "attitude": [0.5, 0.3, -0.7, 0.2]}
RIGID = text_of({"inertia": TENSOR.tolist()}, SPIN, 8, 81, "omega", "attitude")
Q = np.array(SPIN["attitude"]) / np.linalg.norm(SPIN["attitude"])
START = np.array([*SPIN["omega"], *Q])
TIMES = np.round(np.arange(81) * 0.1, 6)
Step = Callable[[Array, float], Array]


def spin(w: Array) -> Array:
    return np.linalg.solve(TENSOR, np.cross(TENSOR @ w, w))


def rates(z: Array) -> Array:
    return np.concatenate([spin(z[:3]), turned(z[3:], z[:3])])


def classical(z: Array, h: float) -> Array:
    return step(lambda _, state: rates(state), 0.0, z, h)


class AdamsBashforth:
    """The method of two steps, or that of other weights; the first step is Euler's or another one."""

    def __init__(self, weight: float = 1.5, first: Step | None = None) -> None:
        self.weight, self.first, self.before = weight, first, None

    def __call__(self, z: Array, h: float) -> Array:
        now, before = rates(z), self.before
        self.before = now
        if before is None:
            return z + h * now if self.first is None else self.first(z, h)
        return np.asarray(z + h * (self.weight * now - (self.weight - 1) * before))


def stepped(step: Step, every: int, z: Array, times: Array, names: tuple[str, ...]) -> Columns:
    n, made = len(names), [z]
    step = deepcopy(step)  # it has a memory
    for begin, end in pairwise(times):
        for _ in range(every):
            z = step(z, (end - begin) / every)
            z[n:] /= np.linalg.norm(z[n:])
        made.append(z)
    return columns(times, np.array(made), names)


rigid = partial(stepped, z=START, times=TIMES, names=("w1", "w2", "w3"))


def printed(made: Columns, digits: int = 10) -> Columns:
    return {name: [float(f"{x:.{digits}g}") for x in column] for name, column in made.items()}


def faster(clock: float) -> Columns:
    made = rows(lambda t, w, q: clock * spin(w), START[:3].tolist(), Q, TIMES, [])
    return columns(TIMES, made, ("w1", "w2", "w3"))


@pytest.mark.parametrize(
    ("made", "title"),
    by_turns(
        [
            (lambda: rigid(classical, 1), ["truncation of order 4: RK4, h = 0.1"]),
            (lambda: faster(1 + 2e-8), []),
            (lambda: rigid(AdamsBashforth(first=classical), 60), []),
        ],
        3,
    ),
)
def test_a_method_is_named_from_ten_printed_digits(
    made: Callable[[], Columns], title: list[str], tmp_path: Path
) -> None:
    """An error of hundred roundings at the end is explained; another that is as small has no such name."""
    words = titles(tmp_path, RIGID, printed(made()))
    assert [each for each in words if "RK" in each] == title


@pytest.mark.parametrize(
    ("method", "title"),
    by_turns(
        [
            (AdamsBashforth(), ["truncation of order 2: Adams-Bashforth 2, h = 0.02"]),
            (
                AdamsBashforth(first=classical),
                ["truncation of order 2: Adams-Bashforth 2, h = 0.02"],
            ),
            (AdamsBashforth(weight=1.6), []),
            (AdamsBashforth(weight=1.0), ["explicit gyroscopic step: explicit Euler, h = 0.02"]),
        ],
        4,
    ),
)
def test_a_method_of_two_steps_is_named(
    method: AdamsBashforth, title: list[str], tmp_path: Path
) -> None:
    """Adams and Bashforth's method has its name and step however it begins; that of others has not."""
    words = titles(tmp_path, RIGID, printed(rigid(method, 5)))
    assert [each for each in words if not each.startswith("attitude")] == title


# A vehicle whose added mass acts by accelerations that are known already.

VEHICLE = text_of(
    {"mass": 30, "inertia": [0.5, 2, 2.2], "added_mass": [4, 9, 8, 0.05, 0.4, 0.5]}
    | {"centre_of_mass": [0, 0, 0]},
    {"linear_velocity": [1.5, 0.3, -0.25], "angular_velocity": [0.3, 0.5, 0.4]},
    *(2, 41, "attitude"),
)
OWN = np.diag([30.0, 30, 30, 0.5, 2.0, 2.2])
ADDED = np.diag([4.0, 9.0, 8.0, 0.05, 0.4, 0.5])
ORDERLY = "added mass by the acceleration of the step before, explicit Euler"
FILTERED = "added mass by the accelerations of the steps before, low-pass with 0.3, explicit Euler"
STEP = ", h = 0.005"


class Plugin:
    """Explicit steps by the low-pass of the accelerations before; at first it is known, or 0."""

    def __init__(self, weight: float, is_known: bool, added: float = 1.0) -> None:
        self.weight, self.before = weight, None if is_known else np.zeros(6)
        self.added = added * ADDED

    def __call__(self, z: Array, h: float) -> Array:
        nu, matrix = z[:6], OWN + ADDED
        x, y = (matrix @ nu)[:3], (matrix @ nu)[3:]
        force = np.concatenate([np.cross(x, nu[3:]), np.cross(y, nu[3:]) + np.cross(x, nu[:3])])
        before = np.linalg.solve(matrix, force) if self.before is None else self.before
        own = np.linalg.solve(matrix - self.added, force - self.added @ before)
        self.before = (1 - self.weight) * before + self.weight * own
        after = nu + h * own
        return np.concatenate([after, z[6:] + h * turned(z[6:], after[3:])])


@pytest.mark.parametrize(
    ("plugin", "title"),
    by_turns(
        [
            (Plugin(1.0, is_known=True), [ORDERLY + STEP]),
            (Plugin(1.0, is_known=False), [ORDERLY + STEP]),
            (Plugin(0.3, is_known=False), [FILTERED + STEP]),
            (Plugin(0.5, is_known=True), []),
            (Plugin(1.0, is_known=True, added=0.0), []),
        ],
        5,
    ),
)
def test_an_added_mass_by_past_accelerations_is_named(
    plugin: Plugin, title: list[str], tmp_path: Path
) -> None:
    """Plug-ins of simulators have their step, and their filter if they have one; others have none."""
    start, times = np.array([1.5, 0.3, -0.25, 0.3, 0.5, 0.4, 1, 0, 0, 0]), np.arange(41) * 0.05
    names = ("u1", "u2", "u3", "w1", "w2", "w3")
    words = titles(tmp_path, VEHICLE, stepped(plugin, 10, start, np.round(times, 6), names))
    assert [each for each in words if "added mass" in each] == title


def in_order(order: tuple[int, ...], q: Array, w: Array, h: float) -> Array:
    """A step of q + h q omega / 2 whose components are overwritten in some order."""
    q = q.copy()
    for i in order:
        q[i] += h * turned(q, w)[i]
    return q


@pytest.mark.parametrize(
    ("order", "words"),
    by_turns(
        [
            ((3, 2, 1, 0), "in place, its last component first, h = 0.025"),
            ((1, 2, 3, 0), "in place, its vector first, h = 0.025"),
            ((0, 1, 2, 3), "in place, h = 0.025"),
            ((2, 0, 3, 1), ""),
        ],
        3,
    ),
)
def test_the_order_of_an_update_in_place_is_named(
    order: tuple[int, ...], words: str, tmp_path: Path
) -> None:
    """Beside a right omega the quaternion is overwritten component by component, in a known order."""

    def step(z: Array, h: float) -> Array:
        right = z
        for _ in range(10):
            right = classical(right, h / 10)
        return np.concatenate([right[:3], in_order(order, z[3:], z[:3], h)])

    names = titles(tmp_path, RIGID, rigid(step, 4))
    assert any("in place" in each for each in names) == bool(words)
    assert not words or any(each.endswith(words) for each in names)


MOMENT = np.array([0.2, -0.3, 0.25])
PUSHED = text_of(
    {"inertia": TENSOR.tolist(), "moment": MOMENT.tolist()}, SPIN, 8, 81, "omega", "attitude"
)


def pushed(moment: Array, z: Array, h: float) -> Array:
    """A step of explicit Euler under a moment, with the attitude turned by the new omega."""
    w = z[:3] + h * (spin(z[:3]) + np.linalg.solve(TENSOR, moment))
    return np.concatenate([w, z[3:] + h * turned(z[3:], w)])


def momentum_in_space(z: Array, h: float) -> Array:
    """A step of an engine that keeps the momentum in space and adds the moment to it there."""
    w, q = z[:3], z[3:]
    momentum = matrix(q) @ (TENSOR @ w + h * MOMENT)
    after = q + h * turned(q, w)
    after /= np.linalg.norm(after)
    return np.concatenate([np.linalg.solve(TENSOR, matrix(after).T @ momentum), after])


def matrix(q: Array) -> Array:
    return np.asarray(Rotation.from_quat(q[[1, 2, 3, 0]]).as_matrix())


def test_the_attitude_beside_the_steps_of_a_fault_has_its_own_sentence(tmp_path: Path) -> None:
    """A moment of the other sign in steps of Euler: what the steps leave of the attitude is named too."""
    names = titles(tmp_path, PUSHED, rigid(partial(pushed, MOMENT * [1, 1, -1]), 10))
    assert any("other sign, beside steps of explicit Euler, h = 0.01" in each for each in names)
    assert any("attitude q + h q omega / 2 with the rate at the end" in each for each in names)


def test_a_momentum_in_space_under_a_moment_is_named(tmp_path: Path) -> None:
    """The moment of a step is added before the turn, which is that of a step of the quaternion."""
    names = titles(tmp_path, PUSHED, rigid(momentum_in_space, 10))
    words = (
        "momentum with the moment of the step turned by q + h q omega / 2 at its begin, h = 0.01"
    )
    assert words in names


WEIGHT, POINT = np.array([0, 0, -3.0]), np.array([0.1, -0.05, 0.3])
HANGING = RIGID.replace(
    "[initial]", f"weight = {{ force = {WEIGHT.tolist()}, at = {POINT.tolist()} }}\n[initial]"
)


@pytest.mark.parametrize(("ahead", "is_named"), [(0.5, True), (0.4, False)])
def test_a_leapfrog_whose_loads_read_the_attitude_is_named(
    ahead: float, is_named: bool, tmp_path: Path
) -> None:
    """The turn is by the rate after half a kick; one after two fifths of it has not this name."""

    def kicked(w: Array, q: Array, h: float) -> Array:
        moment = np.cross(POINT, matrix(q).T @ WEIGHT)
        return np.asarray(w + h * (spin(w) + np.linalg.solve(TENSOR, moment)))

    def leap(z: Array, h: float) -> Array:
        w = kicked(z[:3], z[3:], ahead * h)
        turn = Rotation.from_quat(z[[4, 5, 6, 3]]) * Rotation.from_rotvec(h * w)
        q = turn.as_quat()[[3, 0, 1, 2]]
        return np.concatenate([kicked(w, q, (1 - ahead) * h), q])

    words = "leapfrog, attitude turned by the rate in the middle of the step, h = 0.025"
    assert (words in titles(tmp_path, HANGING, rigid(leap, 4))) == is_named


@pytest.mark.parametrize(
    ("restores", "words"),
    by_turns(
        [
            (True, "RK4 whose stages read q as it is, h = 0.025"),
            (
                False,
                "RK4 whose stages read q as it is, never restored to unit length within the run, h = 0.025",
            ),
            (None, None),
        ],
        4,
        lambda restores, words: restores,
    ),
)
def test_stages_that_read_q_as_it_is_are_named(
    restores: bool | None, words: str | None, tmp_path: Path
) -> None:
    """R of a stage is |q|^2 times a rotation; with q restored at one stage it is another method."""

    def rates(z: Array) -> Array:
        w, q = z[:3], z[3:]
        down = np.array([q[1] * q[3] - q[0] * q[2], q[2] * q[3] + q[0] * q[1], 0.0]) * 2
        down[2] = q[0] ** 2 - q[1] ** 2 - q[2] ** 2 + q[3] ** 2
        moment = np.cross(POINT, WEIGHT[2] * down)
        return np.concatenate([spin(w) + np.linalg.solve(TENSOR, moment), turned(q, w)])

    def unit(z: Array) -> Array:
        return np.concatenate([z[:3], z[3:] / np.linalg.norm(z[3:])])

    own = [START]

    def classical(z: Array, h: float) -> Array:
        # `rigid` restores the length of what it is given.
        z = own[0] if restores is False else z
        first = rates(z)
        second = rates(unit(z + h / 2 * first) if restores is None else z + h / 2 * first)
        third = rates(z + h / 2 * second)
        own[0] = z + h / 6 * (first + 2 * second + 2 * third + rates(z + h * third))
        return own[0].copy()

    names = titles(tmp_path, HANGING, rigid(classical, 4))
    assert [words in name for name in names] == [True] if words else not names
