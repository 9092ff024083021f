"""Conserved quantities of a free rigid body: T, |H|^2 and, in space, H, with H = I omega.

Written from the definitions and independent of the equations of motion.
"""

from __future__ import annotations

from taylor_verify.exact.invariant import Array, Invariant
from taylor_verify.exact.rows import applied, dot, largest, norms, ones, squares, turned
from taylor_verify.scenes.bodies import RigidBody
from taylor_verify.scenes.motion import Motion


def energy(body: RigidBody) -> Invariant:
    """T = omega . I omega / 2, so that dT/dH = omega."""

    def value(motion: Motion) -> Array:
        return dot(motion["omega"], _momentum(body, motion)) / 2

    return Invariant(
        "T",
        value,
        lambda motion: largest(value(motion)),
        lambda motion: {"momentum": motion["omega"]},
    )


def momentum(body: RigidBody) -> Invariant:
    """H2 = |I omega|^2."""

    def value(motion: Motion) -> Array:
        return squares(_momentum(body, motion))

    return Invariant(
        "H2",
        value,
        lambda motion: largest(value(motion)),
        lambda motion: {"momentum": 2 * _momentum(body, motion)},
    )


def space_momentum(body: RigidBody) -> Invariant:
    """R I omega; a small rotation d of the attitude adds d x (R I omega)."""
    return Invariant(
        "H_space",
        lambda motion: turned(motion["attitude"], _momentum(body, motion)),
        lambda motion: largest(norms(_momentum(body, motion))),
        lambda motion: {
            "momentum": ones(motion["omega"]),
            "attitude": norms(_momentum(body, motion)),
        },
    )


def _momentum(body: RigidBody, motion: Motion) -> Array:
    return applied(body.inertia, motion["omega"])
