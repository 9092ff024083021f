"""The poles of a solid's motion in complex time, with tests for single-valued solutions there.

z' = v(z) is homogeneous quadratic, so that z = c/(t - t*) + ... with v(c) = -c. A solution near it may
differ by terms (t - t*)^(rho - 1), rho the eigenvalues of Dv(c) + 1 (Kowalevski's exponents): one that
is no integer makes t* a branch point of the general solution.
"""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from taylor_verify.scenes.bodies import ImmersedBody
from taylor_verify_reports.claims.check import Residual

Complex = np.ndarray[Any, np.dtype[np.complex128]]

_STARTS: Final = 12
_STEPS: Final = 60
_SINGULAR: Final = 1e10
_FOUND: Final = 1e-13
_BOUND: Final = 1e-10


def branching(body: ImmersedBody) -> Residual:
    """The largest distance of an exponent from the integers, over the poles that are found."""
    distances = []
    for c in leading_coefficients(body):
        exponents = np.linalg.eigvals(jacobian(_energy(body), c) + np.eye(6))
        distances.append(float(np.max(np.abs(exponents - np.round(exponents.real)))))
    return Residual(
        max(distances, default=float("nan")),
        _BOUND,
        "distance of Kowalevski's exponents from the integers, as eigenvalues in doubles; a million "
        "roundoffs are granted",
    )


def _energy(body: ImmersedBody) -> Any:
    return np.array(body.energy_matrix, dtype=float)


def leading_coefficients(body: ImmersedBody) -> list[Complex]:
    """Some c != 0 with v(c) = -c, by Newton's rule from starts that are the same every time.

    The rule stops where the matrix is singular, as it is at members of a family; what it has reached
    is kept if it solves the equations.
    """
    energy = _energy(body)
    random = np.random.default_rng(1)
    solutions: list[Complex] = []
    for _ in range(_STARTS):
        with np.errstate(all="ignore"):  # what is not finite ends the rule
            c = _newton(energy, random.normal(size=6) + 1j * random.normal(size=6))
        size = float(np.linalg.norm(c))
        if 1e-6 < size < 1e6 and np.linalg.norm(_rates(energy, c) + c) <= _FOUND * size**2:
            solutions.append(c)
    return solutions


def _newton(energy: Any, c: Complex) -> Complex:
    for _ in range(_STEPS):
        slope = jacobian(energy, c) + np.eye(6)
        if not np.all(np.isfinite(slope)) or np.linalg.cond(slope) > _SINGULAR:
            break
        c = c - np.linalg.solve(slope, _rates(energy, c) + c)
    return c


def _rates(energy: Any, z: Complex) -> Complex:
    x, y = z[:3], z[3:]
    velocity = energy @ z
    U, Omega = velocity[:3], velocity[3:]
    return np.concatenate([np.cross(x, Omega), np.cross(y, Omega) + np.cross(x, U)])


def jacobian(energy: Any, z: Complex) -> Complex:
    """Dv(z): v is quadratic, so that v(z + d) - v(z - d) = 2 Dv(z) d without error."""
    columns = [(_rates(energy, z + d) - _rates(energy, z - d)) / 2 for d in np.eye(6)]
    return np.stack(columns, axis=1)
