"""Weber's motion with attitude and centre: certified quadrature in balls, another in mpmath, and Taylor."""

from __future__ import annotations

import cmath
from dataclasses import replace
from fractions import Fraction
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from builders.numbers import apart
from builders.scenes import vector
from builders.webers import BODIES, built, by_turns, case, curve_of
from flint import acb, arb, ctx
from mpmath import mp, mpf

from taylor_verify.exact.balls import Undecidable, ball, midpoint
from taylor_verify.exact.kirchhoff.closed import closed_form, enclosed
from taylor_verify.exact.kirchhoff.solid import solid, velocities
from taylor_verify.exact.kirchhoff.weber import course
from taylor_verify.exact.kirchhoff.weber.course import WeberBalls
from taylor_verify.exact.kirchhoff.weber.enclosure import Quotients
from taylor_verify.exact.kirchhoff.weber.panels import Integrands, Panels, _goes_round
from taylor_verify.exact.rotation import rotation_matrix
from taylor_verify.exact.route import solution
from taylor_verify.exact.taylor import TaylorSolution
from taylor_verify.scenes import tensors
from taylor_verify.scenes.motion import Impulse
from taylor_verify.scenes.precision import exact_value
from taylor_verify.scenes.scene import Scene

DIGITS = 30
TIMES = [Fraction(0), Fraction(1, 3), Fraction(-5, 2), Fraction(2)]
WHOLE = frozenset({"attitude", "centre"})
# x all but along axis 3, on its way past it: the azimuth of that axis runs fast there.
BESIDE_A_POLE = vector("1/1000", 0, 1), vector("1/2", "1/3", "-1/2000")


def placed(scene: Scene) -> Scene:
    """The same motion with attitude and centre, from a frame that is turned and away from the origin."""
    _, start = solid(scene)
    attitude = (Fraction(1), Fraction(2), Fraction(-1), Fraction(3))
    oblique = replace(start, attitude=attitude, centre=vector("0.5", -1, 2))
    return replace(scene, track=WHOLE, initial=oblique)


def whole(start: str, body: str) -> Scene:
    return placed(case(start, body))


PAIRS = by_turns(1, 6)


@pytest.mark.parametrize(("body", "start"), PAIRS)
def test_the_balls_hold_the_taylor_motion(body: str, start: str) -> None:
    """Frame and path to 30 digits, forward and backward, within what is proven of both."""
    scene = whole(start, body)
    exact_motion = solution(scene)
    motion = exact_motion.motion(TIMES, DIGITS)
    assert (exact_motion.regime, exact_motion.route) == ("weber", "arb")
    truth = TaylorSolution(scene).motion(TIMES, DIGITS)
    with mp.workdps(DIGITS + 30):
        for k in range(len(TIMES)):
            for name in truth.quantities:
                distance = mp.norm(list((motion[name][k] - truth[name][k]).flat))
                room = motion.radii[name][k] + truth.radii[name][k]
                size = mp.norm(list(truth[name][k].flat))
                assert distance <= room * (size if size else 1) * (1 + mpf(10) ** -20)


@pytest.mark.parametrize(
    ("body", "start"),
    [
        ("theta < 0", "y = 0"),
        pytest.param("r alike", "plain", marks=pytest.mark.slow),
        pytest.param("theta > 0", "plain", marks=pytest.mark.slow),
        pytest.param("theta < 0", "x along axis 3", marks=pytest.mark.slow),
        pytest.param("r alike", "fast", marks=pytest.mark.slow),
    ],
)
def test_the_sums_in_mpmath_are_the_balls(body: str, start: str) -> None:
    """The azimuth of y in place of that of a body axis, Z by way of T, and panels of other widths."""
    scene, times, digits = whole(start, body), [Fraction(0), Fraction(-3, 2), Fraction(1)], 20
    exact = solution(scene, "mpmath")
    assert (exact.regime, exact.route) == ("weber", "mpmath")
    one, other = exact.motion(times, digits), enclosed(scene).motion(times, digits)
    with mp.workdps(digits + 30):
        assert apart(other, one) <= 2 * mpf(10) ** -digits


def test_past_a_pole_no_digit_is_lost() -> None:
    """Where the azimuth of one body axis runs fast another one is taken, and the start is Taylor's."""
    scene = placed(built(*BESIDE_A_POLE, *BODIES["theta > 0"]))
    times = [Fraction(1, 100), Fraction(3, 2)]
    truth = TaylorSolution(scene).motion(times, DIGITS)
    with mp.workdps(DIGITS + 30):
        assert apart(truth, enclosed(scene).motion(times, DIGITS)) <= 2 * mpf(10) ** -DIGITS


def test_the_frame_is_a_rotation_that_keeps_the_impulse_in_space() -> None:
    """R R^T = 1, R x = X0 and R y + centre x X0 = M0, which no step of the quadrature asks for."""
    scene = whole("plain", "theta > 0")
    _, start = solid(scene)
    motion = enclosed(scene).motion([Fraction(9, 2), Fraction(-1)], DIGITS)
    to_space = rotation_matrix(start.attitude)
    X0 = tensors.apply(to_space, start.linear)
    M0 = tensors.plus(tensors.apply(to_space, start.angular), tensors.cross(start.centre, X0))
    with mp.workdps(DIGITS + 10):
        X, M = (np.array([mp.convert(entry) for entry in v]) for v in (X0, M0))
        for k in range(2):
            R, c = motion["attitude"][k], motion["centre"][k]
            rest = [
                *(R @ R.T - np.eye(3, dtype=int)).flat,
                *(R @ motion["linear_impulse"][k] - X),
                *(R @ motion["angular_impulse"][k] + np.cross(c, X) - M),
            ]
            assert max(map(abs, rest)) <= 20 * mpf(10) ** -DIGITS


def test_the_frame_turns_at_omega_and_the_centre_moves_at_U() -> None:
    """(R(t + h) - R(t - h))/2h = R [Omega]x and the same of the centre, to the order h^2."""
    scene, t, h = whole("plain", "theta < 0"), Fraction(7, 4), Fraction(1, 10**9)
    body, _ = solid(scene)
    motion = enclosed(scene).motion([t - h, t, t + h], 40)
    x, y = (
        tuple(exact_value(entry) for entry in motion[name][1])
        for name in ("linear_impulse", "angular_impulse")
    )
    U, Omega = velocities(body, Impulse(x, y))
    with mp.workdps(45):
        R = motion["attitude"]
        u, w = (np.array([mp.convert(entry) for entry in v]) for v in (U, Omega))
        spin = np.array([[0, -w[2], w[1]], [w[2], 0, -w[0]], [-w[1], w[0], 0]])
        twice = 2 * mp.convert(h)
        turning = (R[2] - R[0]) / twice - R[1] @ spin
        moving = (motion["centre"][2] - motion["centre"][0]) / twice - R[1] @ u
        assert max(map(abs, [*turning.flat, *moving])) <= mpf(10) ** -15


def test_the_start_is_the_scenes_own() -> None:
    """Both routes have at time 0 what the scene wrote."""
    scene = whole("plain", "r alike")
    for route in (enclosed(scene), closed_form(scene)):
        motion = route.motion([Fraction(0)], DIGITS)
        with mp.workdps(DIGITS + 5):
            assert [mp.nstr(c, 10) for c in motion["centre"][0]] == ["0.5", "-1.0", "2.0"]
            exact = rotation_matrix((Fraction(1), Fraction(2), Fraction(-1), Fraction(3)))
            entries = zip(
                motion["attitude"][0].flat, (e for row in exact for e in row), strict=True
            )
            assert all(abs(a - mp.convert(b)) <= mpf(10) ** -DIGITS for a, b in entries)


def test_panels_are_kept_for_later_times() -> None:
    """What lies between the start and a time is integrated once at each precision."""
    scene = whole("plain", "r alike")
    curve, body = curve_of(scene), solid(scene)[0]
    motion_in_balls = WeberBalls(curve, body, WHOLE)
    motion_in_balls.motion([Fraction(3)], 20)
    panels = list(course._panels(curve, body, 1).until(Fraction(3)))
    (frames,) = motion_in_balls._frames.values()
    integrals = dict(frames._integrals)
    motion_in_balls.motion([Fraction(2), Fraction(3)], 20)
    assert course._panels(curve, body, 1).until(Fraction(3)) == panels
    assert set(frames._integrals) - set(integrals) <= {
        (panel.start, Fraction(2)) for panel in panels
    }


def test_a_time_that_is_a_ball_is_answered_for_all_of_it() -> None:
    """The frame at a time known to 10^-20 holds those at both ends."""
    scene = whole("plain", "theta > 0")
    body, _ = solid(scene)
    with ctx.workprec(150):
        frames = course.Frames(curve_of(scene), body, 150)
        little = ball(Fraction(1, 10**20))
        around = frames.at(arb(2, little), WHOLE)
        for end in (arb(2) - little, arb(2) + little):
            exact = frames.at(end, WHOLE)
            for name in ("attitude", "centre"):
                pairs = zip(np.ravel(around[name]), np.ravel(exact[name]), strict=True)
                assert all(wide.contains(narrow) for wide, narrow in pairs)
        # Rates of some 10, and what balls of theta functions lose beside their midpoints.
        assert max(float(entry.rad()) for entry in around["centre"]) <= 1e-17


def test_a_ball_of_time_beyond_the_ellipse_of_its_panel_is_declined() -> None:
    """The bound of phi' is that in the ellipse, which reaches 2/3 of a half-width beyond the panel."""
    scene = whole("plain", "theta > 0")
    body, _ = solid(scene)
    with ctx.workprec(150):
        frames = course.Frames(curve_of(scene), body, 150)
        panel = course._panels(curve_of(scene), body, 1).until(Fraction(1, 100))[0]
        end, half = ball(panel.end).mid(), ball(panel.half)
        frames._reached(end + arb(0, half * 0.66))
        with pytest.raises(Undecidable):
            frames._reached(end + arb(0, half * 0.67))


# The bound.


def test_the_integrands_keep_below_their_bound_in_the_ellipse() -> None:
    """At many places on the boundary and inside, for panels on both sides."""
    scene = whole("plain", "theta > 0")
    body, _ = solid(scene)
    for side in (1, -1):
        with ctx.workprec(100):
            motion = Quotients(curve_of(scene))
            integrands = Integrands.of(body, motion.F, ball)
            for panel in Panels(curve_of(scene), body, side).until(side * Fraction(3)):
                middle, half = (panel.start + panel.end) / 2, panel.half
                for k in range(12):
                    for size in (1.2, 2.0, 2.999):
                        z = size * cmath.exp(1j * (k + 0.3) * cmath.pi / 6)
                        z = (z + 1 / z) / 2
                        t = acb(ball(middle)) + acb(ball(half)) * acb(z.real, z.imag)
                        n, y = motion.impulses(motion.jets(t))
                        assert abs(integrands.azimuth(n, y, panel.axis)) < panel.azimuth
                        assert abs(integrands.rise(n, y)) < panel.rise


@pytest.mark.parametrize("bits", [12, 24])
def test_the_rule_is_wrong_by_less_than_is_said(bits: int) -> None:
    """Few nodes, as if few bits were asked for: the true integral is in the ball, which is wide."""
    scene = whole("plain", "theta > 0")
    body, _ = solid(scene)
    with ctx.workprec(160):
        rough = course.Frames(curve_of(scene), body, bits)
        fine = course.Frames(curve_of(scene), body, 150)
        panels = Panels(curve_of(scene), body, 1).until(Fraction(2))
        for panel in panels:
            for end in (panel.end, (2 * panel.start + panel.end) / 3):
                for wide, narrow in zip(
                    rough._by_gauss(panel, end), fine._by_gauss(panel, end), strict=True
                ):
                    assert narrow.rad() < arb(2) ** -130
                    assert wide.contains(narrow)
                    assert wide.rad() > arb(2) ** (-2 * bits)


def test_the_arcs_cover_the_upper_boundary(monkeypatch: pytest.MonkeyPatch) -> None:
    """The arcs that are used follow each other from one end of the ellipse to the other."""
    scene = whole("plain", "theta > 0")
    body, _ = solid(scene)
    arcs, whole_arc = list[tuple[Fraction, Fraction]](), Panels._arc

    def recorded(
        self: Panels, middle: Fraction, half: Fraction, at: Fraction, spread: Fraction
    ) -> Any:
        arcs.append((at - spread, at + spread))
        return whole_arc(self, middle, half, at, spread)

    panels = Panels(curve_of(scene), body, 1)
    monkeypatch.setattr(Panels, "_arc", recorded)
    with ctx.workprec(panels._bits):
        assert panels._bounded(Fraction(1, 2), Fraction(1, 4)) is not None
    # An arc that holds too much is followed by its halves.
    used = [
        arc for arc, later in pairwise([*arcs, (Fraction(1), Fraction(1))]) if later[0] == arc[1]
    ]
    assert (used[0][0], used[-1][1]) == (0, 1)
    assert all(before[1] == after[0] for before, after in pairwise(used))


def test_an_ellipse_with_a_pole_inside_is_declined() -> None:
    """Wide ones hold zeros of theta, and the boundary alone would not show them."""
    scene = whole("plain", "theta > 0")
    body, _ = solid(scene)
    panels = Panels(curve_of(scene), body, 1)
    with ctx.workprec(panels._bits):
        assert panels._bounded(Fraction(1, 2), Fraction(1, 4)) is not None
        for half in (2, 4):
            assert panels._bounded(Fraction(1), Fraction(half)) is None


def test_values_that_go_round_zero_are_counted() -> None:
    """z on the upper half of a circle about 0, and 1 + z/2, which keeps away from it."""
    circle = [cmath.exp(1j * cmath.pi * (k + 0.5) / 6) for k in range(6)]
    assert _goes_round([acb(z.real, z.imag) for z in circle])
    assert not _goes_round([acb(1 + z.real / 2, z.imag / 2) for z in circle])
    assert not _goes_round([acb(-2 + z.real, z.imag) for z in circle])


# Broken twins.


def midpoints(scene: Scene) -> dict[str, np.ndarray]:
    """What the balls say at one precision."""
    body, _ = solid(scene)
    with ctx.workprec(120):
        rows = WeberBalls(curve_of(scene), body, WHOLE).enclose([Fraction(2)], 120)
    centre = np.frompyfunc(midpoint, 1, 1)
    return {name: centre(np.array(row, dtype=object)) for name, row in rows.items()}


@pytest.mark.parametrize("fault", ["angle", "b", "none"])
def test_a_fault_in_the_frame_is_seen(monkeypatch: pytest.MonkeyPatch, fault: str) -> None:
    """The angle between two body axes left out, or b: the attitude is wrong, the impulses are not."""
    scene = whole("plain", "theta > 0")
    truth = TaylorSolution(scene).motion([Fraction(2)], 20)
    if fault == "angle":
        monkeypatch.setattr(course, "_angle_between", lambda *_: arb(0))
    if fault == "b":
        right = Integrands.of

        def without_b(*arguments: object) -> Integrands:
            return replace(right(*arguments), b=arb(0))

        monkeypatch.setattr(Integrands, "of", without_b)
    quantities = midpoints(scene)
    with mp.workdps(30):
        missed = {n: mp.norm(list((quantities[n] - truth[n]).flat)) for n in truth.quantities}
    assert missed["linear_impulse"] <= mpf(10) ** -18
    assert (missed["attitude"] > mpf("0.01")) is (fault != "none")
    assert fault != "none" or missed["centre"] <= mpf(10) ** -18
