"""Files under written loads: right ones pass, and a wrong load fails the gate of the state.

The answers come from integrators that read the texts by Python's own ``eval``.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import partial
from itertools import pairwise
from pathlib import Path
from random import Random
from typing import Any

import pytest
from builders.drawn_loads import drawn
from builders.integrators import step
from builders.scenes import sampled
from builders.trajectories import write_csv
from builders.turns import by_turns
from builders.written_loads import Evaluated, end_of, euler, kirchhoff, value
from mpmath import mp, mpf

from taylor_verify import check
from taylor_verify.judge.causes.likely import NOT_LOOKED_FOR
from taylor_verify.judge.files.judgement import NO_CONVENTIONS
from taylor_verify.judge.load_notes import NOTHING_CONSERVED
from taylor_verify.records.status import Status
from taylor_verify.run import run
from taylor_verify.scenes.motion import Clock
from taylor_verify.scenes.scene import Scene

GROUPS = {"euler": ("w",), "kirchhoff": ("x", "y")}
ROWS = 6
# RK4 in this many steps between two rows is right to about seven digits.
STEPS = 4
TOLERANCE = 1e-3

# The rates at a time in the step that begins at the first argument.
Rates = Callable[[Any, Any, list[Any]], list[Any]]

RIGID = euler(["r31*w2 + sin(2*t)/3", "-r32*tanh(t) - w2/20", "0.3*r11 - 0.1*w3*norm(w1, w2)"], "4")
SOLID = kirchhoff(
    ["-0.1*c1*r11 - norm(u1, u2, u3)*u1/4", "0.3*c2*r31", "-0.2*r33"],
    ["-w1/5", "0.1*sin(t)*r21", "-w3/10"],
    "3",
)
SWITCH = "19/16"  # a step of `by_steps` ends here
SWITCHED = euler([f"0.4 if t < {SWITCH} else -0.3", "-0.05*w2", f"0.5*step(t - {SWITCH})"], "4")
TOP = euler(["r33/4 - r32/3", "r31/3 - r33/4", "(r32 - r31)/4"], "4")
BY_CLOCK = euler(["0.4*sin(2*t)", "-0.05*w2", "0.3*exp(-t)"], "4")


def with_rows(scene: Scene, rows: int = ROWS) -> Scene:
    """The scene with rows at times that a double holds."""
    start, end = scene.clock.start, scene.clock.instants[-1]
    parts = 2 ** (rows - 1).bit_length()
    instants = tuple(start + (end - start) * Fraction(k, parts) for k in range(rows))
    return replace(scene, clock=Clock(start, instants))


def written(path: Path, scene: Scene, rows: Sequence[Sequence[Any]]) -> Path:
    """A file of these states: omega or both impulses, quaternion and centre."""
    groups = [f"{letter}{i}" for letter in GROUPS[scene.model] for i in (1, 2, 3)]
    centre = ["c1", "c2", "c3"] if "centre" in scene.track else []
    header = ["t", *groups, "q0", "q1", "q2", "q3", *centre]
    numbers = [
        map(float, (value(instant), *row))
        for instant, row in zip(scene.clock.instants, rows, strict=True)
    ]
    return Path(write_csv(path, dict(zip(header, zip(*numbers, strict=True), strict=True))))


def by_steps(scene: Scene, rates: Rates) -> list[list[Any]]:
    """The states by the classical Runge-Kutta method."""
    with mp.workdps(17):
        y, rows = Evaluated(scene).start(), list[list[Any]]()
        rows.append(y)
        instants = [value(instant) for instant in scene.clock.instants]
        for begin, end in pairwise(instants):
            h = (end - begin) / STEPS
            for k in range(STEPS):
                time = begin + k * h
                y = step(partial(rates, time), time, y, h)
            rows.append(y)
        return rows


def with_moment(scene: Scene, texts: Sequence[str]) -> Scene:
    """The scene with other texts of the moment."""
    loads = scene.body.loads
    other = replace(loads, vectors=(("moment", tuple(texts)),))
    return replace(scene, body=scene.body.with_loads(other))


def in_space(scene: Scene) -> Scene:
    """The scene with its moment taken for one in space axes: M becomes R^T M."""
    ((_, m),) = scene.body.loads.vectors
    return with_moment(
        scene, [" + ".join(f"r{i}{j}*({m[i - 1]})" for i in (1, 2, 3)) for j in (1, 2, 3)]
    )


def wrong_sign(scene: Scene) -> Scene:
    ((_, m),) = scene.body.loads.vectors
    return with_moment(scene, [f"-({m[0]})", str(m[1]), str(m[2])])


def clocked(scene: Scene, later: int = 0, stops: bool = False) -> Rates:
    """The rates, for conditions with the clock of a step so many later; or with one that stops."""
    equations, start = Evaluated(scene), value(scene.clock.start)
    span = value(scene.clock.instants[1] - scene.clock.start) / STEPS

    def stepped(begin: Any, t: Any, y: list[Any]) -> list[Any]:
        equations.clock = start if stops else begin + span * (later + mpf(1) / 2)
        return equations.rates(t, y)

    return stepped


def of_text(scene: Scene) -> Rates:
    return clocked(scene)


def once_a_step(scene: Scene) -> Rates:
    """The rates with a clock that stands still over each step, as a load that is set once a step has it."""
    rates = of_text(scene)
    return lambda begin, _, y: rates(begin, begin, y)


def twice(scene: Scene) -> Scene:
    """The scene with twice its moment, as where a weight is in the loads and in the energy."""
    ((_, m),) = scene.body.loads.vectors
    return with_moment(scene, [f"2*({entry})" for entry in m])


Twin = tuple[Scene, Callable[[Scene], Rates], set[str]]
TWINS: Mapping[str, Twin] = {
    "sign": (BY_CLOCK, lambda scene: of_text(wrong_sign(scene)), {"omega", "T"}),
    "space axes": (BY_CLOCK, lambda scene: of_text(in_space(scene)), {"omega", "T"}),
    "load of the step before": (BY_CLOCK, once_a_step, {"omega", "T"}),
    "switch missed": (SWITCHED, lambda scene: clocked(scene, stops=True), {"omega", "T"}),
    "switch late by a step": (SWITCHED, lambda scene: clocked(scene, later=-1), {"omega", "T"}),
    "potential twice": (TOP, lambda scene: of_text(twice(scene)), {"omega", "T+V"}),
}


def failures(scene: Scene, file: Path) -> tuple[set[str], list[str]]:
    """The quantities that fail the tolerance, and the names of the likely causes."""
    judged = check(scene, file, partial=True, tolerance=TOLERANCE)
    failed = {v.quantity for v in judged.verdicts if v.verdict is Status.FAIL}
    return failed, [cause.name for cause in judged.causes]


# The likely causes of the twins that have one; of the others none is said.
CAUSES = {
    "space axes": ["moment in space axes"],
    "potential twice": ["moment twice"],
    "sign": ["moment 1 with the other sign"],
    "switch missed": ["switch at t = 1.1875 missed"],
    # Nothing else in these loads reads the time.
    "switch late by a step": ["loads late"],
}


@pytest.mark.parametrize(
    "scene", by_turns([RIGID, BY_CLOCK, SOLID]), ids=["rigid", "clock", "solid"]
)
def test_a_right_file_passes_every_gate(scene: Scene, tmp_path: Path) -> None:
    """Rows that are right to the last digit pass the bounds of the arithmetic, balances among them."""
    scene = with_rows(scene, 3)
    with mp.workdps(40):
        rows = [Evaluated(scene).start()]
        rows += [end_of(scene, time, 20, 4).state for time in scene.clock.elapsed[1:]]
    judged = check(scene, written(tmp_path / "right.csv", scene, rows), partial=True)
    assert judged.passed, judged.verdicts
    names = {verdict.quantity for verdict in judged.verdicts}
    assert {"initial state", "attitude", "T"} <= names
    assert all((v.bound or 1.0) < 1e-11 for v in judged.verdicts)


def test_an_answer_of_steps_passes_a_tolerance_and_fails_the_arithmetic(tmp_path: Path) -> None:
    """A Runge-Kutta answer is right to its own digits; the cause of its error is the order of its steps."""
    scene = with_rows(BY_CLOCK)
    file = written(tmp_path / "steps.csv", scene, by_steps(scene, of_text(scene)))
    assert check(scene, file, partial=True, tolerance=TOLERANCE).passed
    strict = check(scene, file, partial=True)
    assert not strict.passed
    assert [cause.name for cause in strict.causes] == ["truncation of order 4"]
    assert NOT_LOOKED_FOR not in strict.remarks
    assert NO_CONVENTIONS in strict.remarks


@pytest.mark.parametrize("twin", by_turns([*TWINS], of=5))
def test_a_wrong_load_fails_the_state_and_the_gate_that_names_it(twin: str, tmp_path: Path) -> None:
    """A file that passes with the right load fails the state, and the work or the conserved energy.

    A weight that is counted twice leaves the momentum along the vertical. The fault is the likely cause, or
    none is said.
    """
    scene, rates, named = TWINS[twin]
    scene = with_rows(scene)
    right = written(tmp_path / "right.csv", scene, by_steps(scene, of_text(scene)))
    wrong = written(tmp_path / "wrong.csv", scene, by_steps(scene, rates(scene)))
    assert check(scene, right, partial=True, tolerance=TOLERANCE).passed
    failed, causes = failures(scene, wrong)
    assert named <= failed
    assert "H_along" not in failed
    assert causes == CAUSES.get(twin, [])


# Other numbers in these make a logarithm of less than zero, a power of too many digits, and the like.
NO_NUMBERS = [1039, 1046, 1055, 2050]


@pytest.mark.parametrize("seed", by_turns([*NO_NUMBERS, *range(12)], of=20))
def test_a_wrong_answer_to_drawn_loads_fails(seed: int) -> None:
    """No other number, sign or limit that is tried in the texts of a scene ends the search for causes."""
    scene = sampled(drawn(Random(seed), with_states=seed % 3 == 0).scene, 21)
    assert not run(scene, "scipy:RK45").passed


def test_work_and_impulse_without_arcs_are_those_of_the_exact_motion(tmp_path: Path) -> None:
    """T and H fail where work and impulse are wrong, though no arc can begin at a row: q has a sign."""
    scene = with_rows(euler(["-q1/4 - w1/5", "-q2/4 - w2/5", "-q3/4 - w3/5"], "2"), 3)
    right = written(tmp_path / "right.csv", scene, by_steps(scene, of_text(scene)))
    wrong = written(tmp_path / "wrong.csv", scene, by_steps(scene, of_text(wrong_sign(scene))))
    answer = check(scene, right, partial=True, tolerance=TOLERANCE)
    assert answer.passed
    assert NOTHING_CONSERVED in answer.remarks
    failed, causes = failures(scene, wrong)
    assert {"T", "H2", "H_space"} <= failed
    assert causes == []
