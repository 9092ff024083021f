"""Clebsch's body about any body axis, and with a repeated root anywhere, by closed routes and Taylor."""

from __future__ import annotations

import random
from collections.abc import Iterator, Sequence
from dataclasses import replace
from fractions import Fraction
from itertools import product

import pytest
from builders.clebsch import STOUT
from builders.numbers import apart, motions_of_taylor
from builders.scenes import one_instant, vector
from builders.turns import by_turns
from mpmath import mp, mpf

from taylor_verify.exact.elements import elements
from taylor_verify.exact.invariants import invariants
from taylor_verify.exact.kirchhoff import quartic
from taylor_verify.exact.kirchhoff.axis_of_revolution import UPRIGHT, body_about, clebsch_about
from taylor_verify.exact.kirchhoff.quartic import Nutation, repeated_root
from taylor_verify.exact.kirchhoff.regime import regime
from taylor_verify.exact.route import CLOSED_ROUTES, solution
from taylor_verify.exact.solution import NO_CLOSED_FORM, NoClosedForm
from taylor_verify.exact.taylor import TaylorSolution
from taylor_verify.numbers import tensors
from taylor_verify.numbers.tensors import Matrix, Vector
from taylor_verify.scenes.bodies import Clebsch, ImmersedBody
from taylor_verify.scenes.motion import Clock, Impulse
from taylor_verify.scenes.scene import Scene

DIGITS = 30
TIMES = [Fraction(-1), Fraction(0), Fraction(2)]
WHOLE = frozenset({"attitude", "centre"})
GENERIC = vector("0.6", "-0.4", "0.5"), vector("0.2", "0.3", "0.8")
# p p' q q' r r' about the axis.
SIX = {
    "four-roots": vector(1, 2, "0.2", "0.5", "1.1", "0.7"),
    "two-roots": vector("1.5", "0.8", "0.1", "0.4", 1, "1.25"),
    "cubic": vector("1.2", "1.2", "0.1", "0.3", "0.9", "0.8"),
    "trigonometric": vector("1.2", "1.2", "0.3", "0.3", "0.9", "0.8"),
}
# The length of the second is rational.
DIRECTIONS = [vector(1, 1, 0), vector(1, 2, 2), vector(1, -2, 3)]
AXES = [vector(1, 0, 0), vector(0, 1, 0), vector(0, 0, 1)]


def about(n: Vector, six: Vector, x: Vector, y: Vector) -> Scene:
    """A body of these six coefficients about n, with attitude and path."""
    attitude = (Fraction(1), Fraction(2), Fraction(-1), Fraction(3))
    start = Impulse(x, y, attitude, vector(2, -1, "0.5"))
    body = body_about(Clebsch(*six), n)
    return Scene("test", "test", "kirchhoff", WHOLE, body, start, Clock(Fraction(0), tuple(TIMES)))


@pytest.mark.parametrize(("kind", "n"), by_turns(product(SIX, [*DIRECTIONS, *AXES[:2]]), 4))
def test_generic_motions_are_those_of_the_taylor_recursion(kind: str, n: Vector) -> None:
    """Impulses, attitude and path about any direction or body axis, forward and backward."""
    assert motions_of_taylor(about(n, SIX[kind], *GENERIC), kind, TIMES, DIGITS)


# Degenerate motions about (1, 1, 0)/sqrt 2. Beside axes.py, z = n.x, h = n.y and a = nu y.y - h^2, and
# with l = p - p', s = q - q', F^2 = nu x.x and FG = nu x.y,
#     nu f = r (F^2 - z^2) (l z^2 + 2 s h z + m) - r^2 (FG - h z)^2,
# where m = r a - l z^2 - 2 s h z at the start.


def drop_of_p(kind: str, n: Vector, x: Vector, y: Vector, r: Fraction, s: Fraction) -> Fraction:
    """The l that makes the motion steady, homoclinic at z = F, or heteroclinic."""
    nu, z, h = tensors.dot(n, n), tensors.dot(n, x), tensors.dot(n, y)
    F2, FG, a = (
        nu * tensors.dot(x, x),
        nu * tensors.dot(x, y),
        nu * tensors.dot(y, y) - h**2,
    )
    if kind == "steady":
        rest = 2 * r * z * a - 2 * (F2 - z**2) * s * h - 2 * r * h * (FG - h * z)
        return rest / (2 * (F2 - z**2) * z)
    if kind == "heteroclinic":
        assert FG == h == 0
        return -r * a / (F2 - z**2)
    F = Fraction(2)
    assert F2 == F**2
    assert FG == F * h
    return -(r * a + 2 * s * h * (F - z)) / (F2 - z**2)


N, TOWARDS = vector(1, 1, 0), (vector(1, 0, 1), vector("1/5", "1/3", "1/3"))
R, TWIST = Fraction(1), Fraction(1, 4)


def triple() -> tuple[Fraction, Fraction]:
    """(l, s) such that z = F is a triple root: 4 F (l F + s h) = -r h^2 beside the double root."""
    x, y = TOWARDS
    F, z, h = Fraction(2), tensors.dot(N, x), tensors.dot(N, y)
    a = 2 * tensors.dot(y, y) - h**2
    by_h = R * h**2 / (4 * F)
    s = (-R * a / (F - z) + by_h * (F + z) / F) / (2 * h - h * (F + z) / F)
    return (-by_h - s * h) / F, s


def degenerate() -> Iterator[tuple[str, Fraction, Fraction, Vector, Vector]]:
    """Yield the regime, l, s and the start."""
    nothing, across = vector(0, 0, 0), vector(1, -1, 0)
    swing = vector(1, "1/2", "1/3"), tensors.cross(N, vector(1, "1/2", "1/3"))
    level = vector("4/5", "1/5", 0), vector("1/3", "-1/7", 0)
    yield "rest", Fraction(-1), TWIST, nothing, nothing
    yield "euler-top", Fraction(-1), TWIST, nothing, vector(1, "1/2", "1/3")
    yield "steady", Fraction(-1), TWIST, N, vector("1/3", "1/3", 0)
    yield "steady", drop_of_p("steady", N, *level, R, TWIST), TWIST, *level
    yield "hyperbolic", drop_of_p("hyperbolic", N, *TOWARDS, R, TWIST), TWIST, *TOWARDS
    yield "algebraic", *triple(), *TOWARDS
    yield "heteroclinic", drop_of_p("heteroclinic", N, *swing, R, TWIST), TWIST, *swing
    # Where p' = p and n.y = 0 the twist alone leaves a quadratic f.
    yield "trigonometric", Fraction(0), TWIST, swing[0], vector("1/3", "-1/3", "2/5")
    # A start on the axis that leaves it, and G = n.y = 0: through both poles.
    yield "four-roots", Fraction(-1), TWIST, N, vector("1/2", "1/4", "1/3")
    yield (
        "four-roots",
        Fraction(-1),
        Fraction(0),
        vector(1, 1, "1/9"),
        tensors.scaled(Fraction(3), across),
    )


@pytest.mark.parametrize(
    ("kind", "l", "s", "x", "y"), by_turns(degenerate(), 9, lambda kind, *_: kind)
)
def test_degenerate_motions_about_an_irrational_axis_are_decided_and_solved(
    kind: str, l: Fraction, s: Fraction, x: Vector, y: Vector
) -> None:
    """Every equality that makes a motion special is one of rationals, though the axis is irrational."""
    six = (Fraction(4), 4 - l, Fraction(1, 5), Fraction(1, 5) - s, R, Fraction(1, 2))
    assert motions_of_taylor(about(N, six, x, y), kind, TIMES, DIGITS)


@pytest.mark.parametrize("n", [DIRECTIONS[2], AXES[1]])
@pytest.mark.parametrize("route", ["arb", "mpmath"])
def test_the_start_is_the_scenes_own(route: str, n: Vector) -> None:
    """Every component at time 0 is the one that the scene wrote, and a zero is a zero."""
    x, y = vector("1/3", 0, "-1/7"), vector(0, "2/3", 0)
    scene = about(n, SIX["cubic"], x, y)
    scene = replace(scene, initial=replace(scene.initial, centre=vector(0, "1/3", 0)))
    motion = solution(scene, route).motion([Fraction(0)], 30)
    with mp.workdps(30):
        given_start = {"linear_impulse": x, "angular_impulse": y, "centre": vector(0, "1/3", 0)}
        for name, start in given_start.items():
            for entry, stated in zip(motion[name][0], start, strict=True):
                assert abs(entry - mp.convert(stated)) <= mpf(10) ** -30 * abs(mp.convert(stated))


# The axis.


LITTLE = Fraction(1, 10**60)


def moved(matrix: Matrix, i: int, k: int) -> Matrix:
    return tuple(
        tuple(entry + LITTLE * (sorted((a, b)) == [i, k]) for b, entry in enumerate(row))
        for a, row in enumerate(matrix)
    )


@pytest.mark.parametrize("block", ["linear", "coupling", "angular"])
@pytest.mark.parametrize(("i", "k"), [(0, 0), (0, 1), (1, 2), (2, 2)])
def test_what_is_nearly_of_revolution_is_not(block: str, i: int, k: int) -> None:
    """An entry of a matrix that is off by 10^-60 leaves no closed form."""
    scene = about(DIRECTIONS[0], SIX["four-roots"], *GENERIC)
    assert isinstance(scene.body, ImmersedBody)
    other = scene.body.with_parts({block: moved(getattr(scene.body, block), i, k)})
    assert clebsch_about(other) is None
    assert solution(replace(scene, body=other)).regime == NO_CLOSED_FORM
    for route in CLOSED_ROUTES:
        with pytest.raises(NoClosedForm, match="about any axis"):
            solution(replace(scene, body=other), route)


def test_a_body_with_a_choice_keeps_the_third_axis() -> None:
    """Where every axis is one of symmetry the axes are those of the body."""
    for n in AXES:
        body = body_about(Clebsch(*vector("1.2", "1.2", "0.3", "0.3", "0.9", "0.9")), n)
        clebsch = clebsch_about(body)
        assert clebsch is not None
        assert (body.axis_of_symmetry, clebsch[1]) == (3, UPRIGHT)


# What is said of it.


def test_the_elements_are_those_of_the_body_about_axis_3() -> None:
    """The period and the range do not depend on the axes in which a body is written."""
    n = DIRECTIONS[1]
    turn = tuple(
        tensors.scaled(Fraction(1, 3), row) for row in (vector(2, 1, -2), vector(-2, 2, -1), n)
    )
    scene = about(n, SIX["four-roots"], *GENERIC)
    upright = about(vector(0, 0, 1), SIX["four-roots"], *(tensors.apply(turn, v) for v in GENERIC))
    orbit, other = elements(scene), elements(upright)
    for name in ("period", "m", "F", "G", "T", "A", "discriminant"):
        assert abs(orbit[name].value / other[name].value - 1) <= mpf(10) ** -14
    for end in ("low", "high"):
        assert abs(orbit[f"xe_{end}"].value / other[f"x3_{end}"].value - 1) <= mpf(10) ** -14
    text = " ".join([*orbit.sentences, *(element.meaning for element in orbit.values())])
    assert "about the direction e along (1, 2, 2)" in text
    assert not any(word in text for word in ("x3", "y3", "axis 3"))


@pytest.mark.parametrize(
    ("n", "name"), [(DIRECTIONS[2], "y_axis"), (AXES[0], "y1"), (AXES[1], "y2"), (AXES[2], "y3")]
)
def test_y_along_the_axis_is_conserved(n: Vector, name: str) -> None:
    """The invariant is n.y, and Taylor's motion has it; that of another direction varies."""
    scene = about(n, SIX["two-roots"], *GENERIC)
    (fourth,) = (i for i in invariants(scene) if i.name.startswith("y") and i.name != "y_space")
    assert fourth.name == name
    motion = TaylorSolution(scene).motion(TIMES, DIGITS)
    with mp.workdps(40):
        values = fourth.value(motion)
        component = mp.convert(tensors.dot(n, GENERIC[1]))
        assert all(abs(value - component) <= 10 * mpf(10) ** -DIGITS for value in values)
        assert max(abs(row[0] - row[1]) for row in motion["angular_impulse"]) >= mpf("0.01")
        assert fourth.scale(motion) >= max(abs(value) for value in values)


def test_a_drift_in_the_wrong_unit_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    """F Z' without its factor 1/nu: the centre misses Taylor's by far, the attitude does not."""
    scene = about(DIRECTIONS[0], SIX["four-roots"], *GENERIC)
    truth = TaylorSolution(scene).motion(TIMES[2:], 20)
    right = quartic.Nutation.drift
    monkeypatch.setattr(quartic.Nutation, "drift", lambda self, z: self.axes.nu * right(self, z))
    quantities = solution(scene, "mpmath").evaluate(TIMES[2:], 20)
    with mp.workdps(30):
        for name, is_wrong in {"attitude": False, "centre": True}.items():
            missed = mp.norm(list((quantities[name] - truth[name]).flat))
            assert (missed > mpf("0.01")) is is_wrong
            assert is_wrong or missed <= mpf(10) ** -18


# Repeated roots, wherever they and the start lie

FORTY = 40


def nutation(solid: Clebsch, start: Sequence[Fraction]) -> Nutation:
    return Nutation.of(solid, Impulse(tuple(start[:3]), tuple(start[3:])))


# Bodies whose quartic has a repeated root. With z0, F^2, FG, y3 and h = r (y1^2 + y2^2) of the
# start, and D = p - p', s = q - q',
#
#     f/r = (F^2 - z^2) [D (z^2 - z0^2) + 2 s y3 (z - z0) + h] - r (FG - y3 z)^2
#
# is linear in D and s: two conditions on f make them rational.


def doubled(start: Sequence[Fraction], d: Fraction, solid: Clebsch) -> Clebsch | None:
    """The body with p' and q' changed so that f(d) = f'(d) = 0, or None if there is none."""
    n, r = nutation(solid, start), solid.r
    y3, z0, gap = n.y3, n.z, n.F2 - d**2
    h = r * (start[3] ** 2 + start[4] ** 2)
    by_D, by_D_slope = d**2 - z0**2, 2 * d
    by_s, by_s_slope = 2 * y3 * (d - z0), 2 * y3
    level = gap * h - r * (n.FG - y3 * d) ** 2
    level_slope = -2 * d * h + 2 * r * y3 * (n.FG - y3 * d)
    a, b = gap * by_D, gap * by_s
    c, e = gap * by_D_slope - 2 * d * by_D, gap * by_s_slope - 2 * d * by_s
    determinant = a * e - b * c
    if determinant == 0:
        return None
    D = (b * level_slope - level * e) / determinant
    s = (level * c - a * level_slope) / determinant
    return positive(replace(solid, p_prime=solid.p - D, q_prime=solid.q - s))


def positive(solid: Clebsch) -> Clebsch | None:
    """The body if its energy is positive definite."""
    across = solid.p > 0 and solid.p * solid.r > solid.q**2
    along = solid.p_prime > 0 and solid.p_prime * solid.r_prime > solid.q_prime**2
    return solid if across and along else None


def random_start(rng: random.Random, place: str) -> tuple[Fraction, ...]:
    """Small rationals: anywhere, on the axis, at a turning point, or on the way to a pole."""

    def between(low: int, high: int) -> Fraction:
        return Fraction(rng.randint(6 * low, 6 * high), 6)

    x1, x2, x3, y1, y2, y3 = (between(-1, 1) for _ in range(6))
    if place == "axis":
        x1 = x2 = Fraction(0)
    if place == "turning point":
        y1, y2 = y1 * x1, y1 * x2
    if place == "to a pole":
        side = rng.choice([1, -1])
        x1, x2, x3, y1 = Fraction(3, 5), Fraction(0), Fraction(4 * side, 5), side * y3 / 3
    return x1, x2, x3, y1, y2, y3


def random_double_roots(place: str, number: int) -> list[tuple[Clebsch, tuple[Fraction, ...]]]:
    """Bodies with p, q, r fixed whose quartic from a random start has a random double root."""
    rng, cases = random.Random(place), list[tuple[Clebsch, tuple[Fraction, ...]]]()
    while len(cases) < number:
        start, d = random_start(rng, place), Fraction(rng.randint(-9, 9), 6)
        solid = doubled(start, d, STOUT) if any(start[:3]) else None
        if solid is None:
            continue
        n = nutation(solid, start)
        if regime(n) not in ("steady", "heteroclinic"):
            cases.append((solid, start))
    return cases


PLACES = ("anywhere", "axis", "turning point", "to a pole")


@pytest.mark.parametrize("place", PLACES)
def test_a_double_root_anywhere(place: str) -> None:
    """Wherever the double root and the start lie, the closed form is the motion of Taylor.

    If p' >= p, f has one real root, or infinity, beyond each pole, so that only at a pole can one
    of them meet a turning point.
    """
    times = [Fraction(2), Fraction(-1)]
    for solid, start in random_double_roots(place, 3):
        n, root = nutation(solid, start), repeated_root(nutation(solid, start).f)
        assert root is not None
        assert root**2 == n.F2 or solid.p_prime < solid.p
        scene = one_instant(solid.body(), Impulse(tuple(start[:3]), tuple(start[3:])))
        truth = TaylorSolution(scene).motion(times, FORTY)
        exact = solution(scene, "arb")
        assert exact.regime in ("hyperbolic", "trigonometric", "algebraic")
        with mp.workdps(FORTY + 20):
            motion = exact.motion(times, FORTY)
            assert apart(truth, motion) <= 2 * mpf(10) ** -FORTY
