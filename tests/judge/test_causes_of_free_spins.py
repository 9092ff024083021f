"""Likely causes of rows of a free body: other starts, noise, rates of wrong angles, speeds that are cut."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from builders.caused_rows import RIGID, TENSOR, TIMES, Array, Law, Q, columns, rigid, rows, titles
from builders.integrators import rk4, turned
from builders.numbers import cross
from builders.scenes import text_of
from builders.trajectories import VECTORS, Columns
from builders.turns import by_turns
from builders.wrong_dynamics import turned as rate_of_turn
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

SCENE = RIGID.format(load="")
START = [0.9, -0.4, 1.0]


def from_start(law: Callable[[Array], Array], start: list[float]) -> Columns:
    """Rows of a body that begins with another omega."""
    return columns(TIMES, rows(lambda t, w, q: law(w), start, Q, TIMES, ()), ("w1", "w2", "w3"))


def free(w: Array) -> Array:
    return np.linalg.solve(TENSOR, np.cross(TENSOR @ w, w))


FAULTS: dict[str, Callable[[Array], Array]] = {
    "damping = 0.05": lambda w: free(w) - 0.05 * w,
    "factor of the gyroscopic term = 0.9": lambda w: 0.9 * free(w),
    "no gyroscopic term": lambda w: 0 * w,
}


@pytest.mark.parametrize("name", by_turns([*FAULTS], 3))
def test_a_fault_is_named_beside_another_start(name: str, tmp_path: Path) -> None:
    """The first row shows the start, and the rows after it the fault of the equations."""
    first, *others = titles(tmp_path, SCENE, from_start(FAULTS[name], START))
    assert first == "another start"
    assert any(each.startswith(f"with that: {name}") for each in others)


def test_another_start_alone_is_all_that_is_said(tmp_path: Path) -> None:
    """A right motion from another start has no second fault."""
    (only,) = titles(tmp_path, SCENE, from_start(free, START))
    assert only.startswith("another start: from the file's own first row the motion is exact")


def test_an_unknown_law_from_another_start_is_not_named(tmp_path: Path) -> None:
    """Another start explains nothing alone, and no fault of the catalogue stands beside it."""
    made = from_start(lambda w: free(w) + 0.05 * np.sin(3 * w[::-1]), START)
    assert titles(tmp_path, SCENE, made) == []


def test_a_fault_from_the_right_start_has_no_other_one(tmp_path: Path) -> None:
    """A file that begins as the scene does has a fault of the equations alone."""
    names = titles(tmp_path, SCENE, from_start(FAULTS["damping = 0.05"], [0.8, -0.5, 1.1]))
    assert not any("start" in each for each in names)


# The noise of a sensor: what is left by a cause has no memory.


HEAVIER = TENSOR + np.diag([0.0, 0.0, 0.15])
DAMPED: Law = lambda t, w, q: -0.07 * TENSOR @ w  # noqa: E731 (a law of one line)


def with_noise(made: Columns, size: float) -> Columns:
    draws = np.random.default_rng(7)
    rows = {name: np.array(made[name], float) for name in VECTORS["omega"]}
    return made | {n: (r + size * draws.standard_normal(len(r))).tolist() for n, r in rows.items()}


def by_rk45() -> Columns:
    """The right motion by a sound method at a coarse tolerance."""

    def rates(t: float, z: np.ndarray) -> np.ndarray:
        return np.r_[free(z[:3]), rate_of_turn(z[3:], z[:3])]

    z = solve_ivp(rates, (0, 8), np.r_[0.8, -0.5, 1.1, Q], t_eval=TIMES, rtol=2e-3, atol=1e-5).y.T
    return columns(TIMES, z, VECTORS["omega"])


@pytest.mark.parametrize(
    ("made", "words"),
    by_turns(
        [
            (lambda: rigid(gyro=0.0), "no gyroscopic term"),
            (lambda: rigid(HEAVIER), "I_33 = 3.2"),
            (lambda: rigid(moment=DAMPED), "damping = 0.07"),
            (lambda: rigid(), "omega contradicts the file's own attitude"),
            (by_rk45, None),
        ],
        5,
    ),
)
def test_a_fault_is_named_through_noise(
    made: Callable[[], Columns], words: str | None, tmp_path: Path
) -> None:
    """A cause of all rows stands out of noise; an error of steps has a memory, and no name."""
    sentences = titles(tmp_path, SCENE, with_noise(made(), 5e-5))
    assert [each[: len(words or "")] for each in sentences] == [words] * bool(words)


# Euler angles whose rates are taken for the body's.


def by_angles(factor: float) -> Columns:
    """Rows of the free body, and of roll, pitch and yaw that are integrals of p, q and factor r."""
    start = Rotation.from_quat(Q, scalar_first=True).as_euler("ZYX")[::-1]
    weights = np.array([1.0, 1.0, factor])
    solved = solve_ivp(
        lambda t, z: np.r_[free(z[:3]), weights * z[:3]],
        (0, TIMES[-1]),
        np.r_[0.8, -0.5, 1.1, start],
        "DOP853",
        t_eval=TIMES,
        rtol=3e-14,
        atol=1e-15,
    )
    omega, angles = np.split(solved.y.T, 2, axis=1)
    q = Rotation.from_euler("ZYX", angles[:, ::-1]).as_quat(scalar_first=True)
    return columns(TIMES, np.hstack([omega, q]), VECTORS["omega"])


@pytest.mark.parametrize(("factor", "is_named"), [(1.0, True), (1.02, False)])
def test_body_rates_taken_for_rates_of_angles_are_named(
    factor: float, is_named: bool, tmp_path: Path
) -> None:
    """Integrals of p, q and r in the place of roll, pitch and yaw are named; near ones are not."""
    sentences = titles(tmp_path, SCENE, by_angles(factor))
    assert [title.startswith("attitude by roll' = p") for title in sentences] == [True] * is_named


# Engines that cut a speed to a largest one after each step.


INERTIA = np.array([1.0, 2.2, 2.9])
FLIPPING = {"omega": [0.4, 3, 0.2], "attitude": [1, 0, 0, 0]}
RACKET = text_of({"inertia": [1, 2.2, 2.9]}, FLIPPING, 8, 81, "omega", "attitude")


def racket(w: Array) -> Array:
    return np.asarray(cross(INERTIA * w, w) / INERTIA)


def cut(cap: float, w: Array) -> Array:
    size = float(np.linalg.norm(w))
    return w * min(1.0, cap / size)


def clipped(cap: float, w: Array) -> Array:
    return np.clip(w, -cap, cap)


def stepped(limit: partial[Array], every: int) -> Columns:
    """Rows of fine steps, a limit after every so many of them, and a turn by the new omega."""
    h, w, q = 0.1 / every, np.array([0.4, 3.0, 0.2]), np.array([1.0, 0, 0, 0])
    made = [[*w, *q]]
    for step in range(1, 80 * every + 1):
        w = limit(rk4(racket, rk4(racket, w, h / 2)[0], h / 2)[0])
        q = turned(q, h * w)
        if step % every == 0:
            made.append([*w, *q])
    return columns(np.round(np.arange(81) * 0.1, 6), np.array(made), VECTORS["omega"])


@pytest.mark.parametrize("every", by_turns([5, 1], 2))
def test_a_speed_that_is_cut_again_and_again_is_named(every: int, tmp_path: Path) -> None:
    """The length of the rows is the cap wherever it acts; the step is that of the engine."""
    names = titles(tmp_path, RACKET, stepped(partial(cut, 2.8), every))
    words = f"omega is cut to the length 2.8 after each step, h = {0.1 / every:g}"
    assert any(words in each for each in names)


def test_a_cut_of_each_component_is_no_cut_of_the_length(tmp_path: Path) -> None:
    """A clip of single components is no cut of the length, and the word is not said."""
    names = titles(tmp_path, RACKET, stepped(partial(clipped, 2.8), 1))
    assert not any("cut to the length" in each for each in names)


def test_a_speed_below_the_cap_is_not_cut(tmp_path: Path) -> None:
    """A free motion that never reaches the cap has no word of it."""
    names = titles(tmp_path, RACKET, stepped(partial(cut, 9.0), 1))
    assert not any("cut to the length" in each for each in names)
