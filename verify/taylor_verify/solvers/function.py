"""A function of Python as a solver: `python:package.module:function?KEY=VALUE`.

The module is imported from the current folder too, as ``python -m`` does. Settings are handed over as
keyword arguments: ``?step=0.01`` is ``function(problem, step=0.01)``.
"""

from __future__ import annotations

import os
import sys
from functools import reduce
from importlib import import_module
from typing import Any, Final

from taylor_verify.records.faults import cut
from taylor_verify.solvers.callback import Callback
from taylor_verify.solvers.solver import Solver

PREFIX: Final = "python:"
_FORM: Final = "python:package.module:function"


def named(name: str) -> Solver:
    """Return the solver of a function; ValueError where there is none."""
    place, _, query = name.removeprefix(PREFIX).partition("?")
    module, _, attribute = place.partition(":")
    if not module or not attribute:
        raise ValueError(f"expected {_FORM}, got {cut(name)}")
    return solver_of(_looked_up(module, attribute), f"{PREFIX}{place}", query)


def solver_of(answer: Any, name: str, query: str = "") -> Solver:
    """Return the solver that a callable, or a Solver, is under a name; ValueError for anything else."""
    if isinstance(answer, Solver):
        return answer
    if not callable(answer):
        raise ValueError(f"expected a callable, got a {type(answer).__name__} @ {cut(name)}")
    pairs = [part.partition("=") for part in query.split("&") if part]
    if wrong := [key for key, _, value in pairs if not key.isidentifier() or not value]:
        raise ValueError(f"expected KEY=VALUE behind ?, got {cut(wrong[0])} @ {cut(name)}")
    settings = tuple((key, _number(value)) for key, _, value in pairs)
    return Callback(answer, "?".join(filter(None, (name, query))), settings)


def _looked_up(module: str, attribute: str) -> Any:
    try:
        return reduce(getattr, attribute.split("."), _imported(module))
    except Exception as error:  # importing runs a user's code
        reason = f"{type(error).__name__}: {error}"
        where = f"{module}:{attribute}, in the current folder too"
        raise ValueError(f"expected {_FORM} to be found, got {reason} @ {where}") from error


def _imported(module: str) -> Any:
    """Import a module; the current folder comes first for it, and last for all others."""
    folder = os.getcwd()
    sys.path.insert(0, folder)
    try:
        return import_module(module)
    finally:
        sys.path.remove(folder)
        if folder not in sys.path:
            sys.path.append(folder)


def _number(text: str) -> float | str:
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            continue
    return text
