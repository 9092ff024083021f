"""Sentences on the mass, inertia and added masses of a homogeneous ellipsoid."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

from mpmath import mp

from taylor_verify.records.faults import shown
from taylor_verify.scenes.bodies import ImmersedBody
from taylor_verify.scenes.stand_in import STAND_IN_BITS

_DIGITS_TOLD: Final = 12


def sentences(body: ImmersedBody) -> list[str]:
    """Return sentences on the ellipsoid of a body; none for a body given by its coefficients."""
    shape = body.ellipsoid
    if shape is None:
        return []
    exact = shape.inertias
    a = ", ".join(map(shown, shape.semi_axes))
    is_neutral = shape.density == shape.fluid_density
    buoyancy = ", as heavy as what it displaces" if is_neutral else ""
    return [
        f"A homogeneous ellipsoid: semi-axes {a}, density {shown(shape.density)}, in a fluid of "
        f"density {shown(shape.fluid_density)}{buoyancy}.",
        f"By Lamb's integrals: mass {_text([exact.mass])}, added mass {_text(exact.added_mass)}; "
        f"inertia {_text(exact.inertia)}, added inertia {_text(exact.added_inertia)}.",
        "1/(mass + added mass) and 1/(inertia + added inertia) are irrational. The exact motion is that of "
        f"these numbers themselves; a solver gets them rounded, with {STAND_IN_BITS} bits at most.",
        *_symmetry(body),
    ]


def _symmetry(body: ImmersedBody) -> list[str]:
    axis = body.axis_of_symmetry
    if axis is None:
        return ["Three different semi-axes: none of them is an axis of symmetry."]
    if body.ellipsoid is None or len(set(body.ellipsoid.semi_axes)) > 1:
        return [
            f"Two equal semi-axes: Clebsch's body with q = q' = 0, its axis the body axis {axis}."
        ]
    free = "; free, y is constant in body axes, and x turns about it at the rate r |y|"
    return [f"A sphere: T = p x.x/2 + r y.y/2{free if body.is_free else ''}."]


def _text(numbers: Sequence[Any]) -> str:
    with mp.workdps(2 * _DIGITS_TOLD):
        texts = (mp.nstr(mp.convert(number), _DIGITS_TOLD) if number else "0" for number in numbers)
        return ", ".join(map(str, texts))
