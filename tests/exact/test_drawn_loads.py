"""Motions under drawn loads by another integrator, and under others by the digits of another enclosure."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path
from random import Random
from typing import Any, Final

import pytest
from builders.drawn_loads import Drawn, drawn
from builders.written_loads import End, end_of, rotation
from mpmath import mp, mpf, norm

from taylor_verify.exact.printed import document
from taylor_verify.exact.route import solution
from taylor_verify.exact.solution import Unsettled
from taylor_verify.scenes.motion import Motion
from taylor_verify.scenes.reading.reader import load

DIGITS = 16
# What may be refused or given up.
MOST_GIVEN_UP = 0.02


def outside(case: Drawn, motion: Motion, end: End) -> list[str]:
    """The quantities that are farther from the other integrator's than their radius and its error."""
    n = 3 if case.scene.model == "euler" else 6
    state, q, centre = end.state[:n], end.state[n : n + 4], end.state[n + 4 : n + 7]
    vectors = {"attitude": [entry for row in rotation(q) for entry in row]}
    if n == 3:
        vectors["omega"] = state
    else:
        vectors |= {"linear_impulse": state[:3], "angular_impulse": state[3:], "centre": centre}
    vectors |= {name: end.own[name] for name in motion.peaks}
    far = []
    for name, other in vectors.items():
        size = motion.peaks[name][0] if name in motion.peaks else mp.norm(other)
        middle = [e for row in motion[name][0] for e in (row if name == "attitude" else [row])]
        apart = mp.norm([a - b for a, b in zip(middle, other, strict=True)])
        radius = motion.radius_of(name)[0] * (size or 1)
        if not apart <= radius + 10 * end.error + mpf(10) ** -(DIGITS + 10):
            far.append(f"{name}: {mp.nstr(apart, 3)} of {mp.nstr(radius, 3)}")
    return far


def answers(
    seed: int, count: int, share: Fraction, columns: int, with_states: bool
) -> Counter[str]:
    """Count what became of drawn scenes, each followed for a share of its span; a motion outside its
    radius fails with its scene."""
    random, reasons = Random(seed), Counter[str]()
    while reasons.total() < count:
        case = drawn(random, with_states)
        if case.scene.body.loads is None:
            # Every entry happens to be zero.
            continue
        elapsed, start = share * case.elapsed, case.scene.clock.start
        switches = [time for time in case.switches if abs(time - start) < abs(elapsed)]
        end = end_of(case.scene, elapsed, DIGITS, 1, switches, columns)
        if end.crosses or end.error > mpf(10) ** -(DIGITS - 2):
            # The other integrator does not end its steps at kinks, or would need more of them.
            reasons["left out"] += 0
            continue
        try:
            motion = solution(case.scene).motion([elapsed], DIGITS)
        except Unsettled as refused:
            reasons[str(refused)] += 1
            continue
        with mp.workdps(DIGITS + 15):
            assert not outside(case, motion, end), case.text
        reasons["right"] += 1
    return reasons


# Half of a span needs a column less in the table of the other integrator.
HALF, WHOLE = (Fraction(1, 2), 6), (Fraction(1), 7)


@pytest.mark.parametrize(
    ("seed", "count", "along", "with_states"),
    [
        *((1, 30, HALF, False), (3, 8, HALF, True)),
        pytest.param(2, 2000, WHOLE, False, marks=pytest.mark.slow),
        pytest.param(4, 200, WHOLE, True, marks=pytest.mark.slow),
    ],
)
def test_drawn_motions_are_within_their_radii(
    seed: int, count: int, along: tuple[Fraction, int], with_states: bool
) -> None:
    """The enclosure gives up at most a fiftieth of all of them, each with its reason.

    Wheels, lags, integrals and held values that jump are among them: the other integrator has other
    equations for these.
    """
    reasons = answers(seed, count, *along, with_states)
    assert reasons["right"] >= (1 - MOST_GIVEN_UP) * count, reasons


# Digits of another enclosure

FOLDER: Final = Path(__file__).parent / "laboratory"
ANSWERS: Final[dict[str, Any]] = json.loads((FOLDER / "answers.json").read_text())
TWENTY: Final = 20


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
    printed = document(scene, solution(scene), times, TWENTY)
    assert [row["t"] for row in printed["rows"]] == [row["t"] for row in rows]
    largest: dict[str, Any] = {}
    with mp.workdps(45):
        for ours, theirs in zip(printed["rows"], rows, strict=True):
            assert mpf(ours["radius"]) < mpf(10) ** (1 - TWENTY)
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
