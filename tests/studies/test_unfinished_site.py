"""A site that was interrupted goes on with what is finished, and with nothing that has a fault."""

from __future__ import annotations

from pathlib import Path

import pytest
from matplotlib.figure import Figure

from taylor_verify.plotting.picture import Picture
from taylor_verify_reports.studies import finished_parts as folders
from taylor_verify_reports.studies.site import pages, site_work
from taylor_verify_reports.studies.site.site_work import Work

PICTURES = [Picture(stem, stem, stem, Figure) for stem in ("one", "two")]
SOURCES = {"index.md": "# One\n"}


@pytest.fixture(autouse=True)
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(folders, "user_cache_path", lambda name: tmp_path / name)
    return tmp_path


def make_page(report: Path, error: type[BaseException] | None = None) -> list[str]:
    """Make a page where there is none, and return the pages that were there; end in an error."""
    with site_work.unfinished(report) as work:
        work.source(SOURCES)
        there = [file.name for file in work.made.glob("*")]
        work.made.mkdir(exist_ok=True)
        (work.made / "index.html").touch()
        if error is not None:
            raise error
    return there


def test_pages_stay_after_an_interrupt_alone(tmp_path: Path) -> None:
    """An error leaves none, because Sphinx would not read a page with a fault again; the end neither."""
    with pytest.raises(KeyboardInterrupt):
        make_page(tmp_path, KeyboardInterrupt)
    with pytest.raises(ZeroDivisionError):
        make_page(tmp_path, ZeroDivisionError)
    assert make_page(tmp_path) == []
    with pytest.raises(KeyboardInterrupt):
        make_page(tmp_path, KeyboardInterrupt)
    assert make_page(tmp_path) == ["index.html"]
    assert make_page(tmp_path) == []


def test_pages_of_other_sources_are_made_anew(tmp_path: Path) -> None:
    """Another byte of any source removes all pages; the same sources leave all files as they are."""
    work = Work(tmp_path / "site")
    source = work.source(SOURCES)
    before = (source / "index.md").stat().st_mtime_ns
    work.made.mkdir()
    assert work.source(SOURCES) == source
    assert (source / "index.md").stat().st_mtime_ns == before
    assert work.made.exists()
    work.source({"index.md": "# Two\n"})
    assert not work.made.exists()


def test_a_picture_is_drawn_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A drawing that was made before an interrupt is not made again."""
    stored, drawn = Work(tmp_path / "site").drawings, list[str]()

    def svg(picture: Picture) -> str:
        drawn.append(picture.stem)
        if picture.stem == "two" and len(drawn) == 2:
            raise KeyboardInterrupt
        return f"<svg>{picture.stem}</svg>"

    monkeypatch.setattr(pages, "dumps", lambda picture: picture.stem.encode())
    monkeypatch.setattr(pages, "_svg", svg)
    with pytest.raises(KeyboardInterrupt):
        pages._drawn(PICTURES, stored)
    made = pages._drawn(PICTURES, stored)
    assert made == {"one.svg": "<svg>one</svg>", "two.svg": "<svg>two</svg>"}
    assert drawn == ["one", "two", "two"]
