"""The picture of an enclosure's width shows what was stored, and a true error is never above it."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import pytest
from samples import GENERAL, one_instant, vector

from taylor_verify.exact.enclosure.course import Course
from taylor_verify.exact.widths import SCENES, widths
from taylor_verify.publish import data
from taylor_verify.publish.pictures import widths as pictures
from taylor_verify.publish.pictures.picture import plotting, save
from taylor_verify.publish.widths import STORED
from taylor_verify.scenes.motion import Impulse
from taylor_verify.scenes.reader import load

REPORTS = Path(__file__).parent.parent / "reports"
TIMES = [Fraction(k, 2) for k in range(1, 9)]


def test_the_middle_errs_by_less_than_the_width() -> None:
    """The enclosure with twice the bits is within the one with few, which gives digits away."""
    moving = Impulse(vector("0.1", "0.2", 1), vector("0.3", 0, 1))
    rows = widths(one_instant(GENERAL, moving), TIMES, 80)
    assert [row["t"] for row in rows] == [float(t) for t in TIMES]
    assert all(0 < row["error"] <= row["width"] <= 1e-15 for row in rows)


def test_a_width_that_is_too_small_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    """Without its radii an enclosure is narrower than the error that the truth shows."""
    moving = Impulse(vector("0.1", "0.2", 1), vector("0.3", 0, 1))
    sound = Course.rows

    def narrowed(*arguments: object) -> object:
        for time, row in sound(*arguments):  # type: ignore[arg-type]
            yield time, replace(row, state=[z.mid() for z in row.state])

    monkeypatch.setattr(Course, "rows", narrowed)
    rows = widths(one_instant(GENERAL, moving), TIMES, 80)
    assert any(row["error"] > row["width"] for row in rows)


@pytest.mark.slow
def test_the_stored_widths_are_remade() -> None:
    """The first rows of the published numbers are what the scenes give today.

    The steps that lead to them do not know yet where the run ends.
    """
    stored = data.read_document(REPORTS / STORED)
    for name in SCENES:
        rows = [row for row in stored["rows"] if row["scene"] == name][:40]
        times = [Fraction(row["t"]) for row in rows]
        assert widths(load(name), times, stored["bits"])[:10] == rows[:10]


def test_what_is_drawn_is_what_is_stored(tmp_path: Path) -> None:
    """Each panel has the width and the error of one motion, and two runs give one file."""
    stored = data.read_document(REPORTS / STORED)
    motions = pictures.series(stored)
    assert list(motions) == list(SCENES)
    with plotting():
        figure = pictures.picture(stored).figure()
        for axes, lines in zip(figure.axes, motions.values(), strict=True):
            drawn = {line.get_gid(): line.get_xydata() for line in axes.get_lines()}
            assert {name: list(map(tuple, points)) for name, points in drawn.items()} == lines
    once, again = (save([pictures.picture(stored)], tmp_path / part) for part in ("a", "b"))
    assert [file.read_bytes() for file in once] == [file.read_bytes() for file in again]
    assert all(row["error"] <= row["width"] for row in stored["rows"])


def test_a_document_without_rows_is_refused() -> None:
    """A picture of nothing is no picture."""
    with pytest.raises(ValueError, match="expected widths and errors above zero"):
        pictures.picture({"bits": 140, "rows": []})
