"""Motions whose ends are known by hand: kinks, switches, ends, and data that are tiny at first."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from builders.scenes import one_instant, text_of, vector
from builders.written_loads import about_axes
from mpmath import mp, mpf

from taylor_verify.exact.route import solution
from taylor_verify.exact.solution import NoClosedForm, Unsettled
from taylor_verify.exact.taylor import TaylorSolution
from taylor_verify.numbers import tensors
from taylor_verify.numbers.tensors import ZERO_MATRIX, diagonal
from taylor_verify.scenes.bodies import ImmersedBody, RigidBody
from taylor_verify.scenes.motion import Impulse, Spin
from taylor_verify.scenes.reading.reader import read
from taylor_verify.scenes.scene import Scene

# A vehicle whose rates pass zero some forty times; the last time at the sixteenth step of some others.
SWINGING = text_of(
    {
        **{"mass": 0.8533, "inertia": [0.7107, 0.5854, 0.2606]},
        "centre_of_mass": [-0.0075, 0.0252, 0.0194],
        "added_mass": [0.593, 0.5368, 0.12, 0.2808, 0.1427, 0.1224],
        "force": [
            "0.27*(1 if t < 6.448 else 0) - 0.202*abs(u1)*u1",
            "-0.168*abs(u2)*u2",
            "-0.149*abs(u3)*u3",
        ],
        "couple": ["-0.249*abs(w1)*w1", "-0.248*abs(w2)*w2", "-0.252*abs(w3)*w3"],
        "weight": {"force": [0, 0, 9], "at": [0, 0, 0.059]},
        "buoyancy": {"force": [0, 0, -9]},
        "current": [0.184, 0.269, 0.235],
    },
    {
        "linear_velocity": [-0.964718, -0.989542, 0.163324],
        "angular_velocity": [0.544903, 0.351197, 0.480359],
        "attitude": [0.419035, 0.769593, 0.469791, -0.88199],
    },
    *(19.22, 32, "attitude"),
)


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


def test_a_short_step_before_a_kink_is_no_end_of_the_motion() -> None:
    """Steps before a kink are next to nothing: the motion goes on, whichever of all steps they are."""
    scene = read(SWINGING, "swinging")
    motion = solution(scene).motion(scene.clock.elapsed, 19)
    assert max(motion.radius) <= 1e-19


def test_a_kink_that_is_only_touched_is_not_followed() -> None:
    """1 + sin t touches zero at 3 pi/2: the rows before it are proven, and the time is said."""
    scene = about_axes('["cos(t)", "abs(1 + w1)", 0]')
    with pytest.raises(Unsettled) as refusal:
        solution(scene).motion([Fraction(4), Fraction(5)], 20)
    assert refusal.value.motion is not None
    assert len(refusal.value.motion["omega"]) == 1
    assert str(refusal.value).count("near t =") == 1


def test_switches_are_exact() -> None:
    """A moment of 1 from t = 1/3 to 2/3 gives w = 1/3; at a switch the later piece begins."""
    scene = about_axes('["1 if t >= 1/3 else 0", "step(t - 1/3) - step(t - 2/3)", 0]')
    motion = solution(scene).motion([Fraction(1, 3), Fraction(1)], 30)
    with mp.workdps(40):
        assert abs(motion["omega"][0][0]) <= motion.radius[0]
        assert abs(motion["omega"][1][0] - mpf(2) / 3) <= mpf(10) ** -30
        assert abs(motion["omega"][1][1] - mpf(1) / 3) <= mpf(10) ** -30


@pytest.mark.parametrize(
    ("text", "function", "time"),
    [
        # w' = -sqrt(w) from 1/4 comes to rest, where the root has no derivative.
        ("-sqrt(w1)", r"sqrt\(w1\)", "1.0"),
        ("sqrt(1/2 - t)", r"sqrt\(1/2 - t\)", "0.5"),
        ("(1 - 2*t)^(1/3)", r"\(1 - 2 \* t\)\^\(1/3\)", "0.5"),
        # (1 - w)^2 = 9/16 - 2 t.
        ("1/(1 - w1)", r"1 / \(1 - w1\)", "0.28"),
        ("asin(t/2 + 1/2)", r"asin\(1/2 \* t \+ 1/2\)", "1.0"),
        ("tan(t)", r"tan\(t\)", "1.57"),
    ],
)
def test_a_function_that_ends_the_motion_is_named(text: str, function: str, time: str) -> None:
    """The refusal has the function, the entry that it stands in, and the time; rows before it stand."""
    scene = about_axes(f'["{text}", 0, 0]', '["1/4", 0, 0]', "2")
    with pytest.raises(Unsettled, match=rf"{function}.* in body.moment\[0\].* near t = ({time})"):
        solution(scene).motion([Fraction(1, 8), Fraction(2)], 20)


def test_written_loads_have_no_closed_form() -> None:
    """Whatever the body would do without them."""
    with pytest.raises(NoClosedForm, match="loads that a scene writes down"):
        solution(about_axes('["cos(t)", 0, 0]'), "arb")


# Tiny data

TRIAXIAL = RigidBody(diagonal(vector(1, 2, 3)))
# A disturbance of the spin about the middle axis grows by exp(0.577 t).
GROWTH = 0.577


def small_start(seed: Fraction) -> tuple[Scene, Scene]:
    spinning = one_instant(TRIAXIAL, Spin((seed, Fraction(1), Fraction(0))), "attitude")
    return spinning, spinning


def small_gap(seed: Fraction) -> tuple[Scene, Scene]:
    nearly = RigidBody(diagonal((Fraction(1), Fraction(2), 2 + seed)))
    spinning = one_instant(nearly, Spin((Fraction(1, 3), Fraction(1), Fraction(1, 7))))
    return spinning, spinning


def small_coefficient(seed: Fraction) -> tuple[Scene, Scene]:
    """With A = 1 and B = 0 the couple y moves as the momentum of the rigid body with K = C."""
    turned = (
        (Fraction(1), seed, Fraction(0)),
        (seed, Fraction(1, 2), Fraction(0)),
        vector(0, 0, "1/3"),
    )
    solid = ImmersedBody(diagonal(vector(1, 1, 1)), ZERO_MATRIX, turned)
    about = vector(0, 2, 0)
    rigid = RigidBody(tensors.inverse(turned))
    return (
        one_instant(solid, Impulse(vector(0, 0, 1), about)),
        one_instant(rigid, Spin(tensors.apply(turned, about))),
    )


SEEDED = {
    "start": small_start,
    "gap": small_gap,
    "coefficient": small_coefficient,
}


@pytest.mark.parametrize(("kind", "exponent"), [("start", 20), ("gap", 300), ("coefficient", 20)])
def test_a_tiny_datum_starts_an_unstable_motion(kind: str, exponent: int) -> None:
    """A start, coefficient or gap of 10^-300 is not lost: the body tumbles when it must."""
    enclosed, known = SEEDED[kind](Fraction(1, 10**exponent))
    late = [Fraction(round(exponent * 2.302585 / GROWTH) + 3)]
    motion, truth = (
        TaylorSolution(enclosed).motion(late, 12),
        solution(known, "arb").motion(late, 20),
    )
    with mp.workdps(60):
        if kind == "coefficient":
            assert isinstance(known.body, RigidBody)
            inertia = np.array([[mp.convert(c) for c in row] for row in known.body.inertia])
            one, other = motion["angular_impulse"][0], inertia @ truth["omega"][0]
        else:
            one, other = motion["omega"][0], truth["omega"][0]
        assert mp.norm(list(one - other)) <= mpf(10) ** -12 * mp.norm(list(other))
        if kind != "gap":
            # The spin about the middle axis has visibly ended.
            assert abs(abs(one[1]) / mp.norm(list(one)) - 1) > mpf("1e-4")
