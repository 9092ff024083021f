"""The elementary steps of all texts of a scene in one piece of time, between two switches."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import lru_cache, partial
from itertools import pairwise
from math import ceil, floor
from typing import TYPE_CHECKING, Final, NamedTuple

from taylor_verify.numbers.precision import Rung
from taylor_verify.numbers.tensors import ZERO_VECTOR, Vector
from taylor_verify.scenes.loads.grammar import Fault, Grammar, Unread
from taylor_verify.scenes.loads.states import Continuous, Held, State
from taylor_verify.scenes.loads.steps import NoStep, Step, Steps, needed
from taylor_verify.scenes.loads.tables import Kind, Table
from taylor_verify.scenes.loads.vocabulary import (
    CENTRE,
    INERTIA,
    INVARIANTS,
    NO_DOUBTS,
    VECTORS,
    Doubts,
    Entries,
    Entry,
    names,
)

if TYPE_CHECKING:
    from taylor_verify.scenes.loads.loads import Loads

MOST_SWITCHES: Final = 10_000
# The place of a text that is no part of a scene.
FUNCTION: Final = "event"
_TOO_MANY: Final = f"at most {MOST_SWITCHES} switches"
# The inputs of vectors that are given by their space components.
_IN_SPACE: Final = frozenset(("t", *CENTRE))
_OF_SPACE: Final = "t, c1 to c3, tables, and definitions of these, in a vector of [space]"


class Piece(NamedTuple):
    """The steps between two switches, None where there is none, and the places of results among them.

    ``outputs`` are the loads, ``rates`` those of all continuous components, ``values`` those of all held
    components, and ``rotor`` the momentum of the wheels where a text writes it, else empty. ``functions``
    are wanted along the motion. Steps of values alone may be "sign", "step", "floor", and "choose", whose
    operands are a, b and c: b if a >= 0 else c, of which the one that is not chosen may have no value.
    """

    begin: Fraction | None
    end: Fraction | None
    steps: tuple[Step, ...]
    outputs: tuple[int, ...]
    rates: tuple[int, ...] = ()
    values: tuple[int, ...] = ()
    rotor: tuple[int, ...] = ()
    functions: tuple[int, ...] = ()


class PieceReader:
    """The steps of all texts for the times between ``begin`` and ``end``.

    A scan notes the times of all switches; which branch it takes does not matter, as all are read. No text
    is read beyond a name in ``doubts``.
    """

    def __init__(
        self,
        loads: Loads,
        begin: Fraction | None = None,
        end: Fraction | None = None,
        is_scan: bool = False,
        doubts: Doubts = NO_DOUBTS,
    ) -> None:
        self._loads = loads
        self._is_scan = is_scan
        self._doubts = doubts
        self._is_in_space = False
        self._inside = _between(begin, end)
        self.steps = Steps()
        self.switches: set[Fraction] = set()
        self.jumps = False
        # The times between which each staircase has all of its switches.
        self.known: list[tuple[Fraction, Fraction]] = []
        self._grammar = Grammar(self.steps, self._named, self._is_past, self._on_stairs)
        self._definitions, self._tables = dict(loads.definitions), dict(loads.tables)
        self._space = {f"{n}{i + 1}": (n, i) for n, _ in loads.space for i in range(3)}
        self._vectors = dict(loads.space)
        self._own = {name for state in loads.states for name in state.components}
        # A name in a value may jump with the state, and is read apart.
        self._places: dict[tuple[str, bool], int] = {}
        self._faulty: set[tuple[str, bool]] = set()
        self._open: list[str] = []

    def outputs(self) -> list[int]:
        """The steps of the loads: three of a moment, or six of force and couple."""
        entries = dict(self._loads.vectors)
        vectors = [
            self.entries(entries.get(name, ZERO_VECTOR), f"body.{name}")
            for name in VECTORS[self._loads.model]
        ]
        for hung in self._loads.hung:
            force = [self._in_body_axes(hung.force, j, "body") for j in range(3)]
            parts = [force, self._moment(hung.at, force)][-len(vectors) :]
            for vector, part in zip(vectors, parts, strict=True):
                vector[:] = [
                    self.steps.combined("+", a, b) for a, b in zip(vector, part, strict=True)
                ]
        return [place for vector in vectors for place in vector]

    def rotor(self) -> list[int]:
        """The steps of the momentum of the wheels; none where no text writes it."""
        return self.entries(self._loads.rotor, "body.rotor")

    def functions(self) -> list[int]:
        """The steps of functions of the motion."""
        return self.entries(self._loads.functions, FUNCTION)

    def rates(self) -> list[int]:
        """The steps of the rates of all continuous components."""
        return [
            place
            for state in self._loads.states
            if isinstance(state, Continuous)
            for place in self.entries(state.rate, f"states.{state.name}.rate", state.is_vector)
        ]

    def values(self) -> list[int]:
        """The steps of the values of all held components; these alone may jump with the state."""
        self._grammar.may_jump = True
        places = [
            place
            for state in self._loads.states
            if isinstance(state, Held)
            for place in self.entries(state.value, f"states.{state.name}.value", state.is_vector)
        ]
        self._grammar.may_jump = False
        return places

    def entries(self, entries: Entries, place: str, is_vector: bool = True) -> list[int]:
        """The steps of numbers and texts, which stand at this place of the scene."""
        return [self._entry(*each) for each in _placed(entries, place, is_vector)]

    def reads(self) -> frozenset[str]:
        """The names of all inputs of the steps so far."""
        return frozenset(s.name for s in self.steps.steps if s.operation == "input")

    def _entry(self, entry: Entry, place: str) -> int:
        if isinstance(entry, str):
            return self._grammar.read(entry, place)
        return self.steps.number(entry)

    def _in_body_axes(self, vector: Sequence[Entry], j: int, place: str) -> int:
        """Component j of R^T v, for a vector by its components in space."""
        return self.steps.total(
            [
                self.steps.combined(
                    "*",
                    self.steps.input(f"r{i + 1}{j + 1}"),
                    self._entry(vector[i], f"{place}[{i}]"),
                )
                for i in range(3)
            ]
        )

    def _moment(self, at: Vector, force: Sequence[int]) -> list[int]:
        """The cross product of a point and a force."""
        steps = self.steps

        def product(i: int, j: int) -> int:
            return steps.combined("*", steps.number(at[i]), force[j])

        return [
            steps.combined("-", product(j, k), product(k, j)) for j, k in ((1, 2), (2, 0), (0, 1))
        ]

    # Names.

    def _named(self, name: str) -> int:
        key = name, self._grammar.may_jump
        if key not in self._places:
            if name in self._open:
                way = " -> ".join((*self._open, name))
                raise NoStep("a definition without itself", way)
            if key in self._faulty:
                raise Unread
            self._open.append(name)
            try:
                self._places[key] = self._meaning(name)
            except Unread:
                self._faulty.add(key)
                raise
            finally:
                self._open.pop()
        if self._is_in_space and not self._open:
            self._check_in_space(name, self._places[key])
        return self._places[key]

    def _check_in_space(self, name: str, place: int) -> None:
        """Raise NoStep for a name that leads to more than a vector by its space components may read."""
        steps = self.steps.steps
        inputs = {steps[k].name for k in needed(steps, [place]) if steps[k].operation == "input"}
        if others := sorted(inputs.difference(_IN_SPACE, {name})):
            raise NoStep(_OF_SPACE, f"`{name}`, which reads `{others[0]}`")
        if not inputs <= _IN_SPACE:
            raise NoStep(_OF_SPACE, f"`{name}`")

    def _meaning(self, name: str) -> int:
        if name in self._doubts.names:
            raise Unread
        if name in self._definitions:
            return self._entry(self._definitions[name], f"define.{name}")
        if name in self._space:
            vector, j = self._space[name]
            return self._in_body_axes(self._vectors[vector], j, f"space.{vector}")
        if name in self._tables:
            return self._tabulated(self._tables[name])
        if name == "pi":
            return self.steps.constant("pi")
        if name in INERTIA and self._loads.inertia is not None:
            return self.steps.number(self._loads.inertia[int(name[1]) - 1][int(name[2]) - 1])
        if name == "t":
            time, begin = self.steps.input("t"), self.steps.number(self._loads.origin)
            return self.steps.combined("+", time, begin)
        if name in names(self._loads.model) or name in self._own or self._is_invariant(name):
            return self.steps.input(name)
        if self._doubts.are_names_lost:
            raise Unread
        raise NoStep("a known name", f"`{name}`")

    def _is_invariant(self, name: str) -> bool:
        """Return True for a name that functions of the motion alone may use."""
        return bool(self._loads.functions) and name in INVARIANTS[self._loads.model]

    # Switches.

    def _tabulated(self, table: Table) -> int:
        """The polynomial of a table, by Horner's rule."""
        table = _since_start(table, self._loads.origin, self._loads.rung)
        self.jumps |= table.kind is Kind.HOLD
        if self._is_scan:
            self.switches.update(table.times)
        knot, coefficients = table.polynomial(self._inside)
        steps = self.steps
        time = steps.combined("-", steps.input("t"), steps.number(knot))
        place = steps.number(Fraction(0))
        for coefficient in reversed(coefficients):
            place = steps.combined("+", steps.combined("*", place, time), steps.number(coefficient))
        return place

    def _on_rung(self, number: Fraction) -> Fraction:
        """A number, rounded once to the rung if there is one."""
        return number if self._loads.rung is None else self._loads.rung.round(number)

    def _is_past(self, slope: Fraction, value: Fraction) -> bool:
        """Return True if slope t + value, which is not constant, is not negative in this piece of time."""
        slope, value = self._on_rung(slope), self._on_rung(value)
        if not slope:
            return value >= 0
        is_after = self._is_after(-value / slope)
        return is_after if slope > 0 else not is_after

    def _is_after(self, switch: Fraction) -> bool:
        self.jumps = True
        if self._is_scan:
            self.switches.add(switch)
            self._check_switches(len(self.switches))
        return self._inside >= switch

    def _on_stairs(self, slope: Fraction, value: Fraction) -> int:
        """The step of floor(slope t + value) on which this piece of time stands.

        A scan notes each time within the reach of the loads at which it is another one, and the next ones
        on both sides, beyond which nothing is known.
        """
        self.jumps = True
        slope, value = self._on_rung(slope), self._on_rung(value)
        if self._is_scan and slope:
            ends = [slope * time + value for time in self._loads.reach]
            first, last = ceil(min(ends)) - 1, floor(max(ends)) + 1
            self._check_switches(len(self.switches) + last - first + 1)
            stairs = sorted((k - value) / slope for k in range(first, last + 1))
            self.switches.update(stairs)
            self.known.append((stairs[0], stairs[-1]))
        return floor(slope * self._inside + value)

    def _check_switches(self, count: int) -> None:
        if count > MOST_SWITCHES:
            raise NoStep(_TOO_MANY, "more")

    # Faults.

    def faults(self) -> Iterator[Fault]:
        """Yield the faults of all texts, also of definitions that nothing names."""
        loads = self._loads
        for name, entries in loads.vectors:
            self.look_at(entries, f"body.{name}")
        self.look_at(loads.rotor, "body.rotor")
        for state in loads.states:
            self.look_at_state(state)
        for name in self._definitions:
            self._grammar.may_jump = self._stands_in_values_alone(name)
            self._look_at_one(partial(self._named, name), f"define.{name}")
        for name, entries in loads.space:
            components = [f"{name}{i}" for i in (1, 2, 3)]
            self._grammar.may_jump = any(map(self._stands_in_values_alone, components))
            self.look_at(entries, f"space.{name}")
        # The components of a vector share their texts.
        yield from dict.fromkeys(self._grammar.faults)

    def faults_of_space(self) -> Iterator[Fault]:
        """Yield the names in vectors of [space] that lead to more than such a vector may read."""
        self._is_in_space = self._grammar.may_jump = True
        for name, entries in self._loads.space:
            self.look_at(entries, f"space.{name}")
        yield from (fault for fault in self._grammar.faults if fault.expected == _OF_SPACE)

    def _stands_in_values_alone(self, name: str) -> bool:
        asked = self._places.keys() | self._faulty
        is_in_values = (name, True) in asked or self._doubts.are_values_lost
        return is_in_values and (name, False) not in asked

    def look_at_state(self, state: State) -> None:
        """Read the rate or the value of a state; faults are for `faults` to yield."""
        self._grammar.may_jump = isinstance(state, Held)
        key = "value" if self._grammar.may_jump else "rate"
        self.look_at(state.entries, f"states.{state.name}.{key}", state.is_vector)

    def look_at(self, entries: Entries, place: str, is_vector: bool = True) -> None:
        """Read entries as far as they have no faults, which are for `faults` to yield."""
        for entry, where in _placed(entries, place, is_vector):
            self._look_at_one(partial(self._entry, entry, where), where)

    def _look_at_one(self, read: Callable[[], int], place: str) -> None:
        try:
            read()
        except NoStep as fault:
            self._grammar.faults.append(Fault(place, 1, fault.expected, fault.got))
        except Unread:
            pass


def _placed(entries: Entries, place: str, is_vector: bool) -> list[tuple[Entry, str]]:
    """Pair each entry with its place."""
    return [(entry, f"{place}[{i}]" if is_vector else place) for i, entry in enumerate(entries)]


@lru_cache(maxsize=64)
def _since_start(table: Table, origin: Fraction, rung: Rung | None) -> Table:
    """A table by the times since the start, rounded to a rung if there is one: each piece asks for it."""
    times = [time - origin for time in table.times]
    if rung is not None:
        times = [rung.round(time) for time in times]
        if any(a >= b for a, b in pairwise(times)):
            raise NoStep("knots of a table that differ", f"two that {rung.name} makes one")
    return replace(table, times=tuple(times))


def _between(begin: Fraction | None, end: Fraction | None) -> Fraction:
    """A time between two others, one of which may be missing."""
    if begin is None or end is None:
        return (end or Fraction(0)) - 1 if begin is None else begin + 1
    return (begin + end) / 2
