"""Picture of the error against the version, a line for each setting of an engine."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from itertools import pairwise
from math import inf
from typing import TYPE_CHECKING, Final

from taylor_verify.plotting.log_axes import number_axes, widened
from taylor_verify.plotting.picture import Picture
from taylor_verify.plotting.sheet import name_lines, sheet
from taylor_verify.plotting.style import look_of_line
from taylor_verify.plotting.wording import plain
from taylor_verify_reports.studies.engines.document import Board, EngineRow
from taylor_verify_reports.studies.engines.entry import EntryList

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_HEIGHT: Final = 3.0
# The least number of versions for a line.
_FEWEST: Final = 3


@dataclass(frozen=True)
class Sweep:
    """The versions of an engine, oldest first, and the error of each setting at each of them.

    ``step`` is the step of all lines; ``lines`` has the errors of each setting by its name, None for a
    version that was not judged.
    """

    title: str
    scene: str
    step: str
    versions: tuple[str, ...]
    lines: dict[str, tuple[float | None, ...]]


def sweeps(board: Board, entries: EntryList) -> list[Sweep]:
    """Return the sweep of every engine with several versions."""
    titles = entries.titles
    results = []
    for engine, title in titles.items():
        rows = [r for r in board.study.rows if r.engine == engine and not r.shipped and r.is_judged]
        versions = sorted({row.version for row in rows}, key=_parts)
        if len(versions) >= _FEWEST and (shared := _shared(rows, versions)):
            results.append(_sweep(title, rows, versions, shared))
    return results


def _shared(rows: Sequence[EngineRow], versions: Sequence[str]) -> tuple[str, str] | None:
    """Return the scene and the step on which most versions were run; None if there are too few.

    Of several scenes it is the last one, and of several steps the middle one.
    """
    counts: dict[tuple[str, str], set[str]] = {}
    for row in rows:
        counts.setdefault((row.scene, row.value), set()).add(row.version)
    most = max(map(len, counts.values()))
    full = [key for key, own in counts.items() if len(own) == most and most >= _FEWEST]
    scene = full[-1][0] if full else ""
    steps = [value for name, value in full if name == scene]
    return (scene, steps[len(steps) // 2]) if steps else None


def _sweep(
    title: str, rows: Sequence[EngineRow], versions: Sequence[str], shared: tuple[str, str]
) -> Sweep:
    scene, step = shared
    lines: dict[str, dict[str, float]] = {}
    for row in rows:
        if (row.scene, row.value) == shared and 0 < row.worst < inf:
            lines.setdefault(row.variant or "default", {})[row.version] = row.worst
    errors = {name: tuple(own.get(v) for v in versions) for name, own in lines.items()}
    return Sweep(title, scene, step, tuple(versions), errors)


def pictures(board: Board, entries: EntryList) -> list[Picture]:
    """Return the picture of all sweeps; an empty list if no engine has several versions."""
    drawn = [sweep for sweep in sweeps(board, entries) if sweep.lines]
    if not drawn:
        return []
    alt = " ".join(_sentence(sweep) for sweep in drawn)
    return [Picture("engines-versions", "Error against version", alt, partial(_figure, drawn))]


def _sentence(sweep: Sweep) -> str:
    """Return the largest change of each engine in a sentence."""
    ratios = []
    for name, errors in sweep.lines.items():
        measured = [(v, e) for v, e in zip(sweep.versions, errors, strict=True) if e is not None]
        ratios += [(max(a, b) / min(a, b), name, v, a, b) for (_, a), (v, b) in pairwise(measured)]
    course = f"{sweep.title}, {sweep.versions[0]} to {sweep.versions[-1]}, step {sweep.step}"
    if not ratios or max(ratios)[0] < 2:
        return f"{course}: no version changed an error by a factor of two."
    _, name, version, before, after = max(ratios)
    change = f"{plain(before)} to {plain(after)}"
    return f"{course}: the largest change is that of {name} in {version}, {change}."


def _figure(drawn: Sequence[Sweep]) -> Figure:
    figure, places = sheet(len(drawn), [], height=_HEIGHT)
    for axes, sweep in zip(places, drawn, strict=True):
        axes.set_title(f"{sweep.title}, step {sweep.step}", pad=4)
        errors = [e for line in sweep.lines.values() for e in line if e is not None]
        axes.set(yscale="log", ylabel="largest error", ylim=widened(errors, 0.1, 0.1))
        positions = range(1, len(sweep.versions) + 1)
        axes.set(xlim=(0.6, len(sweep.versions) + 0.7))
        number_axes(axes)
        axes.set_xticks(positions, sweep.versions, rotation=45, ha="right")
        for number, (name, line) in enumerate(sweep.lines.items()):
            look = look_of_line(number)
            pairs = zip(positions, line, strict=True)
            points = [(float(k), e) for k, e in pairs if e is not None]
            axes.plot(*zip(*points, strict=True), gid=name, label=name, zorder=3, **look.line)
        name_lines(axes)
    return figure


def _parts(version: str) -> tuple[int, ...]:
    """Return the numbers of a version, by which versions are sorted."""
    return tuple(int(part) for part in version.split(".") if part.isdecimal())
