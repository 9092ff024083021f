"""Settings: solvers with their options on a rung, and the settings of a trade-off."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Final

from taylor_verify.models.registry import natural_units
from taylor_verify.records.precisions import FORMATS
from taylor_verify.scenes.bodies import RigidBody
from taylor_verify.scenes.precision import Rung
from taylor_verify.scenes.precision import rung as rung_named
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.engines.engine import Outside, engines
from taylor_verify.solvers.engines.peer import Peer
from taylor_verify.solvers.registry import CLOSED_FORM, PROCESS, TAYLOR, solver_named
from taylor_verify.solvers.solver import Solver
from taylor_verify.solvers.taylor.driver import Taylor
from taylor_verify.studies.tradeoff.document import label

RUNGS: Final = tuple(FORMATS)
# Every third power of ten. A rung takes those above its own tolerance, which is twice its roundoff.
_TOLERANCES: Final = tuple(f"1e-{digits}" for digits in range(3, 75, 3))
_SCIPY: Final = tuple(f"scipy:{name}" for name in ("RK45", "DOP853", "Radau", "BDF", "LSODA"))
# Tolerances of solvers of other libraries, the coarsest first.
LIBRARY_TOLERANCES: Final = ("1e-3", "1e-6", "1e-9", "1e-12")
_GEOMETRIC: Final = (
    "implicit-midpoint",
    "splitting",
    "moser-veselov",
    "preprocessed-moser-veselov",
    "lie-rk4",
)
# Steps relative to the scene's natural unit of time, in which its rates are of size one.
_STEPS: Final = (Fraction(1, 4), Fraction(1, 16), Fraction(1, 64))
_ODEFUN: Final = ("mpmath:odefun?tol=1e-6", "mpmath:odefun")
# odefun takes some ten milliseconds for a unit of time, so that this limit is about ten seconds.
_LONGEST_FOR_ODEFUN: Final = 400
ELLIPJ: Final = "closed-form:ellipj"

# The names of a solver and a rung, which are sent from process to process.
Name = tuple[str, str]

TOLERANCE, STEP, NOTHING = "tolerance", "step", ""
# The key of a solver's name that sets its accuracy, and the kind of that number.
_ASKED: Final = {"tol": TOLERANCE, "rtol": TOLERANCE, "step": STEP}


@dataclass(frozen=True)
class Setting:
    """A way to solve a scene, ready to run.

    ``requested`` is the tolerance or the step, the latter in the scene's unit of time, and ``asked`` says
    which; they are None and empty for a solver that takes neither. Settings of one ``family`` differ in
    nothing else, the cheapest first. ``withheld`` is the reason if the setting is not run.
    """

    solver: Solver
    rung: Rung
    requested: float | None
    asked: str
    family: str
    withheld: str = ""

    @property
    def label(self) -> str:
        """Solver, setting and rung in one printed line."""
        return label(self.solver.name, self.solver.setting, self.rung.name)

    @property
    def name(self) -> Name:
        return self.solver.name, self.rung.name

    @property
    def is_integrator(self) -> bool:
        """True for a solver that steps through the times before a sample."""
        return not self.solver.name.startswith(CLOSED_FORM)


def settings(scene: Scene, rungs: Iterable[str] = RUNGS) -> tuple[Setting, ...]:
    """Return all settings for a scene, family by family, the coarsest first.

    A solver that is not installed, or is not made for the scene, reports it when it is run.

    Raises ValueError for a name that is no rung.
    """
    is_rigid = isinstance(scene.body, RigidBody)
    all_settings: list[Setting] = []
    for rung in map(rung_named, dict.fromkeys(rungs)):
        all_settings += taylor(rung)
        if rung.name == "f64":
            all_settings += library(_SCIPY, LIBRARY_TOLERANCES, rung)
            all_settings += geometric(scene, rung) if is_rigid else ()
            all_settings += odefun(scene, rung)
            all_settings += [setting(ELLIPJ, rung)] if is_rigid else []
    return tuple(all_settings)


def chosen(names: Iterable[str], rungs: Iterable[str] = RUNGS) -> tuple[Setting, ...]:
    """Return the solvers of these names on each of their rungs, and taylor's settings as yardstick.

    A solver that has none of the rungs gets the first one, and reports the reason. Raises ValueError for an
    unknown solver or rung.
    """
    ladder = [rung_named(name) for name in dict.fromkeys(rungs)]
    all_settings = [one for rung in ladder for one in taylor(rung)]
    for name in names:
        solver = solver_named(name)
        known = [rung for rung in ladder if not solver.unavailable(rung)]
        all_settings += [setting(name, rung) for rung in known or ladder[:1]]
    return tuple(dict.fromkeys(all_settings))


def outside(
    rungs: Iterable[str] = RUNGS,
    only: Iterable[str] | None = None,
    tolerances: Sequence[str] = LIBRARY_TOLERANCES,
) -> tuple[Setting, ...]:
    """Return the integrators of other libraries, or ``only`` those named, at each of the ``tolerances``.

    They are on f64, which all have; there are none if the ``rungs`` lack it. A library that is not
    available reports it when it is run.
    """
    if "f64" not in rungs:
        return ()
    known = toleranced()
    wanted = known if only is None else set(only)
    names = [f"outside:{name}" for name in known if name in wanted]
    return tuple(library(names, tolerances, rung_named("f64")))


def toleranced() -> list[str]:
    """Return the names of the engines that have a tolerance, as those with fixed steps do not."""
    return [name for name, engine in engines().items() if "rtol" in engine.script.about.settings]


def setting(name: str, rung: Rung) -> Setting:
    """Return the setting of a solver by its name, which includes its tolerance or step.

    A library whose script stays in memory is a peer, timed like the solvers of this process. Raises
    ValueError for an unknown solver.
    """
    solver = solver_named(name)
    if isinstance(solver, Outside) and solver.engine.script.about.serves:
        solver = Peer(solver)
    if isinstance(solver, Taylor):
        tolerance = 2 * rung.unit_roundoff if solver.tolerance is None else solver.tolerance
        code = " optimised" if solver.is_optimised else ""
        return Setting(solver, rung, float(tolerance), TOLERANCE, f"taylor {rung.name}{code}")
    if name.startswith(PROCESS):
        # The options of a command that set its accuracy are unknown.
        return Setting(solver, rung, None, NOTHING, name)
    family, _, options = name.partition("?")
    for part in options.split("&"):
        key, _, value = part.partition("=")
        if key in _ASKED:
            accuracy = float(Fraction(value))
            return Setting(solver, rung, accuracy, _ASKED[key], family.replace(":", " "))
    return Setting(solver, rung, None, NOTHING, family.replace(":", " "))


def taylor(rung: Rung, tolerances: Iterable[str] = _TOLERANCES) -> Iterator[Setting]:
    """Yield taylor at each tolerance above the rung's own, and at that one, heyoka's machine epsilon."""
    for text in tolerances:
        # A tolerance within a factor of ten of epsilon would be nearly the same setting.
        if float(text) > 10 * float(2 * rung.unit_roundoff):
            yield setting(f"{TAYLOR}?tol={text}", rung)
    yield setting(TAYLOR, rung)


def library(solvers: Iterable[str], tolerances: Sequence[str], rung: Rung) -> Iterator[Setting]:
    """Yield each solver at each tolerance, which is both absolute and relative."""
    for solver in solvers:
        for text in tolerances:
            yield setting(f"{solver}?rtol={text}&atol={text}", rung)


def geometric(scene: Scene, rung: Rung) -> Iterator[Setting]:
    """Yield each geometric integrator at three steps."""
    unit = natural_units(scene).time
    for method in _GEOMETRIC:
        for share in _STEPS:
            yield setting(f"geometric:{method}?step={share * unit}", rung)


def odefun(scene: Scene, rung: Rung) -> Iterator[Setting]:
    """Yield mpmath's integrator, withheld from a scene that is too long for it."""
    span = max(abs(t) for t in scene.clock.elapsed) / natural_units(scene).time
    long = f"{float(span):.3g} units of time, more than {_LONGEST_FOR_ODEFUN}, would take minutes"
    withheld = long if span > _LONGEST_FOR_ODEFUN else ""
    for name in _ODEFUN:
        made = setting(name, rung)
        # Its own tolerance is ten bits beyond the precision, so that the cheaper setting is first.
        requested = made.requested or float(rung.unit_roundoff / 2**10)
        yield replace(made, requested=requested, asked=TOLERANCE, withheld=withheld)
