"""Rows that are made of other rows when they are looked at, such as quaternions of angles."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import Any, final

import numpy as np

from taylor_verify.solvers.files.compact_rows import Floats, Rows
from taylor_verify.solvers.values import Value

# From the numbers of a row of each source, all of them finite, to the numbers of the row that is made.
Make = Callable[..., Sequence[Value]]


@final
class MadeRows(Rows):
    """Rows of ``width`` numbers, each made of the rows of the sources; NaN where a source is not finite."""

    def __init__(self, sources: Sequence[Rows], make: Make, width: int) -> None:
        self.sources, self._make = tuple(sources), make
        finite = np.logical_and.reduce([source.finite for source in sources])
        super().__init__([range(len(sources[0]))] * width, finite)

    def at(self, places: Sequence[int]) -> MadeRows:
        sources = [source.at(places) for source in self.sources]
        return MadeRows(sources, self._make, self.width)

    def written(self) -> Iterator[tuple[Any, Floats]]:
        for source in self.sources:
            yield from source.written()

    def _some(self, places: Sequence[int]) -> Iterator[Any]:
        each = zip(places, *(source.values_at(places) for source in self.sources), strict=True)
        lost = (np.nan,) * self.width
        rows = [self._make(*row) if self.finite[k] else lost for k, *row in each]
        return iter(list(zip(*rows, strict=True)) or [()] * self.width)
