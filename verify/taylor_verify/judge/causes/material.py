"""Data on which every hypothesis is tested: rows of an answer, and the defects from each row to the next.

    defect = z_k+1 - flow(z_k)

where flow is the exact motion over the same time. A limited number of evenly chosen pairs of rows
represents all rows. Everything is float64, so defects near its roundoff get no cause here.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Final

import numpy as np

from taylor_verify.judge.causes.equations import Equations
from taylor_verify.judge.causes.flow import Floats, flow
from taylor_verify.records.answers import LikelyCause
from taylor_verify.records.verdict import Verdict
from taylor_verify.scenes.instants import evenly

Places = np.ndarray[Any, np.dtype[np.intp]]

# Number of evenly chosen pairs of rows that represent all; a single pair may agree by chance.
_MOST_PAIRS: Final = 24
FEWEST_PAIRS: Final = 2
# Bound of the errors of float64 and of the series of the flow, relative to the state.
_NOISE: Final = 64 * 2.0**-53


@dataclass(frozen=True)
class Candidate:
    """A tested hypothesis: the part of the error that it ``leaves``, and its count of ``fitted`` numbers.

    If a candidate ``is_sure``, no hypothesis about the dynamics is needed.
    """

    name: str
    quantity: str
    leaves: float
    why: str
    fitted: int = 0
    is_sure: bool = False

    def cause(self) -> LikelyCause:
        """Return the candidate as a likely cause."""
        share = f"this explains {100 * (1 - self.leaves):.3g} % of the error of {self.quantity}"
        sentence = f"{self.name}: {self.why}; {share}"
        return LikelyCause(self.name, self.quantity, self.leaves, sentence)


@dataclass(frozen=True)
class Material:
    """An answer in body axes as float64, with NaN in rows that are not finite.

    ``start`` and ``start_attitude`` are the scene's initial state, ``elapsed`` the times since then.
    ``states`` (n, d) are omega, or x and y; NaN if the answer lacks them. ``quaternions`` (n, 4) are of
    unit length, body to space; None if the answer has no attitude. ``columns`` are the states as written
    in a file, in any axes; None if they equal ``states``. ``digits`` is the number of decimals in the file,
    ``bits`` the precision of the arithmetic, ``failed`` the verdicts of states that failed.
    """

    equations: Equations
    start: Floats
    start_attitude: Floats
    elapsed: Floats
    states: Floats
    quaternions: Floats | None = None
    columns: Floats | None = None
    digits: int | None = None
    bits: int = 53
    failed: Mapping[str, Verdict] = field(default_factory=dict)

    @property
    def quantity(self) -> str:
        """Name of the quantity that the states belong to."""
        return "omega" if self.equations.is_rigid else "impulse"

    @cached_property
    def places(self) -> Places:
        """Indices of the first rows of the compared pairs."""
        known = (
            self.states if self.quaternions is None else np.hstack([self.states, self.quaternions])
        )
        finite = np.flatnonzero(np.all(np.isfinite(known), axis=1))
        first: Places = finite[:-1][np.diff(finite) == 1]
        return first[np.array(evenly(len(first), _MOST_PAIRS))] if len(first) else first

    def at(self, first: Places) -> Pairs:
        """Return the pairs of rows that begin at these places."""
        second, q = first + 1, self.quaternions
        turned = () if q is None else (q[first], q[second])
        spans = self.elapsed[second] - self.elapsed[first]
        return Pairs(self.equations, self.states[first], self.states[second], spans, *turned)

    @cached_property
    def pairs(self) -> Pairs:
        return self.at(self.places)

    @cached_property
    def is_telling(self) -> bool:
        """Return True if the defects are far above the errors of float64 and of printed digits."""
        if len(self.places) < FEWEST_PAIRS:
            return False
        printed = 0.0 if self.digits is None else 10.0 ** (1 - self.digits)
        return _NOISE + printed < self.pairs.largest < np.inf

    @property
    def start_row(self) -> int | None:
        """Index of the row at the start, if there is one."""
        rows = np.flatnonzero(self.elapsed == 0)
        return int(rows[0]) if len(rows) else None

    @property
    def start_error(self) -> float | None:
        """Error of the row at the start, relative to the scene's state; None without such a row."""
        row, size = self.start_row, float(np.linalg.norm(self.start))
        if row is None or not size > 0:
            return None
        return float(np.linalg.norm(self.states[row] - self.start)) / size

    def candidate(self, name: str, why: str, states: Floats, fitted: int = 0) -> Candidate:
        """Return a hypothesis by which the pairs of rows end in these ``states``."""
        return Candidate(name, self.quantity, self.pairs.left(states), why, fitted)

    def tried(self, hypotheses: Sequence[tuple[str, str, Equations]]) -> Iterator[Candidate]:
        """Yield a candidate for each hypothesis: its name, the reason in words, its equations."""
        if hypotheses:
            moved = self.pairs.moved([equations for *_, equations in hypotheses])
            for (name, why, _), states in zip(hypotheses, moved, strict=True):
                yield self.candidate(name, why, states)


@dataclass(frozen=True)
class Pairs:
    """States and quaternions of some rows and of the rows after them, and the time between."""

    equations: Equations
    begin: Floats
    end: Floats
    spans: Floats
    turned: Floats | None = None
    turned_end: Floats | None = None

    @cached_property
    def sizes(self) -> Floats:
        """Size of every component: the largest |omega|, or the largest |x| and |y|."""
        vectors = np.stack([self.begin, self.end]).reshape(-1, len(self.begin[0]) // 3, 3)
        largest = np.max(np.linalg.norm(vectors, axis=2), axis=0)
        return np.repeat(np.where(largest > 0, largest, 1.0), 3)

    @cached_property
    def flow(self) -> Floats:
        """Exact states at the second row of every pair."""
        exact: Floats = self.moved([self.equations])[0]
        return exact

    @cached_property
    def defect(self) -> Floats:
        return self.end - self.flow

    @cached_property
    def largest(self) -> float:
        """Largest defect, relative to the size of its vector; infinite for NaN."""
        return self.size(self.defect)

    def moved(self, equations: Sequence[Equations]) -> Floats:
        """Return the states (m, n, d) after the spans by each of these equations."""
        begin = np.column_stack([self.begin, np.ones(len(self.begin))])
        maps = np.stack([hypothesis.map for hypothesis in equations])
        return flow(maps, begin, self.spans, np.append(self.sizes, np.inf))[:, :, :-1]

    def size(self, rows: Floats) -> float:
        """Return the largest vector of rows, relative to its typical size; infinite for NaN."""
        vectors = (rows / self.sizes).reshape(len(rows), -1, 3)
        largest = float(np.max(np.linalg.norm(vectors, axis=2)))
        return largest if np.isfinite(largest) else np.inf

    def left(self, states: Floats) -> float:
        """Return the part of the largest defect that remains if the motion leads to these states."""
        return self.size(self.end - states) / self.largest if self.largest > 0 else np.inf
