"""Manufactured motions: the enclosure under their loads contains them, and broken equations do not pass."""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from builders.turns import by_turns
from mpmath import mp, mpf

from taylor_verify.exact.conditioning.condition import transition
from taylor_verify.exact.enclosure import flow
from taylor_verify.exact.route import solution
from taylor_verify.models.algebra import add, apply, cross
from taylor_verify.models.euler import euler_equations
from taylor_verify.models.form import Equations, Named, labelled
from taylor_verify.models.kirchhoff import kirchhoff_equations, velocities
from taylor_verify.models.problem import Problem
from taylor_verify.records.precisions import LADDER
from taylor_verify.records.status import Status
from taylor_verify.run import run
from taylor_verify.scenes import library
from taylor_verify.scenes.loads.manufactured import Manufactured, Wave
from taylor_verify.scenes.motion import Clock, Motion
from taylor_verify.scenes.reading.reader import load, read
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.registry import solver_named
from taylor_verify.solvers.solver import Solver
from taylor_verify.solvers.taylor.driver import Taylor
from taylor_verify.solvers.trajectory import Trajectory

NAMES = library.names("manufactured")
EULER = "manufactured/euler-full-tensor"
KIRCHHOFF = "manufactured/kirchhoff-tones"


def written(name: str) -> Manufactured:
    """The motion that a scene file writes down, read apart from the product's reader."""
    import tomllib
    from decimal import Decimal

    document = tomllib.loads(library.find(name).read_text(), parse_float=Decimal)
    tables = list(document["manufactured"].values())
    frequencies = sorted({Fraction(term["frequency"]) for table in tables for term in table})

    def column(frequency: Fraction, key: str) -> tuple[Fraction, ...]:
        zero = {key: [0, 0, 0]}
        terms = (
            next((t for t in table if Fraction(t["frequency"]) == frequency), zero)
            for table in tables
        )
        return tuple(Fraction(c) for term in terms for c in term.get(key, [0, 0, 0]))

    waves = tuple(Wave(nu, column(nu, "cosine"), column(nu, "sine")) for nu in frequencies if nu)
    return Manufactured(column(Fraction(0), "cosine"), waves)


def missed(motion: Motion, chosen: Manufactured, elapsed: list[Fraction]) -> list[mpf]:
    """How far the rows of a motion lie outside their radii from the chosen one; none is positive."""
    names = [n for n in ("omega", "linear_impulse", "angular_impulse") if n in motion.quantities]
    left = []
    with mp.workdps(70):
        for k, t in enumerate(elapsed):
            row = [mp.convert(z) for z in chosen.constant]
            for wave in chosen.waves:
                c, s = mp.cos_sin(mp.convert(wave.frequency * t))
                pairs = zip(row, wave.cosine, wave.sine, strict=True)
                row = [z + mp.convert(a) * c + mp.convert(b) * s for z, a, b in pairs]
            for j, name in enumerate(names):
                part = row[3 * j : 3 * j + 3]
                apart = mp.norm([a - b for a, b in zip(motion[name][k], part, strict=True)])
                left.append(apart - motion.radius[k] * mp.norm(part))
    return left


# The truth.


@pytest.mark.parametrize("name", NAMES)
def test_the_enclosure_contains_the_chosen_motion(name: str) -> None:
    """The cosines and sines of the file are within proven radii of thirty digits, at every sample."""
    scene = replace(load(name), track=frozenset())
    elapsed = list(scene.clock.elapsed)
    motion = solution(scene).motion(elapsed, 30)
    assert solution(scene).route == "taylor"
    assert max(missed(motion, written(name), elapsed)) <= 0


def test_the_attitude_about_a_fixed_axis_is_known() -> None:
    """From rest about one axis, omega = a sin t turns the body by |a| (1 - cos t): R = R0 exp([angle]x)."""
    name = "manufactured/euler-from-rest"
    elapsed = [Fraction(1, 2), Fraction(4), Fraction(8)]
    start, *attitudes = solution(load(name)).motion([Fraction(0), *elapsed], 40)["attitude"]
    with mp.workdps(50):
        axis = [mp.convert(c) for c in written(name).waves[0].sine]
        for t, R in zip(elapsed, attitudes, strict=True):
            angle = 1 - mp.cos(mp.convert(t))
            x, y, z = (angle * c for c in axis)
            turned = mp.expm(mp.matrix([[0, -z, y], [z, 0, -x], [-y, x, 0]]))
            expected = np.array(start) @ np.array(turned.tolist(), dtype=object)
            assert np.max(np.abs(R - expected)) <= mpf(10) ** -38


def test_the_derivative_has_the_orders_of_the_waves(monkeypatch: pytest.MonkeyPatch) -> None:
    """Long steps over small fast waves have a derivative that twice as many orders do not change."""
    scene = load("manufactured/euler-resonance")
    elapsed = [Fraction(0), Fraction(20)]
    own = flow._order
    matrices = []
    for factor in (1, 2):
        monkeypatch.setattr(flow, "_order", lambda *given, by=factor: by * own(*given))
        matrices.append(transition(scene, elapsed).carried.since_first[-1])
    assert np.max(abs(matrices[0] - matrices[1])) <= 1e-4 * np.max(abs(matrices[1]))


# What is broken is found.


def gyroscopic_sign(n: Named) -> dict[str, Any]:
    """H' = K H x H + M."""
    H, K = n.vector("H"), n.symmetric("K")
    return dict(euler_equations(n)) | labelled("H", add(cross(apply(K, H), H), n.vector("M")))


def no_gyroscopic_term(n: Named) -> dict[str, Any]:
    return dict(euler_equations(n)) | labelled("H", n.vector("M"))


def diagonal_tensor(n: Named) -> dict[str, Any]:
    return dict(
        euler_equations(Named({k: v for k, v in n.items() if k not in ("K12", "K13", "K23")}))
    )


def no_munk_couple(n: Named) -> dict[str, Any]:
    """y' = y x Omega + L, without x x U."""
    x, y = n.vector("x"), n.vector("y")
    _, Omega = velocities(x, y, n.symmetric("A"), n.matrix("B"), n.symmetric("C"))
    return dict(kirchhoff_equations(n)) | labelled("y", add(cross(y, Omega), n.vector("L")))


def transposed_coupling(n: Named) -> dict[str, Any]:
    """The row of B taken for the index of y."""
    swapped = {f"B{i}{j}": n[f"B{j}{i}"] for i in (1, 2, 3) for j in (1, 2, 3)}
    return dict(kirchhoff_equations(Named({**n, **swapped})))


BROKEN = [
    *((EULER, f) for f in (gyroscopic_sign, no_gyroscopic_term, diagonal_tensor)),
    *((KIRCHHOFF, f) for f in (no_munk_couple, transposed_coupling)),
]


@dataclass(frozen=True)
class Twin(Solver):
    """The Taylor driver with other equations under the same loads."""

    free: Equations
    name: str = "twin"
    setting: str = ""
    takes_loads = True

    def solve(self, problem: Problem) -> Trajectory:
        return Taylor().solve(problem.with_equations(self.free))


def beginning_of(name: str) -> Scene:
    """The first instants of a scene."""
    scene = load(name)
    first = tuple(scene.clock.instants[:5])
    return replace(scene, clock=Clock(scene.clock.start, first))


@pytest.mark.parametrize(
    ("name", "equations", "status"),
    [
        (EULER, euler_equations, Status.PASS),
        (KIRCHHOFF, kirchhoff_equations, Status.PASS),
        *((name, broken, Status.FAIL) for name, broken in BROKEN),
    ],
)
def test_broken_equations_under_the_right_loads_fail_and_the_right_ones_pass(
    name: str, equations: Equations, status: Status
) -> None:
    """The loads share no cross product with the equations: what one lacks is not undone by the other."""
    judged = run(beginning_of(name), Twin(equations), "f64", causes=False)
    assert judged.verdicts[1].verdict is status


# Scenes, and who is not made for them.


@pytest.mark.parametrize("step", by_turns(LADDER))
def test_a_motion_that_stands_still_is_answered(step: str) -> None:
    """A constant omega under the moment that holds it there: no wave, and the rest as ever."""
    text = library.find(EULER).read_text()
    lines = [line for line in text.splitlines() if "frequency = 1" not in line]
    scene = read("\n".join(lines), "still")
    assert run(scene, "taylor", step).verdicts[1].verdict is Status.PASS


@pytest.mark.parametrize("solver", ["outside:cvode-bdf", "geometric:moser-veselov?step=0.1"])
def test_who_is_not_told_of_the_loads_is_not_asked(solver: str) -> None:
    """A solver that would answer for another problem is unavailable, and not wrong."""
    assert run(EULER, solver_named(solver), "f64").verdicts[0].verdict is Status.UNAVAILABLE
