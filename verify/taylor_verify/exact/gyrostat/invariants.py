"""Conserved quantities of a gyrostat's free motion: T, |H|^2 and, in space, H, with H = I omega + h.

Written from the definitions and independent of the equations of motion.
"""

from __future__ import annotations

from taylor_verify.exact.invariant import Array, Invariant
from taylor_verify.exact.rows import applied, dot, largest, norms, ones, squares, turned
from taylor_verify.scenes.gyrostat import Gyrostat
from taylor_verify.scenes.motion import Motion
from taylor_verify.scenes.mpfr import real


def whole(body: Gyrostat, motion: Motion) -> Array:
    """H at every row."""
    H: Array = applied(body.inertia, motion["omega"]) + real((body.rotor,), motion["omega"])
    return H


def energy(body: Gyrostat) -> Invariant:
    """T = omega . I omega / 2, so that dT/dH = omega."""

    def value(motion: Motion) -> Array:
        return dot(motion["omega"], applied(body.inertia, motion["omega"])) / 2

    return Invariant(
        "T",
        value,
        lambda motion: largest(value(motion)),
        lambda motion: {"momentum": motion["omega"]},
    )


def momentum(body: Gyrostat) -> Invariant:
    """H2 = |I omega + h|^2."""

    def value(motion: Motion) -> Array:
        return squares(whole(body, motion))

    return Invariant(
        "H2",
        value,
        lambda motion: largest(value(motion)),
        lambda motion: {"momentum": 2 * whole(body, motion)},
    )


def space_momentum(body: Gyrostat) -> Invariant:
    """R (I omega + h); a small rotation d of the attitude adds d x (R (I omega + h))."""
    return Invariant(
        "H_space",
        lambda motion: turned(motion["attitude"], whole(body, motion)),
        lambda motion: largest(norms(whole(body, motion))),
        lambda motion: {
            "momentum": ones(motion["omega"]),
            "attitude": norms(whole(body, motion)),
        },
    )
