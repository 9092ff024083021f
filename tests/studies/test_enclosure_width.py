"""The picture of an enclosure's width shows the stored data; no true error is above the width."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import pytest
from builders.scenes import GENERAL, sample_scene

from taylor_verify.exact.enclosure.course import Course
from taylor_verify.plotting.picture import plotting, save
from taylor_verify_reports.studies import enclosure_width as pictures
from taylor_verify_reports.studies.enclosure_width import (
    ENCLOSURE,
    EnclosureStudy,
    WidthRow,
    widths,
)

MADE = EnclosureStudy(
    140,
    (
        WidthRow("a", 0.5, 1.5e-40, 2.9e-41),
        WidthRow("a", 1.0, 3.9e-40, 5.5e-41),
        WidthRow("b", 0.5, 2.0e-38, 0.0),
        WidthRow("b", 1.0, 4.0e-37, 1.0e-39),
    ),
)
TIMES = [Fraction(k, 2) for k in range(1, 9)]


def test_the_middle_errs_by_less_than_the_width() -> None:
    """The enclosure with twice the bits lies within the one with few bits."""
    rows = widths(sample_scene(GENERAL), TIMES, 80)
    assert [row.t for row in rows] == [float(t) for t in TIMES]
    assert all(0 < row.error <= row.width <= 1e-15 for row in rows)


def test_a_width_that_is_too_small_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    """An enclosure without its radii is narrower than its true error."""
    sound = Course.rows

    def narrowed(*arguments: object) -> object:
        for time, row in sound(*arguments):  # type: ignore[arg-type]
            yield time, replace(row, state=[z.mid() for z in row.state])

    monkeypatch.setattr(Course, "rows", narrowed)
    rows = widths(sample_scene(GENERAL), TIMES, 80)
    assert any(row.error > row.width for row in rows)


def test_what_is_drawn_is_what_is_stored(tmp_path: Path) -> None:
    """Each panel has the width and the error of one motion, and two runs give one file."""
    ENCLOSURE.write(tmp_path, MADE)
    stored = ENCLOSURE.load(tmp_path)
    assert stored == MADE
    motions = pictures.series(stored)
    assert list(motions) == ["a", "b"]
    with plotting():
        figure = pictures.picture(stored).figure()
        for axes, lines in zip(figure.axes, motions.values(), strict=True):
            drawn = {line.get_gid(): line.get_xydata() for line in axes.get_lines()}
            assert {name: list(map(tuple, points)) for name, points in drawn.items()} == lines
    once, again = (save([pictures.picture(stored)], tmp_path / part) for part in ("a", "b"))
    assert [file.read_bytes() for file in once] == [file.read_bytes() for file in again]
