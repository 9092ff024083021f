"""Faults in single entries of the Coriolis matrix of an added mass, and in sets that simulators zero."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product
from typing import Final

import numpy as np

from taylor_verify.judge.causes.basis import EPSILON, coriolis_of
from taylor_verify.judge.causes.changed_equations import Equations
from taylor_verify.judge.causes.fit import Family, fault
from taylor_verify.judge.causes.many_flows import Floats

_KIND: Final = "Coriolis matrix"
_MASSES: Final = np.kron([[1.0, 0.0], [0.0, 0.0]], np.ones((3, 3)))
# Parts of an added mass of which its Coriolis terms may be made; that of its diagonal is another body's.
_PARTS: Final = {
    "its masses alone": _MASSES,
    "its diagonal masses alone": _MASSES * np.eye(6),
    "all but its coupling of masses and moments": np.kron(np.eye(2), np.ones((3, 3))),
}
_Places = tuple[tuple[int, int], ...]


def _with_mirrors(places: _Places) -> _Places:
    return (*places, *((k, i) for i, k in places))


_LOWER: Final = ((5, 1), (5, 3), (6, 1), (6, 2))
# Entries that public simulators set to zero together, rows and columns from 1.
_TOGETHER: Final[dict[str, _Places]] = {
    "pitch and yaw by the velocities": _LOWER,
    "pitch by the velocities": _LOWER[:2],
    "yaw by the velocities": _LOWER[2:],
    "as in MSS": _with_mirrors(_LOWER),
    "as in MSS, but for C_62 and C_26": _with_mirrors(_LOWER[:3]),
    "as in another version of MSS": ((5, 1), (5, 4), (6, 1), (6, 2)),
    "its lower left block, the Munk moment": tuple(product((4, 5, 6), (1, 2, 3))),
    "its upper right block": tuple(product((1, 2, 3), (4, 5, 6))),
    "its lower right block": tuple(product((4, 5, 6), (4, 5, 6))),
    "all but its Munk moment": tuple(product(range(1, 7), (4, 5, 6))),
}


def faults_of_added_mass(right: Equations) -> Iterator[Family]:
    """Yield the faults of the entries of an added mass that the scene names."""
    if right.added is None or not np.any(right.added):
        return
    for words, places in _TOGETHER.items():
        listed = " ".join(f"C_{i}{k}" for i, k in places)
        name = f"entries {listed} of the added mass are 0 ({words})"
        yield fault(name, _KIND, _changed(right, places, 0.0))
    whole, parts = coriolis_of(right.added), [right.added, right.added * np.eye(6)]
    for words, entries in _PARTS.items():
        part = right.added * entries
        if not any(np.array_equal(part, other) for other in parts):
            parts.append(part)
            extra = right.basis.factors(products=coriolis_of(part) - whole)
            name = f"the Coriolis terms of the added mass are made of {words}"
            yield fault(name, _KIND, {"extra": extra})
    for i, k in product(range(1, 7), repeat=2):
        for words, factor in (("is 0", 0.0), ("has the other sign", -1.0)):
            changes = _changed(right, ((i, k),), factor)
            if np.any(changes["extra"]):
                name = f"entry C_{i}{k} of the added mass {words}, in the Coriolis matrix"
                yield fault(name, _KIND, changes)


def _changed(right: Equations, places: _Places, factor: float) -> dict[str, Floats]:
    """Return the change by entries of C_A that have a factor."""
    forms = np.zeros((6, 6, 6))
    for i, k in places:
        forms[i - 1, :, k - 1] = (factor - 1) * _entry(right, i - 1, k - 1)
    return {"extra": right.basis.factors(products=right.basis.products(forms))}


def _entry(right: Equations, i: int, k: int) -> Floats:
    """Return the factors of nu in the entry of -C_A, (6,)."""
    if i < 3 and k < 3:
        return np.zeros(6)
    assert right.added is not None
    rows = right.added[3:] if i > 2 and k > 2 else right.added[:3]
    # S(p)_ik = -epsilon_ikj p_j
    return np.asarray(-EPSILON[i % 3, k % 3] @ rows)
