"""The gyroscopic term: how an engine treats it is named where that explains its omega, and only there."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from builders.integrators import Kick, engine, explicit, implicit, none, without_wheels
from builders.trajectories import Columns, exact_columns, file_judgement, write_csv
from builders.turns import by_turns

FREE, FULL = "euler/with-attitude", "euler/full-tensor"
WORDS = {
    none: "no gyroscopic term",
    explicit: "explicit gyroscopic step",
    implicit: "implicit gyroscopic step",
}


def causes(path: Path, scene: str, columns: Columns) -> list[str]:
    """The causes of a file: they name the gyroscopic term."""
    judgement = file_judgement(write_csv(path / "mine.csv", columns), scene)
    return [cause.sentence for cause in judgement.causes]


@pytest.mark.parametrize(
    ("kick", "scene", "h", "every"),
    by_turns(
        [
            (kick, *rows)
            for kick in WORDS
            for rows in (
                *((FREE, 0.01, 1), (FULL, 0.002, 50)),
                (FREE, 0.002, 50),
            )
        ],
        5,
    ),
)
def test_each_treatment_is_named(
    kick: Kick, scene: str, h: float, every: int, tmp_path: Path
) -> None:
    """Rows that are the steps, and rows many steps apart, show what the engine does and its step."""
    cause, *_ = causes(tmp_path, scene, engine(scene, kick, h, 41, every))
    assert cause.startswith(WORDS[kick])
    assert kick is none or f", h = {h:g}; " in cause


@pytest.mark.slow
def test_a_step_much_finer_than_the_rows_is_named(tmp_path: Path) -> None:
    """A hundred steps from row to row, on a body that flips: the first-order term alone says 108."""
    cause, *_ = causes(tmp_path, "engines/flip", engine("engines/flip", explicit, 0.02, 21, 100))
    assert cause.startswith("explicit gyroscopic step: explicit Euler, h = 0.02; ")


@pytest.mark.parametrize("kick", by_turns([explicit, implicit], 2))
@pytest.mark.parametrize("scene", by_turns(["euler/gyrostat", "euler/gyrostat-moment"], 2))
def test_a_step_for_a_body_with_wheels_is_named(scene: str, kick: Kick, tmp_path: Path) -> None:
    """The torque of the wheels is a part of the term: with it a first-order step explains everything."""
    cause, *_ = causes(tmp_path, scene, engine(scene, kick, 0.01, 41))
    assert cause.startswith(WORDS[kick])
    assert ", h = 0.01; " in cause


def test_two_faults_are_not_called_by_one(tmp_path: Path) -> None:
    """Its first order with the wheels is refuted, and a term without them alone leaves too much."""
    columns = engine("euler/gyrostat", without_wheels, 0.001, 41)
    assert not any("gyroscopic" in cause for cause in causes(tmp_path, "euler/gyrostat", columns))


def test_a_moment_is_no_gyroscopic_term(tmp_path: Path) -> None:
    """Under a moment an engine without the term still has omega grow by I^-1 M."""
    columns = engine("euler/constant-moment", none, 0.01, 21)
    assert columns["w1"][0] != columns["w1"][-1] or columns["w3"][0] != columns["w3"][-1]
    (cause,) = causes(tmp_path, "euler/constant-moment", columns)
    assert cause.startswith("no gyroscopic term; ")


def late(sound: Columns) -> Columns:
    return sound | {"t": [t + 0.005 for t in sound["t"]]}


def scaled(sound: Columns) -> Columns:
    return sound | {"w2": [1.001 * w for w in sound["w2"]]}


def noisy(sound: Columns) -> Columns:
    noise = np.random.default_rng(3).standard_normal(len(sound["t"]))
    return sound | {"w1": [float(w + 1e-6 * e) for w, e in zip(sound["w1"], noise, strict=True)]}


@pytest.mark.parametrize(
    ("spoil", "words"),
    [
        (late, []),
        (scaled, ["omega has factors "]),
        (noisy, ["omega contradicts the file's own attitude"]),
    ],
)
def test_another_error_is_not_called_a_gyroscopic_one(
    spoil: Callable[[Columns], Columns], words: list[str], tmp_path: Path
) -> None:
    """A wrong scale and noise have words of their own, and a late clock has no cause."""
    sound = {name: list(values) for name, values in exact_columns("euler/with-attitude").items()}
    named = causes(tmp_path, "euler/with-attitude", spoil(sound))
    assert [cause.split(",")[0].split("(")[0] for cause in named] == words
