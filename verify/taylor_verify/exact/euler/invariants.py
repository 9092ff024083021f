"""Conserved quantities of a free rigid body: T, |H|^2 and, in space, H, with H = I omega + h.

h is the momentum of wheels, zero for a body without them.

Written from the definitions and independent of the equations of motion.
"""

from __future__ import annotations

from collections.abc import Callable

from taylor_verify.exact.invariant import Array, Invariant
from taylor_verify.exact.row_arithmetic import applied, dot, largest, norms, ones, squares, turned
from taylor_verify.scenes.bodies import RigidBody
from taylor_verify.scenes.motion import Motion
from taylor_verify.scenes.mpfr import real


def energy(body: RigidBody) -> Invariant:
    """T = omega . I omega / 2, so that dT/dH = omega."""

    def value(motion: Motion) -> Array:
        return dot(motion["omega"], applied(body.inertia, motion["omega"])) / 2

    return Invariant(
        "T",
        value,
        lambda motion: largest(value(motion)),
        lambda motion: {"momentum": motion["omega"]},
    )


def momentum(H: Callable[[Motion], Array]) -> Invariant:
    """H2 = |H|^2."""
    return Invariant(
        "H2",
        lambda motion: squares(H(motion)),
        lambda motion: largest(squares(H(motion))),
        lambda motion: {"momentum": 2 * H(motion)},
    )


def space_momentum(H: Callable[[Motion], Array]) -> Invariant:
    """R H; a small rotation d of the attitude adds d x R H."""
    return Invariant(
        "H_space",
        lambda motion: turned(motion["attitude"], H(motion)),
        lambda motion: largest(norms(H(motion))),
        lambda motion: {"momentum": ones(motion["omega"]), "attitude": norms(H(motion))},
    )


def whole(body: RigidBody, motion: Motion) -> Array:
    """H at every row."""
    alone = applied(body.inertia, motion["omega"])
    # Nothing is added for no wheels: a row of float64 meets no exact entry that it need not.
    H: Array = alone + real((body.rotor,), alone) if any(body.rotor) else alone
    return H
