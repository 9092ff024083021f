"""No digit is printed that its number does not have, and the radius means one thing on every route."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from itertools import product
from pathlib import Path
from typing import Any, Final

import numpy as np
import pytest
from builders.numbers import closed_routes
from builders.scenes import one_instant, read_scene, text_of, vector
from builders.turns import by_turns
from flint import arb
from mpmath import mp, mpf

from taylor_verify.exact import printed as printing
from taylor_verify.exact.printed import document
from taylor_verify.exact.route import CLOSED_ROUTES, solution
from taylor_verify.exact.solution import NO_CLOSED_FORM, NoClosedForm
from taylor_verify.numbers import tensors
from taylor_verify.numbers.irrational import PI, Constant, Pi, generator
from taylor_verify.scenes.bodies import Clebsch, RigidBody
from taylor_verify.scenes.motion import Impulse, Spin
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene
from taylor_verify.scenes.stand_in import stand_in

ROUTES: Final = (*CLOSED_ROUTES, "taylor")
NOT_VECTORS: Final = ("t", "radius", "absolute", "regime")
SHIPPED: Final = (
    "extremes/kirchhoff-unstable-spin-1e-40",
    "extremes/kirchhoff-impulses-1e-150",
    "extremes/kirchhoff-small-impulse-1e-30",
    "extremes/kirchhoff-modulus-1e-30",
    "extremes/kirchhoff-linear-1e20",
    "extremes/kirchhoff-nearly-orthogonal",
    "extremes/euler-modulus-1e-30",
    "extremes/euler-separatrix-tail",
    "extremes/euler-omega-1e-150",
    "extremes/euler-ratio-1e12",
)


def scene(body: str, initial: str, track: str = "attitude") -> Scene:
    return read_scene(body, initial, top=f'track = ["{track}"]')


def printed(asked: Scene, route: str | None, t: Fraction | int, digits: int) -> dict[str, Any]:
    """Return the row of `exact --json` at a time."""
    shown = document(asked, solution(asked, route), [("t", Fraction(t))], digits)
    (row,) = shown["rows"]
    return {**row, "regime": shown["regime"]}


def vectors(row: dict[str, Any]) -> dict[str, list[str]]:
    return {
        name: np.ravel(np.array(value)).tolist()
        for name, value in row.items()
        if name not in NOT_VECTORS
    }


def unit(text: str) -> Fraction:
    """One unit in the last digit of a number."""
    mantissa, _, exponent = text.partition("e")
    return Fraction(10) ** (int(exponent or 0) - len(mantissa.partition(".")[2]))


def check_digits(coarse: dict[str, Any], fine: dict[str, Any]) -> None:
    """Every component is within a unit of its last digit; those that are "0" are within `absolute`.

    That holds of the finer row too, whose tiny components may be "0" where the coarser one has digits.
    """
    for name, texts in vectors(coarse).items():
        open_part = Fraction(fine.get("absolute", {}).get(name, 0))
        true = [Fraction(text) for text in vectors(fine)[name]]
        hidden = Fraction(0)
        for text, value in zip(texts, true, strict=True):
            if text == "0":
                hidden += value**2
            else:
                assert abs(Fraction(text) - value) <= unit(text) + (0 if value else open_part)
        assert hidden <= Fraction(coarse.get("absolute", {}).get(name, 0)) ** 2


PROLATE: Final = "ellipsoid = { semi_axes = [1, 1, 2], density = 1, fluid_density = 1 }"
IMPULSES: Final = "linear_impulse = [1, 0, 2]\nangular_impulse = [0, 1, 1]"


FAR: Final = {
    "tumbling ever faster": ("-1", 250, "-3.48051347394571784958e108"),
    "after very long": ("0", 10**110, "0.6743749450554305857989"),
}


@pytest.mark.parametrize(("damping", "t", "x1"), FAR.values(), ids=FAR)
def test_a_spheroid_keeps_its_digits(damping: str, t: int, x1: str) -> None:
    """After 10^108 turns forty digits are the beginning of a hundred.

    The rationals of 120 digits that stand for its masses would leave a dozen.
    """
    body = scene(f"{PROLATE}\ndamping = {damping}", IMPULSES, "centre")
    fine = printed(body, "arb", t, 100)
    check_digits(printed(body, "arb", t, 40), fine)
    assert abs(Fraction(fine["linear_impulse"][0]) - Fraction(x1)) <= unit(x1)


TURNS: Final[dict[str, Callable[[], mpf]]] = {
    'euler = { sequence = "zyx", degrees = [10, 5, 0] }': lambda: (
        mp.cos(mp.pi / 18) * mp.cos(mp.pi / 36)
    ),
    "rotation_vector = [1, 0, 1]": lambda: (1 + mp.cos(mp.sqrt(2))) / 2,
    "axis_angle = { axis = [1, 1, 1], degrees = 90 }": lambda: mpf(1) / 3,
}


@pytest.mark.parametrize("route", ROUTES)
@pytest.mark.parametrize("turn", TURNS)
def test_an_attitude_by_angles_is_that_of_the_angles(route: str, turn: str) -> None:
    """Two hundred digits of R are those of the angles, where a solver's quaternion has 120."""
    row = printed(scene("inertia = [1, 2, 3]", f"omega = [0, 0, 1]\n{turn}"), route, 0, 200)
    with mp.workdps(220):
        assert_equal([row["attitude"][0][0]], [TURNS[turn]()], 199)


ELLIPSOID: Final = "ellipsoid = { semi_axes = [4, 6, 9], density = 1, fluid_density = 0 }"
ONES: Final = "[1, 1, 1]"


@pytest.mark.parametrize(("t", "digits"), [(8, 130), pytest.param(440, 20, marks=pytest.mark.slow)])
def test_an_ellipsoid_in_a_vacuum_stays_on_the_separatrix(t: int, digits: int) -> None:
    """It is enclosed, and turns as the rigid body of moments 117, 97, 52 does, which has a closed form."""
    start = f"linear_velocity = [0, 0, 0]\nangular_velocity = {ONES}"
    row = printed(scene(ELLIPSOID, start, "attitude"), None, t, digits)
    rigid = printed(scene("inertia = [117, 97, 52]", f"omega = {ONES}"), "arb", t, 3 * digits)
    assert rigid["regime"] == "separatrix"
    check_digits({"attitude": row["attitude"], "absolute": row.get("absolute", {})}, rigid)


# Independent motions: a body of revolution by hand.


def assert_equal(texts: list[str], values: list[mpf], digits: int) -> None:
    """Compare printed numbers with values: so many digits are printed, and all of them are right."""
    for text, value in zip(texts, values, strict=True):
        assert abs(mpf(text) - value) <= mpf(10) ** (1 - digits) * abs(value)


def precession(H: list[mpf], across: mpf, along: mpf, t: mpf) -> list[mpf]:
    """The angular momentum in body axes, by its moments of inertia across and along axis 3.

    From H' = H x omega: H3 stays, and H1 + i H2 turns at the rate H3 (1/across - 1/along).
    """
    turn = H[2] * (1 / across - 1 / along) * t
    c, s = mp.cos(turn), mp.sin(turn)
    return [H[0] * c - H[1] * s, H[0] * s + H[1] * c, H[2]]


DEGREES: Final = '["2 deg/s", "1 deg/s", "3 deg/s"]'


@pytest.mark.parametrize("route", ["arb", "taylor"])
def test_a_spheroid_in_degrees_has_two_hundred_digits(route: str) -> None:
    """A prolate spheroid that does not move along precesses, with Lamb's added inertia, as by hand."""
    start = f"linear_velocity = [0, 0, 0]\nangular_velocity = {DEGREES}"
    row = printed(scene(PROLATE, start), route, 20, 200)
    with mp.workdps(400):
        e = mp.sqrt(3) / 2
        # Lamb, art. 114: the alphas along and across the axis, for 1 - e^2 = 1/4.
        along = (mp.atanh(e) - e) / (2 * e**3)
        across = 1 / e**2 - mp.atanh(e) / (4 * e**3)
        mass = 8 * mp.pi / 3
        added = mass / 5 * 9 * (across - along) / (6 + 5 * (along - across))
        moments = (mass + added, mass * 2 / 5)
        H = [moments[i] * n * mp.pi / 180 for i, n in ((0, 2), (0, 1), (1, 3))]
        assert_equal(row["angular_impulse"], precession(H, *moments, mpf(20)), 200)


# Tiny components.

TINY: Final = "extremes/euler-unstable-axis-1e-40"


@pytest.mark.parametrize("digits", [4, 20])
@pytest.mark.parametrize("name", by_turns([TINY, *SHIPPED]))
def test_every_printed_digit_is_right(name: str, digits: int) -> None:
    """The digits are those of three times as many, in every component, however small it is."""
    shipped = load(name)
    instants = shipped.clock.elapsed
    for t in (Fraction(1), instants[len(instants) // 2]):
        for route in closed_routes(shipped):
            check_digits(printed(shipped, route, t, digits), printed(shipped, route, t, 3 * digits))


def test_digits_that_no_error_proves_are_caught(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where forty digits more are printed than the error of a component allows, the comparison fails."""
    fine = printed(load(TINY), "arb", 1, 60)
    monkeypatch.setattr(printing, "_proven_digits", lambda value, error, digits: digits + 40)
    with pytest.raises(AssertionError):
        check_digits(printed(load(TINY), "arb", 1, 20), fine)


# Relations that nobody has proven.


@dataclass(frozen=True)
class Twin(Constant):
    """The number pi under another name: no ball shows whether a number is it."""

    def evaluated(self) -> arb:
        return arb.pi()


TWIN: Final = generator((Pi(), Twin()), 1)


def top(w3: Any) -> Scene:
    """A body on its separatrix, 2 w1^2 = 18 w3^2, if w3 is pi/3."""
    spin = Spin(tuple(map(stand_in, (PI, Fraction(7, 3), w3))))
    return one_instant(RigidBody(tensors.diagonal(vector(2, 3, 6))), spin, "attitude")


def test_a_kind_of_motion_that_is_not_decided_has_no_closed_form() -> None:
    """Then the motion is enclosed, whatever the answer is, and its digits are those of both."""
    open_question, separatrix = top(TWIN / 3), top(PI / 3)
    assert solution(separatrix).regime == "separatrix"
    for route in CLOSED_ROUTES:
        with pytest.raises(NoClosedForm, match="the kind of motion is not decided"):
            solution(open_question, route)
    chosen = solution(open_question)
    assert (chosen.route, chosen.regime) == ("taylor", NO_CLOSED_FORM)
    row = printed(open_question, None, 2, 150)
    assert row["regime"] == NO_CLOSED_FORM
    check_digits(row, printed(separatrix, "arb", 2, 200))


def test_a_body_that_may_be_a_sphere_is_enclosed() -> None:
    """Differences of its coefficients may be zero: their balls contain zero, and the motion has digits."""

    def solid(along: Any) -> Scene:
        p, q = stand_in(PI), Fraction(0)
        body = Clebsch(p, stand_in(along), q, q, Fraction(1), Fraction(2)).body()
        return one_instant(body, Impulse(vector(1, 0, 1), vector(0, 1, 1)))

    check_digits(printed(solid(TWIN), None, 1, 20), printed(solid(PI), "arb", 1, 60))


def test_a_constant_that_cancels_decides_the_kind() -> None:
    """A rational ratio is a closed form, also where the numbers have an unproven relation to pi."""
    spin = Spin(tuple(map(stand_in, (TWIN, 3 * TWIN, TWIN / 3))))
    body = RigidBody(tensors.diagonal(vector(2, 3, 6)))
    assert solution(one_instant(body, spin, "attitude")).regime == "separatrix"


# The radius

SCENES = (
    "euler/with-attitude",
    "euler/oblique-symmetry",
    "kirchhoff/screw",
)
TIMES = ("1.25", "7")


def rows_by(scene: str, route: str, digits: int) -> list[dict[str, Any]]:
    asked = load(scene)
    times = [(text, asked.clock.start + Fraction(text)) for text in TIMES]
    rows: list[dict[str, Any]] = document(asked, solution(asked, route), times, digits)["rows"]
    return rows


def flat_vectors(row: dict[str, Any]) -> dict[str, list[Fraction]]:
    """Every vector and matrix of a row, flat, as the rationals that its text says."""
    values = {}
    for name, value in row.items():
        if name not in ("t", "radius"):
            values[name] = [Fraction(text) for text in np.ravel(np.array(value))]
    return values


def errors(row: dict[str, Any], truth: dict[str, Any]) -> dict[str, Fraction]:
    """The square of each vector's error by that of its norm, recomputed from the text alone."""
    ones, others = flat_vectors(row), flat_vectors(truth)
    assert set(ones) == set(others)
    return {
        name: sum((a - b) ** 2 for a, b in zip(ones[name], others[name], strict=True))
        / sum(b * b for b in others[name])
        for name in ones
    }


@pytest.mark.parametrize(("digits", "scene"), by_turns(product([3, 16], SCENES)))
def test_printed_digits_are_within_the_radius_on_every_route(scene: str, digits: int) -> None:
    """Against forty digits of the other routes; and printing is most of it, on all three alike."""
    sharp = {route: rows_by(scene, route, 40) for route in ROUTES}
    for route in ROUTES:
        for k, row in enumerate(rows_by(scene, route, digits)):
            radius = Fraction(row["radius"])
            assert Fraction(5, 10**digits) < radius <= Fraction(6, 10**digits)
            for other in ROUTES:
                room = radius + Fraction(sharp[other][k]["radius"])
                assert max(errors(row, sharp[other][k]).values()) <= room**2


DIAGONALS = {"linear": [1, 1, 1], "coupling": [0, 0, 0], "angular": [1, 2, 3]}
ENERGY = {name: np.diag(entries).tolist() for name, entries in DIAGONALS.items()}
# An impulse that a force takes away.
CANCELLING = text_of(
    {"force": ["1/3", "2/3", 0], "energy": ENERGY},
    {"linear_impulse": ["-1/7", "-2/7", 0], "angular_impulse": [0, 0, 0]},
    *(1, 2),
)


@pytest.mark.parametrize("left", [Fraction(1, 10**100), Fraction(0)])
def test_what_is_left_of_a_vector_that_cancels_is_right(tmp_path: Path, left: Fraction) -> None:
    """x is linear in time. Of 1e-100 of it every digit is right; of nothing, zero is printed and said."""
    file = tmp_path / "cancelling.toml"
    file.write_text(CANCELLING, encoding="utf-8")
    scene = load(str(file))
    printed_rows = document(
        scene, solution(scene, "taylor"), [("t", Fraction(3, 7) + 3 * left)], 30
    )
    (row,) = printed_rows["rows"]
    truth = [left, 2 * left, Fraction(0)]
    errors = [Fraction(p) - t for p, t in zip(row["linear_impulse"], truth, strict=True)]
    assert Fraction(row["radius"]) < Fraction(1, 10**29)
    assert sum(e * e for e in errors) <= Fraction(row["radius"]) ** 2 * sum(t * t for t in truth)
    assert ("absolute" in row) is (left == 0)
