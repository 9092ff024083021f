"""Likely causes of an answer to a scene with a sampled controller, and near misses that have none."""

from __future__ import annotations

import tomllib
from collections.abc import Callable
from fractions import Fraction
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from builders.integrators import turned
from builders.trajectories import named, write_csv
from builders.turns import by_turns
from builders.written_loads import Evaluated, instants
from builders.wrong_dynamics import Array, explained_motion

from taylor_verify import check, exact
from taylor_verify.judge.causes.float_answer import Motion
from taylor_verify.judge.causes.likely import Explained
from taylor_verify.records.status import Status
from taylor_verify.scenes.families.toml_text import toml
from taylor_verify.scenes.reading.reader import read
from taylor_verify.scenes.scene import Scene

BODY = """
title = "Sampled controller"
model = "euler"
[body]
inertia = [1.2, 0.9, 1.6]
moment = ["a1", "a2", "a3"]
[define]
kp = "0.8"
[states]
m = { every = "1/10", value = ["-kp*w1 + 0.1*w2", "-kp*w2", "-kp*w3"] }
a = { every = "1/10", offset = "1/20", start = [0, 0, 0], value = ["m1", "m2", "m3"] }
[initial]
omega = [0.3, -0.5, 0.4]
[time]
end = 0.7
samples = 15
"""
TENTH = 'every = "1/10"'
CONTINUOUS = BODY[BODY.index("[states]") : BODY.index("[initial]")]


@cache
def scene(text: str = BODY) -> Scene:
    return read(text, "controller")


def names(changed: str, text: str = BODY) -> list[str]:
    """The names of the causes of the exact motion of a changed scene, printed in ten digits."""
    return [cause.name for cause in of_motion(changed, text).causes]


def of_motion(changed: str, text: str) -> Explained:
    own = scene(text)
    rows = exact(scene(changed), times=list(own.clock.instants), digits=15)["omega"]
    v = np.array([[float(f"{float(x):.10g}") for x in row] for row in rows])
    return explained_motion(own, Motion(v))


@pytest.mark.parametrize(
    ("changed", "name"),
    by_turns(
        [
            (
                BODY.replace(TENTH, 'every = "1/5"').replace("1/20", "1/10"),
                "m and a taken every 0.2 and 0.2, 2 times the scene's time",
            ),
            (
                BODY.replace(TENTH, 'every = "3/20"').replace("1/20", "3/40"),
                "m and a taken every 0.15 and 0.15, 3/2 of the scene's time",
            ),
            (BODY.replace(TENTH, 'every = "13/100"').replace("1/20", "7/100"), None),
            (BODY.replace('["m1", "m2", "m3"]', '["-kp*w1 + 0.1*w2", "-kp*w2", "-kp*w3"]'), None),
            (BODY.replace('"a1", "a2", "a3"', '"m1", "m2", "m3"'), "a without its delay"),
            (
                BODY.replace('"a1", "a2", "a3"', '"b1", "b2", "b3"').replace(
                    "[initial]",
                    'b = { every = "1/10", offset = "1/20", start = [0, 0, 0], '
                    'value = ["a1", "a2", "a3"] }\n[initial]',
                ),
                # A delay of what a passes on is the same delay of a.
                "m is used one sample late, by 0.1",
            ),
            (
                BODY.replace(CONTINUOUS, "").replace(
                    '"a1", "a2", "a3"', '"-kp*w1 + 0.1*w2", "-kp*w2", "-kp*w3"'
                ),
                "m and a continuous, where the scene samples",
            ),
            (BODY.replace('kp = "0.8"', 'kp = "0.81"'), "kp"),
        ],
        8,
    ),
)
def test_a_controller_that_is_run_otherwise_is_named(changed: str, name: str | None) -> None:
    """Another rate or gain, a sample more or no delay has its name; another instant has none."""
    assert names(changed) == ([] if name is None else [name])


HELD = """
title = "Controller with limits"
model = "euler"
[body]
inertia = [1.2, 0.9, 1.6]
moment = ["m1", "m2", "m3"]
[states]
m = { every = "1/10", value = ["clip(-w1,-0.45,0.45)", "clip(-w2,-0.45,0.45)", "clip(-w3,-0.45,0.45)"] }
[initial]
omega = [0.3, -0.5, 0.4]
[time]
end = 1
samples = 21
"""
WHEELS = """
title = "Wheels with motors"
model = "euler"
[body]
inertia = [[1.2, 0.1, 0], [0.1, 0.9, 0], [0, 0, 1.6]]
rotor = ["h1", "h2", "h3"]
[define]
d = "1/2"
[states]
h = { start = [0.1, 0, -0.2], rate = ["d*w1", "d*w2", "d*w3"] }
[initial]
omega = [0.3, -0.5, 0.4]
[time]
end = 6
samples = 41
"""
VALUE = HELD[HELD.index("value") : HELD.index(" }")]
LATE = HELD.replace("m = {", "m = { start = [0, 0, 0],").replace(
    "[initial]",
    'n = { start = [0, 0, 0], every = "1/10", value = ["m1", "m2", "m3"] }\n[initial]',
)
LATE = LATE.replace('moment = ["m1", "m2", "m3"]', 'moment = ["n1", "n2", "n3"]')
LATER = HELD.replace("m = {", 'm = { start = [0, 0, 0], offset = "7/100",')
SHORT = ", ".join(f'"-w{i}*0.45/max(norm(w1, w2, w3), 0.45)"' for i in (1, 2, 3))
LENGTH = "the length of the vector is limited, where the scene limits each axis"
FREE = "no limits"
STATES = HELD[HELD.index("[states]") : HELD.index("[initial]")]
LIMITED = VALUE.removeprefix("value = ")
SMOOTH = HELD.replace(STATES, "").replace('["m1", "m2", "m3"]', LIMITED)
REACTION = 'moment = ["d*w1", "d*w2", "d*w3"]\nrotor'


@pytest.mark.parametrize(
    ("text", "changed", "name"),
    by_turns(
        [
            (HELD, LATE, "m is used one sample late, by 0.1"),
            (
                HELD,
                HELD.replace(STATES, "").replace('["m1", "m2", "m3"]', LIMITED),
                "m continuous, where the scene samples",
            ),
            (HELD, LATE.replace("clip(-w1,", "clip(-1.3*w1,"), None),
            (HELD, LATER, "time by which m is taken late"),
            (HELD, LATER.replace("clip(-w1,", "clip(-1.3*w1,"), None),
            (HELD, HELD.replace(VALUE, f"value = [{SHORT}]"), LENGTH),
            (SMOOTH, SMOOTH.replace(LIMITED, f"[{SHORT}]"), LENGTH),
            (SMOOTH, SMOOTH.replace(LIMITED, '["-w1", "-w2", "-w3"]'), FREE),
            (SMOOTH, SMOOTH.replace(LIMITED, f"[{SHORT}]").replace("-w1*", "-1.3*w1*"), None),
            (WHEELS, WHEELS.replace("rotor", REACTION), "no reaction of the wheels' motors"),
            (WHEELS, WHEELS.replace('"1/2"', '"1/3"'), "d"),
            (WHEELS, WHEELS.replace("rotor", REACTION).replace('"1/2"', '"9/20"'), None),
        ],
        3,
    ),
    ids=[
        *("late", "continuous", "late and more", "another phase", "another phase and more"),
        *("by length", "by length, smooth", "no limits, smooth", "by length and more"),
        *("no reaction", "gain", "no reaction and a gain"),
    ],
)
def test_an_own_state_without_a_first_value_or_with_large_effects_is_named(
    text: str, changed: str, name: str | None
) -> None:
    """A controller late from the start, one with a kink, and wheels that run away have their names."""
    assert names(changed, text) == ([] if name is None else [name])


THIRDS = (
    HELD.replace('"1/10"', '"1/15"').replace("21", "16").replace('"clip(-w3,-0.45,0.45)"', '"1/3"')
)
CONTINUOUSLY = HELD.replace(STATES, "").replace('["m1", "m2", "m3"]', LIMITED)


RATES = ", ".join(f'"(-kp*w{i} - a{i})/0.3"' for i in (1, 2, 3))
LAG = f"[states]\na = {{ start = [0, 0, 0], rate = [{RATES}] }}\n"
MOTOR = BODY.replace(CONTINUOUS, LAG).replace("0.7", "6")
PROMPT = MOTOR.replace(LAG, "").replace('"a1", "a2", "a3"', '"-kp*w1", "-kp*w2", "-kp*w3"')


@pytest.mark.parametrize(
    ("changed", "name"),
    by_turns(
        [
            (PROMPT, "a without its lag"),
            (MOTOR.replace("/0.3", "/0.318"), "the number 0.3 in all texts"),
            (PROMPT.replace('"-kp*w3"', '"-1.1*kp*w3"'), None),
        ],
        3,
    ),
    ids=["no lag", "longer", "no lag and more"],
)
def test_a_lag_that_is_left_out_or_longer_is_named(changed: str, name: str | None) -> None:
    """Without a lag the moment makes its rate zero; another time constant is fitted by fine steps."""
    assert names(changed, MOTOR) == ([] if name is None else [name])
    if name == "a without its lag":
        assert as_printed(changed, MOTOR)[1] <= 1e-8


@pytest.mark.parametrize(
    "changed",
    [
        LATE,
        CONTINUOUSLY,
        LATER,
        HELD.replace('"1/10"', '"1/5"'),
        HELD.replace("-w1,", "w1,"),
        HELD.replace("0.45", "0.35"),
        HELD.replace(VALUE, 'value = ["-w1", "-w2", "-w3"]'),
    ],
    ids=["late", "continuous", "phase", "rate", "sign", "limit", "no limits"],
)
def test_the_printed_scene_of_a_cause_moves_as_the_answer_does(changed: str) -> None:
    """Its keys, put into the scene, are read, and make the motion of the answer."""
    _, error = as_printed(changed, HELD)
    assert error <= 1e-8


@pytest.mark.parametrize(
    ("changed", "key"),
    [
        (THIRDS.replace('"1/15"', '"2/15"'), 'states.m.every = "2/15"'),
        (THIRDS.replace(', "1/3"]', ', "1/6"]'), '"1/6"]'),
        (THIRDS.replace("-w2,-0.45,0.45", "-w2,-0.45,0.35"), ', "1/3"]'),
    ],
    ids=["times", "found", "own"],
)
def test_a_printed_number_has_all_of_its_digits(changed: str, key: str) -> None:
    """A number that no short decimal is, is printed as a fraction."""
    (cause,) = check(scene(THIRDS), of_scene(changed)).causes
    assert key in cause.sentence


TRACKED = HELD.replace("[body]", 'track = ["m"]\n[body]')


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        (TRACKED.replace("-w2,", "w2,"), "does not explain the error of m;"),
        (TRACKED.replace("0.45", "0.35"), " of m;"),
    ],
    ids=["contradicted", "explained"],
)
def test_a_cause_says_what_it_leaves_of_own_states(changed: str, words: str) -> None:
    """Held values of the file that are not those of the cause stand in the sentence."""
    (cause,) = check(scene(TRACKED), of_scene(changed)).causes
    assert words in cause.sentence
    assert ("does not explain" in cause.sentence) is words.startswith("does not")


def of_scene(text: str) -> dict[str, Any]:
    """Return the exact motion of a scene, rounded to doubles, as an answer."""
    times = list(scene(text).clock.instants)
    motion = exact(scene(text), times, 17).quantities.items()
    columns = {name: values.astype(float) for name, values in motion}
    return {"t": [float(t) for t in times], **columns}


def as_printed(changed: str, text: str) -> tuple[str, float]:
    """Return the sentence of the cause of a changed scene, and how far its printed scene moves from it."""
    (cause,) = of_motion(changed, text).causes
    document = tomllib.loads(text)
    for line in cause.sentence.partition("as a scene: ")[2].split("; "):
        for name, value in tomllib.loads(line).items():
            put(document if name in ("define", "states") else document["body"], name, value)
    printed = read(toml(document, repr), "printed")
    times = list(printed.clock.instants)
    moved, answer = (exact(s, times, 20)["omega"] for s in (printed, scene(changed)))
    return cause.sentence, float(np.max(np.abs(moved - answer)))


def put(table: dict[str, Any], name: str, value: Any) -> None:
    """Put a value into a table, and the entries of a table into that of its name."""
    if isinstance(value, dict):
        for key, entry in value.items():
            put(table.setdefault(name, {}), key, entry)
    else:
        table[name] = value


def test_what_a_cause_leaves_is_computed_through_the_kinks_of_limits() -> None:
    """Another limit leaves the digits of the file, and a right file no moment between its rows."""
    (cause,) = of_motion(SMOOTH.replace("0.45", "0.35"), SMOOTH).causes
    assert cause.sentence.startswith("the number 0.45 in all texts = 0.35 for 0.45")
    assert cause.leaves < 1e-7
    assert all(np.max(np.abs(each.load)) < 1e-6 for each in of_motion(SMOOTH, SMOOTH).missing_load)


@pytest.mark.parametrize(
    ("text", "key"),
    by_turns([(BODY, 'moment = ["a1", "a2", "a3"]'), (WHEELS, "rotor")]),
    ids=["sampled", "wheels"],
)
def test_a_moment_beside_own_states_is_listed_from_row_to_row(text: str, key: str) -> None:
    """Own states go on along the rows: what is listed is what no controller of the scene makes."""
    wave = "0.02*sin(3*t)"
    beside = f'moment = ["a1", "a2 + {wave}", "a3"]' if text is BODY else None
    changed = text.replace(key, beside or f'moment = ["0", "{wave}", "0"]\nrotor')
    known = of_motion(changed, text)
    assert not known.causes
    assert len(known.missing_load) > 10
    for each in known.missing_load:
        middle = (each.t + each.until) / 2
        assert each.load == pytest.approx([0, 0.02 * np.sin(3 * middle), 0], abs=2e-4)


def test_where_no_moment_leads_to_the_second_row_nothing_is_said() -> None:
    """Another moment changes nothing at first where limits hold: the file fails, and that is all."""
    text = Path("cases/loads/sampled-controller.toml").read_text(encoding="utf-8")
    text = text.replace('limit = "0.15"', 'limit = "0.45"').replace("end = 0.4", "end = 2")
    own = text.replace("samples = 3", "samples = 21")
    other = own.replace(TENTH, 'every = "1/5"')
    judged = check(scene(own), of_scene(other))
    assert judged["omega"].verdict is Status.FAIL
    assert not judged.causes
    assert not judged.missing_load


def test_rows_on_instants_that_no_double_is_have_a_floor(tmp_path: Path) -> None:
    """Rows at tenths, which are rounded, lie beside the instants, which are not: both are one point."""
    rows = exact(scene(), times=list(scene().clock.instants), digits=15)["omega"]
    v = np.array([[float(x) for x in row] for row in rows])
    times = np.array([float(t) for t in scene().clock.instants])
    path = write_csv(tmp_path / "mine.csv", named(("t", "w1", "w2", "w3"), np.c_[times, v]))
    judged = check(scene(), str(path), tolerance=1e-6)
    assert {verdict.verdict for verdict in judged.verdicts} == {Status.PASS}
    assert all(np.isfinite(verdict.attainable or np.nan) for verdict in judged.verdicts)


INTEGRAL = BODY.replace(
    CONTINUOUS, '[states]\nj = { start = [0, 0, 0], rate = ["w1", "w2 - 0.1*j1", "q3"] }\n'
).replace('"a1", "a2", "a3"', '"-kp*w1 - 0.3*j1", "-kp*w2 - 0.2*j2", "-0.4*q3 - 0.1*j3"')
# Each second instant is between two rows, and ends a step.
SLOW = BODY.replace("samples = 15", "samples = 8")
UNEVEN = SLOW.replace('"1/10"', '"3/25"').replace('"1/20"', '"3/50"')
Step = Callable[[Callable[[float, Array], Array], float, Array, float], Array]


def _heun(f: Callable[[float, Array], Array], t: float, y: Array, h: float) -> Array:
    first = f(t, y)
    return y + h / 2 * (first + f(t + h, y + h * first))


def _euler_with_turn(f: Callable[[float, Array], Array], t: float, y: Array, h: float) -> Array:
    after = y + h * f(t, y)
    after[3:7] = turned(y[3:7], h * after[:3])
    return after


def in_steps(text: str, step: Step, parts: list[float]) -> dict[str, Any]:
    """Return the answer in so many steps between rows and instants, each so large a part of all."""
    own = Evaluated(scene(text))
    y, now, rows = np.array(own.start(), float), Fraction(0), []

    def rates(t: float, y: Array) -> Array:
        return np.array(own.rates(t, list(y)), float)

    own.take(0.0, Fraction(0), list(y))
    times = list(scene(text).clock.instants)
    for time in sorted({*times, *instants(scene(text), times[-1])}):
        begin = float(now)
        for part in parts if time > now else []:
            y = step(rates, begin, y, part * float(time - now))
            y[3:7] /= np.linalg.norm(y[3:7])
            begin += part * float(time - now)
        if time in instants(scene(text), times[-1]):
            own.take(float(time), time, list(y))
        now = time
        rows += [y[:7]] if time in times else []
    columns = zip(("w1", "w2", "w3", "q0", "q1", "q2", "q3"), np.transpose(rows), strict=True)
    return {"t": [float(t) for t in times], **dict(columns)}


@pytest.mark.parametrize(
    ("text", "step", "parts", "name"),
    by_turns(
        [
            (INTEGRAL, _heun, [1 / 3] * 3, "Heun whose stages read q as it is, h = 0.0166667"),
            (BODY, _heun, [1.0], "truncation of order 2: Heun, h = 0.05"),
            (INTEGRAL, _euler_with_turn, [1 / 2] * 2, "turned by the rate at the end of the step"),
            (BODY, _euler_with_turn, [1 / 2] * 2, "explicit Euler, h = 0.025"),
            (SLOW, _heun, [1.0], "Heun, h = 0.05"),
            (UNEVEN, _heun, [1.0], "Heun, steps of at most 0.06"),
            (INTEGRAL, _heun, [2 / 5, 3 / 5], None),
            (BODY, _heun, [2 / 5, 3 / 5], None),
        ],
        3,
    ),
)
def test_coarse_steps_of_own_states_are_named(
    text: str, step: Step, parts: list[float], name: str | None
) -> None:
    """The steps are replayed from the start with all states; unequal ones have no name."""
    causes = check(scene(text), in_steps(text, step, parts)).causes
    assert len(causes) == (name is not None)
    assert not name or name in causes[0].sentence
