"""Heavy tops and pendulums: closed forms by two routes, each inside the enclosure of the equations."""

from __future__ import annotations

from fractions import Fraction

import pytest
from builders.numbers import motions_of_taylor
from builders.scenes import read_scene, vector
from builders.turns import by_turns

from taylor_verify.chain import posed
from taylor_verify.exact.elements import elements
from taylor_verify.exact.printed import document
from taylor_verify.exact.route import solution
from taylor_verify.exact.solution import NoClosedForm
from taylor_verify.models.problem import Problem
from taylor_verify.numbers.precision import exact_value, rung
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.taylor.driver import Taylor

DIGITS = 25
TIMES = vector("1/3", 2, "-3/2")


def heavy(
    inertia: str, at: str, omega: str, attitude: str = "[1, 0.3, -0.2, 0.1]", **more: str
) -> Scene:
    """A body on a fixed point under a weight of two units."""
    weight = more.get("weight", f"weight = {{ force = [0, 0, -2], at = {at} }}")
    return read_scene(
        f"inertia = {inertia}\n{weight}\n{more.get('body', '')}",
        f"omega = {omega}\nattitude = {attitude}",
        time="end = 2\nsamples = 2",
        top='track = ["attitude"]',
    )


# Lagrange's top and a pendulum: moments of inertia, and the point at which the weight hangs.
ERECT = ("[2, 2, 1]", "[0, 0, 0.5]")
PENDULUM = ("[3, 2, 1]", "[0, 0, -0.5]")
BELOW = ("[2, 2, 1]", "[0, 0, -0.5]")
OBLIQUE = ("[[5, 1, -1], [1, 5, -1], [-1, -1, 5]]", "[0.2, 0.2, -0.2]")
UPRIGHT, TILTED = "[1, 0, 0, 0]", "[1, 0.3, 0, 0]"
NUTATING = {
    "axis 3": heavy(*ERECT, "[0.4, -0.3, 3]"),
    "axis 1, oblate": heavy("[3, 2, 2]", "[0.4, 0, 0]", "[-2, 0.5, 0.1]"),
    "below the point": heavy(*BELOW, "[0.4, -0.3, 1]"),
    "an oblique axis": heavy(*OBLIQUE, "[0.5, 1, -0.6]"),
    "no spin": heavy(*ERECT, "[0.4, -0.3, 0]"),
    "a sphere": heavy("[2, 2, 2]", "[0.1, -0.3, 0.2]", "[0.4, -0.3, 1]"),
    "buoyancy too": heavy(
        "[2, 2, 1]",
        "",
        "[0.4, -0.3, 2]",
        weight="weight = { force = [1, 2, -2], at = [0, 0, 0.5] }\n"
        "buoyancy = { force = [-0.5, -1, 1], at = [0, 0, 0.2] }",
    ),
    "a wheel": heavy(*ERECT, "[0.4, -0.3, 1]", body="rotor = [0, 0, 2]"),
    "a wheel on an oblique axis": heavy(*OBLIQUE, "[0.5, 1, -0.6]", body="rotor = [-1, -1, 1]"),
    "from rest": heavy(*ERECT, "[0, 0, 0]"),
    "through the vertical": heavy(*ERECT, "[0.4, -0.3, 2]", UPRIGHT),
    "a pendulum that swings": heavy(*PENDULUM, "[0.4, 0, 0]", TILTED),
    "a pendulum that goes round": heavy(*PENDULUM, "[3, 0, 0]", TILTED),
    "a pendulum from rest": heavy("[3, 2, 1]", "[0, 0.1, -0.5]", "[0, 0, 0]", TILTED),
}
# Motions with closed forms in balls alone, the word of each beside it.
OTHERS = {
    # With the axis level g turns at the rate W of H: I3 w3 W = m g l.
    "a steady precession": ("steady-top", heavy(*ERECT, "[0, 0.5, 2]", "[1, 1, 0, 0]")),
    "hanging": ("sleeping-top", heavy(*BELOW, "[0, 0, 1]", UPRIGHT)),
    "sleeping": ("sleeping-top", heavy(*ERECT, "[0, 0, 3]", UPRIGHT)),
    # T and y3 of the vertical spin, from a tilt of cosine 3/5.
    "falling": ("falling-top", heavy(*ERECT, "[0.6, 0.2, 2.4]", "[2, 0, -1, 0]")),
    "about to fall": ("unstable-top", heavy(*ERECT, "[0, 0, 2]", UPRIGHT)),
}
TOPS = {name: ("nutating-top", scene) for name, scene in NUTATING.items()} | OTHERS
# The axes of a sphere are found in another way.
by_top = pytest.mark.parametrize(
    "name", by_turns(TOPS, 3, lambda name: (TOPS[name][0], name == "a sphere"))
)


@by_top
def test_closed_routes_are_the_enclosed_motion(name: str) -> None:
    """Weierstrass's functions in balls, and Jacobi's where it nutates, are the Taylor series of the
    equations as written, before the start too; and each motion has the word of its kind."""
    word, scene = TOPS[name]
    assert solution(scene).regime == word
    assert len(motions_of_taylor(scene, word, TIMES, DIGITS)) == (1 if name in OTHERS else 2)
    if name in OTHERS:
        with pytest.raises(NoClosedForm, match="its routes are arb and taylor"):
            solution(scene, "mpmath")


@pytest.mark.parametrize("spin", [Fraction(k, 4) for k in (8, 10, 11, 12, 13, 16)])
def test_a_top_sleeps_where_the_textbook_says(spin: Fraction) -> None:
    """The spin on the vertical is stable exactly for (I3 w3)^2 >= 4 I1 m g l, here w3^2 >= 8."""
    scene = heavy(*ERECT, f'[0, 0, "{spin}"]', UPRIGHT)
    assert solution(scene).regime == ("sleeping-top" if spin**2 >= 8 else "unstable-top")


NO_TOPS = {
    "no body of revolution": heavy("[3, 2, 1]", "[0, 0, 0.5]", "[0.4, -0.3, 1]"),
    "its weight beside the axis": heavy("[2, 2, 1]", "[0.1, 0, 0.5]", "[0.4, -0.3, 1]"),
    "a wheel beside the axis": heavy(*ERECT, "[0.4, -0.3, 1]", body="rotor = [0.1, 0, 0]"),
    "a text beside the weight": heavy(
        *ERECT, "[0.4, -0.3, 1]", body='moment = ["0.1*sin(t)", 0, 0]'
    ),
    "a constant moment too": heavy(*ERECT, "[0.4, -0.3, 1]", body="moment = [0, 0, 0.1]"),
    "a pendulum on its way to the top": heavy("[4, 3, 2]", "[0, 0, -0.5]", "[1, 0, 0]", UPRIGHT),
    "damping too": heavy(*ERECT, "[0.4, -0.3, 1]", body="damping = 0.1"),
    "two directions": heavy(
        "[2, 2, 1]",
        "",
        "[0.4, -0.3, 1]",
        weight="weight = { force = [0, 0, -2], at = [0, 0, 0.5] }\n"
        "buoyancy = { force = [1, 0, 0], at = [0, 0, 0.2] }",
    ),
}


@pytest.mark.parametrize("name", NO_TOPS)
def test_what_is_no_top_is_enclosed(name: str) -> None:
    """Each of these lacks one condition of a closed form, and its truth is the enclosure."""
    exact = solution(NO_TOPS[name])
    assert (exact.regime, exact.route) == ("no closed form", "taylor")


def test_a_rounded_top_is_enclosed() -> None:
    """On a rung the numbers of the load are rounded one by one, as its steps have them: no closed form
    of the weight may stand for them."""
    given = posed(load("loads/lagrange-top"), Taylor(), rung("f32"))
    assert isinstance(given, Problem)
    assert solution(given.given).regime == "no closed form"


@pytest.mark.parametrize("name", ["axis 3", "below the point", "a wheel", "a pendulum that swings"])
def test_the_height_of_the_axis_recurs_after_a_period(name: str) -> None:
    """r33 at a time and one period later, by the enclosure, agree to the digits of the period."""
    _, scene = TOPS[name]
    later = Fraction(1, 3) + exact_value(elements(scene, 20)["period"].value)
    times = [("", Fraction(1, 3)), ("", later)]
    now, then = document(scene, solution(scene, "taylor"), times, 15)["rows"]
    heights = [Fraction(row["attitude"][2][2]) for row in (now, then)]
    assert abs(heights[0] - heights[1]) <= Fraction(1, 10**13)


@pytest.mark.parametrize("name", ["axis 3", "a wheel", "sleeping"])
def test_the_stability_number_is_that_of_the_textbook(name: str) -> None:
    """A is 4 I1 m g l less the square of the momentum along the axis, here 8 - 9, wheels included."""
    assert elements(TOPS[name][1])["A"].value == 8 - 9
