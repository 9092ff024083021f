"""The attitude of a free body in closed form: right in every regime, by the equations and by Taylor."""

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from builders.turns import by_turns
from mpmath import mp, mpf

from taylor_verify.exact.euler import jacobi
from taylor_verify.exact.euler.closed import closed_form
from taylor_verify.exact.taylor import TaylorSolution
from taylor_verify.scenes import tensors
from taylor_verify.scenes.bodies import RigidBody
from taylor_verify.scenes.motion import Clock, Spin
from taylor_verify.scenes.scene import Scene

TILTED = (
    Fraction(1),
    Fraction(2),
    Fraction(-1),
    Fraction(3),
)  # a quaternion that is not of unit length
OBLIQUE = (
    (Fraction(2), Fraction(1, 4), Fraction(-1, 8)),
    (Fraction(1, 4), Fraction(3), Fraction(1, 2)),
    (Fraction(-1, 8), Fraction(1, 2), Fraction(5, 2)),
)


def diagonal(*moments: object) -> tensors.Matrix:
    return tensors.diagonal(tuple(Fraction(m) for m in moments))


def spin(*omega: object) -> tuple[Fraction, ...]:
    return tuple(Fraction(w) for w in omega)


# Every regime, every sign of the encircled component, and the borders between them.
MOTIONS = {
    "min axis": (diagonal(1, 2, 3), spin(1, "0.4", "0.3")),
    "min axis, other sense": (diagonal(3, 1, 2), spin("0.3", "-1", "0.4")),
    "max axis": (diagonal(3, 1, 2), spin(1, "0.2", "-0.3")),
    "max axis, other sense": (diagonal(1, 2, 3), spin("0.2", "0.3", "-1")),
    "cn axis at zero": (diagonal(1, 2, 3), spin(1, "0.4", 0)),
    "oblique": (OBLIQUE, spin("0.5", "-0.25", "0.75")),
    "separatrix": (diagonal(1, "4/3", 2), spin("0.5", "0.3", "0.25")),
    "beside the separatrix": (diagonal(1, 2, 3), spin("1e-12", 1, "1e-13")),
    "axisymmetric": (diagonal(2, 2, 3), spin("0.3", "0.1", 1)),
    "oblate about axis 1": (diagonal(1, 2, 2), spin("0.3", "0.1", 1)),
    "spherical": (diagonal(2, 2, 2), spin("0.3", "-0.2", "0.6")),
    "steady": (diagonal(1, 2, 3), spin(0, 0, "-0.8")),
    "rest": (diagonal(1, 2, 3), spin(0, 0, 0)),
}


def scene(name: str) -> Scene:
    inertia, omega = MOTIONS[name]
    clock = Clock(Fraction(0), (Fraction(1),))
    start = Spin(omega, TILTED)
    return Scene(name, "", "euler", frozenset({"attitude"}), RigidBody(inertia), start, clock)


@pytest.mark.parametrize("name", by_turns(MOTIONS))
def test_attitude_agrees_with_taylor(name: str) -> None:
    """The closed form and the Taylor route, which share no formula, agree to 35 digits."""
    times = [Fraction(0), Fraction(7, 3), Fraction(-5, 2), Fraction(31)]
    closed = closed_form(scene(name)).motion(times, 38)["attitude"]
    series = TaylorSolution(scene(name)).motion(times, 38)["attitude"]
    with mp.workdps(50):
        # Two routes of 38 digits each, on matrices of norm sqrt 3.
        assert all(_norm(a - b) <= mpf(10) ** -37 for a, b in zip(closed, series, strict=True))


@pytest.mark.parametrize("name", MOTIONS)
def test_attitude_obeys_its_equation(name: str) -> None:
    """R' = R [omega]x, by a central difference of the closed form at sixty digits."""
    exact, t, h = closed_form(scene(name)), Fraction(11, 4), Fraction(1, 10**20)
    motion = exact.motion([t - h, t, t + h], 75)
    with mp.workdps(75):
        before, R, after = motion["attitude"]
        slope = (after - before) / (2 * mp.convert(h))
        # The difference is wrong by R''' h^2/6, some 10^-40, and by 75 digits over h.
        assert _norm(slope - R @ _cross_matrix(motion["omega"][1])) <= mpf(10) ** -38


@pytest.mark.parametrize("name", MOTIONS)
def test_momentum_is_fixed_in_space(name: str) -> None:
    """R I omega keeps its first value at all times, |t| = 10^9 too, and R stays a rotation."""
    asked = scene(name)
    motion = closed_form(asked).motion([Fraction(0), Fraction(10) ** 9, Fraction(-(10**9))], 40)
    with mp.workdps(60):
        I = np.array([[mp.convert(v) for v in row] for row in asked.body.inertia], dtype=object)
        momenta = [R @ (I @ w) for R, w in zip(motion["attitude"], motion["omega"], strict=True)]
        size = max(_norm(momenta[0]), mpf(1))
        # Forty digits of R and of omega.
        assert all(_norm(m - momenta[0]) <= size * mpf(10) ** -38 for m in momenta)
        for R in motion["attitude"]:
            assert _norm(R @ R.T - np.eye(3, dtype=int)) <= mpf(10) ** -38
            assert mp.det(mp.matrix(R.tolist())) > 0


@pytest.mark.parametrize("name", ["min axis", "oblique", "axisymmetric", "beside the separatrix"])
def test_a_new_start_goes_on_with_the_same_attitude(name: str) -> None:
    """R(t1 + t2) = R(t1) times the attitude after t2 of a body started from rest frame at t1."""
    asked, first, second = scene(name), Fraction(13, 2), Fraction(29, 3)
    whole = closed_form(asked).motion([first, first + second], 45)
    with mp.workdps(60):
        omega = tuple(Fraction(*w.as_integer_ratio()) for w in whole["omega"][0])
    later = replace(asked, initial=Spin(omega))
    part = closed_form(later).motion([second], 45)["attitude"][0]
    with mp.workdps(60):
        # The restart is rounded to 45 digits; near the separatrix e^(lambda t2) is below 10^3.
        difference = whole["attitude"][1] - whole["attitude"][0] @ part
        assert _norm(difference) <= mpf(10) ** -40


def test_a_missing_third_kind_term_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    """Without the elliptic integral of the third kind the attitude is wrong by more than a tenth."""
    times = [Fraction(31)]
    series = TaylorSolution(scene("min axis")).motion(times, 20)["attitude"][0]
    monkeypatch.setattr(jacobi.Triaxial, "_integral", lambda self, *at: mpf(0))
    broken = closed_form(scene("min axis")).motion(times, 20)["attitude"][0]
    assert _norm(broken - series) > 0.1


def _norm(values: object) -> mpf:
    return mp.norm(list(np.asarray(values).flat))


def _cross_matrix(w: object) -> np.ndarray:
    zero = mpf(0)
    return np.array([[zero, -w[2], w[1]], [w[2], zero, -w[0]], [-w[1], w[0], zero]], dtype=object)
