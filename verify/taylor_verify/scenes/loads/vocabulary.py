"""Names that texts may use, and the vectors that texts are written for, by model."""

from __future__ import annotations

import keyword
from collections.abc import Mapping
from fractions import Fraction
from itertools import chain
from typing import Final, NamedTuple

Entry = Fraction | str
"""A number, or the text of an expression."""
Entries = tuple[Entry, ...]

ROTATION: Final = tuple(f"r{i}{j}" for i in (1, 2, 3) for j in (1, 2, 3))
QUATERNION: Final = ("q0", "q1", "q2", "q3")
CENTRE: Final = ("c1", "c2", "c3")
INERTIA: Final = tuple(f"I{i}{j}" for i in (1, 2, 3) for j in (1, 2, 3))
_RATES: Final = ("w1", "w2", "w3")
# The model of equations that are no body's: somebody's own rates.
FIELD: Final = "field"
_OF_BODY: Final[Mapping[str, tuple[str, ...]]] = {
    "euler": _RATES,
    "kirchhoff": (*_RATES, *(f"{letter}{i}" for letter in "uxy" for i in (1, 2, 3)), *CENTRE),
}
# The loads of a model, in the order of its outputs.
VECTORS: Final[Mapping[str, tuple[str, ...]]] = {
    "euler": ("moment",),
    "kirchhoff": ("force", "couple"),
    FIELD: (),
}
# What functions of the motion may name besides, in its order: kinetic energy and squares of momenta.
INVARIANTS: Final[Mapping[str, tuple[str, ...]]] = {
    "euler": ("T", "H2"),
    "kirchhoff": ("T", "F2", "FG"),
    FIELD: (),
}


class Doubts(NamedTuple):
    """Faults of a scene that leave the meaning of words in its texts open.

    Nothing is known of the ``names``. There may be names beside those that were read if ``are_names_lost``,
    and held values, which may use any definition, if ``are_values_lost``.
    """

    names: frozenset[str] = frozenset()
    are_names_lost: bool = False
    are_values_lost: bool = False

    def __or__(self, other: Doubts) -> Doubts:
        return Doubts(
            self.names | other.names,
            self.are_names_lost or other.are_names_lost,
            self.are_values_lost or other.are_values_lost,
        )


NO_DOUBTS: Final = Doubts()


def names(model: str) -> frozenset[str]:
    """The names that a scene of this model may use without defining them."""
    if model == FIELD:
        return frozenset(("t", "pi"))
    inertia = INERTIA if model == "euler" else ()
    return frozenset(("t", "pi", *_OF_BODY[model], *QUATERNION, *ROTATION, *inertia))


# No scene may define these, so that a text has one meaning in both models. Words of Python are no names.
# The names of functions are for tables alone: a table may be called `log`.
TAKEN: Final = frozenset(chain(names("euler"), names("kirchhoff"), keyword.kwlist))
