"""Two families at once, chosen by the linear fits of both."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Final

import numpy as np

from taylor_verify.judge.causes.arcs import Evidence
from taylor_verify.judge.causes.changed_equations import Equations
from taylor_verify.judge.causes.fit import Family, across, both, orthonormal
from taylor_verify.judge.causes.many_flows import Floats
from taylor_verify.judge.causes.settled import FEW

# Numbers of both together, and the pairs that are tried: the best ones, a number counting as much as this.
_NUMBERS: Final = 6
_MOST: Final = 8
_OF_A_NUMBER: Final = 3.0
# A pair is tried if its linear fit leaves so little, where one of both alone leaves less than this.
_LINEAR: Final = 0.15
_ALONE: Final = 0.97
# A fault and a family leave less than this part of what each of them leaves alone.
_OF_BOTH: Final = 0.5
# A linear fit that leaves no more is good.
_GOOD: Final = 0.3
# Numbers are far if they differ by this part of their scale.
_FAR: Final = 0.3
# Kinds that are one class: no two of them make a pair.
_OF_INERTIA: Final = dict.fromkeys(
    ("body", "part of the body", "Coriolis matrix", "gyroscopic term", "Coriolis terms"), "inertia"
)


@dataclass(frozen=True)
class Linear:
    """A family with its slopes at the right numbers, and the part that its linear fit leaves."""

    family: Family
    slopes: Floats
    left: float

    def is_beyond(self, size: float) -> bool:
        """Return True if numbers far from the right ones leave more than defects of this size."""
        return bool(np.linalg.norm(_FAR * self.slopes @ self.family.scale) > size)

    def begin(self, evidence: Evidence) -> Floats:
        """Return the numbers at which a fit begins: those of the linear fit, if it is good and of one."""
        right = self.family.right
        if self.family.count > 1 or self.left > _GOOD:
            return right
        step = np.linalg.lstsq(self.slopes, evidence.of_right.ravel(), rcond=None)[0]
        return np.asarray(right - step)


def _class(family: Family) -> str:
    """Return the class of a kind of faults."""
    return _OF_INERTIA.get(family.kind, family.kind)


def likely_pairs(
    linear: Sequence[Linear], evidence: Evidence, right: Equations
) -> Iterator[Family]:
    """Yield the best pairs of families of few numbers, as families."""
    few = [each for each in linear if each.family.count <= FEW]
    bases = [orthonormal(each.slopes * each.family.scale, 1e-6) for each in few]
    rests = [across(basis, evidence.of_right.ravel()) for basis in bases]
    tried = list[tuple[float, int, int]]()
    for i, k in combinations(range(len(few)), 2):
        one, other = few[i], few[k]
        count = one.family.count + other.family.count
        is_alone = min(one.left, other.left) > _ALONE
        if _class(one.family) == _class(other.family) or count > _NUMBERS or is_alone:
            continue
        basis = orthonormal(bases[k] - bases[i] @ (bases[i].T @ bases[k]), 1e-9)
        left = float(np.linalg.norm(across(basis, rests[i]))) / evidence.size
        if left < _LINEAR:
            tried.append((left * _OF_A_NUMBER**count, i, k))
    for _, i, k in sorted(tried)[:_MOST]:
        yield both(right, few[i].family, few[k].family)


def pairs_with_a_fault(
    left_by: Sequence[tuple[Family, Floats]],
    linear: Sequence[Linear],
    evidence: Evidence,
    right: Equations,
) -> Iterator[Family]:
    """Yield the best pairs of a fault without numbers and a family, by what a fault leaves of the defects.

    Loads that both change as texts are no pair.
    """
    some = [(fault, rest.ravel()) for fault, rest in left_by if np.all(np.isfinite(rest))]
    few = [each for each in linear if each.family.count <= _NUMBERS]
    if not some or not few:
        return
    rests = np.stack([rest for _, rest in some], axis=1)
    alone = np.linalg.norm(rests, axis=0) / evidence.size
    tried = list[tuple[float, int, int]]()
    for i, each in enumerate(few):
        basis = orthonormal(each.slopes * each.family.scale, 1e-6)
        left = np.linalg.norm(rests - basis @ (basis.T @ rests), axis=0) / evidence.size
        for k in np.flatnonzero(
            (left < _LINEAR) & (left < _OF_BOTH * np.minimum(alone, each.left))
        ):
            tried.append((float(left[k]) * _OF_A_NUMBER**each.family.count, i, int(k)))
    for _, i, place in sorted(tried)[:_MOST]:
        family, (fault, _) = few[i].family, some[place]
        changed = fault.changes(fault.right).keys() & family.changes(family.right).keys()
        if _class(family) != _class(fault) and "acting" not in changed:
            yield both(right, fault, family)
