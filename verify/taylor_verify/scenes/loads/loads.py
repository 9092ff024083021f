"""The loads of a scene: its texts, and the elementary steps that they are in each piece of time."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from typing import Final, NamedTuple

from taylor_verify.numbers.precision import Rung
from taylor_verify.numbers.tensors import ZERO_VECTOR, Matrix, Vector
from taylor_verify.scenes.loads.grammar import Fault
from taylor_verify.scenes.loads.piece import Piece, PieceReader
from taylor_verify.scenes.loads.rounded_steps import finished
from taylor_verify.scenes.loads.states import Continuous, Held, Instant, State, instants
from taylor_verify.scenes.loads.tables import Table
from taylor_verify.scenes.loads.vocabulary import (
    CENTRE,
    NO_DOUBTS,
    QUATERNION,
    ROTATION,
    TAKEN,
    VECTORS,
    Doubts,
    Entries,
    Entry,
)

_NO_JUMP: Final = "a rotor that does not jump: no `step`, `sign`, `floor`, `if` or hold table"
_OF_TIME: Final = "a rotor of t and of the scene's own states that have a rate"


class Hung(NamedTuple):
    """A force that is constant in space, at a point of the body (from its origin, body axes)."""

    force: Vector
    at: Vector = ZERO_VECTOR


@dataclass(frozen=True)
class Loads:
    """Loads in body axes as a scene writes them: the moment, or force and couple.

    ``vectors`` are their entries by name; ``hung`` are weight and buoyancy. ``definitions``, ``space`` and
    ``tables`` are what the texts may name; ``inertia`` is the tensor of a rigid body, for I11 to I33.
    ``current`` is the velocity of the fluid, space axes. ``states`` are the scene's own, and ``rotor`` is
    the momentum of the wheels where a text writes it, else empty.

    The input t of the steps is the time since ``origin``, the start of the scene; so are all times here.
    With a ``rung`` every number of the steps, and every knot of a table, is rounded to it once; switches
    follow from rounded numbers. The stairs of floor are known between the two times of ``reach``.
    ``functions`` are texts that are wanted along the motion, and act on nothing.
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
    states: tuple[State, ...] = ()
    rotor: Entries = ()
    reach: tuple[Fraction, Fraction] = (Fraction(0), Fraction(0))
    functions: tuple[str, ...] = ()

    @property
    def is_written(self) -> bool:
        """True if there is more than constant loads in body axes."""
        entries = (*self.rotor, *(entry for _, each in self.vectors for entry in each))
        has_text = any(isinstance(entry, str) for entry in entries)
        return has_text or bool(self.hung or any(self.current) or self.states)

    def reaching(self, elapsed: Fraction) -> Loads:
        """Return these loads with the stairs of floor as far as a time, if they reached less far."""
        first, last = self.reach
        if first <= elapsed <= last or not self._scan.known:
            return self
        return replace(self, reach=(min(first, elapsed), max(last, elapsed)))

    def on_rung(self, rung: Rung) -> Loads:
        """The loads that a solver on a rung receives.

        Raises ValueError where two knots of a table round to the same time.
        """
        rounded = replace(
            self, rung=rung, states=tuple(state.on_rung(rung) for state in self.states)
        )
        _ = rounded.switches
        return rounded

    def piece(self, time: Fraction, is_later: bool = True) -> Piece:
        """The piece that holds just after a time, or just before it.

        Raises ValueError beyond the stairs of floor that are known.
        """
        switches = self.switches
        k = bisect_right(switches, time)
        if not is_later and k and switches[k - 1] == time:
            k -= 1
        return self.numbered(k)

    def known_pieces(self) -> Iterator[Piece]:
        """Yield all pieces in the order of time, without those beyond the stairs of floor."""
        for k in range(len(self.switches) + 1):
            if self._is_known(*self._ends(k)):
                yield self.numbered(k)

    def numbered(self, k: int) -> Piece:
        """The piece before which so many switches are. Raises ValueError where it is not known."""
        if k not in self._pieces:
            begin, end = self._ends(k)
            if not self._is_known(begin, end):
                first, last = (str(self.origin + time) for time in self.reach)
                raise ValueError(
                    f"expected times between {first} and {last}, where the stairs of floor end"
                )
            self._pieces[k] = self._made(PieceReader(self, begin, end), begin, end)
        return self._pieces[k]

    def _ends(self, k: int) -> tuple[Fraction | None, Fraction | None]:
        switches = self.switches
        return switches[k - 1] if k else None, switches[k] if k < len(switches) else None

    def _is_known(self, begin: Fraction | None, end: Fraction | None) -> bool:
        return all(
            begin is not None and begin >= first and end is not None and end <= last
            for first, last in self._scan.known
        )

    def _made(self, reader: PieceReader, begin: Fraction | None, end: Fraction | None) -> Piece:
        groups = (
            reader.outputs(),
            reader.rates(),
            reader.values(),
            reader.rotor(),
            reader.functions(),
        )
        places = [place for group in groups for place in group]
        steps, left = finished(reader.steps.steps, places, self.rung)
        in_turn = iter(left)
        split = (tuple(next(in_turn) for _ in group) for group in groups)
        return Piece(begin, end, tuple(steps), *split)

    @cached_property
    def _pieces(self) -> dict[int, Piece]:
        return {}

    @cached_property
    def switches(self) -> Sequence[Fraction]:
        """The times at which the steps become others, sorted."""
        return sorted(self._scan.switches)

    @cached_property
    def inputs(self) -> frozenset[str]:
        """The names of all inputs that the steps have in any piece, own states among them."""
        return self._scan.reads()

    @cached_property
    def _scan(self) -> PieceReader:
        reader = PieceReader(self, is_scan=True)
        for read in (
            reader.outputs,
            reader.rates,
            reader.values,
            reader.rotor,
            reader.functions,
        ):
            read()
        return reader

    # States of the scene's own.

    @cached_property
    def continuous(self) -> tuple[str, ...]:
        """The components of all continuous states, in the scene's order; so are `Piece.rates`."""
        return tuple(n for s in self.states if isinstance(s, Continuous) for n in s.components)

    @cached_property
    def held_values(self) -> tuple[str, ...]:
        """The components of all held states, in the scene's order; so are `Piece.values`."""
        return tuple(name for state in self.held_states for name in state.components)

    @property
    def held_states(self) -> tuple[Held, ...]:
        """The states whose values are held, in the scene's order."""
        return tuple(state for state in self.states if isinstance(state, Held))

    def starting(self, own: Mapping[str, Vector]) -> Loads:
        """Return the same loads with other starts of the states, by their names."""
        states = tuple(
            state.starting(own[state.name]) if state.name in own else state for state in self.states
        )
        return replace(self, states=states)

    def instants(self, until: Fraction) -> tuple[Instant, ...]:
        """The elapsed times at which held states take their values, up to one, both ends included.

        Raises ValueError for more than ten thousand, and where two of them are one number of the rung.
        """
        return instants(self.held_states, until, self.rung)

    @property
    def reads_attitude(self) -> bool:
        """True if a load depends on the attitude or the centre."""
        return not self.inputs.isdisjoint((*ROTATION, *QUATERNION, *CENTRE))

    @property
    def reads_centre(self) -> bool:
        """True if a load depends on the centre."""
        return not self.inputs.isdisjoint(CENTRE)

    def faults(self, doubts: Doubts = NO_DOUBTS) -> Iterator[Fault]:
        """Yield the faults of all texts, also of definitions that nothing names, beyond the ``doubts``."""
        yield from PieceReader(self, is_scan=True, doubts=doubts).faults()
        yield from self._faults_of_rotor(doubts)
        yield from self._missing_starts(doubts)

    def faults_of_space(self, doubts: Doubts) -> Iterator[Fault]:
        """Yield what a scene lets no vector of [space] read, beyond the ``doubts``: its equations would."""
        yield from PieceReader(self, is_scan=True, doubts=doubts).faults_of_space()

    def _faults_of_rotor(self, doubts: Doubts) -> Iterator[Fault]:
        for i, entry in enumerate(self.rotor):
            place = f"body.rotor[{i}]"
            reader = PieceReader(self, is_scan=True, doubts=doubts)
            reader.look_at((entry,), place, is_vector=False)
            others = sorted(reader.reads().difference(("t", *self.continuous)))
            if others:
                yield Fault(place, 1, _OF_TIME, ", ".join(f"`{name}`" for name in others))
            if reader.jumps:
                yield Fault(place, 1, _NO_JUMP, "a jump by the time")

    def _missing_starts(self, doubts: Doubts) -> Iterator[Fault]:
        """Yield held states that are read before they are first taken, and have no start."""
        at_once = [state for state in self.held_states if not state.offset]
        first = self._read_by(at_once, doubts)
        for state in self.held_states:
            if state.start is None and (state.offset or not first.isdisjoint(state.components)):
                expected = "a start, as the state is read before it is first taken"
                yield Fault(f"states.{state.name}", 0, expected, "nothing")

    def _read_by(self, states: Sequence[Held], doubts: Doubts) -> frozenset[str]:
        reader = PieceReader(self, is_scan=True, doubts=doubts)
        for state in states:
            reader.look_at_state(state)
        return reader.reads()


__all__ = [
    "CENTRE",
    "QUATERNION",
    "ROTATION",
    "TAKEN",
    "VECTORS",
    "Entries",
    "Entry",
    "Hung",
    "Loads",
    "Piece",
]
