"""Programs and files of others under loads that change with time: asked, answered and judged."""

from __future__ import annotations

import json
import math
import shlex
import shutil
import subprocess
from dataclasses import replace
from fractions import Fraction
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from builders import integrators
from builders.scenes import asked_at
from builders.trajectories import columns_at, write_csv
from mpmath import mp, mpf

import taylor_verify
from taylor_verify.exact.route import solution
from taylor_verify.judge.floor.inputs import _numbers, _with_factors
from taylor_verify.models.problem import Problem, adopt, pose
from taylor_verify.numbers.precision import rung
from taylor_verify.records.status import Status
from taylor_verify.run import run
from taylor_verify.scenes import library
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.callback import Callback
from taylor_verify.solvers.process import protocol
from taylor_verify.solvers.process.process import named
from taylor_verify.solvers.trajectory import Outcome

NAMES = library.names("manufactured")
EULER = "manufactured/euler-tones"
KIRCHHOFF = "manufactured/kirchhoff-path"
F64 = rung("f64")
OUTSIDE = Path(protocol.__file__).parents[1] / "outside"


def short(name: str, end: Fraction) -> Scene:
    return asked_at(name, 0, end / 2, end)


# What a program is told.


def asked(problem: Problem) -> dict[str, Any]:
    return protocol.question(problem)


def as_fractions(entry: Any) -> Any:
    """The exact numbers of a text, nested as they are."""
    return [as_fractions(e) for e in entry] if isinstance(entry, list) else Fraction(entry)


@pytest.mark.parametrize("on", ["f32", "mp237"])
@pytest.mark.parametrize("name", [EULER, KIRCHHOFF, "manufactured/euler-full-tensor"])
def test_the_waves_that_are_told_are_the_motion(name: str, on: str) -> None:
    """H*, or x* and y*, is start + cosines (cos nu t - 1) + sines sin nu t of the exact texts."""
    problem = pose(load(name), rung(on))
    document, given = asked(problem), replace(problem.given, track=frozenset())
    waves = {key: as_fractions(value["text"]) for key, value in document["manufactured"].items()}
    initial, time = document["initial"], Fraction(13, 10)
    if document["model"] == "euler":
        begin = as_fractions(initial["angular_momentum"]["text"])
        inertia = as_fractions(document["body"]["inertia"]["text"])
    else:
        begin = as_fractions(initial["linear_impulse"]["text"]) + as_fractions(
            initial["angular_impulse"]["text"]
        )
    motion = solution(given).motion([time], 60)
    with mp.workdps(70):
        known = [v for n in motion.quantities for v in motion[n][0]]
        if document["model"] == "euler":
            known = [sum(mp.convert(i) * w for i, w in zip(r, known, strict=True)) for r in inertia]
        values = [mp.convert(v) for v in begin]
        for nu, a, b in zip(waves["frequencies"], waves["cosines"], waves["sines"], strict=True):
            c, s = mp.cos_sin(mp.convert(nu * time))
            terms = zip(values, a, b, strict=True)
            values = [z + mp.convert(p) * (c - 1) + mp.convert(q) * s for z, p, q in terms]
        assert max(abs(p - q) for p, q in zip(known, values, strict=True)) <= mpf(10) ** -58
    cosines = zip(waves["constant_part"], *waves["cosines"], strict=True)
    assert [sum(column) for column in cosines] == begin


# Programs that answer.


def doubles(table: Any) -> dict[str, Any]:
    """The hexadecimal floats of a table of the question."""
    return {key: np.array(as_doubles(value["hex"])) for key, value in table.items()}


def as_doubles(entry: Any) -> Any:
    return [as_doubles(e) for e in entry] if isinstance(entry, list) else float.fromhex(entry)


def runge_kutta(problem: Problem, step: float) -> Any:
    """Omega, or the impulses, by RK4 on what a program is told: z' is that of z*, and free beside it."""
    document = json.loads(json.dumps(asked(problem)))
    body, initial, waves, clock = (
        doubles(document[table]) for table in ("body", "initial", "manufactured", "time")
    )
    is_euler = document["model"] == "euler"

    def free(z: Any) -> Any:
        if is_euler:
            return np.cross(z, body["inverse_inertia"] @ z)
        x, y = z[:3], z[3:]
        U = body["linear"] @ x + body["coupling"] @ y
        w = body["coupling"].T @ x + body["angular"] @ y
        return np.concatenate([np.cross(x, w), np.cross(y, w) + np.cross(x, U)])

    def rates(t: float, z: Any) -> Any:
        nu, cosines, sines = waves["frequencies"], waves["cosines"], waves["sines"]
        c, s = np.cos(nu * t), np.sin(nu * t)
        there = start + (c - 1) @ cosines + s @ sines
        return free(z) + (nu * c) @ sines - (nu * s) @ cosines - free(there)

    names = ("angular_momentum",) if is_euler else ("linear_impulse", "angular_impulse")
    z = start = np.concatenate([initial[name] for name in names])
    rows, now = [], 0.0
    for instant in clock["elapsed"]:
        count = math.ceil(abs(instant - now) / step)
        for k in range(count):
            h, t = (instant - now) / count, now + k * (instant - now) / count
            z = integrators.step(rates, t, z, h)
        now = instant
        rows.append(body["inverse_inertia"] @ z if is_euler else z)
    return np.array(rows)


@pytest.mark.parametrize(("name", "end"), [(EULER, 2), (KIRCHHOFF, -2)])
def test_a_program_follows_the_loads_with_order_four(name: str, end: int) -> None:
    """Halving the step of RK4 divides the error of the state by 16: the loads are those of the time."""
    scene = replace(short(name, Fraction(end)), track=frozenset())
    errors = []
    for step in (0.05, 0.025):
        verdicts = run(scene, Callback(partial(runge_kutta, step=step)), causes=False).verdicts
        (state,) = [v for v in verdicts if v.quantity in ("omega", "impulse")]
        assert state.verdict is Status.FAIL
        errors.append(state.max or 0.0)
    # Half an order leaves room for the next term of the error, and none for orders 3 and 5.
    assert 2**3.5 <= errors[0] / errors[1] <= 2**4.5


def test_the_example_in_c_says_that_it_has_no_such_loads(tmp_path: Path) -> None:
    """A program made for constant loads can tell from the question, and answers that it is unsuited."""
    compiler = shutil.which("cc") or shutil.which("gcc")
    if compiler is None:
        pytest.skip("no C compiler")
    built = tmp_path / "rk4"
    subprocess.run([compiler, "-std=c99", "-o", built, OUTSIDE / "rk4.c", "-lm"], check=True)
    trajectory = named(f"process:{shlex.quote(str(built))}").solve(pose(load(EULER), F64))
    assert trajectory.outcome is Outcome.UNSUITED
    assert "expected constant loads, got a manufactured motion" in trajectory.detail


# Files.


def written(scene: Scene, folder: Path, **columns: Any) -> str:
    return write_csv(folder / "file.csv", {**columns_at(scene, scene.clock.instants), **columns})


@pytest.mark.parametrize("name", [EULER, pytest.param(KIRCHHOFF, marks=pytest.mark.slow)])
def test_a_sound_file_passes(name: str, tmp_path: Path) -> None:
    """The exact motion of numbers rounded where the scene writes them passes, balances and all."""
    scene = load(name)
    judgement = taylor_verify.check(scene, written(scene, tmp_path))
    assert {verdict.verdict for verdict in judgement.verdicts} == {Status.PASS}
    assert {"T"} < {verdict.quantity for verdict in judgement.verdicts}
    assert judgement.conventions == ()


def test_a_file_that_drifts_in_one_row_fails_by_its_balances(tmp_path: Path) -> None:
    """A component off by 1e-12 in a single row fails by the balances under these loads."""
    scene = load(EULER)
    columns = columns_at(scene, scene.clock.instants)
    columns["w2"][len(columns["w2"]) // 2] += 1e-12
    judgement = taylor_verify.check(scene, write_csv(tmp_path / "file.csv", columns))
    failed = {v.quantity for v in judgement.verdicts if v.verdict is Status.FAIL}
    assert failed == {"omega", "T", "H2"}


@pytest.mark.parametrize("on", ["f32", "f64"])
@pytest.mark.parametrize("name", NAMES)
def test_what_a_stranger_stores_is_a_manufactured_motion(name: str, on: str) -> None:
    """Each number of the scene rounded where it stands: the motion begins at its own start, exactly."""
    scene = load(name)
    given = adopt(scene, rung(on), scene.clock.instants).given
    motion = given.body.manufactured
    assert motion is not None
    assert all(rung(on).holds(w.frequency) for w in motion.waves)
    assert all(rung(on).holds(c) for w in motion.waves for c in (*w.cosine, *w.sine))
    assert solution(replace(given, track=frozenset())).regime == "manufactured"


def test_every_number_of_a_motion_is_an_input() -> None:
    """Frequencies, coefficients and constants are moved like the body's numbers, each at its place."""
    scene = load(EULER)
    motion, u = scene.body.manufactured, F64.unit_roundoff
    assert motion is not None
    places = _numbers(scene)
    written = [motion.constant, *(v for w in motion.waves for v in (w.cosine, w.sine))]
    of_motion = [p for p in places if p[0][:4] in ("cons", "cosi", "sine", "freq")]
    assert len(of_motion) == len(motion.waves) + sum(bool(c) for v in written for c in v)
    for name, k, _ in of_motion:
        moved = _with_factors(scene, {(name, k, k): 1 + u}).body.manufactured
        assert moved is not None
        assert moved != motion
        if name == "frequency":
            assert [w.frequency for w in moved.waves] == [
                w.frequency * (1 + u if j == k else 1) for j, w in enumerate(motion.waves)
            ]
