"""Words of the glossary: each linked word is defined, and every page links its first use."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest
from builders.worked import DOCS

from taylor_verify_reports.studies.site.glossary import TERMS

HEADINGS = re.findall(r"^## (.+)$", (DOCS / "glossary.md").read_text("utf-8"), re.MULTILINE)
CONF = "from taylor_verify_reports.studies.site.conf import *\n"
INDEX = """\
# A rung in a heading

The `ball`, a ball, and balls on two rungs; a [regime](other.md).

| rung |
|---|
| ball |

```{toctree}
glossary
other
```
"""
OTHER = "# Other\n\nNo [rung](glossary.md#rung) is a ball-room. A rung, the regime.\n"
WORDS = (
    "# Glossary\n\n## rung\n\nA rung is no ball.\n\n## ball\n\nRound.\n\n## regime\n\nOne word.\n"
)


def test_every_linked_term_is_defined() -> None:
    """Each linked term is a heading of the glossary."""
    assert set(TERMS) <= set(HEADINGS)


def test_the_glossary_is_in_order() -> None:
    """Words are sorted, and none is there twice."""
    assert [*HEADINGS] == sorted(set(HEADINGS), key=str.lower)


@pytest.mark.parametrize("term", TERMS)
def test_a_definition_is_in_plain_words(term: str) -> None:
    """A definition is one or more sentences, and does not lean on its own word alone."""
    text = (DOCS / "glossary.md").read_text(encoding="utf-8")
    definition = text.split(f"\n## {term}\n")[1].split("\n## ")[0].strip()
    assert definition.endswith(".")
    assert len(definition.split()) >= 8
    assert re.fullmatch(TERMS[term], term)


@pytest.fixture(scope="module")
def pages(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """Three pages made by Sphinx, by name."""
    place = tmp_path_factory.mktemp("terms")
    files = {"conf.py": CONF, "index.md": INDEX, "other.md": OTHER, "glossary.md": WORDS}
    for name, text in files.items():
        (place / name).write_text(text, encoding="utf-8")
    command = [sys.executable, "-m", "sphinx", "-W", "-q", str(place), str(place / "made")]
    done = subprocess.run(command, capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "")
    made = {page.stem: page.read_text(encoding="utf-8") for page in (place / "made").glob("*.html")}
    return {
        name: text.partition("<article")[2].partition("</article")[0] for name, text in made.items()
    }


def links(page: str) -> list[tuple[str, str]]:
    return re.findall(r'<a class="term[^"]*" href="glossary.html#([\w-]+)">([^<]+)</a>', page)


def test_the_first_use_is_a_link(pages: dict[str, str]) -> None:
    """The first word in a sentence leads to its definition; code, headings, tables and links do not."""
    assert links(pages["index"]) == [("ball", "ball"), ("rung", "rungs")]


def test_a_link_of_the_page_itself_counts(pages: dict[str, str]) -> None:
    """A term that the page links by hand is linked once, and a word within another one is none."""
    assert links(pages["other"]) == [("regime", "regime")]


def test_the_glossary_does_not_link_to_itself(pages: dict[str, str]) -> None:
    """Definitions stand as they are written."""
    assert links(pages["glossary"]) == []


def test_links_written_by_hand_lead_to_a_heading() -> None:
    """Each link to the glossary leads to an existing heading."""
    slugs = {re.sub(r"[^\w -]", "", word.lower()).replace(" ", "-") for word in HEADINGS}
    for page in sorted(Path(DOCS).rglob("*.md")):
        named = re.findall(r"glossary\.md#([\w-]+)", page.read_text(encoding="utf-8"))
        assert set(named) <= slugs, page.name
