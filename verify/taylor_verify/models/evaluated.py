"""The values of a scene's own texts at one state, to a precision above that of a rung.

Where a held state is taken, and what the momentum of wheels is at a row: not a matter of equations.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Any, Final

from mpmath import mp

from taylor_verify.models.functions import functions_of
from taylor_verify.models.written import value
from taylor_verify.numbers.precision import exact_value
from taylor_verify.numbers.tensors import Vector
from taylor_verify.scenes.loads.loads import Loads, Piece
from taylor_verify.scenes.loads.steps import needed

# Beside the bits of a rung.
MORE_BITS: Final = 64


def wheels(loads: Loads, elapsed: Fraction, own: Vector, bits: int) -> Vector:
    """Return the momentum of wheels that a text writes, at a time and the scene's continuous states."""
    with mp.workprec(bits + MORE_BITS):
        inputs = dict(zip(("t", *loads.continuous), map(mp.convert, (elapsed, *own)), strict=True))
        piece = loads.piece(elapsed)
        return tuple(map(exact_value, evaluated(piece, piece.rotor, inputs)))


def evaluated(piece: Piece, places: Sequence[int], inputs: Mapping[str, Any]) -> list[Any]:
    """Return the values of the steps at some places, in the ambient precision of mpmath.

    Raises ArithmeticError or ValueError for one that has no value. A branch that is not chosen needs none.
    """
    functions, values = functions_of(mp.zero), dict[int, Any]()
    for place in needed(piece.steps, places):
        step = piece.steps[place]
        try:
            if step.operation == "number":
                values[place] = mp.convert(step.number)
            elif step.operation == "choose":
                condition, first, second = step.operands
                values[place] = values[first if _real(values[condition]) >= 0 else second]
            elif failed := [v for v in map(values.get, step.operands) if isinstance(v, Exception)]:
                values[place] = failed[0]
            else:
                values[place] = value(step, values, functions, inputs)
        except (ArithmeticError, ValueError) as error:
            values[place] = error
    return [_real(values[place]) for place in places]


def _real(value: Any) -> Any:
    """Return a value; raise the error that stands in its place."""
    if isinstance(value, Exception):
        raise value
    return value
