"""Many numbers of float64 in eight bytes each: in a tuple they take 32."""

from __future__ import annotations

from array import array
from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Any, final, overload

if TYPE_CHECKING:
    import numpy as np


@final
class Doubles(Sequence[float]):
    """Numbers as immutable as a tuple, and equal to any sequence of the same numbers."""

    __slots__ = ("_values",)

    def __init__(self, values: Iterable[float] = ()) -> None:
        self._values = array("d")
        if hasattr(values, "tobytes") and hasattr(values, "astype"):
            self._values.frombytes(values.astype("float64").tobytes())
        else:
            self._values.extend(values)

    def __len__(self) -> int:
        return len(self._values)

    @overload
    def __getitem__(self, place: int) -> float: ...

    @overload
    def __getitem__(self, place: slice) -> Doubles: ...

    def __getitem__(self, place: int | slice) -> float | Doubles:
        return Doubles(self._values[place]) if isinstance(place, slice) else self._values[place]

    def __iter__(self) -> Iterator[float]:
        return iter(self._values.tolist())

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> np.ndarray[Any, Any]:
        import numpy as np

        # Who asks for no copy gets what nobody can write to.
        held = np.asarray(self._values)
        held.setflags(write=False)
        return held if copy is False else held.astype(dtype or np.float64)

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
