"""A time over that of a yardstick, as a picture shows it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import isfinite


@dataclass(frozen=True)
class Ratio:
    """The ratio of one run; ``low`` and ``high`` are the least and the greatest seen, where known."""

    label: str
    rung: str
    ratio: float
    low: float | None = None
    high: float | None = None

    @property
    def least(self) -> float:
        """The lower end of the range, or the ratio itself."""
        return self.ratio if self.low is None else self.low

    @property
    def greatest(self) -> float:
        """The upper end of the range, or the ratio itself."""
        return self.ratio if self.high is None else self.high


def check(ratios: Sequence[Ratio]) -> None:
    """Raise a ValueError that names every fault.

    Faults are no ratio at all, an empty text, no positive finite number, a ratio outside its range.
    """
    if not ratios:
        raise ValueError("expected ratios, got none @ ratios")
    faults = [fault for i, one in enumerate(ratios) for fault in _faults(one, f"ratios[{i}]")]
    if faults:
        raise ValueError("\n".join(faults))


def _faults(one: Ratio, place: str) -> Iterator[str]:
    for name, text in (("label", one.label), ("rung", one.rung)):
        if not text:
            yield f"expected a text, got {text!r} @ {place}.{name}"
    numbers = {"ratio": one.ratio, "low": one.low, "high": one.high}
    given = {name: value for name, value in numbers.items() if value is not None}
    bad = [name for name, value in given.items() if not (isfinite(value) and value > 0)]
    for name in bad:
        yield f"expected a positive number, got {given[name]} @ {place}.{name}"
    if not bad and not one.least <= one.ratio <= one.greatest:
        yield (
            f"expected a ratio between {one.least:g} and {one.greatest:g}, got {one.ratio:g} "
            f"@ {place}.ratio"
        )
