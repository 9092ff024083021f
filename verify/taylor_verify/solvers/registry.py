"""The solvers that the command line knows by name: a line of `FAMILIES` for each kind."""

from __future__ import annotations

from collections.abc import Callable
from difflib import get_close_matches
from importlib import import_module
from importlib.util import find_spec
from itertools import chain
from typing import TYPE_CHECKING, Any, NamedTuple, cast

from taylor_verify.records.plugins import Plugin, free

if TYPE_CHECKING:
    from taylor_verify.solvers.solver import Solver

TAYLOR = "taylor"
# A user's program: the command that starts it follows.
PROCESS = "process:"
# Solvers of other libraries, each in its own environment.
OUTSIDE = "outside:"
# A function of Python.
PYTHON = "python:"


class Family(NamedTuple):
    """Solvers whose names begin alike, and the module in solvers whose ``named(name)`` makes one.

    ``form`` is what a message calls them. ``names`` has NUMBER for what is to be chosen, and is None
    where the module says by ``usages()`` what there is, and by ``remarks()`` what each of them is.
    ``package`` is the package that they need, and ``extra`` brings it.
    """

    prefix: str
    module: str
    form: str
    names: tuple[str, ...] | None = ()
    package: str = ""
    extra: str = ""


_GEOMETRIC = "implicit-midpoint splitting moser-veselov preprocessed-moser-veselov lie-rk4"
_SCIPY = "RK45 DOP853 Radau BDF LSODA"
_TAYLOR = (TAYLOR, "taylor?tol=NUMBER", "taylor?code=optimised")
_STEPPED = tuple(f"geometric:{method}?step=NUMBER" for method in _GEOMETRIC.split())
_TOLERANT = tuple(f"scipy:{method}?rtol=NUMBER&atol=NUMBER" for method in _SCIPY.split())
_ODEFUN = ("mpmath:odefun?tol=NUMBER&degree=NUMBER",)

FAMILIES = (
    Family("taylor?", "taylor.settings", TAYLOR, _TAYLOR, "heyoka", "taylor"),
    Family("geometric:", "geometric.methods", "geometric:METHOD?step=NUMBER", _STEPPED),
    Family("scipy:", "scipy", "scipy:METHOD", _TOLERANT, "scipy", "scipy"),
    Family("mpmath:", "odefun", "mpmath:odefun", _ODEFUN),
    Family(OUTSIDE, "engines.engine", "outside:LIBRARY-METHOD", None),
    Family(PROCESS, "process.process", "process:COMMAND"),
    Family(PYTHON, "function", "python:package.module:function"),
)


def solver_names() -> tuple[str, ...]:
    """Return the names to choose from, NUMBER standing for what is to be chosen."""
    names = (
        _module(family).usages() if family.names is None else family.names for family in FAMILIES
    )
    return (*chain.from_iterable(names), *(plugin.name for plugin in _plugged()))


def remarks() -> dict[str, str]:
    """Return remarks on names: a title, or why it is unavailable; nothing heavy is imported for it."""
    by_name: dict[str, str] = {}
    for family in FAMILIES:
        if family.names is None:
            by_name |= _module(family).remarks()
        elif family.package and find_spec(family.package) is None:
            install = f"unavailable: pip install 'taylor-verify[{family.extra}]'"
            by_name |= dict.fromkeys(family.names, install)
    return by_name | {plugin.name: plugin.origin for plugin in _plugged()}


def solver_named(name: str) -> Solver:
    """Return the solver of that name; ValueError lists the names there are."""
    for family in FAMILIES:
        if f"{name}?".startswith(family.prefix):
            return cast("Solver", _module(family).named(name))
    word, _, query = name.partition("?")
    for plugin in _plugged():
        if plugin.name == word:
            from taylor_verify.solvers.function import solver_of

            return solver_of(plugin.content, word, query)
    forms = ", ".join(family.form for family in FAMILIES)
    near = get_close_matches(name, solver_names(), n=1)
    hint = f"; did you mean {near[0]}?" if near else ""
    raise ValueError(f"expected a solver ({forms}), got {name!r}{hint}")


def _plugged() -> list[Plugin]:
    """Return the solvers of other packages whose names are not those of a family."""
    words = (family.prefix.rstrip("?:") for family in FAMILIES)
    return free("solvers", lambda plugin: iter((plugin.name.partition(":")[0],)), words)


def _module(family: Family) -> Any:
    # A solver is imported when it is asked for: most bring a library with them.
    return import_module(f"taylor_verify.solvers.{family.module}")


def as_solver(solver: Solver | Callable[..., Any] | str) -> Solver:
    """Return a Solver as it is, and that of a name or of a callable; ValueError for anything else."""
    from taylor_verify.records.faults import brief
    from taylor_verify.solvers.callback import Callback
    from taylor_verify.solvers.solver import Solver

    if isinstance(solver, str):
        return solver_named(solver)
    if isinstance(solver, Solver):
        return solver
    if callable(solver):
        return Callback.of(solver)
    raise ValueError(f"expected a Solver, the name of one or a callable, got {brief(solver)}")
