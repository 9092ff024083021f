"""The radius means one thing on every route: the error of each vector by its norm, printing included."""

from __future__ import annotations

from fractions import Fraction
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from builders.scenes import text_of
from builders.turns import by_turns

from taylor_verify.exact.printed import document
from taylor_verify.exact.route import solution
from taylor_verify.scenes.reading.reader import load

ROUTES = ("arb", "mpmath", "taylor")
SCENES = (
    "euler/with-attitude",
    "euler/oblique-symmetry",
    "kirchhoff/screw",
)
TIMES = ("1.25", "7")


def printed(scene: str, route: str, digits: int) -> list[dict[str, Any]]:
    asked = load(scene)
    times = [(text, asked.clock.start + Fraction(text)) for text in TIMES]
    rows: list[dict[str, Any]] = document(asked, solution(asked, route), times, digits)["rows"]
    return rows


def vectors(row: dict[str, Any]) -> dict[str, list[Fraction]]:
    """Every vector and matrix of a row, flat, as the rationals that its text says."""
    values = {}
    for name, value in row.items():
        if name not in ("t", "radius"):
            values[name] = [Fraction(text) for text in np.ravel(np.array(value))]
    return values


def errors(row: dict[str, Any], truth: dict[str, Any]) -> dict[str, Fraction]:
    """The square of each vector's error by that of its norm, recomputed from the text alone."""
    ones, others = vectors(row), vectors(truth)
    assert set(ones) == set(others)
    return {
        name: sum((a - b) ** 2 for a, b in zip(ones[name], others[name], strict=True))
        / sum(b * b for b in others[name])
        for name in ones
    }


@pytest.mark.parametrize(("digits", "scene"), by_turns(product([3, 16], SCENES)))
def test_printed_digits_are_within_the_radius_on_every_route(scene: str, digits: int) -> None:
    """Against forty digits of the other routes; and printing is most of it, on all three alike."""
    sharp = {route: printed(scene, route, 40) for route in ROUTES}
    for route in ROUTES:
        for k, row in enumerate(printed(scene, route, digits)):
            radius = Fraction(row["radius"])
            assert Fraction(5, 10**digits) < radius <= Fraction(6, 10**digits)
            for other in ROUTES:
                room = radius + Fraction(sharp[other][k]["radius"])
                assert max(errors(row, sharp[other][k]).values()) <= room**2


DIAGONALS = {"linear": [1, 1, 1], "coupling": [0, 0, 0], "angular": [1, 2, 3]}
ENERGY = {name: np.diag(entries).tolist() for name, entries in DIAGONALS.items()}
# An impulse that a force takes away.
CANCELLING = text_of(
    {"force": ["1/3", "2/3", 0], "energy": ENERGY},
    {"linear_impulse": ["-1/7", "-2/7", 0], "angular_impulse": [0, 0, 0]},
    *(1, 2),
)


@pytest.mark.parametrize("left", [Fraction(1, 10**100), Fraction(0)])
def test_what_is_left_of_a_vector_that_cancels_is_right(tmp_path: Path, left: Fraction) -> None:
    """x is linear in time. Of 1e-100 of it every digit is right; of nothing, zero is printed and said."""
    file = tmp_path / "cancelling.toml"
    file.write_text(CANCELLING, encoding="utf-8")
    scene = load(str(file))
    printed = document(scene, solution(scene, "taylor"), [("t", Fraction(3, 7) + 3 * left)], 30)
    (row,) = printed["rows"]
    truth = [left, 2 * left, Fraction(0)]
    errors = [Fraction(p) - t for p, t in zip(row["linear_impulse"], truth, strict=True)]
    assert Fraction(row["radius"]) < Fraction(1, 10**29)
    assert sum(e * e for e in errors) <= Fraction(row["radius"]) ** 2 * sum(t * t for t in truth)
    assert ("absolute" in row) is (left == 0)
