"""Motions under written loads are those of an integrator that reads the texts by itself."""

from __future__ import annotations

from fractions import Fraction

import pytest
from builders.turns import by_turns
from builders.written_loads import about_axes, end_of, euler, kirchhoff
from mpmath import mp, mpf

from taylor_verify.exact.route import solution
from taylor_verify.exact.solution import NoClosedForm, Unsettled
from taylor_verify.scenes.scene import Scene

DIGITS = 18

# Each function of the grammar, each name, and the forms that people write.
EULER = {
    "waves": ("0.1*sin(2*t)", "-w2/20", "cos(t/3)*w1"),
    "field": ("2*b2*r11 - b3", "b1*q0 - 0.3*w2", "-b1*b2*q3"),
    "gradient": ("I23*(o2^2 - o3^2)", "3*n^2*o3*o1", "(I22 - I11)*o1*o2"),
    "roots": ("sqrt(2 + w1)", "pow(3 + w2, 1/3)", "-(w1^2 + w3^2 + 1)^-1.5"),
    "transcendental": ("exp(-w1)*log(3 + w2)", "tan(w3/2) - asin(w1/4)", "acos(w2/4) - atan(3*w1)"),
    "hyperbolic": ("sinh(w1) - cosh(w2)", "tanh(5*w3)", "atan2(w1 - 2, w2 + 3)"),
    "norms": ("-0.2*norm(w1, w2, w3)*w1", "-0.2*norm(w1, w2, w3)*w2", "1/(2 + t)"),
    "constants": ("pi*w2/10", "sqrt(2)*w3/5", "exp(1/10)*(2*pi - 6)*w1"),
}
TABLES = """
[define]
n = "1/2"
[space]
b = ["cos(n*t)", "sin(n*t)/2", "1/3"]
o = ["cos(n*t)", "sin(n*t)", 0]
"""
KIRCHHOFF = {
    "drag": (("-0.2*s*u1", "-0.2*s*u2", "-0.2*s*u3"), ("-0.1*w1", "-w2/8", "-w3*abs(2 + w3)/8")),
    "thrust": (("exp(-t/5)", "0.1*x2*y3", "0"), ("0.2*sin(3*t)", "-y2/10", "x1*u2/7")),
    "spring": (("-d1/4", "-d2/4", "-d3/4"), ("0", "c1*r31/5", "q1*q2")),
}
SPEED = """
[define]
s = "norm(u1, u2, u3)"
[space]
d = ["c1", "c2", "c3 + 1"]
"""
HUNG = """
weight = { force = [0, 0, 2], at = [0, "1/8", "1/10"] }
buoyancy = { force = [0, 0, "-7/4"] }
current = ["1/4", 0, "-1/8"]
"""


def distances(scene: Scene, time: Fraction) -> list[tuple[mpf, mpf]]:
    """How far each vector of the enclosure is from the other integrator's, and its radius."""
    motion = solution(scene).motion([time], DIGITS)
    end = end_of(scene, time, DIGITS).state
    pairs = []
    names = ["omega"] if scene.model == "euler" else ["linear_impulse", "angular_impulse"]
    with mp.workdps(DIGITS + 15):
        for k, name in enumerate(names):
            pairs.append(_apart(motion[name][0], end[3 * k : 3 * k + 3], motion.radius_of(name)[0]))
        if scene.model == "kirchhoff":
            pairs.append(_apart(motion["centre"][0], end[-3:], motion.radius_of("centre")[0]))
    return pairs


def _apart(vector: object, other: list[mpf], radius: mpf) -> tuple[mpf, mpf]:
    size = mp.norm(other)
    apart = mp.norm([a - b for a, b in zip(list(vector), other, strict=True)])  # type: ignore[call-overload]
    return apart / size, radius


@pytest.mark.parametrize("name", by_turns(EULER))
@pytest.mark.parametrize("end", ["3/4", "-1/4"])
def test_a_moment_of_texts_turns_the_body_as_python_reads_it(name: str, end: str) -> None:
    """Every function and every name, forwards and backwards in time."""
    scene = euler(EULER[name], end, TABLES)
    for apart, radius in distances(scene, scene.clock.elapsed[-1]):
        assert apart <= radius + mpf(10) ** -(DIGITS + 4)
        assert radius <= mpf(10) ** -DIGITS


@pytest.mark.parametrize("name", by_turns(KIRCHHOFF))
def test_force_and_couple_of_texts_drive_the_solid_as_python_reads_them(name: str) -> None:
    """With weight, buoyancy and a current beside them; the centre is a state where a load reads it."""
    scene = kirchhoff(*KIRCHHOFF[name], tables=SPEED, more=HUNG)
    for apart, radius in distances(scene, scene.clock.elapsed[-1]):
        assert apart <= radius + mpf(10) ** -(DIGITS + 4)


def test_a_kink_is_crossed_without_loss_of_digits() -> None:
    """w' = 1 - w|w| from -1 is tan(t - pi/4) up to its zero, and tanh(t - pi/4) behind it."""
    scene = about_axes('["1 - w1*abs(w1)", 0, 0]', "[-1, 0, 0]")
    motion = solution(scene).motion([Fraction(1, 2), Fraction(2)], 30)
    with mp.workdps(40):
        true = mp.tan(mpf(1) / 2 - mp.pi / 4), mp.tanh(2 - mp.pi / 4)
        for row, value, radius in zip(motion["omega"], true, motion.radius, strict=True):
            assert abs(row[0] - value) <= abs(value) * radius <= abs(value) * mpf(10) ** -30


def test_thirty_kinks_cost_no_digit() -> None:
    """With w1 = sin t the rate |w1| of w2 has its kinks at n pi: w2 = 2n + 1 - cos(t - n pi)."""
    scene = about_axes('["cos(t)", "abs(w1)", 0]')
    motion = solution(scene).motion([Fraction(100)], 30)
    with mp.workdps(40):
        n = mp.floor(100 / mp.pi)
        true = 2 * n + 1 - mp.cos(100 - n * mp.pi)
        assert abs(motion["omega"][0][1] - true) <= true * mpf(10) ** -30


def test_a_kink_that_is_only_touched_is_not_followed() -> None:
    """1 + sin t touches zero at 3 pi/2: the rows before it are proven, and the time is said."""
    scene = about_axes('["cos(t)", "abs(1 + w1)", 0]')
    with pytest.raises(Unsettled) as refusal:
        solution(scene).motion([Fraction(4), Fraction(5)], 20)
    assert refusal.value.motion is not None
    assert len(refusal.value.motion["omega"]) == 1


def test_switches_are_exact() -> None:
    """A moment of 1 from t = 1/3 to 2/3 gives w = 1/3; at a switch the later piece begins."""
    scene = about_axes('["1 if t >= 1/3 else 0", "step(t - 1/3) - step(t - 2/3)", 0]')
    motion = solution(scene).motion([Fraction(1, 3), Fraction(1)], 30)
    with mp.workdps(40):
        assert abs(motion["omega"][0][0]) <= motion.radius[0]
        assert abs(motion["omega"][1][0] - mpf(2) / 3) <= mpf(10) ** -30
        assert abs(motion["omega"][1][1] - mpf(1) / 3) <= mpf(10) ** -30


def test_a_root_that_ends_the_motion_is_named() -> None:
    """w' = -sqrt(w) from 1/4 comes to rest at t = 1, where the root has no derivative."""
    scene = about_axes('["-sqrt(w1)", 0, 0]', '["1/4", 0, 0]', "2")
    with pytest.raises(Unsettled) as refusal:
        solution(scene).motion([Fraction(1, 2), Fraction(2)], 20)
    assert refusal.value.motion is not None
    with mp.workdps(30):
        assert abs(refusal.value.motion["omega"][0][0] - mpf(1) / 16) <= mpf(10) ** -20


def test_written_loads_have_no_closed_form() -> None:
    """Whatever the body would do without them."""
    with pytest.raises(NoClosedForm, match="loads that a scene writes down"):
        solution(about_axes('["cos(t)", 0, 0]'), "arb")
