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
# Ways in which many times are spread over pieces, of which the parts are kept.
_MOST_PARTS: Final = 64
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
        self._known_parts: dict[tuple[str, bytes], list[tuple[_Code, Any, Floats]]] = {}

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
    def _switches(self) -> Floats:
        return np.array([_not_before(switch) for switch in self.written.switches])

    def _reach(self, first: float, last: float) -> None:
        """Make the stairs of floor known as far as these times: a solver may look beyond the samples."""
        wider = self.written
        for time in (first, last):
            if time < wider.reach[0] or time > wider.reach[1]:
                wider = wider.reaching(exact_value(time))
        if wider is not self.written:
            self.written = wider
            vars(self).pop("_switches", None)
            self._known_parts.clear()

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
        times, states = elapsed.ravel(), state.reshape(elapsed.size, -1)
        own = None if held is None else held.reshape(elapsed.size, held.shape[-1])
        pieces = np.searchsorted(self._switches, times, side="right")
        if inside is not None or pieces.min() == pieces.max():
            values = self._at(which, times, states, own, inside)
        else:
            parts = self._parts(which, pieces)
            made = [
                self._evaluated(
                    code, times[rows], states[rows], None if own is None else own[rows], numbers
                )
                for code, rows, numbers in parts
            ]
            values = np.empty((elapsed.size, made[0].shape[-1]))
            for (_, rows, _), part in zip(parts, made, strict=True):
                values[rows] = part
        return values.reshape(*elapsed.shape, values.shape[-1])

    def _parts(self, which: str, pieces: Floats) -> list[tuple[_Code, Any, Floats]]:
        """Return each code that pieces have but for the numbers in it, its rows, and the numbers of each.

        The pieces of a table differ in nothing else. Steps of a method ask for the same ones many times.
        """
        key = which, pieces.tobytes()
        if key not in self._known_parts:
            codes = {
                piece: self._code(which, self.written.numbered(piece), is_one=False)
                for piece in np.unique(pieces).tolist()
            }
            own = [codes[piece] for piece in pieces.tolist()]
            texts = np.array([code.text for code in own])
            parts = list[tuple[_Code, Any, Floats]]()
            for text in dict.fromkeys(texts.tolist()):
                rows = np.flatnonzero(texts == text)
                numbers = np.array([own[row].numbers for row in rows]).T
                parts.append((own[rows[0]], rows, numbers))
            if len(self._known_parts) >= _MOST_PARTS:
                self._known_parts.clear()
            self._known_parts[key] = parts
        return self._known_parts[key]

    def _at(
        self,
        which: str,
        elapsed: Any,
        state: Floats,
        held: Floats | None,
        inside: Fraction | None = None,
    ) -> Floats:
        is_one = state.ndim == 1
        first = elapsed if is_one else elapsed[0]
        piece = self.written.piece(exact_value(first) if inside is None else inside)
        code = self._code(which, piece, is_one)
        return self._evaluated(code, elapsed, state, held, code.numbers)

    def _evaluated(
        self, code: _Code, elapsed: Any, state: Floats, held: Floats | None, numbers: Any
    ) -> Floats:
        """Return the values of a code whose numbers may be others for each of many states."""
        is_one = state.ndim == 1
        columns = state.tolist() if is_one else list(state.T)
        inputs = self._inputs(elapsed, columns, code.names) | self._held(held, is_one)
        if missing := code.names - inputs.keys():
            raise ValueError(f"expected the held values {', '.join(sorted(missing))}, got none")
        with np.errstate(all="ignore") if code.chooses else nullcontext():
            values = code.function(numbers, **{name: inputs[name] for name in code.names})
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
    """A function from numbers, and inputs by name, to values, and the names that it reads.

    One that ``chooses`` has a step that takes one of two values, of which the other need not exist.
    ``text`` is its own, in which the ``numbers`` do not stand.
    """

    function: Callable[..., list[Any]]
    names: frozenset[str]
    chooses: bool
    numbers: tuple[float, ...]
    text: str


@lru_cache(maxsize=256)
def _compiled(steps: tuple[Step, ...], outputs: tuple[int, ...], is_one: bool) -> _Code:
    """Return the function from the inputs of one state, or of many, to the values at some places."""
    chooses = any(step.operation == "choose" for step in steps)
    names, numbers, lines = set[str](), list[float](), list[str]()
    for place in needed(steps, outputs):
        step = steps[place]
        operands = [f"k{operand}" for operand in step.operands]
        if step.operation == "number":
            number = float(step.number or 0)
            text = repr(number) if is_one else f"numbers[{len(numbers)}]"
            numbers.append(number)
        elif step.operation == "input":
            text = f"in_{step.name}"
            names.add(step.name)
        elif step.operation in ("+", "-", "*", "/"):
            text = f" {step.operation} ".join(operands)
        else:
            exponent = [repr(float(step.number or 0))] * (step.operation == "power")
            text = f"{step.operation}({', '.join(operands + exponent)})"
        lines.append(f" k{place} = {text}")
    results = ", ".join(f"k{output}" for output in outputs)
    inputs = (f" in_{name} = inputs['{name}']" for name in sorted(names))
    text = "\n".join(["def loads(numbers, **inputs):", *inputs, *lines, f" return [{results}]"])
    # Floats would raise an error for the value that is not chosen.
    function = _made(text, has_floats=is_one and not chooses)
    return _Code(function, frozenset(names), chooses, tuple(numbers), text)


@lru_cache(maxsize=256)
def _made(text: str, has_floats: bool) -> Callable[..., list[Any]]:
    """Return the function of a text: the names of the scene and the grammar, k0, ... and + - * / alone."""
    known: dict[str, Any] = dict(FLOATS if has_floats else functions_of(np.empty(0)))
    exec(text, known)
    made: Callable[..., list[Any]] = known["loads"]
    return made
