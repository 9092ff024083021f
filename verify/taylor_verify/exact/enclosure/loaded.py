"""The equations of a body, under loads that its scene writes down or without, and of own states.

An attitude that the scene tracks or a load depends on is in the state: as the quaternion e since the start,
e(0) = 1, so that R = R_0 R(e) with the attitude R_0 of the start. So is the centre. Then follow the scene's
own states, a block for each: those with a rate, and those whose values are held.

Under a rotor h of texts the state is H = I omega + h in place of omega, H' = H x omega + M with
omega = K (H - h): so no derivative of h is needed, which may have kinks.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from copy import copy
from fractions import Fraction
from typing import Any, Final

from flint import arb, arb_mat

from taylor_verify.exact.balls import ball_matrix, balls
from taylor_verify.exact.enclosure.box import Box, over_box
from taylor_verify.exact.enclosure.image import Image
from taylor_verify.exact.enclosure.layout import Layout
from taylor_verify.exact.enclosure.piece_tapes import PieceTapes
from taylor_verify.exact.enclosure.rationals import rational_values
from taylor_verify.exact.enclosure.system import Piece, System, Taken
from taylor_verify.exact.registry import kind_of
from taylor_verify.numbers.rotation import conjugate, product, rotation_matrix, rotation_rows
from taylor_verify.numbers.tensors import Vector
from taylor_verify.scenes.loads.loads import VECTORS, Loads
from taylor_verify.scenes.loads.states import Instant
from taylor_verify.scenes.loads.steps import text_with_address
from taylor_verify.scenes.motion import State
from taylor_verify.scenes.scene import Scene

# A turn since the start is a quaternion of any length.
_NO_TURN: Final = (Fraction(1), Fraction(0), Fraction(0), Fraction(0))


def posed(scene: Scene) -> System:
    """The equations of a scene's body, and where its motion begins."""
    return body_of(scene).system()


def body_of(scene: Scene) -> LoadedBody:
    """The body of a scene with its loads, if it has any."""
    return LoadedBody(scene, scene.body.loads or Loads(scene.model, ()))


class LoadedBody:
    """The tapes of one scene, each made when a motion comes to its piece of time.

    ``orders`` are those of the rates of change that functions of the motion are wanted with.
    """

    def __init__(
        self,
        scene: Scene,
        loads: Loads,
        orders: int = 0,
    ) -> None:
        self._scene, self._loads, self._orders = scene, loads, orders
        # The motion begins at a state, turned so since the scene's start, and with own states.
        self._initial, self._turn = scene.initial, _NO_TURN
        self._own: Mapping[str, Vector | None] = {s.name: s.start for s in loads.states}
        self._kind = kind_of(scene.body)
        self._layout = Layout(
            size=len(self._kind.state(scene.initial)),
            turns=bool(loads.reads_attitude or scene.track),
            travels=loads.reads_centre or "centre" in scene.track,
            declared=loads.states,
        )
        self._tapes: dict[Any, PieceTapes] = {}
        # Steps take long to hash, as tapes are looked up by them.
        self._tapes_from: dict[Fraction | None, PieceTapes] = {}

    def starting(self, initial: State, own: Mapping[str, Vector]) -> LoadedBody:
        """Return the same body from another start, with the same tapes: R_0 stays that of the scene.

        ``own`` are the states of the scene's own there, by their names.
        """
        other = copy(self)
        back = conjugate(self._scene.initial.attitude)
        other._initial, other._turn = initial, tuple(product(back, initial.attitude))
        other._own = own
        return other

    def system(self) -> System:
        """The equations, and where the motion begins."""
        loads = self._loads
        return System(
            pieces=self.piece,
            blocks=self._layout.blocks,
            start=self._start,
            framed=self._framed if self._scene.track else None,
            begin=self._begin if loads.rotor or self._turn != _NO_TURN else None,
            exactly=self._exactly() if loads.held_values else None,
            own=self._layout.own,
            instants=loads.instants if loads.held_values else None,
            taken=self._taken,
            step_text=self._step_text,
            moving=("the momentum",) if loads.rotor else self._kind.moving,
        )

    @property
    def _start(self) -> Vector:
        """The state at the start, without the momentum of a rotor of texts, and its turn of any length."""
        initial, layout = self._initial, self._layout
        start = self._kind.state(initial)
        if self._loads.rotor:
            start = self._kind.momentum(self._scene.body, start)
        if layout.turns:
            start += self._turn
        if layout.travels:
            start += self._kind.centre(initial) or ()
        for state in layout.states:
            start += self._own.get(state.name) or (Fraction(0),) * len(state.components)
        return start

    def _begin(self, time: Fraction) -> list[arb]:
        """The start in balls, its turn of unit length, with the momentum of the rotor at a time."""
        start, place = balls(self._start), self._layout.size
        turn = self._layout.turn(start)
        length = sum((e * e for e in turn), arb(0)).sqrt()
        start[place : place + len(turn)] = [e / length for e in turn]
        if not self._loads.rotor:
            return start
        box = Box.about(start)
        wheels = Image(self._tapes_at(time, is_later=True).wheels, box, time).outputs()
        added = over_box(box, *wheels)
        return [z + h for z, h in zip(start, added, strict=False)] + start[len(added) :]

    def _exactly(self) -> list[Any]:
        """The start in exact numbers; None for a component of H that is not rational."""
        start: list[Any] = list(self._start)
        if self._loads.rotor:
            tape = self._tapes_at(Fraction(0), is_later=True).wheels
            values = rational_values(tape, start, Fraction(0))
            wheels = [values[place] for place in tape.outputs]
            start[:3] = [None if h is None else z + h for z, h in zip(start, wheels, strict=False)]
        return start

    def _framed(self, state: Sequence[arb]) -> list[arb]:
        """The entries of R = R_0 R(e)."""
        start = ball_matrix(rotation_matrix(self._scene.initial.attitude))
        turn = list(self._layout.turn(state))
        entries: list[arb] = (start * arb_mat(rotation_rows(turn))).entries()
        return entries

    def piece(self, elapsed: Fraction, is_later: bool) -> Piece:
        """The tape from an elapsed time on."""
        piece, tapes = self._loads.piece(elapsed, is_later), self._tapes_at(elapsed, is_later)
        image = tapes.image if self._loads.rotor else None
        functions = tapes.functions(self._orders) if self._loads.functions else None
        return Piece(tapes.rates, piece.end if is_later else piece.begin, image, functions)

    def _tapes_at(self, elapsed: Fraction, is_later: bool) -> PieceTapes:
        piece = self._loads.piece(elapsed, is_later)
        if piece.begin not in self._tapes_from:
            steps = piece[2:]
            if steps not in self._tapes:
                self._tapes[steps] = PieceTapes(self._scene, self._layout, piece)
            self._tapes_from[piece.begin] = self._tapes[steps]
        return self._tapes_from[piece.begin]

    def _step_text(self, elapsed: Fraction, is_later: bool, place: int) -> str:
        """A step of the loads as text, with the first place of the scene that needs it."""
        piece = self._loads.piece(elapsed, is_later)
        addresses = [f"body.{v}[{i}]" for v in VECTORS[self._loads.model] for i in range(3)]
        addresses += [f"the rate of {name}" for name in self._loads.continuous]
        addresses += [f"the value of {name}" for name in self._loads.held_values]
        addresses += [f"body.rotor[{i}]" for i in range(3)]
        outputs = (*piece.outputs, *piece.rates, *piece.values, *piece.rotor)
        return text_with_address(piece.steps, place, zip(addresses, outputs, strict=False))

    def _taken(self, instant: Instant) -> Taken:
        """The values that are taken at an instant, by the later piece."""
        places = [place for name in instant.names for place in self._layout.own[name]]
        return Taken(self._tapes_at(instant.time, is_later=True).values(instant.places), places)
