"""The frame of a free solid in a fluid from the constancy of its impulse: fewer equations to expand.

In space the impulse F Z and the moment of impulse are constant. So the third row of R, with the space
axis Z along F, is x/F; one more row, r' = r x Omega, gives the second as their product; of the centre
two coordinates are F X = (R y)_Y, F Y = -(R y)_X from their start (Hydromechanics 49 (18), (19)), and
the third is the integral of x.U/F. This is 27 products of series instead of 45.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np
from mpmath import mp

from verify.exact.rotation import rotation_matrix
from verify.scenes import tensors
from verify.scenes.motion import Impulse
from verify.scenes.tensors import Vector

Rows = np.ndarray[Any, Any]


def crosswise(start: Impulse) -> Vector:
    """A rational vector across x at the start: the row r, of any length."""
    x = start.linear
    least = min(range(3), key=lambda i: abs(x[i]))
    unit = tuple(Fraction(int(i == least)) for i in range(3))
    return tensors.cross(x, unit)


def placed(start: Impulse, states: Rows) -> dict[str, Rows]:
    """``attitude`` (n, 3, 3) and ``centre`` (n, 3) from rows of x, y, r and int x.U.

    At the ambient precision of mpmath; x must not be zero.
    """
    x0, y0, r0 = (
        np.array([[mp.convert(c) for c in v]])
        for v in (start.linear, start.angular, crosswise(start))
    )
    F, length = mp.sqrt(_dot(x0, x0)[0]), mp.sqrt(_dot(r0, r0)[0])
    there, here = _frames(states[:, :3] / F, states[:, 6:9] / length), _frames(x0 / F, r0 / length)
    attitude = np.array([[mp.convert(c) for c in row] for row in rotation_matrix(start.attitude)])
    to_space = attitude @ here[0].T
    before, after = here[0] @ y0[0], np.matmul(there, states[:, 3:6, None])[:, :, 0]
    path = np.stack([after[:, 1] - before[1], before[0] - after[:, 0], states[:, 9]], axis=1) / F
    centre = np.array([mp.convert(c) for c in start.centre])
    return {"attitude": np.matmul(to_space, there), "centre": centre + path @ to_space.T}


def _frames(third: Rows, first: Rows) -> Rows:
    """Matrices (n, 3, 3) from their third and first rows."""
    j, k = [1, 2, 0], [2, 0, 1]
    second = third[:, j] * first[:, k] - third[:, k] * first[:, j]
    return np.stack([first, second, third], axis=1)


def _dot(a: Rows, b: Rows) -> Rows:
    sums: Rows = np.sum(a * b, axis=1)
    return sums
