"""Checks: the distance of the two sides of a statement, and the allowed distance."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final, final

# A false statement must exceed its bound by this factor, more than an inaccurate bound could explain.
_CLEARLY: Final = 1e6


@dataclass(frozen=True)
class Residual:
    """Distance of the two sides of a statement, and the largest distance allowed.

    ``size`` and ``bound`` have the unit of the statement, or are relative where ``because`` says so.
    A bound of zero belongs to an identity that is expanded in exact rationals: there ``size`` is
    zero for an identity, and else the difference of the sides at a stated rational point.
    """

    size: float
    bound: float
    because: str

    @property
    def is_satisfied(self) -> bool:
        """True if the size is within the bound; a NaN is not."""
        return self.size <= self.bound

    @property
    def is_refuted(self) -> bool:
        """True if the size is far beyond the bound; a NaN refutes nothing."""
        return self.size > _CLEARLY * self.bound


Check = Callable[[], Residual]


class Worded(ABC):
    """A check that is written as text."""

    @abstractmethod
    def __call__(self) -> Residual: ...

    @abstractmethod
    def says(self, words: str) -> bool:
        """Return True if these words are in the text."""

    @abstractmethod
    def but(self, old: str, new: str) -> Check:
        """Return the check of the text with new words for old ones, wherever these stand."""


@final
class All(Worded):
    """The conjunction of several checks, as large as the worst of them."""

    def __init__(self, *checks: Check) -> None:
        self.checks = checks

    def __call__(self) -> Residual:
        return worse(*(check() for check in self.checks))

    def says(self, words: str) -> bool:
        return any(isinstance(check, Worded) and check.says(words) for check in self.checks)

    def but(self, old: str, new: str) -> Check:
        """Return the checks that change, changed, without those that do not."""
        return All(
            *(
                check.but(old, new)
                for check in self.checks
                if isinstance(check, Worded) and check.says(old)
            )
        )


def worse(*residuals: Residual) -> Residual:
    """Return the most critical residual: a NaN, else one that exceeds its bound, else the largest."""
    return max(residuals, key=lambda r: (r.size != r.size, not r.is_satisfied, r.size))


def measured(check: Check) -> Residual:
    """Return the residual of a check; NaN with the reason if the check gives no number."""
    try:
        return check()
    except ArithmeticError as error:
        return Residual(float("nan"), bound=0.0, because=f"no number: {error}")
