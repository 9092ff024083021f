"""The rates of a body under written loads, as polynomials in its state and its frame.

The symbols are the components of omega or of the impulses, the unit quaternion q0..q3, the centre c1..c3
and the time t. Every function of a load that is no polynomial is one more symbol, of which nothing is
known: what is zero for all of its values is zero.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, reduce
from itertools import chain, repeat
from operator import add, sub
from typing import Any, Final

from taylor_verify.exact.conserved.polynomial import (
    Polynomial,
    TooLong,
    multiplied,
    rate_of,
    reduced,
    symbols_of,
)
from taylor_verify.exact.quadratic_forms import Equations, Exact
from taylor_verify.exact.registry import kind_of
from taylor_verify.numbers import rotation
from taylor_verify.numbers.irrational import rational
from taylor_verify.numbers.tensors import Matrix, Vector
from taylor_verify.records.quantities import COLUMNS
from taylor_verify.scenes.loads.loads import CENTRE, QUATERNION, Piece
from taylor_verify.scenes.loads.steps import Step
from taylor_verify.scenes.scene import Scene

Row = list[Polynomial]

# Powers up to this one are written out.
_MOST_POWER: Final = 4
_ARITHMETIC: Final[Mapping[str, Callable[[Polynomial, Polynomial], Polynomial]]] = {
    "+": add,
    "-": sub,
    "*": multiplied,
}
_MOMENTUM: Final = ("H1", "H2", "H3")
# What is no symbol, whatever its operands are.
_SUMS: Final = ("input", "number", "+", "-")


@dataclass(frozen=True)
class Derivation:
    """The state, the frame and their rates, under the loads of one piece of time.

    ``known`` are all symbols by name.
    """

    scene: Scene
    piece: Piece
    known: Mapping[str, Polynomial]

    @classmethod
    def each(cls, scene: Scene, pieces: Sequence[Piece]) -> list[Derivation]:
        """The derivations of some pieces, with the same symbols."""
        moving = (COLUMNS[name] for name in kind_of(scene.body).moving)
        steps = [(k, step) for piece in pieces for k, step in enumerate(piece.steps)]
        read = (step.name for _, step in steps if step.operation == "input")
        made = (_symbol(k) for k, step in steps if step.operation not in _SUMS)
        known = symbols_of(chain(*moving, _MOMENTUM, CENTRE, read, made))
        return [cls(scene, piece, known) for piece in pieces]

    @cached_property
    def equations(self) -> Equations:
        """The equations of the state without the written loads."""
        return kind_of(self.scene.body).equations(self.scene.body)

    @property
    def has_rotor(self) -> bool:
        """True if texts write the momentum h of wheels: then the symbols are those of H = I omega + h."""
        loads = self.scene.body.loads
        return loads is not None and bool(loads.rotor)

    def symbols(self, names: Sequence[str]) -> Row:
        """The symbols of these names."""
        return [self.known[name] for name in names]

    @cached_property
    def names(self) -> tuple[str, ...]:
        """The symbols of the state."""
        if self.has_rotor:
            return _MOMENTUM
        moving = kind_of(self.scene.body).moving
        return tuple(column for name in moving for column in COLUMNS[name])

    @cached_property
    def state(self) -> Row:
        """The state z; of a body with wheels omega, by H."""
        if not self.has_rotor:
            return self.symbols(self.names)
        return mapped(kind_of(self.scene.body).pushed(self.scene.body), self._of_body)

    @property
    def _of_body(self) -> Row:
        """I omega = H - h."""
        return [*map(sub, self.symbols(_MOMENTUM), self.wheels)]

    @cached_property
    def wheels(self) -> Row:
        """The momentum h of wheels, by time and own states. Raises TooLong."""
        values = self.values({})
        return [values[place] for place in self.piece.rotor]

    @cached_property
    def _quaternion(self) -> list[Any]:
        return self.symbols(QUATERNION)

    @cached_property
    def attitude(self) -> list[Row]:
        """R of the unit quaternion."""
        rows = rotation.rotation_rows(self._quaternion)
        return [[*map(reduced, row)] for row in rows]

    @cached_property
    def rates(self) -> Mapping[str, Polynomial]:
        """The rates of all symbols that change as the equations say."""
        rates = dict(zip(self.names, self._of_state(), strict=True))
        rates |= dict(zip(QUATERNION, self._of_attitude(), strict=True))
        if len(self.equations.velocity):
            rates |= dict(zip(CENTRE, self._of_centre(), strict=True))
        return rates

    def turned(self, vector: Row) -> Row:
        """R v: a vector in space axes."""
        return [product(row, vector) for row in self.attitude]

    def rate(self, quantity: Polynomial) -> Polynomial:
        """The rate of a polynomial in state and frame. Raises TooLong."""
        return rate_of(quantity, self.rates)

    # The rates of the symbols.

    def _of_state(self) -> Row:
        equations, z = self.equations, self.state
        if self.has_rotor:
            turned = cross(self.symbols(_MOMENTUM), z)
            damping = rational(self.scene.body.damping)
            drag = [part * damping for part in self._of_body]
            return [*map(sub, map(add, turned, self.loads), drag)]
        pushed = mapped(kind_of(self.scene.body).pushed(self.scene.body), self.loads)
        rates = []
        for constant, linear, hessian, push in zip(
            equations.constant, equations.linear, equations.hessian, pushed, strict=True
        ):
            half = [sum_of(row, z) / 2 for row in hessian]
            free = sum_of(linear, z) + rational(constant)
            rates.append(free + push + product(z, half))
        return rates

    def _of_attitude(self) -> Row:
        """q' = q Omega/2."""
        doubled = rotation.product(self._quaternion, [0 * self.spin[0], *self.spin])
        return [reduced(rate) / 2 for rate in doubled]

    def _of_centre(self) -> Row:
        """c' = R U and the current."""
        loads = self.scene.body.loads
        currents = repeat(Fraction(0), 3) if loads is None else loads.current
        return [
            moved + rational(current)
            for current, moved in zip(currents, self.turned(self.velocity), strict=True)
        ]

    @cached_property
    def spin(self) -> Row:
        """Omega."""
        return mapped(self.equations.spin, self.state)

    @cached_property
    def velocity(self) -> Row:
        """U; no components for a body whose origin does not move."""
        return mapped(self.equations.velocity, self.state)

    # The loads.

    @cached_property
    def loads(self) -> Row:
        """The moment, or force and couple. Raises TooLong."""
        values = self.values(self._inputs)
        return [values[place] for place in self.piece.outputs]

    def values(self, inputs: Mapping[str, Polynomial]) -> Row:
        """The steps; an input that is not given is a symbol."""
        values: list[Polynomial] = []
        for place, step in enumerate(self.piece.steps):
            operands = [values[k] for k in step.operands]
            is_input = step.operation == "input" and step.name in inputs
            value = inputs[step.name] if is_input else self._value(place, step, operands)
            values.append(value)
        return values

    def _value(self, place: int, step: Step, operands: Row) -> Polynomial:
        if step.operation == "input":
            return self.known[step.name]
        if step.operation == "number":
            assert step.number is not None
            return 0 * self.known["q0"] + rational(step.number)
        try:
            written = self._written_out(step, operands)
        except TooLong:
            written = None
        # Equal steps are one step, so that the place names the function and its operands.
        return self.known[_symbol(place)] if written is None else written

    def _written_out(self, step: Step, operands: Row) -> Polynomial | None:
        """The polynomial of a step; None of a step that is none. Raises TooLong."""
        if step.operation in _ARITHMETIC:
            return _ARITHMETIC[step.operation](*operands)
        if step.operation == "/" and operands[1].is_constant() and not operands[1].is_zero():
            return operands[0] / operands[1].leading_coefficient()
        if step.operation == "power" and step.number in range(2, _MOST_POWER + 1):
            return reduce(multiplied, operands * int(step.number or 0))
        return None

    @cached_property
    def _inputs(self) -> Mapping[str, Polynomial]:
        vectors = {"w": self.spin, "u": self.velocity}
        inputs = {
            f"{letter}{i}": v for letter, row in vectors.items() for i, v in enumerate(row, 1)
        }
        for i, row in enumerate(self.attitude, 1):
            inputs |= {f"r{i}{j}": entry for j, entry in enumerate(row, 1)}
        return inputs


def _symbol(place: int) -> str:
    """The name of a step of which nothing is known."""
    return f"step {place}"


def sum_of(numbers: Vector, row: Row) -> Polynomial:
    """The sum of multiples of polynomials."""
    parts = (part * rational(number) for number, part in zip(numbers, row, strict=True))
    return sum(parts, 0 * row[0])


def mapped(matrix: Matrix | Exact, row: Row) -> Row:
    """The product of a matrix and polynomials."""
    return [sum_of(numbers, row) for numbers in matrix]


def product(a: Row, b: Row) -> Polynomial:
    """The scalar product."""
    return sum(map(multiplied, a, b), 0 * a[0])


def cross(a: Row, b: Row) -> Row:
    """The cross product."""
    pairs = ((1, 2), (2, 0), (0, 1))
    return [multiplied(a[j], b[k]) - multiplied(a[k], b[j]) for j, k in pairs]
