"""The gallery: pictures of errors are true to their data, and its page names them."""

from __future__ import annotations

import re
from dataclasses import replace
from functools import cache
from itertools import combinations
from math import floor, inf
from pathlib import Path

import numpy as np
import pytest
from builders import reports
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.ticker import FixedLocator

from taylor_verify.cli import main
from taylor_verify.draw import file_errors
from taylor_verify.plotting import log_axes
from taylor_verify.plotting.picture import Picture, plotting
from taylor_verify_reports.studies.gallery import page as gallery
from taylor_verify_reports.studies.portraits.study import PORTRAITS
from taylor_verify_reports.studies.source import Report

RAISED = "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"
LOWERED = str.maketrans(RAISED, "-0123456789")


def stored() -> Report:
    return Report(reports.for_gallery())


@cache
def shown() -> tuple[gallery.Shown, ...]:
    return tuple(gallery.shown(stored()))


# Errors


def test_errors_of_rungs_are_in_their_own_roundoffs() -> None:
    """The start, an error of zero and what is no number have no place; the others are in units of u."""
    gate = {
        "quantity": "omega",
        "errors": [0.0, 2e-7, 0.0, None, inf, 4e-7],
        "attainable": [1e-7] * 6,
    }
    times = [10.0, 9.0, 8.0, 7.0, 6.0, 5.0]
    record = {"rung": "f32", "times": times, "unit_roundoff": 1e-7, "gates": [gate]}
    ((line,),) = file_errors.panels_of({"f32": record}, 10.0, in_roundoffs=True).values()
    is_drawn = np.isfinite(line.errors)
    assert line.times[is_drawn].tolist() == [9.0, 5.0]
    assert line.errors[is_drawn] == pytest.approx([2, 4])
    assert line.floor[is_drawn] == pytest.approx([1, 1])


# The whole gallery


@pytest.mark.parametrize("end", ["generic-errors", "the-pole-errors"])
def test_no_text_is_cut(end: str) -> None:
    """All names, numbers and notes lie within their pictures, to a tenth of a millimetre."""
    picture = next(one.picture for one in shown() if one.picture.stem.endswith(end))
    with plotting():
        figure = picture.figure()
        # In inches, of all that is visible.
        box = figure.get_tightbbox(FigureCanvasAgg(figure).get_renderer())
    width, height = figure.get_size_inches()
    least, most = min(box.x0, box.y0), max(box.x1 - width, box.y1 - height)
    assert max(-least, most) <= 0.004, picture.stem


def overlaps(picture: Picture) -> list[tuple[str, str]]:
    """The numbers at its axes that lie on each other."""
    with plotting():
        figure = picture.figure()
        renderer = FigureCanvasAgg(figure).get_renderer()
        figure.draw(renderer)
        pairs = []
        for axes in figure.axes:
            for axis, limits in ((axes.xaxis, axes.get_xlim()), (axes.yaxis, axes.get_ylim())):
                ticks = [*axis.get_major_ticks(), *axis.get_minor_ticks()]
                shown = [
                    (tick.label1.get_window_extent(renderer), tick.label1.get_text())
                    for tick in ticks
                    if tick.label1.get_visible() and min(limits) <= tick.get_loc() <= max(limits)
                ]
                named = [(box, text) for box, text in shown if text]
                pairs += [
                    (a, b) for (p, a), (q, b) in combinations(named, 2) if p.overlaps(q) and a != b
                ]
    return pairs


@pytest.mark.parametrize("stem", ["euler-separatrix-errors", "kirchhoff-through-the-pole-errors"])
def test_a_short_logarithmic_axis_can_be_read(stem: str) -> None:
    """An axis of less than two decades has plain numbers, none of which lies on another."""
    picture = next(one.picture for one in shown() if one.picture.stem == stem)
    assert overlaps(picture) == []
    with plotting():
        figure = picture.figure()
        figure.axes[0].set_xlim(1, 1.0001)
        figure.axes[0].xaxis.set_major_locator(FixedLocator([1, 1.000001]))
        figure.axes[0].xaxis.set_major_formatter(lambda value, _: f"{value:.6f}")
    assert overlaps(replace(picture, figure=lambda: figure)) == [("1.000000", "1.000001")]


# Up to 10^308, the last power of ten that is a double.
@given(st.floats(-300, 296), st.floats(0.3, 12), st.booleans())
def test_a_number_at_an_axis_reads_as_it_stands(low: float, decades: float, is_long: bool) -> None:
    """The text of 1, 2 or 5 of any decade is that number, and axes have as many powers as decades."""
    power = floor(low)
    for digit in (1,) if is_long else (1, 2, 5):
        text = log_axes.number(digit * 10.0**power, is_long)
        raised = re.fullmatch(rf"(?:(\d)·)?10([{RAISED}]+)", text)
        value = (
            int(raised[1] or 1) * 10.0 ** int(raised[2].translate(LOWERED))
            if raised
            else float(text)
        )
        assert value == pytest.approx(digit * 10.0**power, rel=1e-12)
    count = log_axes.powers_within(10.0**low, 10.0 ** (low + decades))
    assert abs(count - decades) <= 1


def test_the_command_asks_for_what_is_missing(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A folder without portraits, or with a portrait that is none, is a wrong call and stays as it is."""
    assert main(["publish", "gallery", "--from", str(tmp_path)]) == 2
    assert "publish portraits" in capsys.readouterr().err
    portrait = tmp_path / PORTRAITS.name("euler/generic")
    portrait.parent.mkdir(parents=True)
    portrait.write_text("[]\n", encoding="utf-8")
    assert main(["publish", "gallery", "--from", str(tmp_path)]) == 2
    assert "euler-generic.json" in capsys.readouterr().err
    assert not (tmp_path / "figures").exists()
