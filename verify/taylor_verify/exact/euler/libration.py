"""Pitch on a circular orbit: a body that turns about a principal axis, under gravity that turns about it.

    I alpha'' = z1 cos 2 psi + z2 sin 2 psi,    psi = alpha - n t

alpha  the angle of the body about its axis k, from the start      n  the rate at which the moment turns
I      the moment of inertia about axis k

In a frame that turns at n this is a pendulum in the angle 2 psi, and the motion of a solid in a plane of a
fluid (kirchhoff/plane): an impulse (a, b), constant in space, gives the couple D x_i x_j with D the
difference of two entries of A. So z1 = D a b and z2 = D (b^2 - a^2)/2. P. C. Hughes, Spacecraft Attitude
Dynamics (1986), section 9.2.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import reduce
from operator import mul
from typing import Any, Final

import numpy as np
from flint import arb, fmpq
from mpmath import mp

from taylor_verify.exact.carried import carried
from taylor_verify.exact.conserved.derivation import ARITHMETIC
from taylor_verify.exact.conserved.polynomial import Polynomial, rational, symbols_of
from taylor_verify.exact.euler import heavy
from taylor_verify.exact.kirchhoff import closed
from taylor_verify.exact.rotation import rotation_matrix
from taylor_verify.exact.solution import Number, Solution, Time
from taylor_verify.numbers import tensors
from taylor_verify.numbers.tensors import ZERO_MATRIX, Vector
from taylor_verify.scenes.bodies import ImmersedBody, RigidBody
from taylor_verify.scenes.loads.loads import Loads
from taylor_verify.scenes.loads.steps import Step, exact_root
from taylor_verify.scenes.motion import Impulse, Spin
from taylor_verify.scenes.scene import Scene

# Of alpha and n t.
_SYMBOLS: Final = ("cos alpha", "sin alpha", "cos nt", "sin nt", "t")


# By the word of the motion in a plane.
WORDS: Final = {
    "planar-swing": "pitch-swing",
    "planar-turn": "pitch-turn",
    "planar-front": "pitch-front",
    "planar-steady": "pitch-steady",
    "steady": "pitch-steady",
}


class _NoPitch(Exception):
    """The error for a step that is no polynomial in the cosines and sines of alpha and n t."""


@dataclass(frozen=True)
class Pitch:
    """The motion of a solid in the frame that turns at ``rate`` about axis ``k`` of the body."""

    scene: Scene
    k: int
    rate: Fraction


def enclosed(scene: Scene) -> Solution:
    """The motion of a loaded body in balls; raises NoClosedForm, with the reason, where it has none."""
    pitch = pitch_of(scene)
    if pitch is None:
        return heavy.enclosed(scene)
    return _from_orbit(closed.enclosed(pitch.scene), pitch, arb.cos, arb.sin)


def closed_form(scene: Scene) -> Solution | None:
    """The motion in mpmath, None where it has none; raises NoClosedForm likewise."""
    pitch = pitch_of(scene)
    if pitch is None:
        return heavy.closed_form(scene)
    inner = closed.closed_form(pitch.scene)
    return None if inner is None else _from_orbit(inner, pitch, mp.cos, mp.sin)


def _from_orbit(
    inner: Solution, pitch: Pitch, cos: Callable[[Any], Any], sin: Callable[[Any], Any]
) -> Solution:
    """The solution in space, by that in the turning frame."""
    spin = np.array(pitch.scene.body.energy_matrix, dtype=object)[3:, 3:]
    start = np.array(rotation_matrix(pitch.scene.initial.attitude), dtype=object)

    def back(rows: dict[str, Any], elapsed: Sequence[Time], number: Number) -> None:
        exactly = np.vectorize(number, otypes=[object])
        omega, frames = rows["angular_impulse"] @ exactly(spin), rows.get("attitude")
        omega[:, pitch.k] += number(pitch.rate)
        rows.clear()
        rows["omega"] = omega
        if frames is not None:
            to_space = exactly(start)
            angles = [number(pitch.rate) * number(t) for t in elapsed]
            turns = [_about(pitch.k, cos(angle), sin(angle)) for angle in angles]
            rows["attitude"] = np.array(
                [to_space @ turn @ to_space.T @ R for turn, R in zip(turns, frames, strict=True)]
            )

    return carried(inner, back, WORDS[inner.regime])


def pitch_of(scene: Scene) -> Pitch | None:
    """Return the pitch of a scene, or None where its body and moment are not of this kind."""
    body, start = scene.body, scene.initial
    if not isinstance(body, RigidBody) or not isinstance(start, Spin) or body.damping:
        return None
    loads = body.loads
    if loads is None or loads.rung is not None or loads.states or loads.rotor or loads.switches:
        return None
    for k in range(3):
        I, omega = body.inertia[k][k], start.omega
        if sum(map(bool, body.inertia[k])) == 1 and not any(omega[:k] + omega[k + 1 :]):
            moment = _Planar(loads, rotation_matrix(start.attitude), k).moment()
            if moment is not None:
                rate, z1, z2 = moment
                return _pitch(scene, k, rate, (I, z1, z2))
    return None


def _pitch(scene: Scene, k: int, rate: Fraction, numbers: Sequence[Fraction]) -> Pitch | None:
    I, z1, z2 = numbers
    size = exact_root(z1**2 + z2**2)
    if not size:
        return None
    i, j = (k + 1) % 3, (k + 2) % 3
    a, b = (z1, size + z2) if size + z2 else (Fraction(1), Fraction(0))
    D = 1 / (size + z2) if size + z2 else -2 * z2
    turns = [Fraction(2), Fraction(2), Fraction(2)]
    turns[k], turns[j] = Fraction(1), Fraction(3)
    x, y, A = ([Fraction(0)] * 3 for _ in range(3))
    x[i], x[j], y[k] = a, b, I * (scene.initial.omega[k] - rate)
    # No two are alike, so that the body has no axis of symmetry.
    A[i], A[j], A[k] = Fraction(1), 1 + D, 2 + D
    solid = ImmersedBody(
        tensors.diagonal(_vector(A)), ZERO_MATRIX, tensors.diagonal(_vector(n / I for n in turns))
    )
    impulse = Impulse(_vector(x), _vector(y), attitude=scene.initial.attitude)
    return Pitch(replace(scene, model="kirchhoff", body=solid, initial=impulse), k, rate)


def _vector(row: Iterable[Fraction]) -> Vector:
    first, second, third = row
    return first, second, third


def _about(k: int, c: Any, s: Any) -> Any:
    """The turn about axis k by an angle of this cosine and sine."""
    i, j = (k + 1) % 3, (k + 2) % 3
    entries = {(i, i): c, (i, j): -s, (j, i): s, (j, j): c, (k, k): 1 + 0 * c}
    turn = np.empty((3, 3), dtype=object)
    for place in np.ndindex(3, 3):
        # Filled one by one, as an array would take a polynomial for its terms.
        turn[place] = entries.get(place, 0 * c)
    return turn


def _powers(product: Polynomial) -> tuple[int, ...]:
    """The powers of the one product of a polynomial."""
    (powers,) = product.monoms()
    return powers


def _fraction(number: fmpq) -> Fraction:
    return Fraction(int(number.p), int(number.q))


class _Planar:
    """The moment of loads on a body that has turned by alpha about its axis k since the start."""

    def __init__(self, loads: Loads, start: Sequence[Vector], k: int) -> None:
        self._piece, self._k = loads.piece(Fraction(0)), k
        self._symbols = symbols_of(_SYMBOLS)
        self._rate: Fraction | None = None
        c, s = self._symbols["cos alpha"], self._symbols["sin alpha"]
        exactly = np.vectorize(rational, otypes=[object])
        R = exactly(np.array(start, dtype=object)) @ _about(k, c, s)
        self._inputs = {f"r{i + 1}{j + 1}": R[i, j] for i in range(3) for j in range(3)}
        self._inputs["t"] = self._symbols["t"]

    def moment(self) -> tuple[Fraction, Fraction, Fraction] | None:
        """Return n, z1 and z2; None where the moment is another function."""
        values: list[Polynomial] = []
        try:
            for step in self._piece.steps:
                values.append(self._value(step, [values[place] for place in step.operands]))
        except _NoPitch:
            return None
        moment = [self._reduced(values[place]) for place in self._piece.outputs]
        along = moment.pop(self._k)
        if self._rate is None or not all(part.is_zero() for part in moment):
            return None
        return self._matched(along, self._rate)

    def _matched(self, M: Polynomial, rate: Fraction) -> tuple[Fraction, Fraction, Fraction] | None:
        ca, sa, ct, st, _ = (self._symbols[name] for name in _SYMBOLS)
        for sign in (1, -1):
            double = (ct * ct - st * st, 2 * ct * st * sign)
            angle = (ca * ca - sa * sa, 2 * ca * sa)
            cosine = angle[0] * double[0] + angle[1] * double[1]
            sine = angle[1] * double[0] - angle[0] * double[1]
            z1, z2 = M[_powers(sa * ca * st * ct)] / (4 * sign), M[_powers(sa * ca)] / 2
            if M == self._reduced(z1 * cosine + z2 * sine):
                return sign * rate, _fraction(z1), _fraction(z2)
        return None

    def _value(self, step: Step, operands: Sequence[Polynomial]) -> Polynomial:
        if step.operation in ("cos", "sin"):
            self._note(operands[0])
            return self._symbols[f"{step.operation} nt"]
        if step.operation == "input" and step.name in self._inputs:
            return self._inputs[step.name]
        if step.operation == "number" and step.number is not None:
            return 0 * self._symbols["t"] + rational(step.number)
        if step.operation in ARITHMETIC:
            return self._reduced(ARITHMETIC[step.operation](*operands))
        if step.operation == "power" and step.number in (2, 3, 4):
            return self._reduced(reduce(mul, operands * int(step.number)))
        if step.operation == "/" and operands[1].is_constant() and not operands[1].is_zero():
            return operands[0] / operands[1].leading_coefficient()
        raise _NoPitch

    def _note(self, angle: Polynomial) -> None:
        """Note n of an angle n t, which is the same in all of them."""
        rate = _fraction(angle[_powers(self._symbols["t"])])
        if (
            not rate
            or angle != self._symbols["t"] * rational(rate)
            or self._rate not in (None, rate)
        ):
            raise _NoPitch
        self._rate = rate

    def _reduced(self, polynomial: Polynomial) -> Polynomial:
        for name in ("alpha", "nt"):
            c, s = self._symbols[f"cos {name}"], self._symbols[f"sin {name}"]
            polynomial = polynomial % (c * c + s * s - 1)
        return polynomial
