"""Loads whose numbers are inputs, as held values are: many values of them go through one flow.

A dial is the input in the place of a literal, of the factor of a term, or of an entry that is a number.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any, Final

import numpy as np

from taylor_verify.judge.causes.changed_equations import Changes
from taylor_verify.judge.causes.changed_texts import terms
from taylor_verify.judge.causes.hung_loads import written_out
from taylor_verify.judge.causes.many_flows import Floats
from taylor_verify.judge.causes.texts import Place, places
from taylor_verify.models import own
from taylor_verify.models.acting import Acting
from taylor_verify.scenes.loads.loads import Loads
from taylor_verify.scenes.loads.states import Held

# A number but for an exponent: of a negative base it has no other value.
LITERAL: Final = re.compile(
    r"(?<![\w.^])(?<!\*\*)(?<!\^ )(?<!\*\* )(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?"
)
_NAME: Final = "dial_"
# Later than all runs: the values of dials are never taken.
_NEVER: Final = Fraction(10**9)
# Parts of the loads whose entries may be inputs.
_READABLE: Final = frozenset({"vectors", "definitions", "space", "hung", "rate", "value"})
# The path to a place, and what is turned there: an entry, the literal at a position, or a term.
Key = tuple[Any, str, int]


@dataclass(frozen=True)
class Dials:
    """Loads with dials, the values of all held components, and the place of each dial among these."""

    acting: Acting
    values: Floats
    places: dict[Key, int]

    def turned(self, keys: Iterable[tuple[Key, float]]) -> Changes:
        """Return the change of the scene by other values of some dials."""
        values = self.values.copy()
        for key, value in keys:
            values[self.places[key]] = value
        return {"acting": self.acting, "held": values}


def is_readable(place: Place) -> bool:
    """Return True if an input may stand at a place."""
    return not _READABLE.isdisjoint(place.path)


def entry(place: Place) -> Key:
    """Return the key of a number that is an entry."""
    return place.path, "entry", 0


def literal(place: Place, position: int) -> Key:
    """Return the key of the literal at a position of a text."""
    return place.path, "literal", position


def term(place: Place, k: int) -> Key:
    """Return the key of the factor of a term of a text."""
    return place.path, "term", k


def dials(acting: Acting, wanted: Iterable[Key]) -> Dials:
    """Return the loads of a scene with dials for some of their numbers; what a grammar refuses has none."""
    loads, keys = acting.written, frozenset(wanted)
    dialled = [pair for place in places(loads) if is_readable(place) for pair in _of(place, keys)]
    tried = _with_dials(loads, dialled)
    if next(tried.faults(), None) is not None:
        paths = dict.fromkeys(key[0] for key, _ in dialled)
        fine = [path for path in paths if _is_fine(loads, [d for d in dialled if d[0][0] == path])]
        dialled = [pair for pair in dialled if pair[0][0] in fine]
        tried = _with_dials(loads, dialled)
    first = len(loads.held_values)
    values = np.array(own.held_starts(tried), dtype=float)
    return Dials(acting.of(tried), values, {key: first + k for k, (key, _) in enumerate(dialled)})


def _is_fine(loads: Loads, dialled: list[tuple[Key, Fraction]]) -> bool:
    return next(_with_dials(loads, dialled).faults(), None) is None


def _of(place: Place, keys: frozenset[Key]) -> list[tuple[Key, Fraction]]:
    """Return the wanted dials of a place, with the values that the scene has."""
    if entry(place) in keys:
        return [(entry(place), Fraction(place.entry))]
    if not isinstance(place.entry, str):
        return []
    literals = [
        (literal(place, match.start()), Fraction(match.group()))
        for match in LITERAL.finditer(place.entry)
    ]
    factors = [(term(place, k), Fraction(1)) for k in range(len(terms(place.entry)))]
    return [pair for pair in (*literals, *factors) if pair[0] in keys]


def _with_dials(loads: Loads, dialled: list[tuple[Key, Fraction]]) -> Loads:
    names = {key: f"{_NAME}{k + 1}" for k, (key, _) in enumerate(dialled)}
    other, paths = loads, {key[0] for key in names}
    for place in places(loads):
        if place.path in paths:
            text = names.get(entry(place)) or _text(place, names)
            other = replace(place, loads=other).put(text)
    if not dialled:
        return other
    values = tuple(value for _, value in dialled)
    own_names = tuple(names.values())
    state = Held(_NAME, values, own_names, _NEVER, _NEVER, is_vector=True)
    other = replace(other, states=(*other.states, state))
    return written_out(other) if any(path[0] == "hung" for path in paths) else other


def _text(place: Place, names: dict[Key, str]) -> str:
    """Return a text with the names of its dials."""
    text = str(place.entry)
    parts, begin, written = terms(text), 0, list[str]()
    if parts == [f"({text})"]:
        begin = -1
    for k, part in enumerate(parts):

        def named(match: re.Match[str], begin: int = begin) -> str:
            return names.get(literal(place, begin + match.start()), match.group())

        words = LITERAL.sub(named, part).strip()
        if term(place, k) in names:
            sign = "-" if words.startswith("-") else "+"
            words = f"{sign} {names[term(place, k)]}*({words.lstrip('+-').strip()})"
        written.append(words)
        begin += len(part)
    return " ".join(written).removeprefix("+ ")
