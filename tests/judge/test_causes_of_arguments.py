"""Likely causes of loads that read something else than the scene's, or at other times, and near misses."""

from __future__ import annotations

from fractions import Fraction
from functools import cache

import numpy as np
import pytest
from builders.integrators import step
from builders.scenes import text_of
from builders.turns import by_turns
from builders.wrong_dynamics import explained_change, explained_motion, named_motion

from taylor_verify.judge.causes.float_answer import Motion
from taylor_verify.judge.causes.many_flows import Floats
from taylor_verify.scenes.reading.reader import read
from taylor_verify.scenes.scene import Scene

SATELLITE = """
title = "Gravity gradient and a controller"
model = "euler"
[body]
inertia = [[1.2, 0.1, 0.05], [0.1, 0.9, -0.07], [0.05, -0.07, 1.6]]
moment = [
  "3*n^2*(o2*(I31*o1 + I32*o2 + I33*o3) - o3*(I21*o1 + I22*o2 + I23*o3)) - 0.2*q1 - 0.05*w1",
  "3*n^2*(o3*(I11*o1 + I12*o2 + I13*o3) - o1*(I31*o1 + I32*o2 + I33*o3)) - 0.2*q2 - 0.05*w2",
  "3*n^2*(o1*(I21*o1 + I22*o2 + I23*o3) - o2*(I11*o1 + I12*o2 + I13*o3)) - 0.2*q3 - 0.05*w3",
]
[define]
n = "0.5"
[space]
o = ["cos(0.3*t)", "sin(0.3*t)", 0]
[initial]
omega = [0.3, -0.5, 0.4]
attitude = [0.8, 0.4, 0.2, 0.4]
[time]
end = 6
samples = 31
"""
VEHICLE = """
title = "Vehicle in a current"
model = "kirchhoff"
[body]
mass = 2
inertia = [0.3, 0.7, 0.8]
added_mass = [0.3, 1.5, 1.4, 0.05, 0.2, 0.2]
force = ["0.4 - 0.3*abs(u1)*u1 - 0.1*u1", "-0.5*abs(u2)*u2 - 0.1*u2", "-0.6*abs(u3)*u3 - 0.1*u3"]
couple = ["-0.1*w1", "-0.1*w2", "-0.2*w3"]
weight = { force = [0, 0, 20], at = [0, 0, 0.05] }
buoyancy = { force = [0, 0, -20], at = [0.02, 0, 0] }
current = [0.2, 0.1, 0]
[initial]
linear_velocity = [0.9, -0.2, 0.1]
angular_velocity = [0.1, 0.2, -0.3]
[time]
end = 4
samples = 31
"""
# Of a neutral vehicle the couple turns its sign if the points are exchanged.
SINKING = VEHICLE.replace("[0, 0, -20]", "[0, 0, -19]")
WHOLE = VEHICLE.replace("abs(u1)", "s").replace("abs(u2)", "s").replace("abs(u3)", "s")
WHOLE = (
    WHOLE.replace("0.3*s", "a*s")
    .replace("0.1*u", "b*u")
    .replace("[initial]", '[define]\ns = "norm(u1, u2, u3)"\na = "0.3"\nb = "0.1"\n[initial]')
)
TOP = text_of(
    {"inertia": [2, 2.5, 1.5], "weight": {"force": [0, 0, -3], "at": [0.2, 0.1, 0.5]}},
    {"omega": [0.5, 0.4, 2], "attitude": [0.8, 0.4, 0.2, 0.4]},
    *(4, 31, "omega", "attitude"),
)
BY_TIME = ["0.3*sin(0.7*t)", "-0.15*w2", "0.12"]
TIMED = text_of(
    {"inertia": [2.6, 3.4, 1.9], "moment": BY_TIME}, {"omega": [0.4, -0.3, 0.5]}, 15, 61
)
CONSTANT = TIMED.replace('"0.3*sin(0.7*t)", "-0.15*w2", "0.12"', '"0.3", "-0.1", "0.2"')


@cache
def scene(text: str) -> Scene:
    return read(text, "loads")


def swapped(text: str, *pairs: tuple[str, str]) -> str:
    """The text with names exchanged, all at once."""
    for k, (old, _) in enumerate(pairs):
        text = text.replace(old, f"<{k}>")
    for k, (_, new) in enumerate(pairs):
        text = text.replace(f"<{k}>", new)
    return text


LAST = [("*q1", "*q0"), ("*q2", "*q1"), ("*q3", "*q2")]
FIRST = [("*q1", "*q2"), ("*q2", "*q3"), ("*q3", "*q0")]
PRODUCTS = [(f"I{i}{k}*", "0*") for i in (1, 2, 3) for k in (1, 2, 3) if i != k]
GROUND = [(f"u{i}", f"(u{i} + 0.2*r1{i} + 0.1*r2{i})") for i in (1, 2, 3)]
DOUBLED = [(f"{x}*abs", f"{2 * x}*abs") for x in (0.3, 0.5, 0.6)]
HALVED = [("-0.1*w1", "-0.05*w1"), ("-0.1*w2", "-0.05*w2"), ("-0.2*w3", "-0.1*w3")]
LIMITED = TIMED.replace("0.3*sin(0.7*t)", "clip(0.25*sin(0.7*t), -0.3, 0.3)")
THRUST = [
    ("0.4 -", "0.4*r11 -"),
    ('"-0.5*abs', '"0.4*r12 - 0.5*abs'),
    ('"-0.6*abs', '"0.4*r13 - 0.6*abs'),
]
WEIGHT = "weight = { force = [0, 0, 20], at = [0, 0, 0.05] }"
BUOYANCY = "buoyancy = { force = [0, 0, -20], at = [0.02, 0, 0] }"
HEAVY = "weight = { force = [0, 0, -3], at = [0.2, 0.1, 0.5] }"
ADDED = [("0.3, 1.5, 1.4, 0.05, 0.2, 0.2", "0.33, 1.65, 1.54, 0.055, 0.22, 0.22")]
SPEED = "sqrt(u1*u1 + u2*u2 + u3*u3)"
SPEEDS = [(f"abs(u{i})", SPEED) for i in (1, 2, 3)]
EXCHANGED = [("at = [0, 0, 0.05]", "at = [0.02, 0, 0]"), ("at = [0.02, 0, 0]", "at = [0, 0, 0.05]")]
FIXED = [(WEIGHT, ""), ('"-0.6*abs', '"20 - 0.6*abs')]
F = ["0.4 - 0.3*abs(u1)*u1 - 0.1*u1", "-0.5*abs(u2)*u2 - 0.1*u2", "-0.6*abs(u3)*u3 - 0.1*u3"]
C = ["-0.1*w1", "-0.1*w2", "-0.2*w3"]


def in_space(texts: list[str], axis: int) -> str:
    """Component of R^T of three texts."""
    return " + ".join(f"r{k + 1}{axis + 1}*({text})" for k, text in enumerate(texts))


def of_state(every: str) -> list[tuple[str, str]]:
    """The loads of the vehicle in states that are held."""
    couple = [f"{C[0]} - r32", f"{C[1]} + r31 + 0.4*r33", f"{C[2]} - 0.4*r32"]
    names = ((F, "f", F), (C, "g", couple))
    states = [
        f'{n} = {{ every = "{every}", value = {own!r} }}'.replace("'", '"') for _, n, own in names
    ]
    own = [(f'"{old}"', f'"{n}{i + 1}"') for texts, n, _ in names for i, old in enumerate(texts)]
    return [
        *own,
        (WEIGHT, ""),
        (BUOYANCY, ""),
        ("[initial]", "\n".join(["[states]", *states, "[initial]"])),
    ]


IN_SPACE = [(f'"{text}"', f'"{in_space(own, k)}"') for own in (F, C) for k, text in enumerate(own)]
W = ["0.4 - a*s*u1 - b*u1", "-0.5*s*u2 - b*u2", "-0.6*s*u3 - b*u3"]
M = ["0.3", "-0.1", "0.2"]


def by_R(texts: list[str]) -> list[tuple[str, str]]:
    """Three texts, each with the component of R of them."""
    sums = [" + ".join(f"r{i}{k + 1}*({t})" for k, t in enumerate(texts)) for i in (1, 2, 3)]
    return [(f'"{text}"', f'"{own}"') for text, own in zip(texts, sums, strict=True)]


LATE = of_state("2/15")
PLAIN = [("o1", "(cos(0.3*t))"), ("o2", "(sin(0.3*t))"), ("o3", "0")]


def asked(text: str, pairs: list[tuple[str, str]]) -> list[str]:
    """The causes of a motion whose body has other texts."""
    body = text[text.index("[body]") : text.index("omega =" if "omega =" in text else "linear_vel")]
    return named_motion(text.replace(body, swapped(body, *pairs)), text)


@pytest.mark.parametrize(
    ("text", "pairs", "name"),
    by_turns(
        [
            (
                SATELLITE,
                LAST,
                "the loads read the quaternion with the scalar last, which comes first",
            ),
            (
                SATELLITE,
                FIRST,
                "the loads read the quaternion with the scalar first, which comes last",
            ),
            (SATELLITE, PRODUCTS, "the loads have no products of inertia"),
            (SATELLITE, PLAIN, "o of [space] is not turned into body axes"),
            (
                SATELLITE,
                [(f"*w{i}", f"*180/pi*w{i}") for i in (1, 2, 3)],
                "the loads take omega in degrees",
            ),
            (
                VEHICLE,
                GROUND,
                "the loads take the velocity over ground, not that through the water",
            ),
            (VEHICLE, DOUBLED, "factor of all quadratic drag"),
            (VEHICLE, [("at = [0.02, 0, 0]", "at = [0, 0, 0]")], "buoyancy at the origin"),
            (VEHICLE, THRUST, "terms of force without velocities in space axes"),
            (VEHICLE, IN_SPACE, "force and couple, but for weight and buoyancy, in space axes"),
            (VEHICLE, FIXED, "weight fixed in body axes"),
            (TOP, [(HEAVY, "moment = [-0.3, 0.6, 0]")], "weight fixed in body axes"),
            (TOP, [("-3]", "3]")], "moment with the other sign"),
            (VEHICLE, [("abs", "")], "the loads have no abs"),
            (VEHICLE, HALVED, "factor of all linear drag in the couple"),
            (WHOLE, [("norm", "-norm")], "s with the other sign"),
            (LIMITED, [("-0.3, 0.3", "-0.22, 0.22")], "the number 0.3 in all texts"),
            (
                VEHICLE,
                [(f"abs(u{i})", "1") for i in (1, 2, 3)],
                "the loads have linear drag, 1 for abs(u1), abs(w1) or the whole speed",
            ),
            (WHOLE, by_R(W), "force turned the wrong way, by R"),
            (CONSTANT, by_R(M), "moment turned the wrong way, by R"),
            (
                VEHICLE,
                SPEEDS,
                "the loads have the whole speed, |U| or |W|, where the scene has abs(u1) or abs(w1)",
            ),
            (
                VEHICLE.replace("-0.2*w3", "-0.2*abs(w3)*w3"),
                SPEEDS,
                "the loads have the whole speed, |U| or |W|, where the scene has abs(u1) or abs(w1), "
                "in the force alone",
            ),
            (
                WHOLE,
                [(f"s*u{i}", f"abs(u{i})*u{i}") for i in (1, 2, 3)],
                "the loads have abs(u1) or abs(w1), where the scene has the whole speed",
            ),
            (WHOLE, [('"0.3"', '"0.1"'), ('"0.1"', '"0.3"')], "a and b exchanged"),
            (SINKING, EXCHANGED, "points of weight and buoyancy exchanged"),
            (VEHICLE, ADDED, "factor of the added mass"),
            (VEHICLE, LATE, "loads taken every 0.133333 and held in between"),
        ],
        12,
        lambda text, pairs, name: text,
    ),
)
def test_loads_that_read_something_else_are_named(
    text: str, pairs: list[tuple[str, str]], name: str
) -> None:
    """A load that reads another argument in all of its texts has the name of that."""
    assert asked(text, pairs) == [name]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("text", "pairs"),
    [
        (SATELLITE, LAST[:2]),
        (SATELLITE, PRODUCTS[:2]),
        (VEHICLE, [GROUND[0], DOUBLED[1]]),
        (VEHICLE, [*THRUST[:2], DOUBLED[1]]),
        (VEHICLE, [*IN_SPACE[:1], *IN_SPACE[4:]]),
        (VEHICLE, [*FIXED, DOUBLED[0]]),
        (VEHICLE, of_state("1/7")),
        (VEHICLE, [("-0.5*abs(u2)", "-0.5*(u2)"), DOUBLED[0]]),
        (VEHICLE, [*SPEEDS[:1], DOUBLED[1]]),
        (VEHICLE, [*EXCHANGED, DOUBLED[1]]),
        (VEHICLE, [("1.5, 1.4, 0.05", "1.65, 1.54, 0.05"), DOUBLED[1]]),
    ],
)
def test_loads_that_do_so_here_and_there_have_no_name(
    text: str, pairs: list[tuple[str, str]]
) -> None:
    """An argument that is another one in some places of a text is no exchange of names."""
    assert asked(text, pairs) == []


def test_a_clock_takes_the_time_of_the_loads_with_it() -> None:
    """The clock of a motion that runs by one of its own is named, and no load of another pace."""
    assert named_motion(TIMED, TIMED, Fraction(101, 100)) == ["clock"]


def test_the_point_of_a_weight_is_named_by_its_key() -> None:
    """Weight and buoyancy of one size are one couple: both points explain it, before any couple."""
    (name,) = asked(VEHICLE, [("at = [0.02, 0, 0]", "at = [0.03, 0.01, 0]")])
    assert name in ("buoyancy.at", "weight.at")


LINEAR_OF_FORCE = [(f" - 0.1*u{i}", "") for i in (1, 2, 3)]
LINEAR_OF_COUPLE = [("-0.1*w1", "0"), ("-0.1*w2", "0"), ("-0.2*w3", "0")]
OPPOSITE = [("at = [0, 0, 0.05]", "at = [0, 0, -0.05]"), ("[0.02, 0, 0]", "[-0.02, 0, 0]")]


@pytest.mark.parametrize(
    ("pairs", "name"),
    by_turns(
        [
            (LINEAR_OF_FORCE + LINEAR_OF_COUPLE, "factor of all linear drag"),
            ([("0, 20]", "0, 19.6]"), ("-20]", "-19.6]")], "factor of weight and buoyancy"),
            (OPPOSITE, "couple of weight and buoyancy with the other sign"),
        ],
        2,
    ),
)
def test_what_several_texts_have_in_common_is_named(
    pairs: list[tuple[str, str]], name: str
) -> None:
    """Drag of one order left out, another gravity, or the other sign of a restoring couple is one fault."""
    assert asked(VEHICLE, pairs) == [name]


@pytest.mark.parametrize(
    ("pairs", "name"),
    by_turns(
        [
            ([("0, 20]", "0, 19.6]")], "factor of weight and buoyancy"),
            (LINEAR_OF_FORCE + LINEAR_OF_COUPLE[:1], "factor of all linear drag"),
            (OPPOSITE[:1], "couple of weight and buoyancy with the other sign"),
        ],
        3,
    ),
)
def test_a_part_of_these_texts_has_another_name(pairs: list[tuple[str, str]], name: str) -> None:
    """Weight alone, some of the drag or one of the points is no fault of all of them."""
    assert name not in asked(VEHICLE, pairs)


# Loads that begin or end at another time.

PULSE = """
title = "A thruster"
model = "euler"
[body]
inertia = [3.1, 2.2, 1.4]
moment = [
  "0.25*(step(t-1)-step(t-3))", "-0.1*(step(t-1)-step(t-3))", "0.15*(step(t-1)-step(t-3))"
]
[initial]
omega = [0.2, 0.3, -0.4]
[time]
end = 6
samples = 61
"""


def sentences(changed: str) -> list[str]:
    return [cause.sentence for cause in explained_change(changed, PULSE).causes]


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("t-3", "t-2.25", "switch at t = 3 comes at t = 2.25"),
        ("t-3", "t-3.73", "switch at t = 3 comes at t = 3.73"),
        ("t-1", "t-0.5", "switch at t = 1 comes at t = 0.5"),
        ("step(t-", "step(t-0.3-", "loads late = 0.3"),
        ("step(t-", "step(t+0.3-", "loads early = 0.3"),
    ],
)
def test_a_load_that_begins_or_ends_at_another_time_is_named(
    old: str, new: str, words: str
) -> None:
    """A switch at another time has its name, however far it is; so have all that are late together."""
    (sentence,) = sentences(PULSE.replace(old, new))
    assert sentence.startswith(words)


def test_what_no_text_may_have_is_not_tried_beside_a_switch() -> None:
    """Other values of a power or a limit make no text: w^80, say. The switch has its word."""
    text = PULSE.replace('"-0.1*', '"clip(w2^40, -0.1, 0.1)/9-0.1*')
    assert named_motion(text.replace("t-3", "t-2.25"), text) == ["switch at t = 3"]


@pytest.mark.parametrize(
    "changes",
    by_turns(
        [
            [("t-3", "t-2.25"), ("0.15*", "0.2*")],
            [("t-1", "t-1.4"), ("t-3", "t-3.3")],
            [("-0.1*(step(t-1)-step(t-3))", "-0.1*(step(t-1)-step(t-2))"), ("0.25", "0.3")],
        ]
    ),
)
def test_two_times_or_a_time_and_a_gain_have_no_one_time(changes: list[tuple[str, str]]) -> None:
    """A pulse with two other numbers is not one whose switch comes at another time."""
    text = PULSE
    for old, new in changes:
        text = text.replace(old, new)
    assert not any("comes at" in each or "late" in each for each in sentences(text))


def pulsed(t: float, w: Floats) -> Floats:
    inertia = np.array([3.1, 2.2, 1.4])
    moment = np.array([0.25, -0.1, 0.15]) if 1 - 1e-9 <= t < 3 - 1e-9 else np.zeros(3)
    rate: Floats = (np.cross(inertia * w, w) + moment) / inertia
    return rate


def test_the_stages_of_a_method_at_a_switch_are_no_loads_of_another_time() -> None:
    """RK4 with a switch at the end of a step is off by a sixth of the step's load: nothing is early."""
    rows, h = [np.array([0.2, 0.3, -0.4])], 0.1 / 3
    for k in range(180):
        rows.append(step(pulsed, k * h, rows[-1], h))
    file = Motion(np.round(np.array(rows[::3]), 12))
    causes = explained_motion(scene(PULSE), file, 0.5e-12).causes
    assert not any("late" in cause.sentence for cause in causes)
