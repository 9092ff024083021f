"""Picture of growing errors over decades of time: a line for each ensemble, and Brouwer's powers.

The left panel has the drift of a conserved quantity, the right one the phase, over periods. Thin lines
are powers of time: solid for roundings, dashed for a bias. Their names stand in the note below the panels,
where they do not overlap.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from math import log10
from typing import TYPE_CHECKING, Any, Final

from taylor_verify.plotting.log_axes import number_axes, widened
from taylor_verify.plotting.palette import QUIET
from taylor_verify.plotting.picture import Picture
from taylor_verify.plotting.sheet import sheet
from taylor_verify.plotting.style import look_of_line
from taylor_verify.plotting.wording import plain, stem_of
from taylor_verify_reports.studies.growth.document import Ensemble

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Points = list[tuple[float, float]]

# The quantity of each panel, its heading, and the powers of roundings and of a bias.
PANELS: Final = (
    ("T", "energy, relative", (0.5, 1.0)),
    ("phase", "phase (rad)", (1.5, 2.0)),
)
_THIN: Final[dict[str, Any]] = {"color": QUIET, "linewidth": 0.6, "zorder": 1}
# In the order of the powers above.
_LOOKS: Final = (_THIN, {**_THIN, "dashes": (5, 3)})
# The place of a scene in titles: the lines belong to different scenes.
_TITLE: Final = "ensembles of starts"
# Powers of time are drawn for two lines only if their first points are so many decades apart.
_APART: Final = 1.0
_NOTE: Final = (
    "Root mean square over the starts. Thin: powers of time, 1/2 and 3/2 solid, 1 and 2 dashed."
)


def picture(runs: Sequence[Ensemble]) -> Picture:
    """Return the picture of all runs. Raises ValueError if no run has points to draw."""
    by_label = dict(zip(labels_of(runs), runs, strict=True))
    lines = {
        quantity: {label: _points(run, quantity) for label, run in by_label.items()}
        for quantity, _, _ in PANELS
    }
    if not any(points for by_run in lines.values() for points in by_run.values()):
        raise ValueError("expected a run with errors above zero, got none @ runs")
    sentences = []
    for label in by_label:
        ends = []
        for quantity, by_run in lines.items():
            if points := by_run[label]:
                (n0, e0), (n1, e1) = points[0], points[-1]
                ends.append(f"{quantity} {plain(e0)} at {n0:g} and {plain(e1)} at {n1:g} periods")
        sentences.append(f"{label}: {', '.join(ends) or 'nothing above zero'}")
    alt = (
        f"Errors against periods on {_TITLE}, both logarithmic, energy on the left and "
        f"phase on the right. {'; '.join(sentences)}."
    )
    title = f"Growth of errors: {_TITLE}"
    return Picture(stem_of({"scene": _TITLE}, "growth"), title, alt, partial(_figure, lines))


def _points(run: Ensemble, quantity: str) -> Points:
    """Return the points (periods, root mean square) that a logarithmic axis can show."""
    rms = next((row.rms for row in run.quantities if row.quantity == quantity), ())
    return [(n, e) for n, e in zip(run.counts, rms, strict=False) if e is not None and e > 0]


def _figure(lines: Mapping[str, Mapping[str, Points]]) -> Figure:
    labels = list(next(iter(lines.values())))
    styles = {label: look_of_line(i) for i, label in enumerate(labels)}
    entries = [(styles[label].line, label) for label in labels]
    figure, places = sheet(len(PANELS), entries, _NOTE)
    for axes, (quantity, heading, powers) in zip(places, PANELS, strict=True):
        drawn = {label: points for label, points in lines[quantity].items() if points}
        axes.set(xscale="log", yscale="log", xlabel="periods", ylabel=heading)
        axes.set_title("conserved quantity" if quantity != "phase" else "phase", pad=4)
        everything = [point for points in drawn.values() for point in points]
        if not everything:
            continue
        axes.set(xlim=widened([n for n, _ in everything], 0.05, 0.12))
        axes.set(ylim=widened([e for _, e in everything], 0.07, 0.1))
        number_axes(axes)
        for points in _apart(list(drawn.values())):
            for power, look in zip(powers, _LOOKS, strict=True):
                _draw_power(axes, points, power, look)
        for label, points in drawn.items():
            axes.plot(*zip(*points, strict=True), gid=label, zorder=3, **styles[label].line)
    return figure


def _apart(lines: Sequence[Points]) -> list[Points]:
    """Return the lines whose first points are far from each other; of near ones only the first."""
    separate: list[Points] = []
    for points in lines:
        if all(abs(log10(points[0][1] / other[0][1])) > _APART for other in separate):
            separate.append(points)
    return separate


def _draw_power(axes: Axes, points: Points, power: float, look: Mapping[str, Any]) -> None:
    """Draw a power of time from the first point of a line to the border of the panel."""
    (n0, e0), top, right = points[0], axes.get_ylim()[1], axes.get_xlim()[1]
    end = min(right, n0 * (top / e0) ** (1 / power))
    level = e0 * (end / n0) ** power
    axes.plot([n0, end], [e0, level], gid=f"power {power:g}", scalex=False, scaley=False, **look)


def labels_of(runs: Sequence[Ensemble]) -> list[str]:
    """Return the names of the lines: scene, rung, and the setting of the solver if it has one.

    A scene is named by the last part of its name if that is unique. Of two ensembles with one name the
    longer one has its number of periods too.
    """
    tails = {run.scene: run.scene.rpartition("/")[2] for run in runs}
    names: list[str] = []
    for run in runs:
        is_alone = list(tails.values()).count(tails[run.scene]) == 1
        scene = tails[run.scene] if is_alone else run.scene
        setting = run.solver.removeprefix("taylor").lstrip("?")
        label = " ".join([scene, run.rung, setting]).strip()
        names.append(f"{label}, to {run.periods:.0e}" if label in names else label)
    return names
