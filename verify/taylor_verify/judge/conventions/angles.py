"""Another meaning of a file's angles: their unit, their order, one sign, the sequence of their turns.

The angles of a file are compared with the exact attitude, as a quaternion would be. What explains them with
the fewest departures from how they were read is found; several that do as well are said together.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cache
from itertools import permutations, product
from operator import itemgetter
from typing import Any, Final

import numpy as np

from taylor_verify.judge.conventions.fits import AS_WELL, EXPLAINS, FLOAT64, Finding
from taylor_verify.judge.conventions.readings import rotations
from taylor_verify.judge.conventions.search import attitudes_at, beginnings
from taylor_verify.numbers.precision import Rung
from taylor_verify.scenes.scene import Scene
from taylor_verify.scenes.turns import times
from taylor_verify.solvers.files.columns.forms import FORMS, SEQUENCES
from taylor_verify.solvers.files.columns.units import DEGREE
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
_NOISE: Final = 64 * FLOAT64


@dataclass(frozen=True)
class Meaning:
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
        flipped = [str(k + 1) for k, factor in enumerate(self.factors) if factor < 0]
        if self.is_fixed and len(flipped) == len(_PLAIN):
            return [*words, "take space to body axes"]
        words += ["are about axes that stay fixed"] if self.is_fixed else []
        words += [f"have the other sign in angle {' and '.join(flipped)}"] if flipped else []
        return words

    def quaternion(self, angles: Sequence[Fraction]) -> Sequence[Value]:
        """Return the exact quaternion of a row."""
        turns = [self.factors[k] * angles[k] for k in self.places]
        return FORMS[self._moving].quaternion(turns[::-1] if self.is_fixed else turns)

    def quaternions(self, angles: Floats) -> Floats:
        """Return the quaternions of rows in doubles."""
        turns = angles * np.array([float(factor) for factor in self.factors])
        q = np.array([1.0, 0.0, 0.0, 0.0])[:, None] * np.ones(len(angles))
        for axis, k in zip(self.sequence, self.places, strict=True):
            turn = np.zeros_like(q)
            turn[0], turn[1 + "xyz".index(axis)] = np.cos(turns[:, k] / 2), np.sin(turns[:, k] / 2)
            first, then = (turn, q) if self.is_fixed else (q, turn)
            q = np.array(times(list(first), list(then)))
        return q.T

    @property
    def _moving(self) -> str:
        """The sequence of the same turns about axes that move along, in the opposite order."""
        return self.sequence[::-1] if self.is_fixed else self.sequence


@cache
def _meanings(own: str) -> tuple[Meaning, ...]:
    """Return the meanings with few departures, the fewest first; the own one is the first of all.

    Other sequences about fixed axes are sequences about moving ones in the opposite order.
    """
    every = (
        Meaning(sequence, places, factors, is_fixed)
        for unit in _UNITS
        for factors in product((unit, -unit), repeat=3)
        for sequence in SEQUENCES
        for places in permutations(_PLAIN)
        for is_fixed in {False, sequence == own != own[::-1]}
    )
    counted = [(len(meaning.words(own)), meaning) for meaning in every]
    counted.sort(key=itemgetter(0))
    return tuple(meaning for count, meaning in counted if count <= _MOST)


def with_angles(
    file: TrajectoryFile, scene: Scene, rung: Rung
) -> tuple[TrajectoryFile, Finding | None]:
    """Return the file with its angles as they explain the attitude, and what was found; None for nothing.

    Raises what judge.conventions.search.conventions does.
    """
    if file.form not in SEQUENCES or "quaternion" not in file.groups:
        return file, None
    for rows in reversed(beginnings(file)):
        finding, meaning = _explained(file, scene, rung, rows)
        if finding is not None:
            return _read_by(file, meaning) if finding.is_certain else file, finding
    return file, None


def _angles(file: TrajectoryFile) -> Any:
    (angles,) = file.groups["quaternion"].sources  # type: ignore[attr-defined]
    return angles


def _read_by(file: TrajectoryFile, meaning: Meaning) -> TrajectoryFile:
    rows = MadeRows([_angles(file)], meaning.quaternion, 4)
    return replace(file, groups={**file.groups, "quaternion": rows})


def _explained(
    file: TrajectoryFile, scene: Scene, rung: Rung, rows: tuple[int, ...]
) -> tuple[Finding | None, Meaning]:
    angles, right = _angles(file).doubles(rows), attitudes_at(file, scene, rung, rows)
    every = _meanings(file.form)
    errors = [_apart(rotations(meaning.quaternions(angles)), right) for meaning in every]
    plain, best = errors[0], min(errors)
    enough = AS_WELL * max(best, _NOISE)
    good = [m for m, error in zip(every, errors, strict=True) if error <= enough]
    if not best <= EXPLAINS * plain or plain <= enough:
        return None, every[0]
    first, *others = good
    count = len(first.words(file.form))
    alike = [other for other in others if len(other.words(file.form)) == count]
    words, *more = (f"the angles {'; '.join(m.words(file.form))}" for m in (first, *alike))
    return Finding("quaternion", words, plain, best, tuple(more)), first


def _apart(matrices: Floats, right: Floats) -> float:
    """Return the largest angle between attitudes, in radians where it is small."""
    return (
        float(np.max(np.linalg.norm((matrices - right).reshape(len(right), -1), axis=1))) / 2**0.5
    )
