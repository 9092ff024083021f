"""Equations of one's own: a rate and a start for each name, in the expressions of loads."""

from __future__ import annotations

import keyword
from collections.abc import Mapping
from decimal import Decimal
from fractions import Fraction
from typing import Any, Final

from taylor_verify.records.faults import Faults, Refused, brief
from taylor_verify.scenes.loads.grammar import ALL_FUNCTIONS
from taylor_verify.scenes.loads.loads import Loads
from taylor_verify.scenes.loads.states import Continuous
from taylor_verify.scenes.loads.vocabulary import FIELD, Doubts, names
from taylor_verify.scenes.reading.loads import ENTRY, is_name
from taylor_verify.scenes.reading.states import MOST_COMPONENTS
from taylor_verify.scenes.reading.table import Number, Table, exact_number

_TAKEN: Final = frozenset((*names(FIELD), *ALL_FUNCTIONS, *keyword.kwlist))


def field_of(rates: Mapping[str, Any], start: Mapping[str, Any]) -> Loads:
    """Return the states of a field as those of loads without a body, which begin at t = 0.

    Raises Refused with the faults of all names, texts and numbers.
    """
    faults = Faults()
    texts, numbers = _names_of(rates, "rates", faults), _names_of(start, "start", faults)
    if texts and numbers:
        _check_names(texts, numbers, faults)
    states = _states(texts, numbers, faults)
    loads = Loads(FIELD, (), states=states)
    # A name that lacks its rate is known all the same.
    lost = {str(name) for name in (*texts, *numbers)}.difference(state.name for state in states)
    for place, column, expected, got in loads.faults(Doubts(frozenset(lost))):
        name = place.removeprefix("states.").removesuffix(".rate")
        faults.add(expected, got, f"rates.{name}, column {column}")
    if faults.lines:
        raise Refused(faults.lines)
    return loads


def _names_of(table: Any, what: str, faults: Faults) -> Mapping[str, Any]:
    """Return a table of names; an empty one after a fault."""
    if isinstance(table, Mapping) and table:
        return table
    faults.add("a dict from names to entries", brief(table), what)
    return {}


def _check_names(rates: Mapping[str, Any], start: Mapping[str, Any], faults: Faults) -> None:
    """Note names too many, and those that stand in one table alone."""
    if len(rates) > MOST_COMPONENTS:
        faults.add(f"at most {MOST_COMPONENTS} names", str(len(rates)), "rates")
    for name in [*(n for n in rates if n not in start), *(n for n in start if n not in rates)]:
        place = "start" if name in rates else "rates"
        faults.add(f"the {place.removesuffix('s')} of `{name}`", "nothing", place)


def _states(
    rates: Mapping[str, Any], start: Mapping[str, Any], faults: Faults
) -> tuple[Continuous, ...]:
    """Return the states of the rates; numbers of names without a rate are read as well."""
    texts, numbers = Table(rates, "rates", faults), Table(start, "start", faults)
    states = tuple(_state(texts, numbers, name) for name in list(rates)[:MOST_COMPONENTS])
    for name in numbers.left()[:MOST_COMPONENTS]:
        numbers.number(name, reader=_START)
    return states


def _state(texts: Table, numbers: Table, name: str) -> Continuous:
    if is_name(texts, str(name)) and name in _TAKEN:
        texts.fault("a name that is free", f"`{name}`", name)
    rate = texts.number(name, reader=_RATE)
    start = numbers.number(name, default=Fraction(0), reader=_START)
    return Continuous(name, (start or Fraction(0),), (rate or Fraction(0),), is_vector=False)


def _written(value: Any) -> Any:
    """Return a binary or rational number as a scene would write it; any other value as it is."""
    match value:
        case float():
            return Decimal(value)
        case Fraction():
            return str(value)
    return value


_RATE: Final = Number(lambda value: ENTRY.read(_written(value)), ENTRY.stand_in)
_START: Final = Number(lambda value: exact_number(_written(value)))
