"""The Taylor coefficients of every node of a tape in one step, as balls of the true ones.

``forward[i][k]`` is the coefficient of order k of node i times h^k, so that the step is s from 0 to 1. A
component of the state has the orders 0 to N, every other node 0 to N - 1. ``backward`` has the same from
the last order to the first, so that a product of series is one sum of products of two lists.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from operator import mul

from flint import arb, ctx

from taylor_verify.exact.enclosure.coefficients import Rows, falling_bits
from taylor_verify.exact.enclosure.kinks import Norm, sign_of
from taylor_verify.exact.enclosure.operations import ZERO, Domain, Factors, Operation, State
from taylor_verify.exact.enclosure.tape import Tape
from taylor_verify.numbers.irrational import ball


def convolved(forward: Sequence[arb], backward: Sequence[arb]) -> arb:
    """The sum of the products of two lists, as long as the shorter one."""
    return sum(map(mul, forward, backward), ZERO)


class Nodes:
    """The base class: coefficients of the nodes of a tape from a time on, as operations ask for them."""

    def __init__(self, tape: Tape, begin: Fraction) -> None:
        self.tape, self.begin = tape, begin
        self.forward: list[list[arb]] = []
        self._factors = tape.factors()

    def factors(self, i: int) -> Factors:
        factors = self._factors[i]
        assert factors is not None
        return factors

    def positive(self, a: int, function: str) -> arb:
        """The value of a node at the point. Raises Domain unless it is positive."""
        value = self.forward[a][0]
        if not value > 0:
            raise Domain(f"the argument of {function} may not be positive")
        return value


class Series(Nodes):
    """The coefficients from an exact point at the time ``begin``, for a step of a length h.

    ``flat`` are kinks whose polynomial is 0 in this step; ``sign`` and ``valuation`` are what the others
    turn out to be, and ``single`` the one operand of a norm that is not zero throughout. With ``rows`` the
    series of the state are known, and the outputs of the tape are no rates.
    """

    def __init__(
        self,
        tape: Tape,
        point: Sequence[arb],
        begin: Fraction,
        step: Fraction,
        order: int,
        flat: frozenset[int] = frozenset(),
        rows: Rows | None = None,
    ) -> None:
        super().__init__(tape, begin)
        self.step, self.order = step, order
        self.length, self.flat, self.bits = ball(step), flat, ctx.prec
        self.sign: dict[int, int] = {}
        self.valuation: dict[int, int] = {}
        self.single: dict[int, int] = {}
        self.forward = [[] for _ in tape.operations]
        self.backward: list[list[arb]] = [[] for _ in tape.operations]
        self._slopes: dict[int, list[arb]] = {}
        with ctx.workprec(ctx.prec):
            known = [point] if rows is None else rows
            for row in known:
                for place, entry in zip(tape.states, row, strict=True):
                    self._append(place, entry)
            for k, bits in enumerate(falling_bits(order)):
                ctx.prec = bits
                self._add_order(k)
                if rows is None:
                    self._add_to_state(k)
        self._single_out()

    def _add_order(self, k: int) -> None:
        """The coefficients of order k of all nodes but the state."""
        for i, operation in enumerate(self.tape.operations):
            if isinstance(operation, State):
                continue
            degree = self.tape.degrees[i]
            if degree is not None and k > degree:
                self._append(i, ZERO)
            elif k == 0:
                self._append(i, self._first(i, operation))
            else:
                self._append(i, operation.following(i, self, k))

    def _first(self, i: int, operation: Operation) -> arb:
        try:
            return operation.first(i, self)
        except Domain as end:
            end.node = i
            raise

    def _add_to_state(self, k: int) -> None:
        """The coefficients of order k + 1 of the state."""
        step = self.length / (k + 1)
        for place, rate in zip(self.tape.states, self.tape.rates, strict=True):
            self._append(place, self.forward[rate][k] * step)

    def _append(self, i: int, coefficient: arb) -> None:
        self.forward[i].append(coefficient)
        self.backward[i].insert(0, coefficient)

    def _single_out(self) -> None:
        """A norm of which one operand alone is not zero is the absolute value of that one."""
        for i, operation in enumerate(self.tape.operations):
            if not isinstance(operation, Norm) or i in self.flat:
                continue
            moving = [a for a in operation.nodes if not self.is_nothing(a)]
            if len(moving) == 1:
                series = self.forward[moving[0]][: self.order]
                sign = sign_of(next(entry for entry in series if not entry.is_zero()))
                if sign:
                    self.single[i], self.sign[i] = moving[0], sign
                    self.forward[i] = [sign * entry for entry in series]

    def is_nothing(self, i: int) -> bool:
        """True if the polynomial of a node is zero."""
        return all(entry.is_zero() for entry in self.forward[i][: self.order])

    @property
    def rows(self) -> Rows:
        """Row k: the coefficients of order k of the state."""
        return [[self.forward[i][k] for i in self.tape.states] for k in range(self.order + 1)]

    def of_time(self) -> Rows:
        """Row k: the coefficients of order k of what depends on the time alone, and is no polynomial."""
        tape = self.tape
        places = [i for i, d in enumerate(tape.degrees) if d is None and not tape.moves[i]]
        return [[self.forward[i][k] for i in places] for k in range(self.order)] if places else []

    def rescale(self, step: Fraction) -> None:
        """Make the step another length, on the same side of every kink."""
        factor, power = ball(step / self.step), arb(1)
        powers = [power]
        with ctx.workprec(ctx.prec):
            for bits in falling_bits(self.order):
                ctx.prec = bits
                power = power * factor
                powers.append(power)
        self.forward = [list(map(mul, series, powers)) for series in self.forward]
        self.step, self.length = step, ball(step)

    # What operations ask.

    def product(self, a: int, b: int, k: int) -> arb:
        """The coefficient of order k of the product of two nodes, whose orders up to k are there."""
        if a == b:
            return self.square(a, 0, k)
        return convolved(self.forward[a], self._from(b, k))

    def square(self, a: int, begin: int, k: int) -> arb:
        """The coefficient of order begin + k of a^2, but for 2 a_begin a_k if that order is missing.

        No order of ``a`` below ``begin`` counts.
        """
        series, top = self.forward[a], k + begin
        half = (k - begin + 1) // 2
        first = begin if len(series) > k else begin + 1
        total = ZERO
        for j in range(first, begin + half):
            total += series[j] * series[top - j]
        total += total
        if (k - begin) % 2 == 0:
            middle = series[top // 2]
            total += middle * middle
        return total

    def rest(self, a: int, i: int, k: int) -> arb:
        """The sum of a_j v_(k - j) over j >= 1, for the node v = i whose order k is asked."""
        return convolved(self.forward[a][1 : k + 1], self._from(i, k - 1))

    def driven(self, a: int, d: int, k: int) -> arb:
        """The sum of j a_j d_(k - j) over 1 <= j <= k."""
        return convolved(self._slopes_of(a, k), self._from(d, k - 1))

    def weighted(self, i: int, d: int, k: int) -> arb:
        """The sum of j v_j d_(k - j) over 0 < j < k."""
        return convolved(self._slopes_of(i, k - 1), self._from(d, k - 1))

    def _slopes_of(self, i: int, last: int) -> list[arb]:
        """The multiples j v_j for 1 <= j <= last."""
        slopes = self._slopes.setdefault(i, [])
        for j in range(len(slopes) + 1, last + 1):
            slopes.append(j * self.forward[i][j])
        return slopes[:last]

    def _from(self, i: int, k: int) -> list[arb]:
        """The coefficients of a node from order k down to 0."""
        backward = self.backward[i]
        return backward[len(backward) - k - 1 :]
