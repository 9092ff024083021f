"""Integrators that stay in a process of their own: what they are asked, what they answer, how they end."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from builders.processes import is_alive
from builders.turns import by_turns

from taylor_verify.models.problem import Problem, pose
from taylor_verify.numbers.precision import rung
from taylor_verify.scenes.reading.reader import load
from taylor_verify.solvers.engines import peer as peers
from taylor_verify.solvers.engines.engine import SCRIPTS, named
from taylor_verify.solvers.engines.peer import Peer
from taylor_verify.solvers.engines.session import end_sessions, session
from taylor_verify.solvers.trajectory import Outcome
from taylor_verify.tradeoff.accuracy import Truth

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


def kind(scene: str) -> str:
    return load(scene).model


def posed(scene: str) -> Problem:
    return pose(load(scene), rung("f64"))


@pytest.mark.parametrize(
    "scene",
    by_turns(["euler/backward", "kirchhoff/listed-times", "kirchhoff/general-body"], 3, kind),
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
