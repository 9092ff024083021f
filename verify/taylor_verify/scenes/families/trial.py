"""Trial bodies of a template: a template of which no trial body is a scene is refused."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from itertools import count
from math import gcd
from typing import Final

from taylor_verify.records.faults import Refused
from taylor_verify.scenes.families.cube import Spread, places
from taylor_verify.scenes.families.distributions import Draw
from taylor_verify.scenes.families.family import Family, Place

# If 2 % of the points are bodies, none is among so many trials with a probability of 3e-5.
_TRIALS: Final = 512
# Of a template of more than 2 kB fewer bodies are tried, because a megabyte takes a second to read.
_LEAST_TRIALS: Final = 16
_MOST_CHARACTERS: Final = 2**20


def trial_faults(family: Family, faulty: Collection[str] = ()) -> list[str]:
    """Return the faults of a template of which no trial body is a scene; none if one trial body is.

    The faults are those of a trial body that has fewest. All that come from the numbers become one fault,
    which says how many trial bodies were refused. ``faulty`` are the paths of numbers whose rules
    have faults: the faults of a scene at these places are left out.
    """
    refused: list[list[str]] = []
    for place, node in _trials(family):
        faults = [f for f in _faults(family, place, node) if not _has_number(f, faulty)]
        if not faults:
            return []
        refused.append(faults)
    fewest = min(refused, key=len)
    paths = [variable.path for variable in family.variables]
    # A fault of a whole array, which has a wrong length for example, is one that any numbers have.
    varying = [f for f in fewest if ", got [" not in f and _has_number(f, paths)]
    fixed = [f for f in fewest if f not in varying]
    return [*fixed, *(_summary(f, len(refused), family) for f in varying[:1])]


def _trials(family: Family) -> list[tuple[Place, int]]:
    """Return places of the cube, each with a point of the grid; all points of a grid that is small."""
    length = sum(len(piece) for piece in family.pieces if isinstance(piece, str))
    most = max(_LEAST_TRIALS, min(_TRIALS, _MOST_CHARACTERS // (length + 1)))
    number = most if family.free else min(most, family.nodes)
    step = _step(family.nodes)
    cube = places(Spread.RANDOM, family.free, 0, 0, number)
    return [(place, k * step % family.nodes) for k, place in enumerate(cube)]


def _step(nodes: int) -> int:
    """Return a step that visits each point of a grid once, successive points far from each other."""
    golden = max(1, nodes * 618 // 1000)
    return next(step for step in count(golden) if gcd(step, nodes) == 1)


def _faults(family: Family, place: Place, node: int) -> Sequence[str]:
    try:
        family.scene(place, node)
    except Refused as refused:
        return refused.faults
    return ()


def _has_number(fault: str, paths: Collection[str]) -> bool:
    """Return True if a number with one of these paths stands at the place of a fault, or within it."""
    place = place_of(fault)
    return any(path.startswith(place) for path in paths)


def place_of(fault: str) -> str:
    """Return the place that a fault names, such as ``body.inertia[0]``."""
    return fault.rpartition(" @ ")[2].partition(" (")[0]


def _summary(example: str, trials: int, family: Family) -> str:
    """Return one fault for trial bodies that were all refused; the mend of the example comes first."""
    got = f"{trials} refused trial {'body' if trials == 1 else 'bodies'}"
    fault = f"expected numbers of which some make a body, got {got}, for example: {example}"
    return fault if example.endswith(")") else f"{fault} ({_mend(family)})"


def _mend(family: Family) -> str:
    rules = [variable.rule for variable in family.variables]
    has_range = any(isinstance(rule, Draw) and rule.kind != "choice" for rule in rules)
    return "widen or move the range" if has_range else "add other numbers"
