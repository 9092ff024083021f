"""A solid in a fluid in the numbers of Kirchhoff's equations: A, B, C, X, L and the impulses x and y.

The 21 coefficients are rounded once each; that T is the body.
"""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import final

from taylor_verify.models.fewest_operations import Choice, Numbers
from taylor_verify.models.form import Equations
from taylor_verify.models.kirchhoff import (
    CLEBSCH_DIFFERENCES,
    CLEBSCH_NAMES,
    ClebschAbout,
    clebsch_equations,
    kirchhoff_equations,
)
from taylor_verify.models.mechanics import Change, Mechanics
from taylor_verify.models.units import (
    Units,
    binary,
    largest,
    least_rate,
    least_unit,
    push_time,
    root,
    size,
)
from taylor_verify.numbers import tensors
from taylor_verify.numbers.precision import Rung
from taylor_verify.numbers.tensors import Matrix, Vector
from taylor_verify.scenes.bodies import ImmersedBody
from taylor_verify.scenes.motion import Impulse
from taylor_verify.scenes.named_numbers import IMPULSE, MOMENTUM, Part, Shape, Value

_LETTERS = {"linear": "A", "coupling": "B", "angular": "C", "force": "X", "couple": "L"}


@final
class Immersed(Mechanics[ImmersedBody, Impulse]):
    """Kirchhoff's equations in the impulses."""

    body_letters = tuple(
        Part(_LETTERS[part.name], part.shape, part.dimension, part.is_load)
        for part in ImmersedBody.PARTS
        if part.name in _LETTERS
    )
    momenta = (Part("x", Shape.VECTOR, IMPULSE), Part("y", Shape.VECTOR, MOMENTUM))

    @property
    def equations(self) -> Equations:
        return kirchhoff_equations

    def values(self, body: ImmersedBody) -> Mapping[str, Value]:
        return {_LETTERS[name]: value for name, value in body.parts().items()}

    def body(self, values: Mapping[str, Value]) -> ImmersedBody:
        body = ImmersedBody(**{name: values[letter] for name, letter in _LETTERS.items()})
        if not tensors.is_positive_definite(body.energy_matrix):
            raise ValueError("T is not positive definite")
        return body

    def change(self, body: ImmersedBody) -> Change:
        del body
        return Change()

    def choice(self, numbers: Mapping[str, Fraction], rung: Rung) -> Choice:
        return chosen_equations(numbers, rung)

    def units(self, body: ImmersedBody, start: Impulse, span: Fraction) -> Units:
        state, force, couple = start.moving, size(body.force), size(body.couple)
        linear, coupling, angular = map(largest, (body.linear, body.coupling, body.angular))
        # Without a force |x| is constant; y may start at zero and receive all the energy.
        impulse, spun_up = size(state[:3]), _spun_up(body.energy_matrix, state, angular)
        momentum = max(size(state[3:]), spun_up)
        time = push_time(span, angular * couple, root(linear * angular) * force)
        pushed = least_unit(force, time)
        turned = max(least_unit(couple, time), root(linear / angular) * pushed)
        impulse = max(impulse, pushed) if impulse else binary(force * span)
        momentum = max(momentum, turned) if momentum else binary(couple * span)
        impulse, momentum = impulse or momentum or Fraction(1), momentum or impulse or Fraction(1)
        rate = max(linear * impulse**2 / momentum, coupling * impulse, angular * momentum)
        rate = max(rate, least_rate(force, impulse), least_rate(couple, momentum))
        # Each impulse is at most twice its unit, which bounds the path unless loads or damping act.
        speed = 6 * (linear * impulse + coupling * momentum)
        path = max(2 * binary(speed * span * impulse / momentum), Fraction(1))
        return Units(time=1 / binary(rate), momentum=momentum, impulse=impulse, path=path)


def _spun_up(energy: Matrix, state: Vector, angular: Fraction) -> Fraction:
    """Return a power of two near |y| for a motion with all its energy in the largest entry of C."""
    return root(tensors.dot(state, tensors.apply(energy, state)) / angular)


def chosen_equations(numbers: Numbers, rung: Rung) -> Choice:
    """Return the equations of x, y, X, L and the 21 coefficients.

    A difference of two of Clebsch's coefficients becomes a coefficient if the rung can represent it.
    """
    axis = axis_of_symmetry(numbers)
    loads_and_state = {n: v for n, v in numbers.items() if n[0] not in "ABC"}
    if axis is None:
        zeros = sum(not value for name, value in numbers.items() if name[0] in "ABC")
        left_out = (f"{zeros} of 21 coefficients are zero",) if zeros else ()
        return Choice(kirchhoff_equations, {**loads_and_state, **numbers}, {}, left_out)
    across = axis % 3 + 1
    diagonals = [numbers[f"{matrix}{i}{i}"] for matrix in "ABC" for i in (across, axis)]
    six = dict(zip(CLEBSCH_NAMES, diagonals, strict=True))
    equal = tuple(n for n in "pqr" if six[n] and six[n] == six[f"{n}'"])
    own = {name: value for name, value in six.items() if name[0] not in equal or name in equal}
    differences = {n: six[f"{n}'"] - six[n] for n in "pqr" if six[n] != six[f"{n}'"]}
    coefficients = {
        CLEBSCH_DIFFERENCES[n]: value for n, value in differences.items() if rung.holds(value)
    }
    sentences = [f"Clebsch's T about axis {axis}: 6 coefficients of 21"]
    sentences += [f"{n}' = {n}" for n in equal]
    sentences += [f"{d} = {n}' - {n}" for n, d in CLEBSCH_DIFFERENCES.items() if d in coefficients]
    plain = axis == 3 and not equal
    equations = clebsch_equations if plain else ClebschAbout(axis, equal)
    return Choice(equations, {**loads_and_state, **own, **coefficients}, six, tuple(sentences))


def axis_of_symmetry(numbers: Numbers) -> int | None:
    """Return the body axis about which T is exactly Clebsch's; 3 where there is a choice."""
    if any(value for name, value in numbers.items() if name[0] in "ABC" and name[1] != name[2]):
        return None
    for axis in (3, 1, 2):
        i, j = (k for k in (1, 2, 3) if k != axis)
        if all(numbers[f"{m}{i}{i}"] == numbers[f"{m}{j}{j}"] for m in "ABC"):
            return axis
    return None
