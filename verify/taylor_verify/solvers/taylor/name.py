"""The names of heyoka's integrator, `taylor` and `taylor?tol=NUMBER`, read without loading heyoka."""

from __future__ import annotations

from fractions import Fraction
from typing import Final

from taylor_verify.solvers.options import options

TAYLOR: Final = "taylor"


def named_at(text: str) -> str:
    """The name of the integrator at a tolerance."""
    return f"{TAYLOR}?tol={text}"


def tolerance(name: str) -> Fraction | None:
    """The tolerance that is set in a name, exactly as written; None for the rung's own.

    Raises ValueError for a tolerance that is no positive number, and for a name of something else.
    """
    if name == TAYLOR:
        return None
    return options(name, [TAYLOR], ["tol"]).positive("tol", default="")
