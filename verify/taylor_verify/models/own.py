"""States of a scene's own in a problem: their names in its form, their units, and what they begin with.

A continuous one is a state of the form, in a unit of its own. A held one is a parameter, in the scene's
units: it becomes another at each of its instants.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from fractions import Fraction
from typing import Final

from taylor_verify.models.units import binary
from taylor_verify.numbers.tensors import Vector
from taylor_verify.scenes.loads.loads import Loads
from taylor_verify.scenes.loads.states import Continuous

# No letter of a body, a load or a frame begins with these.
CONTINUOUS: Final = "own."
HELD: Final = "held."


def in_form(name: str, loads: Loads) -> str:
    """Return the name in a form of a component of a state; the name itself where it is none."""
    if name in loads.continuous:
        return CONTINUOUS + name
    return HELD + name if name in loads.held_values else name


def starts(loads: Loads) -> Vector:
    """Return where the continuous components begin."""
    return tuple(v for s in loads.states if isinstance(s, Continuous) for v in s.start)


def held_starts(loads: Loads) -> Vector:
    """Return the held components before their first instants; 0 where nothing reads that."""
    return tuple(value for state in loads.held_states for value in state.first)


def numbers(loads: Loads, held: Vector) -> dict[str, Fraction]:
    """Return the held components by their names in a form."""
    names = [HELD + name for name in loads.held_values]
    return dict(zip(names, held, strict=True))


def units_of(loads: Loads, rates: Sequence[float], time: Fraction) -> Vector:
    """Return the unit of each continuous component: what its state is of size one in.

    ``rates`` are those at the start, and ``time`` is what they last for. Both are estimates.
    """
    units: list[Fraction] = []
    left = iter(rates)
    for state in loads.states:
        if isinstance(state, Continuous):
            sizes = [abs(value) for value in state.start]
            sizes += [abs(Fraction(next(left))) * time for _ in state.start]
            units += [binary(max(sizes)) or Fraction(1)] * len(state.start)
    return tuple(units)


def framed(track: Collection[str], loads: Loads | None) -> Collection[str]:
    """Return what is tracked, and attitude and centre where a load reads them."""
    if loads is None:
        return track
    read = {"attitude": loads.reads_attitude, "centre": loads.reads_centre}
    return {*track, *(name for name, is_read in read.items() if is_read)}
