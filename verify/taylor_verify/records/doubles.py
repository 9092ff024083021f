"""Compact sequences of float64: eight bytes per number, where a tuple takes 32."""

from __future__ import annotations

from array import array
from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Any, Final, final

if TYPE_CHECKING:
    import numpy as np

# Decimal digits of a number that a picture needs.
_DIGITS: Final = 4
# As many numbers are changed at once: what that takes beside them stays small.
_PIECE: Final = 2**17
# So few are written out sooner than they are counted.
_FEW: Final = 256


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
    """Return the numbers, each the nearest double to its own first four decimal digits.

    A million numbers are written out once for each of the four digits that occur, not once each.
    """
    import numpy as np

    exact = np.array(values if isinstance(values, np.ndarray | Doubles) else list(values), float)
    if len(exact) <= _FEW:
        return Doubles(_written(value) for value in exact.tolist())
    for first in range(0, len(exact), _PIECE):
        piece = exact[first : first + _PIECE]
        piece[:] = _in_four_digits(piece)
    return Doubles(exact)


def _in_four_digits(exact: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    import numpy as np

    rounded = exact.copy()
    with np.errstate(all="ignore"):
        power = np.floor(np.log10(np.abs(exact))) - (_DIGITS - 1)
        counts = exact / 10.0**power
        whole = np.rint(counts)
        # Where this is False, the rounding of the quotient could change the digits.
        is_clear = (np.abs(power) < 250) & (np.abs(np.abs(counts - whole) - 0.5) > 1e-6)
    codes = whole[is_clear] + 1j * power[is_clear]
    unique, places = np.unique(codes, return_inverse=True)
    texts = [float(f"{int(code.real)}e{int(code.imag)}") for code in unique]
    rounded[is_clear] = np.array(texts, dtype=float)[places]
    others = np.flatnonzero(~is_clear)
    rounded[others] = [_written(value) for value in exact[others].tolist()]
    return rounded


def _written(value: float) -> float:
    return float(f"{value:.{_DIGITS}g}")
