"""The study of the width of an enclosure beside its true error, on two motions without a closed form."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Final

from taylor_verify.plotting.log_axes import widened
from taylor_verify.plotting.picture import Picture
from taylor_verify.plotting.sheet import Entry, sheet
from taylor_verify.plotting.wording import plain, power_of_ten
from taylor_verify_reports.studies.enclosure.document import EnclosureStudy
from taylor_verify_reports.studies.stored import Stored
from taylor_verify_reports.studies.study import Measured, Progress, Study

if TYPE_CHECKING:
    from matplotlib.figure import Figure


Points = list[tuple[float, float]]
Motions = Mapping[str, Mapping[str, Points]]

STEM: Final = "enclosure-width"
# The end of the axis over the last time: room for half of the last number.
_BEYOND: Final = 1.04
_LINES: Final[Mapping[str, Entry]] = {
    "width": ({"color": "#A83C00", "linewidth": 1.6}, "proven width"),
    "error": ({"color": "#0072B2", "linewidth": 0.9, "linestyle": (0, (5, 1.6))}, "true error"),
}


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


ENCLOSURE: Final = Stored(EnclosureStudy, "enclosure")


def _measure(folder: Path, progress: Progress) -> Measured:
    from taylor_verify_reports.studies.enclosure.measure import study

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
