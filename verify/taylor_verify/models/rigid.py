"""A rigid body in the numbers of Euler's equations: K, M and H = I omega.

K and H are formed exactly and rounded once each. The rounded body is K^-1, and omega = K H, exactly.
"""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import Final, final

from taylor_verify.models.choice import Choice, Numbers, holds
from taylor_verify.models.euler import PrincipalEuler, TensorEuler, differences, euler_equations
from taylor_verify.models.form import Equations
from taylor_verify.models.manufactured import EULER_INVERSE
from taylor_verify.models.mechanics import Change, Mechanics
from taylor_verify.models.units import Units, binary, largest, root, size
from taylor_verify.scenes import tensors
from taylor_verify.scenes.bodies import RigidBody
from taylor_verify.scenes.motion import Spin
from taylor_verify.scenes.parts import MOMENT, MOMENTUM, Dimension, Part, Shape, Value
from taylor_verify.scenes.precision import Rung, floor_log2, power_of_two
from taylor_verify.scenes.tensors import Matrix, Vector

_AXES: Final = tensors.diagonal((Fraction(1),) * 3)
_PRODUCTS: Final = ("K12", "K13", "K23")
_DIFFERENCES: Final = {"D1": "K33 - K22", "D2": "K11 - K33", "D3": "K22 - K11"}


@final
class Rigid(Mechanics[RigidBody, Spin]):
    """Euler's equations in the angular momentum."""

    body_letters = (
        Part("K", Shape.SYMMETRIC, Dimension(-1, -2, 0)),
        Part("M", Shape.VECTOR, MOMENT, is_load=True),
    )
    momenta = (Part("H", Shape.VECTOR, MOMENTUM),)
    inverse = EULER_INVERSE

    @property
    def equations(self) -> Equations:
        return euler_equations

    def values(self, body: RigidBody) -> Mapping[str, Value]:
        return {"K": body.inverse_inertia, "M": body.moment}

    def body(self, values: Mapping[str, Value]) -> RigidBody:
        if not tensors.is_positive_definite(values["K"]):
            raise ValueError("the inverse inertia tensor is not positive definite")
        return RigidBody(tensors.inverse(values["K"]), values["M"])

    def change(self, body: RigidBody) -> Change:
        return Change(body.inertia, body.inverse_inertia)

    def choice(self, numbers: Mapping[str, Fraction], rung: Rung) -> Choice:
        return chosen_equations(numbers, rung)

    def units(self, body: RigidBody, start: Spin, span: Fraction) -> Units:
        momentum, motion = tensors.apply(body.inertia, start.omega), body.manufactured
        if motion is not None:
            # Not where the motion begins counts, but how far it goes, and how fast its waves are.
            reached = size(motion.mapped(body.inertia).reach) or Fraction(1)
            rate = max(size(motion.reach), motion.highest) or Fraction(1)
            return Units(time=1 / binary(rate), momentum=reached)
        unit = size(momentum) or binary(size(body.moment) * span) or Fraction(1)
        rate = size(start.omega) or largest(body.inverse_inertia) * unit
        # Where the moments differ by many orders of magnitude H may turn far faster than the body does.
        rate = max(rate, _nutation(body.inverse_inertia, momentum))
        return Units(time=1 / binary(rate), momentum=unit)

    def derived(self, body: RigidBody, start: Spin) -> Mapping[str, Mapping[str, Value]]:
        return {
            "body": {"inverse_inertia": body.inverse_inertia},
            "initial": {"angular_momentum": tensors.apply(body.inertia, start.omega)},
        }


def _nutation(K: Matrix, H: Vector) -> Fraction:
    """A power of two near the fastest rate of H' = H x K H linearised at H; 0 where nothing changes.

    The trace of J = [H]x K - [K H]x vanishes, so that its eigenvalues are the roots of
    z^3 + s z - d with s = -tr(J^2)/2, d = det J: not above twice the larger of |s|^(1/2), |d|^(1/3).
    """
    omega = tensors.apply(K, H)
    columns = (
        tensors.plus(
            tensors.cross(H, column), tensors.scaled(Fraction(-1), tensors.cross(omega, e))
        )
        for column, e in zip(K, _AXES, strict=True)
    )
    J = tensors.transpose(tuple(columns))
    square = tensors.product(J, J)
    s = (square[0][0] + square[1][1] + square[2][2]) / 2
    d = tensors.dot(J[0], tensors.cross(J[1], J[2]))
    by_s = root(abs(s)) if s else Fraction(0)
    by_d = power_of_two(floor_log2(abs(d)) // 3) if d else Fraction(0)
    return max(by_s, by_d)


def chosen_equations(numbers: Numbers, rung: Rung) -> Choice:
    """From H1..H3, the upper triangle of K and M1..M3."""
    K = [[numbers[f"K{min(i, j)}{max(i, j)}"] for j in (1, 2, 3)] for i in (1, 2, 3)]
    replaced = {name: value for name, value in numbers.items() if name[0] == "K" and value}
    if any(numbers[name] for name in _PRODUCTS):
        found = {f"D{i}{i}": K[i - 1][i - 1] - K[2][2] for i in (1, 2)}
        formed = tuple(i for i in (1, 2) if not holds(rung, found[f"D{i}{i}"]))
        extra = {n: v for n, v in found.items() if int(n[1]) not in formed}
        said = ["a sphere is taken away from K: " + _told({n: f"{_K(n)} - K33" for n in extra})]
        return Choice(
            TensorEuler(formed), {**numbers, **extra}, replaced, _sentences(said, extra, formed)
        )
    found = dict(zip(_DIFFERENCES, differences(K), strict=True))
    missing = tuple(int(n[1]) for n, value in found.items() if not holds(rung, value))
    extra = {n: v for n, v in found.items() if int(n[1]) not in missing}
    said = ["principal axes: " + _told({n: _DIFFERENCES[n] for n in extra if extra[n]})]
    said += [
        f"{_DIFFERENCES[n]} = 0: H{n[1]} feels no gyroscopic term" for n in found if not found[n]
    ]
    if len(missing) == 1 and all(extra.values()):
        others = " + ".join(extra)
        said.append(f"D{missing[0]} is -({others}), as {rung.name} does not hold it")
        equations = PrincipalEuler(summed=missing[0])
        return Choice(equations, {**numbers, **extra}, replaced, _sentences(said, extra))
    return Choice(
        PrincipalEuler(missing),
        {**numbers, **extra},
        replaced,
        _sentences(said, extra, missing),
    )


def _K(name: str) -> str:
    return f"K{name[1:]}"


def _told(definitions: Mapping[str, str]) -> str:
    return ", ".join(f"{name} = {text}" for name, text in definitions.items())


def _sentences(said: list[str], extra: Numbers, formed: tuple[int, ...] = ()) -> tuple[str, ...]:
    """What was said, without a list that is empty, and what the rung could not hold."""
    kept = [sentence for sentence in said if not sentence.endswith(": ")]
    if formed:
        kept.append("differences of K's diagonal that the rung does not hold are formed as it goes")
    return tuple(kept)
