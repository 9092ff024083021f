"""The site without a browser: what every page must have, and what its pictures are made of."""

from __future__ import annotations

import json
import re
import shutil
from collections.abc import Collection, Iterator, Mapping
from fractions import Fraction
from html.parser import HTMLParser
from itertools import pairwise
from math import dist
from pathlib import Path, PurePosixPath
from typing import Any

import pytest
from builders import reports
from builders.reports import SCENES
from hypothesis import given
from hypothesis import strategies as st

from taylor_verify.cli import main
from taylor_verify.publish.mathml import inline, mathml
from taylor_verify.publish.pictures.palette import PAPER, contrast
from taylor_verify.solvers.files.file import read
from taylor_verify.studies.site import motion, work
from taylor_verify.studies.site.builder import MADE_BY, build, contents
from taylor_verify.studies.site.links import Links, way
from taylor_verify.studies.site.looks import DARK_PAPER, LINE_CONTRAST, Palette
from taylor_verify.studies.site.prose import Prose, sections, slug_of
from taylor_verify.studies.site.scene_page import ScenePage
from taylor_verify.studies.site.source import Report


@pytest.fixture(scope="module")
def report() -> Path:
    return reports.small()


@pytest.fixture(scope="module")
def site(report: Path) -> dict[str, str | bytes]:
    return contents(report)


@pytest.fixture(scope="module")
def pages(site: dict[str, str | bytes]) -> dict[str, Page]:
    return {name: Page(str(text)) for name, text in site.items() if name.endswith(".html")}


class Page(HTMLParser):
    """The links, anchors and stored data of a page, as a browser would find them."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.text = text
        self.links: list[str] = []
        self.loads: list[str] = []
        self.anchors: list[str] = []
        self.figures: dict[str, Any] = {}
        self._reading = ""
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        found = dict(attrs)
        if found.get("id"):
            self.anchors.append(str(found["id"]))
        if tag == "a" and found.get("href"):
            self.links.append(str(found["href"]))
        if tag in ("script", "img", "link") and (link := found.get("src") or found.get("href")):
            self.loads.append(link)
        stored = tag == "script" and found.get("type") == "application/json"
        self._reading = str(found["id"]) if stored else ""

    def handle_data(self, data: str) -> None:
        if self._reading:
            self.figures[self._reading] = json.loads(data)
            self._reading = ""


def test_every_page_names_its_maker(pages: dict[str, Page]) -> None:
    """Line one of each page says what made it, and a scene's page the digest of its scene."""
    assert {page.text.partition("\n")[0] for page in pages.values()} == {MADE_BY}
    for scene in SCENES:
        assert re.search(r"SHA-256 <code[^>]*>[0-9a-f]{64}<", pages[place_of(scene)].text)


def place_of(scene: str) -> str:
    return f"scenes/{scene.replace('/', '-')}.html"


def test_links_resolve(site: dict[str, str | bytes], pages: dict[str, Page]) -> None:
    """Every link within the site leads to a file of it, and to an anchor that is there."""
    links_resolve(pages, site)


def links_resolve(pages: Mapping[str, Page], site: Collection[str]) -> None:
    for name, page in pages.items():
        for link in page.links + page.loads:
            if link.startswith(("http://", "https://", "data:")):
                continue
            path, _, anchor = link.partition("#")
            target = resolved(name, path) if path else name
            assert target in site, f"{link} @ {name}"
            assert not anchor or anchor in pages[target].anchors, f"{link} @ {name}"


def resolved(page: str, link: str) -> str:
    parts: list[str] = list(PurePosixPath(page).parent.parts)
    for part in link.split("/"):
        parts = parts[:-1] if part == ".." else [*parts, part]
    return "/".join(parts)


def test_nothing_comes_from_a_network(site: dict[str, str | bytes], pages: dict[str, Page]) -> None:
    """No page loads a script, a style, a picture or a font from an address, and no script asks for one."""
    for page in pages.values():
        assert not [load for load in page.loads if "//" in load.removeprefix("data:")]
    own = {n: str(t) for n, t in site.items() if n.endswith((".css", ".js")) and "plotly" not in n}
    assert len(own) == 5
    for name, text in own.items():
        assert not re.search(r"https?:|@import|url\(|fetch\(|XMLHttp|import\(", text), name


def test_anchors_are_one_of_a_kind(pages: dict[str, Page]) -> None:
    """No page has an id twice: links and labels would go to the first."""
    for name, page in pages.items():
        assert len(page.anchors) == len(set(page.anchors)), name


def test_pictures_name_what_is_there(site: dict[str, str | bytes], pages: dict[str, Page]) -> None:
    """Every colour that a picture names is in both themes, every column in the picture itself."""
    script = str(site["assets/palette.js"])
    palette = json.loads(script[script.index("{") : script.rindex("}") + 1])
    assert palette["light"].keys() == palette["dark"].keys()
    figures = [figure for page in pages.values() for figure in page.figures.values()]
    assert len(figures) > 20
    for figure in figures:
        assert figure["drawings"]
        assert all(one["data"] for one in figure["drawings"])
        for text in texts(figure):
            if text.startswith("$"):
                assert text[1:] in palette["light"], text
            if text.startswith("@"):
                assert text[1:] in figure["columns"], text


def texts(value: Any) -> Iterator[str]:
    if isinstance(value, str):
        yield value
    elif isinstance(value, (list, dict)):
        for one in value.values() if isinstance(value, dict) else value:
            yield from texts(one)


def test_a_scene_has_everything(pages: dict[str, Page]) -> None:
    """Equations, orbit, data, accuracy, pictures, gates, values and commands stand on a scene's page."""
    page = pages[place_of("kirchhoff/whole-motion")]
    wanted = {"equations", "orbit", "data", "accuracy", "pictures", "gates", "values", "reproduce"}
    assert wanted <= set(page.anchors)
    assert {"error-data", "polhode-data", "axis-data", "path-data", "potential-data"} <= set(
        page.figures
    )
    assert "<math" in page.text


@pytest.mark.parametrize(
    ("page", "wanted"),
    [
        ("index.html", "median error, u"),
        ("index.html", "Largest error over attainable"),
        ("solvers.html", "6 digits"),
        ("extremes.html", "The worst that a search has found"),
        ("controls.html", "What it proves"),
        ("errata.html", "as transcribed"),
        ("errata.html", "True on a condition"),
        ("errata.html", "Neither true nor false"),
        ("method.html", "What is not tested"),
    ],
)
def test_what_a_page_takes_from_another_is_there(
    pages: dict[str, Page], page: str, wanted: str
) -> None:
    """A part of a published file that a page shows is found by its heading; a new one would lose it."""
    assert wanted in pages[page].text


def test_exact_values_are_a_trajectory(report: Path, tmp_path: Path) -> None:
    """Values copied from a page are a file that `check` reads, with every digit of the portrait."""
    found = Report(report)
    scene = "kirchhoff/whole-motion"
    prose = Prose(Links(report, {}, {scene: place_of(scene)}))
    links = Links(report, {}, {scene: place_of(scene)})
    context = ScenePage(found, prose, links, Palette()).context(scene)
    file = tmp_path / "copied.csv"
    file.write_text(context["values"] + "\n", encoding="utf-8")
    read_back = read(str(file))
    portrait = found.portrait(scene)
    assert portrait is not None
    rows = portrait["values"]["rows"]
    assert list(read_back.times) == [Fraction(row["t"]) for row in rows]
    first = context["values"].splitlines()[1].split(",")
    assert [text.strip() for text in first[1:4]] == rows[0]["linear_impulse"]


def test_the_polhode_lies_on_its_ellipsoid(report: Path) -> None:
    """Every omega of the course satisfies omega.I omega = 2T to the digits of the surface."""
    portrait = Report(report).portrait("euler/with-attitude")
    assert portrait is not None
    figure = motion.polhode(portrait, None)
    assert figure is not None
    ball = figure.drawings[0].traces[0]["ball"]
    for omega in portrait["course"]["omega"]:
        along = [sum(a * w for a, w in zip(axis, omega, strict=True)) for axis in ball["axes"]]
        square = sum((w / s) ** 2 for w, s in zip(along, ball["semi"], strict=True))
        # Semi-axes and directions have four digits, and enter squared.
        assert abs(square - 1) <= 2e-3


def test_a_loaded_body_has_no_ellipsoid(report: Path) -> None:
    """Under a moment the energy is not kept: the curve of omega stands alone."""
    portrait = Report(report).portrait("euler/constant-moment")
    assert portrait is not None
    figure = motion.polhode(portrait, None)
    assert figure is not None
    assert {trace["type"] for trace in figure.drawings[0].traces} == {"scatter3d"}


@given(st.lists(st.tuples(*[st.floats(-1, 1)] * 3), min_size=3, max_size=60), st.floats(1e-3, 0.2))
def test_a_thinned_curve_is_the_same_curve(rows: list[tuple[float, ...]], part: float) -> None:
    """Every point that was left out is within the tolerance of the chord between its neighbours."""
    kept = motion.thinned(rows, part)
    extent = max(max(row[i] for row in rows) - min(row[i] for row in rows) for i in range(3))
    assert (kept[0], kept[-1]) == (0, len(rows) - 1)
    for first, last in pairwise(kept):
        for k in range(first + 1, last):
            # A thousand points of the chord come within its length / 2000 of the nearest one.
            chord = [on_chord(rows[first], rows[last], n / 1000) for n in range(1001)]
            near = min(dist(rows[k], point) for point in chord)
            assert near <= part * extent + dist(rows[first], rows[last]) / 2000 + 1e-12


def on_chord(one: tuple[float, ...], other: tuple[float, ...], part: float) -> list[float]:
    return [a + part * (b - a) for a, b in zip(one, other, strict=True)]


def test_digits_left() -> None:
    """10^-n leaves n digits, one or more leaves none, and what was not run has no number."""
    assert [work.digits_left(error) for error in (1e-6, 2e-6, 1.0, 30.0)] == [6, 5, 0, 0]
    assert work.digits_left(None) is None


# Words, formulas, links


def prose(folder: Path) -> Prose:
    pages = {"tables/README.md": "tables/index.html", "claims.md": "claims.html"}
    return Prose(Links(folder, pages, {"euler/generic": "scenes/euler-generic.html"}))


def test_a_scene_in_a_table_leads_to_its_page(tmp_path: Path) -> None:
    """A code span that is a scene's name is a link; another one, or one within a link, is none."""
    found = prose(tmp_path).html("`euler/generic` and `omega`", "tables/x.md", "tables/x.html")
    assert 'href="../scenes/euler-generic.html"' in found
    assert found.count("<a ") == 1
    within = prose(tmp_path).html("[`euler/generic`](https://a.b)", "x.md", "x.html")
    assert within.count("<a ") == 1


def test_markdown_links_lead_within_the_site(tmp_path: Path) -> None:
    """A page becomes its HTML, a folder its index; what lies outside the report gets no link."""
    (tmp_path / "data").mkdir()
    (tmp_path / "data" / "worst.json").write_text("{}", encoding="utf-8")
    links = {
        "[a](../claims.md#errata)": 'href="../claims.html#errata"',
        "[a](README.md)": 'href="index.html"',
        "[a](../tables)": 'href="index.html"',
        "[a](../data/worst.json)": 'href="../data/worst.json"',
    }
    for markdown, expected in links.items():
        assert expected in prose(tmp_path).html(markdown, "tables/x.md", "tables/x.html")
    for markdown in ("[a](../../verify/taylor_verify/run.py)", "[a](../data/none.json)"):
        assert "<a" not in prose(tmp_path).html(markdown, "tables/x.md", "tables/x.html")


def test_a_file_name_becomes_a_title(tmp_path: Path) -> None:
    """A link that shows nothing but its own path shows the title of the page instead."""
    (tmp_path / "claims.md").write_text("# What *they* claim\n", encoding="utf-8")
    found = prose(tmp_path).html("[claims.md](claims.md) [these](claims.md)", "x.md", "x.html")
    assert re.findall(r">([^<>]+)</a>", found) == ["What they claim", "these"]


def test_somebody_elses_html_is_text(tmp_path: Path) -> None:
    """Markup in the Markdown is shown and never taken for a part of the page."""
    found = prose(tmp_path).html("<script>alert(1)</script>", "x.md", "x.html")
    assert "<script" not in found


def test_ways() -> None:
    """A way leads from the folder of a page; a percent sign in a name is no escape in it."""
    assert way("scenes/a.html", "index.html") == "../index.html"
    assert way("index.html", "scenes/a.html") == "scenes/a.html"
    assert way("index.html", "scenes/_a%20b.html") == "scenes/_a%2520b.html"


def test_formulas_are_set() -> None:
    """Bold and upright letters have characters of their own, functions have room, words can break."""
    assert "\N{MATHEMATICAL BOLD SMALL X}" in mathml(r"\mathbf x")
    assert "\N{MATHEMATICAL BOLD ITALIC SMALL OMEGA}" in mathml(r"\boldsymbol\omega")
    assert "\N{MATHEMATICAL SANS-SERIF CAPITAL R}" in mathml(r"\mathsf R")
    assert re.search(r"<mspace[^>]*/><mi>sin</mi><mspace", mathml(r"F\sin\theta"))
    words = inline(r"\text{for } M = 0 \text{ it is <so>}")
    assert words.startswith("for ")
    assert words.endswith("it is &lt;so&gt;")
    with pytest.raises(ValueError, match=r"expected LaTeX, got '\\\\frac"):
        mathml(r"\frac{1}{")


def test_anchors_are_githubs() -> None:
    """Headings have the anchors that links in the Markdown ask for."""
    taken: dict[str, int] = {}
    assert slug_of("How to read a cell", taken) == "how-to-read-a-cell"
    assert slug_of("Euler, by `taylor`", taken) == "euler-by-taylor"
    assert slug_of("How to read a cell", taken) == "how-to-read-a-cell-1"


def test_sections() -> None:
    """A file parts at its second headings, and nothing of it is lost."""
    text = "# a\n\nb\n\n## c\n\nd\n\n### e\n\n## f\n"
    found = sections(text)
    assert list(found) == ["", "c", "f"]
    assert "".join(found.values()) == text


# Colours, files


def test_lines_stand_out_in_both_themes() -> None:
    """Every rung and solver has the contrast of 3 of WCAG 2.1 (1.4.11) on light paper and on dark."""
    palette = Palette()
    names = [palette.rung(rung) for rung in ("f32", "f64", "f80", "f128", "mp237")]
    names += [palette.family(f"scipy {name}", "f64") for name in ("RK45", "DOP853", "BDF")]
    names += [palette.line(n) for n in range(6)]
    found = palette.document()
    for name in (token.removeprefix("$") for token in names):
        assert contrast(found["light"][name], PAPER) >= LINE_CONTRAST, name
        assert contrast(found["dark"][name], DARK_PAPER) >= LINE_CONTRAST, name


def test_the_site_is_the_same_every_time(report: Path, site: dict[str, str | bytes]) -> None:
    """Made again from the same folder, no byte differs."""
    assert contents(report) == site


def test_a_folder_of_somebody_else_is_left_alone(report: Path, tmp_path: Path) -> None:
    """A target with other files is refused, and what is in it stays."""
    mine = tmp_path / "notes.txt"
    mine.write_text("mine", encoding="utf-8")
    with pytest.raises(ValueError, match="expected a folder that is empty or has an earlier site"):
        build(report, tmp_path)
    assert mine.read_text(encoding="utf-8") == "mine"


def test_the_command_says_what_is_missing(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """`publish --site` of a folder without verdicts names the file that it wants, and ends with 2."""
    arguments = ["publish", "--from", str(tmp_path), "--site", str(tmp_path / "site")]
    assert main(arguments) == 2
    assert "verdicts.json" in capsys.readouterr().err
    assert not (tmp_path / "site").exists()


def test_a_site_of_committed_files_alone_is_whole(
    report: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Without records and portraits each scene has its page and all links resolve; that is said."""
    place = tmp_path / "clone"
    bulk = ("records", "portraits", "*.pdf", "gates.*")
    shutil.copytree(report, place, ignore=shutil.ignore_patterns(*bulk))
    assert main(["publish", "--from", str(place), "--site", str(tmp_path / "site")]) == 0
    said = capsys.readouterr().err
    assert "without 10 records of runs, 5 portraits of scenes: `taylor-verify publish" in said
    target = tmp_path / "site"
    files = {file.relative_to(target).as_posix(): file for file in target.rglob("*.*")}
    read = {name: file.read_text("utf-8") for name, file in files.items() if name.endswith(".html")}
    pages = {name: Page(text) for name, text in read.items()}
    assert {place_of(scene) for scene in SCENES} < set(pages)
    links_resolve(pages, files)
