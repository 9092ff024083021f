"""The answer of a solver: its outcome, and the states of the body as exact numbers."""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from enum import Enum
from fractions import Fraction
from functools import cached_property
from itertools import chain
from typing import Any, Final

import numpy as np
from mpmath import mp

from taylor_verify import types
from taylor_verify.models.evaluated import wheels
from taylor_verify.models.form import labelled
from taylor_verify.models.frame import rotation
from taylor_verify.models.own import in_form
from taylor_verify.models.problem import Problem
from taylor_verify.models.registry import mechanics
from taylor_verify.models.written import unit_of
from taylor_verify.numbers import tensors
from taylor_verify.numbers.precision import Rung, exact_value, held_exactly
from taylor_verify.records.sampled import Sampled
from taylor_verify.scenes.instants import MOST_KEPT
from taylor_verify.scenes.motion import Motion
from taylor_verify.scenes.mpfr import precision, to_mpf, to_mpfr

_NATIVE: Final = {"f32": np.float32, "f64": np.float64}


class Outcome(Enum):
    """The end of a run; the value is the sentence that is shown."""

    FINISHED = "reached the last sample"
    NON_FINITE = "stopped: a state or derivative was not finite"
    STEP_LIMIT = "stopped: the bound on the number of steps was reached"
    INTERRUPTED = "stopped before the last sample"
    NOT_REPRESENTABLE = "not started: the rung cannot hold the scene"
    MISSHAPEN = "answered with an array of the wrong shape"
    RAISED = "ended with an error"
    NOT_STARTED = "could not be started"
    NO_PACKAGE = "not started: a package is missing"
    NO_FORMAT = "not started: this machine lacks the number format"
    UNSUITED = "not started: the solver does not run on it here"
    TIMED_OUT = "was stopped: the time limit was reached"
    CRASHED = "ended by a signal or with an exit status other than 0"
    MISANSWERED = "claimed success, but its answer is not what was asked for"

    @property
    def is_unavailable(self) -> bool:
        """True if nothing was run, by no fault of the solver."""
        return self in (Outcome.NO_PACKAGE, Outcome.NO_FORMAT, Outcome.UNSUITED)


class ByRows(Mapping[str, np.ndarray[Any, Any]]):
    """Quantities that are formed when some of their rows are read; ``count`` is the number of all rows."""

    count: int

    @abstractmethod
    def rows(self, places: Sequence[int]) -> dict[str, np.ndarray[Any, Any]]:
        """Return the quantities in some rows."""

    def __getitem__(self, quantity: str) -> np.ndarray[Any, Any]:
        return self.rows(range(self.count))[quantity]

    def __contains__(self, quantity: object) -> bool:
        return any(quantity == name for name in self)

    def __len__(self) -> int:
        return sum(1 for _ in self)


class Postponed(ByRows):
    """The quantities of a trajectory, formed from a solver's ``states`` when they are read.

    ``exact`` converts a number of the solver to a rational. For a long answer only the rows that are read
    are formed, and none is stored.
    """

    def __init__(
        self,
        problem: Problem,
        rows: Sequence[Sequence[Any]] | np.ndarray[Any, Any],
        exact: Callable[[Any], Fraction],
    ) -> None:
        self._problem, self.states, self.exact = problem, rows, exact
        self.count = len(rows)

    def rows(self, places: Sequence[int]) -> dict[str, np.ndarray[Any, Any]]:
        if self.count > MOST_KEPT:
            return self._made(places)
        return {name: rows[list(places)] for name, rows in self._formed.items()}

    @cached_property
    def _formed(self) -> dict[str, np.ndarray[Any, Any]]:
        return self._made(range(self.count))

    def _made(self, places: Sequence[int]) -> dict[str, np.ndarray[Any, Any]]:
        exact, rows = self.exact, self.states
        times = [self._problem.times[k] for k in places]
        return from_scaled(self._problem, [[exact(v) for v in rows[k]] for k in places], times)

    def __getitem__(self, quantity: str) -> np.ndarray[Any, Any]:
        return self._formed[quantity]

    def __iter__(self) -> Iterator[str]:
        return iter(_names(self._problem))

    def __reduce__(self) -> tuple[Any, ...]:
        return dict, (self._formed,)


def rows_at(
    quantities: Mapping[str, np.ndarray[Any, Any]], places: Sequence[int]
) -> dict[str, np.ndarray[Any, Any]]:
    """Return the quantities of an answer in some rows."""
    if isinstance(quantities, ByRows):
        return quantities.rows(places)
    return {name: rows[list(places)] for name, rows in quantities.items()}


def native(
    quantities: Mapping[str, np.ndarray[Any, Any]], rung: Rung
) -> Mapping[str, np.ndarray[Any, Any]]:
    """Return the quantities in NumPy's own numbers of a rung; exact ones where it has none."""
    if rung.name not in _NATIVE or not quantities:
        return quantities
    count = (
        len(next(iter(quantities.values())))
        if not isinstance(quantities, ByRows)
        else quantities.count
    )
    blocks: dict[str, list[np.ndarray[Any, Any]]] = {name: [] for name in quantities}
    with np.errstate(over="ignore", under="ignore"):
        for begin in range(0, count, MOST_KEPT):
            places = range(begin, min(begin + MOST_KEPT, count))
            for name, rows in rows_at(quantities, places).items():
                blocks[name].append(rows.astype(_NATIVE[rung.name]))
    return {name: np.concatenate(parts) for name, parts in blocks.items()}


def motion_of(quantities: Mapping[str, np.ndarray[Any, Any]], bits: int) -> Motion:
    """Return the quantities of an answer as a Motion; ``bits`` is the precision of attitude matrices."""
    by_name = {k: v for k, v in quantities.items() if k != "quaternion"}
    if "quaternion" in quantities:
        with mp.workprec(bits):
            by_name["attitude"] = _rotations(quantities["quaternion"])
    samples = len(next(iter(by_name.values())))
    return Motion(by_name, np.array([mp.zero] * samples, dtype=object))


@dataclass(frozen=True, eq=False, repr=False)
class Trajectory(Sampled):
    """The answer of one solver to one problem.

    ``quantities`` maps ``omega``, ``linear_impulse``, ``angular_impulse``, ``centre`` (n, 3) and
    ``quaternion`` (n, 4; body to space, any sign, nearly unit) to object arrays of mpf that hold the
    solver's numbers exactly, one row per sample; empty unless the outcome is FINISHED. Those that `solve`
    returns are rounded to NumPy's float64 on f64, and to float32 on f32.
    ``evaluations`` counts derivatives of the whole state, ``seconds`` the propagation alone and
    ``compile_seconds`` what came before it. ``inner_seconds`` is the part of ``seconds`` that was
    spent in somebody else's compiled integrator, where that is told apart. A ``file`` is an answer of a
    user's function at times of its own, or by names: it is judged as a trajectory file is. The truth value
    of a trajectory is ``passed``.
    """

    outcome: Outcome
    quantities: Mapping[str, np.ndarray[Any, Any]] = field(default_factory=dict)
    detail: str = ""
    steps: int = 0
    evaluations: int = 0
    seconds: float = 0.0
    compile_seconds: float = 0.0
    inner_seconds: float | None = None
    file: types.TrajectoryFile | None = None
    times: Sequence[Fraction] = ()

    @property
    def passed(self) -> bool:
        """True if the solver reached the last sample. Whether its states are right, `run` says."""
        return self.outcome is Outcome.FINISHED

    @property
    def _remark(self) -> str:
        reason = f" ({self.detail})" if self.detail else ""
        return f", {self.outcome.value}{reason}"

    def motion(self, bits: int) -> Motion:
        """Return the answer as a Motion; ``bits`` is the precision of attitude matrices."""
        return motion_of(self.quantities, bits)


def of_rows(
    problem: Problem,
    rows: Sequence[Sequence[Any]],
    is_finite: Callable[[Any], bool] = math.isfinite,
    **work: Any,
) -> Trajectory:
    """Return the trajectory of states in the problem's own form and units, a row for each sample.

    NON_FINITE where a number of them is none. ``work`` are the counts and times of Trajectory.
    """
    if not all(is_finite(value) for row in rows for value in row):
        return Trajectory(Outcome.NON_FINITE, **work)
    exact = Postponed(problem, rows, exact_value)
    return Trajectory(Outcome.FINISHED, exact, **work)


def _rotations(quaternions: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    """Return the rotation matrices (n, 3, 3) of quaternions (n, 4) of any length, in the ambient precision.

    A quaternion of length zero is not an attitude: it gives NaN, which fails every gate.
    """
    columns = to_mpfr(quaternions).T
    with precision():
        matrices = np.array(rotation(list(columns)), dtype=object) / np.sum(columns**2, axis=0)
    return to_mpf(np.moveaxis(matrices, -1, 0))


def _names(problem: Problem) -> tuple[str, ...]:
    """Return the quantities that the states of a problem hold."""
    return tuple(group.name for group in problem.scene.groups)


def from_scaled(
    problem: Problem, rows: Sequence[Sequence[Fraction]], times: Sequence[Fraction] = ()
) -> dict[str, np.ndarray[Any, Any]]:
    """Return the quantities of states in the problem's own form and units, formed exactly.

    ``rows`` (n, states) stand in the order of ``problem.form.states``, a row for each sample, and the held
    values of the scene's own states behind them. ``times`` are theirs, and the problem's own if left out.

    omega = K H is a sum of products of dyadic numbers, so it is dyadic and held without rounding.
    """
    names = (*problem.form.states, *problem.held_names)
    columns: dict[str, Sequence[Fraction]]
    columns = dict(zip(names, zip(*rows, strict=True), strict=True))
    columns |= _without_wheels(problem, columns, times or problem.times)
    units, given = problem.units, problem.given
    kind = mechanics(given.body)
    for name in kind.states:
        if name not in columns:
            columns[name] = (problem.parameter.get(name, Fraction(0)),) * len(rows)
    parts = (_vectors(columns, part.name, units.of(part.dimension)) for part in kind.momenta)
    momenta = (tuple(chain.from_iterable(vectors)) for vectors in zip(*parts, strict=True))
    moving = list(map(kind.change(given.body).moving, momenta))
    quantities = {
        name: [vector[3 * k : 3 * k + 3] for vector in moving]
        for k, name in enumerate(given.initial.MOVING)
    }
    tracked = _names(problem)
    if "quaternion" in tracked:
        quantities["quaternion"] = list(zip(*(columns[f"e{i}"] for i in range(4)), strict=True))
    if "centre" in tracked:
        start = given.initial.parts()["centre"]
        quantities["centre"] = [
            tensors.plus(start, c) for c in _vectors(columns, "c", units.centre)
        ]
    quantities |= _own_states(problem, columns)
    return {
        name: np.array([[held_exactly(entry) for entry in row] for row in vectors], dtype=object)
        for name, vectors in quantities.items()
    }


def _own_states(
    problem: Problem, columns: Mapping[str, Sequence[Fraction]]
) -> dict[str, list[tuple[Fraction, ...]]]:
    """Return the tracked states of the scene's own, in its units."""
    loads = problem.given.body.loads
    if loads is None:
        return {}
    states: dict[str, list[tuple[Fraction, ...]]] = {}
    for state in loads.states:
        if state.name in problem.scene.states:
            parts = [
                [v * unit_of(name, loads, problem.units) for v in columns[in_form(name, loads)]]
                for name in state.components
            ]
            states[state.name] = list(zip(*parts, strict=True))
    return states


def _without_wheels(
    problem: Problem, columns: Mapping[str, Sequence[Fraction]], times: Sequence[Fraction]
) -> dict[str, list[Fraction]]:
    """Return the momentum of the body alone, where a text writes that of its wheels."""
    loads, units = problem.given.body.loads, problem.units
    if loads is None or not loads.rotor:
        return {}
    own = [
        [v * unit for v in columns[in_form(name, loads)]]
        for name, unit in zip(loads.continuous, units.own, strict=True)
    ]
    alone: list[list[Fraction]] = [[], [], []]
    for k, time in enumerate(times):
        values = tuple(component[k] for component in own)
        h = wheels(loads, time * units.time, values, problem.rung.bits)
        for i, entry in enumerate(h):
            alone[i].append(columns[f"H{i + 1}"][k] - entry / units.momentum)
    return labelled("H", alone)


def _vectors(
    columns: Mapping[str, Sequence[Fraction]], letter: str, unit: Fraction
) -> list[tensors.Vector]:
    triple = zip(*(columns[f"{letter}{i}"] for i in (1, 2, 3)), strict=True)
    return [tensors.scaled(unit, vector) for vector in triple]
