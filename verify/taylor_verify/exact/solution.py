"""An exact solution, and the conditions under which its numbers are accepted.

The truth is independent of what it judges: nothing here imports models, solvers or the judge.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Mapping, Sequence
from fractions import Fraction
from typing import Any, Final, final

import numpy as np
from mpmath import mp, mpf

from taylor_verify.numbers.precision import power_of_two
from taylor_verify.scenes.motion import Motion

Quantities = Mapping[str, np.ndarray[Any, Any]]

Time = Any
"""A time since the start: a rational, or a number of the route, which is a ball or an mpf."""

Number = Callable[[Any], Any]
"""A function that makes a ball or an mpf of a rational, at the ambient precision; others stay unchanged."""

NO_CLOSED_FORM: Final = "no closed form"

_FIRST_GUARD_DIGITS = 3
# Two evaluations that are compared differ by this much in precision.
SETTLING_STEP_DIGITS: Final = 12
# The precision rises by this many steps, attempt by attempt, until two evaluations agree. The numbers are
# odd, so that an effect at every second step cannot occur in two evaluations that are compared.
_RISES: Final = (1, 1, 3, 3, 9, 9, 27)


class NoClosedForm(Exception):
    """The error for a scene that tracks a quantity without a closed form; the text names it."""


class Unsettled(ArithmeticError):
    """The error for digits that cannot be reached at every time; the text says why.

    ``motion`` holds the rows that have their digits all the same, and is None where none has. Its row k
    belongs to time number ``places[k]`` of those that were asked for. With ``is_end`` the motion itself
    ends on the way, so that no solver can reach the other times.
    """

    def __init__(
        self,
        because: str,
        motion: Motion | None = None,
        places: Sequence[int] = (),
        is_end: bool = False,
    ) -> None:
        super().__init__(because)
        self.motion, self.places, self.is_end = motion, tuple(places), is_end

    @classmethod
    def beside(cls, because: str, motion: Motion | None, digits: int) -> Unsettled:
        """The doubt with those rows of a motion at all times whose radius is small enough."""
        if motion is None:
            return cls(because)
        # Written so that a NaN is not small.
        places = [k for k, radius in enumerate(motion.radius) if radius <= mpf(10) ** -digits]
        return cls(because, motion.at(places), places) if places else cls(because)


class Solution(ABC):
    """The exact motion of one scene.

    ``regime`` is one word for the kind of orbit, decided in exact rationals, or ``no closed form``.
    ``route`` is ``arb`` or ``mpmath`` (closed forms), or ``taylor`` (enclosed Taylor series).
    ``by_periods`` says that its periods are integrals, made once.
    """

    regime: str
    route: str
    by_periods: bool = False

    @property
    def evidence(self) -> str:
        """``proven`` where the radius is a bound; ``agreed`` where two precisions agree to that much."""
        return "agreed" if self.route == "mpmath" else "proven"

    @abstractmethod
    def motion(self, elapsed: Sequence[Fraction], digits: int) -> Motion:
        """The motion at these times since the start, to ``digits`` digits of every vector and matrix.

        Raises Unsettled where that cannot be had at every time.
        """

    def evaluate(self, elapsed: Sequence[Fraction], digits: int) -> Quantities:
        """The tracked quantities at these times, to about ``digits`` digits and without a claim.

        Object arrays of mpf shaped as in Motion. Those of the motion, unless stated.
        """
        return self.motion(elapsed, digits).quantities


class Settled(Solution):
    """A solution that is accepted when two evaluations at different precisions agree."""

    @abstractmethod
    def evaluate(self, elapsed: Sequence[Time], digits: int) -> Quantities:
        """The tracked quantities at one precision, at times that are rational or mpf."""

    @final
    def motion(self, elapsed: Sequence[Fraction], digits: int) -> Motion:
        """The motion to ``digits`` significant digits of every vector and matrix.

        Two evaluations at different precisions must agree to the digits asked for; until they do,
        both precisions rise. The difference is the error of the poorer one; the better one is returned.

        Raises Unsettled when some hundreds of digits do not suffice.
        """
        working = digits + _FIRST_GUARD_DIGITS
        poorer = self.evaluate(elapsed, working)
        for rise in _RISES:
            finer = working + rise * SETTLING_STEP_DIGITS
            better = self.evaluate(elapsed, finer)
            with mp.workdps(finer):
                radii = _differences(poorer, better)
                radius = np.array(
                    [_largest(row) for row in zip(*radii.values(), strict=True)], dtype=object
                )
                motion = Motion(better, radius, radii, _apart(poorer, better))
                # Written so that a NaN is not agreement.
                if _largest(radius) <= mpf(10) ** -digits:
                    return motion
            poorer, below, working = better, working, finer
        because = (
            f"two evaluations of the exact solution at {below} and {working} digits do not agree to "
            f"{digits} digits"
        )
        raise Unsettled.beside(because, motion, digits)


def longest(elapsed: Iterable[Time]) -> Fraction:
    """Return the longest of these times; of an mpf, the power of two above it."""
    return max(
        (abs(t) if isinstance(t, Fraction) else power_of_two(mp.mag(t)) for t in elapsed if t != 0),
        default=Fraction(0),
    )


def beside(time: Time, number: Number) -> Number:
    """Return a function that makes exact numbers fit to be combined with a time, which may be exact too."""
    return unchanged if isinstance(time, Fraction) else number


def unchanged(value: Any) -> Any:
    """Return the value: the conversion of what needs none."""
    return value


def _differences(poorer: Quantities, better: Quantities) -> Quantities:
    """Row by row, the relative Frobenius distance of every quantity."""
    return {
        name: np.array(
            [_distance(p, b) for p, b in zip(poorer[name], rows, strict=True)], dtype=object
        )
        for name, rows in better.items()
    }


def _apart(poorer: Quantities, better: Quantities) -> Quantities:
    """The distance of every component."""
    return {name: np.abs(poorer[name] - values) for name, values in better.items()}


def _largest(differences: Iterable[mpf]) -> mpf:
    """The largest, or a NaN if there is one (Python's max would lose it); 0 of none."""
    return max(differences, key=lambda d: (d != d, d), default=mpf(0))


def _distance(p: np.ndarray[Any, Any], b: np.ndarray[Any, Any]) -> mpf:
    """The norm of the difference as Motion.radius measures it: by that of b, absolute where b is zero."""
    size = mp.norm(list(b.flat))
    return mp.norm(list((p - b).flat)) / (size if size > 0 else 1)
