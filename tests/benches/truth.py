"""The exact motion: the second route, enclosures."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction
from functools import partial
from typing import Final

from builders.scenes import tracking_all

from benches.ratio import Action, Ratio, Side
from taylor_verify.exact.route import solution
from taylor_verify.exact.taylor import TaylorSolution
from taylor_verify.models.problem import pose
from taylor_verify.numbers.precision import rung
from taylor_verify.scenes.reading.reader import load
from taylor_verify.solvers.taylor.driver import Taylor

_WHOLE: Final = ("euler/with-attitude", "kirchhoff/whole-motion")
_ROUTES_INSTANTS, _ROUTES_DIGITS = 10, 50
_ENCLOSED: Final = ("euler/constant-moment", "kirchhoff/auv-turn", "kirchhoff/general-body")
_ENCLOSED_DIGITS: Final = 30
_WIDER_RUNG: Final = "mp237"


def _mpmath_over_balls(name: str) -> tuple[Side, Side]:
    scene = tracking_all(load(name))
    times = [10 * k + Fraction(1, 7) for k in range(_ROUTES_INSTANTS)]
    sides = []
    for route in ("mpmath", "arb"):
        exact = solution(scene, route)
        sides.append(Action(partial(_motion, exact, times), units=len(times)))
    return sides[0], sides[1]


def _motion(exact: object, times: Sequence[Fraction], _: None) -> object:
    return exact.motion(times, _ROUTES_DIGITS)  # type: ignore[attr-defined]


def _enclosure_over_driver(name: str) -> tuple[Side, Side]:
    scene = tracking_all(load(name))
    times, problem = scene.clock.elapsed, pose(scene, rung(_WIDER_RUNG))
    return (
        Action(lambda _: TaylorSolution(scene).motion(times, _ENCLOSED_DIGITS)),
        Action(lambda _: Taylor().solve(problem)),
    )


def ratios() -> Iterator[Ratio]:
    """Yield what exact motions cost beside each other."""
    for name in _WHOLE:
        yield Ratio(
            f"mpmath/{name}",
            "the second route, whose two precisions agree, over the proven one; both after the set-up",
            partial(_mpmath_over_balls, name),
            unit="instant",
        )
    for name in _ENCLOSED:
        yield Ratio(
            f"enclosed/{name}",
            f"the Taylor enclosure to {_ENCLOSED_DIGITS} digits over a solve on {_WIDER_RUNG}",
            partial(_enclosure_over_driver, name),
            unit="motion",
        )
