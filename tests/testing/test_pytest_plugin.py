"""The pytest plugin: two lines in another project judge a simulator, and say what is wrong with it."""

from __future__ import annotations

from typing import Any

import pytest

from taylor_verify import check
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict
from taylor_verify.testing.demand import is_met

pytest_plugins = ["pytester"]

# The plugin, and the modules of the package's own functions.
NAMES = """certify check exact explain numbers numbers.working_precision records records.version
run run_many scenes sweep testing testing.plugin tradeoff types"""
LIGHT = {f"taylor_verify.{name}" for name in NAMES.split()}
HEAVY = {"flint", "gmpy2", "heyoka", "mpmath", "numpy", "rich"}


@pytest.fixture(autouse=True, scope="module")
def _loaded() -> None:
    """Load what judges a wrong answer, with its diagnosis, before any session inside this one.

    pytester forgets what such a session is the first to import. The next one would load it a second time
    beside the first, with classes and a working precision of its own.
    """
    check("euler/generic", lambda problem: [problem.given.initial.omega] * len(problem.times))


# A body of three equal moments keeps its omega: on euler/spherical `still` is exact, elsewhere wrong.
SOLVERS = """
import pytest

def still(problem):
    return [problem.given.initial.omega] * len(problem.times)

def too_fast(problem):
    return [[w * (1 + 2**-20) for w in row] for row in still(problem)]

def nan(problem):
    return [[float("nan")] * 3] * len(problem.times)

def raising(problem):
    depth = 0
    return 1 / depth
"""


@pytest.fixture(autouse=True)
def _as_in_another_project(monkeypatch: pytest.MonkeyPatch) -> None:
    """Only this plugin, and from this checkout, whatever is installed beside it."""
    monkeypatch.setenv("PYTEST_DISABLE_PLUGIN_AUTOLOAD", "1")


def session(pytester: pytest.Pytester, tests: str, *options: str) -> pytest.RunResult:
    pytester.makepyfile(SOLVERS + tests)
    plugins = ("-p", "taylor_verify.testing.plugin", "-p", "no:cacheprovider")
    return pytester.runpytest_inprocess(*plugins, *options)


# What passes and what fails.


def test_two_lines_are_enough(pytester: pytest.Pytester) -> None:
    """A test of two lines passes with a solver that is right, and hands back its judgement."""
    tests = """
def test_my_simulator(verify_solver):
    verify_solver("euler/spherical", still)

def test_its_judgement(verify_solver):
    found = verify_solver("euler/spherical", still, rung="f32")
    assert {v.quantity for v in found.verdicts} == {"initial state", "omega", "T", "H2"}
"""
    session(pytester, tests).assert_outcomes(passed=2)


def test_a_wrong_solver_fails_with_all_a_person_needs(pytester: pytest.Pytester) -> None:
    """Which solver and scene, quantity, size, time, against what, bound, why; and the user's line."""
    tests = """
def test_my_simulator(verify_solver):
    verify_solver("euler/generic", still)
"""
    result = session(pytester, tests)
    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines(
        [
            '>       verify_solver("euler/generic", still)',
            "E       Failed: fail, likely cause: no gyroscopic term; worst: omega: *",
            "E       still on euler/generic, f64, against the exact motion * data (*): 1 of 4 * no pass",
            "E       fail  euler/generic f64 omega: no digit is right at t = * (error *); *; larger than "
            "f64 * since t = *; largest error * (max|omega|) * is allowed; up to * times what perfect *",
            "E       pass  euler/generic f64 T: *",
            "E       pass  euler/generic f64 H2: *",
            "E       likely cause: euler/generic f64: no gyroscopic term; *",
        ]
    )
    # Nothing of the plugin's own between the user's line and the message.
    assert "pytest_plugin.py" not in result.stdout.str()


def test_what_a_callable_raises_is_shown_where_it_rose(pytester: pytest.Pytester) -> None:
    """The traceback leads into the user's own code, and the test fails."""
    result = session(
        pytester, 'def test_it(verify_solver):\n    verify_solver("euler/spherical", raising)\n'
    )
    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines(
        ["*return 1 / depth", "*ZeroDivisionError*", "*ended with an error*"]
    )


@pytest.mark.parametrize(
    "call",
    [
        'verify_solver("euler/sphericle", still)',
        'verify_solver("euler/spherical", "tailor")',
        'verify_solver("euler/spherical", 17)',
        'verify_solver("euler/spherical", still, rung="f65")',
        'verify_solver("euler/spherical", still, tolerance=0)',
        'verify_solver("euler/spherical", still, tolerance={"omega": 2})',
        'verify_solver("euler/spherical", still, tolerance={"attitude": 1e-3})',
        'verify_solver("euler/spherical", still, only=["T", "attitude"])',
        'verify_solver("euler/spherical", still, only=[])',
        'verify_solver("euler/spherical", still, only=[None])',
    ],
)
def test_a_wrong_call_fails(pytester: pytest.Pytester, call: str) -> None:
    """A name, a tolerance or a quantity that is not there fails the test and says what is expected."""
    result = session(pytester, f"def test_it(verify_solver):\n    {call}\n")
    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines(["E*Failed: expected *"])


# Tolerances, and conserved quantities alone.


def test_a_tolerance_takes_the_place_of_the_bound(pytester: pytest.Pytester) -> None:
    """A coarse method passes within its own tolerance, for all quantities or for each its own."""
    tests = """
@pytest.mark.parametrize(
    "tolerance",
    [None, 1e-9, 1e-5, {"omega": 1e-5}, {"omega": 1e-5, "T": 1e-5, "H2": 1e-5}],
)
def test_it(verify_solver, tolerance):
    verify_solver("euler/spherical", too_fast, tolerance=tolerance)
"""
    result = session(pytester, tests)
    # Without one, below the error, and where T and H2 keep their bounds, it fails.
    result.assert_outcomes(passed=2, failed=3)
    result.stdout.fnmatch_lines(
        [
            "E       fail * omega: 6 digits are right up to t = 100 (largest error 9.5e-07); *above the "
            "tolerance of 1e-09 (rounding in f64 explains *, where 1.00e-9 is allowed; *",
        ]
    )


def test_conserved_quantities_alone_are_said_to_be_alone(pytester: pytest.Pytester) -> None:
    """They may be judged alone; pass or fail, the words say that they certify no state."""
    tests = """
def test_blind(verify_solver):
    verify_solver("euler/generic", still, only="conserved")

def test_one(verify_solver):
    verify_solver("euler/spherical", still, only="T")

def test_seen(verify_solver):
    verify_solver("euler/spherical", too_fast, only=["T", "H2"])

def test_state(verify_solver):
    verify_solver("euler/spherical", still, only=["omega", "T"])
"""
    result = session(pytester, tests)
    result.assert_outcomes(passed=3, failed=1)
    words = "conserved quantities alone were judged. That does not certify a state"
    result.stdout.fnmatch_lines([f"E*{words}*", "*= taylor-verify =*"])
    # pytest's own short summary follows, and repeats a whole message where the variable CI is set.
    noted = result.stdout.str().partition("= taylor-verify =")[2].partition("= short test summary")
    summary = noted[0].splitlines()
    names = [line.partition(": ")[0].rpartition("::")[2] for line in summary if words in line]
    assert names == ["test_blind", "test_one"]


def test_the_note_of_a_worker_reaches_the_summary(pytester: pytest.Pytester) -> None:
    """Under xdist, where tests run in other processes, the summary has the note all the same."""
    pytester.makepyfile(
        SOLVERS
        + 'def test_blind(verify_solver):\n    verify_solver("euler/spherical", still, only="T")\n'
    )
    plugins = ("-p", "taylor_verify.testing.plugin", "-p", "xdist.plugin", "-n", "1")
    result = pytester.runpytest_subprocess(*plugins)
    result.assert_outcomes(passed=1)
    result.stdout.fnmatch_lines(["*= taylor-verify =*", "*conserved quantities alone*"])


def test_no_option_saves_a_run_without_numbers(pytester: pytest.Pytester) -> None:
    """A NaN meets no tolerance, and a run that did not finish fails whatever is asked of it."""
    tests = """
def test_nan(verify_solver):
    verify_solver("euler/spherical", nan, tolerance=0.9)

def test_unfinished(verify_solver):
    verify_solver("euler/spherical", raising, tolerance=0.9, only="conserved")
"""
    session(pytester, tests).assert_outcomes(failed=2)


# Demands, one by one.


def verdict(status: Status = Status.PASS, **numbers: Any) -> Verdict:
    named = {"scene": "s", "solver": "t", "rung": "f64", "setting": "", "outcome": ""}
    return Verdict(**{**named, "quantity": "omega", "verdict": status, **numbers})


@pytest.mark.parametrize("status", list(Status))
def test_only_a_pass_meets_a_demand(status: Status) -> None:
    """Undecided, vacuous, refused and unavailable are not green."""
    assert is_met(verdict(status)) is (status is Status.PASS)


# The marker.


def test_a_marker_makes_a_test_of_every_scene_and_rung(pytester: pytest.Pytester) -> None:
    """Names, patterns and rungs multiply, and each is a test with a name of its own."""
    tests = """
@pytest.mark.verify_scenes("euler/spherical", "euler/re*", rung=["f32", "f64"])
def test_it(verify_scene):
    assert verify_scene.rung in {"f32", "f64"}
    verify_scene(still)

@pytest.mark.verify_scenes("euler/spherical", tolerance=1e-5)
@pytest.mark.verify_scenes("euler/generic", only="conserved")
class TestOfAClass:
    def test_it(self, verify_scene):
        verify_scene(too_fast if verify_scene.scene == "euler/spherical" else still)
"""
    result = session(pytester, tests, "-v")
    result.assert_outcomes(passed=6)
    names = ["spherical-f32", "rest-f32", "spherical-f64", "rest-f64"]
    result.stdout.fnmatch_lines([f"*::test_it?euler/{name}? PASSED*" for name in names])


@pytest.mark.parametrize(
    ("tests", "words"),
    [
        ("@pytest.mark.verify_scenes()\ndef test_it(verify_scene): pass", "expected scenes"),
        (
            '@pytest.mark.verify_scenes("euler/sphericle")\ndef test_it(verify_scene): pass',
            "did you mean euler/spherical",
        ),
        (
            '@pytest.mark.verify_scenes("nobody/*")\ndef test_it(verify_scene): pass',
            "got nobody/* (no scene fits the pattern",
        ),
        (
            '@pytest.mark.verify_scenes("euler/rest", rung="f65")\ndef test_it(verify_scene): pass',
            "expected a rung",
        ),
        (
            '@pytest.mark.verify_scenes("euler/rest", rung=[])\ndef test_it(verify_scene): pass',
            "expected rungs, such as 'f64', got none",
        ),
        (
            '@pytest.mark.verify_scenes("euler/rest", rungs=1)\ndef test_it(verify_scene): pass',
            "expected rung, tolerance or only, got rungs",
        ),
        ("def test_it(verify_scene): pass", "on a test that asks for verify_scene, got none"),
        (
            '@pytest.mark.verify_scenes("euler/rest")\ndef test_it(tmp_path): pass',
            "nothing would be judged",
        ),
    ],
)
def test_a_marker_that_would_judge_nothing_is_an_error(
    pytester: pytest.Pytester, tests: str, words: str
) -> None:
    """No scene, an unknown one, no fixture, no marker: the collection fails and says why."""
    result = session(pytester, tests)
    result.assert_outcomes(errors=1)
    assert words in result.stdout.str()


def test_a_test_that_judges_nothing_is_no_pass(pytester: pytest.Pytester) -> None:
    """To ask for a fixture and not to call it fails; a test that was skipped or failed is left so."""
    tests = """
def test_idle(verify_solver):
    pass

@pytest.mark.verify_scenes("euler/rest")
def test_idle_scene(verify_scene):
    verify_scene.scene

def test_skipped(verify_solver):
    pytest.skip("no simulator here")

def test_failed(verify_solver):
    assert False, "before it came to it"

@pytest.fixture
def simulator(verify_solver):
    return lambda scene: verify_solver(scene, still)

def test_by_a_fixture_of_ones_own(simulator):
    simulator("euler/spherical")
"""
    result = session(pytester, tests)
    result.assert_outcomes(passed=1, failed=3, skipped=1)
    result.stdout.fnmatch_lines(["expected the test to judge a solver with each of its gates*"])


# What it costs a project that does not use it.


def test_a_session_without_a_scene_loads_nothing_heavy(pytester: pytest.Pytester) -> None:
    """A project that does not use the plugin has no more of it than the light modules."""
    pytester.makepyfile(
        f"""
        import sys

        def test_mine():
            assert "taylor_verify.testing.plugin" in sys.modules
            mine = {{name for name in sys.modules if name.startswith("taylor_verify.")}}
            assert mine == {LIGHT!r}
            assert not {HEAVY!r} & set(sys.modules)
        """
    )
    result = pytester.runpytest_subprocess("-p", "taylor_verify.testing.plugin")
    result.assert_outcomes(passed=1)


def test_scenes_are_collected_without_the_heavy_modules(pytester: pytest.Pytester) -> None:
    """Patterns and rungs are resolved when tests are collected; numbers come when one is run."""
    pytester.makepyfile(
        f"""
        import sys, pytest

        @pytest.mark.verify_scenes("euler/*", rung="f32")
        def test_mine(verify_scene):
            assert not {HEAVY!r} & set(sys.modules)
            verify_scene(lambda problem: [problem.given.initial.omega] * len(problem.times))
        """
    )
    result = pytester.runpytest_subprocess(
        "-p", "taylor_verify.testing.plugin", "-k", "euler/spherical"
    )
    assert result.parseoutcomes()["passed"] == 1
