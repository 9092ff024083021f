"""Student's distribution: how far a mean of few values may be from the true one."""

from __future__ import annotations

from functools import cache
from math import sqrt, tan


@cache
def student(freedom: int, level: float) -> float:
    """Return the t for which Student's variable is between -t and t with probability ``level``."""
    import mpmath

    def excess(theta: mpmath.mpf) -> mpmath.mpf:
        within = mpmath.betainc(0.5, freedom / 2, 0, mpmath.sin(theta) ** 2, regularized=True)
        return within - level

    with mpmath.workprec(53):
        # With t = sqrt(freedom) tan(theta) the root lies in a bounded interval of theta.
        return sqrt(freedom) * tan(mpmath.findroot(excess, (0, mpmath.pi / 2), solver="bisect"))
