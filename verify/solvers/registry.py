"""The solvers that the command line knows by name."""

from __future__ import annotations

from difflib import get_close_matches
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from verify.solvers.solver import Solver

NAMES = ("taylor",)
# A solver of one's own: what follows is the command that starts it.
PROCESS = "process:"


def solver_named(name: str) -> Solver:
    """The solver of that name; ValueError lists the names there are."""
    if name.startswith(PROCESS):
        from verify.solvers.process import named

        return named(name)
    if name not in NAMES:
        raise ValueError(unknown_solver(name))
    # heyoka takes a fifth of a second to import, and only a run needs it.
    from verify.solvers.taylor.driver import Taylor

    return Taylor()


def check_name(name: str) -> None:
    """Raise the ValueError of `solver_named`; nothing heavy is imported for it."""
    if name not in NAMES:
        solver_named(name)


def unknown_solver(name: str) -> str:
    """What to say about a name that is no solver."""
    near = get_close_matches(name, NAMES, n=1)
    hint = f"; did you mean {near[0]}?" if near else ""
    return f"expected a solver ({', '.join(NAMES)}, {PROCESS}COMMAND), got {name!r}{hint}"
