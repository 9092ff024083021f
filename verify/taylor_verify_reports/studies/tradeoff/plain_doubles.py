"""Failures of the closed form in plain doubles: its errors on orbits from easy to degenerate ones.

The parameter 1 - m of each orbit is exact. The error is the largest of omega over all samples.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from fractions import Fraction
from math import inf
from typing import Final

from taylor_verify.exact.elements import elements
from taylor_verify.models.problem import pose
from taylor_verify.numbers.precision import rung
from taylor_verify.scenes.motion import Clock, Spin
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene
from taylor_verify.tradeoff.setting import ELLIPJ, setting
from taylor_verify.tradeoff.trade_off import trade_off
from taylor_verify_reports.studies.tradeoff.document import PlainDouble

# The solver with steps that is run on short scenes for comparison.
_BESIDE: Final = "taylor"

_EASY: Final = "euler/generic"
_LONG: Final = (3, 6, 9, 12, 15)
_NEAR: Final = (2, 4, 5, 6, 8)
_SAMPLES: Final = 11


@dataclass(frozen=True)
class Case:
    """A scene with its description; ``is_short`` is True if a solver with steps can follow it."""

    scene: Scene
    what: str
    is_short: bool = True


def cases() -> Iterator[Case]:
    """Yield an easy orbit, long times, starts near the middle axis, separatrices, a turn about the axis."""
    yield Case(load(_EASY), "far from every degeneracy")
    for digits in _LONG:
        end = Fraction(10) ** digits
        # No sample is a multiple of another one, so that none is exact by chance.
        times = tuple(end * k / (_SAMPLES - 1) + Fraction(k, 7) for k in range(_SAMPLES))
        scene = replace(load(_EASY), clock=Clock(Fraction(0), times))
        yield Case(scene, f"{_EASY} until t = 1e{digits}", digits <= 3)
    for digits in _NEAR:
        small = Fraction(1, 10**digits)
        racket = load("euler/tennis-racket")
        scene = replace(racket, initial=Spin((small, Fraction(1), small)))
        yield Case(scene, f"a body 1, 2, 3 from omega = (1e-{digits}, 1, 1e-{digits})")
    yield Case(load("euler/separatrix"), "the separatrix, its data dyadic")
    yield Case(load("euler/separatrix-full-tensor"), "the separatrix, its axes oblique")
    yield Case(load("euler/steady-middle-axis"), "a steady turn about the middle axis")


def plain_doubles() -> Iterator[PlainDouble]:
    """Yield a row for each case: 1 - m, error and outcome, and on short scenes the error of taylor.

    ``m_prime`` is None for an orbit without a modulus.
    """
    f64 = rung("f64")
    for case in cases():
        solvers = (ELLIPJ, _BESIDE) if case.is_short else (ELLIPJ,)
        trade = trade_off(case.scene, [setting(name, f64) for name in solvers], 0, patience=inf)
        point, *beside = (p.on(case.scene.name) for p in trade.points)
        m_prime = elements(pose(case.scene, f64).given).get("m_prime")
        yield PlainDouble(
            what=case.what,
            scene=case.scene.name,
            end=float(case.scene.clock.instants[-1]),
            m_prime=None if m_prime is None else float(m_prime.value),
            error=point.error,
            outcome=point.outcome,
            standing=point.standing,
            because=point.because,
            beside=_BESIDE,
            error_beside=beside[0].error if beside else None,
        )
