"""Pictures of error against time and step: each engine's best setting beside the plain solvers."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import count, groupby
from math import inf
from typing import TYPE_CHECKING, Final

from taylor_verify.plotting.log_axes import number_axes, widened
from taylor_verify.plotting.picture import Picture
from taylor_verify.plotting.sheet import Entry, sheet
from taylor_verify.plotting.style import DASHED, INK, QUIET, Look, look_of_line
from taylor_verify.plotting.wording import plain
from taylor_verify_reports.studies.engines.document import Board, EngineRow
from taylor_verify_reports.studies.engines.entry import EntryList
from taylor_verify_reports.studies.engines.ranking import EngineSetting, newest, settings

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_HEIGHT: Final = 3.9
_ERROR: Final = "largest error of omega and attitude"
_DOUBLE, _SINGLE = "float64", "float32"
# There are as many colours as engines with a name in the legend: these and the worst, in two panels.
_BEST: Final = 2
_OTHERS: Final = Look(QUIET, "o", width=0.6, size=2.0)
_PLAIN_MARKERS: Final = ("o", "s", "^", "D", "v")


@dataclass(frozen=True)
class Line:
    """An engine in a picture: the points (work, error) that are above zero, from coarse to fine."""

    name: str
    points: tuple[tuple[float, float], ...]
    look: Look = _OTHERS


@dataclass(frozen=True)
class Panel:
    """The engines of one precision; both panels have the plain solvers."""

    heading: str
    lines: tuple[Line, ...]


def pictures(board: Board, entries: EntryList) -> list[Picture]:
    """Return the pictures of error against time and against step for the engines of the ``board``.

    ``entries`` is the list of engines. A picture without any point is left out.
    """
    scene = entries.advised[0]
    time = panels(board, entries, scene, work=board.pace, unit=1e6)
    step = panels(board, entries, scene, work=_step, unit=1.0)
    drawn = []
    if time:
        axis = "time for a second of the motion (µs)"
        drawn.append(_picture(scene, "time", axis, time))
    if step:
        drawn.append(_picture(scene, "step", "step (s)", step))
    return drawn


def panels(
    board: Board,
    entries: EntryList,
    scene: str,
    work: Callable[[EngineRow], float | None],
    unit: float,
) -> list[Panel]:
    """Return a panel for each precision, with a line for each engine whose best setting has it.

    ``work`` returns the work of a row, which is multiplied by ``unit``. A panel of plain solvers alone is
    left out.
    """
    titles = entries.titles
    plain_solvers = {row.name for row in entries.entry if row.plain}
    lines: dict[str, list[Line]] = {_DOUBLE: [], _SINGLE: []}
    for engine, group in groupby(newest(settings(board.study)), key=lambda each: each.engine):
        best = _best([*group], scene)
        if best is None:
            continue
        costs = [(work(row), row.worst) for row in best.on(scene)]
        points = tuple((unit * x, y) for x, y in costs if x and 0 < y < inf)
        line = Line(titles.get(engine, engine), points)
        if points and engine in plain_solvers:
            lines[_DOUBLE].append(line)
            lines[_SINGLE].append(line)
        elif points:
            lines[_SINGLE if best.rung == "f32" else _DOUBLE].append(line)
    plain_titles = {titles.get(name, name) for name in plain_solvers}
    if all(line.name in plain_titles for line in lines[_SINGLE]):
        lines[_SINGLE] = []
    numbers = count()
    return [
        Panel(heading, tuple(_with_looks(own, plain_titles, numbers)))
        for heading, own in lines.items()
        if own
    ]


def _with_looks(
    lines: Sequence[Line], plain_titles: Collection[str], numbers: Iterator[int]
) -> Iterator[Line]:
    """Yield the lines: plain solvers dashed, the best engines and the worst in colour, others grey."""
    engines = sorted((line for line in lines if line.name not in plain_titles), key=_least)
    styles = {line.name: look_of_line(next(numbers)) for line in (*engines[:_BEST], *engines[-1:])}
    markers = iter(_PLAIN_MARKERS)
    for line in lines:
        if line.name in plain_titles:
            yield replace(line, look=Look(INK, next(markers), DASHED))
        else:
            yield replace(line, look=styles.get(line.name, _OTHERS))


def _least(line: Line) -> float:
    """Return the smallest error of a line."""
    return min(y for _, y in line.points)


def _best(group: Sequence[EngineSetting], scene: str) -> EngineSetting | None:
    """Return the setting of an engine with the smallest error on the scene; None without judged rows."""
    errors = [(row.worst, setting) for setting in group if (row := setting.best(scene)) is not None]
    return min(errors, key=lambda pair: pair[0])[1] if errors else None


def _step(row: EngineRow) -> float | None:
    return float(row.value) if row.value and row.knob == "step" else None


def _picture(scene: str, what: str, axis: str, drawn: Sequence[Panel]) -> Picture:
    every = [(line.name, x, y) for panel in drawn for line in panel.lines for x, y in line.points]
    name, x, y = min(every, key=lambda point: point[2])
    names = ", ".join(dict.fromkeys(line.name for panel in drawn for line in panel.lines))
    alt = (
        f"Largest error of omega and attitude against {axis} on {scene}, both logarithmic, for the best "
        f"setting of {names}. The smallest error is {plain(y)}, of {name} at {plain(x)}."
    )
    stem = f"engines-{what}"
    return Picture(
        stem, f"Error against {what}: {scene}", alt, partial(_figure, axis, tuple(drawn))
    )


def _short(names: Collection[str]) -> list[str]:
    """Return names without what carries an engine, behind the comma, unless two would be one."""
    shorter = [name.partition(",")[0] for name in names]
    counts = Counter(shorter)
    return [b if counts[b] == 1 else a for a, b in zip(names, shorter, strict=True)]


def _figure(axis: str, drawn: Sequence[Panel]) -> Figure:
    styles = {line.name: line.look for panel in drawn for line in panel.lines}
    named = {name: look.line for name, look in styles.items() if look != _OTHERS}
    entries: list[Entry] = [*zip(named.values(), _short(named), strict=True)]
    if len(named) < len(styles):
        entries.append((_OTHERS.line, f"{len(styles) - len(named)} others, in the table"))
    note = "Best settings; in colour the best two and the worst; dashed: plain solvers, in float64."
    figure, places = sheet(len(drawn), entries, note, _HEIGHT)
    spots = [point for panel in drawn for line in panel.lines for point in line.points]
    limits = {
        "xlim": widened([x for x, _ in spots], 0.08, 0.12),
        "ylim": widened([y for _, y in spots], 0.06, 0.06),
    }
    for axes, panel in zip(places, drawn, strict=True):
        axes.set_title(panel.heading, pad=4)
        axes.set(xscale="log", yscale="log", xlabel=axis, ylabel=_ERROR, **limits)
        number_axes(axes)
        for line in panel.lines:
            axes.plot(*zip(*line.points, strict=True), gid=line.name, zorder=3, **line.look.line)
    return figure
