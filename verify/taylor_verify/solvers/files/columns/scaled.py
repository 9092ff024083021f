"""The numbers of a column in the scene's unit, each formed when somebody looks at it."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any, final, overload

from taylor_verify.solvers.values import Value, exact


@final
class Scaled(Sequence[Value]):
    """Numbers times a factor, exactly; NaN and infinity as they are."""

    def __init__(self, values: Sequence[Any], factor: Fraction) -> None:
        self._values, self._factor = values, factor

    def __len__(self) -> int:
        return len(self._values)

    @overload
    def __getitem__(self, place: int) -> Value: ...

    @overload
    def __getitem__(self, place: slice) -> list[Value]: ...

    def __getitem__(self, place: int | slice) -> Any:
        if isinstance(place, slice):
            return [self._formed(value) for value in self._values[place]]
        return self._formed(self._values[place])

    def _formed(self, raw: Any) -> Value:
        value = exact(raw)
        return value * self._factor if isinstance(value, Fraction) else value
