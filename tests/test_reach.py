"""The reach of each precision: exact families, the judge's own numbers, tables and maps that say them."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import replace
from fractions import Fraction
from itertools import pairwise
from math import inf, log10, nan
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from mpmath import mp

import verify
from verify.cli import main
from verify.exact.elements import elements
from verify.judge.gates import FACTOR
from verify.publish import reach as page
from verify.publish.cells import NOTHING
from verify.publish.pictures import digits_map
from verify.publish.pictures.palette import TEXT_CONTRAST, contrast, lightness
from verify.publish.pictures.picture import plotting
from verify.publish.pictures.style import PAGE_WIDTH
from verify.scenes.precision import rung
from verify.scenes.reader import load
from verify.scenes.scene import Scene
from verify.solvers.taylor.driver import Taylor, at_tolerance
from verify.trade import reach
from verify.trade.attainability import least_error, left_out, narrowest
from verify.trade.families import QUARTERS, Family, at_quarters, families, family, period_of
from verify.trade.recommend import MARGIN, OutOfReach, recommend
from verify.trade.setting import setting

F32, F64, F80 = rung("f32"), rung("f64"), rung("f80")
MEMBERS = [(one, value) for one in families() for value in one.values]
# One of each family, the most extreme.
EXTREMES = [(one, one.values[-1]) for one in families()]


def short(name: str, far: Mapping[str, int]) -> Family:
    """The family on these rungs alone, for so many periods."""
    return replace(family(name), far=dict(far))


def measured(one: Family, value: str, *names: str) -> dict[str, reach.Reach]:
    return {r.rung: r for r in reach.reaches(one, value, map(rung, names or one.far))}


# The families


def test_names_are_there_once() -> None:
    """A family is found by its name, no two members have one label, and a wrong name is refused."""
    labels = [one.label(value) for one, value in MEMBERS]
    assert len(set(labels)) == len(labels) == reach.members()
    assert all(family(one.name).values == one.values for one in families())
    with pytest.raises(ValueError, match=r"expected one of the families .*, got 'comets'"):
        family("comets")


def test_values_lead_to_the_extreme() -> None:
    """They are exact, positive and strictly monotonic: away from one, where nothing is extreme."""
    for one in families():
        sizes = [abs(log10(Fraction(value))) for value in one.values]
        assert all(Fraction(value) > 0 for value in one.values)
        assert sizes == sorted(set(sizes))


@pytest.mark.parametrize(("one", "value"), EXTREMES, ids=lambda x: getattr(x, "name", x))
def test_every_family_is_periodic_and_free(one: Family, value: str) -> None:
    """Its most extreme member has a period, of the elements' own digits, and no loads."""
    scene = one.scene(value)
    assert scene.body.is_free
    exact = elements(scene, 30)["period"].value
    with mp.workdps(30):
        assert abs(mp.convert(period_of(scene)) - exact) <= mp.mpf(10) ** -11 * exact


@pytest.mark.parametrize("value", ["1e-2", "1e-8", "1e-14"])
def test_the_separatrix_is_as_far_as_it_says(value: str) -> None:
    """1 - k^2 of the member d is d, to as many digits as d has before its square counts."""
    d = Fraction(value)
    found = elements(family("separatrix").scene(value), 30)["m_prime"].value
    with mp.workdps(30):
        assert abs(found / mp.convert(d) - 1) <= mp.convert(d)


def test_instants_are_the_quarters_of_the_periods_named() -> None:
    """Four for each number of periods, the last of them its end; exact, and rising."""
    scene = at_quarters(family("unstable-axis").scene("1e-6"), (1, 3, 10))
    period, instants = period_of(scene), scene.clock.elapsed
    assert [t / period for t in instants[QUARTERS - 1 :: QUARTERS]] == [1, 3, 10]
    assert [t / period for t in instants[QUARTERS : 2 * QUARTERS]] == [
        Fraction(9, 4),
        Fraction(5, 2),
        Fraction(11, 4),
        3,
    ]
    assert list(instants) == sorted(set(instants))


def test_an_orbit_without_a_period_is_refused() -> None:
    """A separatrix has none, and it is said."""
    with pytest.raises(ValueError, match="expected a periodic orbit, got a separatrix one"):
        period_of(load("euler/separatrix"))


# The measurement


@pytest.mark.parametrize(
    ("name", "value"),
    [("euler-attitude", "1"), ("unstable-axis", "1e-4"), ("added-mass", "1e5")],
)
def test_errors_and_floors_are_the_judges(name: str, value: str) -> None:
    """The error is the largest that the judge finds in the same run; so is the attainable one there."""
    one = short(name, {"f64": 3})
    found = measured(one, value)["f64"]
    asked = at_quarters(one.scene(value), found.periods)
    states = {"omega", "impulse", "attitude"}
    verdicts = [v for v in verify.run(asked, Taylor(), "f64").verdicts if v.quantity in states]
    assert found.errors[-1] == pytest.approx(max(v.max for v in verdicts), rel=1e-3)
    # The judge's stands at the sample of its largest error, ours is the largest of all samples.
    assert max(v.attainable for v in verdicts) <= 1.001 * found.floors[-1]
    assert found.floors[-1] <= 10 * max(v.attainable for v in verdicts)


@pytest.fixture(scope="module")
def axis() -> dict[str, dict[str, reach.Reach]]:
    """Two members beside the unstable axis, by value and rung."""
    one = short("unstable-axis", {"f32": 3, "f64": 3, "f80": 3})
    return {value: measured(one, value) for value in ("1e-2", "1e-10")}


def test_digits_only_get_fewer(axis: dict[str, dict[str, reach.Reach]]) -> None:
    """Errors and floors are the largest so far: neither falls with the periods."""
    for by_rung in axis.values():
        for found in by_rung.values():
            assert list(found.errors) == sorted(found.errors)
            assert list(found.floors) == sorted(found.floors)
            assert len(found.errors) == len(found.periods)


def test_a_wider_rung_leaves_more(axis: dict[str, dict[str, reach.Reach]]) -> None:
    """Floors are as the roundoffs, but for the steps that each rung takes; and so are the errors."""
    f64, f80 = axis["1e-2"]["f64"], axis["1e-2"]["f80"]
    ratio = f80.floors[0] / f64.floors[0] * 2**11
    assert ratio == pytest.approx((f80.steps / f64.steps) ** 0.5, rel=0.05)
    assert f80.errors[0] < f64.errors[0] < axis["1e-2"]["f32"].errors[0]


def test_solvers_come_near_the_floor(axis: dict[str, dict[str, reach.Reach]]) -> None:
    """What is not lost is within the judge's factor of the attainable error."""
    for found in axis["1e-2"].values():
        for error, least in zip(found.errors, found.floors, strict=True):
            assert error <= FACTOR * least or least >= 0.1


def test_what_is_lost_is_not_followed(axis: dict[str, dict[str, reach.Reach]]) -> None:
    """1e-10 beside the axis doubles are lost in the first period: none is run after, and none told."""
    found = axis["1e-10"]["f64"]
    assert found.errors[0] >= 1
    assert found.errors[1:] == (inf,) * (len(found.periods) - 1)
    assert found.floors[0] >= 1
    one = short("unstable-axis", {"f64": 1})
    assert found.steps == measured(one, "1e-10")["f64"].steps
    assert found.row()["errors"][1:] == [None] * (len(found.periods) - 1)


@pytest.mark.parametrize(
    ("name", "value", "why"),
    [
        ("separatrix", "1e-10", "rounded to f32, the orbit is a separatrix one"),
        ("nearly-singular", "1e-14", "rounded to f32, T is not positive definite"),
        ("nearly-spherical", "1e-8", "rounded to f32"),
    ],
)
def test_another_orbit_is_not_followed(name: str, value: str, why: str) -> None:
    """Where rounding the data makes another orbit of them, nothing is compared, and it is said."""
    found = measured(family(name), value, "f32")["f32"]
    assert found.errors == found.floors == ()
    assert why in found.why


def test_a_coarse_solver_reaches_less(monkeypatch: pytest.MonkeyPatch) -> None:
    """The digits are of what was solved: at a tolerance of 1e-6 there are no more than some six."""
    one = short("euler-periods", {"f64": 1})
    fine = measured(one, "1")["f64"]
    monkeypatch.setattr(reach, "Taylor", lambda: at_tolerance("1e-6"))
    coarse = measured(one, "1")["f64"]
    assert fine.errors[0] <= FACTOR * fine.floors[0]
    assert coarse.errors[0] > 1e4 * fine.errors[0]


def test_nan_is_lost_for_ever() -> None:
    """The largest of numbers with a NaN among them is NaN, from there on; JSON has null for it."""
    errors = reach._up_to([1e-9] * 4 + [1e-9, nan, 1e-9, 1e-9] + [1e-9] * 4)
    assert errors[0] == 1e-9
    assert all(error != error for error in errors[1:])
    row = reach.Reach("a", "1", "f64", (1, 3, 10), errors, errors).row()
    assert row["errors"] == [1e-9, None, None]


def test_the_precision_of_mpmath_is_left_as_it_was() -> None:
    """A measurement works at its own precision."""
    before = mp.prec
    measured(short("thin-rod", {"f32": 1}), "1e2")
    assert mp.prec == before


# The page


def row(value: str, name: str, *errors: float | None, why: str = "") -> dict[str, Any]:
    """A row as `Reach.row` gives it; the floor is a tenth of the error."""
    return {
        "family": "axis",
        "value": value,
        "rung": name,
        "periods": [1, 10, 100],
        "errors": list(errors),
        "floors": [None if error is None else error / 10 for error in errors],
        "steps": 9,
        "why": why,
    }


VALUES = ("1e-1", "1e-2", "1e-3")


def document() -> dict[str, Any]:
    """One family of three values on two rungs, with everything that a table has to tell."""
    return {
        "families": [
            {
                "name": "axis",
                "title": "a body beside something",
                "symbol": "d",
                "extreme": "something",
                "values": list(VALUES),
                "rungs": {"f32": 100, "f64": 100},
            }
        ],
        "rows": [
            row("1e-1", "f32", 1e-6, 1e-4, 1e-2),
            row("1e-2", "f32", 1e-3, 0.5, None),
            row("1e-3", "f32", why="rounded to f32, it is another orbit"),
            row("1e-1", "f64", 1e-14, 1e-13, 1e-12),
            row("1e-2", "f64", 1e-13, 1e-11, 1e-9),
            row("1e-3", "f64", 1e-12, 1e-8, 0.0),
        ],
        "lost": 1.0,
        "provenance": {"processor": "some", "versions": {"heyoka": "7"}, "command": "publish"},
    }


def of_rung(name: str) -> list[dict[str, Any]]:
    return [one for one in document()["rows"] if one["rung"] == name]


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


@given(st.lists(ERRORS.map(lambda found: found[:3]), min_size=1, max_size=6), st.integers(1, 15))
def test_a_reach_is_of_all_that_is_easier(table: list[list[float]], digits: int) -> None:
    """Up to the value told every error is small enough, and the next one's is not."""
    rows = [{**row(str(k), "f64"), "errors": errors} for k, errors in enumerate(table)]
    told = page.last_value(rows, 10, digits)
    count = 0 if told is None else int(told) + 1
    good = [errors[1] is not None and errors[1] <= 10.0**-digits for errors in table]
    assert all(good[:count])
    assert not any(good[count : count + 1])


def test_page_is_made_of_what_was_stored(tmp_path: Path) -> None:
    """Made again it is the same; each answer is in its cell; without a measurement there is none."""
    assert page.pages(tmp_path) == {}
    paths = page.write(tmp_path, document())
    assert {path.suffix for path in paths} == {".json", ".md", ".svg", ".pdf"}
    assert all(path.exists() for path in paths)
    text = (tmp_path / page.PAGE).read_text(encoding="utf-8")
    assert page.pages(tmp_path) == {page.PAGE: text}
    cells = [[cell.strip() for cell in line.split("|")[1:-1]] for line in text.splitlines()]
    assert ["f32", "1", "1e-2", "1e-1", NOTHING, "1e-2", "1e-1", NOTHING] in cells
    assert ["f64", "100", "1e-3 →", "1e-3 →", "1e-1", "1e-3 →", "1e-3 →", "1e-1"] in cells
    assert ["1e-3", "not held", "100 →, 100 →, 1"] in cells
    assert "figures/reach-axis.svg" in text


def test_stored_data_that_are_none_are_refused(tmp_path: Path) -> None:
    """A file with something else in it is named, and no page is made."""
    place = tmp_path / page.REACH
    place.parent.mkdir()
    place.write_text('{"families": 3}', encoding="utf-8")
    with pytest.raises(ValueError, match=r"expected a measured reach, .* @ .*reach\.json"):
        page.pages(tmp_path)


def test_the_verb_measures_and_writes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """`publish --reach` stores what was measured, tells each member as it ends, and what it wrote."""

    def made(finished: Any) -> dict[str, Any]:
        finished("axis d = 1e-1")
        return document()

    monkeypatch.setattr(reach, "document", made)
    assert main(["publish", "--reach", "--from", str(tmp_path), "--json"]) == 0
    out, err = capsys.readouterr()
    assert str(tmp_path / page.PAGE) in json.loads(out)["written"]
    assert "axis d = 1e-1" in err
    stored = json.loads((tmp_path / page.REACH).read_text(encoding="utf-8"))
    assert stored["rows"] == document()["rows"]


# The map


@pytest.fixture
def figure() -> Iterator[Figure]:
    (picture,) = page.pictures(document())
    with plotting():
        yield picture.figure()


def test_every_cell_tells_its_digits(figure: Figure) -> None:
    """Achieved and attainable, each rung, value and number of periods; what was not run is hatched."""
    found = {text.get_gid(): text.get_text() for axes in figure.axes for text in axes.texts}
    assert found["f32 achieved 1e-1 1"] == "6"
    assert found["f32 attainable 1e-1 1"] == "7"
    assert found["f32 achieved 1e-2 100"] == "0"
    assert found["f64 achieved 1e-2 10"] == "11"
    assert "f32 achieved 1e-3 1" not in found
    patches = [p for axes in figure.axes for p in axes.patches if isinstance(p, Rectangle)]
    assert sum(p.get_gid() == "cell" for p in patches) == 2 * (6 + 9)
    assert sum(p.get_gid() == "not run" for p in patches) == 2 * 3


def test_the_map_is_as_wide_as_the_page(figure: Figure) -> None:
    """Nothing of it stands beyond the page."""
    assert figure.get_size_inches()[0] == PAGE_WIDTH
    box = figure.get_tightbbox()
    width, height = figure.get_size_inches()
    assert box.x0 >= 0
    assert box.y0 >= 0
    assert box.x1 <= width
    assert box.y1 <= height


def test_no_name_hides_another() -> None:
    """However many values there are, the names below them stand apart."""
    (one,) = document()["families"]
    values = [f"1e-{2 * k}" for k in range(1, 21)]
    rows = [row(value, "f64", 1e-9, 1e-8, 1e-7) for value in values]
    with plotting():
        drawn = digits_map.picture({**one, "values": values}, rows).figure()
        drawn.canvas.draw()
        axes = next(axes for axes in drawn.axes if axes.get_xticks().size)
        boxes = [label.get_window_extent() for label in axes.get_xticklabels()]
    assert len(boxes) >= 4
    assert all(left.x1 < right.x0 for left, right in pairwise(boxes))


def test_classes_are_told_in_grey() -> None:
    """From class to class the lightness falls by ten or more of a hundred, the first by five."""
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
    """Who cannot see the map is told the values at its two ends."""
    (picture,) = page.pictures(document())
    assert "On f32 six digits are left after 1 period up to 1e-1" in picture.alt
    assert "after 100 periods up to none of these" in picture.alt
    assert "On f64 six digits are left after 1 period up to 1e-3" in picture.alt


def test_a_map_of_nothing_is_refused() -> None:
    """A family without a run has no picture."""
    (one,) = document()["families"]
    with pytest.raises(ValueError, match="expected runs of the family, got none @ axis"):
        digits_map.picture(one, [])


# What recommend makes of it


@pytest.fixture(scope="module")
def generic() -> Scene:
    whole = load("euler/generic")
    return replace(whole, clock=replace(whole.clock, instants=whole.clock.instants[:6]))


def test_the_least_error_is_below_what_is_measured(generic: Scene) -> None:
    """A floor of one rounding a sample is no more than that of the steps that the solver takes."""
    for name in ("f32", "f64"):
        least = least_error(generic, rung(name))
        (omega, *_) = verify.run(generic, Taylor(), name).verdicts
        assert least is not None
        assert 0 < least <= omega.attainable * FACTOR
        assert omega.max <= FACTOR * omega.attainable


def test_a_rung_that_cannot_reach_it_is_not_measured(generic: Scene) -> None:
    """Single precision is left out at 1e-10 with the reason in words, and double is recommended."""
    asked = [setting("taylor", F32), setting("taylor", F64)]
    found = recommend(generic, 1e-10, asked)
    assert found.rung == F64
    (reason,) = found.left_out
    assert "on f32 rounding alone leaves" in reason
    assert reason in found.sentence
    assert found.document()["left_out"] == [reason]


def test_a_rung_is_left_out_by_its_own_floor(generic: Scene) -> None:
    """It takes a floor of the judge's factor times the target; what is nearer is measured."""
    least = least_error(generic, F64)
    assert least is not None
    assert left_out(generic, [F64], 0.99 * least / FACTOR).keys() == {F64}
    assert left_out(generic, [F64], 1.01 * least / FACTOR) == {}
    assert recommend(generic, 1e-3, [setting("taylor", F32)]).left_out == ()


def test_the_narrowest_precision_is_named(generic: Scene) -> None:
    """Where nothing asked can do it, the text names a rung whose floor reaches it; one bit less may not."""
    target = 1e-30
    with pytest.raises(OutOfReach) as caught:
        recommend(generic, target, [setting("taylor", F64)])
    found = narrowest(generic, target / MARGIN)
    assert found is not None
    wide, least = found
    assert least <= target / MARGIN
    assert (
        f"the narrowest precision on which rounding alone leaves so little is {wide.name}"
        in str(caught.value)
    )
    assert narrowest(generic, 1e-5)[0] in (F32, F64)
    assert least_error(generic, F80) > target / MARGIN


def test_no_precision_reaches_below_the_widest(generic: Scene) -> None:
    """A floor in proportion to the roundoff is above 1e-305 with a thousand bits: none is named."""
    assert narrowest(generic, 1e-305) is None


def test_what_computes_elsewhere_is_measured_anyway(generic: Scene) -> None:
    """A solver that works on wider numbers than it answers on is not judged by the floor of these."""
    with pytest.raises(OutOfReach, match="most accurate"):
        recommend(generic, 1e-25, [setting("mpmath:odefun?tol=1e-6", F64)])
