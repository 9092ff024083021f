"""The loads that a scene writes down, as numbers: straight-line code made from their steps."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import nullcontext
from fractions import Fraction
from functools import cached_property, lru_cache
from math import inf, nextafter
from typing import Any, Final, NamedTuple

import numpy as np

from taylor_verify.models.form import labelled
from taylor_verify.models.frame import rotation
from taylor_verify.models.functions import FLOATS, functions_of
from taylor_verify.numbers.precision import exact_value
from taylor_verify.scenes.loads.loads import Loads, Piece
from taylor_verify.scenes.loads.states import Instant
from taylor_verify.scenes.loads.steps import Step, needed
from taylor_verify.scenes.loads.vocabulary import QUATERNION, ROTATION
from taylor_verify.scenes.scene import Scene

Floats = np.ndarray[Any, Any]

_VELOCITIES: Final = ("u1", "u2", "u3", "w1", "w2", "w3")
_FRAME: Final = frozenset((*ROTATION, *QUATERNION))
# From the q of a state, whose length a method may let drift, the q that texts read, and R.
Frame = Callable[[Sequence[Any]], tuple[Sequence[Any], Sequence[Sequence[Any]]]]


def of_unit_length(q: Sequence[Any]) -> tuple[Sequence[Any], Sequence[Sequence[Any]]]:
    """Return q of unit length, and its R."""
    size = sum(e * e for e in q)
    return [e / size**0.5 for e in q], [[e / size for e in row] for row in rotation(q)]


class Acting:
    """The loads of a scene, and what its own states do, in its units and body axes.

    They are those of each piece of time; a switch belongs to the later one. ``t`` is the scene's time, and
    ``state`` omega, or x and y; then q0..q3 and the centre where a text reads them; then the continuous
    components of the scene's own states. ``held`` are the held ones. All may have more axes in front, the
    same for all. Raises ValueError for a state that is too short, and for held values that are missing.
    ``written`` are the loads as texts; ``frame`` is how they read the attitude.
    """

    def __init__(self, scene: Scene, loads: Loads, frame: Frame = of_unit_length) -> None:
        self._scene, self.written, self._start = scene, loads, scene.clock.start
        self._frame = frame
        self._is_euler = scene.model == "euler"
        self._matrix = np.array(scene.body.energy_matrix, dtype=float)
        self._codes: dict[tuple[str, Fraction | None, bool], _Code] = {}

    def of(self, loads: Loads) -> Acting:
        """Return other loads of the same scene."""
        return Acting(self._scene, loads, self._frame)

    def framed(self, frame: Frame) -> Acting:
        """Return the same loads, which read the attitude in another way."""
        return Acting(self._scene, self.written, frame)

    def __reduce__(self) -> tuple[Any, ...]:
        # Code that was made here is made again there.
        return Acting, (self._scene, self.written, self._frame)

    def loads(self, t: Any, state: Any, held: Any = None, inside: Fraction | None = None) -> Floats:
        """Return the moment (..., 3), or force and couple in one array (..., 6).

        They are those of the piece that has an elapsed time ``inside``, where one is given.
        """
        return self._values("outputs", t, state, held, inside)

    def rates(self, t: Any, state: Any, held: Any = None, inside: Fraction | None = None) -> Floats:
        """Return the rates of the continuous components."""
        return self._values("rates", t, state, held, inside)

    def rotor(self, t: Any, state: Any, inside: Fraction | None = None) -> Floats:
        """Return the momentum of the wheels that a text writes."""
        return self._values("rotor", t, state, None, inside)

    def functions(self, t: Any, state: Any) -> Floats:
        """Return the functions that are wanted along the motion, and act on nothing."""
        return self._values("functions", t, state, None)

    def taken(self, instant: Instant, state: Any, held: Any) -> Floats:
        """Return the held components after an instant, from those before it."""
        after = np.array(held, dtype=float)
        # A value that is taken on a switch is that of the later piece.
        time = _not_before(instant.time)
        values = self._at("values", time, np.asarray(state, dtype=float), after)
        after[list(instant.places)] = values[list(instant.places)]
        return after

    @cached_property
    def _switches(self) -> list[float]:
        return [_not_before(switch) for switch in self.written.switches]

    def _reach(self, first: float, last: float) -> None:
        """Make the stairs of floor known as far as these times: a solver may look beyond the samples."""
        wider = self.written
        for time in (first, last):
            if time < wider.reach[0] or time > wider.reach[1]:
                wider = wider.reaching(exact_value(time))
        if wider is not self.written:
            self.written = wider
            vars(self).pop("_switches", None)

    def _values(
        self, which: str, t: Any, state: Any, held: Any, inside: Fraction | None = None
    ) -> Floats:
        """Return the values of the steps that a field of a piece lists."""
        state = np.asarray(state, dtype=float)
        held = None if held is None else np.asarray(held, dtype=float)
        elapsed = np.asarray(t, dtype=float) - float(self._start)
        if state.ndim == 1 and elapsed.ndim == 0:
            if not np.isfinite(elapsed):
                raise ValueError(f"expected a time, got {t}")
            self._reach(float(elapsed), float(elapsed))
            return self._at(which, float(elapsed), state, held, inside)
        elapsed = np.broadcast_to(elapsed, state.shape[:-1])
        if not elapsed.size:
            return np.empty((*elapsed.shape, 0))
        if held is not None:
            held = np.broadcast_to(held, (*elapsed.shape, held.shape[-1]))
        self._reach(float(elapsed.min()), float(elapsed.max()))
        pieces = np.searchsorted(self._switches, elapsed, side="right")
        if inside is not None or pieces.min() == pieces.max():
            flat = None if held is None else held.reshape(elapsed.size, held.shape[-1])
            part = self._at(which, elapsed.ravel(), state.reshape(elapsed.size, -1), flat, inside)
            return part.reshape(*elapsed.shape, part.shape[-1])
        values: Floats | None = None
        for piece in np.unique(pieces):
            rows = pieces == piece
            part = self._at(which, elapsed[rows], state[rows], None if held is None else held[rows])
            if values is None:
                values = np.empty((*elapsed.shape, part.shape[-1]))
            values[rows] = part
        assert values is not None
        return values

    def _at(
        self,
        which: str,
        elapsed: Any,
        state: Floats,
        held: Floats | None,
        inside: Fraction | None = None,
    ) -> Floats:
        is_one = state.ndim == 1
        columns = state.tolist() if is_one else list(state.T)
        first = elapsed if is_one else elapsed[0]
        piece = self.written.piece(exact_value(first) if inside is None else inside)
        code = self._code(which, piece, is_one)
        inputs = self._inputs(elapsed, columns, code.names) | self._held(held, is_one)
        if missing := code.names - inputs.keys():
            raise ValueError(f"expected the held values {', '.join(sorted(missing))}, got none")
        with np.errstate(all="ignore") if code.chooses else nullcontext():
            values = code.function(**{name: inputs[name] for name in code.names})
        return (
            np.array(values, dtype=float)
            if is_one
            else np.array([v + 0 * elapsed for v in values]).T
        )

    def _code(self, which: str, piece: Piece, is_one: bool) -> _Code:
        # Steps take long to hash, as compiled code is looked up by them.
        key = which, piece.begin, is_one
        if key not in self._codes:
            self._codes[key] = _compiled(piece.steps, getattr(piece, which), is_one)
        return self._codes[key]

    def _held(self, held: Floats | None, is_one: bool) -> dict[str, Any]:
        if held is None:
            return {}
        columns, names = held.tolist() if is_one else list(held.T), self.written.held_values
        if len(columns) != len(names):
            raise ValueError(f"expected {len(names)} held values, got {len(columns)}")
        return dict(zip(names, columns, strict=True))

    def _inputs(
        self, elapsed: Any, columns: Sequence[Any], names: frozenset[str]
    ) -> dict[str, Any]:
        """Return what texts may read, as far as some of the ``names`` need it."""
        n, own = 3 if self._is_euler else 6, len(self.written.continuous)
        needed = n + 4 * self.written.reads_attitude + 3 * self.written.reads_centre + own
        if len(columns) < needed:
            raise ValueError(f"expected a state of {needed} numbers, got {len(columns)}")
        columns, last = columns[: len(columns) - own], columns[len(columns) - own :]
        moving, q, c = columns[:n], columns[n : n + 4], columns[n + 4 : n + 7]
        inputs = {"t": elapsed, **labelled("c", c)}
        inputs |= dict(zip(self.written.continuous, last, strict=True))
        if self._is_euler:
            inputs |= labelled("w", moving)
        else:
            inputs |= labelled("x", moving[:3]) | labelled("y", moving[3:])
            velocity = self._matrix @ np.array(moving)
            rows = velocity.tolist() if velocity.ndim == 1 else velocity
            inputs |= dict(zip(_VELOCITIES, rows, strict=True))
        if q and not names.isdisjoint(_FRAME):
            q, R = self._frame(q)
            inputs |= {f"q{i}": e for i, e in enumerate(q)}
            inputs |= {f"r{i + 1}{j + 1}": R[i][j] for i in range(3) for j in range(3)}
        return inputs


def _not_before(time: Fraction) -> float:
    """Return the first double that is not before a time."""
    near = float(time)
    return near if Fraction(near) >= time else nextafter(near, inf)


class _Code(NamedTuple):
    """A function from inputs by name to values, and the names that it reads.

    One that ``chooses`` has a step that takes one of two values, of which the other need not exist.
    """

    function: Callable[..., list[Any]]
    names: frozenset[str]
    chooses: bool


@lru_cache(maxsize=256)
def _compiled(steps: tuple[Step, ...], outputs: tuple[int, ...], is_one: bool) -> _Code:
    """Return the function from the inputs of one state, or of many, to the values at some places."""
    chooses = any(step.operation == "choose" for step in steps)
    # Floats would raise an error for the value that is not chosen.
    known: dict[str, Any] = dict(FLOATS if is_one and not chooses else functions_of(np.empty(0)))
    names = set[str]()
    lines: list[str] = []
    for place in needed(steps, outputs):
        step = steps[place]
        operands = [f"k{operand}" for operand in step.operands]
        if step.operation == "number":
            known[f"k{place}"] = float(step.number or 0)
            continue
        if step.operation == "power":
            known[f"e{place}"] = float(step.number or 0)
            operands.append(f"e{place}")
        if step.operation == "input":
            text = f"in_{step.name}"
            names.add(step.name)
        elif step.operation in ("+", "-", "*", "/"):
            text = f" {step.operation} ".join(operands)
        else:
            text = f"{step.operation}({', '.join(operands)})"
        lines.append(f" k{place} = {text}")
    results = ", ".join(f"k{output}" for output in outputs)
    head = ["def loads(**inputs):", *(f" in_{name} = inputs['{name}']" for name in sorted(names))]
    # The text is made of the names of the scene and the grammar, of k0, e0, ... and of + - * / alone.
    exec("\n".join([*head, *lines, f" return [{results}]"]), known)
    return _Code(known["loads"], frozenset(names), chooses)
