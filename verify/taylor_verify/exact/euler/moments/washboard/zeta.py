"""The run over any number of teeth of the washboard in mpmath, by Hurwitz' zeta function.

Legend as in board, kappa < 0. Teeth have the width pi/Omega, and from each to the next F grows by
d = slope pi/Omega. With a = F/d on the first tooth, n teeth take the time

    T(n) = d^(-1/2) int sum_(k < n) (a + k)^(-1/2) dsigma = Z(0) - Z(n),
    Z(n) = d^(-1/2) int zeta(1/2, a + n) dsigma over the first tooth.

T grows with n and bends down, so that Newton's iteration in a real n never passes the root after its first
step. A time lies in the tooth of the whole part of n, and there a series gives the place.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property, partial
from typing import Final, final

from mpmath import mp, mpf

from taylor_verify.exact.euler.moments.washboard.panels import Panels
from taylor_verify.exact.euler.moments.washboard.turnings import MOST_TEETH, TOO_MANY_TEETH
from taylor_verify.exact.solution import Unsettled

_MOST_STEPS: Final = 60
_NEAR: Final = 0.25
_COUNTING_DIGITS: Final = 15


@final
class ZetaTeeth:
    """The motion after the place ``start``, at the precision of mpmath at which this was made.

    ``squared(start, x)`` is F at start + x, ``width`` that of a tooth.
    """

    def __init__(
        self, squared: Callable[[mpf, mpf], mpf], start: mpf, width: mpf, slope: mpf
    ) -> None:
        self._squared, self.start = partial(squared, start), start
        self._width, self._rise, self._bits = width, slope * width, mp.prec
        self._panels: dict[int, Panels] = {}

    def time(self, sigma: mpf) -> mpf:
        """The time from the start to a place after it."""
        n = int(mp.floor((sigma - self.start) / self._width))
        return self._crossed(n) + self._tooth(n).at(sigma - self.start - n * self._width)

    def place(self, t: mpf) -> tuple[mpf, mpf]:
        """sigma and nu at a time t >= 0 after the start."""
        n = self._count(t)
        rest = t - self._crossed(n)
        if rest < 0 and n:
            n -= 1
            rest = t - self._crossed(n)
        x = self._tooth(n).inverse(rest)
        nu = mp.sqrt(self._squared(x) + n * self._rise)
        return self.start + n * self._width + x, nu

    def _count(self, t: mpf) -> int:
        """The whole teeth that are crossed in the time t, or one more."""
        # The time of n teeth of which each is level: 2 ((a + n)^(1/2) - a^(1/2)).
        level, scaled = self._squared(mpf(0)) / self._rise, t * mp.sqrt(self._rise) / self._width
        n = scaled * mp.sqrt(level) + scaled**2 / 4
        if n > MOST_TEETH:
            raise Unsettled(TOO_MANY_TEETH)
        with mp.workdps(min(mp.dps, int(mp.log10(1 + n)) + _COUNTING_DIGITS)):
            for _ in range(_MOST_STEPS):
                step = (t - self._crossed(n)) / self._slowness(n)
                n = max(n + step, mpf(0))
                if abs(step) <= _NEAR:
                    return int(mp.floor(n))
        raise Unsettled("the teeth of the washboard up to the time asked for are not counted")

    def _crossed(self, n: mpf | int) -> mpf:
        """T."""
        return self._over(lambda a: -mp.zeta(mpf(1) / 2, a), n) - self._first if n else mpf(0)

    @cached_property
    def _first(self) -> mpf:
        """-Z(0)."""
        with mp.workprec(self._bits):
            return self._over(lambda a: -mp.zeta(mpf(1) / 2, a), 0)

    def _slowness(self, n: mpf) -> mpf:
        """T'."""
        return self._over(lambda a: mp.zeta(mpf(3) / 2, a) / 2, n)

    def _over(self, f: Callable[[mpf], mpf], n: mpf | int) -> mpf:
        """d^(-1/2) int f(a + n) dsigma over the first tooth; f is positive where a > 1."""
        a = Panels(lambda x: f(self._squared(x) / self._rise + n), self._width / 2, self._width)
        return a.at(self._width) / mp.sqrt(self._rise)

    def _tooth(self, n: int) -> Panels:
        """The time on tooth number n after its beginning, as far beyond its end as it is asked for."""
        if n not in self._panels:
            risen = n * self._rise
            self._panels[n] = Panels(
                lambda x: 1 / mp.sqrt(self._squared(x) + risen), self._width / 2
            )
        return self._panels[n]
