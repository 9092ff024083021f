"""Trajectories with attitude and origin, and along them 49 (8), (17), (18), (19), (22) and (27).

All start with Z along F. The trajectories come from R' = R [Omega]x and c' = R U alone, apart from what
keeps R x constant; Euler's angles are read off the elements of R.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import astuple
from fractions import Fraction
from typing import Any, Final

from mpmath import mp

from taylor_verify.numbers import tensors
from taylor_verify.numbers.rotation import rotation_matrix
from taylor_verify.numbers.tensors import Vector
from taylor_verify.scenes.bodies import Clebsch
from taylor_verify.scenes.motion import Impulse, Quaternion
from taylor_verify_reports.claims.hydromechanics.clebsch import COEFFICIENTS, QUARTIC
from taylor_verify_reports.claims.setting import Equations, Numeric
from taylor_verify_reports.claims.trajectory import DIGITS, trajectory

_WHY: Final = (
    "along a trajectory settled to 60 digits, relative; ten are granted for what the quotients lose"
)
_TIMES: Final = tuple(Fraction(k, 4) for k in range(1, 9))


def _vector(*entries: Fraction | int | str) -> Vector:
    return tuple(Fraction(entry) for entry in entries)


_IMPULSES: Final = ("linear_impulse", "angular_impulse")


def _rows(body: Clebsch, start: Impulse, *track: str) -> Iterator[dict[str, Any]]:
    """Yield the components of x and y, and what else is tracked, R among it, at each time."""
    motion = trajectory(body.body(), start, _TIMES, track=frozenset(track))
    for x, y, R, *centre in zip(*(motion[name] for name in (*_IMPULSES, *track)), strict=True):
        components = dict(zip(("x1", "x2", "x3", "y1", "y2", "y3"), (*x, *y), strict=True))
        yield components | {"i": 1j, "R": R, "centre": centre, "exponential": _exponential(R)}


def _exponential(R: Any) -> Any:
    """sin(theta) e^(i psi): R13 + i R23 is -i times it."""
    return 1j * (R[0, 2] + 1j * R[1, 2])


# The third row of R that this quaternion makes is x/F = (12, 20, 9)/25. T > 0: q^2 < p r.
_TURN: Final[Quaternion] = (Fraction(1), Fraction(2), Fraction(2), Fraction(4))
_BODY: Final = Clebsch(*_vector("3/100", "1/50", "1/30", "1/20", "2/5", "1/4"))
_LINEAR, _ANGULAR = _vector(12, 20, 9), _vector(3, 9, -4)
_F: Final = Fraction(25)


def _central() -> Iterator[dict[str, Any]]:
    """Yield the rows where X and Y are by (18) and the corrected (19) at the start."""
    first, second, _ = rotation_matrix(_TURN)
    centre = (tensors.dot(second, _ANGULAR) / _F, -tensors.dot(first, _ANGULAR) / _F, Fraction(0))
    start = Impulse(_LINEAR, _ANGULAR, _TURN, centre)
    F, y3 = mp.convert(_F), mp.convert(_ANGULAR[2])
    constants = {"F": F, "y3": y3, "G": mp.fdot(_LINEAR, _ANGULAR) / F}
    for row in _rows(_BODY, start, "attitude", "centre"):
        ((X, Y, _),) = row["centre"]
        across = mp.sqrt(F**2 - row["x3"] ** 2)
        yield row | constants | {"X": X, "Y": Y, "across": across, "size": F * mp.hypot(X, Y)}


# (22); (18) is its real part. Then (19).
place: Final = Numeric(_central, DIGITS + 10, 1e-50, _WHY)(
    "(F*(X + i*Y) - ((G*x3 - F*y3) + i*(x1*y2 - x2*y1)) / across * (exponential*F/across)) / size = 0",
    "(F*Y - (-R[0, 0]*y1 - (R[0, 1]*y2 + R[0, 2]*y3))) / size = 0",
)

_DIGITS: Final = 40


def _stretch() -> Iterator[dict[str, Any]]:
    """Yield the constants of the motion, and of a stretch between two times the length and the angle psi.

    Between these times x3 only rises, and sqrt(X3) stays positive; ``integral`` is that of a function of x3
    over sqrt(X3).
    """
    times = (Fraction(1), Fraction(7, 5))
    start = Impulse(_LINEAR, _ANGULAR, _TURN)
    motion = trajectory(_BODY.body(), start, times, _DIGITS, frozenset({"attitude"}))
    x, y = ([mp.convert(v) for v in vector] for vector in (_LINEAR, _ANGULAR))
    six = {name: mp.convert(c) for name, c in zip(COEFFICIENTS, astuple(_BODY), strict=True)}
    p, pp, q, qq, r, _ = six.values()
    F, y3 = mp.sqrt(mp.fdot(x, x)), y[2]
    G = mp.fdot(x, y) / F
    # (6) at the start, in which nothing cancels.
    m1 = r * (y[0] ** 2 + y[1] ** 2) - (p - pp) * x[2] ** 2 - 2 * (q - qq) * x[2] * y3
    quartic = eval(QUARTIC, dict(six))
    ends = [row[2] for row in motion["linear_impulse"]]
    first, last = map(_exponential, motion["attitude"])

    def integral(function: Callable[[Any], Any]) -> Any:
        return mp.quad(lambda z: function(z) / mp.sqrt(quartic(z, F, G, y3, m1)), ends)

    stretch = {"turned": mp.arg(last / first), "elapsed": mp.convert(times[1] - times[0])}
    yield six | stretch | {"F": F, "G": G, "y3": y3, "integral": integral}


_SUMS: Final = (
    "quadrature of forty digits of a smooth integrand against a trajectory settled to forty; five digits "
    "are granted for what the sums lose"
)
# (8), and (17).
elapsed_time: Final = Numeric(_stretch, _DIGITS + 5, 1e-35, f"relative; {_SUMS}")(
    "integral(lambda z: 1 / r) / elapsed = 1"
)
angle_advance: Final = Numeric(_stretch, _DIGITS + 5, 1e-35, f"radians; {_SUMS}")(
    "turned - q*F*elapsed = integral(lambda z: (F*G - z*y3) / (F**2 - z**2) * F)"
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
    """Yield x, X1 and X2 now and at the start, the product of their roots, and e^(i psi) over its start."""
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
