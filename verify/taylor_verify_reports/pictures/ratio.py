"""Ratio of a time to that of a yardstick, for pictures."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import inf


@dataclass(frozen=True)
class Ratio:
    """The ratio of one run; ``low`` and ``high`` are the least and the greatest ratio, if known."""

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

    Faults are an empty list, an empty text, a number that is not positive and finite, and a ratio outside
    its range.
    """
    if not ratios:
        raise ValueError("expected ratios, got none @ ratios")
    faults = [
        f"expected {expected}, got {value} @ ratios[{i}].{name}"
        for i, ratio in enumerate(ratios)
        for name, expected, value in _faults(ratio)
    ]
    if faults:
        raise ValueError("\n".join(faults))


def _faults(ratio: Ratio) -> Iterator[tuple[str, str, str]]:
    """Yield each fault: the name of the field, the expectation, and the value."""
    for name, text in (("label", ratio.label), ("rung", ratio.rung)):
        if not text:
            yield name, "a text", repr(text)
    numbers = {"ratio": ratio.ratio, "low": ratio.low, "high": ratio.high}
    bad = {n: v for n, v in numbers.items() if v is not None and not 0 < v < inf}
    for name, value in bad.items():
        yield name, "a positive number", str(value)
    if not bad and not ratio.least <= ratio.ratio <= ratio.greatest:
        between = f"a ratio between {ratio.least:g} and {ratio.greatest:g}"
        yield "ratio", between, f"{ratio.ratio:g}"
