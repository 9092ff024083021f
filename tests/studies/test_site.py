"""The site without a browser: what every page must have, and what its pictures are made of."""

from __future__ import annotations

import re
import shutil
from collections.abc import Collection, Mapping
from fractions import Fraction
from html import unescape
from html.parser import HTMLParser
from pathlib import Path, PurePosixPath
from urllib.parse import unquote

import pytest
from builders import reports
from builders.reports import SCENES
from markdown_it import MarkdownIt

from taylor_verify.cli import main
from taylor_verify.solvers.files.file import read
from taylor_verify_reports.studies.portraits.stored_portraits import PORTRAITS
from taylor_verify_reports.studies.site import builder
from taylor_verify_reports.studies.site.builder import build, contents
from taylor_verify_reports.studies.site.pages import front
from taylor_verify_reports.studies.site.scene_page import scene_page
from taylor_verify_reports.studies.site.stage import Stage
from taylor_verify_reports.studies.source import Report
from taylor_verify_reports.typesetting.mathml import inline, mathml

CONF = "from taylor_verify_reports.studies.site.conf import *\n"
INDEX = """\
# Docs

```{toctree}
:maxdepth: 1
:caption: Explanation

method
```
"""
METHOD = """\
# How it is done

As [the controls](../reports/tables/controls.md#what-each-gate-sees) show, with $`a^2`$,
for `euler/with-attitude`. The [data](../reports/data/verdicts.json), [the source](../notes.txt),
[nothing](../none.txt).

```{include} ../MORE.md
```
"""
MORE = "See [the list](docs/index.md) and [the report](reports/README.md).\n"

# Building a site takes many seconds: `make test-site` runs these tests.
building = pytest.mark.slow

# What a clone of the repository lacks.
BULK = ("records", "portraits", "*.pdf", "gates.*")


@pytest.fixture(scope="module")
def report() -> Path:
    return reports.small()


@pytest.fixture(scope="module")
def checkout(report: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with docs of one page beside the report."""
    place = tmp_path_factory.mktemp("checkout")
    shutil.copytree(report, place / "reports")
    files = {"docs/conf.py": CONF, "docs/index.md": INDEX, "docs/method.md": METHOD}
    (place / "docs").mkdir()
    for name, text in {**files, "MORE.md": MORE, "notes.txt": "of the checkout"}.items():
        (place / name).write_text(text, encoding="utf-8")
    return place


@pytest.fixture(scope="module")
def site(checkout: Path) -> dict[str, str | bytes]:
    return contents(checkout / "reports")


@pytest.fixture(scope="module")
def pages(site: dict[str, str | bytes]) -> dict[str, Page]:
    return {name: Page(str(text)) for name, text in site.items() if name.endswith(".html")}


class Page(HTMLParser):
    """The links and anchors of a page, as a browser would find them."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.text = text
        self.links: list[str] = []
        self.loads: list[str] = []
        self.anchors: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        attributes = dict(attrs)
        if attributes.get("id"):
            self.anchors.append(str(attributes["id"]))
        if tag == "a" and attributes.get("href"):
            self.links.append(str(attributes["href"]))
        if tag in ("script", "img", "link", "iframe") and (
            link := attributes.get("src") or attributes.get("href")
        ):
            self.loads.append(link)

    @property
    def navigation(self) -> str:
        """The list of pages beside the page."""
        return self.text.partition('<div class="sidebar-tree">')[2].partition("</aside>")[0]


def place_of(scene: str) -> str:
    return f"reports/scenes/{scene.replace('/', '-')}.html"


@building
def test_links_resolve(site: dict[str, str | bytes], pages: dict[str, Page]) -> None:
    """All links within the site lead to its files and to existing anchors."""
    links_resolve(pages, site)


def links_resolve(pages: Mapping[str, Page], site: Collection[str]) -> None:
    for name, page in pages.items():
        for link in page.links + page.loads:
            if link.startswith(("http://", "https://", "data:", "mailto:")):
                continue
            path, _, anchor = unquote(link).partition("?")[0].partition("#")
            target = resolved(name, path) if path else name
            assert target in site, f"{link} @ {name}"
            if anchor and target in pages:
                assert anchor in pages[target].anchors, f"{link} @ {name}"


def resolved(page: str, link: str) -> str:
    parts: list[str] = list(PurePosixPath(page).parent.parts)
    for part in link.split("/"):
        parts = parts[:-1] if part == ".." else [*parts, part]
    return "/".join(parts)


@building
def test_nothing_comes_from_a_network(site: dict[str, str | bytes], pages: dict[str, Page]) -> None:
    """No page loads a script, a style, a picture or a font from an address, and no style asks for one."""
    for name, page in pages.items():
        assert not [load for load in page.loads if "//" in load.removeprefix("data:")], name
    sheets = {n: text_of(t) for n, t in site.items() if n.endswith(".css")}
    assert "_static/site.css" in sheets
    for name, text in sheets.items():
        assert not re.search(r"@import|url\(\W*(?:https?:)?//", text), name
    own = [file.name for file in Path(builder.__file__).parent.glob("assets/*.js")]
    assert own
    for name in own:
        script = text_of(site[f"_static/{name}"])
        assert not re.search(r"https?:|fetch\(|XMLHttp|import\(", script), name


def text_of(content: str | bytes) -> str:
    return content.decode() if isinstance(content, bytes) else content


@building
def test_docs_and_report_have_one_navigation(pages: dict[str, Page]) -> None:
    """Pages of docs, of the report and of scenes have the same navigation, and motions have none."""
    listed = {
        name: re.findall(r'reference internal" href="[^"]*">([^<]+)<', page.navigation)
        for name, page in pages.items()
        if not name.startswith("reports/motions/")
    }
    assert len(listed) < len(pages)
    assert len({tuple(names) for names in listed.values()}) == 1
    assert {"How it is done", "Scenes", "What each gate sees"} <= set(listed["index.html"])
    assert {"docs/method.html", "reports/tables/controls.html", place_of(SCENES[0])} <= set(pages)


@building
def test_a_page_of_docs_reaches_the_rest(
    site: dict[str, str | bytes], pages: dict[str, Page]
) -> None:
    """Links lead to a page of the report, a file of it and of the checkout; one to nothing is text."""
    page = pages["docs/method.html"]
    assert "../reports/tables/controls.html#what-each-gate-sees" in page.links
    assert "../index.html" in page.links
    files = [name.rpartition("/")[2] for name in site if name.startswith("_downloads/")]
    assert {"verdicts.json.tar.xz", "notes.txt"} <= set(files)
    assert "nothing" in page.text
    assert "none.txt" not in page.text


@building
def test_anchors_are_one_of_a_kind(pages: dict[str, Page]) -> None:
    """No page has an id twice: links and labels would go to the first."""
    for name, page in pages.items():
        assert len(page.anchors) == len(set(page.anchors)), name


@building
def test_a_scene_has_everything(site: dict[str, str | bytes], pages: dict[str, Page]) -> None:
    """Equations, orbit, data, accuracy, pictures, gates, values and commands stand on a scene's page."""
    page = pages[place_of("kirchhoff/whole-motion")]
    headings = {
        "equations-of-motion",
        "the-orbit-in-numbers",
        "initial-data",
        "accuracy",
        "pictures",
    }
    headings |= {"the-arithmetic-of-the-gates", "exact-values", "how-to-reproduce-this"}
    blocks = {"scene", "exact", "commands", "motion"}
    assert headings | blocks <= set(page.anchors)
    assert "../motions/kirchhoff-whole-motion.html" in page.loads
    assert "_images/kirchhoff-whole-motion-errors.svg" in site


@building
def test_exact_values_are_a_trajectory(
    report: Path, pages: dict[str, Page], tmp_path: Path
) -> None:
    """Values copied from a page are a file that `check` reads, with every digit of the portrait."""
    scene = "kirchhoff/whole-motion"
    _, _, block = pages[place_of(scene)].text.partition('id="exact"')
    copied = unescape(re.sub(r"<[^>]+>", "", block.partition("<pre>")[2].partition("</pre>")[0]))
    file = tmp_path / "copied.csv"
    file.write_text(copied, encoding="utf-8")
    read_back = read(str(file))
    portrait = Report(report).portrait(scene)
    assert portrait is not None
    rows = portrait["values"]["rows"]
    assert list(read_back.times) == [Fraction(row["t"]) for row in rows]
    first = copied.splitlines()[1].split(",")
    assert [text.strip() for text in first[1:4]] == rows[0]["linear_impulse"]


# Words, formulas, links


def test_markdown_links_lead_within_the_site(tmp_path: Path) -> None:
    """A folder leads to its index, a file comes along, what is not there gets no link."""
    for name in ("tables/README.md", "claims.md", "data/hard.json"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text("# A title\n", encoding="utf-8")
    stage = Stage(tmp_path, None)
    expected = {
        "[a](../claims.md#errata)": "[a](../claims.md#errata)",
        "[a](README.md)": "[a](README.md)",
        "[a](../tables)": "[a](README.md)",
        "[a](../data/hard.json)": "[a](../data/hard.json)",
        "[claims](https://a.b/c.md)": "[claims](https://a.b/c.md)",
        "[a](../../verify/taylor_verify/run.py)": "a",
        "[a](../data/none.json)": "a",
    }
    for markdown, text in expected.items():
        stage.add_pages({"reports/tables/x.md": markdown})
        assert stage.files["reports/tables/x.md"] == text
    assert stage.files["reports/data/hard.json"] == b"# A title\n"


def test_somebody_elses_html_is_text(tmp_path: Path) -> None:
    """Markup in the words of a scene is shown and never taken for a part of the page."""
    markup = "<script>alert(1)</script>"
    words = {"title": markup, "why": [markup], "toml": f"# {markup}\n# ```\n{markup}"}
    reports.write_runs(tmp_path, [("euler/with-attitude", "f64")])
    PORTRAITS.write(tmp_path, [reports.portrait_without_run("euler/with-attitude") | words])
    page = scene_page("euler/with-attitude", Report(tmp_path), ())
    html = MarkdownIt("commonmark").enable("table").render(page)
    assert html.count("alert(1)") >= 4
    assert "<script>alert" not in html


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


# Colours, files


@building
def test_a_fault_of_a_page_is_an_error(report: Path, tmp_path: Path) -> None:
    """A page that Sphinx warns of ends in an error that names it, and nothing is written."""
    # Portraits and records are most of the work, and of no page that is broken here.
    bulk = shutil.ignore_patterns(*BULK)
    shutil.copytree(report, tmp_path / "report", ignore=bulk)
    page = tmp_path / "report" / "claims.md"
    page.write_text(page.read_text("utf-8") + "\n[a](#no-such-heading)\n", encoding="utf-8")
    with pytest.raises(ValueError, match=r"claims\.md.*no-such-heading"):
        build(tmp_path / "report", tmp_path / "site")
    assert not (tmp_path / "site").exists()


def test_what_is_not_installed_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A missing package is named as pip knows it, before anything is done."""
    monkeypatch.setattr(builder, "_NEEDED", ("no_such_package",))
    with pytest.raises(ImportError) as raised:
        contents(tmp_path)
    assert raised.value.name == "no-such-package"


@building
def test_the_site_is_the_same_every_time(checkout: Path, site: dict[str, str | bytes]) -> None:
    """Made again from the same folder, no byte differs."""
    assert contents(checkout / "reports") == site


def test_a_folder_of_somebody_else_is_left_alone(tmp_path: Path) -> None:
    """A target with other files is refused, and what is in it stays."""
    mine = tmp_path / "notes.txt"
    mine.write_text("mine", encoding="utf-8")
    with pytest.raises(ValueError, match="expected a folder that is empty or has an earlier site"):
        build(tmp_path, tmp_path)
    assert mine.read_text(encoding="utf-8") == "mine"


def test_the_command_says_what_is_missing(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """`publish --site` of a folder without verdicts names the file that it wants, and ends with 2."""
    arguments = ["publish", "--from", str(tmp_path), "--site", str(tmp_path / "site")]
    assert main(arguments) == 2
    assert "verdicts.json" in capsys.readouterr().err
    assert not (tmp_path / "site").exists()


@building
def test_a_site_of_committed_files_alone_is_whole(
    report: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The site without records and portraits has a page for each scene, and a message says so."""
    place = tmp_path / "clone"
    shutil.copytree(report, place, ignore=shutil.ignore_patterns(*BULK))
    assert main(["publish", "--from", str(place), "--site", str(tmp_path / "site")]) == 0
    errors = capsys.readouterr().err
    assert "without 2 tables for searching, 10 records of runs, 5 portraits of scenes" in errors
    assert "`taylor-verify publish --missing` makes" in errors
    target = tmp_path / "site"
    files = {file.relative_to(target).as_posix(): file for file in target.rglob("*.*")}
    read = {name: file.read_text("utf-8") for name, file in files.items() if name.endswith(".html")}
    pages = {name: Page(text) for name, text in read.items()}
    assert {place_of(scene) for scene in SCENES} < set(pages)
    links_resolve(pages, files)


def test_the_readme_is_the_front_page(tmp_path: Path) -> None:
    """The front page is the README of the checkout; the report stands below the page of results."""
    files = {
        "README.md": "# Read me\n",
        "docs/conf.py": CONF,
        "docs/index.md": INDEX.replace("method", "results"),
        "docs/results.md": "# Results\n",
        "reports/claims.md": "# Claims\n",
    }
    for name, text in files.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text, encoding="utf-8")
    made = front(Stage(tmp_path / "reports", tmp_path / "docs"))
    assert made["index.md"].startswith("# Read me\n")
    assert "\ndocs/results\n" in made["index.md"]
    assert "claims" not in made["index.md"]
    assert "\n/reports/claims\n" in made["docs/results.md"]


def test_the_pages_of_parts_stand_below_their_page(tmp_path: Path) -> None:
    """The navigation has the board, and the page of each engine under it; another page is its own."""
    tables = tmp_path / "tables"
    tables.mkdir()
    for name in ("engines", "engines-mujoco", "engines-drake", "hard"):
        (tables / f"{name}.md").write_text(f"# {name}\n", encoding="utf-8")
    stage = Stage(tmp_path, None)
    stage.add_pages({})
    assert stage.report_pages == ["reports/tables/engines", "reports/tables/hard"]
    board = str(stage.files["reports/tables/engines.md"])
    assert board.endswith("```{toctree}\n:hidden:\n\nengines-drake\nengines-mujoco\n```\n")
    assert "toctree" not in str(stage.files["reports/tables/hard.md"])
