"""Motions that any number explains: those along one line, and those that a method paces otherwise."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np

from taylor_verify.judge.causes.float_answer import Answer, velocities_of
from taylor_verify.judge.causes.lateness import at_other_times, true_states
from taylor_verify.judge.causes.many_flows import Floats
from taylor_verify.judge.causes.settled import FIT_ROWS

# A part of the time in which a motion changes by its own size.
_BRIEF: Final = 0.03
# Velocities that change along one direction leave this part in any other one.
_ON_A_LINE: Final = 1e-9
# A motion has one pace if a method changes it otherwise by less than this part, or so many roundings.
_OFF_PACE: Final = 1e-4
_OFF_ROUNDINGS: Final = 30.0


@dataclass(frozen=True)
class Shape:
    """The shape of the true motion beside an answer, whose ``floor`` is the rounding of the file."""

    answer: Answer
    floor: float

    @cached_property
    def is_on_a_line(self) -> bool:
        """True if the velocities change along one direction."""
        v = self.answer.truth.v / self.answer.sizes
        singular = np.linalg.svd(v - v[0], compute_uv=False)
        return bool(singular[1] <= _ON_A_LINE * singular[0])

    @cached_property
    def has_one_pace(self) -> bool:
        """True if a method of order two changes the pace of the motion alone."""
        few = self.answer.thinned(FIT_ROWS)
        return off_pace(few) < max(_OFF_PACE, _OFF_ROUNDINGS * self.floor)


def off_pace(answer: Answer) -> float:
    """Return the part of the second derivative of the true motion's rates that is not along the rates.

    A method of order two changes the rates by such derivatives. Where they are along the rates, as in a
    decay or a steady precession, it changes the pace alone, as another clock would.
    """
    nu, z = velocities_of(answer.right, answer.truth.v), true_states(answer, answer.n)

    def rates(late: float) -> Floats:
        shifts = np.full(answer.count, late)
        states = at_other_times(answer, z, shifts) if late else z
        every = answer.right.rates(answer.times + shifts, states)[0, : answer.n]
        return np.asarray(every / answer.sizes[:, None])

    now, span = rates(0.0), float(np.ptp(answer.times)) or 1.0
    turning = float(np.max(np.linalg.norm(nu[:, -3:], axis=1)))
    step = _BRIEF / max(turning, float(np.max(np.abs(now))), 1 / span)
    before, after = rates(-step), rates(step)
    bend = before - 2 * now + after
    along = np.sum(bend * now, axis=0) / np.maximum(np.sum(now**2, axis=0), 1e-300)
    size = float(np.linalg.norm(bend))
    return float(np.linalg.norm(bend - along * now)) / size if size > 0 else 0.0
