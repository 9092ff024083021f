"""Bodies of revolution whose origin lies anywhere on their axis: closed forms against Taylor."""

from __future__ import annotations

from fractions import Fraction
from itertools import product

import pytest
from builders.turns import by_turns
from mpmath import mp, mpf

from taylor_verify.exact.carried import Back
from taylor_verify.exact.elements import elements
from taylor_verify.exact.kirchhoff import displaced
from taylor_verify.exact.kirchhoff.displaced import moved, moved_back, symmetric_origin
from taylor_verify.exact.kirchhoff.solid import solid
from taylor_verify.exact.route import solution
from taylor_verify.exact.taylor import TaylorSolution
from taylor_verify.scenes import tensors
from taylor_verify.scenes.bodies import ImmersedBody
from taylor_verify.scenes.motion import Clock, Impulse, Motion
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene
from taylor_verify.scenes.tensors import Matrix, Vector

TIMES = [Fraction(-3, 2), Fraction(0), Fraction(5, 2)]
DIGITS = 30
# p p' q q' r r' about the point where T is of Clebsch's form: two generic regimes, and one in which p and q
# are the same along the axis as across it.
BODIES = {
    "four-roots": ("1", "2", "0.2", "0.5", "1.1", "0.7"),
    "two-roots": ("1.5", "0.8", "0.1", "0.4", "1", "1.25"),
    "trigonometric": ("1.2", "1.2", "0.3", "0.3", "0.9", "0.8"),
}
BETA = Fraction(-3, 10)


def scene(axis: int, six: tuple[str, ...], beta: Fraction = BETA) -> Scene:
    """A body of revolution about a body axis, with attitude and path; p is that about the centred point."""
    p, p_prime, q, q_prime, r, r_prime = map(Fraction, six)
    i, j = axis % 3, (axis + 1) % 3

    def block(across: Fraction, along: Fraction, askew: Fraction = Fraction(0)) -> Matrix:
        rows = [[Fraction(0)] * 3 for _ in range(3)]
        rows[i][i] = rows[j][j] = across
        rows[axis - 1][axis - 1] = along
        rows[i][j], rows[j][i] = askew, -askew
        return tuple(map(tuple, rows))

    body = ImmersedBody(block(p + beta**2 / r, p_prime), block(q, q_prime, beta), block(r, r_prime))
    start = Impulse(
        tuple(map(Fraction, ("0.6", "-0.4", "0.5"))),
        tuple(map(Fraction, ("0.2", "0.3", "0.8"))),
        (Fraction(1), Fraction(2), Fraction(-1), Fraction(3)),
        tuple(map(Fraction, ("2", "-1", "0.5"))),
    )
    whole = frozenset({"attitude", "centre"})
    return Scene("test", "test", "kirchhoff", whole, body, start, Clock(Fraction(0), tuple(TIMES)))


def distance(motion: Motion, truth: Motion) -> mpf:
    """The largest distance of any vector or matrix, relative to its size."""
    with mp.workdps(2 * DIGITS):
        return max(
            mp.norm(list((a - b).flat)) / mp.norm(list(b.flat))
            for name, rows in truth.quantities.items()
            for a, b in zip(motion[name], rows, strict=True)
        )


# Every body on one route about one axis, the others by turns.
@pytest.mark.parametrize(
    ("kind", "axis", "route"), by_turns(product(BODIES, [1, 3], ["arb", "mpmath"]))
)
def test_the_motion_is_that_of_the_taylor_recursion(kind: str, axis: int, route: str) -> None:
    """x, y, attitude and path agree with what knows the equations of the 21 coefficients alone."""
    asked = scene(axis, BODIES[kind])
    exact, truth = solution(asked, route), TaylorSolution(asked)
    assert exact.regime == kind
    # Each of the two is promised to these digits of every vector and matrix.
    promised = 2 * mpf(10) ** -DIGITS
    assert distance(exact.motion(TIMES, DIGITS), truth.motion(TIMES, DIGITS)) <= promised


@pytest.mark.parametrize("route", ["arb", "mpmath"])
def test_a_displacement_to_the_wrong_side_is_seen(
    monkeypatch: pytest.MonkeyPatch, route: str
) -> None:
    """The broken twin: moved back by -d, y and the path are wrong in their first digit."""
    asked = scene(3, BODIES["four-roots"])

    def wrongly(d: Vector, start: Impulse) -> Back:
        return moved_back(tensors.scaled(Fraction(-1), d), start)

    monkeypatch.setattr(displaced, "moved_back", wrongly)
    motion = solution(asked, route).motion(TIMES, DIGITS)
    assert distance(motion, TaylorSolution(asked).motion(TIMES, DIGITS)) > 0.1


def test_the_other_origin_changes_no_integral() -> None:
    """T, F^2, FG and y3 are the same numbers about either point, as rationals."""
    asked = scene(3, BODIES["two-roots"])
    d = symmetric_origin(solid(asked)[0])
    assert d == (0, 0, -BETA / Fraction(1))

    def integrals(of: Scene) -> tuple[Fraction, ...]:
        body, start = of.body, of.initial
        assert isinstance(body, ImmersedBody)
        assert isinstance(start, Impulse)
        state = start.linear + start.angular
        energy = tensors.dot(state, tensors.apply(body.energy_matrix, state)) / 2
        x, y = start.linear, start.angular
        return energy, tensors.dot(x, x), tensors.dot(x, y), y[2]

    assert integrals(moved(asked, d)) == integrals(asked)


def test_a_body_of_revolution_has_an_axis_wherever_its_origin_is() -> None:
    """And one entry of B that breaks the symmetry takes it away."""
    body = scene(2, BODIES["four-roots"]).body
    assert isinstance(body, ImmersedBody)
    assert body.axis_of_symmetry == 2
    rows = [list(row) for row in body.coupling]
    rows[0][2] += Fraction(1, 10**30)
    askew = ImmersedBody(body.linear, tuple(map(tuple, rows)), body.angular)
    assert askew.axis_of_symmetry is None


def test_a_real_vehicle_has_a_closed_form() -> None:
    """REMUS, of revolution but for its origin, says where it is solved, and about which axis."""
    orbit = elements(load("kirchhoff/remus-100"))
    assert orbit.regime == "four-roots"
    assert orbit["period"].value > 0
    assert orbit.sentences[0] == (
        "Solved about the origin moved by (-0.0292513, 0.0, 0.0), where B is symmetric."
    )
    assert orbit.sentences[1].startswith("x1 swings")
