"""Physics engines as solvers: each begins where the scene does, and comes nearer with a smaller step."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from builders.processes import PATIENCE
from builders.scenes import acted, oblique

from taylor_verify.models.problem import pose
from taylor_verify.numbers.precision import rung
from taylor_verify.records.quantities import INITIAL, STATES
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict
from taylor_verify.run import run
from taylor_verify.scenes.reading.reader import load
from taylor_verify.solvers.engines.engine import SCRIPTS, engines, prepare
from taylor_verify.solvers.engines.launcher import NotMade
from taylor_verify.solvers.process import protocol
from taylor_verify.solvers.registry import solver_named
from taylor_verify.solvers.trajectory import Outcome

STEP = 1 / 32
# Settings that exclude each other: the explicit methods of Exudyn have no constraint.
BESIDE = {"coordinates=EulerParameters": "integrator=GeneralizedAlpha"}

# Engines with other equations than Euler's or Kirchhoff's: no smaller step brings them nearer.
# Without omega x I omega, whatever their settings or with this one.
WITHOUT_GYROSCOPIC_TERM = (
    *("ammo?flags=0", "ammo?flags=4", "ammo?flags=8"),
    *("brax-positional", "brax-spring", "cannon", "havok"),
    *("jolt?gyroscopic=off", "rapier?version=0.19.3"),
    *("bullet?gyroscopic=off", "ode?gyroscopic=off", "pybox3d"),
)
# Without what of the added mass goes with accelerations.
WITHOUT_ADDED_MASS = ("mujoco_fluid-ellipsoid",)


def has_other_equations(name: str) -> bool:
    """True for the name of an engine, with settings or without, that leaves out a term."""
    engine, _, settings = name.removeprefix("outside:").partition("?")
    asked = {engine, *(f"{engine}?{setting}" for setting in settings.split("&"))}
    return not asked.isdisjoint((*WITHOUT_GYROSCOPIC_TERM, *WITHOUT_ADDED_MASS))


def each_setting() -> list[str]:
    """The engines by name, with each word of each of their settings, and those without a step."""
    names = []
    for one in engines().values():
        about = one.script.about
        # The vehicles of simulators are bodies of their own: test_free_body.py.
        if about.data != "tensor" or one.script.library == "vehicle":
            continue
        words = [
            f"{key}={word}"
            for key, default in about.settings.items()
            if isinstance(default, list)
            for word in default
        ]
        queries = ["&".join(filter(None, (word, BESIDE.get(word)))) for word in words]
        names += [f"outside:{one.name}?{query}" for query in queries]
        if "step" not in about.settings:
            names.append(f"outside:{one.name}")
    return names


def verdicts_of(name: str, **settings: float) -> dict[str, Verdict]:
    """The verdicts on the scene by quantity, on the precision of the engine."""
    for key, value in settings.items():
        name += f"{'&' if '?' in name else '?'}{key}={value}"
    solver = solver_named(name)
    on = next(on for on in ("f64", "f32") if not solver.unavailable(rung(on)))
    takes_euler = "euler" in solver.engine.script.about.models
    scene = oblique() if takes_euler else load("kirchhoff/ellipsoid-triaxial")
    return {v.quantity: v for v in run(scene, solver, on).verdicts}


@pytest.mark.slow
@pytest.mark.parametrize("name", each_setting())
def test_an_engine_is_right_under_every_setting(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """The first row is the start in the axes of the question, and half the step leaves two thirds of the
    error or less, until roundoff, but where the engine has other equations. What an engine ships with,
    damping or sleep, holds the first alone."""
    # A test downloads nothing.
    monkeypatch.setenv("UV_OFFLINE", "1")
    try:
        prepare(name)
    except NotMade as reason:
        pytest.skip(str(reason))
    stepped = "step" in solver_named(name).engine.script.about.settings
    errors = []
    for step in (STEP, STEP / 2):
        verdicts = verdicts_of(name, **({"step": step} if stepped else {}))
        assert verdicts[INITIAL].verdict is Status.PASS
        errors.append(max(v.max or 0 for v in verdicts.values() if v.quantity in STATES))
        if "defaults=shipped" in name:
            return
    # Each step carries on a rounding; these orbits carry an error on thirtyfold at most.
    bits = rung(verdicts[INITIAL].rung).bits
    roundoff = 30 * 2.0**-bits * 4 / STEP
    comes_nearer = errors[1] <= max(errors[0] / 1.5 if stepped else 0.0, roundoff)
    assert comes_nearer is not has_other_equations(name)


def pushed() -> list[str]:
    """The engines that take all that acts on a rigid body."""
    abouts = {one.name: one.script.about for one in engines().values()}
    return [n for n, a in abouts.items() if a.loads == "written" and "euler" in a.models]


@pytest.mark.slow
@pytest.mark.parametrize("name", pushed())
def test_an_engine_is_given_loads_and_states(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Half the step leaves two thirds of the error or less, with loads, wheels and a sampled controller."""
    monkeypatch.setenv("UV_OFFLINE", "1")
    try:
        prepare(f"outside:{name}")
    except NotMade as reason:
        pytest.skip(str(reason))
    asked, errors = acted(), []
    for step in (STEP, STEP / 2):
        solver = solver_named(f"outside:{name}?step={step}")
        on = next(rung(on) for on in ("f64", "f32") if not solver.unavailable(rung(on)))
        answered = solver.solve(solver.problem(asked, on))
        assert answered.outcome is Outcome.FINISHED, answered.detail
        exact = solver_named("taylor").solve(pose(asked, on))
        errors.append(np.abs(answered.quantities["omega"] - exact.quantities["omega"]).max())
    assert errors[1] <= errors[0] / 1.5
    assert errors[0] < 0.1


# What the scripts do themselves.


@pytest.mark.parametrize("attitude", [(0.5, 0.5, -0.5, 0.5), (-0.6, 0.0, 0.8, 0.0), (-1, 0, 0, 0)])
def test_rodrigues_parameters_are_the_attitude(
    attitude: tuple[float, ...], sibling: Callable[[str], Any]
) -> None:
    """The parameters are at most 1 long, and lead back to the quaternion or its negative."""
    basilisk = sibling("with_basilisk")
    sigma = np.array(basilisk.rodrigues(attitude))
    assert sigma @ sigma <= 1
    back = np.array(basilisk.quaternion(sigma))
    assert abs(abs(back @ attitude) - 1) <= 4 * 2**-53


NOISY = """
import json, os, sys
sys.path.insert(0, {folder!r})
from free_body import Solved, answer

def solve(body, settings):
    print("noise of Python")
    os.system("echo noise of C")
    rows = [body.row(body.omega, body.attitude) for _ in body.instants]
    return Solved(rows, 0, 0, 0.0, 0.0)

answer(solve)
print("noise at the end")
"""


def test_what_an_engine_prints_is_not_in_the_answer() -> None:
    """Standard output has the answer alone; what an engine prints there goes to stderr."""
    question = json.dumps(protocol.question(pose(oblique(), rung("f64"))))
    done = subprocess.run(
        [sys.executable, "-c", NOISY.format(folder=str(SCRIPTS))],
        input=question,
        capture_output=True,
        text=True,
        check=True,
        timeout=PATIENCE,
    )
    assert len(json.loads(done.stdout)["w1"]) == 5
    for noise in ("noise of Python", "noise of C", "noise at the end"):
        assert noise in done.stderr
