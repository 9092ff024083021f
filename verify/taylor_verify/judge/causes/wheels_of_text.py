"""Wheels whose momentum h is a text: H' = H x W + M with H = I W + h, of which simulators have a part.

What they lack, or have with the other sign, is a moment that the scene may write: W x h for the gyroscopic
term, and h' for the reaction of the motors.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Final

from taylor_verify.judge.causes.changed_texts import added
from taylor_verify.judge.causes.vectors_of_texts import cross, sum_of
from taylor_verify.scenes.loads.loads import Loads
from taylor_verify.scenes.loads.states import Continuous

_OMEGA: Final = ("w1", "w2", "w3")
_NONE: Final = ("0", "0", "0")
_TURNING: Final = "gyroscopic term of the wheels"


def half_wheels(loads: Loads) -> Iterator[tuple[str, Loads]]:
    """Yield loads whose wheels lack a term, or have it with the other sign, and without wheels."""
    if not loads.rotor:
        return
    yield "wheels left out", replace(loads, rotor=_NONE)
    h, own = [str(entry) for entry in loads.rotor], dict(_rates(loads))
    turning = cross(_OMEGA, h)
    yield from _otherwise(loads, _TURNING, turning)
    for k, part in enumerate(turning):
        alone = [part if k == i else "0" for i in range(3)]
        if part != "0":
            yield f"{_TURNING} left out on axis {k + 1}", added(loads, {"moment": alone})
            yield f"{_TURNING} with the other sign on axis {k + 1}", _twice(loads, alone)
    if all(entry in own or entry.replace(".", "").isdigit() for entry in h):
        reaction = [f"({own.get(entry, 0)})" for entry in h]
        yield from _otherwise(loads, "reaction of the wheels' motors", reaction)


def _otherwise(loads: Loads, term: str, moment: Sequence[str]) -> Iterator[tuple[str, Loads]]:
    """Yield the loads without a term, by the moment that undoes it, and with the other sign."""
    yield f"no {term}", added(loads, {"moment": moment})
    yield f"{term} with the other sign", _twice(loads, moment)


def _twice(loads: Loads, moment: Sequence[str]) -> Loads:
    return added(loads, {"moment": [sum_of([("2", part)]) for part in moment]})


def _rates(loads: Loads) -> Iterator[tuple[str, str]]:
    for state in loads.states:
        if isinstance(state, Continuous):
            yield from zip(state.components, map(str, state.rate), strict=True)
