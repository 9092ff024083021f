"""The solvers that the command line knows by name."""

from __future__ import annotations

from difflib import get_close_matches
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from verify.solvers.solver import Solver

NAMES = ("taylor",)


def solver_named(name: str) -> Solver:
    """The solver of that name; ValueError lists the names there are."""
    if name not in NAMES:
        raise ValueError(unknown_solver(name))
    # heyoka takes a fifth of a second to import, and only a run needs it.
    from verify.solvers.taylor.driver import Taylor

    return Taylor()


def unknown_solver(name: str) -> str:
    """What to say about a name that is no solver."""
    near = get_close_matches(name, NAMES, n=1)
    hint = f"; did you mean {near[0]}?" if near else ""
    return f"expected a solver ({', '.join(NAMES)}), got {name!r}{hint}"
