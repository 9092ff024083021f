"""Equations of one's own: a rate and a start for each name, in the expressions of loads."""

from __future__ import annotations

import keyword
from collections.abc import Mapping
from decimal import Decimal
from fractions import Fraction
from typing import Any, Final

from taylor_verify.records.faults import Faults, Refused, brief
from taylor_verify.scenes.loads.loads import Loads
from taylor_verify.scenes.loads.states import Continuous
from taylor_verify.scenes.loads.vocabulary import FIELD, names
from taylor_verify.scenes.reading.loads import ENTRY, is_name
from taylor_verify.scenes.reading.states import MOST_COMPONENTS
from taylor_verify.scenes.reading.table import Number, Table, exact_number

_TAKEN: Final = frozenset((*names(FIELD), *keyword.kwlist))


def field_of(rates: Mapping[str, Any], start: Mapping[str, Any], begin: Fraction) -> Loads:
    """Return the states of a field as those of loads without a body; ``t`` begins at ``begin``.

    Raises Refused with the faults of all names, texts and numbers.
    """
    faults = Faults()
    _check_tables(rates, start, faults)
    states = () if faults.lines else _states(rates, start, faults)
    loads = Loads(FIELD, (), origin=begin, states=states)
    if not faults.lines:
        for place, column, expected, got in loads.faults():
            name = place.removeprefix("states.").removesuffix(".rate")
            faults.add(expected, got, f"rates.{name}, column {column}")
    if faults.lines:
        raise Refused(faults.lines)
    return loads


def _check_tables(rates: Any, start: Any, faults: Faults) -> None:
    """Note what is no table of names, or does not fit the other one."""
    for what, table in (("rates", rates), ("start", start)):
        if not isinstance(table, Mapping) or not table:
            faults.add("a dict from names to entries", brief(table), what)
    if faults.lines:
        return
    if len(rates) > MOST_COMPONENTS:
        faults.add(f"at most {MOST_COMPONENTS} names", str(len(rates)), "rates")
    for name in [*(n for n in rates if n not in start), *(n for n in start if n not in rates)]:
        place = "start" if name in rates else "rates"
        faults.add(f"the {place.removesuffix('s')} of `{name}`", "nothing", place)


def _states(
    rates: Mapping[str, Any], start: Mapping[str, Any], faults: Faults
) -> tuple[Continuous, ...]:
    texts, numbers = Table(rates, "rates", faults), Table(start, "start", faults)
    return tuple(_state(texts, numbers, name) for name in rates)


def _state(texts: Table, numbers: Table, name: str) -> Continuous:
    if is_name(texts, str(name)) and name in _TAKEN:
        texts.fault("a name that is free", f"`{name}`", name)
    rate, start = texts.number(name, reader=_RATE), numbers.number(name, reader=_START)
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
