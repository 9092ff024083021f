"""The names of heyoka's integrator: `taylor`, `taylor?tol=1e-9&code=optimised`."""

from __future__ import annotations

from fractions import Fraction
from typing import Final

from taylor_verify.solvers.options import Options, options
from taylor_verify.solvers.registry import TAYLOR
from taylor_verify.solvers.taylor.driver import Taylor

_SETTINGS: Final = ("tol", "code")
_OPTIMISED: Final = "optimised"


def named(name: str) -> Taylor:
    """Return the solver that such a name stands for; ValueError for any other name."""
    chosen = options(name, [TAYLOR], _SETTINGS)
    chosen.word("code", [_OPTIMISED])
    return Taylor(name, tolerance=_tolerance(name, chosen), is_optimised="code" in chosen)


def tolerance(name: str) -> Fraction | None:
    """Return the tolerance that is set in a name, exactly as written; None for the rung's own.

    Raises ValueError for a tolerance that is no positive number, and for a name of something else.
    """
    return _tolerance(name, options(name, [TAYLOR], _SETTINGS))


def _tolerance(name: str, chosen: Options) -> Fraction | None:
    if "tol" not in chosen and (name == TAYLOR or chosen.values):
        return None
    return chosen.positive("tol", default="")
