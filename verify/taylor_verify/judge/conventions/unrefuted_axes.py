"""Renamings of axes that vectors do not refute, asked for all axes at once.

|P v - w|^2 = |v|^2 + |w|^2 - 2 w.P v, and w.P v is a sum of the nine products w_i v_j, whatever P is. The
terms cancel, so a small error is not told by them. A large one is, and refutes P.
"""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from taylor_verify.judge.conventions.axis_orders import AXES, Axes

Floats = np.ndarray[Any, np.dtype[np.float64]]

# Rows are the nine entries of P.
_ENTRIES: Final = np.array([axes.vectors(np.eye(3)).T.ravel() for axes in AXES])
# The rounding of the cancelling terms is a smaller part of them.
_CANCELS: Final = 2.0**-44


def unrefuted(vectors: Floats, right: Floats, most: float) -> set[Axes]:
    """Return the axes P for which |P v - w| may be at most ``most`` in every row, of any numbers.

    ``vectors`` are the rows v and ``right`` the rows w, both (n, 3).
    """
    products = (right[:, :, None] * vectors[:, None, :]).reshape(-1, 9)
    terms = np.sum(vectors * vectors + right * right, axis=1)[:, None]
    squares = terms - 2 * products @ _ENTRIES.T
    is_refuted = np.any(squares > most * most + _CANCELS * terms, axis=0)
    return {axes for axes, refuted in zip(AXES, is_refuted, strict=True) if not refuted}
