"""heyoka, compiled: nothing is stored, no decimal comma reaches it, and time reversed is the same bits."""

from __future__ import annotations

import locale
import shutil
import subprocess
from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import heyoka as hy
import numpy as np
import pytest
from builders.processes import printed_by
from builders.scenes import LOADED, MOMENT, TENSOR, vector
from mpmath import mp

from taylor_verify.models.euler import euler_equations
from taylor_verify.models.form import Named
from taylor_verify.models.problem import pose
from taylor_verify.numbers.decimal_point import decimal_point
from taylor_verify.numbers.precision import rung
from taylor_verify.scenes.bodies import RigidBody
from taylor_verify.scenes.motion import Clock, Impulse, Motion, Spin
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.solver import Solver
from taylor_verify.solvers.taylor.driver import Taylor, compiled
from taylor_verify.solvers.trajectory import Outcome
from taylor_verify_reports.controls.defects import Defect


def test_heyoka_stores_nothing() -> None:
    """heyoka's own database, which damage turns into a crash, is never opened."""
    problem = pose(load("euler/generic"), rung("f64"))
    hy.llvm_state.set_diskcache_enabled(True)
    compiled.__wrapped__(problem.form, problem.rung, tolerance=None, is_optimised=True)
    assert not hy.llvm_state.get_diskcache_enabled()


# The locale.

COMMA = """
import locale
locale.setlocale(locale.LC_ALL, "de_DE.UTF-8")
from taylor_verify import run
print(run("euler/generic", rung="f128").passed, locale.localeconv()["decimal_point"])
"""


@pytest.fixture(scope="module")
def german(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the locale of Germany, whose decimal mark is a comma."""
    folder = tmp_path_factory.mktemp("locales")
    if not shutil.which("localedef"):
        pytest.skip("no localedef to make the locale de_DE with")
    words = ["localedef", "-i", "de_DE", "-f", "UTF-8", str(folder / "de_DE.UTF-8")]
    if subprocess.run(words, capture_output=True, check=False).returncode:
        pytest.skip("localedef cannot make the locale de_DE")
    return folder


def test_a_decimal_comma_reaches_no_code(german: Path) -> None:
    """heyoka is imported, and its code compiled, with decimal points; the comma comes back."""
    assert printed_by(COMMA, LOCPATH=str(german)) == "True ,\n"


def test_blocks_with_decimal_points_may_overlap(monkeypatch: pytest.MonkeyPatch) -> None:
    """The locale before the first block comes back behind the last, whoever ends it, and not before."""
    calls: list[str | None] = []

    def setlocale(category: int, name: str | None = None) -> str:
        assert category == locale.LC_NUMERIC
        calls.append(name)
        return "de_DE.UTF-8"

    monkeypatch.setattr(locale, "setlocale", setlocale)
    with decimal_point():
        with decimal_point():
            pass
        assert "de_DE.UTF-8" not in calls
    assert calls == [None, "C", "C", "de_DE.UTF-8"]


# Time reversed

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
