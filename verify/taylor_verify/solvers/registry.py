"""The solvers that the command line knows by name."""

from __future__ import annotations

from difflib import get_close_matches
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from taylor_verify.solvers.solver import Solver

TAYLOR = "taylor"
TAYLOR_AT = f"{TAYLOR}?"
# A solver of one's own: what follows is the command that starts it.
PROCESS = "process:"
GEOMETRIC = "geometric:"
SCIPY = "scipy:"
MPMATH = "mpmath:"
CLOSED_FORM = "closed-form:"
# Of other libraries, each in an environment of its own.
OUTSIDE = "outside:"
# A simulator in an FMU: what follows is its file.
FMU = "fmu:"
# The names there are, NUMBER standing for what is to be chosen.
NAMES = (
    TAYLOR,
    "taylor?tol=NUMBER",
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
    "mpmath:odefun?tol=NUMBER&degree=NUMBER",
    "closed-form:ellipj",
    "outside:cvode-adams?rtol=NUMBER&atol=NUMBER",
    "outside:cvode-bdf?rtol=NUMBER&atol=NUMBER",
    "outside:cyrk-dop853?rtol=NUMBER&atol=NUMBER",
    "outside:cyrk-tsit5?rtol=NUMBER&atol=NUMBER",
    "outside:cyrk-vern7?rtol=NUMBER&atol=NUMBER",
    "outside:cyrk-vern8?rtol=NUMBER&atol=NUMBER",
    "outside:cyrk-lsoda?rtol=NUMBER&atol=NUMBER",
    "outside:diffrax-tsit5?rtol=NUMBER&atol=NUMBER",
    "outside:diffrax-dopri8?rtol=NUMBER&atol=NUMBER",
    "outside:extensisq-pr7?rtol=NUMBER&atol=NUMBER",
    "outside:extensisq-pr8?rtol=NUMBER&atol=NUMBER",
    "outside:extensisq-pr9?rtol=NUMBER&atol=NUMBER",
    "outside:extensisq-swag?rtol=NUMBER&atol=NUMBER",
    "outside:rebound-bs?rtol=NUMBER&atol=NUMBER",
    "outside:numbalsoda-dop853?rtol=NUMBER&atol=NUMBER",
    "outside:numbalsoda-lsoda?rtol=NUMBER&atol=NUMBER",
    "fmu:FILE?step=NUMBER",
)


def solver_named(name: str) -> Solver:
    """The solver of that name; ValueError lists the names there are."""
    # A solver is imported when it is asked for: most bring a library with them.
    if name == TAYLOR or name.startswith(TAYLOR_AT):
        from taylor_verify.solvers.taylor import driver

        return driver.named(name)
    if name.startswith(PROCESS):
        from taylor_verify.solvers.process import process

        return process.named(name)
    if name.startswith(GEOMETRIC):
        from taylor_verify.solvers.geometric import methods

        return methods.named(name)
    if name.startswith(SCIPY):
        from taylor_verify.solvers import scipy

        return scipy.named(name)
    if name.startswith(MPMATH):
        from taylor_verify.solvers import odefun

        return odefun.named(name)
    if name.startswith(CLOSED_FORM):
        from taylor_verify.solvers import closed_form

        return closed_form.named(name)
    if name.startswith(OUTSIDE):
        from taylor_verify.solvers.entrants import entrant

        return entrant.named(name)
    if name.startswith(FMU):
        from taylor_verify.solvers.fmu import fmu

        return fmu.named(name)
    raise ValueError(unknown_solver(name))


def as_solver(solver: Solver | str) -> Solver:
    """Return a Solver as it is, and that of a name; ValueError for anything else."""
    from taylor_verify.scenes.reading.faults import brief
    from taylor_verify.solvers.solver import Solver

    if isinstance(solver, str):
        return solver_named(solver)
    if isinstance(solver, Solver):
        return solver
    mend = " (a callable is judged by taylor_verify.check)" if callable(solver) else ""
    raise ValueError(f"expected a Solver or the name of one, got {brief(solver)}{mend}")


def check_name(name: str) -> None:
    """Raise the ValueError of `solver_named`; nothing heavy is imported for it."""
    if name.startswith(TAYLOR_AT):
        from taylor_verify.solvers.taylor.name import tolerance

        tolerance(name)
    elif name != TAYLOR:
        solver_named(name)


def unknown_solver(name: str) -> str:
    """What to say about a name that is no solver."""
    families = [
        *(TAYLOR, f"{GEOMETRIC}METHOD?step=NUMBER", f"{SCIPY}METHOD", f"{MPMATH}odefun"),
        *(f"{CLOSED_FORM}ellipj", f"{OUTSIDE}LIBRARY-METHOD", f"{PROCESS}COMMAND"),
        f"{FMU}FILE?step=NUMBER",
    ]
    near = get_close_matches(name, NAMES, n=1)
    hint = f"; did you mean {near[0]}?" if near else ""
    return f"expected a solver ({', '.join(families)}), got {name!r}{hint}"
