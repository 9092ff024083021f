"""Compact sequences of float64: eight bytes per number, where a tuple takes 32."""

from __future__ import annotations

from array import array
from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Any, final

if TYPE_CHECKING:
    import numpy as np


@final
class Doubles(Sequence[float]):
    """Numbers as immutable as a tuple, and equal to any sequence of the same numbers."""

    __slots__ = ("_values",)

    def __init__(self, values: Iterable[float] = ()) -> None:
        # An array of NumPy is read as it lies, without a number of Python for each of its own.
        astype = getattr(values, "astype", None)
        self._values = array("d", values if astype is None else astype("d").tobytes())

    def __len__(self) -> int:
        return len(self._values)

    def __getitem__(self, place: Any) -> Any:
        return Doubles(self._values[place]) if isinstance(place, slice) else self._values[place]

    def __iter__(self) -> Iterator[float]:
        return iter(self._values.tolist())

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> np.ndarray[Any, Any]:
        import numpy as np

        # Without a copy, the array is read-only.
        doubles = np.asarray(self._values)
        doubles.setflags(write=False)
        return doubles if copy is False else doubles.astype(dtype or np.float64)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Sequence):
            return NotImplemented
        return len(self) == len(other) and all(a == b for a, b in zip(self, other, strict=True))

    def __hash__(self) -> int:
        return hash(tuple(self))

    def __repr__(self) -> str:
        return repr(tuple(self))

    def __reduce__(self) -> tuple[Any, ...]:
        return Doubles, (self._values,)


def four_digits(values: Iterable[float]) -> Doubles:
    """Return the numbers, each the nearest double to its own first four decimal digits."""
    tolist = getattr(values, "tolist", None)
    return Doubles(map(float, map("{:.4g}".format, values if tolist is None else tolist())))
