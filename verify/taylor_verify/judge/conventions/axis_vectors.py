"""Meanings of an attitude of three or four numbers that are no angles: vectors along the axis of a turn."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Final

import numpy as np

from taylor_verify.solvers.files.columns.column_units import DEGREE
from taylor_verify.solvers.files.columns.forms import FORMS
from taylor_verify.solvers.values import Value

Floats = np.ndarray[Any, np.dtype[np.float64]]

# Factors of an angle, with the words for what the numbers are then.
_OF_ANGLES: Final = {
    Fraction(1): "{}",
    DEGREE: "{} in degrees",
    Fraction(2): "{} with half of the angle",
    Fraction(1, 2): "{} with twice the angle",
}
_FORMS: Final = ("rotvec", "mrp", "gibbs")
_Places = tuple[int, ...]
_LIKE_VECTORS: Final[list[tuple[str, _Places]]] = [(form, ()) for form in _FORMS]
_LIKE_QUATERNIONS: Final[list[tuple[str, _Places]]] = [
    ("axis_angle", ()),
    ("axis_angle", (1, 2, 3, 0)),
]


@dataclass(frozen=True)
class Vector:
    """A form of the attitude, with the factor of its angles and the places of its numbers.

    ``is_turned`` if it takes space to body axes. Without a ``form`` it is a quaternion.
    """

    form: str
    factor: Fraction = Fraction(1)
    places: _Places = ()
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


def vectors(own: str) -> Iterator[Vector]:
    """Yield the meanings of the numbers of a form, or of a quaternion, that form itself first."""
    yield Vector(own)
    for form, places in _LIKE_VECTORS if own in _FORMS else _LIKE_QUATERNIONS:
        for factor in _OF_ANGLES if FORMS[form].angles else (Fraction(1),):
            for is_turned in (False, True):
                meaning = Vector(form, factor, places, is_turned)
                if meaning != Vector(own):
                    yield meaning
