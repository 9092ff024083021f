"""Pictures: every solver is told from the others, nothing false is joined, every line has a name."""

import re
from base64 import b64decode
from collections.abc import Iterator, Mapping
from itertools import combinations, pairwise
from math import floor, inf, log10
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import matplotlib
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from taylor_verify.draw import file_errors
from taylor_verify.plotting import log_axes
from taylor_verify.plotting.picture import Picture, plotting, save
from taylor_verify.plotting.style import (
    INK,
    KINDS,
    PAGE_WIDTH,
    PAPER,
    QUIET,
    kind_of,
    look_of,
    look_of_rung,
)
from taylor_verify.tradeoff import work_precision as trade
from taylor_verify.tradeoff.document import label
from taylor_verify.tradeoff.work_precision import front_of, panels_of, series_of

RUNGS = ("f32", "f64", "f80", "f128", "mp237")
RAISED = "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"
LOWERED = str.maketrans(RAISED, "-0123456789")
SVG = "{http://www.w3.org/2000/svg}"


def row(family: str, rung: str, requested: float, error: float | None, **other: Any) -> dict:
    """A point as `Point.row` gives it, sound unless it says otherwise."""
    made = {
        "solver": family.replace(" ", ":"),
        "setting": f"tol={requested:g}",
        "rung": rung,
        "family": family,
        "asked": "tolerance",
        "requested": requested,
        "requested_digits": -log10(requested),
        "achieved_digits": -log10(error) if error else None,
        "error": error,
        "steps": 100,
        "evaluations": 1000,
        "seconds": 0.01,
        "spread": 1.5,
        "first_seconds": 0.5,
        "standing": "sound",
        "because": "",
    }
    return made | other


def family(name: str, rung: str, start: float, order: float, finest: int = 12) -> list[dict]:
    """Work that grows by ``order`` decades of error a decade, from ``start`` seconds on."""
    rows = []
    for digits in range(3, finest + 1, 3):
        work = 10 ** (digits / order)
        counts = {"steps": int(20 * work), "evaluations": int(200 * work)}
        rows.append(
            row(name, rung, 10.0**-digits, 3 * 10.0**-digits, seconds=start * work, **counts)
        )
    return rows


def fallen(name: str, rung: str, digits: int, standing: str) -> dict:
    """A setting that is no answer."""
    error = 2.0 if standing == "false success" else None
    seconds = 0.02 if error else None
    return row(name, rung, 10.0**-digits, error, standing=standing, seconds=seconds)


OTHERS = [entry[0] for kind in KINDS for entry in kind.entries]


def document(rows: list[dict], **other: Any) -> dict[str, Any]:
    return {"scene": "euler/generic", "track": [], "points": rows, "timing": {"repeats": 5}} | other


def many() -> dict[str, Any]:
    """All solvers that have a look of their own, and two that have none."""
    rows = [
        one
        for i, rung in enumerate(RUNGS)
        for one in family(f"taylor {rung}", rung, 0.001 * 3**i, 14.0, (6, 15, 18, 33, 60)[i])
    ]
    for i, name in enumerate([*OTHERS, "process:./mine", "unheard of"]):
        rows += family(name, "f64", 0.002 * 1.4 ** (i % 7), 3.0 + i % 5)
    at = {(one["family"], one["requested"]): i for i, one in enumerate(rows)}
    rows[at["scipy rk45", 1e-6]] = fallen("scipy rk45", "f64", 6, "failed")
    rows[at["scipy bdf", 1e-3]] = fallen("scipy bdf", "f64", 3, "false success")
    rows[at["cvode bdf", 1e-12]] = fallen("cvode bdf", "f64", 12, "failed")
    rows[at["closed form", 1e-12]] |= {"error": 0.0, "achieved_digits": None}
    return document(rows, attainable={"f64": 1e-15, "f128": 1e-34})


def few(*kinds: str) -> dict[str, Any]:
    """The kinds named, with one of everything that a legend explains."""
    rows = [one for one in many()["points"] if one["family"].startswith(kinds)]
    exact = row("scipy radau", "f64", 1e-13, 0.0)
    return document([*rows, exact], attainable={"f64": 1e-15}, track=["attitude", "omega"])


def figures(document: Mapping[str, Any]) -> Iterator[tuple[str, Figure]]:
    for picture in trade.pictures(document):
        with plotting():
            figure = picture.figure()
        yield picture.stem.rpartition("-")[2], figure


@pytest.fixture(scope="module")
def crowded() -> dict[str, Figure]:
    return dict(figures(many()))


# Looks


def test_every_family_has_its_own_colour_and_marker() -> None:
    """No two of all known families and rungs share a colour and a marker."""
    styles = [look_of_rung(rung) for rung in RUNGS] + [look_of(name, "f64") for name in OTHERS]
    pairs = {(look.colour, look.marker) for look in styles}
    assert len(pairs) == len(styles) >= 24


def luminance(colour: str) -> float:
    """The relative luminance of WCAG 2, 0 black to 1 white."""
    parts = (int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5))
    linear = [v / 12.92 if v <= 0.04045 else ((v + 0.055) / 1.055) ** 2.4 for v in parts]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(colour: str) -> float:
    """The contrast of WCAG 2 with paper, from 1 to 21."""
    return (luminance(PAPER) + 0.05) / (luminance(colour) + 0.05)


def test_lines_and_text_stand_out_from_paper() -> None:
    """Lines have the contrast of 3 and text that of 4.5, which WCAG 2.1 asks for (1.4.11, 1.4.3)."""
    names = [*OTHERS, *(f"unknown {i}" for i in range(50))]
    colours = {look_of(name, "f64").colour for name in names}
    colours |= {look_of_rung(rung).colour for rung in RUNGS}
    assert all(contrast(colour) >= 3 for colour in colours)
    assert min(contrast(INK), contrast(QUIET)) >= 4.5


@pytest.mark.parametrize(
    ("name", "same"),
    [
        ("scipy RK45", "scipy:RK45?rtol=1e-3&atol=1e-6"),
        ("geometric preprocessed-moser-veselov", "geometric:preprocessed-moser-veselov?step=1/4"),
        ("CVODE Adams", "sundials cvode adams"),
    ],
)
def test_a_solver_looks_the_same_however_it_is_set(name: str, same: str) -> None:
    """Options and punctuation change no look."""
    assert look_of(name, "f64") == look_of(same, "f64")
    assert kind_of(name) == kind_of(same)


# What is joined


def test_a_line_joins_neighbours_that_are_sound_and_nothing_else(crowded: dict) -> None:
    """All drawn lines are runs of neighbouring sound settings of one family."""
    rows = many()["points"]
    keys = {"time": "seconds", "evaluations": "evaluations"}
    checked = 0
    for name, key in keys.items():
        for axes in crowded[name].axes:
            for line in axes.get_lines():
                its = [one for one in rows if one["family"] == line.get_gid()]
                if not its:
                    continue
                spots = [(one[key], one["error"]) for one in its if one["standing"] == "sound"]
                order = [(one[key], one["error"]) for one in its]
                drawn = [tuple(spot) for spot in line.get_xydata()]
                assert set(drawn) <= set(spots)
                places = [order.index(spot) for spot in drawn]
                assert places == list(range(places[0], places[0] + len(places)))
                checked += 1
    assert checked >= 2 * 26


def test_every_sound_point_is_drawn_once_a_panel(crowded: dict) -> None:
    """Sound points of a family are all on its lines."""
    for one in many()["points"]:
        if one["standing"] != "sound" or one["error"] == 0:
            continue
        spot = (one["seconds"], one["error"])
        panels = [
            sum(spot == tuple(xy) for line in axes.get_lines() for xy in line.get_xydata()
                if line.get_gid() == one["family"])
            for axes in crowded["time"].axes
        ]  # fmt: skip
        assert max(panels) == 1


def test_the_front_is_that_of_the_trade(crowded: dict) -> None:
    """The stairs of each panel are the same, fall all the way, and no sound point is below them."""
    stairs = [
        [tuple(spot) for spot in line.get_xydata()]
        for axes in crowded["time"].axes
        for line in axes.get_lines()
        if line.get_gid() == "front"
    ]
    assert len(stairs) == len(panels_of(series_of(many(), "seconds")))
    sound = [one for one in many()["points"] if one["standing"] == "sound" and one["error"]]
    for corners in stairs:
        assert all(x <= x_next and y >= y_next for (x, y), (x_next, y_next) in pairwise(corners))
        for one in sound:
            reached = min(y for x, y in corners if x <= one["seconds"])
            assert one["error"] >= reached


def test_the_front_agrees_with_the_judgement() -> None:
    """The front of a real trade-off, from its document alone, is the one that the trade names."""
    from taylor_verify.scenes.reading.reader import load
    from taylor_verify.tradeoff.setting import settings as all_settings
    from taylor_verify.tradeoff.trade_off import trade_off

    scene = load("euler/generic")
    asked = [one for one in all_settings(scene, ["f32", "f64"]) if one.family.startswith("taylor")]
    made = trade_off(scene, asked, repeats=1).document()
    points = front_of(made, "seconds")
    assert [label(one["solver"], one["setting"], one["rung"]) for one in points] == made["front"]
    assert next(p.stem for p in trade.pictures(made)) == "euler-generic-time"


def test_floors_are_drawn_where_their_rung_is(crowded: dict) -> None:
    """The attainable error of a rung stands in every panel with taylor on that rung."""
    floors = [
        sorted(line.get_ydata()[0] for line in axes.get_lines() if line.get_gid() == "floor")
        for axes in crowded["time"].axes
    ]
    assert [1e-34, 1e-15] in floors
    assert floors.count([1e-15]) == len(panels_of(series_of(many(), "seconds"))) - 1


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


# Up to 10^308, the last power of ten that is a double.
@given(st.floats(-300, 296), st.floats(0.3, 12), st.booleans())
def test_a_number_at_an_axis_reads_as_it_stands(low: float, decades: float, is_long: bool) -> None:
    """The text of 1, 2 or 5 of any decade is that number, and axes have as many powers as decades."""
    power = floor(low)
    for digit in (1,) if is_long else (1, 2, 5):
        text = log_axes.number(digit * 10.0**power, is_long=is_long)
        raised = re.fullmatch(rf"(?:(\d)·)?10([{RAISED}]+)", text)
        value = (
            int(raised[1] or 1) * 10.0 ** int(raised[2].translate(LOWERED))
            if raised
            else float(text)
        )
        assert value == pytest.approx(digit * 10.0**power, rel=1e-12)
    count = log_axes.powers_within(10.0**low, 10.0 ** (low + decades))
    assert abs(count - decades) <= 1


# Names


def plain_picture() -> Picture:
    """Return a picture of one family."""
    return trade.pictures(document(family("taylor f64", "f64", 0.01, 9.0)))[0]


def names_in(axes: Axes) -> set[str]:
    """Return the names in the legend of a panel, or in a strip above one."""
    legend = axes.get_legend()
    return {text.get_text() for text in (*axes.texts, *(legend.get_texts() if legend else ()))}


@pytest.mark.parametrize("name", ["time", "evaluations"])
def test_every_line_is_named(crowded: dict, name: str) -> None:
    """All solvers have names in their panels."""
    written = {text for axes in crowded[name].axes for text in names_in(axes)}
    for series in series_of(many(), "seconds"):
        assert {series.family, series.label} & written


def test_nothing_is_cut_off() -> None:
    """Headings, numbers, axis names and the legend are on the page, and headings do not touch."""
    for _, figure in figures(few("taylor", "scipy", "geometric")):
        canvas = FigureCanvasAgg(figure)
        with plotting():
            canvas.draw()
        renderer = canvas.get_renderer()
        everything = figure.get_tightbbox(renderer)
        width, height = figure.get_size_inches()
        assert width == PAGE_WIDTH
        assert everything.x0 >= 0 <= everything.y0
        assert everything.x1 <= width
        assert everything.y1 <= height
        headings = [axes._left_title.get_window_extent(renderer) for axes in figure.axes]
        assert not any(one.overlaps(other) for one, other in combinations(headings, 2))


# Files


def test_two_drawings_are_the_same_bytes(tmp_path: Path) -> None:
    """Drawn twice, in another order and with other settings of the user, every file is the same."""
    rows = family("taylor f64", "f64", 0.01, 9.0) + family("scipy RK45", "f64", 0.05, 4.0)
    made = trade.pictures(document(rows))
    first = [*save(made, tmp_path / "a", ["svg"]), *save(made[:1], tmp_path / "a", ["pdf"])]
    with matplotlib.rc_context({"font.size": 20, "lines.linewidth": 9, "svg.hashsalt": "other"}):
        save(reversed(made), tmp_path / "b", ["svg"])
        save(made[:1], tmp_path / "b", ["pdf"])
    assert len(first) == 3
    for path in first:
        assert path.read_bytes() == (tmp_path / "b" / path.name).read_bytes()


def test_a_file_is_text_without_a_date(tmp_path: Path) -> None:
    """The SVG parses, its words are text, it tells what it shows; neither it nor the PDF has a date."""
    picture = trade.pictures(few("taylor", "scipy"))[0]
    svg, pdf = save([picture], tmp_path)
    root = ElementTree.fromstring(svg.read_bytes())
    words = {"".join(text.itertext()).strip() for text in root.iter(f"{SVG}text")}
    assert {"f128", "rk45", "taylor f64", "time of a solve, best of 5 (s)"} <= words
    assert root.find(f"{SVG}title").text == picture.title
    assert picture.alt in {text.text for text in root.iter() if text.tag.endswith("description")}
    assert not [tag for tag in root.iter() if tag.tag.endswith("}date")]
    assert b"CreationDate" not in pdf.read_bytes()
    assert pdf.read_bytes().startswith(b"%PDF")
    assert b"/FontFile2" in pdf.read_bytes()


def test_a_notebook_shows_a_picture_with_its_words(tmp_path: Path) -> None:
    """A notebook shows the published SVG with its alternative text."""
    picture = plain_picture()
    (svg,) = save([picture], tmp_path, ["svg"])
    html = ElementTree.fromstring(picture._repr_html_())
    (image,) = html.iter("img")
    kind, _, drawn = image.attrib["src"].partition(",")
    assert kind == "data:image/svg+xml;base64"
    assert b64decode(drawn) == svg.read_bytes()
    assert image.attrib["alt"] == picture.alt


def test_the_alt_text_has_the_numbers() -> None:
    """The alternative text names the fastest and the most accurate setting, and counts the front."""
    time = trade.pictures(many())[0].alt
    front = front_of(many(), "seconds")
    for row in (front[0], front[-1]):
        assert label(row["solver"], row["setting"], row["rung"]) in time
    assert time.endswith(f"{len(front)} settings are beaten by none.")
