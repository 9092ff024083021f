"""Answers of a user's function: states at the scene's times, or a trajectory at times of its own.

array (samples, n)     states at the scene's times, in the order of the protocol
(t, y), OdeResult      at the scene's times likewise; at other times a trajectory of its own
a dense output         a function of time, such as SciPy's OdeSolution: it is sampled
anything else          an object that `check` takes: a dict of arrays, a table, a data set
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from taylor_verify.models.problem import Problem
from taylor_verify.records.faults import Refused, cut
from taylor_verify.solvers.files.file import TrajectoryFile
from taylor_verify.solvers.files.objects import trajectory
from taylor_verify.solvers.files.rotation_objects import bare
from taylor_verify.solvers.trajectory import Trajectory


class MisshapenAnswer(ValueError):
    """An answer that is no trajectory; the text says what was expected."""


class Unfinished(Exception):
    """The word of an integrator that it did not reach the end."""


class _Pair(NamedTuple):
    """Times and states, a row of ``y`` for each state, as an OdeResult has them."""

    t: Any
    y: Any


def answer_of(answered: Any, problem: Problem) -> Any:
    """Return states (samples, n), or a TrajectoryFile where the answer has names or times of its own.

    Raises MisshapenAnswer for what is neither, and Unfinished for a result without success.
    """
    if isinstance(answered, tuple) and len(answered) == 2 and np.ndim(answered[0]) == 1:
        answered = _pair(*answered)
    if _has_states(answered):
        return _of_result(answered, problem)
    if callable(answered):
        return _sampled(answered, problem)
    if isinstance(answered, Mapping | Trajectory) or _has_names(answered):
        return _file(answered, problem)
    _check_numbers(answered)
    return answered


def _has_names(answered: Any) -> bool:
    has_dtype_names = getattr(getattr(answered, "dtype", None), "names", None) is not None
    return hasattr(answered, "columns") or hasattr(answered, "data_vars") or has_dtype_names


def _has_states(answered: Any) -> bool:
    """Return True for SciPy's result, a dict itself; a data set may have variables t and y."""
    is_set = hasattr(answered, "data_vars") or not hasattr(answered, "t")
    return not is_set and getattr(getattr(answered, "y", None), "ndim", 0) == 2


def _pair(t: Any, y: Any) -> Any:
    """Return times and states with a row for each state, whichever way round they came."""
    times, states = np.asarray(t), np.asarray(y)
    if states.ndim != 2:
        return t, y
    along = [axis for axis in (0, 1) if states.shape[axis] == len(times)]
    if len(along) != 1:
        expected = f"(t, y) with y of shape ({len(times)}, n)"
        raise MisshapenAnswer(f"expected {expected}, got {states.shape} (hand over y alone)")
    return _Pair(times, states.T if along == [0] else states)


def _of_result(answered: Any, problem: Problem) -> Any:
    """Return the states of an OdeResult, or of times and states."""
    if getattr(answered, "success", True) is False:
        raise Unfinished(str(getattr(answered, "message", "the integrator did not succeed")))
    given = [float(time) for time in problem.given.clock.instants]
    if len(answered.t) == len(given) and np.array_equal(np.asarray(answered.t, float), given):
        return np.asarray(answered.y).T
    dense = getattr(answered, "sol", None)
    return _file(answered, problem) if dense is None else _sampled(dense, problem)


def _sampled(dense: Any, problem: Problem) -> Any:
    """Return a dense output at the scene's times."""
    return np.array([np.asarray(dense(float(t))) for t in problem.given.clock.instants])


def _file(answered: Any, problem: Problem) -> TrajectoryFile:
    """Return the trajectory of an object with names; a dict without times has those of the scene."""
    scene = problem.scene
    try:
        return trajectory(answered, scene)
    except (Refused, ValueError) as fault:
        if not isinstance(answered, Mapping) or "t" in answered:
            raise MisshapenAnswer(str(fault)) from None
        try:
            return trajectory({"t": [*problem.given.clock.instants], **answered}, scene)
        except (Refused, ValueError):
            raise MisshapenAnswer(str(fault)) from None


def _check_numbers(answered: Any) -> None:
    """Refuse masked numbers and a unit: NumPy drops a mask and a unit."""
    _, unit = bare(answered)
    if unit.strip("1 ") not in ("", "dimensionless"):
        mend = "a state has quantities of several units: return a dict of them"
        raise MisshapenAnswer(f"expected states without a unit, got {cut(unit)} ({mend})")
    rows = answered if isinstance(answered, list | tuple) else [answered]
    masks = [np.ma.getmaskarray(row) for row in rows if isinstance(row, np.ma.MaskedArray)]
    if masked := sum(int(np.sum(mask)) for mask in masks):
        raise MisshapenAnswer(f"expected states without a mask, got {masked} masked numbers")
