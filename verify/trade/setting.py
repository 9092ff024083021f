"""A setting: one solver, as it is set, on one rung; and the settings that a trade-off compares."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from typing import Final

from verify.models.units import natural_units
from verify.scenes.precision import Rung
from verify.scenes.precision import rung as rung_named
from verify.scenes.scene import Scene
from verify.solvers.registry import solver_named
from verify.solvers.solver import Solver
from verify.solvers.taylor.driver import Taylor, at_tolerance

RUNGS: Final = ("f32", "f64", "f80", "f128")
# Every third power of ten that is above twice the rung's roundoff, where its own tolerance begins.
_TOLERANCES: Final = tuple(f"1e-{digits}" for digits in range(3, 75, 3))
_SCIPY: Final = ("RK45", "DOP853", "Radau", "BDF", "LSODA")
_SCIPY_TOLERANCES: Final = ("1e-3", "1e-6", "1e-9", "1e-12")
_GEOMETRIC: Final = (
    *("implicit-midpoint", "splitting", "moser-veselov", "preprocessed-moser-veselov", "lie-rk4"),
)
# Of the scene's natural unit of time, in which its rates are of size one.
_STEPS: Final = (Fraction(1, 4), Fraction(1, 16), Fraction(1, 64))


@dataclass(frozen=True)
class Setting:
    """One way to solve a scene, ready to run.

    ``requested`` is the tolerance or the step that was asked for, the latter in the scene's unit of
    time, and ``asked`` says which. Settings of one ``family`` differ in nothing else, the cheapest
    first.
    """

    solver: Solver
    rung: Rung
    requested: float
    asked: str
    family: str

    @property
    def label(self) -> str:
        words = (self.solver.name, self.solver.setting, self.rung.name)
        return " ".join(word for word in words if word)


def settings(scene: Scene, rungs: Iterable[str] = RUNGS) -> tuple[Setting, ...]:
    """What there is to solve the scene with, family by family, the coarsest first.

    A solver that is not installed says so when it is asked to run.

    Raises ValueError for a name that is no rung.
    """
    found: list[Setting] = []
    for rung in map(rung_named, dict.fromkeys(rungs)):
        found += _taylor(rung)
        if rung.name == "f64":
            found += _scipy(rung)
            found += _geometric(scene, rung) if scene.model == "euler" else ()
    return tuple(found)


def _taylor(rung: Rung) -> Iterator[Setting]:
    """Each tolerance that the rung can hold, and the rung's own: heyoka's is the machine epsilon."""
    epsilon = float(2 * rung.unit_roundoff)
    for text in _TOLERANCES:
        # The last step down to epsilon would be another name for it.
        if float(text) > 10 * epsilon:
            yield Setting(at_tolerance(text), rung, float(text), "tolerance", f"taylor {rung.name}")
    yield Setting(Taylor(), rung, epsilon, "tolerance", f"taylor {rung.name}")


def _scipy(rung: Rung) -> Iterator[Setting]:
    for method in _SCIPY:
        for text in _SCIPY_TOLERANCES:
            solver = solver_named(f"scipy:{method}?rtol={text}&atol={text}")
            yield Setting(solver, rung, float(text), "tolerance", f"scipy {method}")


def _geometric(scene: Scene, rung: Rung) -> Iterator[Setting]:
    unit = natural_units(scene).time
    for method in _GEOMETRIC:
        for share in _STEPS:
            step = share * unit
            solver = solver_named(f"geometric:{method}?step={step}")
            yield Setting(solver, rung, float(step), "step", f"geometric {method}")
