"""Measurement of a plain call and the driver on a free body: the same scene, the same judge.

The plain call is judged on the moments and the omega that it was given, held exactly, as `check`
holds anybody's answer; the driver on the data that it rounds itself.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from fractions import Fraction
from math import inf, isfinite
from typing import Any, Final

from mpmath import mp

from taylor_verify.exact.route import solution
from taylor_verify.judge.floor.arithmetic import truth_digits
from taylor_verify.judge.judgement import judgement
from taylor_verify.models.problem import adopt
from taylor_verify.records.precisions import bits_of
from taylor_verify.records.quantities import GATE_FACTOR, INITIAL
from taylor_verify.records.verdict import Verdict
from taylor_verify.run import run
from taylor_verify.scenes import tensors
from taylor_verify.scenes.bodies import RigidBody
from taylor_verify.scenes.motion import Clock, Spin
from taylor_verify.scenes.precision import exact_value, held_exactly
from taylor_verify.scenes.precision import rung as rung_named
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.taylor.plain import Plain, euler_equations
from traps.document import TrapCase, TrapGate

MOMENTS: Final = (1, 2, 3)
# Dyadic in every format, and a spin about no axis.
GENERIC: Final = (0.71875, -0.40625, 0.90625)

# A truth of so many digits is beyond question beside an error of double precision.
_DIGITS: Final = truth_digits(bits_of("f64"), 10)


def free(name: str, omega: Sequence[float], end: float, samples: int = 11, start: int = 0) -> Scene:
    """The free body from this omega, exactly as the doubles have it, at equally spaced times.

    The times too are doubles, so that nobody has to round them.
    """
    elapsed = (Fraction(end * (k / (samples - 1))) for k in range(samples))
    body = RigidBody(tensors.diagonal(tuple(Fraction(moment) for moment in MOMENTS)))
    spin = Spin(tuple(Fraction(value) for value in omega))
    clock = Clock(Fraction(start), tuple(start + t for t in elapsed))
    return Scene(name, name, "euler", frozenset(), body, spin, clock)


def compared(scene: Scene, rung: str = "f64", typed: bool = False) -> TrapCase:
    """Return the judged case of the plain call and the driver on one scene."""
    problem = adopt(scene, rung_named(rung), scene.clock.instants)
    plain = Plain(typed=typed)
    trajectory = plain.solve(problem)
    judged = judgement(problem, plain, trajectory).verdicts
    driver, driver_error = driver_on(scene, rung)
    return TrapCase(
        scene.name,
        said=trajectory.detail,
        error=judged[0].max,
        driver=driver,
        driver_error=driver_error,
        steps=trajectory.steps,
        gates={verdict.quantity: _gate(verdict) for verdict in judged},
    )


def _gate(verdict: Verdict) -> TrapGate:
    over = None if verdict.ratio is None else verdict.ratio / GATE_FACTOR
    return TrapGate(verdict.verdict.value, over)


def driver_on(scene: Scene, rung: str = "f64") -> tuple[str, float | None]:
    """Return the words of the driver and the judge on a scene, and its largest error."""
    verdict = next(v for v in run(scene, "taylor", rung).verdicts if v.quantity != INITIAL)
    ending = f"{verdict.outcome}; state: {verdict.verdict.value}"
    return ending, verdict.max


def error_at(state: Iterable[Any], elapsed: Fraction) -> float:
    """Return the relative error of the generic body's omega at a time after its start."""
    numbers = [float(value) for value in state]
    if not all(isfinite(value) for value in numbers):
        return inf
    truth = solution(free("", GENERIC, 1.0)).motion([elapsed], _DIGITS)["omega"][0]
    with mp.workdps(_DIGITS):
        off = [held_exactly(exact_value(v)) - t for v, t in zip(numbers, truth, strict=True)]
        return float(mp.norm(off) / mp.norm(list(truth)))


def typed_equations() -> Any:
    """The body's equations as heyoka has them."""
    return euler_equations([float(moment) for moment in MOMENTS])
