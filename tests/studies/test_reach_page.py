"""Pages of the reach of each precision: tables and maps that show the measurements."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from dataclasses import replace
from itertools import pairwise
from math import inf, nan
from pathlib import Path

import pytest
from builders.studies.reach import AXIS, row, study
from builders.studies.stored import publish_document
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from taylor_verify.cli import main
from taylor_verify.plotting.palette import TEXT_CONTRAST, contrast, lightness
from taylor_verify.plotting.picture import plotting
from taylor_verify.plotting.style import PAGE_WIDTH
from taylor_verify.records import store
from taylor_verify.records.json_text import complete
from taylor_verify.records.replacement import replace_files
from taylor_verify.words.cells import NOTHING
from taylor_verify_reports.studies.reach import measure as reach
from taylor_verify_reports.studies.reach import page as page
from taylor_verify_reports.studies.reach import picture as digits_map
from taylor_verify_reports.studies.reach.document import ReachRow, ReachStudy
from taylor_verify_reports.studies.reach.study import STUDY

# The page


def of_rung(name: str) -> list[ReachRow]:
    return [one for one in study().rows if one.rung == name]


def test_the_last_value_and_the_most_periods() -> None:
    """An error of exactly 10^-n leaves n digits; a value behind one that fails does not count."""
    f32, f64 = of_rung("f32"), of_rung("f64")
    assert page.last_value(f32, 1, 6) == "1e-1"
    assert page.last_value(f32, 1, 3) == "1e-2"
    assert page.last_value(f32, 10, 3) == "1e-1"
    assert page.last_value(f64, 10, 12) == "1e-1"
    assert page.last_value(f64, 1, 12) == "1e-3"
    assert page.most_periods(f32[0], 12) is None
    assert page.most_periods(f32[2], 3) is None
    assert page.most_periods(f64[1], 6) == 100
    assert page.most_periods(f64[2], 12) == 1


ERRORS = st.lists(st.floats(0, 10) | st.sampled_from([None, nan, 1e-3, 1e-6, 1e-12]), min_size=3)


@given(st.lists(ERRORS.map(lambda errors: errors[:3]), min_size=1, max_size=6), st.integers(1, 15))
def test_a_reach_is_of_all_that_is_easier(table: list[list[float]], digits: int) -> None:
    """Every error up to the returned value is small enough, and the next one is not."""
    rows = [replace(row(str(k), "f64"), errors=tuple(e)) for k, e in enumerate(table)]
    last = page.last_value(rows, 10, digits)
    count = 0 if last is None else int(last) + 1
    good = [errors[1] is not None and errors[1] <= 10.0**-digits for errors in table]
    assert all(good[:count])
    assert not any(good[count : count + 1])


def test_page_is_made_of_what_was_stored(tmp_path: Path) -> None:
    """Made again it is the same; each answer is in its cell; without a measurement there is none."""
    assert STUDY.pages(tmp_path) == {}
    paths = publish_document(tmp_path, STUDY, page.REACH, study())
    assert {path.suffix for path in paths} == {".json", ".md", ".csv", ".svg", ".pdf"}
    assert all(path.exists() for path in paths)
    text = (tmp_path / STUDY.path).read_text(encoding="utf-8")
    sheet = (tmp_path / "tables/reach.csv").read_text(encoding="utf-8")
    assert STUDY.pages(tmp_path) == {STUDY.path: text, "tables/reach.csv": sheet}
    cells = [[cell.strip() for cell in line.split("|")[1:-1]] for line in text.splitlines()]
    assert ["f32", "1", "1e-2", "1e-1", NOTHING, "1e-2", "1e-1", NOTHING] in cells
    assert ["f64", "100", "1e-3 →", "1e-3 →", "1e-1", "1e-3 →", "1e-3 →", "1e-1"] in cells
    assert ["1e-3", "not held", "100 →, 100 →, 1"] in cells
    assert "figures/reach-axis.svg" in text
    assert "axis 1e-2, f32: the run stopped: too many steps." in text


def test_stored_data_that_are_none_are_refused(tmp_path: Path) -> None:
    """A file with something else in it is named, and no page is made."""
    place = tmp_path / page.REACH.name
    place.parent.mkdir()
    place.write_text('{"families": 3}', encoding="utf-8")
    with pytest.raises(ValueError, match=r"expected a list, got 3 @ families @ .*reach\.json"):
        STUDY.pages(tmp_path)


def test_families_without_their_rows_are_refused(tmp_path: Path) -> None:
    """A typed document that lacks what its page needs is a ValueError with the file."""
    replace_files(tmp_path, {page.REACH.name: store.laid_out(complete(replace(study(), rows=())))})
    with pytest.raises(
        ValueError, match=r"expected what `publish reach` writes, .* @ .*reach\.json"
    ):
        STUDY.pages(tmp_path)


def test_the_verb_measures_and_writes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """`publish reach` stores what was measured, tells each member as it ends, and what it wrote."""

    def made(finished: Callable[[str], None]) -> ReachStudy:
        finished("axis d = 1e-1")
        return study()

    monkeypatch.setattr(reach, "study", made)
    assert main(["publish", "reach", "--from", str(tmp_path), "--json"]) == 0
    out, err = capsys.readouterr()
    assert str(tmp_path / STUDY.path) in json.loads(out)["written"]
    assert "axis d = 1e-1" in err
    assert page.REACH.load(tmp_path) == study()


# The map


@pytest.fixture
def figure() -> Iterator[Figure]:
    (picture,) = page.pictures(study())
    with plotting():
        yield picture.figure()


def test_every_cell_tells_its_digits(figure: Figure) -> None:
    """Achieved and attainable, each rung, value and number of periods; what was not run is hatched."""
    digits = {text.get_gid(): text.get_text() for axes in figure.axes for text in axes.texts}
    assert digits["f32 achieved 1e-1 1"] == "6"
    assert digits["f32 attainable 1e-1 1"] == "7"
    assert digits["f32 achieved 1e-2 100"] == "0"
    assert digits["f64 achieved 1e-2 10"] == "11"
    assert "f32 achieved 1e-3 1" not in digits
    patches = [p for axes in figure.axes for p in axes.patches if isinstance(p, Rectangle)]
    assert sum(p.get_gid() == "cell" for p in patches) == 2 * (6 + 9)
    assert sum(p.get_gid() == "not run" for p in patches) == 2 * 3


def test_the_map_is_as_wide_as_the_page(figure: Figure) -> None:
    """The map stays within the page."""
    assert figure.get_size_inches()[0] == PAGE_WIDTH
    box = figure.get_tightbbox()
    width, height = figure.get_size_inches()
    assert box.x0 >= 0
    assert box.y0 >= 0
    assert box.x1 <= width
    assert box.y1 <= height


def test_no_name_hides_another() -> None:
    """However many values there are, the names below them stand apart."""
    values = tuple(f"1e-{2 * k}" for k in range(1, 21))
    rows = [row(value, "f64", 1e-9, 1e-8, 1e-7) for value in values]
    with plotting():
        drawn = digits_map.picture(replace(AXIS, values=values), rows).figure()
        drawn.canvas.draw()
        axes = next(axes for axes in drawn.axes if axes.get_xticks().size)
        boxes = [label.get_window_extent() for label in axes.get_xticklabels()]
    assert len(boxes) >= 4
    assert all(left.x1 < right.x0 for left, right in pairwise(boxes))


def test_classes_are_told_in_grey() -> None:
    """The lightness falls by ten or more of a hundred from class to class, the first by five."""
    levels = [lightness(colour) for _, colour in digits_map.CLASSES]
    falls = [before - after for before, after in pairwise(levels)]
    assert falls[0] >= 5
    assert min(falls[1:]) >= 10
    for _, colour in digits_map.CLASSES:
        assert contrast(digits_map.text_on(colour), colour) >= TEXT_CONTRAST


@given(st.integers(0, 70))
def test_whole_digits(digits: int) -> None:
    """An error below 10^-n leaves n digits, one above fewer; what is no number leaves none."""
    assert digits_map.digits_of(0.999 * 10.0**-digits) == digits
    assert digits_map.digits_of(1.001 * 10.0**-digits) == max(digits - 1, 0)
    assert digits_map.digits_of(None) == digits_map.digits_of(nan) == digits_map.digits_of(inf) == 0


def test_alt_text_says_how_far_six_digits_go() -> None:
    """The alternative text of the map has the values at its two ends."""
    (picture,) = page.pictures(study())
    assert "On f32 six digits are left after 1 period up to 1e-1" in picture.alt
    assert "after 100 periods up to none of these" in picture.alt
    assert "On f64 six digits are left after 1 period up to 1e-3" in picture.alt


def test_a_map_of_nothing_is_refused() -> None:
    """A family without a run has no picture."""
    with pytest.raises(ValueError, match="expected runs of the family, got none @ axis"):
        digits_map.picture(AXIS, [])
