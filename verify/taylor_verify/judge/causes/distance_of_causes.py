"""Distance of a cause from the text of the scene: of causes that explain as well the nearest is said."""

from __future__ import annotations

from typing import Final

import numpy as np

from taylor_verify.judge.causes.candidate import Candidate
from taylor_verify.judge.causes.fit import FRAMES
from taylor_verify.judge.causes.fitted_bodies import described
from taylor_verify.judge.causes.float_answer import Answer
from taylor_verify.judge.causes.written_numbers import KIND as WRITTEN

# Times count frames if their clock is that of frames to so many digits.
_EXACTLY: Final = 1e-5


def distance(
    answer: Answer, candidate: Candidate
) -> tuple[int, bool, bool, bool, bool, bool, bool, int]:
    """Return the distance of a candidate from the text of the scene, as a key to sort by.

    Fewer numbers are nearer, and times that count frames, and what the scene writes. What it does not have
    is farther, and a number, and a clock, which no equation has, and a factor of more than one of its
    numbers. Of two numbers the one with fewer digits is nearer.
    """
    family, is_clock = candidate.family, candidate.kind == "clock"
    has_number = " = " in described(answer, candidate)[0]
    is_new = bool(candidate.count) and not np.any(family.right)
    digits = sum(len(f"{number:.6g}") for number in candidate.numbers)
    return (
        candidate.count,
        not (is_clock and _counts_frames(float(candidate.numbers[0]))),
        candidate.kind != WRITTEN,
        is_new,
        has_number,
        is_clock,
        not family.labels,
        digits,
    )


def _counts_frames(clock: float) -> bool:
    """Return True for times in frames, or in seconds where frames are expected."""
    count = max(clock, 1 / clock) if clock > 0 else 0.0
    return any(abs(count / frames - 1) < _EXACTLY for frames in FRAMES)
