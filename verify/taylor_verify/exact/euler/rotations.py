"""The motion of a rigid body by either route: omega in body axes, and R from an attitude at the start.

A course is one motion that is set up at one precision, and valid only there. It is stored for later times:
working precisions are multiples of a step, so that calls share their courses.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from typing import Any, Final, Protocol, final

import numpy as np
from flint import arb, ctx
from mpmath import mp

from taylor_verify.exact import rotation
from taylor_verify.exact.balls import Enclosed, Enclosure
from taylor_verify.exact.frames import product, start_frame
from taylor_verify.exact.solution import Quantities, Settled, Time, longest
from taylor_verify.scenes import motion
from taylor_verify.scenes.motion import Motion
from taylor_verify.scenes.precision import floor_log2

_STEP_BITS: Final = 32
# Less than SETTLING_STEP_DIGITS: two evaluations that are compared never share a course.
_STEP_DIGITS: Final = 10


Moving = tuple[list[list[arb]], list[list[list[arb]]]]
"""omega at every time, and the rows of R; none of the latter where it is not asked for."""


class Course(Protocol):
    """A motion at one precision: numbers of flint, or of mpmath."""

    def at(self, t: Time, turned: bool) -> tuple[list[Any], list[Any]]:
        """omega, and the turn since the start in body axes, empty unless it is asked for.

        The turn is a unit quaternion in balls, which is 1 at the start and whose sign never jumps; or the
        rows of a rotation matrix in mpmath.
        """
        ...


class BallCourse(ABC):
    """A motion at one precision of flint."""

    @abstractmethod
    def at(self, t: Time, turned: bool) -> tuple[list[arb], list[arb]]:
        """omega, and the turn since the start as a quaternion: as Course.at."""

    def rows(self, times: Sequence[Time], start: motion.Quaternion | None) -> Moving:
        """omega at every time, and R from an attitude at the start: one by one, unless stated."""
        if start is None:
            return [self.at(t, turned=False)[0] for t in times], []
        quaternion, both = rotation.unit(start), [self.at(t, turned=True) for t in times]
        frames = [rotation.rotation_rows(rotation.product(quaternion, q)) for _, q in both]
        return [omega for omega, _ in both], frames


@final
@dataclass(eq=False)
class RotationBalls(Enclosed):
    """omega(t) and R(t) in balls; with ``by_quaternion`` the unit quaternion in the place of R."""

    regime: str
    set_up: Callable[[], BallCourse]
    attitude: motion.Quaternion | None = None
    by_quadrature: bool = False
    by_quaternion: bool = False
    _courses: dict[int, BallCourse] = field(default_factory=dict, init=False)

    def enclose(self, elapsed: Sequence[Time], bits: int) -> Enclosure:
        """``omega``, rows of 3, and ``attitude``, rows of 3x3, where it is tracked."""
        with ctx.workprec(-(-bits // _STEP_BITS) * _STEP_BITS):
            course = self.course()
            if self.by_quaternion and self.attitude is not None:
                start = rotation.unit(self.attitude)
                rows = [course.at(t, turned=True) for t in elapsed]
                return {
                    "omega": [omega for omega, _ in rows],
                    "quaternion": [rotation.product(start, turn) for _, turn in rows],
                }
            omega, frames = course.rows(elapsed, self.attitude)
            return (
                {"omega": omega} if self.attitude is None else {"omega": omega, "attitude": frames}
            )

    def course(self) -> BallCourse:
        """The course at the ambient precision of flint."""
        if ctx.prec not in self._courses:
            self._courses[ctx.prec] = self.set_up()
        return self._courses[ctx.prec]

    def quaternion(self, elapsed: Sequence[Fraction], digits: int) -> Motion:
        """``quaternion`` (n, 4) for ``attitude``: scalar first, of unit length, with a proven radius.

        It starts as the scene's own over its norm; its sign follows the motion without a jump.
        """
        return replace(self, by_quaternion=True).motion(elapsed, digits)


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
