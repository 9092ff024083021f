"""A setting: one solver, as it is set, on one rung; and the settings that a trade-off compares."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from typing import Final

from taylor_verify.models.registry import natural_units
from taylor_verify.records.precisions import FORMATS
from taylor_verify.scenes.bodies import RigidBody
from taylor_verify.scenes.precision import Rung
from taylor_verify.scenes.precision import rung as rung_named
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.registry import CLOSED_FORM, PROCESS, solver_named
from taylor_verify.solvers.solver import Solver
from taylor_verify.solvers.taylor.driver import Taylor, at_tolerance

RUNGS: Final = tuple(FORMATS)
# Every third power of ten that is above twice the rung's roundoff, where its own tolerance begins.
_TOLERANCES: Final = tuple(f"1e-{digits}" for digits in range(3, 75, 3))
_SCIPY: Final = ("RK45", "DOP853", "Radau", "BDF", "LSODA")
# What a solver of any other library is asked for, the coarsest first.
LIBRARY_TOLERANCES: Final = ("1e-3", "1e-6", "1e-9", "1e-12")
_GEOMETRIC: Final = (
    *("implicit-midpoint", "splitting", "moser-veselov", "preprocessed-moser-veselov", "lie-rk4"),
)
# Of the scene's natural unit of time, in which its rates are of size one.
_STEPS: Final = (Fraction(1, 4), Fraction(1, 16), Fraction(1, 64))
_ODEFUN: Final = ("mpmath:odefun?tol=1e-6", "mpmath:odefun")
# odefun takes some ten milliseconds for a unit of time, so that this is a matter of ten seconds.
_LONGEST_FOR_ODEFUN: Final = 400
_ELLIPJ: Final = "closed-form:ellipj"

TOLERANCE, STEP, NOTHING = "tolerance", "step", ""
# By which key of its name a solver is told how accurate to be, and what that number is.
_ASKED: Final = {"tol": TOLERANCE, "rtol": TOLERANCE, "step": STEP}


def label(solver: Solver, rung: Rung) -> str:
    """Solver, setting and rung in one line, as they are printed."""
    return " ".join(word for word in (solver.name, solver.setting, rung.name) if word)


@dataclass(frozen=True)
class Setting:
    """One way to solve a scene, ready to run.

    ``requested`` is the tolerance or the step that was asked for, the latter in the scene's unit of
    time, and ``asked`` says which; None and empty for a solver that takes neither. Settings of one
    ``family`` differ in nothing else, the cheapest first. ``withheld`` says why it is not run.
    """

    solver: Solver
    rung: Rung
    requested: float | None
    asked: str
    family: str
    withheld: str = ""

    @property
    def label(self) -> str:
        """Solver, setting and rung in one line."""
        return label(self.solver, self.rung)

    @property
    def is_integrator(self) -> bool:
        """Whether it gets to a time by way of the times before."""
        return not self.solver.name.startswith(CLOSED_FORM)


def settings(scene: Scene, rungs: Iterable[str] = RUNGS) -> tuple[Setting, ...]:
    """What there is to solve the scene with, family by family, the coarsest first.

    A solver that is not installed, or is not made for the scene, says so when it is asked to run.

    Raises ValueError for a name that is no rung.
    """
    found: list[Setting] = []
    for rung in map(rung_named, dict.fromkeys(rungs)):
        found += taylor(rung)
        if rung.name == "f64":
            found += library(_SCIPY, LIBRARY_TOLERANCES, rung)
            found += geometric(scene, rung) if isinstance(scene.body, RigidBody) else ()
            found += odefun(scene, rung)
            found += [setting(_ELLIPJ, rung)] if isinstance(scene.body, RigidBody) else []
    return tuple(found)


def chosen(names: Iterable[str], rungs: Iterable[str] = RUNGS) -> tuple[Setting, ...]:
    """The solvers of these names on every rung that they know, and taylor's as the yardstick.

    A solver that knows none of the rungs stands on the first, to say why. Raises ValueError for a
    name that is no solver or no rung.
    """
    named = list(dict.fromkeys(names))
    ladder = [rung_named(name) for name in dict.fromkeys(rungs)]
    found = [one for rung in ladder for one in taylor(rung)]
    for name in named:
        solver = solver_named(name)
        known = [rung for rung in ladder if not solver.unavailable(rung)]
        found += [setting(name, rung) for rung in known or ladder[:1]]
    return tuple(dict.fromkeys(found))


def outside(
    rungs: Iterable[str] = RUNGS,
    only: Iterable[str] | None = None,
    tolerances: Iterable[str] = LIBRARY_TOLERANCES,
) -> tuple[Setting, ...]:
    """The integrators of other libraries, or ``only`` those of these names, at each of the ``tolerances``.

    They are on f64, which all have: none where the ``rungs`` are without it. One that cannot be had
    says so when it is asked to run.
    """
    from taylor_verify.solvers.engines.engine import engines

    if "f64" not in rungs:
        return ()
    wanted = None if only is None else set(only)
    # An engine of fixed steps has no tolerance to choose.
    toleranced = [name for name, one in engines().items() if "rtol" in one.script.about.settings]
    names = [name for name in toleranced if wanted is None or name in wanted]
    return tuple(library(names, tolerances, rung_named("f64"), "outside:"))


def setting(name: str, rung: Rung) -> Setting:
    """The setting of a solver by its name, which says how accurate it is asked to be.

    Raises ValueError for a name that is no solver.
    """
    solver = solver_named(name)
    if isinstance(solver, Taylor) and solver.tolerance is None:
        epsilon = float(2 * rung.unit_roundoff)
        return Setting(solver, rung, epsilon, TOLERANCE, f"taylor {rung.name}")
    key, requested = _requested(name)
    family = _family(name)
    family = f"{family} {rung.name}" if isinstance(solver, Taylor) else family
    return Setting(solver, rung, requested, _ASKED.get(key, NOTHING), family)


def _requested(name: str) -> tuple[str, float | None]:
    """The key that asks for an accuracy and its number; a command of one's own asks for none."""
    if name.startswith(PROCESS):
        return "", None
    for part in name.partition("?")[2].split("&"):
        key, _, value = part.partition("=")
        if key in _ASKED:
            return key, float(Fraction(value))
    return "", None


def _family(name: str) -> str:
    return name if name.startswith(PROCESS) else name.partition("?")[0].replace(":", " ")


def taylor(rung: Rung, tolerances: Iterable[str] = _TOLERANCES) -> Iterator[Setting]:
    """Each tolerance that the rung can hold, and the rung's own: heyoka's is the machine epsilon."""
    epsilon = float(2 * rung.unit_roundoff)
    for text in tolerances:
        # The last step down to epsilon would be another name for it.
        if float(text) > 10 * epsilon:
            solver = at_tolerance(text)
            yield Setting(solver, rung, float(text), TOLERANCE, f"taylor {rung.name}")
    yield setting("taylor", rung)


def library(
    methods: Iterable[str], tolerances: Iterable[str], rung: Rung, prefix: str = "scipy:"
) -> Iterator[Setting]:
    """Each method at each tolerance, absolute and relative the same."""
    tolerances = tuple(tolerances)
    for method in methods:
        for text in tolerances:
            yield setting(f"{prefix}{method}?rtol={text}&atol={text}", rung)


def geometric(scene: Scene, rung: Rung) -> Iterator[Setting]:
    """Each geometric integrator at three steps."""
    unit = natural_units(scene).time
    for method in _GEOMETRIC:
        for share in _STEPS:
            yield setting(f"geometric:{method}?step={share * unit}", rung)


def odefun(scene: Scene, rung: Rung) -> Iterator[Setting]:
    """mpmath's integrator, on a scene that is short enough for it."""
    span = max(abs(t) for t in scene.clock.elapsed) / natural_units(scene).time
    long = f"{float(span):.3g} units of time, more than {_LONGEST_FOR_ODEFUN}, would take minutes"
    for name in _ODEFUN:
        made = setting(name, rung)
        # Its own tolerance: ten bits beyond the precision, and so the cheaper one is first.
        requested = made.requested or float(rung.unit_roundoff / 2**10)
        withheld = long if span > _LONGEST_FOR_ODEFUN else ""
        yield Setting(made.solver, rung, requested, TOLERANCE, made.family, withheld)
