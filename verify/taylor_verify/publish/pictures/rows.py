"""Rows of a document of ratios, read and refused: label, ratio, its range, and a rung."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from math import isfinite
from typing import Any


@dataclass(frozen=True)
class Ratio:
    """A time over that of a yardstick, of one run, with the least and the greatest seen."""

    label: str
    rung: str
    ratio: float
    low: float
    high: float


def ratios(document: Mapping[str, Any], key: str) -> list[Ratio]:
    """The rows under ``key``, each {label, rung, ratio, low, high}; low and high may be missing.

    Raises ValueError that names every fault: no row, no text, no positive finite number, a ratio
    outside its range.
    """
    rows = document.get(key)
    if not isinstance(rows, list) or not rows:
        raise ValueError(f"expected a list of ratios, got {rows!r} @ {key}")
    faults = [fault for i, row in enumerate(rows) for fault in _faults(row, f"{key}[{i}]")]
    if faults:
        raise ValueError("\n".join(faults))
    return [_read(row) for row in rows]


def _read(row: Mapping[str, Any]) -> Ratio:
    ratio = float(row["ratio"])
    low, high = float(row.get("low") or ratio), float(row.get("high") or ratio)
    return Ratio(row["label"], row["rung"], ratio, low, high)


def _faults(row: Any, place: str) -> Iterator[str]:
    if not isinstance(row, Mapping):
        yield f"expected a row with label, rung and ratio, got {row!r} @ {place}"
        return
    for name in ("label", "rung"):
        if not isinstance(row.get(name), str) or not row[name]:
            yield f"expected a text, got {row.get(name)!r} @ {place}.{name}"
    bad = [name for name in ("ratio", "low", "high") if not _is_ratio(row, name)]
    for name in bad:
        yield f"expected a positive number, got {row.get(name)!r} @ {place}.{name}"
    if not bad:
        read = _read({"label": "", "rung": "", **row})
        if not read.low <= read.ratio <= read.high:
            yield (
                f"expected a ratio between {read.low:g} and {read.high:g}, got {read.ratio:g} "
                f"@ {place}.ratio"
            )


def _is_ratio(row: Mapping[str, Any], name: str) -> bool:
    value = row.get(name)
    if value is None:
        return name != "ratio"
    number = isinstance(value, int | float) and not isinstance(value, bool)
    return number and isfinite(value) and value > 0
