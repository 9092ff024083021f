"""States at times, read by name: the shared face of an exact motion and of a solver's trajectory."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import islice
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from mpmath import mp

from taylor_verify.records.passing import Passing
from taylor_verify.records.quantities import COLUMNS
from taylor_verify.records.showing import dataframe, html_table, picture

if TYPE_CHECKING:
    import pandas

# A page shows so many rows; `to_dataframe` has all of them.
_MOST_SHOWN: Final = 20


class Sampled(Passing):
    """Quantities, each an array with a row for each time; ``motion.omega`` is ``motion["omega"]``.

    ``times`` are on the clock of the scene; empty where they were not asked for by a caller.
    """

    quantities: Mapping[str, Any]
    times: Sequence[Fraction]

    def __getitem__(self, quantity: str) -> Any:
        return self.quantities[quantity]

    def __getattr__(self, name: str) -> Any:
        # Asked before there are quantities, as by pickle, it must not ask for them.
        quantities = vars(self).get("quantities", {})
        if name.startswith("_") or name not in quantities:
            known = ", ".join(quantities) or "none"
            raise AttributeError(f"expected one of the quantities {known}, got {name!r}")
        return quantities[name]

    def __eq__(self, other: object) -> bool:
        return type(self) is type(other) and _listed(vars(self)) == _listed(vars(other))

    __hash__ = None  # type: ignore[assignment]

    def __getstate__(self) -> dict[str, Any]:
        packed: dict[str, Any] = _packed(vars(self))
        return packed

    def to_dataframe(self) -> pandas.DataFrame:
        """Return a pandas.DataFrame with a row for each time, and columns named as those of a file.

        Numbers are those of the quantities; ``.astype(float)`` makes doubles of exact ones. Raises
        ModuleNotFoundError without pandas (``pip install pandas``).
        """
        names = [name for name, _ in self._columns()]
        return dataframe(dict(zip(names, row, strict=True)) for row in self._rows())

    def _columns(self) -> Iterator[tuple[str, Any]]:
        """Yield the columns of a file by name."""
        if self.times:
            yield "t", self.times
        for quantity, values in self.quantities.items():
            flat = values.reshape(len(values), -1).T
            names = COLUMNS.get(quantity, ())
            if len(names) != len(flat):
                names = tuple(f"{quantity}{i}" for i in range(1, len(flat) + 1))
            yield from zip((quantity,) if len(flat) == 1 else names, flat, strict=True)

    def _rows(self) -> Iterator[tuple[Any, ...]]:
        return zip(*(column for _, column in self._columns()), strict=True)

    def __repr__(self) -> str:
        count = len(next(iter(self.quantities.values()), ()))
        span = f" from {self.times[0]} to {self.times[-1]}" if self.times else ""
        names = ", ".join(self.quantities) or "no states"
        times = "1 time" if count == 1 else f"{count} times"
        return f"<{' '.join([type(self).__name__, 'of', names, 'at', times])}{span}{self._remark}>"

    @property
    def _remark(self) -> str:
        """The remark that a subclass adds to its repr."""
        return ""

    def __str__(self) -> str:
        """Return a line that says what it is, and each row with all digits."""
        lines, names = [repr(self)[1:-1]], [name for name, _ in self._columns()]
        for k, row in enumerate(self._rows()):
            pairs = (f"{name} = {value}" for name, value in zip(names, row, strict=True))
            lines.append(f"{'' if self.times else f'row {k}: '}{', '.join(pairs)}")
        return "\n".join(lines)

    def _repr_html_(self) -> str:
        """Return a picture of the quantities against time, and a table of the first rows."""
        names = [name for name, _ in self._columns()]
        rows = [[str(value) for value in row] for row in islice(self._rows(), _MOST_SHOWN)]
        curves = {name: column for name, column in self._columns() if name != "t"}
        drawn = picture(self.times, curves) if len(self.times) > 1 else ""
        return html_table(repr(self)[1:-1], names, rows) + drawn


@dataclass(frozen=True)
class _Packed:
    """A number of mpmath on its way to another process: mpmath's own pickle rounds it to a double."""

    number: Any

    def __reduce__(self) -> tuple[Any, ...]:
        return _unpacked, (self.number._mpf_,)


def _unpacked(state: Any) -> Any:
    return mp.make_mpf(state)


def _packed(value: Any) -> Any:
    """Return a value with each number of mpmath packed."""
    if isinstance(value, Mapping):
        return {name: _packed(each) for name, each in value.items()}
    if isinstance(value, np.ndarray) and value.dtype == object:
        entries = [_Packed(v) if type(v) is mp.mpf else v for v in value.flat]
        return np.array([*entries, None], dtype=object)[:-1].reshape(value.shape)
    return value


def _listed(value: Any) -> Any:
    """Return a value that can be compared: each array as a list."""
    if isinstance(value, Mapping):
        return {name: _listed(each) for name, each in value.items()}
    return value.tolist() if hasattr(value, "tolist") else value
