"""Bounds of all nodes of a tape in one step: how far each is from its polynomial, how fast it changes.

All bounds are of one component alone; no norm mixes components. To be used at BOUND_BITS.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from operator import mul

from flint import arb, arb_mat, ctx

from taylor_verify.exact.enclosure.kinks import Absolute, Norm
from taylor_verify.exact.enclosure.operations import ONE, ZERO, Bilinear, Factors, State
from taylor_verify.exact.enclosure.series import Series, convolved
from taylor_verify.exact.enclosure.tube import StepTooLong

# A polynomial is looked at on intervals halved so often, where no sign of its slope decides.
_HALVINGS = 6
# What the coefficients of higher orders add is no part of a guess.
_FEW_ORDERS = 14


class Bounds:
    """Bounds of the nodes on the polynomial alone, and then, after `widen`, in a tube about it.

    Per node: ``length`` is sum |v_k|, ``change`` the same from order 1 on, ``missed`` is tau, ``beside`` is
    delta, ``slopes`` are bounds of its derivatives by the components of the state.
    """

    def __init__(self, series: Series) -> None:
        self.series, self.tape, self.order = series, series.tape, series.order
        self._tails: dict[int, list[arb]] = {}
        self._slope_tails: dict[int, list[arb]] = {}
        self._measure(series.forward)
        self.missed = [
            ZERO if self._is_polynomial(i) else operation.left_out(i, self).abs_upper()
            for i, operation in enumerate(self.tape.operations)
        ]

    @classmethod
    def rough(cls, series: Series, factor: arb) -> Bounds:
        """Guesses for a step longer by a factor: from the first orders, as if nothing were left out."""
        powers = [ONE]
        for _ in range(_FEW_ORDERS):
            powers.append(powers[-1] * factor)
        bounds = cls.__new__(cls)
        bounds.series, bounds.tape, bounds.order = series, series.tape, series.order
        bounds._measure([list(map(mul, row, powers)) for row in series.forward])
        bounds._leave_nothing_out()
        return bounds

    @classmethod
    def at_start(cls, series: Series) -> Bounds:
        """The bounds of the values at the beginning, where nothing is left out."""
        bounds = cls.__new__(cls)
        bounds.series, bounds.tape, bounds.order = series, series.tape, series.order
        bounds._measure([row[:1] for row in series.forward])
        bounds._leave_nothing_out()
        return bounds

    def _leave_nothing_out(self) -> None:
        self.missed = [ZERO] * len(self.sizes)
        # Kinks that lie within the step are not met.
        self._least_under = {}

    def _measure(self, coefficients: Sequence[Sequence[arb]]) -> None:
        self.sizes = [[entry.abs_upper() for entry in row] for row in coefficients]
        self.change = [sum(row[1:], ZERO) for row in self.sizes]
        self.length = [row[0] + rest for row, rest in zip(self.sizes, self.change, strict=True)]
        self.beside: list[arb] = []
        self.slopes: list[dict[int, arb]] = []

    def _is_polynomial(self, i: int) -> bool:
        return isinstance(self.tape.operations[i], State) or self.tape.degrees[i] is not None

    def widen(self, around: Sequence[arb]) -> None:
        """Bound every node for the states that are ``around`` the polynomial, component by component.

        Raises StepTooLong where a function may have no value or no derivative there.
        """
        self.beside, self.slopes = [], []
        for i, operation in enumerate(self.tape.operations):
            if isinstance(operation, State):
                self.beside.append(around[operation.component])
                self.slopes.append({operation.component: ONE})
                continue
            if self.tape.degrees[i] is not None:
                self.beside.append(ZERO)
                self.slopes.append({})
                continue
            self.beside.append(operation.apart(i, self).abs_upper())
            if not self.beside[i].is_finite():
                raise StepTooLong
            self.slopes.append(self._slopes_of(i) if self.tape.moves[i] else {})

    def _slopes_of(self, i: int) -> dict[int, arb]:
        slopes: dict[int, arb] = {}
        for weight, operand in self.tape.operations[i].slopes(i, self):
            for component, slope in self.slopes[operand].items():
                slopes[component] = slopes.get(component, ZERO) + weight * slope
        return {component: slope.abs_upper() for component, slope in slopes.items()}

    def defect(self) -> arb_mat:
        """A bound of |p' - h F(p)|: of what the polynomials of the rates leave out."""
        self.widen([ZERO] * self.tape.size)
        size = self.series.length.abs_upper()
        return arb_mat(self.tape.size, 1, [self.beside[i] * size for i in self.tape.rates])

    def rates_of_change(self, around: Sequence[arb]) -> arb_mat:
        """A bound of |dF/dz| for the states around the polynomial."""
        self.widen(around)
        matrix = arb_mat(self.tape.size, self.tape.size)
        for row, rate in enumerate(self.tape.rates):
            for component, slope in self.slopes[rate].items():
                matrix[row, component] = slope
        return matrix

    def terms(self) -> list[arb]:
        """The sizes of the rates at the beginning if none of their terms cancelled."""
        first = [row[0] for row in self.sizes]
        return [self.without_cancelling(rate, first) for rate in self.tape.rates]

    def without_cancelling(self, i: int, of_nodes: Sequence[arb]) -> arb:
        """The size of a node if no terms cancelled, by those of the nodes that it is made of."""
        if not isinstance(self.tape.operations[i], Bilinear):
            return of_nodes[i]
        sizes, total = self.factors(i), self.series.factors(i).constant.abs_upper()
        for size, a, b in sizes.products:
            total += size * of_nodes[a] * of_nodes[b]
        for size, e in sizes.sums:
            total += size * of_nodes[e]
        return total

    # What operations ask.

    def factors(self, i: int) -> Factors:
        """The sizes of the numbers of a bilinear operation."""
        return self._factor_sizes[i]

    @cached_property
    def _factor_sizes(self) -> dict[int, Factors]:
        sizes = {}
        for i, operation in enumerate(self.tape.operations):
            if isinstance(operation, Bilinear):
                constant, products, sums = self.series.factors(i)
                sizes[i] = Factors(
                    constant,
                    tuple((_size(factor), a, b) for factor, a, b in products),
                    tuple((_size(factor), e) for factor, e in sums),
                )
        return sizes

    def reach(self, i: int) -> arb:
        """A bound of |v| in the tube."""
        return self.length[i] + self.beside[i]

    def last(self, i: int) -> arb:
        """The size of order N, which the components of the state alone have."""
        row = self.sizes[i]
        return row[self.order] if len(row) > self.order else ZERO

    def tail(self, a: int, b: int) -> arb:
        """The products of two coefficients whose orders are N or more together."""
        return convolved(self.sizes[a], self._tail_of(b))

    def weighted_tail(self, a: int, v: int) -> arb:
        """A bound of the integral of what a' v has from order N - 1 on."""
        if a not in self._slope_tails:
            slopes = [size * j for j, size in enumerate(self.sizes[a])]
            self._slope_tails[a] = _tails(slopes, self.order)
        return convolved(self.sizes[v], self._slope_tails[a]) / self.order

    def _tail_of(self, i: int) -> list[arb]:
        if i not in self._tails:
            self._tails[i] = _tails(self.sizes[i], self.order)
        return self._tails[i]

    def least(self, i: int) -> arb:
        """A positive lower bound of |v| in the tube. Raises StepTooLong where there is none."""
        return self.require(self._distance(i) - self.beside[i])

    def least_of_polynomial(self, i: int) -> arb:
        """A positive lower bound of |v_p|. Raises StepTooLong where there is none."""
        return self.require(self._distance(i))

    def keeps_from_zero(self, i: int) -> bool:
        """True if |v| has a positive lower bound in the tube."""
        return bool(self._distance(i) - self.beside[i] > 0)

    def _distance(self, i: int) -> arb:
        return self.series.forward[i][0].abs_lower() - self.change[i]

    def require(self, bound: arb) -> arb:
        """The lower end of a bound. Raises StepTooLong unless it is positive."""
        lower: arb = bound.lower()
        if not lower > 0:
            raise StepTooLong
        return lower

    def least_of_norm(self, i: int) -> arb:
        """A lower bound of |v_p| over s^m, where the norm begins with order m."""
        begin = self.series.valuation[i]
        rest = sum(self.sizes[i][begin + 1 :], ZERO)
        return self.require(self.series.forward[i][begin].abs_lower() - rest)

    # Kinks.

    def below_zero(self, i: int) -> arb:
        """The distance by which the polynomial under a kink goes beyond zero, to the other side."""
        least = self._least_under.get(i, ZERO)
        return least.abs_upper() if least < 0 else ZERO

    def is_on_one_side(self, i: int, a: int) -> bool:
        """True if the operand of a kink keeps its sign in the tube."""
        if i in self.series.flat or i not in self.series.sign:
            return False
        return bool(self._least_under[i] > self.beside[a])

    @cached_property
    def _least_under(self) -> dict[int, arb]:
        """The least value of sign times operand for each kink that is not flat, at full precision."""
        least = {}
        for i, operation in enumerate(self.tape.operations):
            if i in self.series.sign and isinstance(operation, Absolute | Norm):
                with ctx.workprec(max(ctx.prec, self.series.bits)):
                    least[i] = minimum(self.series.forward[i])
        return least


def _size(factor: arb | None) -> arb:
    return ONE if factor is None else factor.abs_upper()


def _tails(sizes: Sequence[arb], order: int) -> list[arb]:
    """Entry j is the sum of the sizes from order N - j on."""
    tails, total = [], ZERO
    for size in (*[ZERO] * (order + 1 - len(sizes)), *reversed(sizes)):
        total += size
        tails.append(total)
    return tails


def minimum(coefficients: Sequence[arb]) -> arb:
    """A lower bound of a polynomial on [0, 1], exact at an end to which it is monotone."""
    slopes = [k * entry for k, entry in enumerate(coefficients)][1:]
    least = arb("inf")
    waiting = [(0, 0)]
    while waiting:
        level, i = waiting.pop()
        low, high = arb(i) / 2**level, arb(i + 1) / 2**level
        whole = low.union(high)
        around = value_at(coefficients, whole)
        if not around > 0:
            slope = value_at(slopes, whole)
            if slope > 0 or slope < 0:
                around = value_at(coefficients, low if slope > 0 else high)
            elif level < _HALVINGS:
                waiting += [(level + 1, 2 * i), (level + 1, 2 * i + 1)]
                continue
        least = min(least, around.lower())
    return least


def value_at(coefficients: Sequence[arb], s: arb) -> arb:
    """The value of a polynomial, by Horner's rule."""
    total = ZERO
    for entry in reversed(coefficients):
        total = total * s + entry
    return total
