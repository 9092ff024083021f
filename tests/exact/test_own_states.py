"""States of a scene's own in the truth: closed forms, arcs, boxes of starts, and a broken twin."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from functools import cache
from itertools import product
from typing import Any

import pytest
from builders.scenes import read_scene
from flint import arb, ctx
from mpmath import mp, mpf

from taylor_verify.exact.enclosure.course import Course
from taylor_verify.exact.enclosure.image import Functions, Image
from taylor_verify.exact.enclosure.loaded import posed
from taylor_verify.exact.enclosure.walk import Row
from taylor_verify.exact.printed import document
from taylor_verify.exact.route import solution
from taylor_verify.exact.row_arithmetic import quaternions
from taylor_verify.exact.solution import Unsettled
from taylor_verify.exact.taylor import arcs
from taylor_verify.numbers.irrational import ball
from taylor_verify.numbers.precision import exact_value
from taylor_verify.scenes.motion import Motion
from taylor_verify.scenes.scene import Scene

DIGITS = 20
SATELLITES = {
    "wheel of a text": (
        'rotor = ["tanh(2*h)", "sin(t)/5", 0.1]\nmoment = [0.03, 0, "-w3/9"]',
        'h = { start = "1/3", rate = "q1 - h/3 + w1*w2" }',
    ),
    "sampled": (
        'rotor = [0.05, 0, 0.1]\nmoment = ["a1", "a2", "m1/3"]',
        'm = { every = "1/5", value = ["-0.8*q1 - w1/2", "clip(-0.8*q2 - w2/2, -0.15, 0.15)"] }\n'
        'a = { every = "1/5", offset = "1/10", start = [0, 0], value = ["m1", "m2"] }',
    ),
}


def named(states: str) -> str:
    """The names of states, one a line, as an array has them."""
    return ", ".join(f'"{line.split(" ")[0]}"' for line in states.splitlines())


def about_axes(states: str, body: str, omega: str = "[0, 0, 0]", end: str = "4") -> Scene:
    """A ball with omega for its momentum, whose states are all tracked."""
    return read_scene(
        f"inertia = [1, 1, 1]\n{body}",
        f"omega = {omega}",
        f"[states]\n{states}",
        time=f"end = {end}\nsamples = 2",
        top=f"track = [{named(states)}]",
    )


def satellite(name: str) -> Scene:
    body, states = SATELLITES[name]
    start = "omega = [0.3, -0.5, 0.4]\nattitude = [0.5, 0.6, -0.4, 0.45]"
    top = f'track = ["attitude", {named(states)}]'
    return read_scene(f"inertia = [1.2, 0.9, 1.6]\n{body}", start, f"[states]\n{states}", top=top)


def motion(scene: Scene, *times: str, digits: int = DIGITS) -> Motion:
    return solution(scene).motion([Fraction(time) for time in times], digits)


def assert_near(motion: Motion, name: str, row: int, wanted: list[Any]) -> None:
    """Each component is within the radius, which is as small as was asked."""
    with mp.workdps(2 * DIGITS):
        wanted = [
            mpf(c.numerator) / c.denominator if isinstance(c, Fraction) else c for c in wanted
        ]
        size = mp.norm(wanted) or mpf(1)
        size = motion.peaks[name][row] or mpf(1) if name in motion.peaks else size
        apart = mp.norm([a - b for a, b in zip(motion[name][row], wanted, strict=True)])
        assert apart <= size * motion.radius_of(name)[row] <= size * mpf(10) ** -DIGITS


# Closed forms.


def test_a_wheel_takes_the_momentum_of_its_motor() -> None:
    """Along an axis I w + h is constant: h' = 1/3 - h gives w = w0 + h0 - h."""
    scene = about_axes('h = { start = 0, rate = "1/3 - h" }', 'rotor = ["h", 0, 0]', "[1, 0, 0]")
    with mp.workdps(2 * DIGITS):
        h = (1 - mp.exp(-4)) / 3
        got = motion(scene, "4")
        assert_near(got, "h", 0, [h])
        assert_near(got, "omega", 0, [1 - h, 0, 0])


def test_a_rotor_may_depend_on_the_time_with_kinks() -> None:
    """h = |t - 1|/3 along an axis: w = w0 + 1/3 - h, on both sides of the kink and of the start."""
    scene = about_axes("f = { start = 0, rate = 0 }", 'rotor = [0, "abs(t - 1)/3", 0]')
    got = motion(scene, "-2", "1/2", "3")
    for row, h in enumerate((1, Fraction(1, 6), Fraction(2, 3))):
        assert_near(got, "omega", row, [0, Fraction(1, 3) - h, 0])


def test_damping_slows_the_body_and_not_its_wheels() -> None:
    """w' = -1/3 - w/2 under h = t/3 and a damping of 1/2; a controller that reads q is not tracked."""
    body = 'rotor = ["t/3", 0, 0]\ndamping = 0.5\nmoment = [0, 0, "0*q1"]'
    scene = about_axes('f = { start = 0, rate = "q1" }', body)
    with mp.workdps(2 * DIGITS):
        assert_near(motion(scene, "2"), "omega", 0, [2 * (mp.exp(-1) - 1) / 3, 0, 0])


def test_a_lag_is_an_exponential() -> None:
    """f' = 1 - f drives w' = f, also backwards in time."""
    scene = about_axes('f = { start = 0, rate = "1 - f" }', 'moment = ["f", 0, 0]')
    with mp.workdps(2 * DIGITS):
        for row, t in enumerate((mpf(3), mpf(-1))):
            got = motion(scene, "3", "-1")
            assert_near(got, "f", row, [1 - mp.exp(-t)])
            assert_near(got, "omega", row, [t - 1 + mp.exp(-t), 0, 0])


def test_a_state_may_begin_to_move_with_any_order() -> None:
    """i with the third derivative t, from rest, is t^4/24: its first orders are all zero."""
    states = 'i = { start = 0, rate = "k" }\nk = { start = 0, rate = "w1" }'
    got = motion(about_axes(states, 'moment = ["t", 0, 0]'), "2")
    assert_near(got, "i", 0, [Fraction(2, 3)])


def test_a_sampled_controller_is_a_recursion() -> None:
    """m = -w every half second halves w each time; a row on an instant is read after it."""
    scene = about_axes('m = { every = "1/2", value = "-w1" }', 'moment = ["m", 0, 0]', "[1, 0, 0]")
    got = motion(scene, "0", "1/4", "1/2", "1", "4")
    for row, (w, m) in enumerate(((1, -1), (0.75, -1), (0.5, -0.5), (0.25, -0.25))):
        assert_near(got, "omega", row, [w, 0, 0])
        assert_near(got, "m", row, [m])
    assert_near(got, "m", 4, [mpf(-1) / 2**8])


def test_values_of_one_instant_read_what_was_before_it() -> None:
    """Two values that read each other change places; one that is late holds the one before."""
    states = (
        'm = { every = 1, start = 1, value = "n" }\n'
        'n = { every = 1, start = 2, value = "m" }\n'
        'a = { every = 1, start = 5, value = "n" }'
    )
    got = motion(about_axes(states, 'moment = ["m", 0, 0]'), "0", "1", "3/2", "2")
    assert [row[0] for row in got["m"]] == [2, 1, 1, 2]
    assert [row[0] for row in got["n"]] == [1, 2, 2, 1]
    assert [row[0] for row in got["a"]] == [2, 1, 1, 2]


def test_a_switch_and_an_instant_on_one_time_go_with_the_later_piece() -> None:
    """The value of t = 1 is that of the times from 1 on."""
    states = 'm = { every = 1, value = "floor(t) + (3 if t < 1 else 5)" }'
    got = motion(about_axes(states, 'moment = ["m", 0, 0]'), "1/2", "1", "2")
    assert [row[0] for row in got["m"]] == [3, 6, 7]
    assert_near(got, "omega", 2, [9, 0, 0])


def test_a_value_exactly_on_its_jump_is_that_of_the_number() -> None:
    """sign(w) is 0 at rest, and step(w) is 1."""
    states = 'm = { every = 9, value = ["sign(w1)", "step(w1)", "1 if w1 > 0 else 2"] }'
    got = motion(about_axes(states, 'moment = ["m1", 0, 0]'), "1")
    assert list(got["m"][0]) == [0, 1, 2]


def test_a_value_of_the_time_alone_is_exact() -> None:
    """|t - 1| is 7/10 at t = 3/10 and 17/10, which no ball about it shows."""
    states = 'm = { every = "1/10", value = "1 if abs(t - 1) < 0.7 else 0" }'
    got = motion(about_axes(states, 'moment = ["m", 0, 0]'), "2")
    assert_near(got, "omega", 0, [Fraction(13, 10), 0, 0])


def test_a_counter_is_exact() -> None:
    """Ten tenths are one; a state without a rate stays what it is."""
    states = (
        'n = { every = "1/10", start = 0, value = "n + 0.1" }\n'
        'k = { start = "1/3", rate = 0 }\n'
        'm = { every = "1/10", value = "floor(3*norm(k, 0*n)) + (1 if sqrt(n*n) >= 1 else 0)" }'
    )
    got = motion(about_axes(states, 'moment = ["m", 0, 0]'), "9/10", "1")
    assert [row[0] for row in got["m"]] == [1, 2]


def test_a_jump_that_is_not_decided_is_given_up_with_its_time() -> None:
    """w = t/3 comes to 1/3 at t = 1, where floor(3 w) jumps: the rows before it are proven."""
    scene = about_axes('m = { every = 1, value = "floor(3*w1)" }', 'moment = ["1/3", 0, "m"]')
    with pytest.raises(Unsettled, match=r"jump near t = 1\.0") as refusal:
        motion(scene, "1/2", "2")
    assert refusal.value.motion is not None
    assert_near(refusal.value.motion, "omega", 0, [Fraction(1, 6), 0, 0])


def test_what_is_not_chosen_needs_no_value() -> None:
    """The root of a negative number is not asked for; where it is, it is named with its time and entry."""
    states = 'm = { every = 1, value = "sqrt(w1) if w1 > 0 else 7" }'
    got = motion(about_axes(states, 'moment = ["-1", 0, "m"]'), "1/2")
    assert_near(got, "omega", 0, [-0.5, 0, 3.5])
    states = 'm = { every = 1, value = "sqrt(1/2 - w1)" }'
    where = r"square root may not be positive near t = 1\.0 \(sqrt\(1/2 - w1\) in the value of m\)"
    with pytest.raises(Unsettled, match=where):
        motion(about_axes(states, 'moment = [1, 0, "m"]'), "2")


def test_held_states_are_not_followed_backwards() -> None:
    """They have no past; the rows of later times stand."""
    scene = about_axes("m = { every = 1, value = 1 }", 'moment = ["m", 0, 0]')
    with pytest.raises(Unsettled, match="run forward") as refusal:
        motion(scene, "-1", "1")
    assert refusal.value.places == (1,)


def test_a_state_at_rest_has_the_digits_of_its_largest_norm() -> None:
    """f = e^-30 t is 1e-26 at t = 2, and its radius is counted by 1, which it was."""
    scene = about_axes('f = { start = 1, rate = "-30*f" }', "", end="2")
    got = motion(scene, "2")
    assert got.peaks["f"][0] == 1
    with mp.workdps(2 * DIGITS):
        assert abs(got["f"][0][0] - mp.exp(-60)) <= got.radius_of("f")[0] <= mpf(10) ** -DIGITS
    row = document(scene, solution(scene), [("2", Fraction(2))], 10)["rows"][0]
    assert row["f"].startswith("8.756510763e-27")
    assert Fraction(row["radius"]) <= Fraction(1, 10**9)


def test_arcs_begin_with_own_states_of_their_own() -> None:
    """Arcs lead from the middle of a motion to its end, with values held as they were there."""
    for name in ("sampled", "wheel of a text"):
        scene = satellite(name)
        whole = solution(scene).motion([Fraction(3, 4), Fraction(1)], DIGITS)
        with mp.workdps(DIGITS + 10):
            exact = {
                n: tuple(map(exact_value, rows[0].flat)) for n, rows in whole.quantities.items()
            }
            q = quaternions(whole["attitude"][:1].astype(float))[0]
        del exact["attitude"]
        # The controller reads the quaternion, whose sign goes on from the start.
        sign = 1 if sum(q * [float(e) for e in scene.initial.attitude]) > 0 else -1
        turn = tuple(Fraction(sign * e) for e in q)
        start = replace(scene.initial, omega=exact.pop("omega"), attitude=turn)
        end = arcs(scene, [start], [Fraction(1, 4)], 12, [Fraction(3, 4)], [exact])
        with mp.workdps(DIGITS):
            # The attitude of the arc is right to the digits of float64.
            assert mp.norm(list((end["omega"][0] - whole["omega"][1]).flat)) <= 1e-13
    with pytest.raises(ValueError, match="own states at the start of 1 arcs"):
        arcs(scene, [start], [Fraction(1, 4)], 12, [Fraction(3, 4)])


def test_stairs_go_on_beyond_the_scene() -> None:
    """A motion to twice the end of its scene knows their later stairs: w' = floor(t)."""
    scene = about_axes("f = { start = 0, rate = 0 }", 'moment = ["floor(t)", 0, 0]', end="2")
    assert_near(motion(scene, "4"), "omega", 0, [6, 0, 0])
    assert_near(motion(scene, "-2"), "omega", 0, [3, 0, 0])


# Wide boxes, and what is left out of them.

SPREAD = Fraction(1, 10**4)
CORNERS = list(product((-1, 1), repeat=3))[::2]


def reached(name: str, signs: tuple[int, ...] | None, bits: int) -> Row:
    """The row at t = 3/2 of a box of starts about omega, or of one of its corners."""
    scene = satellite(name)
    if signs is not None:
        omega = (w + s * SPREAD for w, s in zip(scene.initial.moving, signs, strict=True))
        scene = replace(scene, initial=scene.initial.with_moving(tuple(omega)))
    system = posed(scene)
    with ctx.workprec(bits):
        start = system.start_balls()
        if signs is None:
            start[:3] = [z + arb(0, ball(2 * SPREAD)) for z in start[:3]]
        course = Course.of(system, start, bits, 10_000)
        ((_, row),) = course.rows([Fraction(3, 2)])
    return row


@cache
def corners(name: str) -> list[Row]:
    return [reached(name, signs, 160) for signs in CORNERS]


def is_contained(name: str, corners: list[Row]) -> bool:
    row = reached(name, None, 80)
    with ctx.workprec(200):
        return all(
            ours.overlaps(theirs)
            for corner in corners
            for ours, theirs in zip(row.state, corner.state, strict=True)
        )


@pytest.mark.parametrize("name", ["wheel of a text", "sampled"])
def test_motions_from_a_box_of_starts_stay_in_its_balls(name: str) -> None:
    """Through instants and with omega as an image; H is at most twice as wide as omega here."""
    assert is_contained(name, corners(name))


def test_the_dependence_of_a_value_on_the_state_is_needed(monkeypatch: pytest.MonkeyPatch) -> None:
    """Without its slopes a corner leaves the box at once."""
    ends = corners("sampled")
    outputs = Image.outputs

    def flat(self: Image) -> Functions:
        values, slopes = outputs(self)
        return Functions(values, slopes * 0)

    monkeypatch.setattr(Image, "outputs", flat)
    assert not is_contained("sampled", ends)
