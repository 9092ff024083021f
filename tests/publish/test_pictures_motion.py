"""Pictures of motions and of their errors: true to the data, hidden where hidden, the same each time."""

from __future__ import annotations

import re
import shutil
from dataclasses import replace
from functools import cache
from itertools import combinations
from math import floor, inf, log, nan
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest
from builders import reports
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.ticker import FixedLocator

from taylor_verify.cli import main
from taylor_verify.draw import axis_path, centre_path, polhode
from taylor_verify.draw.stage import norm_of, scale
from taylor_verify.draw.view import Ellipsoid, View, pieces
from taylor_verify.plotting import log_axes
from taylor_verify.plotting.palette import lightness
from taylor_verify.plotting.picture import Picture, plotting, save
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict
from taylor_verify_reports.studies.controls import picture as shifts
from taylor_verify_reports.studies.controls.document import CONTROLS
from taylor_verify_reports.studies.gallery import page as gallery
from taylor_verify_reports.studies.gallery.page import Stored
from taylor_verify_reports.studies.gallery.pictures import errors_over_time, potential
from taylor_verify_reports.studies.portraits.study import PORTRAITS

RUNGS = ("f32", "f64", "f80", "f128", "mp237")
FREE = ("euler/generic", "euler/with-attitude", "euler/separatrix", "euler/tennis-racket")
WITH_CENTRE = ("kirchhoff/whole-motion", "kirchhoff/falling-away", "manufactured/kirchhoff-path")
# One of each kind, by the ends of their names.
KINDS = ("generic-polhode", "whole-motion-axis", "whole-motion-centre", "generic-errors")

RAISED = "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"
LOWERED = str.maketrans(RAISED, "-0123456789")

angles = st.floats(-180, 180)
heights = st.floats(-80, 80)
lengths = st.floats(0.2, 5)


def stored() -> Stored:
    return Stored(reports.for_gallery())


@cache
def shown() -> tuple[gallery.Shown, ...]:
    return tuple(gallery.shown(stored()))


def of_polhode(scene: str) -> polhode.Series:
    columns = ("w1", "w2", "w3")
    samples = stored().samples(scene, columns)
    return polhode.series(stored().portrait(scene), samples, stored().record(scene, "f64"))


# The view


@given(angles, heights, st.lists(lengths, min_size=3, max_size=3))
def test_a_view_keeps_lengths_across_it(azimuth: float, elevation: float, p: list[float]) -> None:
    """Right, up and towards the viewer are a right-handed frame: what is seen lacks the depth alone."""
    view = View(azimuth, elevation)
    assert np.abs(view.frame @ view.frame.T - np.eye(3)).max() <= 1e-12
    assert np.linalg.det(view.frame) == pytest.approx(1)
    point = np.array(p)
    across, depth = view.project(point)[0], float(view.towards @ point)
    assert across @ across + depth**2 == pytest.approx(point @ point)


@given(angles, heights, st.tuples(lengths, lengths, lengths), angles, heights)
def test_what_faces_the_viewer_is_what_a_ray_to_him_leaves_the_body_from(
    azimuth: float, elevation: float, semi_axes: tuple[float, float, float], a: float, b: float
) -> None:
    """A point of the surface is seen if and only if a short way towards the viewer leads outside."""
    view, surface = View(azimuth, elevation), Ellipsoid(semi_axes)
    q = View(a, b).towards
    point = q * np.array(semi_axes)
    ahead = (point + 1e-4 * min(semi_axes) * view.towards) / np.array(semi_axes)
    slope = float(q / np.array(semi_axes) @ view.towards)
    if abs(slope) > 1e-3 / min(semi_axes):
        assert bool(surface.faces(point, view)[0]) == bool(ahead @ ahead > 1)


@given(angles, heights, st.tuples(lengths, lengths, lengths))
def test_the_outline_is_on_the_surface_and_nothing_is_seen_beyond_it(
    azimuth: float, elevation: float, semi_axes: tuple[float, float, float]
) -> None:
    """The rim's points are on the surface with their normal across the view, and no circle is wider."""
    view, surface = View(azimuth, elevation), Ellipsoid(semi_axes)
    rim = surface.outline(view)
    assert np.abs(np.square(rim / np.array(semi_axes)).sum(axis=1) - 1).max() <= 1e-9
    normal = rim / np.square(semi_axes)
    across = np.abs(normal @ view.towards) / np.linalg.norm(normal, axis=1)
    assert across.max() <= 1e-9
    widest = np.abs(view.project(rim)).max(axis=0)
    for pole in np.eye(3):
        # The rim has a corner every two degrees.
        assert (np.abs(view.project(surface.circle(pole))).max(axis=0) <= 1.001 * widest).all()


@given(st.lists(st.booleans(), min_size=2, max_size=30))
def test_the_pieces_are_the_whole_line(mask: list[bool]) -> None:
    """The pieces stand in order, each from the end of the last, seen or hidden as its first point is."""
    line = np.arange(2.0 * len(mask)).reshape(-1, 2)
    parts = list(pieces(line, np.array(mask)))
    joined = [parts[0][1][0], *(point for _, piece in parts for point in piece[1:])]
    assert np.array_equal(np.array(joined), line)
    for is_seen, piece in parts:
        assert is_seen == mask[int(piece[0, 0]) // 2]


def test_a_view_from_below_or_above_is_never_steep() -> None:
    """Whatever side is asked for, the upright axis stays upright on the paper."""
    assert View.facing((0, 0, 5)).elevation == 28
    assert View.facing((1, 0, -0.01)).elevation == -12
    assert View.facing((0, 0, 0)).elevation == 12


# The polhode


@pytest.mark.parametrize("scene", FREE)
def test_course_and_samples_are_on_the_ellipsoid(scene: str) -> None:
    """All points have length one in units of the semi-axes, because the energy is conserved."""
    series = of_polhode(scene)
    for points in (series.course, series.samples, *series.separatrices):
        q = points / np.array(series.semi_axes)
        assert np.abs(np.square(q).sum(axis=1) - 1).max() <= 1e-7
    assert len(series.samples) == len(series.errors)


def test_the_separatrix_scene_runs_along_a_separatrix() -> None:
    """The course of the separatrix scene lies in the plane of a curve, that of a plain scene in none."""

    def distance(scene: str) -> float:
        series = of_polhode(scene)
        q = series.course / np.array(series.semi_axes)
        curves = [curve / np.array(series.semi_axes) for curve in series.separatrices]
        normals = [np.cross(curve[0], curve[40]) for curve in curves]
        return min(float(np.abs(q @ n).max() / np.linalg.norm(n)) for n in normals)

    assert distance("euler/separatrix") <= 1e-7
    assert distance("euler/generic") >= 0.1


def test_the_errors_are_those_of_the_record_in_its_roundoff() -> None:
    """1 is one u of the rung that the record is of."""
    record = stored().record("euler/generic", "f64")
    gate = next(gate for gate in record["gates"] if gate["quantity"] == "omega")
    errors = of_polhode("euler/generic").errors
    assert [error * 2.0**-53 for error in errors] == pytest.approx(gate["errors"])


@pytest.mark.parametrize(
    ("scene", "what"),
    [
        ("kirchhoff/whole-motion", "free rigid body"),
        ("manufactured/euler-tones", "free rigid body"),
        ("euler/rest", "a body that turns"),
    ],
)
def test_a_scene_without_a_polhode_is_refused(scene: str, what: str) -> None:
    """A fluid, a moment that changes with time, or no motion at all: there is no such surface."""
    with pytest.raises(ValueError, match=f"{what}.* @ {scene}"):
        polhode.series(stored().portrait(scene), [], stored().record(scene, "f64"))


def test_the_scale_of_colours_reads_the_same_in_grey() -> None:
    """Lightness falls all the way from little to much, by more than half of what paper has."""
    colours = [scale()(k / 20) for k in range(21)]
    shades = [lightness("#" + "".join(f"{round(255 * v):02X}" for v in c[:3])) for c in colours]
    assert shades == sorted(shades, reverse=True)
    assert shades[0] - shades[-1] >= 50


@given(st.lists(st.floats(0, 1e6), min_size=1, max_size=40))
def test_colours_keep_the_order_of_the_errors(errors: list[float]) -> None:
    """A larger error is never lighter; none, or no number, is the lightest."""
    norm = norm_of([*errors, nan, inf])
    places = [float(norm(error)) for error in sorted(errors)]
    assert places == sorted(places)
    assert float(norm(0.0)) == 0.0
    assert all(0 <= place <= 1 for place in places)


# Axis and centre


def test_a_free_motion_keeps_a_direction_in_space() -> None:
    """The angular momentum or linear impulse of every free scene stands still, and no other's does."""
    for scene in ("euler/with-attitude", *WITH_CENTRE):
        series = axis_path.series(stored().portrait(scene))
        assert np.abs(np.linalg.norm(series.path, axis=1) - 1).max() <= 1e-7
        assert (series.fixed is None) == scene.startswith("manufactured")


def test_the_axis_is_that_of_the_motion() -> None:
    """The axis is that of symmetry for Clebsch's body; else the one that the polhode goes round."""
    assert axis_path.axis_of(stored().portrait("kirchhoff/whole-motion")) == 3
    assert axis_path.axis_of(stored().portrait("kirchhoff/oblate-about-axis-1")) == 1
    assert axis_path.axis_of(stored().portrait("euler/with-attitude")) == 1
    assert axis_path.axis_of(stored().portrait("euler/about-max-axis")) == 1
    assert axis_path.axis_of(stored().portrait("manufactured/kirchhoff-path")) == 3


def test_a_centre_moves_as_its_velocity_says() -> None:
    """The path drawn is the course's own, and its direction field is made of unit vectors."""
    for scene in WITH_CENTRE:
        portrait = stored().portrait(scene)
        series = centre_path.series(portrait)
        assert series.path.tolist() == portrait["course"]["centre"]
        assert np.abs(np.linalg.norm(series.directions, axis=1) - 1).max() <= 1e-7


@pytest.mark.parametrize("module", [axis_path, centre_path])
def test_what_is_not_tracked_is_not_drawn(module: Any) -> None:
    """A scene of the angular velocity alone has neither an axis in space nor a path."""
    with pytest.raises(ValueError, match=r"expected a scene with its .* @ euler/generic"):
        module.picture(stored().portrait("euler/generic"))


# Errors


def test_the_line_is_the_largest_error_so_far() -> None:
    """The line never falls, has values of errors, and ends at the largest."""
    points = [(1.0, 2.0), (2.0, 0.5), (3.0, 4.0), (4.0, 1.0)]
    assert errors_over_time.so_far(points) == [(1.0, 2.0), (2.0, 2.0), (3.0, 4.0), (4.0, 4.0)]


def test_what_a_logarithm_cannot_show_is_left_out() -> None:
    """The start, an error of zero and what is no number have no place; the others are in units of u."""
    gate = {"quantity": "omega", "errors": [0.0, 2e-7, 0.0, None, inf, 4e-7]}
    times = [10.0, 9.0, 8.0, 7.0, 6.0, 5.0]
    record = {"rung": "f32", "times": times, "unit_roundoff": 1e-7, "gates": [gate]}
    points = errors_over_time.series([record])["omega"]["f32"]
    assert points == [(1.0, pytest.approx(2)), (5.0, pytest.approx(4))]
    with pytest.raises(ValueError, match="expected errors above zero, got none @ euler/generic"):
        errors_over_time.picture("euler/generic", [])


def test_the_powers_are_those_of_brouwers_law() -> None:
    """All panels have one dashed line, straight in logarithms, of slope 1/2 or 3/2."""
    records = [stored().record("euler/generic", rung) for rung in RUNGS]
    with plotting():
        figure = errors_over_time.picture("euler/generic", records).figure()
    slopes = []
    for axes in figure.axes:
        (line,) = [one for one in axes.get_lines() if str(one.get_gid()).startswith("power")]
        (t0, e0), (t1, e1) = line.get_xydata()
        slopes.append(log(e1 / e0) / log(t1 / t0))
        assert [one.get_gid() for one in axes.get_lines() if one is not line] == list(RUNGS)
    assert slopes == pytest.approx([0.5, 1.5])


def test_a_record_of_the_state_alone_has_one_panel() -> None:
    """A record without gates on conserved quantities has a single panel."""
    record = stored().record("manufactured/euler-resonance", "f64")
    alone = {**record, "gates": [g for g in record["gates"] if g["quantity"] == "omega"]}
    panels = errors_over_time.panels_of(errors_over_time.series([alone]))
    assert [panel.quantity for panel in panels] == ["omega"]


def test_shifts_are_those_of_rows_that_have_one() -> None:
    """No number, no shift or a shift that explains nothing: no line. The best explained comes first."""
    row = Verdict(
        "euler/a",
        "a",
        "f64",
        "control",
        "omega",
        Status.FAIL,
        "reached the last sample",
        **{"max": 1e-3, "residual": 1e-4, "time_shift": 0.5, "shift": "constant"},
    )
    rows = [
        row,
        replace(row, solver="b", residual=1e-9),
        replace(row, solver="c", shift="none"),
        replace(row, solver="d", max=None),
        replace(row, solver="e", residual=nan),
        replace(row, solver="f", residual=None, time_shift=None, shift=None),
    ]
    assert [one["solver"] for one in shifts.series(rows)] == ["b", "a"]
    with pytest.raises(ValueError, match="expected an error with its shift of time"):
        shifts.picture(rows[2:], "controls")


def test_the_half_millisecond_is_found() -> None:
    """The defect that is read half a millisecond early has that shift, and next to nothing is left."""
    rows = {row["solver"]: row for row in shifts.series(CONTROLS.load(stored().folder).verdicts)}
    early = rows["half-a-millisecond-early"]
    assert early["shift"] == pytest.approx(-5e-4, rel=1e-6)
    assert early["residual"] <= 1e-10 * early["error"]


# The quartic


def test_the_curve_touches_zero_at_the_ends_of_the_interval() -> None:
    """The ends are corners of the drawn curve, X3 is zero there, and the roots near by are inside."""
    for scene in ("whole-motion", "two-real-roots", "falling-away", "half-turn", "algebraic"):
        series = potential.series(stored().portrait(f"kirchhoff/{scene}"))
        z, X = series.curve.T
        top = X[(z >= series.interval[0]) & (z <= series.interval[1])].max()
        for end in series.interval:
            assert abs(X[np.flatnonzero(z == end)[0]]) <= 1e-6 * top
        assert (np.diff(z) > 0).all()
        assert sum(count for _, count in series.roots) + 2 * (series.pair is not None) == 4


def test_a_body_without_a_quartic_is_refused() -> None:
    """Only Clebsch's free body has one."""
    with pytest.raises(ValueError, match=r"expected a quartic .* @ kirchhoff/general-body"):
        potential.picture([stored().portrait("kirchhoff/general-body")], "general-body")


# The whole gallery


def fits(picture: Picture) -> None:
    """Return True if all that is drawn stays within the border, to a tenth of a millimetre."""
    with plotting():
        figure = picture.figure()
        # In inches, of all that is visible.
        box = figure.get_tightbbox(FigureCanvasAgg(figure).get_renderer())
    width, height = figure.get_size_inches()
    least, most = min(box.x0, box.y0), max(box.x1 - width, box.y1 - height)
    assert max(-least, most) <= 0.004, picture.stem


@pytest.mark.parametrize("end", KINDS)
def test_no_text_is_cut(end: str) -> None:
    """All names, numbers and notes lie within their pictures."""
    fits(next(one.picture for one in shown() if one.picture.stem.endswith(end)))


@pytest.mark.slow
def test_no_text_is_cut_in_the_whole_gallery() -> None:
    """No picture that is published cuts a text."""
    for one in shown():
        fits(one.picture)


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


def test_two_drawings_are_the_same_file(tmp_path: Path) -> None:
    """SVG and PDF have no date and no random name in them, and the SVG says what it shows."""
    chosen = [one.picture for one in shown() if one.picture.stem == "euler-separatrix-polhode"]
    first = {file.name: file.read_bytes() for file in save(chosen, tmp_path)}
    assert first == {file.name: file.read_bytes() for file in save(chosen, tmp_path)}
    assert {name.rpartition(".")[2] for name in first} == {"svg", "pdf"}
    text = ElementTree.fromstring(first["euler-separatrix-polhode.svg"])
    descriptions = [node.text for node in text.iter() if node.tag.endswith("}description")]
    assert descriptions == [chosen[0].alt]


def test_the_page_shows_every_picture_and_where_it_comes_from() -> None:
    """The page names its maker first, has unique stems, and names existing files of data."""
    text = gallery.page(shown())
    stems = [one.picture.stem for one in shown()]
    assert text.startswith("<!-- made by taylor-verify publish; do not edit -->\n")
    assert len(set(stems)) == len(stems) >= 20
    assert re.findall(r"\]\(([\w-]+)\.svg\)", text) == stems
    named = re.findall(r"(?:\]\(\.\./|`)((?:data|reference)/[^)`]+)[)`]", text)
    assert len(named) > len(stems)
    assert [name for name in named if not (reports.for_gallery() / name).is_file()] == []
    assert all(one.picture.alt for one in shown())
    assert not any(re.search(r"\b(nan|inf|None)\b", one.block()) for one in shown())


def test_the_command_asks_for_what_is_missing(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A folder without portraits, or with a portrait that is none, is a wrong call and stays as it is."""
    assert main(["publish", "gallery", "--from", str(tmp_path)]) == 2
    assert "publish reference" in capsys.readouterr().err
    name = PORTRAITS.name("euler/generic")
    for file in (name, gallery.record_name("euler/generic", "f64")):
        (tmp_path / file).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(reports.for_gallery() / file, tmp_path / file)
    reference = gallery.reference_name("euler/generic")
    (tmp_path / reference).parent.mkdir()
    (tmp_path / reference).write_text("t\n0\n", encoding="utf-8")
    assert main(["publish", "gallery", "--from", str(tmp_path)]) == 2
    assert "w1" in capsys.readouterr().err
    assert not (tmp_path / "figures").exists()
