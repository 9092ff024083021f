"""Setting: a solver with its options on a rung; and the lists of settings that a trade-off compares."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Final

from taylor_verify.models.registry import natural_units
from taylor_verify.numbers.precision import Rung
from taylor_verify.numbers.precision import rung as rung_named
from taylor_verify.records.precisions import FORMATS
from taylor_verify.scenes.bodies import RigidBody
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.engines.engine import Outside, engines
from taylor_verify.solvers.engines.peer import Peer
from taylor_verify.solvers.registry import PROCESS, TAYLOR, solver_named
from taylor_verify.solvers.solver import Solver
from taylor_verify.solvers.taylor.driver import Taylor
from taylor_verify.tradeoff.document import label

RUNGS: Final = tuple(FORMATS)
# Every third power of ten. A rung has those above its own tolerance, which is twice its roundoff.
_TOLERANCES: Final = tuple(f"1e-{digits}" for digits in range(3, 75, 3))
_SCIPY: Final = tuple(f"scipy:{name}" for name in ("RK45", "DOP853", "Radau", "BDF", "LSODA"))
# Tolerances of solvers of other libraries, the coarsest first.
LIBRARY_TOLERANCES: Final = ("1e-3", "1e-6", "1e-9", "1e-12")
# What begins anew at no switch and at no instant shows what that costs, and what stepping over them loses.
_UNSTOPPED: Final = "&stop=no"
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
# odefun takes tens of milliseconds for a natural unit of time, so that this limit is about ten seconds.
_LONGEST_FOR_ODEFUN: Final = 400

# The names of a solver and a rung, which are sent from process to process.
Name = tuple[str, str]

TOLERANCE, STEP, NOTHING = "tolerance", "step", ""
# The key of a solver's name that sets its accuracy, and the kind of that number.
_ASKED: Final = {"tol": TOLERANCE, "rtol": TOLERANCE, "step": STEP}


@dataclass(frozen=True)
class Setting:
    """A way to solve a scene, ready to run.

    ``requested`` is a tolerance, or a step in the scene's unit of time; ``asked`` is the word for it. They
    are None and empty for a solver that takes neither. Settings of one ``family`` differ in nothing but
    this number. ``withheld`` is the reason why the setting is not run, if there is one.
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
        """The names of the solver and the rung."""
        return self.solver.name, self.rung.name


def settings(scene: Scene, rungs: Iterable[str] = RUNGS) -> tuple[Setting, ...]:
    """Return all settings for a scene on the ``rungs``, family by family, the coarsest first.

    A solver that is not installed, or is not made for the scene, says so when it is run. Raises ValueError
    for a name that is no rung.
    """
    is_rigid, loads = isinstance(scene.body, RigidBody), scene.body.loads
    # Switches, or instants of held states, at which a solver begins anew.
    has_stops = loads is not None and bool(loads.switches or loads.held_states)
    all_settings: list[Setting] = []
    for rung in map(rung_named, dict.fromkeys(rungs)):
        all_settings += taylor(rung)
        if rung.name == "f64":
            all_settings += library(_SCIPY, LIBRARY_TOLERANCES, rung)
            if has_stops:
                all_settings += library(_SCIPY[:2], LIBRARY_TOLERANCES, rung, _UNSTOPPED)
            all_settings += geometric(scene, rung) if is_rigid else ()
            all_settings += odefun(scene, rung)
    return tuple(all_settings)


def chosen(names: Iterable[str], rungs: Iterable[str] = RUNGS) -> tuple[Setting, ...]:
    """Return taylor's settings for comparison, and the named solvers on each of the rungs that they have.

    A solver that has none of the rungs gets the first one, and says so when it is run. Raises ValueError
    for an unknown solver or rung.
    """
    ladder = [rung_named(name) for name in dict.fromkeys(rungs)]
    all_settings: list[Setting] = []
    for rung in ladder:
        all_settings += taylor(rung)
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

    They run on f64, which all of them have; without f64 among the ``rungs`` the result is empty. A library
    that is not available says so when it is run.
    """
    if "f64" not in rungs:
        return ()
    known = toleranced()
    wanted = known if only is None else set(only)
    names = [f"outside:{name}" for name in known if name in wanted]
    return tuple(library(names, tolerances, rung_named("f64")))


def toleranced() -> list[str]:
    """Return the names of the engines that take a tolerance, unlike those with fixed steps."""
    return [name for name, engine in engines().items() if "rtol" in engine.script.about.settings]


def setting(name: str, rung: Rung) -> Setting:
    """Return the setting of a solver by its name, which includes its tolerance or step.

    A library whose process stays between solves becomes a Peer, and is timed like the solvers of this
    process. Raises ValueError for an unknown solver.
    """
    solver = solver_named(name)
    if isinstance(solver, Outside) and solver.engine.script.about.serves:
        solver = Peer(solver)
    if isinstance(solver, Taylor):
        tolerance = 2 * rung.unit_roundoff if solver.tolerance is None else solver.tolerance
        family = f"taylor {rung.name}{' optimised' if solver.is_optimised else ''}"
        return Setting(solver, rung, float(tolerance), TOLERANCE, family)
    if name.startswith(PROCESS):
        # The options of a command that set its accuracy are unknown.
        return Setting(solver, rung, requested=None, asked=NOTHING, family=name)
    method, _, options = name.partition("?")
    family = method.replace(":", " ")
    if _UNSTOPPED in options:
        family += " without stops"
    for option in options.split("&"):
        key, _, value = option.partition("=")
        if key in _ASKED:
            accuracy = float(Fraction(value))
            return Setting(solver, rung, requested=accuracy, asked=_ASKED[key], family=family)
    return Setting(solver, rung, requested=None, asked=NOTHING, family=family)


def taylor(rung: Rung, tolerances: Iterable[str] = _TOLERANCES) -> Iterator[Setting]:
    """Yield taylor at each tolerance above the rung's own, and at its own, which is heyoka's epsilon."""
    for text in tolerances:
        # A tolerance within a factor of ten of epsilon would be nearly the same setting.
        if float(text) > 10 * float(2 * rung.unit_roundoff):
            yield setting(f"{TAYLOR}?tol={text}", rung)
    yield setting(TAYLOR, rung)


def library(
    solvers: Iterable[str], tolerances: Sequence[str], rung: Rung, option: str = ""
) -> Iterator[Setting]:
    """Yield each solver at each tolerance, both as the absolute and as the relative one."""
    for solver in solvers:
        for text in tolerances:
            yield setting(f"{solver}?rtol={text}&atol={text}{option}", rung)


def geometric(scene: Scene, rung: Rung) -> Iterator[Setting]:
    """Yield each geometric integrator at three steps."""
    unit = natural_units(scene).time
    for method in _GEOMETRIC:
        for share in _STEPS:
            yield setting(f"geometric:{method}?step={share * unit}", rung)


def odefun(scene: Scene, rung: Rung) -> Iterator[Setting]:
    """Yield mpmath's integrator; if the scene is too long, its settings are withheld."""
    span = max(abs(t) for t in scene.clock.elapsed) / natural_units(scene).time
    reason = f"{float(span):.3g} units of time, more than {_LONGEST_FOR_ODEFUN}, would take minutes"
    withheld = reason if span > _LONGEST_FOR_ODEFUN else ""
    for name in _ODEFUN:
        bare = setting(name, rung)
        # Without an option its tolerance is ten bits beyond the precision.
        requested = bare.requested or float(rung.unit_roundoff / 2**10)
        yield replace(bare, requested=requested, asked=TOLERANCE, withheld=withheld)
