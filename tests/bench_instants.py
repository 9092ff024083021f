"""The exact motion at many instants at once, beside each of them alone: a part of `make bench`.

Both by the closed form in balls, after the set-up: at once by polynomials where there is a short series of
theta functions, alone by theta functions of one argument. What follows are the radii, and the numbers of
mpmath made of the balls.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from functools import partial
from math import ceil, log2
from typing import Final

from flint import ctx

from taylor_verify.exact.balls import Enclosed
from taylor_verify.exact.route import solution
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene

INSTANTS: Final = 1_000
DIGITS: Final = (16, 40)
SCENES: Final = (
    *("euler/generic", "euler/with-attitude", "euler/full-tensor", "euler/gyrostat"),
    *("kirchhoff/four-real-roots", "kirchhoff/whole-motion"),
)
# As many as exact.balls adds to the digits at first.
GUARD_BITS: Final = 40


def actions(scene: Scene, digits: int) -> list[Callable[[], object]]:
    """Return the balls of each instant alone and of all at once, the motion, and its numbers."""
    exact = solution(scene)
    assert isinstance(exact, Enclosed)
    end, bits = scene.clock.elapsed[-1], ceil(digits * log2(10)) + GUARD_BITS
    times = [end * Fraction(k + 1, INSTANTS) for k in range(INSTANTS)]

    def enclosed(groups: Sequence[Sequence[Fraction]]) -> None:
        with ctx.workprec(bits):
            for group in groups:
                exact.enclose(group, bits)

    def numbers() -> object:
        return dict(exact.motion(times, digits).quantities)

    exact.motion(times, digits)
    return [
        partial(enclosed, [[t] for t in times]),
        partial(enclosed, [times]),
        partial(exact.motion, times, digits),
        numbers,
    ]


def at_once(
    interleaved: Callable[[Sequence[Callable[[], object]], int], list[float]],
    line: Callable[..., str],
) -> None:
    """Print the table: microseconds of processor time an instant, and what is gained."""
    print(f"\nMicroseconds an instant in balls, {INSTANTS:,} instants, after the set-up.")
    print(line("", "digits", "alone", "at once", "ratio", "radii too", "in mpmath"))
    for name in SCENES:
        for digits in DIGITS:
            spent = interleaved(actions(load(name), digits), 3)
            alone, once, motion, numbers = (1e6 * seconds / INSTANTS for seconds in spent)
            cells = (f"{alone:.1f}", f"{once:.1f}", f"{alone / once:.1f}")
            print(line(name, str(digits), *cells, f"{motion:.1f}", f"{numbers:.1f}"))
