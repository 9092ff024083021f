"""The equations of motion as quadratic forms with exact coefficients.

Each kind of body writes its own from the texts; they share nothing with models. What cancels in exact
coefficients is gone: a vector that stays zero for a whole body is disturbed by no rounding.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any, NamedTuple

import numpy as np

from taylor_verify.exact.clocks import Exact, Floats, standing, swing
from taylor_verify.scenes.manufactured import Manufactured
from taylor_verify.scenes.tensors import Matrix, Vector


class Scaled(NamedTuple):
    """Equations in units, as float64."""

    constant: Floats
    linear: Floats
    hessian: Floats
    spin: Floats
    velocity: Floats


class Equations(NamedTuple):
    """z' = ``constant`` + ``linear`` z + z.``hessian`` z/2, with Omega = ``spin`` z and U = ``velocity`` z.

    The shapes are (n,), (n, n), (n, n, n), symmetric in the last two places, and (3, n); ``velocity`` has
    no rows for a rigid body.
    """

    constant: Exact
    linear: Exact
    hessian: Exact
    spin: Exact
    velocity: Exact

    def minus(self, other: Equations) -> Equations:
        """The difference, entry by entry."""
        return Equations(*(one - two for one, two in zip(self, other, strict=True)))

    def damped(self, damping: Fraction) -> Equations:
        """The equations with -c z more."""
        if not damping:
            return self
        decay = np.diag([damping] * len(self.constant)) + nothing(len(self.constant))
        return self._replace(linear=self.linear - decay)

    def driven(self, motion: Manufactured | None) -> Equations:
        """The equations without linear terms, and with the loads and the clock of a manufactured motion.

        z' = N(z) + z*' - N(z*) with z* = S w and w' = W w for the clock w. Its first variable is 1, which
        makes a product of what is linear; without a motion it is the only one, and absent where no term
        is linear.
        """
        if motion is None and not self.linear.any():
            return self
        d = len(self.constant)
        S, W = swing(motion or standing(d))
        n = d + len(W)
        hessian = np.full((n, n, n), Fraction(0), dtype=object)
        hessian[:d, :d, :d] = self.hessian
        hessian[:d, d:, d:] = -(S.T @ self.hessian @ S)
        hessian[:d, d, :d] += self.linear
        hessian[:d, :d, d] += self.linear
        loads = np.concatenate([S @ W - self.linear @ S, W])
        hessian[:, d, d:] += loads
        hessian[:, d:, d] += loads
        more = np.full((3, len(W)), Fraction(0), dtype=object)
        spin, velocity = (
            np.hstack([form, more[: len(form)]]) for form in (self.spin, self.velocity)
        )
        constant = np.concatenate([self.constant, more[0]])
        return Equations(constant, nothing(n), hessian, spin, velocity)

    def scaled(self, units: Vector, time: Fraction, length: Fraction) -> Scaled:
        """The equations with z in ``units``, one for each component; the centre goes by lengths."""
        one = np.array(units, dtype=object)
        rates = time / one
        return Scaled(
            (self.constant * rates).astype(float),
            (self.linear * np.outer(rates, one)).astype(float),
            (self.hessian * np.multiply.outer(rates, np.outer(one, one))).astype(float),
            (self.spin * one * time).astype(float),
            (self.velocity * one * (time / length)).astype(float),
        )


def exact(rows: Sequence[Any]) -> Exact:
    """The array of a vector or a matrix."""
    return np.array(rows, dtype=object)


def nothing(n: int) -> Exact:
    """The linear part of equations that have none."""
    return np.full((n, n), Fraction(0), dtype=object)


def cross(left: Matrix, right: Matrix) -> Exact:
    """The second derivatives of (left z) x (right z), two linear forms of z with three rows each."""
    one, other = exact(left), exact(right)
    pairs = ((1, 2), (2, 0), (0, 1))
    products = [np.outer(one[j], other[k]) - np.outer(one[k], other[j]) for j, k in pairs]
    return exact([product + product.T for product in products])
