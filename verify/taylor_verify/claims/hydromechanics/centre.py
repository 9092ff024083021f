"""Hydromechanics 49 (18)-(22): where the origin of the body is, the axis of space along F.

X, Y, Z   coordinates of the origin in space (c below), c' = R U; cos xY is the element of R in row Y
and column x, and so on. Other symbols as in clebsch.py and angles.py.
M         R y + c x R x, the moment of the impulse about the origin of space: constant, and along Z
          where that origin lies on the central axis of the impulse
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import Final

from taylor_verify.claims.claim import Claim, Verdict, worse
from taylor_verify.claims.field import (
    QUATERNION,
    Element,
    Field,
    apply,
    cross,
    dot,
    identity,
    named,
    plus,
    quaternion_rates,
    rotation,
    unit_root,
    values,
)
from taylor_verify.claims.hydromechanics.angles import Angles
from taylor_verify.claims.hydromechanics.clebsch import COEFFICIENTS, kinetic_energy
from taylor_verify.claims.hydromechanics.paths import place


class Led:
    """Clebsch's body in a frame of space whose third axis is along F: x is F times R's third row."""

    def __init__(self) -> None:
        plain = ("F", "x1", "x2", "x3", "y1", "y2", "y3", "c1", "c2", "c3", *COEFFICIENTS)
        self.field = field = Field({**QUATERNION, **values(plain)}, {"e0": unit_root})
        self.F, self.y, self.c = field["F"], field.vector("y"), field.vector("c")
        self.p, self.pp, self.q, self.qq, self.r, self.rr = six = tuple(
            field[name] for name in COEFFICIENTS
        )
        self.R = rotation([field[f"e{k}"] for k in range(4)])
        self.x = [self.F * entry for entry in self.R[2]]
        p, pp, q, qq, r, rr = six
        (x1, x2, x3), (y1, y2, y3) = self.x, self.y
        self.U = [p * x1 + q * y1, p * x2 + q * y2, pp * x3 + qq * y3]
        self.Omega = [q * x1 + r * y1, q * x2 + r * y2, qq * x3 + rr * y3]
        dy = plus(cross(self.y, self.Omega), cross(self.x, self.U))
        velocity = apply(self.R, self.U)
        field.turn(quaternion_rates(field, self.Omega) | named("y", dy) | named("c", velocity))
        self.Ry = apply(self.R, self.y)
        self.G = dot(self.x, self.y) / self.F
        self.moment = plus(self.Ry, cross(self.c, [0 * self.F, 0 * self.F, self.F]))

    def derived_velocity(self) -> Iterator[Element]:
        """U and Omega against the derivatives of (1), at free x and y."""
        x, y = self.field.vector("x"), self.field.vector("y")
        six = tuple(self.field[name] for name in COEFFICIENTS)
        T = kinetic_energy(six, x, y)
        yield self.field.partial(T, "x3") - (self.pp * x[2] + self.qq * y[2])
        yield self.field.partial(T, "y1") - (self.q * x[0] + self.r * y[0])


def first(b: Led, sign: int = 1) -> Iterator[Element]:
    """(18) with the constant it lacks, M_Y: as a coordinate, and its rate against R U."""
    yield b.F * b.c[0] - (sign * b.Ry[1] - b.moment[1])
    yield b.field.rate(b.Ry[1]) - b.F * b.field.rate(b.c[0])
    yield b.field.rate(b.moment[1])


def second(b: Led, sign: int = -1) -> Iterator[Element]:
    """(19): ``sign`` is that of the second and third term of the sum."""
    (a11, a12, a13), (y1, y2, y3) = b.R[0], b.y
    right = -1 * y1 * a11 + sign * (y2 * a12 + y3 * a13)
    yield b.field.rate(right) - b.F * b.field.rate(b.c[1])
    yield b.F * b.c[1] - (right + b.moment[0])


def third(b: Led, row: int = 3) -> Iterator[Element]:
    """(20)."""
    yield b.G - dot(b.y, b.R[row - 1])


def distance(b: Led, sign: int = 1) -> Iterator[Element]:
    """(21), with X and Y about the central axis."""
    X, Y = b.Ry[1] / b.F, -b.Ry[0] / b.F
    yield b.F**2 * (X**2 + Y**2) - (dot(b.y, b.y) - sign * b.G**2)


def height_rate(b: Led, sign: int = 1) -> Iterator[Element]:
    """F dZ/dt, which the text does not give; (20) does not hold Z."""
    x3, y3 = b.x[2], b.y[2]
    right = b.p * b.F**2 + (b.pp - b.p) * x3**2 + b.q * b.F * b.G + sign * (b.qq - b.q) * x3 * y3
    yield b.F * b.field.rate(b.c[2]) - right
    yield b.field.partial(dot(b.y, b.R[2]), "c3")


def complex_place(
    a: Angles, sign: int = -1, root: int = 1, conjugate: bool = False
) -> Iterator[Element]:
    """(22) about the central axis; ``sign`` is that of F y3 - G x3. sqrt(F^2 - x3^2) = F sin theta."""
    Ry = apply(a.R, a.y)
    (x1, x2, x3), (y1, y2, y3) = a.x, a.y
    exponential = a.c["psi"] + (-1 if conjugate else 1) * a.i * a.s["psi"]
    top = sign * (a.F * y3 - Ry[2] * x3) + root * a.i * (x1 * y2 - x2 * y1)
    yield Ry[1] - a.i * Ry[0] - top / (a.F * a.s["theta"]) * exponential


_ROOM: Final = "T of the form (1); Z along F, which is not zero"
_AXIS: Final = "the origin of space lies on the central axis of the impulse"
_ORBIT: Final = "X and Y of a trajectory of 60 digits"
_EXACT: Final = "exact expansion in the quaternion, y, c, F and the six coefficients"

CLAIMS: Final = (
    Claim(
        id="hydromechanics 49 (18)",
        statement=r"FX = y_1\cos xY + y_2\cos yY + y_3\cos zY",
        domain=_ROOM,
        method=f"F X' against F (R U)_X, and F X - (R y)_Y against the constant -M_Y; {_EXACT}. {_ORBIT}",
        verdict=Verdict.ONLY_IF,
        condition=_AXIS,
        correction=r"FX = y_1\cos xY + y_2\cos yY + y_3\cos zY - M_Y",
        counterexample="R = 1, y = 0, c = (1, 0, 0): FX = F, and the right side is 0",
        check=lambda: worse(identity(Led, first)(), place()),
        transcribed=identity(Led, lambda b: [b.F * b.c[0] - b.Ry[1]]),
        mutants={"minus the sum": identity(Led, first, sign=-1)},
    ),
    Claim(
        id="hydromechanics 49 (19)",
        statement=r"FY = -y_1\cos xX + y_2\cos yX + y_3\cos zX",
        domain=f"{_ROOM}; {_AXIS}",
        method=f"F Y' against F (R U)_Y, and F Y - right side against the constant M_X; {_EXACT}. "
        f"{_ORBIT}",
        verdict=Verdict.FALSE,
        correction=r"FY = -(y_1\cos xX + y_2\cos yX + y_3\cos zX)",
        counterexample="body axis y along space axis X, y = (0, 1, 0): FY = -1, the right side as "
        "transcribed is +1; the minus belongs before the whole sum",
        check=lambda: worse(identity(Led, second)(), place()),
        transcribed=identity(Led, second, sign=1),
        mutants={
            "plus the whole sum": identity(Led, lambda b: [b.F * b.c[1] - b.Ry[0]]),
            "the minus before y1 alone, along the trajectory": partial(place, whole=False),
        },
    ),
    Claim(
        id="hydromechanics 49 (20)",
        statement=r"G = y_1\cos xZ + y_2\cos yZ + y_3\cos zZ",
        domain=_ROOM,
        method=f"G = x.y/F; {_EXACT}",
        verdict=Verdict.HOLDS,
        check=identity(Led, third),
        mutants={"Y for Z": identity(Led, third, row=2)},
    ),
    Claim(
        id="hydromechanics 49 coordinate Z",
        statement=r"\text{expressions for } X, Y, Z, \text{ the coordinates of the centre}",
        domain=_ROOM,
        method=f"the right side of (20) does not hold Z; the rate of Z from c' = R U; {_EXACT}",
        verdict=Verdict.VACUOUS,
        void="(20), in the third place, is an equation for G and says nothing of Z",
        correction=r"F\frac{dZ}{dt} = pF^2 + (p' - p)x_3^2 + qFG + (q' - q)x_3y_3",
        check=identity(Led, lambda b: [*height_rate(b), *b.derived_velocity()]),
        mutants={"q - q'": identity(Led, height_rate, sign=-1)},
    ),
    Claim(
        id="hydromechanics 49 (21)",
        statement=r"F^2(X^2 + Y^2) = y_1^2 + y_2^2 + y_3^2 - G^2",
        domain=_ROOM,
        method=f"with X, Y of (18) and the corrected (19); {_EXACT}",
        verdict=Verdict.ONLY_IF,
        condition=_AXIS,
        correction=r"(FX + M_Y)^2 + (FY - M_X)^2 = y_1^2 + y_2^2 + y_3^2 - G^2",
        counterexample="R = 1, y = 0, c = (1, 0, 0): F^2 = 0",
        check=identity(Led, distance),
        transcribed=identity(
            Led,
            lambda b: [b.F**2 * (b.c[0] ** 2 + b.c[1] ** 2) - (dot(b.y, b.y) - b.G**2)],
        ),
        mutants={"+ G^2": identity(Led, distance, sign=-1)},
    ),
    Claim(
        id="hydromechanics 49 (22)",
        statement=r"F(X + Yi) = \frac{Fy_3 - Gx_3 + i\sqrt{X_3}}{\sqrt{F^2 - x_3^2}}\,e^{\psi i}",
        domain=f"{_ROOM}; {_AXIS}; off the axis; sqrt(X3) = x1 y2 - x2 y1 as in (9), psi as in (14), "
        "(15)",
        method=f"F (X + Y i) = (R y)_Y - i (R y)_X in Euler's angles; exact expansion. {_ORBIT}",
        verdict=Verdict.FALSE,
        correction=r"F(X + Yi) = \frac{Gx_3 - Fy_3 + i\sqrt{X_3}}{\sqrt{F^2 - x_3^2}}\,e^{\psi i}",
        counterexample="theta = pi/2, phi = psi = 0, y = (0, 0, 1), F = 1: R y = -Y, so that X = -1, Y = "
        "0; the right side as transcribed is +1",
        check=lambda: worse(identity(Angles, complex_place)(), place()),
        transcribed=identity(Angles, complex_place, sign=1),
        mutants={
            "as transcribed, along the trajectory": partial(place, sign=1),
            "e^(-psi i)": identity(Angles, complex_place, conjugate=True),
            "- i sqrt(X3)": identity(Angles, complex_place, root=-1),
        },
        remark="As transcribed it would be right with psi counted from the opposite direction and the "
        "other sign of sqrt(X3), against (9).",
    ),
    Claim(
        id="hydromechanics 49 centre from (22)",
        statement=r"\text{the motion of the centre may then be inferred from (22)}",
        domain=f"the motion of (27)-(29); {_AXIS}",
        method="|X + Y i| from (22) is that of (21) with either sign, its direction is not; exact "
        "expansion",
        verdict=Verdict.ONLY_IF,
        condition="(22) is corrected; as transcribed it gives the right distance in a wrong direction",
        correction=r"F(X + Yi) = \frac{Gx_3 - Fy_3 + i\sqrt{X_3}}{\sqrt{F^2 - x_3^2}}\,e^{\psi i}",
        counterexample="as for (22)",
        check=identity(Angles, complex_place),
        transcribed=identity(Angles, complex_place, sign=1),
        mutants={"e^(-psi i)": identity(Angles, complex_place, conjugate=True)},
    ),
)
