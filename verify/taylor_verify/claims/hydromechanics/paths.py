"""49 (18), (19), (22) and (27) along trajectories that carry attitude and origin.

Both start with Z along F. The trajectories come from R' = R [Omega]x and c' = R U alone, apart from what
keeps R x constant; Euler's angles are read off the elements of R.
"""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from typing import Any, Final

from mpmath import mp

from taylor_verify.claims.setting import Equations, Numeric
from taylor_verify.claims.trajectory import DIGITS, trajectory
from taylor_verify.exact.rotation import rotation_matrix
from taylor_verify.scenes import tensors
from taylor_verify.scenes.bodies import Clebsch
from taylor_verify.scenes.motion import Impulse, Quaternion
from taylor_verify.scenes.tensors import Vector

_WHY: Final = (
    "along a trajectory settled to 60 digits, relative; ten are granted for what the quotients lose"
)
_TIMES: Final = tuple(Fraction(k, 4) for k in range(1, 9))


def _vector(*entries: Fraction | int | str) -> Vector:
    return tuple(Fraction(entry) for entry in entries)


def _rows(body: Clebsch, start: Impulse, *track: str) -> Iterator[dict[str, Any]]:
    """The components of x and y, R and what else is tracked, at each time."""
    motion = trajectory(body.body(), start, _TIMES, track=frozenset(track))
    for x, y, *tracked in zip(*(motion[name] for name in (*_IMPULSES, *track)), strict=True):
        components = dict(zip(("x1", "x2", "x3", "y1", "y2", "y3"), (*x, *y), strict=True))
        R = tracked[0]
        # R13 + i R23 = -i sin(theta) e^(i psi)
        exponential = 1j * (R[0, 2] + 1j * R[1, 2])
        yield components | dict(zip(track, tracked, strict=True)) | {"exponential": exponential}


_IMPULSES: Final = ("linear_impulse", "angular_impulse")

# The third row of R that this quaternion makes is x/F = (12, 20, 9)/25.
_TURN: Final[Quaternion] = (Fraction(1), Fraction(2), Fraction(2), Fraction(4))
_BODY: Final = Clebsch(*_vector("3/100", "1/50", "1/30", "1/20", "2/5", "1/4"))
_LINEAR, _ANGULAR = _vector(12, 20, 9), _vector(3, 9, -4)
_F: Final = Fraction(25)


def _central() -> Iterator[dict[str, Any]]:
    """The origin of space on the central axis: X and Y by (18) and the corrected (19) at the start."""
    first, second, _ = rotation_matrix(_TURN)
    centre = (tensors.dot(second, _ANGULAR) / _F, -tensors.dot(first, _ANGULAR) / _F, Fraction(0))
    start = Impulse(_LINEAR, _ANGULAR, _TURN, centre)
    F, y3 = mp.convert(_F), mp.convert(_ANGULAR[2])
    constants = {"F": F, "y3": y3, "G": mp.fdot(_LINEAR, _ANGULAR) / F, "i": mp.mpc(0, 1)}
    for row in _rows(_BODY, start, "attitude", "centre"):
        X, Y, _ = row["centre"]
        across = mp.sqrt(F**2 - row["x3"] ** 2)
        yield row | constants | {"X": X, "Y": Y, "across": across, "size": F * mp.hypot(X, Y)}


# (22); (18) is its real part. Then (19).
place: Final = Numeric(_central, DIGITS + 10, 1e-50, _WHY)(
    "(F*(X + i*Y) - ((G*x3 - F*y3) + i*(x1*y2 - x2*y1)) / across * (exponential*F/across)) / size = 0",
    "(F*Y - (-attitude[0, 0]*y1 - (attitude[0, 1]*y2 + attitude[0, 2]*y3))) / size = 0",
)

# a = 17, b = -44, for which x = tan(theta/2) = 2 is a root of the corrected X2; F = 1, G = (a + b)/2
# and y3 = (a - b)/2.
_R: Final = Fraction(1, 100)
_SWINGING: Final = Clebsch(
    p=1 + _R * (Fraction(27, 2) ** 2 + Fraction(61, 2) ** 2),
    p_prime=Fraction(1),
    q=Fraction(0),
    q_prime=Fraction(0),
    r=_R,
    r_prime=Fraction(1, 50),
)
_SWING_START: Final = Impulse(
    linear=_vector("4/5", 0, "-3/5"),
    angular=_vector(6, 0, "61/2"),
    attitude=(Fraction(1), Fraction(0), Fraction(-2), Fraction(0)),
)


def _swinging() -> Iterator[dict[str, Any]]:
    """x, X1 and X2 now and at the start, the product of their roots, and e^(i psi) over its start."""
    a, b = 17, -44
    for row in _rows(_SWINGING, _SWING_START, "attitude"):
        sine = mp.hypot(row["x1"], row["x2"])
        x = sine / (1 + row["x3"])
        symbols = {"x": x, "i": 1j, "turned": row["exponential"] / sine / -1j}
        for z, end in ((x, ""), (mp.mpf(2), "_start")):
            even, odd = a * z**4 + 3 * (a + b) * z**2 + b, 2 * a * z**3 + 2 * b * z
            symbols |= {f"X1{end}": odd - even, f"X2{end}": odd + even}
        # x3 = (1 - x^2)/(1 + x^2), so that 4 x x'/r = -(1 + x^2)^2 (dx3/dt)/r.
        across = row["x1"] * row["y2"] - row["x2"] * row["y1"]
        yield symbols | {
            "product": -((1 + x**2) ** 2) * across,
            "relative": lambda a, b: (a - b) / b,
        }


def algebraic_path(X1: str = "X1", X2: str = "X2") -> Equations:
    """The square of (27), in which the product of the roots is 4 F x x'/r, at each time over the start.

    sqrt(X1) sqrt(X2) has the sign of dx/dt. The names are interchanged in what is transcribed.
    """
    return Numeric(_swinging, DIGITS + 10, 1e-50, _WHY)(
        f"relative((9*{X1}_start - {X2}_start) * (x/2)**3 * turned**3,"
        f" (x + 1)**2 * {X1} - (x - 1)**2 * {X2} + 2*i*(x**2 - 1)*product) = 0"
    )
