"""A pytest plugin: compares a simulator with the exact motion, in the tests of that simulator.

    def test_my_simulator(verify_solver):
        verify_solver("euler/generic", solve)

    @pytest.mark.verify_scenes("euler/*", "kirchhoff/screw", rung="f64")
    def test_my_simulator_on(verify_scene):
        verify_scene(solve)

``solve`` is a callable ``solve(problem) -> states`` as `taylor_verify.check` takes it, a Solver, or the
name of a solver such as ``"process:./my_simulator"``. Both fixtures and the marker take

    rung       the precision of the arithmetic, "f64"; the marker also several
    tolerance  the error that a coarse method is allowed, in place of what rounding leaves: one number for
               all quantities, or a number for each of some, as in `taylor_verify.run`
    only       the quantities that are judged, or "conserved" for all conserved ones

and the fixtures return the Judgement. Whatever is not a pass fails the test, undecided and vacuous
too, and so does a test that asks for a fixture and judges nothing with it. A solver that raises, or
calls `sys.exit` with any code, has failed. `os._exit`, or a crash in compiled code, ends the whole
session, which no plugin can prevent: judge such a solver as a program, ``process:COMMAND``.

Every pytest session of the environment loads this plugin. So only this module and the light ones of
`import taylor_verify` are imported before a scene is named, and no numerical library before one is run.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, NamedTuple, final

import pytest

if TYPE_CHECKING:
    from taylor_verify.judge.judgement import Judgement
    from taylor_verify.judge.tolerances import Tolerance
    from taylor_verify.scenes.scene import Scene
    from taylor_verify.solvers.solver import Solver
    from taylor_verify.testing.demand import Only

    Solve = Callable[[Any], Any] | Solver | str

_MARKER: Final = "verify_scenes"
_MARKER_LINE: Final = (
    f"{_MARKER}(*scenes, rung='f64', tolerance=None, only=None): run the test once for each scene "
    "(a name, a pattern such as 'euler/*', a folder such as 'extremes', or a file) and rung; the "
    "fixture verify_scene judges it"
)
_NOTE: Final = "taylor-verify"
_BLIND: Final = (
    "conserved quantities alone were judged. That does not certify a state: a motion with a wrong "
    "sign or a shifted time conserves them all"
)


@final
@dataclass
class SolverGate:
    """The fixture ``verify_solver``: judges a solver on a scene, and fails the test if it must.

    ``judged`` counts the judgements. ``notes`` are the user properties of the test, which reports show.
    """

    notes: list[tuple[str, object]] = field(default_factory=list)
    judged: int = 0

    def __call__(
        self,
        scene: Scene | Path | str,
        solve: Solve,
        rung: str = "f64",
        *,
        tolerance: Tolerance = None,
        only: Only = None,
    ) -> Judgement:
        __tracebackhide__ = True
        from taylor_verify.testing.demand import demanded_rows, is_met, report

        judgement, raised = _judgement(scene, solve, rung, tolerance)
        self.judged += 1
        try:
            demanded = demanded_rows(judgement, only)
        except ValueError as fault:
            raise pytest.fail.Exception(str(fault)) from None
        is_blind = all(verdict.is_conserved for verdict in demanded)
        if is_blind:
            self.notes.append((_NOTE, f"{judgement.verdicts[0].scene} on {rung}: {_BLIND}"))
        if not demanded or not all(is_met(verdict) for verdict in demanded):
            text = report(judgement, demanded)
            raise pytest.fail.Exception(f"{text}\n{_BLIND}" if is_blind else text) from raised
        return judgement


@final
@dataclass
class SceneGate:
    """The fixture ``verify_scene``: judges a solver on the scene and rung of the marker."""

    case: Case
    gate: SolverGate

    @property
    def scene(self) -> str:
        return self.case.scene

    @property
    def rung(self) -> str:
        return self.case.rung

    def __call__(
        self, solve: Solve, *, tolerance: Tolerance = None, only: Only = None
    ) -> Judgement:
        __tracebackhide__ = True
        return self.gate(
            self.scene,
            solve,
            self.rung,
            tolerance=self.case.tolerance if tolerance is None else tolerance,
            only=self.case.only if only is None else only,
        )


class Case(NamedTuple):
    """A run that a marker asks for."""

    scene: str
    rung: str
    tolerance: Tolerance
    only: Only


@pytest.fixture
def verify_solver(request: pytest.FixtureRequest) -> SolverGate:
    """Judge a solver: verify_solver(scene, solve, rung="f64", tolerance=None, only=None)."""
    return SolverGate(request.node.user_properties)


@pytest.fixture
def verify_scene(request: pytest.FixtureRequest) -> SceneGate:
    """Judge a solver on each scene of @pytest.mark.verify_scenes: verify_scene(solve)."""
    case = getattr(request, "param", None)
    if not isinstance(case, Case):
        pytest.fail(
            f"expected @pytest.mark.{_MARKER}('euler/generic', ...) on a test that asks for "
            "verify_scene, got none (or take verify_solver)",
            pytrace=False,
        )
    return SceneGate(case, SolverGate(request.node.user_properties))


def _judgement(
    scene: Scene | Path | str, solve: Solve, rung: str, tolerance: Tolerance
) -> tuple[Judgement, BaseException | None]:
    """Return the judgement, and the exception that a callable raised, whose traceback pytest then shows."""
    __tracebackhide__ = True
    from taylor_verify.chain import judge_scene
    from taylor_verify.judge.tolerances import tolerances
    from taylor_verify.numbers.precision import rung as rung_named
    from taylor_verify.records.faults import Refused
    from taylor_verify.scenes.reading.reader import as_scene
    from taylor_verify.solvers.callback import Callback
    from taylor_verify.solvers.registry import as_solver

    raised: list[BaseException] = []

    def answer(problem: Any, **settings: Any) -> Any:
        try:
            return given.answer(problem, **settings)
        except (Exception, SystemExit) as error:
            raised.append(error)
            raise

    try:
        scene = as_scene(scene)
        given: Any = as_solver(solve)
        solver = replace(given, answer=answer) if isinstance(given, Callback) else given
        exact_rung, asked = rung_named(rung), tolerances(tolerance, [scene])
    except (Refused, ValueError) as fault:
        raise pytest.fail.Exception(str(fault)) from None
    judgement = judge_scene(scene, solver, exact_rung, asked)
    return judgement, raised[0] if raised else None


# What pytest calls.


def pytest_configure(config: pytest.Config) -> None:
    config.addinivalue_line("markers", _MARKER_LINE)


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """Make a test for each scene and rung of its markers. A marker that would judge nothing fails."""
    marks = list(metafunc.definition.iter_markers(_MARKER))
    if marks and "verify_scene" in metafunc.fixturenames:
        cases = [case for mark in marks for case in _cases(mark)]
        ids = [f"{case.scene}-{case.rung}" for case in cases]
        metafunc.parametrize("verify_scene", cases, ids=ids, indirect=True)
    elif any(mark.name == _MARKER for mark in metafunc.definition.own_markers):
        pytest.fail(
            f"expected a test marked {_MARKER} to ask for the fixture verify_scene, got "
            f"{', '.join(metafunc.fixturenames) or 'none'}: nothing would be judged",
            pytrace=False,
        )


def _cases(mark: pytest.Mark) -> Iterator[Case]:
    from taylor_verify.numbers.precision import rung as rung_named
    from taylor_verify.records.faults import Refused
    from taylor_verify.scenes.library import find, named

    options: Mapping[str, Any] = mark.kwargs
    if unknown := sorted(options.keys() - {"rung", "tolerance", "only"}):
        _wrong_mark(f"expected rung, tolerance or only, got {', '.join(unknown)}")
    if not mark.args:
        _wrong_mark("expected scenes, such as 'euler/generic', got none")
    rungs = options.get("rung", "f64")
    ladder = [rungs] if isinstance(rungs, str) else [*rungs]
    if not ladder:
        _wrong_mark("expected rungs, such as 'f64', got none")
    try:
        # A word of a marker stands for scenes as on the command line.
        names = [name for word in mark.args for name in named(str(word))]
        for name in names:
            find(name)
        for rung in ladder:
            for name in names:
                rung_name = rung_named(rung).name
                yield Case(name, rung_name, options.get("tolerance"), options.get("only"))
    except (Refused, ValueError) as fault:
        _wrong_mark(str(fault))


def _wrong_mark(why: str) -> None:
    pytest.fail(f"{why} @ pytest.mark.{_MARKER}", pytrace=False)


@pytest.hookimpl(trylast=True)
def pytest_runtest_call(item: pytest.Item) -> None:
    """Fail a test that ran to its end and judged nothing.

    pytest's own implementation runs the test before this one, which is not called if the test raises.
    """
    values = getattr(item, "funcargs", {}).values()
    gates = [value.gate if isinstance(value, SceneGate) else value for value in values]
    if idle := [gate for gate in gates if isinstance(gate, SolverGate) and not gate.judged]:
        pytest.fail(
            f"expected the test to judge a solver with each of its gates, got {len(idle)} unused: "
            "call verify_solver(scene, solve) or verify_scene(solve)",
            pytrace=False,
        )


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """Name the green tests that judged conserved quantities alone."""
    notes = [
        f"{report.nodeid}: {text}"
        for report in terminalreporter.getreports("passed")
        for name, text in report.user_properties
        if name == _NOTE
    ]
    if notes:
        terminalreporter.section("taylor-verify")
        for note in dict.fromkeys(notes):
            terminalreporter.line(note)
