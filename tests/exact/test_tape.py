"""Each operation of a tape: its series, its bounds, and what is seen where a bound is left out.

The body is a sphere, so that w' is the moment. The rate of w3 is a function of w1 and w2, which turn in a
circle, or rest, or of the time.
"""

from __future__ import annotations

from fractions import Fraction
from itertools import product
from typing import Any
from unittest import mock

import pytest
from builders.turns import by_turns
from builders.written_loads import FUNCTIONS, about_axes
from flint import arb, ctx
from mpmath import mp, mpf

from taylor_verify.exact.enclosure import functions, kinks, operations, powers
from taylor_verify.exact.enclosure.box import Box, within
from taylor_verify.exact.enclosure.loaded import posed
from taylor_verify.exact.enclosure.operations import Operation, State
from taylor_verify.exact.enclosure.series import Series
from taylor_verify.exact.enclosure.step import Step, Stepper
from taylor_verify.exact.enclosure.system import System
from taylor_verify.exact.route import solution
from taylor_verify.numbers.irrational import ball

# Numbers in them are dyadic, so that Python reads them exactly.
TEXTS = {
    "product": "w1*w2", "square": "w1**2 - w2", "quotient": "w2/(2 + w1)", "inverse": "1/(2 + w1)",
    "sqrt": "sqrt(2 + w1)", "exp": "exp(w1)", "log": "log(2 + w1)", "power": "(2 + w1)**-0.75",
    "sin": "sin(3*w1)", "cos": "cos(3*w1)", "tan": "tan(w1)", "sinh": "sinh(2*w1)", "cosh": "cosh(2*w1)",
    "tanh": "tanh(2*w1)", "atan": "atan(2*w1)", "asin": "asin(w1)", "acos": "acos(w1)",
    "atan2": "atan2(w1, 2 + w2)", "abs": "abs(w1 - 2)*w1", "norm": "norm(w1, w2, 0.5 + w1)",
    "min": "min(w1**2, 4 + w2)", "max": "max(w1**2, w2 - 4)",
}  # fmt: skip
OMEGA = '["3/10", "2/5", "1/7"]'
START = Fraction(3, 10), Fraction(2, 5), Fraction(1, 7)
APART = Fraction(1, 100)
BITS, ORDER = 60, 8


def circling(text: str) -> System:
    return posed(about_axes(f'["w2", "-w1", "{text}"]', OMEGA))


def value(text: str, w1: Any, w2: Any) -> Any:
    return eval(text, dict(FUNCTIONS), {"w1": w1, "w2": w2})


def turned(start: tuple[Any, Any], t: Any) -> tuple[Any, Any]:
    """w1 and w2, which turn in a circle."""
    (a, b), c, s = start, mp.cos(t), mp.sin(t)
    return a * c + b * s, b * c - a * s


def exactly(number: Fraction) -> Any:
    return mpf(number.numerator) / number.denominator


@pytest.mark.parametrize("name", by_turns(TEXTS))
def test_the_series_is_that_of_the_function(name: str) -> None:
    """Twelve orders of every function, against derivatives by mpmath."""
    step = Fraction(-1, 8)
    with mp.workdps(60), ctx.workprec(150):
        tape = circling(TEXTS[name]).pieces(Fraction(0), False)[0]
        series = Series(tape, [ball(w) for w in START], Fraction(0), step, 14)
        begin = exactly(START[0]), exactly(START[1])
        known = mp.taylor(lambda t: value(TEXTS[name], *turned(begin, t)), 0, 12)
        for k, coefficient in enumerate(known):
            got = mpf(series.forward[tape.rates[2]][k].str(40, radius=False))
            assert abs(got - coefficient * exactly(step) ** k) <= mpf(10) ** -24


def step_of(system: System, apart: Fraction, length: Fraction) -> tuple[Box, Step]:
    """A step of few orders from all starts that are ``apart`` in w1 and w2."""
    with ctx.workprec(BITS), mock.patch.object(Stepper, "order", ORDER):
        start = [
            arb(ball(w), ball(d).upper()) for w, d in zip(START, (apart, apart, 0), strict=True)
        ]
        box = Box.about(start)
        return box, Stepper(system).step(box, Fraction(0), length, length)


def stays(text: str, apart: Fraction, length: Fraction = Fraction(1, 4)) -> bool:
    """Return True if the motions from the corners of the box, and from its middle, are in the balls."""
    box, step = step_of(circling(text), apart, length)
    corners = list(product((-1, 1), repeat=2)) if apart else [(0, 0)]
    with mp.workdps(40), ctx.workprec(150):
        for share, signs in product((Fraction(1, 2), Fraction(1)), corners):
            begin = tuple(exactly(w + s * apart) for w, s in zip(START[:2], signs, strict=True))
            time = exactly(share * step.length)
            way = mp.quad(lambda t, b=begin: value(text, *turned(b, t)), [0, time])
            balls = within(box, step.state, step.tube, step.flow, ball(share))
            true = (*turned(begin, time), exactly(START[2]) + way)
            if not all(b.overlaps(arb(mp.nstr(e, 38))) for b, e in zip(balls, true, strict=True)):
                return False
    return True


@pytest.mark.parametrize("name", by_turns(TEXTS))
@pytest.mark.parametrize("length", [Fraction(1, 4), Fraction(-1, 4)])
def test_motions_stay_in_their_balls(name: str, length: Fraction) -> None:
    """From the corners of a wide box, and from a point, in both directions of time."""
    assert stays(TEXTS[name], APART, length)
    assert stays(TEXTS[name], Fraction(0), length)


# Functions of the time alone: what the operation leaves out is the only error of the step.
OF_TIME = {
    powers.Quotient: "1/(2 + t)", powers.Root: "sqrt(2 + t)", powers.Exponential: "exp(t)",
    powers.Logarithm: "log(2 + t)", powers.Power: "(2 + t)^0.75", functions.Circular: "cos(t)",
    functions.Hyperbolic: "cosh(t)", functions.HyperbolicTangent: "tanh(1 + t)",
    functions.Arctangent: "atan(1 + t)", functions.Angle: "atan2(1 + t, 2)", kinks.Norm: "norm(t, 1)",
}  # fmt: skip


def is_near(text: str) -> bool:
    """Return True if w3 after a step is within the bound of what its polynomial leaves out."""
    system = posed(about_axes(f'[0, 0, "{text}"]', OMEGA))
    with ctx.workprec(100), mock.patch.object(Stepper, "root_test", return_value=0.0):
        _, step = step_of(system, Fraction(0), Fraction(1, 16))
    with mp.workdps(40), ctx.workprec(150):
        python = text.replace("^", "**")
        end = exactly(step.length)
        way = mp.quad(lambda t: eval(python, dict(FUNCTIONS), {"t": t}), [0, end])
        polynomial = sum((row[2] for row in step.state), arb(0))
        error = abs(polynomial - arb(mp.nstr(exactly(START[2]) + way, 38)))
        return bool(error.lower() <= step.tube.truncation[2, 0].upper() + polynomial.rad())


@pytest.mark.parametrize("operation", OF_TIME, ids=lambda operation: operation.__name__)
def test_what_an_operation_leaves_out_counts(
    operation: type[Operation], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Without it the motion is not where its polynomial is."""
    assert is_near(OF_TIME[operation])
    monkeypatch.setattr(operation, "left_out", lambda *_: arb(0))
    assert not is_near(OF_TIME[operation])


CURVED = (
    "quotient",
    "sqrt",
    "exp",
    "log",
    "power",
    "sin",
    "cosh",
    "tanh",
    "atan",
)


@pytest.mark.parametrize("name", CURVED)
def test_the_width_of_a_node_counts(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Where nodes are as wide as their own missed part alone, motions from a wide box leave it."""
    assert stays(TEXTS[name], APART)
    for module in (operations, powers, functions, kinks):
        for kind in vars(module).values():
            if isinstance(kind, type) and "apart" in vars(kind) and kind is not State:
                monkeypatch.setattr(kind, "apart", lambda _, i, b: b.missed[i])
    assert not stays(TEXTS[name], APART)


# Kinks.


@pytest.mark.parametrize("end", [Fraction(2), Fraction(-2)])
def test_a_fall_from_rest_begins_on_the_kink_of_a_norm(end: Fraction) -> None:
    """w' = 1 - |w| w from rest is tanh t; the sign of w is that of the time, which |w| must know."""
    for text in ("1 - norm(w1, w2)*w1", "1 - abs(w1)*w1"):
        motion = solution(about_axes(f'["{text}", 0, 0]', "[0, 0, 0]", str(end))).motion(
            [end / 2], 30
        )
        with mp.workdps(45):
            # Backwards w is negative: w' = 1 + w^2.
            true = mp.tanh(1) if end > 0 else -mp.tan(1)
            apart = abs(motion["omega"][0][0] - true)
            assert apart <= abs(true) * motion.radius[0] <= mpf(10) ** -29


def test_a_clipped_controller_passes_its_limits() -> None:
    """w3' = clip(x, -1/2, 1/2) with x = cos 2t: the corners of the clip cost no digit."""
    moment = '["2*w2", "-2*w1", "clip(w1, -1/2, 1/2)"]'
    motion = solution(about_axes(moment, "[1, 0, 0]")).motion([Fraction(3), Fraction(-3)], 30)
    with mp.workdps(45):
        kinks_at = [k * mp.pi / 2 + s * mp.pi / 6 for k in range(-2, 3) for s in (-1, 1)]
        for row, end, radius in zip(motion["omega"], (3, -3), motion.radius, strict=True):
            inside = sorted(t for t in kinks_at if 0 < t / end < 1)
            ways = [0, *(inside if end > 0 else inside[::-1]), end]
            true = mp.quad(lambda t: max(min(mp.cos(2 * t), mpf(1) / 2), -mpf(1) / 2), ways)
            assert abs(row[2] - true) <= radius * 3
            assert radius <= mpf(10) ** -30


def test_a_kink_where_a_piece_of_time_ends_is_passed() -> None:
    """|t - 1| with a switch at 1: the step that ends there is no shorter than others near a kink."""
    for end in (Fraction(3), Fraction(-1)):
        moment = '["abs(t - 1) + abs(t + 1/2)", "1 if t < 1 else 2", "1 if t < -1/2 else 2"]'
        motion = solution(about_axes(moment, "[0, 0, 0]", str(end))).motion([end], 30)
        true = Fraction(17, 2) if end > 0 else -Fraction(7, 4)
        with mp.workdps(40):
            assert abs(motion["omega"][0][0] - exactly(true)) <= mpf(10) ** -29


def test_of_two_kinks_the_near_one_alone_is_flat() -> None:
    """Before the lower corner of a clip nothing is known to be flat but that corner."""
    moment = '[0, 0, "clip(cos(t) - w3, -1/9, 1/9)"]'
    motion = solution(about_axes(moment, "[1, 1, 1]", "-3")).motion([Fraction(-3)], 30)
    assert motion.radius[0] <= mpf(10) ** -30
