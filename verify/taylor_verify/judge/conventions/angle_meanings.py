"""Another meaning of the numbers of an attitude: unit, order, sign or sequence of angles, another form.

They are compared with the exact attitude, as a quaternion would be. What explains them with the fewest
departures from how they were read is found; several that do as well are said together.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cache
from itertools import permutations, product
from operator import itemgetter
from typing import Any, Final

import numpy as np

from taylor_verify.judge.conventions.convention_search import attitudes_at, beginnings
from taylor_verify.judge.conventions.fits import AS_WELL, EXPLAINS, FLOAT64, Finding
from taylor_verify.judge.conventions.meanings import rotations
from taylor_verify.numbers import rotation
from taylor_verify.numbers.precision import Rung
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.files.columns.column_units import DEGREE
from taylor_verify.solvers.files.columns.forms import FORMS, SEQUENCES
from taylor_verify.solvers.files.compact_rows import Rows
from taylor_verify.solvers.files.file import TrajectoryFile
from taylor_verify.solvers.files.made import MadeRows
from taylor_verify.solvers.values import Value

Floats = np.ndarray[Any, np.dtype[np.float64]]

_PLAIN: Final = (0, 1, 2)
_MOST: Final = 2
_UNITS: Final = {
    Fraction(1): "",
    DEGREE: "are in degrees",
    1 / DEGREE: "are in radians",
}
_TURNS: Final = {"z": "yaw", "y": "pitch", "x": "roll"}
_NOISE: Final = 64 * FLOAT64
# Quaternions that are integrated without restoring their length stay as near to it.
_UNIT: Final = 0.1
# Attitudes are no farther apart, as `_apart` measures; numbers that are none are infinitely far.
_FARTHEST: Final = 2.0
# Factors of an angle, with the words for what the numbers are then.
_OF_ANGLES: Final = {
    Fraction(1): "{}",
    DEGREE: "{} in degrees",
    Fraction(2): "{} with half of the angle",
    Fraction(1, 2): "{} with twice the angle",
}
_VECTORS: Final = ("rotvec", "mrp", "gibbs")


@dataclass(frozen=True)
class Angles:
    """A meaning of three angles: factors, their places in a sequence, and whether its axes stay fixed."""

    sequence: str
    places: tuple[int, ...] = _PLAIN
    factors: tuple[Fraction, ...] = (Fraction(1),) * 3
    is_fixed: bool = False

    def words(self, own: str) -> list[str]:
        """Return the departures from the sequence that the angles were read by."""
        size = abs(self.factors[0])
        words = [_UNITS[size]] if size != 1 else []
        words += [f"are of the sequence {self.sequence}"] if self.sequence != own else []
        if self.places != _PLAIN:
            words.append(f"stand in the order {' '.join(str(k + 1) for k in self.places)}")
        flipped = [self._name(k) for k, factor in enumerate(self.factors) if factor < 0]
        if self.is_fixed and len(flipped) == len(_PLAIN):
            return [*words, "take space to body axes"]
        words += ["are about axes that stay fixed"] if self.is_fixed else []
        words += [f"have the other sign in angle {' and '.join(flipped)}"] if flipped else []
        return words

    def _name(self, k: int) -> str:
        """Return the place of an angle in a row, and its turn: the columns may stand in another order."""
        axis = self.sequence[self.places.index(k)]
        turn = _TURNS[axis] if self.sequence == "zyx" else f"about {axis}"
        return f"{k + 1} ({turn})"

    def quaternion(self, angles: Sequence[Fraction]) -> Sequence[Value]:
        """Return the exact quaternion of a row."""
        turns = [self.factors[k] * angles[k] for k in self.places]
        # Turns about fixed axes are the same turns about axes that move along, in the opposite order.
        order = -1 if self.is_fixed else 1
        return FORMS[self.sequence[::order]].quaternion(turns[::order])

    def quaternions(self, angles: Floats) -> Floats:
        """Return the quaternions of rows in doubles."""
        turns = angles * np.array([float(factor) for factor in self.factors])
        q = np.array([1.0, 0.0, 0.0, 0.0])[:, None] * np.ones(len(angles))
        for axis, k in zip(self.sequence, self.places, strict=True):
            turn = np.zeros_like(q)
            turn[0], turn[1 + "xyz".index(axis)] = np.cos(turns[:, k] / 2), np.sin(turns[:, k] / 2)
            first, then = (turn, q) if self.is_fixed else (q, turn)
            q = np.array(rotation.product(list(first), list(then)))
        return q.T


@dataclass(frozen=True)
class Vector:
    """A form of the attitude, with the factor of its angles and the places of its numbers.

    ``is_turned`` if it takes space to body axes. Without a ``form`` it is a quaternion.
    """

    form: str
    factor: Fraction = Fraction(1)
    places: tuple[int, ...] = ()
    is_turned: bool = False

    def words(self, own: str) -> list[str]:
        """Return the departures from the form that the numbers were read by."""
        noun = FORMS[self.form].words if self.form else "a quaternion"
        noun = "an angle and an axis" if self.places else noun
        is_other = self != Vector(own, is_turned=self.is_turned)
        words = [f"are {_OF_ANGLES[self.factor].format(noun)}"] if is_other else []
        return [*words, *["take space to body axes"] * self.is_turned]

    def quaternion(self, numbers: Sequence[Fraction]) -> Sequence[Value]:
        """Return the exact quaternion of a row, not of unit length."""
        ordered = [numbers[k] for k in self.places] or list(numbers)
        if not self.form:
            return ordered
        form = FORMS[self.form]
        angles = [name in form.angles for name in form.columns]
        turns = [self.factor * x if a else x for x, a in zip(ordered, angles, strict=True)]
        q = form.quaternion(turns)
        return [q[0], *(-part for part in q[1:])] if self.is_turned else q

    def quaternions(self, rows: Floats) -> Floats:
        """Return the quaternions of rows in doubles; NaN where the numbers are none."""
        exact = (self.quaternion([Fraction(x) for x in row]) for row in rows.tolist())
        return np.array([[float(part) for part in q] for q in exact])


# A meaning of the numbers of a row.
Meaning = Angles | Vector


@cache
def _meanings(own: str) -> tuple[Meaning, ...]:
    """Return the meanings with few departures, the fewest first; the own one is the first of all."""
    return _sequences(own) if own in SEQUENCES else tuple(_vectors(own))


def _sequences(own: str) -> tuple[Angles, ...]:
    """Return the meanings of angles of a sequence.

    Other sequences about fixed axes are sequences about moving ones in the opposite order.
    """
    every = (
        Angles(sequence, places, factors, is_fixed)
        for unit in _UNITS
        for factors in product((unit, -unit), repeat=3)
        for sequence in SEQUENCES
        for places in permutations(_PLAIN)
        for is_fixed in {False, sequence == own != own[::-1]}
    )
    counted = [(len(meaning.words(own)), meaning) for meaning in every]
    counted.sort(key=itemgetter(0))
    return tuple(meaning for count, meaning in counted if count <= _MOST)


def _vectors(own: str) -> Iterator[Vector]:
    """Yield the meanings of the numbers of a form, or of a quaternion, that form itself first."""
    yield Vector(own)
    forms = _VECTORS if own in _VECTORS else ("axis_angle",)
    orders: list[tuple[int, ...]] = [()] if own in _VECTORS else [(), (1, 2, 3, 0)]
    for form, places in product(forms, orders):
        for factor in _OF_ANGLES if FORMS[form].angles else (Fraction(1),):
            for is_turned in (False, True):
                meaning = Vector(form, factor, places, is_turned)
                if meaning != Vector(own):
                    yield meaning


@np.errstate(over="ignore", invalid="ignore")  # an answer may diverge
def with_angles(
    file: TrajectoryFile, scene: Scene, rung: Rung
) -> tuple[TrajectoryFile, Finding | None]:
    """Return the file with its attitude as its numbers explain it, and what was found; None for nothing.

    Raises what judge.conventions.convention_search.conventions does.
    """
    numbers = _numbers(file)
    if numbers is None:
        return file, None
    for rows in reversed(beginnings(file)):
        finding, meaning = _explained(file, numbers, scene, rung, rows)
        if finding is not None:
            read = MadeRows([numbers], meaning.quaternion, 4)
            mended = replace(file, groups={**file.groups, "quaternion": read})
            return mended if finding.is_certain else file, finding
    return file, None


def _numbers(file: TrajectoryFile) -> Rows | None:
    """Return the numbers that the attitude was read from; None if they are no form of one."""
    rows = file.groups.get("quaternion")
    if rows is None or not file.form:
        return None if rows is None or _are_unit(rows.doubles()) else rows
    (numbers,) = rows.sources  # type: ignore[attr-defined]
    return numbers if numbers.width == len(FORMS[file.form].columns) else None


def _are_unit(q: Floats) -> bool:
    """Return True if most rows are quaternions near unit length."""
    return bool(np.median(np.abs(np.linalg.norm(q, axis=1) - 1)) < _UNIT)


def _explained(
    file: TrajectoryFile, numbers: Rows, scene: Scene, rung: Rung, rows: tuple[int, ...]
) -> tuple[Finding | None, Meaning]:
    columns, right = numbers.doubles(rows), attitudes_at(file, scene, rung, rows)
    every = _meanings(file.form)
    errors = [_apart(rotations(meaning.quaternions(columns)), right) for meaning in every]
    plain, best = errors[0], min(errors)
    enough = AS_WELL * max(best, _NOISE)
    good = [m for m, error in zip(every, errors, strict=True) if error <= enough]
    if not best <= EXPLAINS * min(plain, _FARTHEST) or plain <= enough:
        return None, every[0]
    first, *others = good
    count = len(first.words(file.form))
    alike = [other for other in others if len(other.words(file.form)) == count]
    noun = "the angles"
    if file.form not in SEQUENCES:
        noun = f"the columns taken as {FORMS[file.form].words if file.form else 'q0 q1 q2 q3'}"
    words, *more = (f"{noun} {'; '.join(m.words(file.form))}" for m in (first, *alike))
    return Finding("quaternion", words, plain, best, tuple(more)), first


def _apart(matrices: Floats, right: Floats) -> float:
    """Return the largest angle between attitudes, in radians where it is small; infinite for NaN."""
    apart = np.linalg.norm((matrices - right).reshape(len(right), -1), axis=1)
    return float(np.max(np.where(np.isnan(apart), np.inf, apart))) / 2**0.5
