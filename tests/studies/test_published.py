"""What is published in reports is current, complete and small: no other test reads its pages.

The files that the repository does not hold are no part of it here, whether they are there or not.
"""

from __future__ import annotations

import csv
import json
import re
import shutil
from collections.abc import Iterator
from fnmatch import fnmatch
from functools import cache
from itertools import product
from pathlib import Path
from typing import Any

import pytest
from builders import reports
from builders.verdicts import row as baseline_row
from builders.verdicts import violations

from taylor_verify.batch.differences import FACTOR, LEVEL, Direction, compare
from taylor_verify.batch.earlier_file import read_baseline
from taylor_verify.plotting.picture import Picture, content
from taylor_verify.records import store
from taylor_verify.records.precisions import LADDER
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict
from taylor_verify.scenes.library import EXTREMES, names
from taylor_verify.scenes.reading.reader import load
from taylor_verify.words.page_parts import MADE_BY
from taylor_verify_reports.claims.ledger import claims
from taylor_verify_reports.claims.numbers import CITED
from taylor_verify_reports.studies import claims_page, registry
from taylor_verify_reports.studies import published_report as report
from taylor_verify_reports.studies.bulk import patterns
from taylor_verify_reports.studies.controls import controls_page as controls
from taylor_verify_reports.studies.controls.sight import CONTROLS
from taylor_verify_reports.studies.enclosure_width import ENCLOSURE, SCENES
from taylor_verify_reports.studies.engines import document as board
from taylor_verify_reports.studies.engines.entry import BOARDS
from taylor_verify_reports.studies.growth import growth_page as growth
from taylor_verify_reports.studies.hard.hard_scenes import HARD
from taylor_verify_reports.studies.paper.pack import pack
from taylor_verify_reports.studies.reference import reference_page as reference_files
from taylor_verify_reports.studies.site.builder import build
from taylor_verify_reports.studies.stored import Stored
from taylor_verify_reports.studies.tradeoff import trades
from taylor_verify_reports.typesetting.paper import images

ROOT = Path(__file__).resolve().parents[2]
REPORTS = ROOT / "reports"
MEGABYTE = 1_000_000
# What a user's own runs and the site put there.
LOCAL = ("local/", "site/", ".")


@cache
def committed() -> tuple[str, ...]:
    """Every published file but those that the repository does not hold, by its path."""
    paths = (file.relative_to(REPORTS).as_posix() for file in REPORTS.rglob("*") if file.is_file())
    return tuple(
        sorted(
            path
            for path in paths
            if not (path.startswith(LOCAL) or "__pycache__/" in path or is_bulk(path))
        )
    )


def is_bulk(path: str) -> bool:
    return any(
        fnmatch(f"reports/{path}", f"reports/{pattern}{'*' if pattern.endswith('/') else ''}")
        for pattern in patterns()
    )


@cache
def verdicts() -> tuple[Verdict, ...]:
    return store.load(REPORTS)


def text_of(path: str) -> str:
    return (REPORTS / path).read_text(encoding="utf-8")


@pytest.fixture
def clone(tmp_path: Path) -> Path:
    """The published folder as a clone has it, with the two pages beside it that quote it."""
    for path in committed():
        place = tmp_path / "reports" / path
        place.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(REPORTS / path, place)
    (tmp_path / "docs").mkdir()
    for page in ("README.md", "docs/results.md"):
        shutil.copy(ROOT / page, tmp_path / page)
    return tmp_path / "reports"


# What is there.


def test_a_repository_one_likes_to_receive() -> None:
    """The published files are at most 250 and at most 9 MB."""
    assert len(committed()) <= 250
    assert sum((REPORTS / path).stat().st_size for path in committed()) <= 9 * MEGABYTE


def test_git_leaves_out_what_is_made() -> None:
    """.gitignore lists the bulk of the reports, and .gitattributes calls the rest generated."""
    ignored = (ROOT / ".gitignore").read_text(encoding="utf-8").splitlines()
    assert {f"reports/{pattern}" for pattern in patterns()} <= set(ignored)
    attributes = (ROOT / ".gitattributes").read_text(encoding="utf-8").splitlines()
    assert "reports/** linguist-generated" in attributes


def test_every_link_leads_to_a_committed_file() -> None:
    """No page of reports, of docs or of the README links to a file that a clone does not have."""
    pages = [REPORTS / path for path in committed() if path.endswith(".md")]
    # What `make docs` has built is nobody's page.
    docs = [file for file in (ROOT / "docs").glob("**/*.md") if "_build" not in file.parts]
    pages += [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *docs]
    assert len(pages) > 30
    assert [lost for page in pages for lost in dead_links(page)] == []


def dead_links(page: Path) -> Iterator[str]:
    # Within code and formulas brackets are no links.
    text = re.sub(r"`[^`]*`", "", page.read_text(encoding="utf-8"))
    for link in re.findall(r"\]\((?!https?:|mailto:|#)([^)#\s]+)", text):
        target = (page.parent / link).resolve()
        is_published = target.is_relative_to(REPORTS) and target.is_file()
        made_only = is_published and target.relative_to(REPORTS).as_posix() not in committed()
        if not target.exists() or made_only:
            yield f"{link} @ {page}"


def test_no_other_test_reads_what_is_published() -> None:
    """Tests of code make their data; vectors, and scripts about engines, are read where they lie.

    Those in a browser look at the pages that `make test-site` has made, in a folder of their own.
    """
    reading = {
        file.name
        for file in Path(__file__).parents[1].rglob("*.py")
        if file.parent.name != "site"
        and re.search(r"""(ROOT|\]) / "reports["/]""", file.read_text(encoding="utf-8"))
    }
    board = {"test_published_board.py", "test_page.py"}
    assert reading == {"test_published.py", "test_vectors.py"} | board


# Current: what is published is what the code makes of the published data.


def test_pages_and_tables_are_made_of_the_published_data(clone: Path) -> None:
    """Made again from the data, every page, table and quotation is the one that is published."""
    before = {file: file.read_text("utf-8") for file in clone.parent.rglob("*.[mc][ds]*")}
    report.publish(clone)
    after = {file: file.read_text("utf-8") for file in before if file.exists()}
    assert [file for file in before if after.get(file) != before[file]] == []
    written = {file.relative_to(clone).as_posix() for file in clone.rglob("*") if file.is_file()}
    assert {path for path in written if not is_bulk(path)} == set(committed())


def test_the_ledger_is_made_of_the_published_rows() -> None:
    """claims.md is that of data/claims.json, entry by entry as the ledger has them."""
    stored = claims_page.CLAIMS.load(REPORTS)
    assert text_of("claims.md") == claims_page.page(stored)
    assert stored.cited == dict(CITED)
    assert text_of("claims.md").startswith(MADE_BY)
    statements = {row.id: row.statement for row in stored.claims}
    assert statements == {claim.id: claim.statement for claim in claims()}


def test_data_are_laid_out_as_the_code_writes_them() -> None:
    """Every document of data is byte for byte what would be written of its contents."""
    documents = [p for p in committed() if p.startswith("data/") and p.endswith(".json")]
    assert len(documents) > 10
    unlike = [p for p in documents if store.laid_out(json.loads(text_of(p))) != text_of(p)]
    assert unlike == []


@pytest.mark.parametrize(
    "stored",
    [
        growth.GROWTH,
        growth.LONG,
        HARD,
        ENCLOSURE,
        CONTROLS,
        claims_page.CLAIMS,
        trades.NUMBERS,
        trades.TIMINGS,
        *(places for name in BOARDS for places in board.places(name)[:2]),
    ],
    ids=lambda stored: stored.name,
)
def test_a_published_study_is_written_as_it_was(stored: Stored[Any], tmp_path: Path) -> None:
    """Keys, their order, lines and every digit are those of the committed file."""
    (file,) = stored.write(tmp_path, stored.load(REPORTS))
    assert file.read_text(encoding="utf-8") == text_of(stored.name)


def test_every_scene_is_published_as_it_is_now() -> None:
    """Verdicts have each scene of the standard set on each rung, and the digest of its text."""
    assert {(v.scene, v.rung) for v in verdicts()} == set(product(names(), LADDER))
    published = {v.scene: v.provenance["scene"] for v in verdicts()}
    assert published == {name: load(name).digest for name in names()}


def test_every_extreme_is_published_as_it_is_now() -> None:
    """Each extreme that is run is there with the digest of its text."""
    published = {v.scene: v.provenance["scene"] for v in HARD.load(REPORTS).verdicts}
    left_out = {row.scene for row in HARD.load(REPORTS).left_out}
    assert published == {name: load(name).digest for name in published}
    assert set(names(EXTREMES)) - left_out <= set(published)


def test_some_exact_trajectories_are_those_of_the_code() -> None:
    """The rows of a sixth of the scenes, and the examples, equal those computed now, byte for byte."""
    fresh_files = (reports.some_references() / reference_files.FOLDER).iterdir()
    made_now = [file for file in fresh_files if file.suffix not in (".json", ".md")]
    assert len(made_now) > len(names()) / 6
    assert [file.name for file in made_now if not is_published(file)] == []


def is_published(made: Path) -> bool:
    """A file equals the published one; where scenes share a sheet, rows of some of them are in it."""
    published = published_reference(made.name)
    if made.name == "loads.csv":
        every = filled_columns(published)
        return all(row in every for row in filled_columns(made.read_bytes()))
    return made.read_bytes() == published


def filled_columns(sheet: bytes) -> list[dict[str, str]]:
    """Each row of a sheet by its columns; which others are empty depends on the scenes in the sheet."""
    rows = csv.DictReader(sheet.decode("utf-8").splitlines())
    return [{name: value for name, value in row.items() if value} for row in rows]


def published_reference(name: str) -> bytes:
    return (REPORTS / reference_files.FOLDER / name).read_bytes()


@pytest.mark.slow
def test_exact_trajectories_are_those_of_the_code() -> None:
    """Each CSV, the page and the examples equal those computed now, byte for byte."""
    fresh_files = (reports.every_reference() / reference_files.FOLDER).iterdir()
    made_now = {
        f"{reference_files.FOLDER}/{f.name}": f.read_bytes()
        for f in fresh_files
        if f.suffix != ".json"
    }
    published = [path for path in committed() if path.startswith(reference_files.FOLDER)]
    assert set(made_now) == set(published)
    assert [path for path in published if (REPORTS / path).read_bytes() != made_now[path]] == []


@cache
def drawable() -> tuple[Picture, ...]:
    """Return each picture drawn from published data."""
    return tuple(registry.pictures(REPORTS))


def published_as(picture: Picture) -> Path:
    return REPORTS / "figures" / f"{picture.stem}.svg"


def test_a_picture_of_each_kind_is_drawn_of_the_published_data() -> None:
    """The smallest picture of each drawing function equals the published file, byte for byte."""
    kinds: dict[Any, list[Picture]] = {}
    for picture in drawable():
        kinds.setdefault(picture.figure.func, []).append(picture)
    assert len(kinds) >= 6
    for same in kinds.values():
        picture = min(same, key=lambda one: published_as(one).stat().st_size)
        assert content(picture, "svg") == published_as(picture).read_bytes(), picture.stem


def test_every_published_picture_can_be_drawn_again() -> None:
    """`publish --paper` draws all of them, so that `make release-data` has a PDF of each."""
    drawn = {picture.stem for picture in drawable()}
    assert {file.stem for file in (REPORTS / "figures").glob("*.svg")} <= drawn


# What other pages quote.


def test_the_docs_have_the_short_table_of_the_controls() -> None:
    """The block of docs/results.md is the one made from the published rows, to the letter."""
    page = (ROOT / "docs" / "results.md").read_text(encoding="utf-8")
    shown = page[page.index(controls.BEGIN) : page.index(controls.END) + len(controls.END)]
    assert shown == controls.short(CONTROLS.load(REPORTS))


# The published numbers.


def test_published_rows_are_of_the_schema() -> None:
    """A row of each quantity, status and precision, with what is made of its keys, is of the schema."""
    kinds = {(v.quantity, v.verdict, v.rung): v for v in verdicts()}
    assert len(kinds) > 50
    rows = [verdict.row() for verdict in kinds.values()]
    counts = {status.value: 0 for status in Status}
    assert violations({"verdicts": rows, "summary": counts}) == []


def test_errors_agree_with_their_ratios() -> None:
    """The ratio of a published error at its own time is at most the largest of all samples."""
    scored = [v for v in verdicts() if v.attainable and v.max is not None]
    assert scored
    # The three are rounded to doubles on their own.
    assert [v for v in scored if not v.max / v.attainable <= v.ratio * (1 + 1e-12)] == []


def test_unlike_rungs_are_in_one_class() -> None:
    """Errors in units of attainable ones are in one class on all rungs, which are independent draws.

    No rung as a baseline raises a false alarm against another one, over hundreds of pairs."""
    drawn: dict[tuple[str, str], list[float]] = {}
    for verdict in verdicts():
        assert verdict.ratio is not None
        drawn.setdefault((verdict.scene, verdict.quantity), []).append(verdict.ratio)
    pairs = [pair for same in drawn.values() for pair in product(same, repeat=2)]
    assert len(pairs) > 1000
    assert [pair for pair in pairs if max(pair) > FACTOR * max(LEVEL, min(pair))] == []
    rows = [(baseline_row(was), baseline_row(now)) for was, now in pairs]
    assert [pair for pair in rows if compare([pair[0]], [pair[1]]).towards(Direction.WORSE)] == []


def test_published_rows_are_no_departures_from_themselves() -> None:
    """Every row is in its own rounding class and no regression, read as a report or as a baseline."""
    baseline = read_baseline(REPORTS / "data" / "verdicts.json")
    read, edited = baseline.verdicts, baseline.edited
    assert edited is False
    for rows in (verdicts(), read):
        compared = compare(rows, rows)
        assert (compared.compared, compared.all) == (len(rows), ())
        assert rows
    keys = [(v.scene, v.rung, v.quantity, v.max, v.ratio) for v in verdicts()]
    assert [(v.scene, v.rung, v.quantity, v.max, v.ratio) for v in read] == keys


def test_published_widths_are_above_the_true_errors() -> None:
    """No true error of an enclosure is larger than the width that is proven."""
    study = ENCLOSURE.load(REPORTS)
    assert {row.scene for row in study.rows} == set(SCENES)
    assert all(row.error <= row.width for row in study.rows)


# What is made of all of them.


@pytest.mark.slow
def test_the_published_paper_is_short(tmp_path: Path) -> None:
    """The paper has at most twelve pages."""
    made = pack(REPORTS)
    made.write(tmp_path)
    assert len(images(made.text, made.citation, tmp_path)) <= 12


@pytest.mark.slow
def test_the_whole_site_is_small(clone: Path, tmp_path: Path) -> None:
    """All that is published fits in 20 MB, and every scene has its page."""
    files = build(clone, tmp_path / "site")
    assert sum(file.stat().st_size for file in files) < 20 * MEGABYTE
    scenes = {file.stem for file in files if file.parent.name == "scenes"}
    assert len(scenes) == len(names())
    assert build(clone, tmp_path / "site") == files
