"""Data that every hypothesis is tried on: rows of an answer, and its defects from each row to the next.

    defect = z_k+1 - flow(z_k)

with flow the exact motion over the same time. A bounded number of pairs of rows, evenly chosen, stands
for all. All is float64, so that defects near its roundoff have no cause here.
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

# So many pairs of rows, evenly chosen, stand for all; a single pair may agree by chance.
_MOST_PAIRS: Final = 24
FEWEST_PAIRS: Final = 2
# Float64 and the series of the flow are off by less than so many roundoffs of the state.
_NOISE: Final = 64 * 2.0**-53


@dataclass(frozen=True)
class Candidate:
    """A hypothesis that was tried: the part of the error that it ``leaves``, and its ``fitted`` numbers.

    Beside one that ``is_sure`` no hypothesis about the dynamics is needed.
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
    """An answer in body axes as float64, with NaN in rows that are no numbers.

    ``start`` and ``start_attitude`` are the scene's own initial state, ``elapsed`` the times since then.
    ``states`` (n, d) are omega, or x and y; NaN if the answer lacks them. ``quaternions`` (n, 4) are of
    unit length, body to space; None if the answer has no attitude. ``columns`` are the states as a file
    has them, in whatever axes; None if they are the states. ``digits`` is the number of decimals
    that a file is written with, ``bits`` those of the arithmetic, ``failed`` the verdicts of states that
    failed.
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
        """The name of the states' quantity."""
        return "omega" if self.equations.is_rigid else "impulse"

    @cached_property
    def places(self) -> Places:
        """The first rows of the pairs that are compared."""
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
        """Return True if the defects of the states are far above what float64 and printing leave."""
        if len(self.places) < FEWEST_PAIRS:
            return False
        printed = 0.0 if self.digits is None else 10.0 ** (1 - self.digits)
        return _NOISE + printed < self.pairs.largest < np.inf

    @property
    def start_row(self) -> int | None:
        """The row at the start, if there is one."""
        rows = np.flatnonzero(self.elapsed == 0)
        return int(rows[0]) if len(rows) else None

    @property
    def start_error(self) -> float | None:
        """The error of the row at the start, relative to the scene's state; None without such a row."""
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
        """The size of every component: the largest |omega|, or |x| and |y| apart."""
        vectors = np.stack([self.begin, self.end]).reshape(-1, len(self.begin[0]) // 3, 3)
        largest = np.max(np.linalg.norm(vectors, axis=2), axis=0)
        return np.repeat(np.where(largest > 0, largest, 1.0), 3)

    @cached_property
    def flow(self) -> Floats:
        """The exact states at the second row of every pair."""
        exact: Floats = self.moved([self.equations])[0]
        return exact

    @cached_property
    def defect(self) -> Floats:
        return self.end - self.flow

    @cached_property
    def largest(self) -> float:
        """The largest defect, relative to the size of its vector; infinite if it is no number."""
        return self.size(self.defect)

    def moved(self, equations: Sequence[Equations]) -> Floats:
        """Return the states (m, n, d) after the spans by each of these equations."""
        begin = np.column_stack([self.begin, np.ones(len(self.begin))])
        maps = np.stack([one.map for one in equations])
        return flow(maps, begin, self.spans, np.append(self.sizes, np.inf))[:, :, :-1]

    def size(self, rows: Floats) -> float:
        """Return the largest vector of rows, relative to its usual size; infinite if it is no number."""
        vectors = (rows / self.sizes).reshape(len(rows), -1, 3)
        largest = float(np.max(np.linalg.norm(vectors, axis=2)))
        return largest if np.isfinite(largest) else np.inf

    def left(self, states: Floats) -> float:
        """Return the part of the largest defect that is left if the motion leads to these states."""
        return self.size(self.end - states) / self.largest if self.largest > 0 else np.inf
