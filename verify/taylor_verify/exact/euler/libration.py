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

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Any, NamedTuple

import numpy as np
from flint import arb
from mpmath import mp

from taylor_verify.exact.carried import carried
from taylor_verify.exact.conserved.derivation import Derivation
from taylor_verify.exact.conserved.polynomial import (
    Polynomial,
    TooLong,
    symbols_of,
    terms,
)
from taylor_verify.exact.euler import heavy
from taylor_verify.exact.kirchhoff import closed
from taylor_verify.exact.solution import Number, Solution, Time
from taylor_verify.numbers.irrational import Irrational, rational
from taylor_verify.numbers.rotation import rotation_matrix
from taylor_verify.numbers.tensors import ZERO_MATRIX, diagonal
from taylor_verify.scenes.bodies import ImmersedBody, RigidBody
from taylor_verify.scenes.loads.steps import exact_root
from taylor_verify.scenes.motion import IDENTITY, Impulse, Spin
from taylor_verify.scenes.scene import Scene


class Pitch(NamedTuple):
    """The motion of a solid in the frame that turns at ``rate`` about axis ``k`` of the body."""

    scene: Scene
    k: int
    rate: Fraction


def enclosed(scene: Scene) -> Solution:
    """The motion of a loaded body in balls; raises NoClosedForm, with the reason, where it has none."""
    pitch = pitch_of(scene)
    if pitch is None:
        return heavy.enclosed(scene)
    return _in_space(scene, pitch, closed.enclosed(pitch.scene), arb)


def closed_form(scene: Scene) -> Solution | None:
    """The motion in mpmath, None where it has none; raises NoClosedForm likewise."""
    pitch = pitch_of(scene)
    if pitch is None:
        return heavy.closed_form(scene)
    inner = closed.closed_form(pitch.scene)
    return None if inner is None else _in_space(scene, pitch, inner, mp)


def _in_space(scene: Scene, pitch: Pitch, inner: Solution, functions: Any) -> Solution:
    """The solution by that in the turning frame; ``functions`` has the sine and the cosine."""
    spin = np.array(pitch.scene.body.energy_matrix, dtype=object)[3:, 3:]
    start = np.array(rotation_matrix(scene.initial.attitude), dtype=object)

    def back(rows: dict[str, Any], elapsed: Sequence[Time], number: Number) -> None:
        exactly = np.vectorize(number, otypes=[object])
        omega, frames = rows["angular_impulse"] @ exactly(spin), rows.get("attitude")
        omega[:, pitch.k] += number(pitch.rate)
        rows.clear()
        rows["omega"] = omega
        if frames is not None:
            angles = [number(pitch.rate) * number(t) for t in elapsed]
            turns = [_about(pitch.k, functions.cos(a), functions.sin(a)) for a in angles]
            rows["attitude"] = exactly(start) @ np.array(turns) @ frames

    return carried(inner, back)


def pitch_of(scene: Scene) -> Pitch | None:
    """Return the pitch of a scene, or None where its body and moment are not of this kind."""
    body, start = scene.body, scene.initial
    if not isinstance(body, RigidBody) or not isinstance(start, Spin):
        return None
    if body.damping or any(body.rotor):
        return None
    loads = body.loads
    if loads is None or loads.rung is not None or loads.states or loads.rotor or loads.switches:
        return None
    for k in range(3):
        across = [start.omega[i] for i in range(3) if i != k]
        if sum(map(bool, body.inertia[k])) == 1 and not any(across):
            moment = _moment(scene, k)
            if moment is not None:
                return _pitch(scene, k, (body.inertia[k][k], start.omega[k]), moment)
    return None


def _pitch(
    scene: Scene,
    k: int,
    spin: tuple[Fraction, Fraction],
    moment: tuple[Fraction, Fraction, Fraction],
) -> Pitch | None:
    (I, omega), (n, z1, z2) = spin, moment
    size = exact_root(z1**2 + z2**2)
    if not size:
        return None
    one, zero = Fraction(1), Fraction(0)
    (a, b), D = ((z1, size + z2), 1 / (size + z2)) if size + z2 else ((one, zero), -2 * z2)

    def vector(first: Fraction, second: Fraction, across: Fraction) -> tuple[Fraction, ...]:
        entries = {(k + 1) % 3: first, (k + 2) % 3: second, k: across}
        return tuple(entries[i] for i in range(3))

    # No two moments or masses are alike, so that the body has no axis of symmetry.
    linear, angular = vector(one, 1 + D, 2 + D), vector(2 / I, 3 / I, 1 / I)
    solid = ImmersedBody(diagonal(linear), ZERO_MATRIX, diagonal(angular))
    y = vector(zero, zero, I * (omega - n))
    start = Impulse(vector(a, b, zero), y, attitude=IDENTITY)
    return Pitch(replace(scene, model="kirchhoff", body=solid, initial=start), k, n)


def _about(k: int, c: Any, s: Any) -> Any:
    """The turn about axis k by an angle of this cosine and sine."""
    i, j = (k + 1) % 3, (k + 2) % 3
    entries = {(i, i): c, (i, j): -s, (j, i): s, (j, j): c, (k, k): 1 + 0 * c}
    turn = np.empty((3, 3), dtype=object)
    for place in np.ndindex(3, 3):
        # Filled one by one, as an array would take a polynomial for its terms.
        turn[place] = entries.get(place, 0 * c)
    return turn


def _moment(scene: Scene, k: int) -> tuple[Fraction, Fraction, Fraction] | None:
    """Return n, z1 and z2 of a body that turns by alpha about axis k; None of another moment.

    Nor is there one from an attitude that is not rational, whose motion is enclosed.
    """
    assert scene.body.loads is not None
    piece = scene.body.loads.piece(Fraction(0))
    known = symbols_of(("ca", "sa", "cos", "sin", "t"))
    waves = {p: step for p, step in enumerate(piece.steps) if step.operation in ("cos", "sin")}
    functions = {f"step {place}": known[step.operation] for place, step in waves.items()}
    turned = rotation_matrix(scene.initial.attitude)
    if any(isinstance(entry, Irrational) for row in turned for entry in row):
        return None
    start = [[rational(entry) for entry in row] for row in turned]
    R = np.array(start, dtype=object) @ _about(k, known["ca"], known["sa"])
    inputs = {f"r{i + 1}{j + 1}": R[i, j] for i, j in np.ndindex(3, 3)}
    try:
        values = Derivation(scene, piece, known | functions).values(inputs)
    except (KeyError, TooLong):
        # Something else is read, or a function of something else.
        return None
    along, *across = (_reduced(values[piece.outputs[(k + i) % 3]], known) for i in range(3))
    angles = [dict(terms(values[step.operands[0]])) for step in waves.values()]
    if any(across) or not angles or any(a.keys() != {("t",)} or a != angles[0] for a in angles):
        return None
    return _matched(along, angles[0][("t",)], known)


def _matched(
    M: Polynomial, rate: Fraction, known: dict[str, Polynomial]
) -> tuple[Fraction, Fraction, Fraction] | None:
    c, s, cos, sin = (known[name] for name in ("ca", "sa", "cos", "sin"))
    numbers = dict(terms(M))
    for sign in (1, -1):
        z1 = numbers.get(("ca", "cos", "sa", "sin"), Fraction(0)) / (4 * sign)
        z2 = numbers.get(("ca", "sa"), Fraction(0)) / 2
        (C, S), (c2, s2) = (c * c - s * s, 2 * c * s), (cos * cos - sin * sin, 2 * cos * sin * sign)
        pendulum = rational(z1) * (C * c2 + S * s2) + rational(z2) * (S * c2 - C * s2)
        if M == _reduced(pendulum, known):
            return sign * rate, z1, z2
    return None


def _reduced(polynomial: Polynomial, known: dict[str, Polynomial]) -> Polynomial:
    for c, s in (("ca", "sa"), ("cos", "sin")):
        polynomial = polynomial % (known[c] ** 2 + known[s] ** 2 - 1)
    return polynomial
