"""Loads and states of one's own against 38 digits of another enclosure, whose recursion ran in MPFR.

The folder laboratory has 22 scenes with their long spans, and the answers of that prototype at two times
each, which two precisions of an independent integrator gave alike.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path
from typing import Any, Final

import pytest
from mpmath import mp, mpf, norm

from taylor_verify.exact.printed import document
from taylor_verify.exact.route import solution
from taylor_verify.scenes.reading.reader import load

FOLDER: Final = Path(__file__).parent / "laboratory"
ANSWERS: Final[dict[str, Any]] = json.loads((FOLDER / "answers.json").read_text())
DIGITS: Final = 20


def vectors(row: dict[str, Any]) -> Iterator[tuple[str, list[str]]]:
    """Each quantity of a row with its entries; own states stand beside the others."""
    quantities = {**row, **row.get("states", {})}
    for name, entries in quantities.items():
        if isinstance(entries, list):
            nested = [e if isinstance(e, list) else [e] for e in entries]
            yield name, [text for each in nested for text in each]


@pytest.mark.slow
@pytest.mark.parametrize("name", ANSWERS)
def test_twenty_digits_lie_within_their_radius_of_the_others(name: str) -> None:
    """The radius of a row bounds the error of each vector by its norm, or its largest norm so far."""
    scene = load(FOLDER / f"{name}.toml")
    rows = ANSWERS[name]["rows"]
    times = [(row["t"], Fraction(row["t"])) for row in rows]
    printed = document(scene, solution(scene), times, DIGITS)
    assert [row["t"] for row in printed["rows"]] == [row["t"] for row in rows]
    largest: dict[str, Any] = {}
    with mp.workdps(45):
        for ours, theirs in zip(printed["rows"], rows, strict=True):
            assert mpf(ours["radius"]) < mpf(10) ** (1 - DIGITS)
            answered = dict(vectors(ours))
            assert theirs.keys() - {"t", "states"} <= answered.keys()
            for quantity, entries in vectors(theirs):
                if quantity not in answered:
                    continue
                size = largest[quantity] = max(
                    norm(list(map(mpf, entries))), largest.get(quantity, 0)
                )
                off = norm(
                    [mpf(a) - mpf(b) for a, b in zip(answered[quantity], entries, strict=True)]
                )
                assert off <= (mpf(ours["radius"]) + mpf("1e-36")) * size
