"""The loads of a scene: its texts, and the elementary steps that they are in each piece of time."""

from __future__ import annotations

import keyword
from bisect import bisect_right
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property, partial
from itertools import chain, pairwise
from typing import Final, NamedTuple

from taylor_verify.numbers.precision import Rung
from taylor_verify.numbers.tensors import ZERO_VECTOR, Matrix, Vector
from taylor_verify.scenes.loads.grammar import ALL_FUNCTIONS, Fault, Grammar, Unread
from taylor_verify.scenes.loads.rounding import finished
from taylor_verify.scenes.loads.steps import NoStep, Step, Steps
from taylor_verify.scenes.loads.tables import Table

MOST_SWITCHES: Final = 10_000

Entry = Fraction | str
"""A number, or the text of an expression."""
Entries = tuple[Entry, ...]

ROTATION: Final = tuple(f"r{i}{j}" for i in (1, 2, 3) for j in (1, 2, 3))
QUATERNION: Final = ("q0", "q1", "q2", "q3")
CENTRE: Final = ("c1", "c2", "c3")
_INERTIA: Final = tuple(f"I{i}{j}" for i in (1, 2, 3) for j in (1, 2, 3))
_RATES: Final = ("w1", "w2", "w3")
_OF_BODY: Final[Mapping[str, tuple[str, ...]]] = {
    "euler": _RATES,
    "kirchhoff": (*_RATES, *(f"{letter}{i}" for letter in "uxy" for i in (1, 2, 3)), *CENTRE),
}
# The loads of a model, in the order of its outputs.
VECTORS: Final[Mapping[str, tuple[str, ...]]] = {
    "euler": ("moment",),
    "kirchhoff": ("force", "couple"),
}


def names(model: str) -> frozenset[str]:
    """The names that a scene of this model may use without defining them."""
    inertia = _INERTIA if model == "euler" else ()
    return frozenset(("t", "pi", *_OF_BODY[model], *QUATERNION, *ROTATION, *inertia))


# No scene may define these, so that a text has one meaning in both models. Words of Python are no names.
TAKEN: Final = frozenset(chain(names("euler"), names("kirchhoff"), ALL_FUNCTIONS, keyword.kwlist))


class Hung(NamedTuple):
    """A force that is constant in space, at a point of the body (from its origin, body axes)."""

    force: Vector
    at: Vector = ZERO_VECTOR


class Piece(NamedTuple):
    """The steps between two switches, None where there is none; ``outputs`` are those of the loads."""

    begin: Fraction | None
    end: Fraction | None
    steps: tuple[Step, ...]
    outputs: tuple[int, ...]


@dataclass(frozen=True)
class Loads:
    """Loads in body axes as a scene writes them: the moment, or force and couple.

    ``vectors`` are their entries by name; ``hung`` are weight and buoyancy. ``definitions``, ``space`` and
    ``tables`` are what the texts may name; ``inertia`` is the tensor of a rigid body, for I11 to I33.
    ``current`` is the velocity of the fluid, space axes.

    The input t of the steps is the time since ``origin``, the start of the scene; so are all times here.
    With a ``rung`` every number of the steps, and every knot of a table, is rounded to it once.
    """

    model: str
    vectors: tuple[tuple[str, Entries], ...]
    hung: tuple[Hung, ...] = ()
    definitions: tuple[tuple[str, Entry], ...] = ()
    space: tuple[tuple[str, Entries], ...] = ()
    tables: tuple[tuple[str, Table], ...] = ()
    inertia: Matrix | None = None
    current: Vector = ZERO_VECTOR
    origin: Fraction = Fraction(0)
    rung: Rung | None = None

    def on_rung(self, rung: Rung) -> Loads:
        """The loads that a solver on a rung receives.

        Raises ValueError where two knots of a table round to the same time.
        """
        rounded = replace(self, rung=rung)
        try:
            _ = rounded.switches
        except NoStep as fault:
            raise ValueError(str(fault)) from None
        return rounded

    def piece(self, time: Fraction, is_later: bool = True) -> Piece:
        """The piece that holds just after a time, or just before it."""
        switches = self.switches
        k = bisect_right(switches, time)
        if not is_later and k and switches[k - 1] == time:
            k -= 1
        return self._piece(k)

    def _piece(self, k: int) -> Piece:
        if k not in self._pieces:
            switches = self.switches
            begin = switches[k - 1] if k else None
            end = switches[k] if k < len(switches) else None
            reading = _Reading(self, begin, end)
            outputs = reading.outputs()
            steps, outputs = finished(reading.steps.steps, outputs, self.rung)
            self._pieces[k] = Piece(begin, end, tuple(steps), tuple(outputs))
        return self._pieces[k]

    @cached_property
    def _pieces(self) -> dict[int, Piece]:
        return {}

    @cached_property
    def switches(self) -> Sequence[Fraction]:
        """The times at which the steps become others, sorted."""
        return sorted(self._scan.switches)

    @cached_property
    def inputs(self) -> frozenset[str]:
        """The names of all inputs that the steps have in any piece."""
        return frozenset(s.name for s in self._scan.steps.steps if s.operation == "input")

    @cached_property
    def _scan(self) -> _Reading:
        reading = _Reading(self, is_scan=True)
        reading.outputs()
        return reading

    @property
    def reads_attitude(self) -> bool:
        """True if a load depends on the attitude or the centre."""
        return not self.inputs.isdisjoint((*ROTATION, *QUATERNION, *CENTRE))

    @property
    def reads_centre(self) -> bool:
        """True if a load depends on the centre."""
        return not self.inputs.isdisjoint(CENTRE)

    def faults(self) -> Iterator[Fault]:
        """Yield the faults of all texts, also of definitions that no load names."""
        yield from _Reading(self, is_scan=True).faults()


class _Reading:
    """The steps of all texts for the times between ``begin`` and ``end``.

    A scan notes the times of all switches; which branch it takes does not matter, as all are read.
    """

    def __init__(
        self,
        loads: Loads,
        begin: Fraction | None = None,
        end: Fraction | None = None,
        is_scan: bool = False,
    ) -> None:
        self._loads = loads
        self._is_scan = is_scan
        self._inside = _between(begin, end)
        self.steps = Steps()
        self.switches: set[Fraction] = set()
        self._grammar = Grammar(self.steps, self._named, self._is_after)
        self._definitions, self._tables = dict(loads.definitions), dict(loads.tables)
        self._space = {f"{n}{i + 1}": (n, i) for n, _ in loads.space for i in range(3)}
        self._vectors = dict(loads.space)
        self._places: dict[str, int] = {}
        self._faulty: set[str] = set()
        self._open: list[str] = []

    def outputs(self) -> list[int]:
        """The steps of the loads: three of a moment, or six of force and couple."""
        entries = dict(self._loads.vectors)
        vectors = [
            [
                self._entry(entry, f"body.{name}[{i}]")
                for i, entry in enumerate(entries.get(name, ZERO_VECTOR))
            ]
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
        if name not in self._places:
            if name in self._open:
                way = " -> ".join((*self._open, name))
                raise NoStep("a definition without itself", way)
            if name in self._faulty:
                raise Unread
            self._open.append(name)
            try:
                self._places[name] = self._meaning(name)
            except Unread:
                self._faulty.add(name)
                raise
            finally:
                self._open.pop()
        return self._places[name]

    def _meaning(self, name: str) -> int:
        if name in self._definitions:
            return self._entry(self._definitions[name], f"define.{name}")
        if name in self._space:
            vector, j = self._space[name]
            return self._in_body_axes(self._vectors[vector], j, f"space.{vector}")
        if name in self._tables:
            return self._tabulated(self._tables[name])
        if name == "pi":
            return self.steps.constant("pi")
        if name in _INERTIA and self._loads.inertia is not None:
            return self.steps.number(self._loads.inertia[int(name[1]) - 1][int(name[2]) - 1])
        if name == "t":
            time, begin = self.steps.input("t"), self.steps.number(self._loads.origin)
            return self.steps.combined("+", time, begin)
        if name in names(self._loads.model):
            return self.steps.input(name)
        raise NoStep("a known name", f"`{name}`")

    def _tabulated(self, table: Table) -> int:
        """The polynomial of a table, by Horner's rule."""
        table = self._since_start(table)
        if self._is_scan:
            self.switches.update(table.times)
        knot, coefficients = table.polynomial(self._inside)
        steps = self.steps
        time = steps.combined("-", steps.input("t"), steps.number(knot))
        place = steps.number(Fraction(0))
        for coefficient in reversed(coefficients):
            place = steps.combined("+", steps.combined("*", place, time), steps.number(coefficient))
        return place

    def _since_start(self, table: Table) -> Table:
        loads = self._loads
        times = [time - loads.origin for time in table.times]
        if loads.rung is not None:
            times = [loads.rung.round(time) for time in times]
            if any(a >= b for a, b in pairwise(times)):
                raise NoStep(
                    "knots of a table that differ", f"two that {loads.rung.name} makes one"
                )
        return replace(table, times=tuple(times))

    def _is_after(self, switch: Fraction) -> bool:
        if self._is_scan:
            self.switches.add(switch)
            if len(self.switches) > MOST_SWITCHES:
                raise NoStep(f"at most {MOST_SWITCHES} switches", "more")
        return self._inside >= switch

    # Faults.

    def faults(self) -> Iterator[Fault]:
        loads = self._loads
        for name, entries in loads.vectors:
            for i, entry in enumerate(entries):
                self._look_at(f"body.{name}[{i}]", partial(self._entry, entry))
        for name in self._definitions:
            self._look_at(f"define.{name}", partial(self._definition, name))
        for name, entries in loads.space:
            for i, entry in enumerate(entries):
                self._look_at(f"space.{name}[{i}]", partial(self._entry, entry))
        # The components of a vector share their texts.
        yield from dict.fromkeys(self._grammar.faults)

    def _definition(self, name: str, place: str) -> int:
        del place
        return self._named(name)

    def _look_at(self, place: str, read: Callable[[str], int]) -> None:
        try:
            read(place)
        except NoStep as fault:
            self._grammar.faults.append(Fault(place, 1, fault.expected, fault.got))
        except Unread:
            pass


def _between(begin: Fraction | None, end: Fraction | None) -> Fraction:
    """A time between two others, one of which may be missing."""
    if begin is None or end is None:
        return (end or Fraction(0)) - 1 if begin is None else begin + 1
    return (begin + end) / 2
