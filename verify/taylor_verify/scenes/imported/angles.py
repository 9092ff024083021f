"""Remarks on angles: that they were rounded, and which of them may be meant as quarter turns."""

from __future__ import annotations

from math import pi
from typing import Final

from taylor_verify.scenes.imported.rotation import DECIMALS
from taylor_verify.scenes.precision import float_text
from taylor_verify.scenes.tensors import Vector

# An angle of four digits, 1.571, is as near to a quarter turn as that.
_NEAR: Final = 3e-4
_QUARTER: Final = pi / 2


def remarks_on(name: str, angles: Vector, degrees: bool = False) -> tuple[str, ...]:
    """Return what a reader of the scene must know of these angles; nothing where all are zero."""
    if not any(angles):
        return ()
    unit = "degrees" if degrees else "radians"
    text = ", ".join(map(float_text, angles))
    remarks = [
        f"The tensor was turned by {name} = ({text}) {unit}: their quaternion is formed with 400 bits, "
        f"its largest component made 1, and rounded to {DECIMALS} decimals (quarter turns in degrees are "
        "exact). The turn by it is exact, so that the principal moments are those of the file."
    ]
    if not degrees:
        remarks += [
            f"The angle {float_text(angle)} is taken as written, and is near a quarter turn but none."
            for angle in angles
            if _is_nearly_quarter(float(angle))
        ]
    return tuple(remarks)


def _is_nearly_quarter(angle: float) -> bool:
    return angle != 0 and abs(angle - round(angle / _QUARTER) * _QUARTER) < _NEAR
