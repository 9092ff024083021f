"""The solid of section 48 in exact symbols: all 21 coefficients of T, loads, attitude and origin.

x, y    impulses, body axes            vel = (U, V, W) = dT/dx, Omega = (P, Q, R) = dT/dy
force   (X, Y, Z), body axes           couple = (L, M, N), body axes
A, B, C T = x.A x/2 + x.B y + y.C y/2  c   the origin in space, c' = rot vel; r in body axes
rot     body to space, from the quaternion e of norm 1; rot' = rot [Omega]x
u       a direction fixed in space     line = (l, m, n) = rot^T u, in body axes
"""

from __future__ import annotations

from typing import Final

from taylor_verify_reports.claims.field import values
from taylor_verify_reports.claims.setting import QUATERNION, UNIT, Exact

_PLAIN: Final = tuple(f"{letter}{k}" for letter in ("x", "y", "c", "u") for k in "123")
_RATES: Final = tuple(f"{letter}{k}" for letter in ("dx", "dy") for k in "123")
_LOADS: Final = ("X", "Y", "Z", "L", "M", "N")
_COEFFICIENTS: Final = tuple(
    f"{matrix}{j}{k}" for matrix in "ABC" for j in "123" for k in "123" if matrix == "B" or j <= k
)

_KINEMATICS: Final = """
vel, Omega = A @ x + B @ y, B.T @ x + C @ y
(U, V, W), (P, Q, R) = vel, Omega
T = (x @ vel + y @ Omega) / 2
rot = rotation(e0, e1, e2, e3)
line, r = rot.T @ u, rot.T @ c
l, m, n = line
"""
_LOADED: Final = "force, couple = array([X, Y, Z]), array([L, M, N])"
_LAWS: Final = "dx, dy = cross(x, Omega) + force, cross(y, Omega) + cross(x, vel) + couple"
_TURN: Final = "turn(**quaternion_rates(e0, e1, e2, e3, Omega), x=dx, y=dy, c=rot @ vel)"


def _solid(extra: tuple[str, ...], *lines: str) -> Exact:
    point = {**QUATERNION, **values((*_PLAIN, *extra, *_COEFFICIENTS))}
    return Exact(point, "\n".join((_KINEMATICS, *lines, _TURN)), UNIT)


# Any motion at all: x' and y' are free symbols, so that laws can be compared before they hold.
unposed: Final = _solid((*_RATES, *_LOADS), _LOADED)
# A motion under force and couple, by (3) and (4).
loaded: Final = _solid(_LOADS, _LOADED, _LAWS)
# A motion without external force, by (3) and (4).
unloaded: Final = _solid((), "force = couple = 0 * x", _LAWS)
