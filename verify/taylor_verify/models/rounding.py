"""Numbers, vectors, matrices and times rounded onto one rung."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise

from taylor_verify.models.units import Units
from taylor_verify.numbers.precision import Rung, floor_log2
from taylor_verify.scenes.motion import IDENTITY, Clock, Quaternion
from taylor_verify.scenes.named_numbers import Part, Shape, Value, entrywise


class NotRepresentable(Exception):
    """The error for a scene that the rung cannot represent; the text says why."""


@dataclass(frozen=True)
class Rounding:
    """Rounds scalars, vectors and matrices onto one rung."""

    rung: Rung

    def __call__(self, value: Fraction, shift: int = 0) -> Fraction:
        try:
            return self.rung.round_scaled(value, shift)
        except OverflowError as error:
            raise NotRepresentable(str(error)) from error

    def each(self, value: Value, shift: int = 0) -> Value:
        """Round every number of a value times 2^shift, whatever its shape."""
        return entrywise(lambda entry: self(entry, shift) if entry else entry, value)

    def counted(self, part: Part, value: Value, units: Units) -> Value:
        """Round a part of a state, counted in its unit."""
        if part.shape is Shape.QUATERNION:
            return self.quaternion(value)
        return self.each(value, -units.exponent(part.dimension))

    def part(self, part: Part, value: Value) -> Value:
        """Round a part of a body or a state as it stands."""
        return self.quaternion(value) if part.shape is Shape.QUATERNION else self.each(value)

    def quaternion(self, quaternion: Quaternion) -> Quaternion:
        """Round the components after an exact scaling to order one; the norm does not matter."""
        if quaternion == IDENTITY:
            return quaternion
        shift = -max(floor_log2(entry) for entry in quaternion if entry)
        e0, e1, e2, e3 = (self(entry, shift) for entry in quaternion)
        return (e0, e1, e2, e3)


def distinct_times(clock: Clock, units: Units, rung: Rung) -> Sequence[Fraction]:
    """Return the sample times rounded once each. Raises NotRepresentable where two become one."""
    try:
        shift = -floor_log2(units.time)
        times = tuple(rung.round_scaled(t, shift) for t in clock.elapsed)
    except OverflowError as error:
        raise NotRepresentable(str(error)) from error
    if any(before == after for before, after in pairwise(times)):
        raise NotRepresentable(f"two sample times round to the same number of {rung.name}")
    return times
