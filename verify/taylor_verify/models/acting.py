"""The loads that a scene writes down, as numbers: straight-line code made from their steps."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from functools import lru_cache
from math import inf, nextafter
from typing import Any

import numpy as np

from taylor_verify.models.form import labelled
from taylor_verify.models.frame import rotation
from taylor_verify.models.functions import FLOATS, Functions, functions_of
from taylor_verify.numbers.precision import exact_value
from taylor_verify.scenes.loads.loads import Loads, Piece
from taylor_verify.scenes.loads.steps import Step
from taylor_verify.scenes.scene import Scene

Floats = np.ndarray[Any, Any]


class Acting:
    """The loads of a scene, in its units and body axes.

    They are those of each piece of time; a switch belongs to the later one.
    """

    def __init__(self, scene: Scene, loads: Loads) -> None:
        self._loads, self._start = loads, scene.clock.start
        self._is_euler = scene.model == "euler"
        self._matrix = np.array(scene.body.energy_matrix, dtype=float)

    def __call__(self, t: Any, state: Any) -> Floats | tuple[Floats, Floats]:
        """Return the moment, or force and couple.

        ``t`` is the scene's time, and ``state`` omega, or x and y; then q0..q3 and the centre where a load
        reads them. Both may have more axes in front, the same for both. Raises ValueError for a state that
        is too short.
        """
        state = np.asarray(state, dtype=float)
        elapsed = np.asarray(t, dtype=float) - float(self._start)
        if state.ndim == 1 and elapsed.ndim == 0:
            values = self._at(float(elapsed), state)
        else:
            elapsed = np.broadcast_to(elapsed, state.shape[:-1])
            values = np.empty((*elapsed.shape, 3 if self._is_euler else 6))
            switches = [_not_before(switch) for switch in self._loads.switches]
            pieces = np.searchsorted(switches, elapsed, side="right")
            for piece in np.unique(pieces):
                rows = pieces == piece
                values[rows] = self._at(elapsed[rows], state[rows])
        return values if self._is_euler else (values[..., :3], values[..., 3:])

    def _at(self, elapsed: Any, state: Floats) -> Floats:
        is_one = state.ndim == 1
        columns = state.tolist() if is_one else list(state.T)
        inputs = self._inputs(elapsed, columns)
        first = elapsed if is_one else elapsed[0]
        function = _code(self._loads.piece(exact_value(first)), FLOATS if is_one else _arrays())
        values = function(**{name: inputs[name] for name in self._loads.inputs})
        return np.array(values) if is_one else np.array([v + 0 * elapsed for v in values]).T

    def _inputs(self, elapsed: Any, columns: Sequence[Any]) -> Mapping[str, Any]:
        n = 3 if self._is_euler else 6
        needed = n + 4 * self._loads.reads_attitude + 3 * self._loads.reads_centre
        if len(columns) < needed:
            raise ValueError(f"expected a state of {needed} numbers, got {len(columns)}")
        moving, q, c = columns[:n], columns[n : n + 4], columns[n + 4 : n + 7]
        inputs = {"t": elapsed, **labelled("c", c)}
        if self._is_euler:
            inputs |= labelled("w", moving)
        else:
            velocity = [sum(a * z for a, z in zip(r, moving, strict=True)) for r in self._matrix]
            inputs |= labelled("x", moving[:3]) | labelled("y", moving[3:])
            inputs |= labelled("u", velocity[:3]) | labelled("w", velocity[3:])
        if q:
            size = sum(e * e for e in q)
            R = rotation(q)
            inputs |= {f"q{i}": e / size**0.5 for i, e in enumerate(q)}
            inputs |= {f"r{i + 1}{j + 1}": R[i][j] / size for i in range(3) for j in range(3)}
        return inputs


def _not_before(switch: Fraction) -> float:
    """Return the first double that is not before a switch."""
    near = float(switch)
    return near if Fraction(near) >= switch else nextafter(near, inf)


def _arrays() -> Functions:
    return functions_of(np.empty(0))


def _code(piece: Piece, functions: Functions) -> Callable[..., list[Any]]:
    names = frozenset(step.name for step in piece.steps if step.operation == "input")
    return _compiled(piece.steps, piece.outputs, names, functions is FLOATS)


@lru_cache(maxsize=256)
def _compiled(
    steps: tuple[Step, ...], outputs: tuple[int, ...], names: frozenset[str], is_float: bool
) -> Callable[..., list[Any]]:
    """Return the function from the inputs, by name, to the loads."""
    known: dict[str, Any] = dict(FLOATS if is_float else _arrays())
    lines: list[str] = []
    for place, step in enumerate(steps):
        operands = [f"k{operand}" for operand in step.operands]
        if step.operation == "number":
            known[f"k{place}"] = float(step.number or 0)
            continue
        if step.operation == "power":
            known[f"e{place}"] = float(step.number or 0)
            operands.append(f"e{place}")
        if step.operation == "input":
            text = step.name
        elif step.operation in ("+", "-", "*", "/"):
            text = f" {step.operation} ".join(operands)
        else:
            text = f"{step.operation}({', '.join(operands)})"
        lines.append(f" k{place} = {text}")
    results = ", ".join(f"k{output}" for output in outputs)
    head = [f"def loads({''.join(f'{name}, ' for name in sorted(names))}**others):", *lines]
    # The text is made of the names of the grammar, of k0, e0, ... and of + - * / alone.
    exec("\n".join([*head, f" return [{results}]"]), known)
    made: Callable[..., list[Any]] = known["loads"]
    return made
