"""The sentence that closes Heinbockel's page: constant moments and Jacobi's elliptic functions.

J principal moments, M moments constant in body axes. An elliptic function is single-valued and has
poles. At a pole w ~ c/s with -J_i c_i = (J_j - J_k) c_j c_k; T' = M.w and (H^2)'/2 = M.J w are
derivatives of single-valued functions and have no residue: M.c = 0 = M.J c. With three different J
one c_i is real and two are imaginary, so that for real M the two equations leave M = 0 alone.
"""

from __future__ import annotations

from fractions import Fraction
from functools import partial
from typing import Final

from mpmath import mp

from taylor_verify.scenes.bodies import RigidBody
from taylor_verify.scenes.motion import Spin
from taylor_verify_reports.claims.check import All, Residual
from taylor_verify_reports.claims.claim import Claim
from taylor_verify_reports.claims.heinbockel.continuation import loop
from taylor_verify_reports.claims.setting import Exact
from taylor_verify_reports.claims.trajectory import DIGITS, scene_of, trajectory

_J: Final = (3, 2, 1)
_START: Final = (1, 0, 1)
_CONTINUED: Final = 1e-20

# g the differences of the moments, c2 the squares c_i^2, P = c_1 c_2 c_3.
poles: Final = Exact(
    {"J1": 3, "J2": 2, "J3": 1},
    """
    g = array([J2 - J3, J3 - J1, J1 - J2])
    c2 = array([J2*J3 / (g[1]*g[2]), J3*J1 / (g[2]*g[0]), J1*J2 / (g[0]*g[1])])
    P = -J1*J2*J3 / (g[0]*g[1]*g[2])
    """,
)
# -J_i c_i^2 = (J_j - J_k) P, P^2 is the product of the squares, and T' and (H^2)' have no residue.
_leading: Final = poles("J*c2 = -g*P", "P**2 = c2[0]*c2[1]*c2[2]", "J @ c2 = 0", "J**2 @ c2 = 0")


def one_real() -> Residual:
    """Count the c_i that are not real (c_2) and imaginary (c_1, c_3) for J1 > J2 > J3.

    Counted at a point: the signs of the squares cannot change while the J stay apart.
    """
    signs = [poles.field.value(square) > 0 for square in poles["c2"]]
    wrong = sum(a != b for a, b in zip(signs, (False, True, False), strict=True))
    return Residual(
        float(wrong), bound=0.0, because="c_i that are not real and imaginary as expected"
    )


# J1 = J2, and a moment across the axis of revolution.
revolution: Final = Exact(
    {"w1": 1, "w2": 2, "w3": 3, "J": 2, "J3": 1, "M1": 4, "M2": 5},
    """
    W = w1 + i*w2
    n = (J3 - J)*w3/J
    turn(w1=((J - J3)*w2*w3 + M1)/J, w2=(M2 - (J - J3)*w3*w1)/J)
    """,
)
# W' = i n W + M/J with n constant, so that W is e^(i n t) and a constant.
_trigonometric: Final = revolution("d(w3) = 0", "d(n) = 0", "d(W) = i*n*W + (M1 + i*M2)/J")


def single_valued(*moment: str) -> Residual:
    """|change of w| / |w| after a loop round a singularity in complex time."""
    return Residual(
        loop(_J, _START, moment).relative,
        _CONTINUED,
        "change of w after a loop round its singularity, relative to w; series of 48 orders at a quarter "
        "of the distance leave 10^-28, and eight digits more are granted",
    )


def branched(*moment: str) -> Residual:
    """|change of w| / |w| under a moment; no number if the logarithm does not predict the change.

    So no slip of the continuation can pass for a refutation. The prediction is 2 pi i d s, in which c and
    t* are taken from w with errors of second order in s: a hundred s^2 are granted.
    """
    continued = loop(_J, _START, moment)
    if continued.predicted <= 100 * continued.distance**2:
        return single_valued(*moment)
    return Residual(float("nan"), _CONTINUED, "the change of w after a loop is not 2 pi i d s")


_TIMES: Final = tuple(Fraction(k) for k in (1, 5, 20))


def jacobi(moment: int = 0) -> Residual:
    """Jacobi's functions against a trajectory: the closed form of the free body with full tensor."""
    from taylor_verify.exact.route import solution

    half, zero = Fraction(1, 2), Fraction(0)
    inertia = ((Fraction(3), half, zero), (half, Fraction(2), zero), (zero, zero, Fraction(4)))
    start = Spin((Fraction(1), Fraction(1, 3), Fraction(2)))
    loaded = RigidBody(inertia, (zero, zero, Fraction(moment)))
    orbit = trajectory(loaded, start, _TIMES)["omega"]
    free = scene_of(RigidBody(inertia), start, _TIMES)
    closed = solution(free, "mpmath").motion(_TIMES, DIGITS)["omega"]
    with mp.workdps(DIGITS + 5):
        size = max(
            mp.norm(list(a - b)) / mp.norm(list(b)) for a, b in zip(closed, orbit, strict=True)
        )
        return Residual(
            float(size),
            float(mp.mpf(10) ** (5 - DIGITS)),
            "closed form against a trajectory, both settled to 60 digits, relative; five are granted",
        )


CLAIMS: Final = (
    Claim(
        id="heinbockel constant moments",
        statement=r"\text{in the case of constant coefficients and constant moments the solutions can be "
        r"expressed in terms of Jacobi elliptic functions}",
        domain="(2.2.72), moments constant in body axes, real; three different J",
        method="residues: a pole w ~ c/s asks M.c = 0 = M.J c, with c_2 real and c_1, c_3 imaginary, which "
        "leaves M = 0 (exact expansion of the sums over c). Continuation round a singularity in "
        "complex time: without moment w returns, with one it changes by 2 pi i d s, a logarithm. "
        "Jacobi's form of the free body against a trajectory of 60 digits",
        correction=r"\text{for } M = 0 \text{ the solutions can be expressed in terms of Jacobi elliptic "
        r"functions}",
        counterexample="J = (3, 2, 1), w = (1, 0, 1) at t = 0, M = (1/8, 1/16, 1/5): round the next "
        "singularity in complex time, at a distance of 0.015, w changes by 8e-5 of itself",
        check=All(
            _leading, one_real, partial(single_valued, "0", "0", "0"), _trigonometric, jacobi
        ),
        transcribed=partial(branched, "0.125", "0.0625", "0.2"),
        mutants={
            "a moment about the middle axis alone": partial(branched, "0", "0.1", "0"),
            "a moment about the greatest axis alone": partial(branched, "0.1", "0", "0"),
            "c of the other sign": ("-g*P", "g*P"),
            "Jacobi's form for a body with a moment": partial(jacobi, moment=1),
            "a body of revolution that turns the other way": ("i*n*W", "-i*n*W"),
        },
        remark="Degenerate cases remain: a body of revolution with M across its axis (w_3 is constant and "
        "w_1 + i w_2 trigonometric, which is checked too), and permanent rotations w x J w = M.",
    ),
)
