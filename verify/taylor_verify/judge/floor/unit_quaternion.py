"""The length of an answer's quaternions, which is 1 but for roundings.

An attitude is read from a quaternion of any length, so that no other gate sees the length. A solver that
rounds q in every step and takes none of it back leaves, after N steps, no more than

    | |q| - 1 |  <=  u N,

all roundings going one way. The row is there only where the length is beyond ten times that: then it
fails. A quaternion that is a unit one to roundoff needs no row to say so. A tolerance for the attitude
takes the place of the ten times.
"""

from __future__ import annotations

from math import log2
from typing import Final

import numpy as np

from taylor_verify.judge.errors.state import Errors
from taylor_verify.judge.floor.attainable import Floats, Floor
from taylor_verify.judge.gates import index_of_largest
from taylor_verify.records.quantities import UNIT_QUATERNION
from taylor_verify.records.reason import Carried, Reason, RoundoffFloor, shown

# A length is written out where six digits show that it is not 1.
_SHOWN: Final = 1e-4


def lengths(excess: Floats, base: Floor) -> tuple[Errors, Floats, Reason]:
    """Return the errors of length, what is attainable, and its terms; ``excess`` (n,) is |q| - 1."""
    errors = Errors(UNIT_QUATERNION, "1", np.abs(excess), np.zeros(len(excess)), {})
    elapsed = base.times / (np.max(base.times) or 1.0)
    steps = 1 + float(np.sum(base.steps_at)) * elapsed
    attainable = base.unit_roundoff * steps
    worst = index_of_largest(errors.doubles)
    ends = (float(np.min(excess)), float(np.max(excess)))
    extent = dict.fromkeys(_length(end, attainable[worst]) for end in ends)
    terms = RoundoffFloor(
        Carried.LENGTH,
        shown(float(attainable[worst])),
        round(-log2(base.unit_roundoff)),
        round(steps[worst]),
        lengths=" to ".join(extent),
    )
    return errors, attainable, Reason(floor=terms)


def _length(excess: float, roundings: float) -> str:
    """The length 1 + excess, with the digits that tell it from 1."""
    if abs(excess) <= roundings:
        return "1"
    return f"{1 + excess:.6g}" if abs(excess) > _SHOWN else f"1{excess:+.2g}"
