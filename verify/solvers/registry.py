"""The solvers that the command line knows by name."""

from __future__ import annotations

from difflib import get_close_matches
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from verify.solvers.solver import Solver

TAYLOR = "taylor"
# A solver of one's own: what follows is the command that starts it.
PROCESS = "process:"
GEOMETRIC = "geometric:"
SCIPY = "scipy:"
# The names there are, NUMBER standing for what is to be chosen.
NAMES = (
    TAYLOR,
    "geometric:implicit-midpoint?step=NUMBER",
    "geometric:splitting?step=NUMBER",
    "geometric:moser-veselov?step=NUMBER",
    "geometric:preprocessed-moser-veselov?step=NUMBER",
    "geometric:lie-rk4?step=NUMBER",
    "scipy:RK45?rtol=NUMBER&atol=NUMBER",
    "scipy:DOP853?rtol=NUMBER&atol=NUMBER",
    "scipy:Radau?rtol=NUMBER&atol=NUMBER",
    "scipy:BDF?rtol=NUMBER&atol=NUMBER",
    "scipy:LSODA?rtol=NUMBER&atol=NUMBER",
)


def solver_named(name: str) -> Solver:
    """The solver of that name; ValueError lists the names there are."""
    # Each is imported for itself: heyoka alone takes a fifth of a second, and only a run needs it.
    if name == TAYLOR:
        from verify.solvers.taylor.driver import Taylor

        return Taylor()
    if name.startswith(PROCESS):
        from verify.solvers import process

        return process.named(name)
    if name.startswith(GEOMETRIC):
        from verify.solvers.geometric import methods

        return methods.named(name)
    if name.startswith(SCIPY):
        from verify.solvers import scipy

        return scipy.named(name)
    raise ValueError(unknown_solver(name))


def check_name(name: str) -> None:
    """Raise the ValueError of `solver_named`; nothing heavy is imported for it."""
    if name != TAYLOR:
        solver_named(name)


def unknown_solver(name: str) -> str:
    """What to say about a name that is no solver."""
    families = [TAYLOR, f"{GEOMETRIC}METHOD?step=NUMBER", f"{SCIPY}METHOD", f"{PROCESS}COMMAND"]
    near = get_close_matches(name, NAMES, n=1)
    hint = f"; did you mean {near[0]}?" if near else ""
    return f"expected a solver ({', '.join(families)}), got {name!r}{hint}"
