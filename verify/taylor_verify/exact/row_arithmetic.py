"""The arithmetic of rows of vectors, one for each instant, at the ambient precision.

Their numbers are mpmath's or MPFR's (scenes.mpfr), or float64 where no exact entry meets them; the answer
is in the same.
"""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from taylor_verify.numbers.tensors import Matrix
from taylor_verify.scenes.motion import Quaternion
from taylor_verify.scenes.mpfr import real, sqrt

Array = np.ndarray[Any, Any]

# The places of v and of -v in [v]x, row by row.
_PLUS: Final = [7, 2, 3]
_MINUS: Final = [5, 6, 1]


def applied(matrix: Matrix, rows: Array) -> Array:
    """The matrix times every row, its exact entries taken at the ambient precision."""
    image: Array = rows @ real(matrix, rows).T
    return image


def turned(attitude: Array, rows: Array) -> Array:
    """R v, row by row: body axes to space axes."""
    turned: Array = np.matmul(attitude, rows[:, :, None])[:, :, 0]
    return turned


def dot(a: Array, b: Array) -> Array:
    sums: Array = np.sum(a * b, axis=1)
    return sums


def squares(rows: Array) -> Array:
    return dot(rows, rows)


def cross(a: Array, b: Array) -> Array:
    j, k = [1, 2, 0], [2, 0, 1]
    product: Array = a[:, j] * b[:, k] - a[:, k] * b[:, j]
    return product


def cross_matrices(vectors: Array) -> Array:
    """[v]x (..., 3, 3) of every vector v (..., 3): [v]x d = v x d."""
    entries = np.zeros((*vectors.shape[:-1], 9), dtype=vectors.dtype)
    entries[..., _PLUS], entries[..., _MINUS] = vectors, -vectors
    return entries.reshape(*vectors.shape, 3)


def norms(rows: Array) -> Array:
    return sqrt(squares(rows))


def spectral_norms(matrices: Array) -> Array:
    """The largest singular value of every matrix, to float64 accuracy but in the numbers' own range."""
    largest = [max(abs(entry) for entry in matrix.flat) for matrix in matrices]
    sizes = np.array([nonzero(size) for size in largest], dtype=object)
    moderate = (matrices / sizes[:, None, None]).astype(np.float64)
    singular = np.linalg.norm(moderate, 2, axis=(1, 2))
    norms: Array = np.array(singular.tolist(), dtype=object) * sizes
    return norms


def ones(rows: Array) -> Array:
    """A 1 for every row, in the rows' own numbers."""
    return real([1] * len(rows), rows)


def size(rows: Array) -> Any:
    return max(norms(rows))


def largest(values: Array) -> Any:
    return nonzero(max(abs(value) for value in values))


def nonzero(scale: Any) -> Any:
    """The scale, or 1 where it vanishes: what is measured is then absolute."""
    return scale if scale != 0 else 0 * scale + 1


def quaternions(attitudes: Array, start: Quaternion | None = None) -> Array:
    """Return unit quaternions (n, 4), scalar first; the sign of each is that of its neighbour.

    The sign of the first is that of ``start``, if one is given.
    """
    xx, xy, xz, yx, yy, yz, zx, zy, zz = attitudes.reshape(-1, 9).T
    # A unit quaternion q of R is the eigenvector to the greatest eigenvalue of this symmetric matrix.
    upper = [
        [xx + yy + zz, zy - yz, xz - zx, yx - xy],
        [zy - yz, xx - yy - zz, xy + yx, xz + zx],
        [xz - zx, xy + yx, yy - xx - zz, yz + zy],
        [yx - xy, xz + zx, yz + zy, zz - xx - yy],
    ]
    rows = np.linalg.eigh(np.moveaxis(np.array(upper), -1, 0)).eigenvectors[:, :, -1]
    first = rows[0] if start is None else np.array(start, dtype=float)
    signs = np.where((rows * np.vstack([first, rows[:-1]])).sum(axis=1) < 0, -1.0, 1.0)
    return np.asarray(rows * np.cumprod(signs)[:, None])
