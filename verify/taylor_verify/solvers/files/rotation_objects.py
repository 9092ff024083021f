"""Objects of libraries that are attitudes, recognised by their attributes: rotations, and lists of them."""

from __future__ import annotations

from collections.abc import Mapping
from operator import attrgetter
from typing import Any, Final

import numpy as np

# Scalar first: numpy-quaternion, pyquaternion, and whatever else has these attributes.
_COMPONENTS: Final = attrgetter("w", "x", "y", "z")


def is_rotation(value: Any) -> bool:
    """Return True for a Rotation or a RigidTransform of SciPy, or what has the same methods."""
    has_rotation = hasattr(value, "rotation") and hasattr(value, "translation")
    return has_rotation or (hasattr(value, "as_quat") and hasattr(value, "as_matrix"))


def groups_of(value: Any) -> Mapping[str, Any]:
    """Return the rows of each group that an object holds; none for what is no attitude.

    A Rotation and a list of rotations or quaternions are quaternions, scalar first; a RigidTransform has
    the centre too.
    """
    if is_rotation(value):
        return _of_rotation(value)
    entries = value if isinstance(value, list | tuple) else ()
    if isinstance(value, np.ndarray) and value.dtype == object and value.ndim == 1:
        entries = value.tolist()
    if entries and all(map(is_rotation, entries)):
        each = [_of_rotation(entry) for entry in entries]
        return {group: np.concatenate([rows[group] for rows in each]) for group in each[0]}
    try:
        return {"quaternion": np.array(list(map(_COMPONENTS, entries)))} if entries else {}
    except AttributeError:
        return {}


def _of_rotation(value: Any) -> dict[str, Any]:
    if not hasattr(value, "as_quat"):
        return _of_rotation(value.rotation) | {"centre": np.atleast_2d(value.translation)}
    # Asked for in the order that SciPy has by default, scalar last.
    return {"quaternion": np.atleast_2d(value.as_quat())[:, [3, 0, 1, 2]]}


def bare(value: Any) -> tuple[Any, str]:
    """Return the numbers of a quantity with a unit, of astropy or pint, and its unit as text."""
    for numbers, unit in (("value", "unit"), ("magnitude", "units")):
        if hasattr(value, numbers) and getattr(value, unit, None) is not None:
            return getattr(value, numbers), str(getattr(value, unit))
    return value, ""
