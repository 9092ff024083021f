"""The integrators of other libraries: their names, their scripts, and how near they come."""

from __future__ import annotations

import ast
import json
import re
import shutil
import sys
import threading
import time
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from builders.processes import imported_tops
from builders.scenes import three_instants
from builders.turns import by_turns
from packaging.specifiers import SpecifierSet

from taylor_verify.models.problem import Problem, pose
from taylor_verify.numbers.precision import rung
from taylor_verify.records.faults import Refused
from taylor_verify.scenes.reading.reader import load
from taylor_verify.solvers.engines import python
from taylor_verify.solvers.engines.engine import SCRIPTS, Engine, engines, prepare
from taylor_verify.solvers.engines.launcher import NotMade
from taylor_verify.solvers.engines.script import read_script
from taylor_verify.solvers.engines.script import scripts as read_scripts
from taylor_verify.solvers.process import protocol
from taylor_verify.solvers.registry import OUTSIDE, remarks, solver_named, solver_names
from taylor_verify.solvers.trajectory import Outcome, Trajectory
from taylor_verify.tradeoff.accuracy import Truth

CHECKOUT = Path(__file__).resolve().parents[2]
# Both models, each of the five states, backwards, loads, and instants that leave out the start.
SCENES = [
    *("euler/generic", "euler/with-attitude", "euler/backward", "euler/constant-moment"),
    *("euler/gyrostat", "kirchhoff/general-body", "kirchhoff/whole-motion"),
    *("kirchhoff/constant-loads", "kirchhoff/screw", "kirchhoff/listed-times"),
    *("euler/damped", "kirchhoff/damped"),
]


# Their names.


def test_the_command_line_lists_them_all() -> None:
    """The names of the registry are those of the scripts, and each of them is a solver."""
    listed = {name.partition("?")[0] for name in solver_names() if name.startswith(OUTSIDE)}
    assert listed == {f"outside:{name}" for name in engines()}
    assert listed
    for name in listed:
        assert solver_named(name).name == name


# The scripts.


def scripts() -> list[Path]:
    return sorted(SCRIPTS.glob("with_*.py"))


@pytest.mark.parametrize("file", scripts(), ids=lambda file: file.stem)
def test_every_requirement_is_pinned(file: Path) -> None:
    """A script names exact versions, and fits every Python that the project fits, or says why not."""
    script = read_script(file)
    for requirement in script.requirements:
        assert re.fullmatch(r"[A-Za-z0-9_.-]+==\d+(\.\d+)*(b\d+)?", requirement)
    project = tomllib.loads((CHECKOUT / "pyproject.toml").read_text())["project"]
    wanted = set(pythons(project["requires-python"]))
    fitting = set(pythons(tomllib.loads(script.block)["requires-python"]))
    assert fitting
    assert fitting <= wanted
    if fitting < wanted:
        # uv takes another interpreter then, and the docstring names it.
        assert f"Python {max(fitting)}" in str(ast.get_docstring(ast.parse(file.read_text())))


def pythons(requirement: str) -> list[str]:
    """The versions of Python that fit a requirement."""
    return [f"3.{minor}" for minor in range(40) if f"3.{minor}.99" in SpecifierSet(requirement)]


@pytest.mark.parametrize("file", scripts(), ids=lambda file: file.stem)
def test_a_script_has_the_methods_it_names(file: Path) -> None:
    """The methods of the metadata are those of the script, and it loads no library to begin with."""
    about = read_script(file).about
    tree = ast.parse(file.read_text())
    tables = [
        ast.literal_eval(node.value)
        for node in tree.body
        if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "METHODS"
    ]
    # Where there is no table, the words of the methods are the library's own.
    (table,) = tables or [about.methods]
    assert list(about.methods) == list(table), f"other methods in METHODS than above @ {file.name}"
    siblings = {file.stem for file in SCRIPTS.glob("*.py")}
    for node in tree.body:
        if isinstance(node, ast.Import):
            assert {alias.name for alias in node.names} <= sys.stdlib_module_names
        elif isinstance(node, ast.ImportFrom):
            assert str(node.module).partition(".")[0] in siblings | sys.stdlib_module_names


def test_no_script_hides_a_library() -> None:
    """No file has the name of a module that a script imports, which Python would find first."""
    own = {file.stem for file in SCRIPTS.glob("*.py")}
    imported = set().union(*(imported_tops(file.read_text()) for file in scripts()))
    shared = {"axes", "equations", "free_body", "immersed_body", "question"}
    # MJX and Brax take the model that MuJoCo compiles; the torque of Orekit is a script beside its own.
    assert own & imported == {*shared, "with_mujoco", "with_orekit"}


def test_a_list_says_what_each_is(monkeypatch: pytest.MonkeyPatch) -> None:
    """Each has a title, with the reason beside it where it is unavailable; no environment is made."""
    monkeypatch.setattr(python, "_uv_says", None)
    monkeypatch.setattr(python, "_uv", lambda: "uv")
    monkeypatch.setattr(shutil, "which", lambda program: program)
    remark_of = remarks()
    for name in engines():
        (remark,) = [
            text
            for usage, text in remark_of.items()
            if usage.partition("?")[0].endswith(f":{name}")
        ]
        assert remark
        assert "unavailable" not in remark
    monkeypatch.setattr(python, "_uv", lambda: None)
    assert "pip install 'taylor-verify[engines]'" in remarks()[engines()["cvode-bdf"].usage]


# What they share: the reading of the question, the equations, the writing of the answer.


@pytest.mark.parametrize("scene", by_turns(SCENES, 3))
def test_the_equations_of_the_scripts_lead_to_the_exact_motion(
    scene: str, sibling: Callable[[str], Any]
) -> None:
    """The question as the scripts read it, integrated closely, is answered with the exact motion."""
    integrate = pytest.importorskip("scipy.integrate")
    shared, equations = sibling("question"), sibling("equations")
    asked = pose(load(scene), rung("f64"))
    question = shared.read(json.loads(json.dumps(protocol.question(asked))))
    rates = equations.rates(question.columns)
    tolerance = 1e-11
    integration = integrate.solve_ivp(
        lambda t, s: [question.sign * rate for rate in rates(s, question.parameters)],
        (0, question.end),
        question.state,
        method="DOP853",
        t_eval=question.instants,
        rtol=tolerance,
        atol=tolerance,
    )
    states = integration.y.T.tolist()
    steps = integration.nfev // 12
    answer = shared._written(question, shared.Solved(states, steps, integration.nfev, 0, 0))
    # A wrong sign, index or column is an error of the size of the motion; what is left here is the
    # tolerance of every step, carried on thirtyfold by these orbits.
    read_back = protocol.read(json.dumps(answer).encode(), asked)
    assert error(asked, read_back) <= tolerance * steps * 30


@pytest.mark.parametrize(
    ("changed", "fault"),
    [
        (
            {"columns": ["t", "w1", "w2", "w3", "s1"]},
            "among w1 w2 w3 q0 q1 q2 q3, got s1 @ columns",
        ),
        ({"model": "gyrostat"}, "expected the model euler or kirchhoff, got gyrostat"),
    ],
)
def test_a_question_beyond_the_equations_is_refused_in_a_sentence(
    changed: dict[str, Any], fault: str, sibling: Callable[[str], Any]
) -> None:
    """A state quantity or a model that the scripts do not know is named."""
    document = {**protocol.question(three_instants()), **changed}
    with pytest.raises(SystemExit, match=fault):
        sibling("question").read(document)


def error(asked: Problem, answer: protocol.Answer) -> float:
    from taylor_verify.solvers.callback import Callback

    return Truth(asked).accuracy(Callback(lambda _: answer.states).solve(asked)).worst


def test_the_first_propagation_is_what_compiles(sibling: Callable[[str], Any]) -> None:
    """The second of two propagations is timed, by the processor; the first took longer by compiling."""
    calls = []

    def propagate() -> int:
        calls.append(None)
        threading.Event().wait(0.5)
        end = time.process_time() + (0.2 if len(calls) == 1 else 0.05)
        while time.process_time() < end:
            pass
        return len(calls)

    result, seconds, compiling = sibling("question").twice(propagate)
    assert result == len(calls) == 2
    # What waits for the processor, or for anything else, does not count.
    assert 0.05 <= seconds < 0.5
    assert compiling > 0


# The libraries themselves, where their environments are.


@pytest.mark.slow
@pytest.mark.parametrize("scene", ["euler/backward", "kirchhoff/whole-motion"])
@pytest.mark.parametrize(
    "one",
    [one for one in engines().values() if "rtol" in one.script.about.settings],
    ids=lambda one: one.name,
)
def test_a_library_keeps_near_its_tolerance(
    one: Engine, scene: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The error is the tolerance of every step carried on, and falls with the tolerance."""
    # A test downloads nothing: `taylor-verify tradeoff --outside` does.
    monkeypatch.setenv("UV_OFFLINE", "1")
    try:
        prepare(one.name)
    except NotMade as reason:
        pytest.skip(str(reason))
    asked = pose(load(scene), rung("f64"))
    truth = Truth(asked)
    errors = {}
    for tolerance in (1e-6, 1e-9):
        name = f"outside:{one.name}?rtol={tolerance}&atol={tolerance}"
        trajectory: Trajectory = solver_named(name).solve(asked)
        assert (trajectory.outcome, trajectory.detail) == (Outcome.FINISHED, "")
        assert trajectory.steps > 0
        assert 0 < trajectory.seconds
        errors[tolerance] = truth.accuracy(trajectory).worst
        # These orbits carry an error on thirtyfold at most.
        assert errors[tolerance] <= tolerance * trajectory.steps * 30
    # A thousandth of the tolerance is at least a tenth of the error, for the lowest of orders.
    assert errors[1e-9] <= errors[1e-6] / 10


def written(folder: Path, *blocks: str) -> Path:
    """A script of the folder with these blocks of metadata."""
    texts = (f"# /// script\n{block}\n///".replace("\n", "\n# ") for block in blocks)
    file = folder / "with_mine.py"
    file.write_text("".join(f"{text}\nprint(1)\n" for text in texts), encoding="utf-8")
    return file


TITLED = '[tool.taylor-verify]\ntitle = "x"\n'


@pytest.mark.parametrize(
    ("blocks", "fault"),
    [
        ([], "expected one block of script metadata, got 0"),
        (["a = 1", "a = 1"], "expected one block of script metadata, got 2"),
        (["a = "], "expected TOML in the metadata"),
        (["[tool.taylor-verify]\ntitel = 1"], "unknown field `titel`"),
        (["dependencies = []"], "missing required field `title`"),
        (
            ['dependencies = ["six"]\n' + TITLED],
            "expected a dependency pinned with ==, got 'six' @ with_mine.py",
        ),
        *(
            (
                [f'dependencies = ["six==1.0"]\n{TITLED}{key}'],
                "expected a package among the dependencies, got 'seven' @ with_mine.py",
            )
            for key in ('package = "seven"', 'alike = ["seven"]')
        ),
        (
            [TITLED + "settings = {step = -1.0}"],
            "expected a positive number or words for the setting step, got -1.0 @ with_mine.py",
        ),
        (
            [TITLED + 'settings = {step = "stp"}'],
            "expected an earlier setting for step to follow, got 'stp' @ with_mine.py",
        ),
    ],
)
def test_a_script_that_is_wrong_is_refused(blocks: list[str], fault: str, tmp_path: Path) -> None:
    """Each fault is one line with its file, and reading the folder tells all of them."""
    file = written(tmp_path, *blocks)
    with pytest.raises(ValueError, match=re.escape(fault)):
        read_script(file)
    with pytest.raises(Refused, match=re.escape(fault)):
        read_scripts(tmp_path)


@pytest.mark.parametrize("script", sorted(SCRIPTS.glob("*.py")), ids=lambda file: file.stem)
def test_a_call_of_another_script_has_its_arguments(script: Path) -> None:
    """Scripts import each other from their folder, where no type checker follows."""
    tree = ast.parse(script.read_text(encoding="utf-8"))
    modules = {
        alias.name: SCRIPTS / f"{node.module}.py"
        for node in ast.walk(tree)
        if isinstance(node, ast.ImportFrom)
        for alias in node.names
    }
    calls = [n for n in ast.walk(tree) if isinstance(n, ast.Call) and isinstance(n.func, ast.Name)]
    wrong = [
        (call.func.id, call.lineno)
        for call in calls
        if isinstance(call.func, ast.Name)
        and (file := modules.get(call.func.id)) is not None
        and not any(isinstance(given, ast.Starred) for given in call.args)
        and (asked := functions(file).get(call.func.id)) is not None
        and not asked[0] <= len(call.args) + len(call.keywords) <= asked[1]
    ]
    assert wrong == []


def functions(file: Path) -> dict[str, tuple[int, int]]:
    """The least and the largest number of arguments of each function of a script; none without one."""
    tree = ast.parse(file.read_text(encoding="utf-8") if file.exists() else "")
    return {
        node.name: (len(node.args.args) - len(node.args.defaults), len(node.args.args))
        for node in tree.body
        if isinstance(node, ast.FunctionDef) and not node.args.kwonlyargs and not node.args.vararg
    }
