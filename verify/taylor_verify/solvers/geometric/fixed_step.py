"""Fixed steps to each sample, with a body in float64: the part that all geometric integrators share.

H  angular momentum, body axes        K  inverse inertia tensor, omega = K H
r  momentum of wheels, not part of H
M  constant moment, body axes         q  attitude quaternion, body to space
d  damping, -d H in the rate of H     h  step

All is in the problem's own units, powers of two in which K, H and the rates are of size one. The
equations are autonomous, so no time is ever summed up.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import pairwise
from math import ceil
from time import perf_counter
from typing import Any, ClassVar, Final, NamedTuple, Self

import numpy as np

from taylor_verify.models.problem import Problem
from taylor_verify.numbers.precision import Rung
from taylor_verify.solvers.between_switches import piece_by_piece
from taylor_verify.solvers.geometric.kicks import Kicks, Unreached
from taylor_verify.solvers.geometric.vectors import (
    Matrix,
    Quaternion,
    Vector,
    conjugate,
    into,
    product,
)
from taylor_verify.solvers.solver import Solver, float64_alone, made_without
from taylor_verify.solvers.trajectory import Outcome, Trajectory, of_rows

# At some ten microseconds a step these take a quarter of an hour: more is not begun.
_MOST_STEPS: Final = 10**8


class Unsolved(Exception):
    """The error for an implicit step whose equation could not be solved."""


class Stepped(NamedTuple):
    """The momentum after a step, the trace that the frame's turn is made from, and the step's cost.

    ``evaluations`` counts the angular velocities formed, each a derivative of the whole state.
    """

    H: Vector
    trace: Any
    evaluations: int


Step = Callable[[Vector], Stepped]


@dataclass(frozen=True)
class Body:
    """A problem's body in float64; r is the momentum of its wheels, d its damping."""

    K: Matrix
    M: Vector
    r: Vector = (0.0, 0.0, 0.0)
    d: float = 0.0

    @classmethod
    def of(cls, problem: Problem) -> Self:
        named = problem.parameter

        def entry(i: int, j: int) -> float:
            return float(named.get(f"K{min(i, j)}{max(i, j)}", 0))

        K1, K2, K3 = ((entry(i, 1), entry(i, 2), entry(i, 3)) for i in (1, 2, 3))
        M1, M2, M3 = (float(named.get(f"M{i}", 0)) for i in (1, 2, 3))
        r1, r2, r3 = (float(named.get(f"r{i}", 0)) for i in (1, 2, 3))
        return cls((K1, K2, K3), (M1, M2, M3), (r1, r2, r3), float(named.get("d", 0)))

    @property
    def is_diagonal(self) -> bool:
        (_, a, b), (_, _, c), _ = self.K
        return a == b == c == 0


@dataclass(frozen=True)
class FixedStep(Solver):
    """A method for Euler's equations: equal steps, not longer than ``step``, from sample to sample.

    ``step`` is in the scene's unit of time. The attitude is followed only where it is tracked.
    """

    step: Fraction
    name: str
    counts_steps = True

    # What may act on a body besides its energy, by the names of `acting`.
    takes: ClassVar[tuple[str, ...]] = ()
    in_principal_axes: ClassVar[bool] = False

    @abstractmethod
    def stepping(self, body: Body, H: Vector, h: float) -> Step:
        """Return the map of one step h of a motion that has the momentum H."""

    @abstractmethod
    def turn(self, trace: Any) -> Quaternion:
        """Return the turn of the frame in one step, as seen from the frame."""

    def unavailable(self, rung: Rung) -> str:
        return float64_alone(self.name, rung)

    def unsuited(self, problem: Problem) -> str:
        if reason := super().unsuited(problem):
            return reason
        if problem.given.model != "euler":
            return f"{self.name} is made for Euler's equations, got {problem.given.model}"
        return made_without(self.name, problem.given.body, self.takes)

    def solve(self, problem: Problem) -> Trajectory:
        if reason := self.unsuited(problem) or self.unavailable(problem.rung):
            return Trajectory(Outcome.NOT_STARTED, detail=reason)
        return piece_by_piece(problem, self._solve)

    def _solve(self, problem: Problem) -> Trajectory:
        spans, unit = _spans(problem.begin, problem.times), problem.units.time / self.step
        # Times that were rounded may be slightly longer than a multiple of the step.
        little = 2 * problem.rung.unit_roundoff * max(map(abs, problem.times))
        counts = [ceil((abs(span) - little) * unit) for span in spans]
        if not sum(counts) <= _MOST_STEPS:
            detail = f"{float(sum(counts)):.3g} steps, more than {float(_MOST_STEPS):.3g}"
            return Trajectory(Outcome.STEP_LIMIT, detail=detail)
        run = _Run(self)
        began = perf_counter()
        try:
            rows = run.rows(problem, spans, counts)
        except (Unsolved, Unreached) as error:
            return run.ended(Outcome.INTERRUPTED, began, str(error))
        except (ArithmeticError, ValueError):
            # Python's floats raise where those of NumPy are no number: sin(inf), 1/0.
            return run.ended(Outcome.NON_FINITE, began)
        ended = run.ended(Outcome.FINISHED, began)
        trajectory = of_rows(problem, rows)
        return replace(ended, outcome=trajectory.outcome, quantities=trajectory.quantities)


class _Run:
    """A run, its steps and evaluations counted."""

    def __init__(self, solver: FixedStep) -> None:
        self.solver = solver
        self.steps = self.evaluations = 0

    def ended(self, outcome: Outcome, began: float, detail: str = "") -> Trajectory:
        return Trajectory(
            outcome,
            detail=detail,
            steps=self.steps,
            evaluations=self.evaluations,
            seconds=perf_counter() - began,
        )

    def rows(
        self, problem: Problem, spans: Sequence[Fraction], counts: Sequence[int]
    ) -> list[list[float]]:
        """Return H and, where it is tracked, q at the samples, so many steps in each span."""
        body = Body.of(problem)
        start = [float(value) for value in problem.initial_momenta]
        H: Vector = (start[0], start[1], start[2])
        q: Quaternion | None = (start[3], start[4], start[5], start[6]) if start[3:] else None
        axes = None
        if self.solver.in_principal_axes and not body.is_diagonal:
            body, axes = principal(body)
            H, q = into(axes, H), q and product(q, axes)
        rows = []
        kicks = None if problem.given.body.loads is None else Kicks(problem, body.K, axes)
        begin = float(problem.begin)
        for span, count, end in zip(spans, counts, problem.times, strict=True):
            if count:
                h = float(span / count)
                if kicks is None:
                    H, q = self._to_sample(body, H, q, h, count)
                else:
                    H, q = self._kicked(kicks, body, H, q, begin, h, count)
            begin = float(end)
            rows.append([*H, *(q or ())] if axes is None else _out_of(axes, H, q))
        return rows

    def _kicked(
        self,
        kicks: Kicks,
        body: Body,
        H: Vector,
        q: Quaternion | None,
        t: float,
        h: float,
        count: int,
    ) -> tuple[Vector, Quaternion | None]:
        """Return momentum and attitude after so many steps between kicks, from t on."""
        for k in range(count):
            H = kicks.before(t + k * h, H, q, h)
            H, q = self._to_sample(body, H, q, h, 1)
            H = kicks.after(t + (k + 1) * h, H, q, h)
        self.evaluations += kicks.evaluations
        kicks.evaluations = 0
        return H, q

    def _to_sample(
        self, body: Body, H: Vector, q: Quaternion | None, h: float, count: int
    ) -> tuple[Vector, Quaternion | None]:
        step = self.solver.stepping(body, H, h)
        for _ in range(count):
            H, trace, evaluations = step(H)
            if q is not None:
                q = product(q, self.solver.turn(trace))
            self.steps += 1
            self.evaluations += evaluations
        return H, q


def _spans(begin: Fraction, times: Sequence[Fraction]) -> list[Fraction]:
    """Return the times from the start, which is not always a sample, and from sample to sample."""
    return [after - before for before, after in pairwise((begin, *times))]


def principal(body: Body) -> tuple[Body, Quaternion]:
    """Return the body in its principal axes, and the turn that takes those to the body's own.

    They come from an eigenvalue problem in float64: the body that is then followed differs from the
    problem's by some units of roundoff of its largest entry.
    """
    values, vectors = np.linalg.eigh(np.array(body.K))
    if np.linalg.det(vectors) < 0:
        vectors[:, 0] = -vectors[:, 0]
    k1, k2, k3 = (float(value) for value in values)
    K = ((k1, 0.0, 0.0), (0.0, k2, 0.0), (0.0, 0.0, k3))
    axes = _quaternion(vectors)
    return Body(K, (0.0, 0.0, 0.0), into(axes, body.r)), axes


def _quaternion(R: np.ndarray[Any, Any]) -> Quaternion:
    """Return the unit quaternion of a rotation: q q^T is linear in R, and its longest column is q."""
    (a, b, c), (d, e, f), (g, h, i) = R
    columns = 0.25 * np.array(
        [
            [1 + a + e + i, h - f, c - g, d - b],
            [h - f, 1 + a - e - i, b + d, c + g],
            [c - g, b + d, 1 - a + e - i, f + h],
            [d - b, c + g, f + h, 1 - a - e + i],
        ]
    )
    longest = columns[:, int(np.argmax(np.diag(columns)))]
    q0, q1, q2, q3 = (float(value) for value in longest / np.linalg.norm(longest))
    return (q0, q1, q2, q3)


def _out_of(axes: Quaternion, H: Vector, q: Quaternion | None) -> list[float]:
    """Return momentum and attitude of principal axes in those of the body."""
    back = conjugate(axes)
    return [*into(back, H), *(product(q, back) if q else ())]
