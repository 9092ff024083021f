"""Motions beside an exact one: they are those of the enclosed equations, or there is no answer."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from functools import cache, partial
from types import SimpleNamespace
from typing import Any

import gmpy2
import numpy as np
import pytest
from builders.turns import by_turns
from builders.written_loads import kirchhoff
from mpmath import mp, mpf

from taylor_verify.exact.conditioning import neighbours as module
from taylor_verify.exact.conditioning.extrapolation import extrapolated
from taylor_verify.exact.conditioning.loaded import Linearised
from taylor_verify.exact.conditioning.neighbours import _Arcs, neighbours
from taylor_verify.exact.quadratic_forms import Floats
from taylor_verify.exact.route import solution
from taylor_verify.exact.taylor import arcs
from taylor_verify.scenes.motion import Clock, Motion, State
from taylor_verify.scenes.mpfr import in_mpfr, precision, to_mpf
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene

TIMES = (Fraction(0), Fraction(1, 3), Fraction(3, 4))
ENDS = (Fraction(2, 5), Fraction(1), Fraction(3, 2))
SPANS = [end - begin for begin, end in zip(TIMES, ENDS, strict=True)]
LOADED = replace(
    kirchhoff(["-u1/4", "c2/9", "-r33/3"], ["-w1/5", "x1*r21", "sin(t)/4"], "4"),
    clock=Clock(Fraction(0), (Fraction(0), Fraction(1), Fraction(3, 2))),
)
# Of the exact motion, and of that under written loads, near which no state is nearer than 1e-12.
DIGITS, LOADED_DIGITS = 90, 40
# Constant loads; wheels and attitude; a path.
SCENES = (
    "euler/constant-moment",
    "euler/gyrostat-moment",
    "kirchhoff/steady-screw-under-loads",
)


@cache
def exact_motion(scene: Scene, times: tuple[Fraction, ...]) -> Motion:
    return solution(scene).motion(times, digits_of(scene))


def digits_of(scene: Scene) -> int:
    return DIGITS if scene.body.loads is None else LOADED_DIGITS


def beside(scene: Scene, size: Fraction) -> list[State]:
    """Exact states near the motion at TIMES: every component is off by some parts of ``size``."""
    motion, states = exact_motion(scene, TIMES), []
    for k in range(len(TIMES)):
        parts = {}
        for name in scene.initial.MOVING:
            parts[name] = off(motion[name][k], size * (k + 1))
        if "attitude" in scene.track:
            q = np.array(quaternion(motion["attitude"][k]), dtype=object)
            parts["attitude"] = off(q, size)
        if "centre" in scene.track:
            parts["centre"] = off(motion["centre"][k], size)
        states.append(scene.initial.with_parts(parts))
    return states


def off(vector: np.ndarray, size: Fraction) -> tuple[Fraction, ...]:
    exact = [Fraction(str(mp.nstr(value, 100))) for value in vector]
    return tuple(value + size * Fraction(3 - 2 * i, 4) for i, value in enumerate(exact))


def quaternion(R: np.ndarray) -> list[mpf]:
    """The quaternion of a rotation that is no half turn."""
    scalar = mp.sqrt(1 + R[0, 0] + R[1, 1] + R[2, 2]) / 2
    axis = (R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1])
    return [scalar, *(each / (4 * scalar) for each in axis)]


def asked(scene: Scene, states: list[State], digits: int) -> Motion | None:
    """Where the states come to by their difference from the exact motion, in numbers of mpmath."""
    exact = tuple(in_mpfr(exact_motion(scene, at)) for at in (TIMES, ENDS))
    here = arcs(scene, states, [Fraction(0)] * 3, digits_of(scene), TIMES)
    with precision():
        derivatives = led(scene)
        motion = neighbours(scene, SPANS, exact, in_mpfr(here), derivatives).to(digits)
    if motion is None:
        return None
    return Motion({name: to_mpf(rows) for name, rows in motion.quantities.items()}, motion.radius)


@cache
def led(scene: Scene) -> Floats | None:
    """The derivatives of the motion over the arcs, under written loads."""
    if scene.body.loads is None:
        return None
    every = Clock(scene.clock.start, tuple(sorted({*TIMES, *ENDS})))
    assert not scene.clock.start
    exact = Linearised(replace(scene, clock=every), 20)
    return exact.derivatives(TIMES, ENDS)


def distance(one: Motion, other: Motion) -> mpf:
    """The largest difference of any component, over the largest component of its quantity."""
    return max(
        max(abs(value) for value in (rows - other[name]).flat)
        / max(1, *(abs(value) for value in rows.flat))
        for name, rows in one.quantities.items()
    )


@pytest.mark.parametrize("name", SCENES)
@pytest.mark.parametrize(("size", "digits"), by_turns([("1e-14", 16), ("1e-4", 6), ("1e-70", 71)]))
def test_they_are_the_enclosed_arcs(name: str, size: str, digits: int) -> None:
    """States a little off come to where their own enclosed arcs come to, squares included."""
    with mp.workdps(DIGITS + 20):
        scene = load(name)
        states = beside(scene, Fraction(size))
        motion = asked(scene, states, digits)
        assert motion is not None
        arrived = arcs(scene, states, SPANS, digits + 10, TIMES)
        assert distance(motion, arrived) <= mpf(10) ** -(digits + 3)


@pytest.mark.parametrize(("size", "is_close"), [("1e-12", True), ("1e-3", False)])
def test_under_written_loads_a_derivative_leads_there(size: str, is_close: bool) -> None:
    """The derivative leads what is off by little to where its own arc comes; more is refused."""
    with mp.workdps(DIGITS + 20):
        states = beside(LOADED, Fraction(size))
        motion = asked(LOADED, states, 15)
        assert (motion is not None) is is_close
        if motion is not None:
            arrived = arcs(LOADED, states, SPANS, 30, TIMES)
            assert 0 < distance(motion, arrived) <= mpf(10) ** -18


def test_the_motion_beside_its_derivative_is_the_exact_one() -> None:
    """The run that gives the derivative has the motion, within both radii; elsewhere it is asked for."""
    exact, other = Linearised(LOADED, 20), solution(LOADED)
    for elapsed in (LOADED.clock.elapsed, [Fraction(1, 7)]):
        one, two = (each.motion(elapsed, 20) for each in (exact, other))
        assert one.quantities.keys() == two.quantities.keys()
        assert distance(one, two) <= 4 * max(*one.radius, *two.radius) < mpf(10) ** -19


def test_no_answer_where_doubles_are_not_enough() -> None:
    """Float64 has no twenty digits of the motion for a difference of a thousandth."""
    with mp.workdps(DIGITS + 20):
        scene = load("euler/gyrostat-moment")
        assert asked(scene, beside(scene, Fraction("1e-3")), 20) is None


def test_no_answer_after_too_many_steps() -> None:
    """Arcs of thousands of radians are left to the enclosure."""
    with mp.workdps(DIGITS + 20):
        scene = load("euler/constant-moment")
        exact = in_mpfr(solution(scene).motion(TIMES, DIGITS))
        with precision():
            far = [10**4 * span for span in SPANS]
            assert neighbours(scene, far, (exact, exact), exact).to(16) is None


def test_a_wrong_end_of_the_exact_motion_is_noticed() -> None:
    """The motion along an arc has to arrive at the exact one: else there is no answer."""
    with mp.workdps(DIGITS + 20):
        scene = load("euler/constant-moment")
        states = beside(scene, Fraction("1e-12"))
        exact = [in_mpfr(solution(scene).motion(times, DIGITS)) for times in (TIMES, TIMES)]
        here = in_mpfr(arcs(scene, states, [Fraction(0)] * 3, DIGITS, TIMES))
        with precision():
            assert neighbours(scene, SPANS, (exact[0], exact[1]), here).to(16) is None


def test_too_low_an_order_is_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    """Two orders that do not agree are no answer."""
    with mp.workdps(DIGITS + 20):
        scene = load("euler/constant-moment")
        states = beside(scene, Fraction("1e-14"))
        assert asked(scene, states, 16) is not None
        monkeypatch.setattr(module, "extrapolated", partial(extrapolated, parts=(2, 4)))
        assert asked(scene, states, 16) is None


def test_an_error_of_one_block_is_held_to_that_block() -> None:
    """An error that a large impulse does not notice is too large for a small one beside it."""
    blocks = np.array([[1e-9] * 3 + [1.0] * 3])
    counted: Any = SimpleNamespace(counted=lambda _: blocks, _has_turn=False, _has_centre=False)
    exact = Motion({}, np.zeros(1))
    for first, is_negligible in ((True, False), (False, True)):
        errors = np.array([[1e-12] * 3 + [0.0] * 3 if first else [0.0] * 3 + [1e-12] * 3])
        assert _Arcs.is_negligible(counted, errors, gmpy2.mpfr(1), exact, 6) == is_negligible
