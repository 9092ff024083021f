"""The extremes: each agrees with its name, its truth is right, and the suite answers it."""

from __future__ import annotations

import re
from dataclasses import replace
from fnmatch import fnmatchcase
from fractions import Fraction
from hashlib import sha256
from typing import Any, Final, final

import numpy as np
import pytest
from mpmath import mp, mpf

import taylor_verify
from taylor_verify.cli import main
from taylor_verify.exact.elements import elements
from taylor_verify.exact.route import solution
from taylor_verify.models.problem import Problem, pose
from taylor_verify.numbers import tensors
from taylor_verify.numbers.precision import rung
from taylor_verify.records.status import Status
from taylor_verify.scenes import library
from taylor_verify.scenes.bodies import ImmersedBody, RigidBody
from taylor_verify.scenes.motion import Clock
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.solver import Solver
from taylor_verify.solvers.taylor.driver import Taylor
from taylor_verify.solvers.trajectory import Trajectory

NAMES: Final = library.names(library.EXTREMES)
_DIGITS: Final = 20


def extreme(name: str) -> Scene:
    return load(f"{library.EXTREMES}/{name}")


def at_end(scene: Scene, route: str | None = None, digits: int = _DIGITS) -> dict[str, Any]:
    """The exact motion at the last instant."""
    end = [scene.clock.elapsed[-1]]
    return {k: rows[0] for k, rows in solution(scene, route).motion(end, digits).quantities.items()}


def distance(a: Any, b: Any) -> Any:
    """|a - b| / |b| in the Frobenius norm."""
    return mp.norm(list((a - b).flat)) / mp.norm(list(b.flat))


# The files


@pytest.mark.parametrize("name", NAMES)
def test_every_extreme_loads_and_says_why_it_is_there(name: str) -> None:
    """Each extreme is read under its own name, has the model of its name, and a sentence as reason."""
    scene, text = load(name), library.find(name).read_text(encoding="utf-8")
    assert scene.name == name
    assert scene.model == name.removeprefix("extremes/").split("-")[0]
    assert scene.digest == sha256(text.encode()).hexdigest()
    comment = " ".join(line.lstrip("# ") for line in text.splitlines() if line.startswith("#"))
    assert comment.startswith("Why: ")
    assert comment.endswith(".")
    assert scene.source
    assert len(scene.clock.instants) <= 41


def test_the_table_of_the_readme_has_a_row_for_each() -> None:
    """Every extreme fits exactly one pattern of the table of families, and no pattern is idle."""
    readme = (library.cases_directory() / "README.md").read_text(encoding="utf-8")
    section = readme.split("## The extremes")[1].split("\n## ")[0]
    rows = [line.split("|")[2] for line in section.splitlines() if line.startswith("| ")]
    patterns = [pattern for row in rows for pattern in re.findall(r"`([^`]+)`", row)]
    stems = [name.removeprefix("extremes/") for name in NAMES]
    assert all(any(fnmatchcase(stem, p) for stem in stems) for p in patterns)
    assert {s: sum(fnmatchcase(s, p) for p in patterns) for s in stems} == dict.fromkeys(stems, 1)


# They are what they are called


DISTANCES = [n for n in NAMES if re.search(r"(axis|spin)-1e-\d+$", n) and "nearly" not in n]


@pytest.mark.parametrize("name", DISTANCES)
def test_the_distance_from_the_unstable_axis_is_as_named(name: str) -> None:
    """The one component off the axis is d, and the motion without it is steady and unstable."""
    scene, d = load(name), Fraction(name.rpartition("-1e")[2].join(["1e", ""]))
    first, others = scene.initial.moving[:3], scene.initial.moving[3:]
    off = [v for v in first if v and abs(v) < Fraction(1, 1000)]
    assert off == [d]
    onto = tuple(v if v != d else Fraction(0) for v in first)
    start = scene.initial.with_moving((*onto, *others))
    steady = elements(replace(scene, initial=start), 10)
    assert any("unstable" in sentence for sentence in steady.sentences)


@pytest.mark.parametrize("name", [n for n in NAMES if "modulus" in n])
def test_the_modulus_is_as_named(name: str) -> None:
    """1 - k^2 is what the name says, for Kirchhoff 0.476 of it, to a hundredth of itself."""
    scene, named = load(name), mpf(name.rpartition("modulus-")[2])
    share = mpf("0.476") if scene.model == "kirchhoff" else mpf(1)
    m_prime = elements(scene, 10)["m_prime"].value
    assert abs(m_prime / (share * named) - 1) <= mpf("0.01")


@pytest.mark.parametrize(
    ("name", "least", "most"),
    [
        ("euler-million-periods", 1e6, 1.1e6),
        ("euler-many-turns", 1e4, 1e5),
        ("kirchhoff-many-swings", 1000, 1001),
    ],
)
def test_a_long_run_has_its_periods(name: str, least: float, most: float) -> None:
    """The last instant is that many periods from the start."""
    scene = extreme(name)
    periods = scene.clock.elapsed[-1] / Fraction(str(elements(scene, 10)["period"].value))
    assert least <= periods <= most


def test_the_turned_body_is_the_straight_one() -> None:
    """Its tensor has the moments 1, 2, 3, and its start is (1e-8, 1, 0) in their axes."""
    scene, straight = extreme("euler-unstable-axis-turned"), extreme("euler-unstable-axis-1e-8")
    assert isinstance(scene.body, RigidBody)
    assert isinstance(straight.body, RigidBody)
    for power in range(1, 4):
        traces = []
        for body, start in ((scene.body, scene.initial), (straight.body, straight.initial)):
            omega = vector = start.moving
            for _ in range(power):
                vector = tensors.apply(body.inertia, vector)
            traces.append(tensors.dot(omega, vector))
        assert traces[0] == traces[1]


@pytest.mark.parametrize("name", [n for n in NAMES if "nearly-singular" in n])
def test_the_energy_is_nearly_singular(name: str) -> None:
    """The largest eigenvalue of T is at least 1e12 times its smallest."""
    body = load(name).body
    assert isinstance(body, ImmersedBody)
    with mp.workdps(40):
        matrix = mp.matrix([[mp.convert(v) for v in row] for row in body.energy_matrix])
        values = mp.eigsy(matrix, eigvals_only=True)
        assert max(values) / min(values) >= mpf("1e12")


# The truth, by two routes and by its own scaling


SCALED = [
    ("euler-omega-1e-150", Fraction(1, 10**150)),
    ("euler-omega-1e150", Fraction(10**150)),
    ("kirchhoff-impulses-1e-150", Fraction(1, 10**150)),
    ("kirchhoff-impulses-1e150", Fraction(10**150)),
]


@pytest.mark.parametrize(("name", "scale"), SCALED)
def test_a_faster_motion_is_the_same_one_sooner(name: str, scale: Fraction) -> None:
    """omega, x, y times s and time over s: the motion is s times the same, attitude and path alike."""
    scene = extreme(name)
    slower = scene.initial.with_moving(tuple(v / scale for v in scene.initial.moving))
    slow = replace(scene, initial=slower, clock=_longer(scene.clock, scale))
    fast, same = at_end(scene), at_end(slow)
    with mp.workdps(_DIGITS + 10):
        for quantity, value in fast.items():
            factor = 1 if quantity in ("attitude", "centre") else mp.convert(scale)
            assert distance(value, same[quantity] * factor) <= 4 * mpf(10) ** -_DIGITS


def _longer(clock: Clock, scale: Fraction) -> Clock:
    return Clock(clock.start * scale, tuple(t * scale for t in clock.instants))


@pytest.mark.parametrize("name", [n for n in NAMES if re.search(r"start-1e", n)])
def test_only_the_time_since_the_start_counts(name: str) -> None:
    """The same scene begun at 0 has the same motion to the last digit, and other instants."""
    scene = load(name)
    early = replace(scene, clock=Clock(Fraction(0), scene.clock.elapsed))
    late, soon = at_end(scene), at_end(early)
    assert all(np.array_equal(late[quantity], soon[quantity]) for quantity in late)
    given = pose(scene, rung("f64")).given.clock
    assert len(set(given.instants)) == len(scene.clock.instants)
    assert all(
        abs(g - t) <= abs(t) * rung("f64").unit_roundoff
        for g, t in zip(given.elapsed, scene.clock.elapsed, strict=True)
    )


# The suite answers them


@final
class Flushed(Solver):
    """heyoka on a start whose small components are zero: the body stays on its unstable axis for ever."""

    name = "flushed"

    def solve(self, problem: Problem) -> Trajectory:
        momenta = [n for n in problem.form.states if n[0] in "Hxy"]
        least = max(abs(problem.state[n]) for n in momenta) / 1000
        start = {n: v if n[0] == "e" or abs(v) >= least else 0 for n, v in problem.state.items()}
        return Taylor().solve(
            replace(problem, initial_momenta=tuple(map(Fraction, start.values())))
        )


@pytest.mark.parametrize(
    "name",
    [
        "euler-unstable-axis-1e-4",
        "euler-unstable-axis-1e-16",
        "kirchhoff-unstable-spin-1e-4",
        pytest.param("euler-unstable-axis-1e-8", marks=pytest.mark.slow),
        pytest.param("euler-unstable-axis-1e-40", marks=pytest.mark.slow),
    ],
)
def test_a_body_that_never_flips_has_no_green_state(name: str) -> None:
    """Its state fails, or the gate says that it sees nothing there; it is never a pass."""
    verdicts = {
        v.quantity: v.verdict
        for v in taylor_verify.run(f"extremes/{name}", Flushed(), causes=False).verdicts
    }
    states = {"omega", "impulse", "attitude"}.intersection(verdicts)
    assert states
    assert not [quantity for quantity in states if verdicts[quantity] is Status.PASS]


@pytest.mark.slow
def test_every_extreme_is_answered_as_expected_on_double_precision(
    capsys: pytest.CaptureFixture[str],
) -> None:
    """`run extremes` ends with status 0: what is no pass is listed, and what is listed came so."""
    assert main(["run", "extremes"]) == 0
    assert "not as expected" not in capsys.readouterr().out
