"""An answer as material: float64 rows in the scene's conventions, and the truth beside them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import comb
from typing import Any, Final

import numpy as np

from taylor_verify.judge.causes.budget import Budget
from taylor_verify.judge.causes.changed_equations import Equations
from taylor_verify.judge.causes.many_flows import Floats, flow
from taylor_verify.judge.causes.quaternion_rows import (
    angles,
    of_rotation_vectors,
    product,
    rotation_vectors,
)
from taylor_verify.scenes.instants import evenly
from taylor_verify.scenes.scene import Scene

Places = np.ndarray[Any, np.dtype[np.intp]]

_ROUNDOFF: Final = 2.0**-53
# Rounding of a whole row: errors of three components, of the truth and of the arithmetic of the search.
VECTOR: Final = 3.0
ATTITUDE: Final = 4.0
# A quantity is wrong if its error is this many times the rounding of the file.
_WRONG: Final = 30.0
# The search itself is no better.
_ARITHMETIC: Final = 1e-12
# A path is another one if it is off by more than this part of the error, and of the reach.
_OFF_PATH: Final = 1e-3
_NO_PATH: Final = 1e-6
# A start is the scene's up to so many roundings, or so much of the scatter of the first rows.
_SAME_START: Final = 10.0
_FIRST_ROWS: Final = 24
_NOISY: Final = 1.7


# A function from equations, begins, their times and spans to the ends of arcs.
Stepping = Callable[[Equations, Floats, Floats, Floats], Floats]


@dataclass(frozen=True)
class Motion:
    """States at the times of an answer: ``v`` (rows, n), ``q`` (rows, 4) and ``c`` (rows, 3)."""

    v: Floats
    q: Floats | None = None
    c: Floats | None = None

    def at(self, rows: Any) -> Motion:
        q, c = (None if part is None else part[rows] for part in (self.q, self.c))
        return Motion(self.v[rows], q, c)

    def signed_as(self, first: Floats) -> Motion:
        """Return the motion with the signs of the attitudes such that the first is near to this one."""
        return self if self.q is None or self.q[0] @ first >= 0 else replace(self, q=-self.q)

    def before(self, other: Motion) -> Motion:
        """Return the rows with those of another motion behind them, and its quantities."""
        v, q, c = (
            None if part is None or own is None else np.concatenate([own, part])
            for own, part in ((self.v, other.v), (self.q, other.q), (self.c, other.c))
        )
        assert v is not None
        return Motion(v, q, c)


@dataclass(frozen=True)
class Answer:
    """Rows of an answer, in the order away from the start, and the exact ``truth`` at the same times.

    ``start`` has one row: nu (omega, or U and W), the attitude and the centre. ``noise`` is half a unit of
    the last digit of each component of v, of the attitude and of the centre.
    ``begins`` is the time of the start; ``places`` are the rows of the file, from 0, that these are.
    ``scene`` is the rounded question. Without ``has_rates`` omega is that of the file's own attitudes, and
    is no quantity of the file. With ``stepping`` the arcs go in steps of a method, as the simulator's did.
    """

    right: Equations
    start: Motion
    times: Floats
    file: Motion
    truth: Motion
    noise: tuple[Floats, float, float]
    quantities: tuple[str, ...]
    budget: Budget
    places: Places
    own_attitudes: Floats | None = None
    begins: float = 0.0
    scene: Scene | None = None
    has_rates: bool = True
    stepping: Stepping | None = None

    @property
    def off(self) -> float:
        """The largest error of the moving part."""
        return max(self.worst[group] for group in self.groups)

    @property
    def has_states(self) -> bool:
        """True if the scene has states of its own, which no row of the search has."""
        loads = None if self.scene is None else self.scene.body.loads
        return loads is not None and bool(loads.states or any(loads.rotor))

    @property
    def n(self) -> int:
        return self.right.size

    @property
    def count(self) -> int:
        return len(self.times)

    @property
    def stride(self) -> int:
        """Rows of the file from one row to the next; negative if the file begins at its end."""
        return int(self.places[1] - self.places[0])

    @property
    def spacing(self) -> float:
        """The median time from a row to the next."""
        return float(np.median(np.abs(np.diff(self.times))))

    @cached_property
    def sizes(self) -> Floats:
        """The largest vector of the truth, for each component of v."""
        vectors = self.truth.v.reshape(self.count, -1, 3)
        largest = np.max(np.linalg.norm(vectors, axis=2), axis=0)
        return np.repeat(np.where(largest > 0, largest, 1.0), 3)

    @cached_property
    def rounding(self) -> Floats:
        """Noise of each component of v relative to its vector."""
        return np.asarray(np.maximum(self.noise[0] / self.sizes, 8 * _ROUNDOFF))

    @cached_property
    def groups(self) -> dict[str, slice]:
        """The vectors of v by name."""
        if self.n == 3:
            return {"omega": slice(0, 3)}
        names = ("x", "y") if self.right.has_momenta else ("velocity", "omega")
        return dict(zip(names, (slice(0, 3), slice(3, 6)), strict=True))

    def quantity(self, group: str) -> str:
        """Return the quantity of the verdicts that a group belongs to."""
        return "impulse" if self.n == 6 and group in self.groups else group

    def rows(self, motion: Motion, group: str) -> Floats:
        """Return the rows of a group of vectors, of the attitude or of the centre, which a motion has."""
        frame = {"attitude": motion.q, "centre": motion.c}
        rows = frame[group] if group in frame else motion.v[:, self.groups[group]]
        assert rows is not None
        return rows

    def errors(self, motion: Motion) -> dict[str, Floats]:
        """Return the errors of the rows against a motion: relative ones of v, angles, distances."""
        errors = {
            name: np.linalg.norm(self.file.v[:, part] - motion.v[:, part], axis=1)
            / self.sizes[part][0]
            for name, part in self.groups.items()
        }
        if self.file.q is not None and motion.q is not None:
            errors["attitude"] = angles(self.file.q, motion.q)
        if self.file.c is not None and motion.c is not None:
            errors["centre"] = np.linalg.norm(self.file.c - motion.c, axis=1)
        return errors

    @cached_property
    def error(self) -> dict[str, Floats]:
        """The errors of the rows against the truth."""
        return self.errors(self.truth)

    @cached_property
    def worst(self) -> dict[str, float]:
        return {name: float(np.max(error)) for name, error in self.error.items()}

    @cached_property
    def roundings(self) -> dict[str, float]:
        """The error of a row by the rounding of the file alone."""
        own = {
            name: VECTOR * float(np.max(self.rounding[part])) for name, part in self.groups.items()
        }
        return {
            **own,
            "attitude": ATTITUDE * max(self.noise[1], 1e-15),
            "centre": VECTOR * max(self.noise[2], 1e-14 * self.reach),
        }

    @cached_property
    def reach(self) -> float:
        """The largest distance of the centre from the origin, at least 1."""
        return 1.0 if self.truth.c is None else max(1.0, float(np.max(np.abs(self.truth.c))))

    @cached_property
    def failed(self) -> tuple[str, ...]:
        """The groups that failed by far more than the rounding of the file."""
        return tuple(
            name
            for name, error in self.error.items()
            if self.quantity(name) in self.quantities
            and np.max(error) > max(_WRONG * self.roundings[name], _ARITHMETIC)
        )

    @property
    def moving(self) -> tuple[str, ...]:
        """The failed vectors of v."""
        return tuple(name for name in self.failed if name in self.groups)

    def leaves(self, motion: Motion) -> dict[str, float]:
        """Return the part of each failed group's error that a motion leaves, where the motion has it."""
        return self.parts(self.errors(motion))

    def is_path(self, errors: Mapping[str, Floats]) -> bool:
        """Return True if the path is about that of a motion with these errors, where both have one.

        The momenta and the attitude of a free body do not tell all of its coefficients, as the path does.
        """
        off = errors.get("centre", np.zeros(1))
        least = max(_NO_PATH * self.reach, _WRONG * self.roundings.get("centre", 0.0))
        return float(np.max(off)) <= max(_OFF_PATH * self.worst.get("centre", 0.0), least)

    def parts(self, errors: Mapping[str, Floats]) -> dict[str, float]:
        """Return the largest errors of the failed groups as parts of those of the answer."""
        return {
            name: float(np.max(errors[name])) / self.worst[name]
            for name in self.failed
            if name in errors
        }

    def floor(self, groups: Sequence[str]) -> float:
        """Return the rounding of the file as a part of the error of the worst of these groups."""
        return max(self.roundings[name] / self.worst[name] for name in groups)

    def at(self, rows: Any) -> Answer:
        """Return some of the rows."""
        own = self.attitudes if self.right.coupled > self.n else None
        return replace(
            self,
            times=self.times[rows],
            places=self.places[rows],
            file=self.file.at(rows),
            truth=self.truth.at(rows),
            own_attitudes=None if own is None else own[rows],
        )

    def thinned(self, most: int) -> Answer:
        """Return at most so many rows, spread evenly."""
        return self if self.count <= most else self.at(np.array(evenly(self.count, most)))

    def begun_at(self, row: int) -> Answer:
        """Return the rows from one on, with this row of the file as the start."""
        part = self.at(np.s_[row:])
        nu = velocities_of(self.right, part.file.v[:1])
        q = self.attitudes[row : row + 1]
        c = part.start.c if part.file.c is None else part.file.c[:1]
        return replace(part, start=Motion(nu, q, c), begins=float(self.times[row]))

    def states(self, count: int, rows: Any = np.s_[:]) -> Floats:
        """Return some of the file's rows with so many components, (rows, components).

        Components that the file has not are its own attitudes (see ``attitudes``) and the true centre.
        """
        parts = [self.file.v[rows]]
        if count > self.n:
            parts.append(self.attitudes[rows])
        if count > self.n + 4:
            centres = self.truth.c if self.file.c is None else self.file.c
            assert centres is not None
            parts.append(centres[rows])
        return np.hstack(parts)

    @property
    def is_from_start(self) -> bool:
        """True if the first row is at the start."""
        return bool(self.times[0] == self.begins)

    def with_start(self, mass: Floats) -> Answer:
        """Return the answer of a body with this mass matrix, with the start as a row before the first."""
        if self.is_from_start:
            return self
        start = replace(self.start, v=self.first(mass)[None])
        return replace(
            self,
            times=np.concatenate([[self.begins], self.times]),
            places=np.concatenate([[self.places[0] - self.stride], self.places]),
            file=start.before(self.file),
            truth=start.before(self.truth),
            own_attitudes=None,
        )

    @property
    def writes_momenta(self) -> bool:
        """True if the scene writes the momenta of its start."""
        return self.n == 6 and not (self.scene and self.scene.writes_velocities)

    @cached_property
    def keeps_momenta(self) -> bool:
        """True if another body starts with the scene's momenta, and not with its velocities."""
        if not self.is_from_start:
            return self.writes_momenta
        nu = self.start.v[0]
        if self.right.has_momenta:
            off = np.abs(self.file.v[0] - self.right.mass @ nu) / self.sizes
            return bool(np.all(off <= _SAME_START * self.rounding))
        off = np.linalg.norm(((self.file.v[0] - nu) / self.sizes).reshape(-1, 3), axis=1)
        noise = np.maximum([self.roundings[name] for name in self.groups], self._scatter)
        return bool(np.any(off > _SAME_START * noise))

    @property
    def _scatter(self) -> float:
        """The scatter of the first rows, as a part of the motion's size; 0 where they are smooth.

        Differences of sixth order of noise are larger than those of fifth, which a motion does not make.
        """
        rows = (self.file.v - self.truth.v)[:_FIRST_ROWS] / self.sizes
        if len(rows) < _FIRST_ROWS:
            return 0.0
        fifth, sixth = (float(np.sqrt(np.mean(np.diff(rows, k, axis=0) ** 2))) for k in (5, 6))
        return sixth / comb(12, 6) ** 0.5 if sixth > _NOISY * fifth else 0.0

    @property
    def is_shown_at_start(self) -> bool:
        """True if the first row of a body depends on its mass matrix."""
        return self.is_from_start and self.right.has_momenta != self.keeps_momenta

    @property
    def is_up_to_a_factor(self) -> bool:
        """True if the motion does not show a common factor of the mass matrix."""
        has_momenta = self.right.has_momenta or self.keeps_momenta
        return not (self.right.has_loads or np.any(self.right.rotor) or has_momenta)

    def momenta(self, mass: Floats) -> Floats:
        """Return the first momenta of a body with this mass matrix, (n,)."""
        return np.asarray((self.right.mass if self.keeps_momenta else mass) @ self.start.v[0])

    def first(self, mass: Floats) -> Floats:
        """Return the first v of a body with this mass matrix, (n,)."""
        if self.right.has_momenta:
            return self.momenta(mass)
        nu = self.start.v[0]
        return np.asarray(np.linalg.solve(mass, self.momenta(mass)) if self.keeps_momenta else nu)

    @cached_property
    def attitudes(self) -> Floats:
        """The file's attitudes; without them, those of its own omega from the start.

        The mean of the turns of the exact arcs forward from a row and backward from the next is used: their
        errors cancel in first order.
        """
        if self.file.q is not None:
            return self.file.q
        if self.own_attitudes is not None:
            return self.own_attitudes
        assert self.truth.q is not None
        if self.count < 2:
            return self.truth.q
        spans, free = np.diff(self.times), replace(self.right, acting=None)
        turns = []
        for rows, sign in ((slice(None, -1), 1), (slice(1, None), -1)):
            one = np.zeros((4, self.count - 1))
            one[0] = 1.0
            begin = np.concatenate([self.file.v[rows].T, one])[None]
            (ends,) = flow(free.rates, begin, self.times[rows], sign * spans, 4)
            turns.append(sign * rotation_vectors(ends[self.n :].T))
        steps = of_rotation_vectors((turns[0] + turns[1]) / 2)
        rows_ = [self.truth.q[0]]
        for step in steps:
            rows_.append(product(rows_[-1], step))
        own = np.array(rows_)
        return own if np.all(np.isfinite(own)) else self.truth.q


def velocities_of(right: Equations, rows: Floats) -> Floats:
    """Return nu of rows of v, (rows, components)."""
    return np.asarray(rows @ right.inverse.T) if right.has_momenta else rows
