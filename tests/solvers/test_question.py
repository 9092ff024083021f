"""The question of every kind of scene, which can be filled in, and integrators that stay to be asked."""

from __future__ import annotations

import csv
import io
import json
import re
import sys
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import replace
from fractions import Fraction
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from builders.processes import is_alive
from builders.trajectories import columns_at
from builders.turns import by_turns
from builders.worked import DOCS

from taylor_verify.cli import main
from taylor_verify.models.problem import Problem, pose
from taylor_verify.numbers.precision import rung
from taylor_verify.scenes.library import names
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.engines import peer as peers
from taylor_verify.solvers.engines.engine import SCRIPTS, named
from taylor_verify.solvers.engines.peer import Peer
from taylor_verify.solvers.engines.session import end_sessions, session
from taylor_verify.solvers.process import protocol
from taylor_verify.solvers.trajectory import Outcome
from taylor_verify.tradeoff.accuracy import Truth

# Every number is an object of these two: the one pair that occurs again and again.
PAIR = {"text", "hex"}
# Behind all others: lists of steps and of states, whose entries are alike.
LISTS = ("loads", "states", "instants")
# Tables whose keys are names that the scene chose.
NAMED = ("define", "space")
Kind = tuple[str, frozenset[str], bool, bool, bool]


def kind(scene: Scene) -> Kind:
    """The features by which the questions of two scenes differ in their keys."""
    loads = scene.body.loads
    acts = scene.body.is_free, loads is not None, loads is not None and bool(loads.states)
    return scene.model, scene.track, *acts


@cache
def one_of_each_kind() -> dict[Kind, str]:
    scene_of: dict[Kind, str] = {}
    for name in names():
        scene_of.setdefault(kind(load(name)), name)
    return scene_of


def keys(document: Any) -> Iterator[str]:
    """Every key at every level, as often as it occurs, but for the names that a scene chose."""
    if isinstance(document, dict):
        for key, value in document.items():
            yield key
            yield from () if key in NAMED else keys(value)
    elif isinstance(document, list):
        for entry in document:
            yield from keys(entry)


def legend() -> tuple[set[str], set[str]]:
    """The words in backquotes of the page: those that explain the question, and those of the answer."""
    page = (DOCS.parent / "cases" / "README.md").read_text(encoding="utf-8")
    question, answer = page.partition("The question:")[2].split("The answer is `{")
    lines = ("| `", "With `loads`", "With `states`")
    tables = [line for line in question.splitlines() if line.startswith(lines)]
    words = [set(re.findall(r"`(\w+)`", text)) for text in (" ".join(tables), answer)]
    return words[0], words[1] & {"remark", "steps", "evaluations", "seconds", "compile_seconds"}


@pytest.mark.parametrize("name", one_of_each_kind().values())
def test_no_key_occurs_twice(name: str) -> None:
    """No key but `text` and `hex` occurs twice, before the lists of what a scene writes down."""
    document = protocol.question(pose(load(name), rung("f64")))
    first = {key: value for key, value in document.items() if key not in LISTS}
    assert [*document][: len(first)] == [*first]
    counts = Counter(keys(first))
    assert {key for key, count in counts.items() if count > 1} == PAIR
    # As a reader without a JSON library searches it, in the text that the program gets.
    text = json.dumps({**first, "title": '"elapsed": a title may say anything'})
    assert {text.count(f'"{key}":') for key in counts if key not in PAIR} == {1}


@pytest.mark.parametrize("name", one_of_each_kind().values())
def test_every_key_is_explained(name: str) -> None:
    """The page names each key of a question, and no key before its lists is one of an answer."""
    question, answer = legend()
    document = protocol.question(pose(load(name), rung("f64")))
    asked = {*keys(document)} - PAIR
    assert asked <= question
    assert len(answer) == 5
    first = {key: value for key, value in document.items() if key not in LISTS}
    assert not {*keys(first)} & {*answer, *document["columns"]}


def lists(document: Any) -> Iterator[list[Any]]:
    """Every list at every level."""
    if isinstance(document, list):
        yield document
    entries = document.values() if isinstance(document, dict) else document
    for entry in entries if isinstance(document, dict | list) else ():
        yield from lists(entry)


@pytest.mark.parametrize("name", ["loads/vehicle-in-a-current", "kirchhoff/algebraic", "loads/pid"])
def test_a_vector_is_one_object_of_text_and_hex(name: str) -> None:
    """The lists stand within it: none is a list of such objects."""
    document = protocol.question(pose(load(name), rung("f64")))
    for entries in lists(document):
        assert not entries or not all(isinstance(e, dict) and e.keys() == PAIR for e in entries)


@pytest.mark.parametrize("name", ["loads/pid", "loads/thruster-pulses", "loads/vehicle-depth"])
def test_what_is_tracked_includes_states_of_the_scenes_own(name: str) -> None:
    """`track` lists own states as `columns` do, so that a program may ask either of them."""
    scene = load(name)
    document = protocol.question(pose(scene, rung("f64")))
    assert set(document["track"]) == scene.track | scene.states
    assert scene.states
    for own in scene.states:
        assert any(column.startswith(own) for column in document["columns"])


@pytest.mark.parametrize(
    ("name", "others", "version"),
    [
        ("euler/damped", set(), 1),
        ("kirchhoff/damped", set(), 1),
        ("euler/gyrostat", {"rotor"}, 3),
    ],
)
def test_damping_has_a_version_of_its_own(name: str, others: set[str], version: int) -> None:
    """Programs are asked by version 4, also with wheels; the damping is a text and a float."""
    scene = load(name)
    damped, plain = (
        protocol.question(pose(replace(scene, body=replace(scene.body, damping=c)), rung("f64")))
        for c in (Fraction(1, 8), Fraction(0))
    )
    assert (damped["protocol"], plain["protocol"]) == (4, version)
    assert {"damping", *others} <= set(damped["body"])
    assert damped["body"]["damping"] == {"text": "0.125", "hex": "0x1p-3"}
    assert "damping" not in plain["body"]


@pytest.mark.parametrize("name", by_turns(one_of_each_kind().values(), 10))
def test_the_template_filled_in_passes(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """`question --csv` with the exact motion in its cells is a file that `check` takes as it is."""
    assert main(["question", name, "--csv"]) == 0
    out, stderr = capsys.readouterr()
    assert stderr == ""
    header, *rows = list(csv.reader(io.StringIO(out)))
    scene = load(name)
    instants = pose(scene, rung("f64")).given.clock.instants
    assert len(rows) == len(instants)
    exact = columns_at(scene, instants)
    assert [float(row[0]) for row in rows] == exact["t"]
    filled = [
        [row[0], *(repr(exact[column][k]) for column in header[1:])] for k, row in enumerate(rows)
    ]
    file = tmp_path / "filled.csv"
    file.write_text("\n".join(",".join(line) for line in [header, *filled]) + "\n")
    assert main(["check", str(file), "--scene", name]) == 0


# Integrators that stay in a process of their own

# An integrator without a library: the worked example, in so many steps between two samples.
_SCRIPT = """
import os, sys, time
from dataclasses import replace
sys.path.insert(0, {scripts!r})
import rk4
from question import answer

def solve(question, settings):
    {begins}
    settings.step = max(b - a for a, b in zip(question.instants, question.instants[1:])) / {steps}
    return replace(rk4.solve(question, settings), again=lambda: rk4.solve(question, settings))

answer(solve)
"""


Made = Callable[..., Peer]


@pytest.fixture
def fake(monkeypatch: pytest.MonkeyPatch, users_cache: Path) -> Iterator[Made]:
    """A peer that is this script in this interpreter."""

    def made(begins: str = "pass", steps: int = 40, limit: str = "60") -> Peer:
        monkeypatch.setenv("TAYLOR_VERIFY_TIME_LIMIT", limit)
        script = users_cache.with_name("with_fake.py")
        script.write_text(_SCRIPT.format(scripts=str(SCRIPTS), begins=begins, steps=steps))
        command = [sys.executable, "-B", str(script), "serve"]
        monkeypatch.setattr(peers, "command_of", lambda engine: command)
        return Peer(named("outside:dop853?rtol=1e-9"))

    yield made
    end_sessions()


def fake_kind(scene: str) -> str:
    return load(scene).model


def posed(scene: str) -> Problem:
    return pose(load(scene), rung("f64"))


@pytest.mark.parametrize(
    "scene",
    by_turns(["euler/backward", "kirchhoff/listed-times", "kirchhoff/general-body"], 3, fake_kind),
)
def test_a_peer_is_asked_the_problem_that_heyoka_is_asked(scene: str, fake: Made) -> None:
    """Its states, at the samples and in the problem's own form, are the exact motion."""
    problem = posed(scene)
    trajectory = fake(steps=200).solve(problem)
    assert (trajectory.outcome, trajectory.detail) == (Outcome.FINISHED, "")
    assert trajectory.evaluations == 4 * trajectory.steps > 0
    # The method is of fourth order, and no step is longer than a fortieth of a radian or so.
    assert Truth(problem).accuracy(trajectory).worst <= 1e-5


def test_a_peer_is_timed_without_its_start(fake: Made) -> None:
    """Seconds of a solve are the processor's in the propagation, as often as asked, and grow with it."""
    problem = posed("euler/generic")
    short, long = fake(steps=1), None
    few = short.seconds(problem, 3)
    end_sessions()
    long = fake(steps=30).seconds(problem, 3)
    assert 0 < few < long


def test_one_process_answers_all_questions(fake: Made) -> None:
    """A second question is asked of the process that answered the first, and that one ends when told."""
    one = fake(begins="sys.stderr.write(str(os.getpid()) + chr(10)); sys.stderr.flush()", steps=1)
    for scene in ("euler/generic", "kirchhoff/screw"):
        assert one.solve(posed(scene)).outcome is Outcome.FINISHED
    words = session(peers.command_of(one.engine)).last_words.split()  # type: ignore[arg-type]
    assert len(words) == 2
    assert len(set(words)) == 1
    assert is_alive(words[0])
    end_sessions()
    assert not is_alive(words[0])


@pytest.mark.parametrize(
    ("begins", "outcome", "words"),
    [
        ("raise ValueError('no such step')", Outcome.RAISED, "no such step"),
        ("raise SystemExit('CVODE: too much work')", Outcome.RAISED, "too much work"),
        ("sys.exit('last words') if 0 else os._exit(3)", Outcome.CRASHED, ""),
        ("time.sleep(600)", Outcome.TIMED_OUT, ""),
    ],
)
def test_a_peer_that_fails_is_an_outcome(
    begins: str, outcome: Outcome, words: str, fake: Made
) -> None:
    """An error, a crash and a time limit are outcomes, and the next question is answered all the same."""
    problem = posed("euler/generic")
    # A loaded machine may need more than a second to begin.
    limit = "1" if outcome is Outcome.TIMED_OUT else "60"
    trajectory = fake(begins, limit=limit).solve(problem)
    assert trajectory.outcome is outcome
    assert words in trajectory.detail
    assert fake(begins, limit=limit).seconds(problem, 1) is None
    end_sessions()
    assert fake(steps=1).solve(problem).outcome is Outcome.FINISHED


def test_what_a_library_prints_is_no_answer(fake: Made) -> None:
    """Words on the standard output go to standard error, and the answer is read all the same."""
    assert fake("print('a banner', flush=True)", steps=1).solve(posed("euler/generic")).outcome is (
        Outcome.FINISHED
    )
