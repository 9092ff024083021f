"""The functions of a lattice at many real arguments: one by one, or by polynomials that they share.

Legend as in lattice and theta_series; v = u/L, and lead = 2 q^(1/4). Where theta_1 and theta_2 are series,

    p(u) = e_1 + c (theta_2/theta_1)^2,    p'(u) = -(theta_1'(0)/L)^3 theta_1(2v)/theta_1(v)^4,

the latter because p' is -sigma(2u)/sigma(u)^4. In both the complex lead cancels.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import TYPE_CHECKING, final

from flint import acb, arb

from taylor_verify.exact.theta_series import Places, ThetaSeries

if TYPE_CHECKING:
    from taylor_verify.exact.lattice import Lattice, Periods


class Line(ABC):
    """Many real arguments u, in the order in which they were given."""

    @abstractmethod
    def p(self) -> list[tuple[arb, arb]]:
        """(p, p') at each argument, both real; not finite at a period."""

    @abstractmethod
    def jets(self, w: acb, scale: acb, order: int) -> list[list[acb]]:
        """s(u - w)/scale at each argument, and for order 1 a second list: its derivatives there."""


@final
class OneByOne(Line):
    """Few arguments, or a lattice without a short series."""

    def __init__(self, lattice: Lattice, arguments: Sequence[arb]) -> None:
        self._lattice, self._arguments = lattice, arguments

    def p(self) -> list[tuple[arb, arb]]:
        both = (self._lattice.p(acb(u)) for u in self._arguments)
        return [(p.real, slope.real) for p, slope in both]

    def jets(self, w: acb, scale: acb, order: int) -> list[list[acb]]:
        jets = [self._lattice.jet(u - w, order) for u in self._arguments]
        return [[jet[k] / scale for jet in jets] for k in range(order + 1)]


@final
class BySeries(Line):
    """Many arguments of a lattice of two periods."""

    def __init__(self, lattice: Periods, series: ThetaSeries, arguments: Sequence[arb]) -> None:
        self._lattice, self._series = lattice, series
        turn = arb.pi() / lattice.period
        self._places = Places([turn * u for u in arguments])

    def p(self) -> list[tuple[arb, arb]]:
        series, places = self._series, self._places
        theta1, theta2 = series.one(arb(1)), series.two(arb(1))
        e, c, cube = self._lattice.real_constants
        cube = -cube
        doubled, values = places.doubled, []
        for sin, cos, one_v, two_v, sin_2v, one_2v in zip(
            places.sines,
            places.cosines,
            places.at(theta1),
            places.at(theta2),
            doubled.sines,
            doubled.at(theta1),
            strict=True,
        ):
            below = 1 / (sin * one_v)
            across, square = cos * two_v * below, below * below
            slope = cube * sin_2v * one_2v * (square * square)
            values.append((e + c * (across * across), slope))
        return values

    def jets(self, w: acb, scale: acb, order: int) -> list[list[acb]]:
        length, factor = self._lattice.period, self._series.lead / scale
        return [
            self._series.shifted(-w / length, factor / length**k, k).at(self._places)
            for k in range(order + 1)
        ]
