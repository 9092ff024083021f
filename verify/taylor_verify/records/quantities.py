"""Names that every room shares: quantities, the columns of files, the precision ladder."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Final

# The quantities that say where the body is, in reading order; all others compared are conserved.
STATES: Final = ("omega", "impulse", "attitude", "centre", "velocity")
# The quantity of each model that every run has, and those that a scene may track besides.
MAIN: Final[Mapping[str, str]] = {"euler": "omega", "kirchhoff": "impulse"}
TRACKED: Final[Mapping[str, tuple[str, ...]]] = {
    "euler": ("attitude",),
    "kirchhoff": ("attitude", "centre"),
}
# Conserved quantities in reading order: energy, momenta in body axes, fourth integrals, momenta in space.
CONSERVED: Final = (
    *("T", "H2", "H_space", "F2", "FG", "y1", "y2", "y3"),
    *("clebsch2", "neumann", "steklov", "lyapunov", "chaplygin", "sokolov", "x_space", "y_space"),
)
# Rows that compare no quantity of their own: the start, the extent of an answer, the length of quaternions.
INITIAL: Final = "initial state"
COMPLETE: Final = "complete"
UNIT_QUATERNION: Final = "unit quaternion"

# A gate allows this many times the roundoff floor, which is the root mean square of a random sum. Ten
# leaves room for a solver that rounds a few times a step and for the tail of the distribution, and no room
# for one step in a hundred done wrongly.
GATE_FACTOR: Final = 10

# The columns of a trajectory file, group by group. r12 is row 1, column 2; q0 is the scalar.
COLUMNS: Final[Mapping[str, tuple[str, ...]]] = {
    "omega": ("w1", "w2", "w3"),
    "linear_velocity": ("u1", "u2", "u3"),
    "linear_impulse": ("x1", "x2", "x3"),
    "angular_impulse": ("y1", "y2", "y3"),
    "quaternion": ("q0", "q1", "q2", "q3"),
    "attitude": tuple(f"r{i}{k}" for i in (1, 2, 3) for k in (1, 2, 3)),
    "centre": ("c1", "c2", "c3"),
}
# The groups that the momenta of a model consist of.
MOMENTA: Final[Mapping[str, tuple[str, ...]]] = {
    "euler": ("omega",),
    "kirchhoff": ("linear_impulse", "angular_impulse"),
}
# The groups of velocities that stand for the impulses of a solid in a fluid.
VELOCITIES: Final = ("linear_velocity", "omega")
IMPULSES: Final = COLUMNS["linear_impulse"] + COLUMNS["angular_impulse"]

# Number formats of hardware or of compilers, with the bits of their significand; mpN has N bits.
FORMATS: Final[Mapping[str, int]] = {"f32": 24, "f64": 53, "f80": 64, "f128": 113}
# The precisions that the standard set runs on.
LADDER: Final = (*FORMATS, "mp237")
_MPFR: Final = re.compile(r"mp([1-9][0-9]*)")


def is_conserved(quantity: str) -> bool:
    """Return True for the name of a conserved quantity."""
    return quantity not in (*STATES, INITIAL, COMPLETE)


def bits_of(rung: str) -> int:
    """Return the bits of a rung's significand; 0 for a name that is no rung."""
    if rung in FORMATS:
        return FORMATS[rung]
    found = _MPFR.fullmatch(rung)
    return int(found[1]) if found else 0


def place_of_rung(rung: str) -> tuple[int, int, str]:
    """Return a key to sort rungs by: the named formats, then mpN by N, then any other name."""
    bits = bits_of(rung)
    return (0 if rung in FORMATS else 1 if bits else 2), bits, rung
