"""The exact motion: many instants at once, the second route, enclosures."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction
from functools import partial
from math import ceil, log2
from typing import Final

from builders.two_runs import two_runs
from flint import ctx

from benches.ratio import Action, Ratio, Side, Target
from benches.scenes import tracking_all
from taylor_verify.exact.balls import Enclosed
from taylor_verify.exact.route import solution
from taylor_verify.exact.taylor import TaylorSolution
from taylor_verify.scenes.reading.reader import load

_AT_ONCE: Final = (
    *("euler/generic", "euler/with-attitude"),
    *("kirchhoff/four-real-roots", "kirchhoff/whole-motion"),
)
_DIGITS: Final = (16, 24, 40)
_INSTANTS, _ALONE = 1000, 25
# As many as exact.balls adds to the digits at first.
_GUARD_BITS: Final = 40
_WHOLE: Final = ("euler/with-attitude", "kirchhoff/whole-motion")
_ROUTES_INSTANTS, _ROUTES_DIGITS = 10, 50
_ENCLOSED: Final = ("euler/constant-moment", "kirchhoff/auv-turn", "kirchhoff/general-body")
_ENCLOSED_DIGITS: Final = 30

_FIVE: Final = Target(0.2, "sines and polynomials that all instants share: a fifth was asked for")
_PAIR: Final = Target(1.0, "a proof is to cost no more than two runs that prove nothing")


def _at_once_over_alone(name: str, digits: int) -> tuple[Side, Side]:
    scene = load(name)
    exact, end = solution(scene), scene.clock.elapsed[-1]
    assert isinstance(exact, Enclosed)
    bits = ceil(digits * log2(10)) + _GUARD_BITS
    times = [end * Fraction(k + 1, _INSTANTS) for k in range(_INSTANTS)]
    some = times[:: _INSTANTS // _ALONE]
    exact.motion(times, digits)

    def enclosed(groups: Sequence[Sequence[Fraction]]) -> None:
        with ctx.workprec(bits):
            for group in groups:
                exact.enclose(group, bits)

    return (
        Action(enclosed, lambda: [times], units=len(times)),
        Action(enclosed, lambda: [[t] for t in some], units=len(some)),
    )


def _mpmath_over_balls(name: str) -> tuple[Side, Side]:
    scene = tracking_all(name)
    times = [10 * k + Fraction(1, 7) for k in range(_ROUTES_INSTANTS)]
    sides = []
    for route in ("mpmath", "arb"):
        exact = solution(scene, route)
        sides.append(Action(partial(_motion, exact, times), units=len(times)))
    return sides[0], sides[1]


def _motion(exact: object, times: Sequence[Fraction], _: None) -> object:
    return exact.motion(times, _ROUTES_DIGITS)  # type: ignore[attr-defined]


def _enclosure_over_two_runs(name: str) -> tuple[Side, Side]:
    scene = tracking_all(name)
    times = scene.clock.elapsed
    return (
        Action(lambda _: TaylorSolution(scene).motion(times, _ENCLOSED_DIGITS)),
        Action(lambda _: two_runs(scene, times, _ENCLOSED_DIGITS)),
    )


def ratios() -> Iterator[Ratio]:
    """Yield what exact motions cost beside each other."""
    for name in _AT_ONCE:
        for digits in _DIGITS:
            yield Ratio(
                f"at-once/{name}/{digits}",
                f"an instant among {_INSTANTS:,} to {digits} digits, over one alone, after the set-up",
                partial(_at_once_over_alone, name, digits),
                _FIVE,
                unit="instant",
            )
    for name in _WHOLE:
        yield Ratio(
            f"mpmath/{name}",
            "the second route, whose two precisions agree, over the proven one; both after the set-up",
            partial(_mpmath_over_balls, name),
            unit="instant",
        )
    for name in _ENCLOSED:
        yield Ratio(
            f"enclosure/{name}",
            f"the Taylor enclosure over two runs without a proof, to {_ENCLOSED_DIGITS} digits",
            partial(_enclosure_over_two_runs, name),
            _PAIR,
            unit="motion",
        )
