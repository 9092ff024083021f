"""The front pages: what a reader types works, and what the pages show is what is printed."""

from __future__ import annotations

from pathlib import Path

import pytest
from builders.worked import DOCS, Untrue, blocks, work

FRONT_PAGES = sorted((DOCS / "for").glob("*.md"))
NAMES = ("engine-author", "integrator-author", "satellite", "teacher", "vehicle")


@pytest.fixture(autouse=True)
def _as_a_reader(monkeypatch: pytest.MonkeyPatch) -> None:
    """A folder of one's own, and no CI behind it: pytest and GitHub's runner add lines of theirs."""
    for name in ("CI", "BUILD_NUMBER", "GITHUB_STEP_SUMMARY", "PYTEST_ADDOPTS"):
        monkeypatch.delenv(name, raising=False)


# They judge several files and look for the cause of each error.
LONG = ("engine-author", "integrator-author", "satellite", "vehicle")
PAGES = [
    pytest.param(page, id=page.stem, marks=[pytest.mark.slow] if page.stem in LONG else [])
    for page in FRONT_PAGES
]


@pytest.mark.parametrize("page", PAGES)
def test_a_front_page_is_true(page: Path, tmp_path: Path) -> None:
    """Worked from top to bottom in an empty folder, every block does what the page says."""
    assert work(page, tmp_path) >= 5


def test_each_reader_has_a_front_page() -> None:
    """Engine, integrator, satellite, class, vehicle; each says what is known in the end."""
    assert tuple(page.stem for page in FRONT_PAGES) == NAMES
    assert all("## What you know now\n" in page.read_text(encoding="utf-8") for page in FRONT_PAGES)


def test_every_command_of_a_front_page_is_run() -> None:
    """No block of commands or of Python is in a form that the reading of pages passes over."""
    for page in FRONT_PAGES:
        text, lists = page.read_text(encoding="utf-8"), "```{toctree}"
        fences = text.count("```") - 2 * text.count(lists)
        assert fences == 2 * sum(block.language != "given" for block in blocks(text))
        assert "~~~" not in text


# What must be found untrue.


@pytest.mark.parametrize(
    "page",
    [
        "```python\nprint(1)\n```\n\n```text\n2\n```\n",
        "```python\nprint(1)\n```\n",
        "```console\n$ false\n$ echo $?\n0\n```\n",
        "```console\n$ taylor-verify exact euler/generic --at never\n$ echo $?\n0\n```\n",
        "```python\n# a.py\nx = 1\n```\n\n```diff\n--- a.py\n+++ a.py\n@@\n-x = 2\n+x = 3\n```\n",
    ],
)
def test_an_untrue_page_fails(page: str, tmp_path: Path) -> None:
    """Another output, one that is not shown, another exit status, a change that fits nowhere."""
    file = tmp_path / "page.md"
    file.write_text(page, encoding="utf-8")
    with pytest.raises(Untrue, match=r"page\.md|not show"):
        work(file, tmp_path)
