"""The elements of a triaxial body under a moment. Legend as in board."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from mpmath import mp

from taylor_verify.exact.element import Element, Elements, settled
from taylor_verify.exact.euler.moments.washboard.board import Washboard, WashboardRegime
from taylor_verify.exact.euler.moments.washboard.chebyshev import Swing, course
from taylor_verify.exact.euler.moments.washboard.turnings import located, regime

_ALONG: Final = "Three different moments of inertia and a constant moment along a principal axis: "
_WORK: Final = "Not conserved: T changes by the work of the moment, H by its impulse."
_KEPT: Final = "Conserved: 2T J - |H|^2, with J the moment of inertia about the axis of the moment."
_STORY: Final[Mapping[WashboardRegime, tuple[str, ...]]] = {
    WashboardRegime.STEADY: (
        "The gyroscopic moment of a steady rotation balances the constant moment: omega is constant.",
    ),
    WashboardRegime.STRAIGHT: (
        f"{_ALONG}omega lies along it too, and grows evenly for ever.",
        _WORK,
    ),
    WashboardRegime.SWING: (
        f"{_ALONG}a bead on a tilted washboard that is caught between two walls. The spin about that "
        "axis changes its sign twice a period, and omega recurs.",
        _KEPT,
        _WORK,
    ),
    WashboardRegime.RUN: (
        f"{_ALONG}a bead on a tilted washboard that turns back once, in the past or in the future, "
        "and then runs down for ever: the spin about that axis grows.",
        _KEPT,
        _WORK,
    ),
}


def elements(board: Washboard, digits: int) -> Elements:
    """The period of a swing and what is conserved; ``digits`` significant digits of each.

    Raises NoClosedForm where the motion is too near to a separatrix to be told.
    """
    kind = regime(board)
    return Elements(kind.value, settled(lambda _: _numbers(board, kind), digits), _STORY[kind])


def _numbers(board: Washboard, kind: WashboardRegime) -> list[Element]:
    """At the ambient precision."""
    if kind not in (WashboardRegime.SWING, WashboardRegime.RUN):
        return []
    kept = Element(
        "2TJ-H2",
        mp.convert(board.kept),
        "angular momentum^2",
        "2T J - |H|^2, J the moment of inertia about the axis of M, conserved",
        "omega.I (J - I) omega",
        mp.convert(board.momentum_squared),
    )
    motion = course(board, located(board))
    if not isinstance(motion, Swing):
        return [kept]
    meaning = "omega recurs in body axes, under the moment"
    return [Element("period", motion.period, "time", meaning, "2 int dsigma/nu"), kept]
