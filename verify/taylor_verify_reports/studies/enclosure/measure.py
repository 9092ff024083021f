"""The width of an enclosure over time, beside the true error of its middle.

The truth is an enclosure with twice the bits. Its own width counts as error.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Final

from flint import arb, ctx

from taylor_verify.exact.enclosure.loaded import posed
from taylor_verify.exact.enclosure.tube import BOUND_BITS
from taylor_verify.exact.taylor import TaylorSolution
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene
from taylor_verify_reports.studies.enclosure.document import EnclosureStudy, WidthRow

# A regular motion of a general body, and an irregular one, whose errors grow like an exponential.
SCENES: Final = ("kirchhoff/general-body", "kirchhoff/swimmer-vehicle")
# The precision at which a user who asks for 30 digits gets the first attempt.
BITS: Final = 140
_END: Final = 100
_SAMPLES: Final = 200
_MOST_BITS: Final = 10_000


def study() -> EnclosureStudy:
    """Return the document of the published motions. Raises the errors of `widths`."""
    times = [Fraction(_END * (k + 1), _SAMPLES) for k in range(_SAMPLES)]
    rows = (row for name in SCENES for row in widths(load(name), times, BITS))
    return EnclosureStudy(BITS, tuple(rows))


def widths(scene: Scene, times: Sequence[Fraction], bits: int) -> list[WidthRow]:
    """Return a row for each time after the start, for the state without attitude and centre.

    ``width`` and ``error`` are relative to the length of a vector; they are the largest over the vectors of
    the state. Raises exact.enclosure.stopping.Coarse if ``bits`` are too few to reach the last time.
    """
    bare = replace(scene, track=frozenset())
    spans = posed(bare).spans
    coarse, sharp = _states(bare, times, bits), _states(bare, times, 2 * bits)
    rows = []
    with ctx.workprec(BOUND_BITS):
        for time, state, truth in zip(times, coarse, sharp, strict=True):
            radii = [arb(z.rad()) for z in state]
            errors = [(z.mid() - true) for z, true in zip(state, truth, strict=True)]
            width = max(_relative(radii, truth, span) for span in spans)
            error = max(_relative(errors, truth, span) for span in spans)
            rows.append(WidthRow(scene.name, float(time), width, error))
    return rows


def _states(scene: Scene, times: Sequence[Fraction], bits: int) -> list[list[arb]]:
    """Return the enclosure of the state at each time, with so many bits."""
    with ctx.workprec(bits):
        rows = dict(TaylorSolution(scene).rows(dict(enumerate(times)), bits, _MOST_BITS))
        return [rows[k].state for k in range(len(times))]


def _relative(deviations: Sequence[arb], truth: Sequence[arb], span: range) -> float:
    """Return the size of a vector of deviations over that of the true vector, in three digits."""
    deviation, size = (_size([entries[i] for i in span]) for entries in (deviations, truth))
    return float(f"{float(deviation / size):.2e}")


def _size(entries: Sequence[arb]) -> arb:
    """Return an upper bound of the length of a vector."""
    return sum((e * e for e in map(arb.abs_upper, entries)), arb(0)).sqrt().abs_upper()
