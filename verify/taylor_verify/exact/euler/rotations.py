"""The motion of a rigid body by either route: omega in body axes, and R from an attitude at the start.

A course is one motion that is set up at one precision, and valid only there. It is stored for later times:
working precisions are multiples of a step, so that calls share their courses.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any, Final, Protocol, final

import numpy as np
from flint import arb, arb_mat, ctx
from mpmath import mp

from taylor_verify.exact.balls import Enclosed, Enclosure, ball_matrix
from taylor_verify.exact.frames import product, start_frame
from taylor_verify.exact.solution import Quantities, Settled, Time, longest
from taylor_verify.numbers.precision import floor_log2
from taylor_verify.numbers.rotation import rotation_matrix
from taylor_verify.scenes import motion

_STEP_BITS: Final = 32
# Less than SETTLING_STEP_DIGITS: two evaluations that are compared never share a course.
_STEP_DIGITS: Final = 10


Rows = list[list[arb]]
Moving = tuple[Rows, Sequence[Rows]]
"""omega at every time, and the rows of R; none of the latter where it is not asked for."""


class Course(Protocol):
    """A motion at one precision: numbers of flint, or of mpmath."""

    def at(self, t: Time, turned: bool) -> tuple[list[Any], list[Any]]:
        """omega, and the rows of the turn since the start in body axes, empty unless it is asked for."""
        ...


class BallCourse(Protocol):
    """A motion at one precision of flint."""

    def rows(self, times: Sequence[Time], start: arb_mat | None) -> Moving:
        """omega at every time, and R from the R at the start."""
        ...


class OneByOne(ABC):
    """A motion at one precision of flint, computed at one time after the other."""

    @abstractmethod
    def at(self, t: Time, turned: bool) -> tuple[list[arb], Rows]:
        """omega, and the turn since the start: as Course.at."""

    def rows(self, times: Sequence[Time], start: arb_mat | None) -> Moving:
        """omega at every time, and R from the R at the start."""
        both = [self.at(t, turned=start is not None) for t in times]
        frames = [] if start is None else [(start * arb_mat(turn)).tolist() for _, turn in both]
        return [omega for omega, _ in both], frames


@final
@dataclass(eq=False)
class RotationBalls(Enclosed):
    """omega(t) and R(t) in balls."""

    regime: str
    set_up: Callable[[], BallCourse]
    attitude: motion.Quaternion | None = None
    _courses: dict[int, BallCourse] = field(default_factory=dict, init=False)

    def enclose(self, elapsed: Sequence[Time], bits: int) -> Enclosure:
        """``omega``, rows of 3, and ``attitude``, rows of 3x3, where it is tracked."""
        with ctx.workprec(-(-bits // _STEP_BITS) * _STEP_BITS):
            course = self.course()
            if self.attitude is None:
                return {"omega": course.rows(elapsed, None)[0]}
            omega, frames = course.rows(elapsed, ball_matrix(rotation_matrix(self.attitude)))
            return {"omega": omega, "attitude": frames}

    def course(self) -> BallCourse:
        """The course at the ambient precision of flint."""
        if ctx.prec not in self._courses:
            self._courses[ctx.prec] = self.set_up()
        return self._courses[ctx.prec]


@final
@dataclass(eq=False)
class Rotation(Settled):
    """omega(t) and R(t) in mpmath.

    ``lost`` bounds the decimal digits that a course loses up to a time, its attitude included or not.
    """

    regime: str
    set_up: Callable[[], Course]
    lost: Callable[[Fraction, bool], float]
    attitude: motion.Quaternion | None = None
    _courses: dict[int, Course] = field(default_factory=dict, init=False)

    route = "mpmath"

    def evaluate(self, elapsed: Sequence[Time], digits: int) -> Quantities:
        """``omega`` (n, 3) and ``attitude`` (n, 3, 3), to about ``digits`` significant digits."""
        attitude = self.attitude
        lost = self.lost(longest(elapsed), attitude is not None)
        working = math.ceil((digits + lost) / _STEP_DIGITS) * _STEP_DIGITS
        with mp.workdps(working):
            if working not in self._courses:
                self._courses[working] = self.set_up()
            rows = [self._courses[working].at(t, turned=attitude is not None) for t in elapsed]
            quantities: Mapping[str, np.ndarray[Any, Any]] = {
                "omega": _array([w for w, _ in rows], 3)
            }
            if attitude is not None:
                start = start_frame(attitude)
                frames = [product(start, turn) for _, turn in rows]
                quantities = {**quantities, "attitude": _array(frames, 3, 3)}
        with mp.workdps(digits):
            return {name: +values for name, values in quantities.items()}


def decades(ratio: Fraction) -> float:
    """An upper bound of log10(ratio), for a positive ratio of any size."""
    return (floor_log2(ratio) + 1) * math.log10(2)


def _array(rows: Sequence[Any], *shape: int) -> np.ndarray[Any, Any]:
    return np.array(rows, dtype=object).reshape(-1, *shape)
