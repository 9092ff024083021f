"""The sentence that closes Heinbockel's page: constant moments and Jacobi's elliptic functions.

J principal moments, M moments constant in body axes. An elliptic function is single-valued and has
poles. At a pole w ~ c/s with -J_i c_i = (J_j - J_k) c_j c_k; T' = M.w and (H^2)'/2 = M.J w are
derivatives of single-valued functions and have no residue: M.c = 0 = M.J c. With three different J
one c_i is real and two are imaginary, so that for real M the two equations leave M = 0 alone.
"""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from functools import cache, partial
from typing import Final

from mpmath import mp

from taylor_verify.claims.claim import Claim, Residual, Verdict, worse
from taylor_verify.claims.field import Element, Field, identity, symbols_of
from taylor_verify.claims.heinbockel.continuation import Loop, loop
from taylor_verify.claims.trajectory import DIGITS, trajectory
from taylor_verify.scenes import tensors
from taylor_verify.scenes.bodies import RigidBody
from taylor_verify.scenes.motion import Clock, Spin
from taylor_verify.scenes.scene import Scene

_J: Final = (3, 2, 1)
_START: Final = (1, 0, 1)
_CONTINUED: Final = 1e-20


class Poles:
    """Three moments of inertia as free symbols; c_i^2, and P = c_1 c_2 c_3."""

    def __init__(self) -> None:
        self.field = field = Field({"J1": 3, "J2": 2, "J3": 1})
        self.J = J = [field[name] for name in ("J1", "J2", "J3")]
        self.gaps = [J[1] - J[2], J[2] - J[0], J[0] - J[1]]
        self.squares = [
            J[1] * J[2] / (self.gaps[1] * self.gaps[2]),
            J[2] * J[0] / (self.gaps[2] * self.gaps[0]),
            J[0] * J[1] / (self.gaps[0] * self.gaps[1]),
        ]
        self.product = -1 * J[0] * J[1] * J[2] / (self.gaps[0] * self.gaps[1] * self.gaps[2])


def leading(p: Poles, sign: int = 1) -> Iterator[Element]:
    """-J_i c_i^2 = (J_j - J_k) P, P^2 = the product of the squares, and no residue in T' and (H^2)'."""
    for J, gap, square in zip(p.J, p.gaps, p.squares, strict=True):
        yield J * square + sign * gap * p.product
    first, second, third = p.squares
    yield p.product**2 - first * second * third
    yield sum((J * c2 for J, c2 in zip(p.J, p.squares, strict=True)), start=p.field.element(0))
    yield sum((J**2 * c2 for J, c2 in zip(p.J, p.squares, strict=True)), start=p.field.element(0))


def one_real() -> Residual:
    """For J1 > J2 > J3 c_2 is real, c_1 and c_3 are imaginary.

    Counted at a point: the signs of the squares cannot change while the J stay apart.
    """
    p = symbols_of(Poles)
    signs = [p.field.value(square) > 0 for square in p.squares]
    wrong = sum(a != b for a, b in zip(signs, (False, True, False), strict=True))
    return Residual(float(wrong), 0.0, "c_i that are not real and imaginary as expected")


class Revolution:
    """J1 = J2, and a moment across the axis of revolution."""

    def __init__(self) -> None:
        point = {"w1": 1, "w2": 2, "w3": 3, "J": 2, "J3": 1, "M1": 4, "M2": 5}
        self.field = field = Field(point)
        w1, w2, w3, self.J, self.J3, M1, M2 = (field[name] for name in point)
        self.i, self.w3 = field["i"], w3
        self.W, self.M = w1 + self.i * w2, M1 + self.i * M2
        gap = self.J - self.J3
        field.turn({"w1": (gap * w2 * w3 + M1) / self.J, "w2": (M2 - gap * w3 * w1) / self.J})


def trigonometric(b: Revolution, sign: int = 1) -> Iterator[Element]:
    """w3 is constant and W' = i n W + M/J with n constant, so that W is e^(i n t) and a constant."""
    yield b.field.rate(b.w3)
    n = sign * (b.J3 - b.J) * b.w3 / b.J
    yield b.field.rate(n)
    yield b.field.rate(b.W) - b.i * n * b.W - b.M / b.J


@cache
def _loop(moment: tuple[str, str, str]) -> Loop:
    return loop(_J, _START, moment)


def single_valued(*moment: str) -> Residual:
    """|change of w| / |w| after a loop round a singularity in complex time."""
    x, y, z = moment
    return Residual(
        _loop((x, y, z)).relative,
        _CONTINUED,
        "change of w after a loop round its singularity, relative to w; series of 48 orders at a quarter "
        "of the distance leave 10^-28, and eight digits more are granted",
    )


def logarithm(*moment: str) -> Residual:
    """That the change is 2 pi i d s, as the logarithm predicts it."""
    x, y, z = moment
    found = _loop((x, y, z))
    return Residual(
        found.predicted,
        100 * found.distance**2,
        "change of w after a loop less 2 pi i d s, relative; c and t* are taken from w with errors of "
        "second order in s, and a hundred s^2 are granted",
    )


def branched(*moment: str) -> Residual:
    """What a loop leaves of w under a moment; no number if it is not what the logarithm predicts.

    So no slip of the continuation can pass for a refutation.
    """
    found = single_valued(*moment)
    if logarithm(*moment).is_satisfied:
        return found
    return Residual(float("nan"), found.bound, "the change of w after a loop is not 2 pi i d s")


_TIMES: Final = tuple(Fraction(k) for k in (1, 5, 20))


def jacobi(moment: int = 0) -> Residual:
    """Jacobi's functions against a trajectory: the closed form of the free body with full tensor."""
    from taylor_verify.exact.euler.closed import closed_form

    half, zero = Fraction(1, 2), Fraction(0)
    inertia = ((Fraction(3), half, zero), (half, Fraction(2), zero), (zero, zero, Fraction(4)))
    start = Spin((Fraction(1), Fraction(1, 3), Fraction(2)))
    name = "a free body"
    free = Scene(
        name, name, "euler", frozenset(), RigidBody(inertia), start, Clock(Fraction(0), _TIMES)
    )
    torque: tensors.Vector = (Fraction(0), Fraction(0), Fraction(moment))
    orbit = trajectory(RigidBody(inertia, torque), start, _TIMES)["omega"]
    closed = closed_form(free).motion(_TIMES, DIGITS)["omega"]
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
        verdict=Verdict.FALSE,
        correction=r"\text{for } M = 0 \text{ the solutions can be expressed in terms of Jacobi elliptic "
        r"functions}",
        counterexample="J = (3, 2, 1), w = (1, 0, 1) at t = 0, M = (1/8, 1/16, 1/5): round the next "
        "singularity in complex time, at a distance of 0.015, w changes by 8e-5 of itself",
        check=lambda: worse(
            identity(Poles, leading)(),
            one_real(),
            single_valued("0", "0", "0"),
            identity(Revolution, trigonometric)(),
            jacobi(),
        ),
        transcribed=partial(branched, "0.125", "0.0625", "0.2"),
        mutants={
            "a moment about the middle axis alone": partial(branched, "0", "0.1", "0"),
            "a moment about the greatest axis alone": partial(branched, "0.1", "0", "0"),
            "c of the other sign": identity(Poles, leading, sign=-1),
            "Jacobi's form for a body with a moment": partial(jacobi, moment=1),
            "a body of revolution that turns the other way": identity(
                Revolution, trigonometric, sign=-1
            ),
        },
        remark="Degenerate cases remain: a body of revolution with M across its axis (w_3 is constant and "
        "w_1 + i w_2 trigonometric, which is checked too), and permanent rotations w x J w = M.",
    ),
)
