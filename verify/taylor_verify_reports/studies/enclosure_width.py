"""The study of the width of an enclosure beside its true error, on two motions without a closed form.

The truth is an enclosure with twice the bits. Its own width counts as error.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Final

from taylor_verify.plotting.log_axes import widened
from taylor_verify.plotting.picture import Picture
from taylor_verify.plotting.sheet import Entry, sheet
from taylor_verify.plotting.wording import plain, power_of_ten
from taylor_verify_reports.studies.stored import Stored
from taylor_verify_reports.studies.study import Measured, Progress, Study

if TYPE_CHECKING:
    from flint import arb
    from matplotlib.figure import Figure

    from taylor_verify.scenes.scene import Scene


Points = list[tuple[float, float]]
Motions = Mapping[str, Mapping[str, Points]]

STEM: Final = "enclosure-width"
# The end of the axis over the last time: room for half of the last number.
_BEYOND: Final = 1.04
_LINES: Final[Mapping[str, Entry]] = {
    "width": ({"color": "#A83C00", "linewidth": 1.6}, "proven width"),
    "error": ({"color": "#0072B2", "linewidth": 0.9, "linestyle": (0, (5, 1.6))}, "true error"),
}
# A regular motion of a general body, and an irregular one, whose errors grow like an exponential.
SCENES: Final = ("kirchhoff/general-body", "kirchhoff/swimmer-vehicle")
# The precision at which a user who asks for 30 digits gets the first attempt.
BITS: Final = 140
_END: Final = 100
_SAMPLES: Final = 200
_MOST_BITS: Final = 10_000


@dataclass(frozen=True)
class WidthRow:
    """The enclosure at the time ``t`` of a motion: its width and error, relative to the state vector."""

    scene: str
    t: float
    width: float
    error: float


@dataclass(frozen=True)
class EnclosureStudy:
    """The rows of all motions; ``bits`` is the precision of the enclosures."""

    bits: int
    rows: tuple[WidthRow, ...]


ENCLOSURE: Final = Stored(EnclosureStudy, "enclosure")


# The measurement.


def study() -> EnclosureStudy:
    """Return the document of the published motions. Raises the errors of `widths`."""
    from taylor_verify.scenes.reading.reader import load

    times = [Fraction(_END * (k + 1), _SAMPLES) for k in range(_SAMPLES)]
    rows = (row for name in SCENES for row in widths(load(name), times, BITS))
    return EnclosureStudy(BITS, tuple(rows))


def widths(scene: Scene, times: Sequence[Fraction], bits: int) -> list[WidthRow]:
    """Return a row for each time after the start, for the state without attitude and centre.

    ``width`` and ``error`` are relative to the length of a vector; they are the largest over the vectors of
    the state. Raises exact.enclosure.stopping.Coarse if ``bits`` are too few to reach the last time.
    """
    from flint import arb, ctx

    from taylor_verify.exact.enclosure.loaded import posed
    from taylor_verify.exact.enclosure.tube import BOUND_BITS

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
    from flint import ctx

    from taylor_verify.exact.taylor import TaylorSolution

    with ctx.workprec(bits):
        rows = dict(TaylorSolution(scene).rows(dict(enumerate(times)), bits, _MOST_BITS))
        return [rows[k].state for k in range(len(times))]


def _relative(deviations: Sequence[arb], truth: Sequence[arb], span: range) -> float:
    """Return the size of a vector of deviations over that of the true vector, in three digits."""
    deviation, size = (_size([entries[i] for i in span]) for entries in (deviations, truth))
    return float(f"{float(deviation / size):.2e}")


def _size(entries: Sequence[arb]) -> arb:
    """Return an upper bound of the length of a vector."""
    squares = [e.abs_upper() ** 2 for e in entries]
    return sum(squares[1:], squares[0]).sqrt().abs_upper()


# The picture.


def series(study: EnclosureStudy) -> dict[str, dict[str, Points]]:
    """Return the points of ``width`` and of ``error`` for each scene; a zero is left out."""
    scenes: dict[str, dict[str, Points]] = {}
    for row in study.rows:
        for name, points in scenes.setdefault(row.scene, {name: [] for name in _LINES}).items():
            if (value := getattr(row, name)) > 0:
                points.append((row.t, value))
    return scenes


def picture(study: EnclosureStudy) -> Picture:
    """Return the picture of a study. Raises ValueError for one without rows."""
    motions = series(study)
    if not all(lines["width"] and lines["error"] for lines in motions.values()) or not motions:
        raise ValueError("expected widths and errors above zero, got none @ enclosure")
    ends = "; ".join(
        f"{scene}: width {plain(lines['width'][-1][1])}, error {plain(lines['error'][-1][1])} at "
        f"t = {lines['width'][-1][0]:g}"
        for scene, lines in motions.items()
    )
    alt = (
        f"Proven width of the enclosure with {study.bits} bits and true error of its middle against "
        f"time, errors logarithmic. The error is always below the width. {ends}."
    )
    return Picture(STEM, "Width and true error of an enclosure", alt, partial(_figure, motions))


def _figure(motions: Motions) -> Figure:
    figure, places = sheet(len(motions), list(_LINES.values()))
    # All panels have one scale, which shows the difference between regular and irregular motions.
    points = [point for lines in motions.values() for drawn in lines.values() for point in drawn]
    limits = widened([e for _, e in points], 0.04, 0.04)
    for axes, (scene, lines) in zip(places, motions.items(), strict=True):
        axes.set(yscale="log", ylim=limits, xlim=(0, _BEYOND * max(t for t, _ in points)))
        axes.set(xlabel="time since the start", ylabel="relative to the vector")
        axes.yaxis.set_major_formatter(lambda value, _: power_of_ten(value))
        axes.grid(visible=True, which="major")
        axes.set_title(scene, pad=4)
        for name in ("error", "width"):
            axes.plot(*zip(*lines[name], strict=True), gid=name, **_LINES[name][0])
    return figure


def _measure(folder: Path, progress: Progress) -> Measured:
    with progress.working("enclosure of two motions"):
        return Measured(ENCLOSURE.write(folder, study()))


STUDY: Final = Study(
    name="enclosure",
    title="the proven width of an enclosure beside its true error, as a picture",
    duration="a minute",
    measure=_measure,
    find=ENCLOSURE.find,
    draw=lambda study: [picture(study)],
    needs_heyoka=False,
)
