"""A candidate for a cause: evidence from the arcs, and the motion by which it is proven."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Final

import numpy as np

from taylor_verify.judge.causes.changed_equations import Changes
from taylor_verify.judge.causes.fit import Family
from taylor_verify.judge.causes.float_answer import Answer, Motion
from taylor_verify.judge.causes.many_flows import Floats
from taylor_verify.words.causes import with_numbers

# Digits of a short number, and the part by which one may be off.
_SHORT: Final = 2
_NEARLY: Final = 1e-4
# The effect of a number may be so many times less than in proportion.
_FARTHER: Final = 30.0
# Bodies whose entries agree to this part are one.
_SAME_BODY: Final = 1e-6
# A change below this part of its natural size is none.
_SAME: Final = 1e-10
# A number with so many digits may have been written, if it has them to this part of it, or to so many
# roundings of the file: of others one in some hundreds is by chance, and of the latter one in ten.
_WRITTEN: Final = 5
_NEAR: Final = 3e-8
_ROUNDINGS: Final = 3.0
_FAR: Final = 1e-6
# Another gravity is one of these, or a number with so few digits.
GRAVITY: Final = "factor of weight and buoyancy"
_GRAVITIES: Final = (9.81, 9.80665, 9.8, 1.0)
# Nor is a step, or the damping of a step, below this part.
_SLIGHT: Final = 1e-6


@dataclass(frozen=True)
class Candidate:
    """A fault with its numbers, the part of the ``defects`` that it leaves, and its motion at rows.

    It may be proven if it leaves no more than ``near``. The steps of a ``method`` take the place of its
    changes. ``errors`` are those of its numbers, where they are known. Unless its numbers ``are_seen``, the
    motion does not tell all of them.
    """

    family: Family
    numbers: Floats
    defects: float
    motion: Callable[[Answer, Changes], Motion | None]
    near: float
    method: Any = None
    errors: Floats | None = None
    are_seen: bool = True

    @property
    def kind(self) -> str:
        return self.family.kind

    @property
    def count(self) -> int:
        """Number of the numbers that were fitted."""
        return self.family.count

    @cached_property
    def changes(self) -> Changes:
        """The changes of the equations."""
        return self.family.as_written(self.numbers)

    @property
    def text(self) -> str:
        """The name, with numbers where there are some."""
        family, words, first = self.family, list[str](), 0
        if not self.count:
            return family.name
        for part in family.parts or (family,):
            places = slice(first, first + part.count)
            errors = () if self.errors is None else self.errors[places]
            own = part.name, part.labels, part.right, self.numbers[places], errors
            words.append(with_numbers(*own) if part.count else part.name)
            first += part.count
        return " and ".join(words)

    @property
    def is_nothing(self) -> bool:
        """True for the scene's own numbers, a factor that prints as 1, and no step of damping."""
        if not self.count:
            return False
        if np.all(np.abs(self.numbers - self.family.right) <= _SAME * self.family.scale):
            return True
        if self.kind == "damping step":
            return not self.numbers[0] > _SLIGHT * self.family.scale[0]
        is_factor = self.family.right[0] == 1.0
        is_alone = self.count == 1 or self.kind == "pair"
        return is_factor and is_alone and f"{self.numbers[0]:.6g}" == "1"


def has_few_digits(candidate: Candidate, floor: float) -> bool:
    """Return True if a candidate has no fitted number, or others that somebody may have written.

    ``floor`` is the rounding of the file as a part of the defects, and so of a change that makes them.
    """
    pairs = [*zip(candidate.numbers, candidate.family.right, strict=True)]
    if candidate.kind == "clock":
        # A factor of time may be written either way up.
        return any(_is_written(x, 1.0, floor) for x in (pairs[0][0], 1 / (pairs[0][0] or 1.0)))
    if candidate.family.name == GRAVITY:
        return any(_is_written(pairs[0][0] * g, g, floor) for g in _GRAVITIES)
    return not candidate.count or all(_is_written(x, right, floor) for x, right in pairs)


def _is_written(number: float, right: float, floor: float) -> bool:
    written, size = float(f"{number:.{_WRITTEN}g}"), abs(number)
    if size <= max(_SAME, _ROUNDINGS * floor) * abs(right):
        return True  # 0, for a number that is none
    unknown = min(max(_NEAR * size, _ROUNDINGS * floor * abs(number - right)), _FAR * size)
    return abs(written - number) <= unknown and written != right


def short(numbers: Floats) -> Floats:
    """Return numbers in so few digits that one who writes a scene may have chosen them."""
    return np.array([float(f"{x:.{_SHORT}g}") for x in numbers])


def is_short(candidate: Candidate) -> bool:
    """Return True if the numbers of a candidate differ from the scene's by short ones."""
    change = candidate.numbers - candidate.family.right
    return bool(np.all(np.abs(change - short(change)) <= _NEARLY * np.abs(change)))


def may_explain(candidate: Candidate, numbers: Floats, allowed: float) -> bool:
    """Return True if other numbers may leave no more than allowed: one number explains in proportion."""
    if candidate.count > 1:
        return True
    apart, explains = numbers - candidate.numbers, candidate.numbers - candidate.family.right
    return bool(np.all(np.abs(apart) <= _FARTHER * allowed * np.abs(explains)))


def are_same(changes: Changes, other: Changes) -> bool:
    """Return True if two changes of numbers lead to one body under one load."""
    is_of_numbers = changes.keys() == other.keys() and bool(changes) and "acting" not in changes
    return is_of_numbers and all(
        np.allclose(changes[name], other[name], rtol=_SAME_BODY, atol=0.0) for name in changes
    )


@dataclass(frozen=True)
class Cause:
    """A proven cause: the part of the error of each group that it ``leaves``, and others as good.

    ``where`` stands before the name: the part of the run, or the convention, that it is said for. Unless
    it ``is_whole`` it leaves of the attitude more than the file rounds off.
    """

    name: str
    kind: str
    leaves: Mapping[str, float]
    text: str = ""
    alike: tuple[str, ...] = ()
    changes: Changes = field(default_factory=dict)
    method: Any = None
    where: str = ""
    is_whole: bool = True

    @property
    def title(self) -> str:
        """Name of the cause with its numbers, and where it acts."""
        return ": ".join(filter(None, (self.where, self.text or self.name)))
