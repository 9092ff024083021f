"""Likely causes of an answer to a damped scene: the damping laws of engines, each by its name."""

from __future__ import annotations

from collections.abc import Callable
from math import exp
from pathlib import Path

import numpy as np
import pytest
from builders.trajectories import Columns, file_judgement, write_csv
from builders.turns import by_turns
from builders.wrong_dynamics import Array, Numbers, Rate, material, runge_kutta, simulated

from taylor_verify.judge.causes.search import likely_causes
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene

RIGID, FLUID = "euler/damped", "kirchhoff/damped"
# Of a step of damping c h = x.
EXPLICIT: Callable[[float], float] = lambda x: 1 - x  # noqa: E731 (a law in a row of a table)
IMPLICIT: Callable[[float], float] = lambda x: 1 / (1 + x)  # noqa: E731
EXPONENTIAL: Callable[[float], float] = lambda x: exp(-x)  # noqa: E731


def sentences(scene: Scene, columns: Columns) -> dict[str, str]:
    """The names and sentences of the causes of an answer whose states failed, whatever their errors."""
    with np.errstate(all="ignore"):
        causes = likely_causes(material(scene, columns), scene)
    return {cause.name: cause.sentence for cause in causes if cause.quantity != "attitude"}


def left_out(n: Numbers) -> None:
    n.damping = 0.0


def turned_round(n: Numbers) -> None:
    n.damping = -n.damping


def doubled(n: Numbers) -> None:
    n.damping = 2 * n.damping


def of_velocity(n: Numbers) -> Rate:
    """The rates with c times omega, or U and W, for c times the momenta."""

    def rate(z: Array, q: Array, n: Numbers) -> Array:
        from builders.wrong_dynamics import euler, kirchhoff

        c, n.damping = n.damping, 0.0
        free = (euler if len(z) == 3 else kirchhoff)(z, q, n)
        n.damping = c
        taken = np.linalg.solve(n.tensor, z) if len(z) == 3 else n.tensor @ z
        return free - c * taken

    return rate


@pytest.mark.parametrize(
    ("scene", "change", "name"),
    [
        (RIGID, left_out, "damping left out"),
        pytest.param(RIGID, turned_round, "damping with the other sign", marks=pytest.mark.slow),
        (RIGID, doubled, "another damping"),
        (FLUID, left_out, "damping left out"),
        pytest.param(FLUID, turned_round, "damping with the other sign", marks=pytest.mark.slow),
        pytest.param(FLUID, doubled, "another damping", marks=pytest.mark.slow),
    ],
)
def test_a_wrong_damping_is_named(scene: str, change: Callable[[Numbers], None], name: str) -> None:
    """Damping left out, turned round or doubled has its name, and no other."""
    assert set(sentences(load(scene), simulated(load(scene), change=change))) == {name}


@pytest.mark.parametrize("scene", by_turns([RIGID, FLUID], 2))
def test_damping_of_the_velocity_is_named(scene: str) -> None:
    """A moment -c omega in place of -c I omega, or -c U and -c W in a fluid, has its name, and no other."""
    causes = sentences(load(scene), simulated(load(scene), of_velocity(Numbers(load(scene)))))
    assert set(causes) == {"damping of the velocity"}


# A law in both places, on a rigid body and in a fluid by turns.
@pytest.mark.parametrize(
    ("first", "scene"),
    by_turns([(False, RIGID), (False, FLUID)], 2) + by_turns([(True, FLUID), (True, RIGID)], 2),
)
@pytest.mark.parametrize(
    ("factor", "name", "words"),
    [
        (EXPLICIT, "explicit damping step", "1 - c h"),
        (IMPLICIT, "implicit damping step", "1/(1 + c h)"),
        (EXPONENTIAL, "exponential damping step", "exp(-c h)"),
    ],
)
def test_the_factor_of_a_step_is_named(
    factor: Callable[[float], float], name: str, words: str, first: bool, scene: str
) -> None:
    """A factor once in a step has the name of its law, its place in the step, and the step itself."""
    h, every = (0.1, 10) if scene == RIGID else (0.05, 10)
    causes = sentences(
        load(scene), runge_kutta(load(scene), h, every, factor=factor, factor_first=first)
    )
    assert set(causes) == {name}
    place = "before" if first else "after"
    assert f"by {words} {place} the motion, with h = {h:g};" in causes[name]


@pytest.mark.parametrize("scene", by_turns([RIGID, FLUID], 2))
def test_a_sound_integrator_has_no_cause(scene: str) -> None:
    """The classical method with damping in its rates, and a fine one, are named for nothing."""
    assert sentences(load(scene), simulated(load(scene))) == {}
    assert not {
        name
        for name in sentences(load(scene), runge_kutta(load(scene), 0.1, 5))
        if "damping" in name
    }


def test_check_says_so(tmp_path: Path) -> None:
    """A file of an engine is judged, fails, and its law is in the likely causes."""
    columns = runge_kutta(load(RIGID), 1 / 60, 60, factor=EXPLICIT)
    judged = file_judgement(write_csv(tmp_path / "mine.csv", columns), RIGID)
    assert [cause.name for cause in judged.causes if cause.quantity == "omega"] == [
        "explicit damping step"
    ]
