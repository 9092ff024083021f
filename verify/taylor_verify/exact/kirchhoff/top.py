"""Euler's top in a free solid: motions in which y turns by y' = y x C y, whatever x does.

Where A = p 1 and B = b 1 about some origin, or x = 0, U does not enter the equation of y. Less these
multiples of 1 the motion is that of a rigid body with I = C^-1 and H = y, of attitude S:

    y = S^T Y0,   x = S^T X0,   R = S,   centre = c0,

with X0 = R x and Y0 = R y at the start. Without a linear impulse x and R need no condition, and the centre
needs B = b 1 alone.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from taylor_verify.exact.carried import Back
from taylor_verify.exact.euler.regime import FreeSpin
from taylor_verify.exact.kirchhoff.displaced import centred
from taylor_verify.exact.kirchhoff.isotropic import less_coupling, less_linear, multiple
from taylor_verify.exact.kirchhoff.reduced import Reduced
from taylor_verify.exact.kirchhoff.solid import solid
from taylor_verify.exact.solution import Number, Time
from taylor_verify.numbers import tensors
from taylor_verify.numbers.rotation import rotation_matrix
from taylor_verify.scenes.bodies import ImmersedBody
from taylor_verify.scenes.motion import Impulse


def top(whole: Reduced) -> tuple[Reduced, FreeSpin] | None:
    """Return the spin of Euler's top in a free body, about the origin where B is symmetric; else None."""
    body, start = solid(whole.scene)
    if not any(start.linear) and "centre" not in whole.scene.track:
        # y is the same about every origin, and nothing else is asked for.
        return whole, _spin(body, start)
    reduced = centred(whole)
    body, start = solid(reduced.scene)
    b, p = multiple(body.coupling), multiple(body.linear)
    if b is None or (p is None and any(start.linear)):
        return None
    reduced = less_coupling(reduced, b)
    return reduced if p is None else less_linear(reduced, p), _spin(body, start)


def _spin(body: ImmersedBody, start: Impulse) -> FreeSpin:
    return FreeSpin(tensors.inverse(body.angular), tensors.apply(body.angular, start.angular))


def with_impulses(start: Impulse, track: frozenset[str]) -> Back:
    """Return the way from the motion of the top, omega and S, to that of the solid."""
    to_space = rotation_matrix(start.attitude)
    impulses = {
        "linear_impulse": tensors.apply(to_space, start.linear),
        "angular_impulse": tensors.apply(to_space, start.angular),
    }

    def back(rows: dict[str, Any], elapsed: Sequence[Time], number: Number) -> None:
        frames = rows["attitude"]
        rows.clear()
        for name, in_space in impulses.items():
            # v.R is R^T v, row by row.
            rows[name] = np.array([number(entry) for entry in in_space], dtype=object) @ frames
        if "attitude" in track:
            rows["attitude"] = frames
        if "centre" in track:
            centre = [number(entry) for entry in start.centre]
            rows["centre"] = np.array([centre for _ in elapsed], dtype=object)

    return back
