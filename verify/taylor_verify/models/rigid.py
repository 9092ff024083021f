"""A rigid body in the numbers of Euler's equations: K, M, the momentum r of wheels, and H = I omega.

K and H are formed exactly and rounded once each. The rounded body is K^-1 with wheels r, and omega = K H,
exactly.
"""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import Final, final

from taylor_verify.models.euler import PrincipalEuler, TensorEuler, euler_equations
from taylor_verify.models.fewest_operations import Choice, Numbers
from taylor_verify.models.form import Equations
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
from taylor_verify.numbers.precision import Rung, floor_log2, power_of_two
from taylor_verify.numbers.tensors import Matrix, Vector
from taylor_verify.scenes.bodies import RigidBody
from taylor_verify.scenes.motion import Spin
from taylor_verify.scenes.named_numbers import MOMENT, MOMENTUM, Dimension, Part, Shape, Value

_PRODUCTS: Final = ("K12", "K13", "K23")
_DEVIATIONS: Final = {"D11": "K11 - K33", "D22": "K22 - K33"}
_DIFFERENCES: Final = {"D1": "K33 - K22", "D2": "K11 - K33", "D3": "K22 - K11"}


@final
class Rigid(Mechanics[RigidBody, Spin]):
    """Euler's equations in the angular momentum."""

    body_letters = (
        Part("K", Shape.SYMMETRIC, Dimension(-1, -2, 0)),
        Part("M", Shape.VECTOR, MOMENT, is_load=True),
        Part("r", Shape.VECTOR, MOMENTUM, is_optional=True),
    )
    momenta = (Part("H", Shape.VECTOR, MOMENTUM),)

    @property
    def equations(self) -> Equations:
        return euler_equations

    def values(self, body: RigidBody) -> Mapping[str, Value]:
        return {"K": body.inverse_inertia, "M": body.moment, "r": body.rotor}

    def body(self, values: Mapping[str, Value]) -> RigidBody:
        if not tensors.is_positive_definite(values["K"]):
            raise ValueError("the inverse inertia tensor is not positive definite")
        return RigidBody(tensors.inverse(values["K"]), values["M"], values["r"])

    def change(self, body: RigidBody) -> Change:
        return Change(body.inertia, body.inverse_inertia)

    def choice(self, numbers: Mapping[str, Fraction], rung: Rung) -> Choice:
        return chosen_equations(numbers, rung)

    def units(self, body: RigidBody, start: Spin, span: Fraction) -> Units:
        """Return the units: H by its size or its growth by the moment, time by all its rates."""
        momentum = tensors.apply(body.inertia, start.omega)
        at_start, moment = size(momentum), size(body.moment)
        fastest = largest(body.inverse_inertia)
        # What is at rest may spin up about an axis for the whole span.
        growth = binary(moment * span)
        if at_start:
            growth = least_unit(moment, push_time(span, fastest * moment))
        unit = max(at_start, growth) or Fraction(1)
        rate = size(start.omega) if at_start >= growth and at_start else fastest * unit
        # If the moments differ by many orders of magnitude, H may turn much faster than the body.
        rate = max(rate, _nutation(body.inverse_inertia, momentum))
        rate = max(rate, size(tensors.apply(body.inverse_inertia, body.rotor)))
        rate = max(rate, least_rate(moment, unit))
        return Units(time=1 / binary(rate), momentum=unit)

    def derived(self, body: RigidBody, start: Spin) -> Mapping[str, Mapping[str, Value]]:
        return {
            "body": {"inverse_inertia": body.inverse_inertia},
            "initial": {"angular_momentum": tensors.apply(body.inertia, start.omega)},
        }


def _nutation(K: Matrix, H: Vector) -> Fraction:
    """Return a power of two near the fastest rate of H' = H x K H linearised at H; 0 if H is constant.

    The trace of J = [H]x K - [K H]x vanishes, so that its eigenvalues are the roots of
    z^3 + s z - d with s = -tr(J^2)/2, d = det J: not above twice the larger of |s|^(1/2), |d|^(1/3).
    """
    swept, turned = (
        tensors.product(tensors.cross_matrix(H), K),
        tensors.cross_matrix(tensors.apply(K, H)),
    )
    d, s, *_ = tensors.characteristic(tuple(map(tensors.minus, swept, turned)))
    by_d = power_of_two(floor_log2(abs(d)) // 3) if d else Fraction(0)
    return max(root(abs(s)), by_d)


def chosen_equations(numbers: Numbers, rung: Rung) -> Choice:
    """Return the equations of H1..H3, the upper triangle of K and M1..M3.

    A difference of K's diagonal is a coefficient if the rung can represent it; else the solver forms it.
    """
    k1, k2, k3 = (numbers[f"K{i}{i}"] for i in (1, 2, 3))
    replaced = {name: value for name, value in numbers.items() if name[0] == "K" and value}
    equations: PrincipalEuler | TensorEuler
    if any(numbers[name] for name in _PRODUCTS):
        differences = {"D11": k1 - k3, "D22": k2 - k3}
        definitions, begin = _DEVIATIONS, "K less a multiple of the unit matrix: "
    else:
        differences = dict(zip(_DIFFERENCES, (k3 - k2, k1 - k3, k2 - k1), strict=True))
        definitions, begin = _DIFFERENCES, "principal axes: "
    extra = {name: value for name, value in differences.items() if rung.holds(value)}
    formed = tuple(int(name[1]) for name in differences if name not in extra)
    shown = [name for name in extra if extra[name] or definitions is _DEVIATIONS]
    sentences = (
        [begin + ", ".join(f"{name} = {definitions[name]}" for name in shown)] if shown else []
    )
    if definitions is _DEVIATIONS:
        equations = TensorEuler(formed)
    else:
        sentences += [
            f"{definitions[n]} = 0: H{n[1]} feels no gyroscopic term"
            for n in differences
            if not differences[n]
        ]
        equations = PrincipalEuler(formed)
        if len(formed) == 1 and all(extra.values()):
            sentences.append(
                f"D{formed[0]} is -({' + '.join(extra)}), as {rung.name} does not hold it"
            )
            equations, formed = PrincipalEuler(summed=formed[0]), ()
    if formed:
        sentences.append(
            "differences of K's diagonal that the rung does not hold are formed as it goes"
        )
    return Choice(equations, {**numbers, **extra}, replaced, tuple(sentences))
