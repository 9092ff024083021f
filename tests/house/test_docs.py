"""The pages of docs: built without a warning, complete, and true where they tell numbers or names."""

from __future__ import annotations

import importlib
import importlib.util
import inspect
import pkgutil
import posixpath
import re
import shlex
import subprocess
import sys
from enum import StrEnum
from pathlib import Path
from typing import Any

import pytest
from builders.pages import table_rows
from builders.processes import on_one_core
from builders.worked import DOCS, ROOT, blocks, work

import taylor_verify
from taylor_verify.cli import answer
from taylor_verify.cli.arguments import parse
from taylor_verify.draw.drawn_course import motion
from taylor_verify.draw.pictures import pictures
from taylor_verify.exact.solution import NO_CLOSED_FORM
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict
from taylor_verify.scenes.library import names
from taylor_verify.scenes.reading.reader import load
from taylor_verify.solvers.registry import FAMILIES
from taylor_verify.solvers.trajectory import Outcome

PAGES = sorted(page for page in DOCS.rglob("*.md") if "_build" not in page.parts)
PUBLIC = [
    (kind, name)
    for page in sorted((DOCS / "reference").glob("*.md"))
    for kind, name in re.findall(
        r"^\.\. auto(\w+):: ([\w.]+)", page.read_text(encoding="utf-8"), re.MULTILINE
    )
]
# What is told by its type: nothing is to be said of it.
EVIDENT = {"scene", "name", "rung", "problem", "solver", "trajectory", "verdicts", "law"}


def text_of(page: str) -> str:
    return (DOCS / page).read_text(encoding="utf-8")


# The pages.


@pytest.mark.slow
def test_the_pages_are_built_without_a_warning(tmp_path: Path) -> None:
    """Sphinx, told that warnings are errors, makes every page, as `make docs` does."""
    command = ["sphinx", "-W", "--keep-going", "-q", "-b", "html", str(DOCS), str(tmp_path)]
    done = subprocess.run([sys.executable, "-m", *command], capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "")
    made = [tmp_path / page.relative_to(DOCS).with_suffix(".html") for page in PAGES]
    assert [page for page in made if not page.exists()] == []


def listed_on(page: str) -> list[str]:
    """The pages in the lists of a page."""
    lists = re.findall(r"^```\{toctree\}\n(.*?)^```$", text_of(page), re.MULTILINE | re.DOTALL)
    names = [name for text in lists for name in re.findall(r"^[a-z./][\w./-]+$", text, re.M)]
    return [posixpath.normpath(posixpath.join(posixpath.dirname(page), name)) for name in names]


def test_every_page_is_found_from_the_first() -> None:
    """The side bar has some 25 entries, and every page stands there or below one that does."""
    first = listed_on("index.md")
    below = [name for page in first for name in listed_on(f"{page}.md")]
    pages = {page.relative_to(DOCS).with_suffix("").as_posix() for page in PAGES}
    assert sorted([*first, *below]) == sorted(pages - {"index"})
    assert len(first) <= 25
    assert first[-1] == "results"


def test_the_pages_are_short() -> None:
    """All pages have 28 thousand words at most, the README 700, a front page 600, a first change 300."""
    counts = {page: len(page.read_text(encoding="utf-8").split()) for page in PAGES}
    readme = len((ROOT / "README.md").read_text(encoding="utf-8").split())
    first, *_ = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8").split("\n## What holds")
    assert sum(counts.values()) + readme <= 28_000
    assert readme <= 700
    assert {
        page.stem for page, count in counts.items() if "for" in page.parts and count > 600
    } == set()
    assert len(first.split()) <= 300


@pytest.mark.parametrize(
    "page",
    [*PAGES, ROOT / "CONTRIBUTING.md", ROOT / "README.md"],
    ids=lambda page: page.relative_to(ROOT).as_posix(),
)
def test_every_file_that_is_linked_or_named_exists(page: Path) -> None:
    """Every link and picture of a page leads to a file of the checkout, and every path that is marked as
    one of the checkout is there; a capital NAME stands for any."""
    text = page.read_text(encoding="utf-8")
    links = re.findall(r"\]\((?!https?:)([^)#]+)", text)
    links += re.findall(r"^```\{include\} (\S+)", text, re.MULTILINE)
    assert [link for link in links if not (page.parent / link).exists()] == []
    marked = re.findall(r"`((?:verify|tests|cases|reports|docs)/[\w./-]+)`", text)
    made = ("reports/local", "reports/paper", "reports/site", "docs/_build")
    paths = [path for path in marked if "NAME" not in path and not path.startswith(made)]
    assert [path for path in paths if not (ROOT / path).exists()] == []


@pytest.mark.parametrize(
    "page",
    [
        *("columns.md", "command-line.md", "errors.md", "regimes.md"),
        *(pytest.param(name, marks=pytest.mark.slow) for name in ("enclosure.md", "sweeps.md")),
    ],
)
def test_what_a_page_shows_is_what_happens(page: str, tmp_path: Path) -> None:
    """The blocks that a page executes print what it shows."""
    assert any(block.language in {"console", "python"} for block in blocks(text_of(page)))
    with on_one_core():
        work(DOCS / page, tmp_path)


# What the pages tell.


def regimes() -> set[str]:
    """Every word that a module of taylor_verify.exact has for a regime: in an enumeration, or alone."""
    regimes_of_exact: set[str] = set()
    room = importlib.import_module("taylor_verify.exact")
    for module in pkgutil.walk_packages(room.__path__, "taylor_verify.exact."):
        for name, value in vars(importlib.import_module(module.name)).items():
            if inspect.isclass(value) and issubclass(value, StrEnum) and name.endswith("Regime"):
                regimes_of_exact |= {regime.value for regime in value}
            elif name == "REGIME":
                regimes_of_exact.add(value)
    return regimes_of_exact


def test_every_regime_is_documented() -> None:
    """The words that `regime` can be are listed where a reader looks for them."""
    kirchhoff = (
        *("rest", "steady", "four-roots", "two-roots", "cubic", "hyperbolic"),
        *("trigonometric", "algebraic", "heteroclinic", "euler-top"),
        *("planar-swing", "planar-turn", "planar-front", "planar-uniform", "planar-steady"),
    )
    euler = regimes()
    assert {"max-axis", "separatrix", "straight-moment"} <= euler
    documented = set(re.findall(r"`([\w -]+)`", text_of("regimes.md")))
    assert {*euler, *kirchhoff, NO_CLOSED_FORM} <= documented


def test_every_verdict_is_documented() -> None:
    """The table of verdicts has each status, in its order, and no other."""
    statuses = [row[0] for row in table_rows("verdicts.md")]
    assert statuses[1 : 1 + len(Status)] == [status.value for status in Status]


def test_every_field_of_a_row_is_documented() -> None:
    """Each field of a verdict stands in the list of fields."""
    defined = " ".join(re.findall(r"^`([\w ]+)`\n:", text_of("verdicts.md"), re.MULTILINE))
    assert {*Verdict.__dataclass_fields__, "because", "sentence", "digits"} == set(defined.split())


def test_the_glossary_is_in_order_and_defines_in_sentences() -> None:
    """Words are sorted, none is there twice, and each has a definition of some words."""
    _, *entries = text_of("glossary.md").split("\n## ")
    definitions = dict(entry.split("\n", 1) for entry in entries)
    assert [*definitions] == sorted(definitions, key=str.lower)
    assert len(definitions) == len(entries)
    texts = [text.strip() for text in definitions.values()]
    assert [text for text in texts if not text.endswith(".") or len(text.split()) < 8] == []


def test_every_outcome_is_documented() -> None:
    """The sentences of errors.md are those of Outcome, in its order."""
    sentences = re.findall(r"^- (.*)$", text_of("errors.md"), re.MULTILINE)
    assert sentences == [outcome.value for outcome in Outcome]


def test_every_exit_status_is_documented() -> None:
    """The table of exit statuses has each that a verb can end with."""
    numbers = [int(row[0]) for row in table_rows("errors.md") if row[0].isdigit()]
    statuses = {answer.PASS, answer.FAIL, answer.WRONG_CALL, answer.UNDECIDED, answer.INTERRUPTED}
    assert numbers == sorted(statuses)


def test_every_kind_of_solver_is_documented() -> None:
    """Each method that the command line knows by name is named; `list` names those of a folder."""
    page = text_of("command-line.md")
    for family in FAMILIES:
        assert family.prefix.rstrip("?") in page
        for name in family.names or ():
            assert name.partition("?")[0].rpartition(":")[2] in page


COMMANDS = [
    line
    for page in (*DOCS.rglob("*.md"), ROOT / "README.md")
    for block in re.findall(
        r"^```\w*\n(.*?)^```$", page.read_text("utf-8"), re.MULTILINE | re.DOTALL
    )
    for line in block.splitlines()
    if line.removeprefix("$ ").startswith("taylor-verify ")
]


@pytest.mark.parametrize("command", COMMANDS)
def test_a_command_can_be_typed(command: str) -> None:
    """Verb, options and shipped scenes are those there are."""
    call = command.removeprefix("$ ").partition(" > ")[0]
    arguments = shlex.split(call, comments=True)[1:]
    assert callable(parse(arguments).act)
    scenes = [word for word in arguments if word.startswith(("euler/", "kirchhoff/"))]
    assert [scene for scene in scenes if scene not in names()] == []


def test_the_picture_of_the_docs_is_that_of_its_command() -> None:
    """The picture of the racket shows what `draw` says of it today."""
    text = (DOCS / "pictures" / "racket.svg").read_text(encoding="utf-8")
    assert pictures(motion(load("euler/tennis-racket")), ["time"])["time"].alt in text


# The reference.


def named(name: str) -> Any:
    module, _, last = name.rpartition(".")
    return getattr(importlib.import_module(module), last)


@pytest.mark.parametrize(("kind", "name"), PUBLIC)
def test_what_the_reference_names_has_a_docstring(kind: str, name: str) -> None:
    """The object is there, is of the kind that is told, and says what it is in words of its own."""
    public = named(name)
    assert inspect.isclass(public) == (kind in {"class", "exception"})
    docstring = inspect.getdoc(public) or ""
    # A dataclass without one is given its signature.
    assert " " in docstring.removeprefix(f"{name.rpartition('.')[2]}(")
    assert docstring.partition("\n")[0].rstrip().endswith((".", ",", ":", ";"))


FUNCTIONS = [name for kind, name in PUBLIC if kind == "function"]


@pytest.mark.parametrize("name", FUNCTIONS)
def test_a_docstring_tells_of_every_argument(name: str) -> None:
    """Each argument occurs in the docstring, but for those whose type says all."""
    function = named(name)
    docstring = (function.__doc__ or "").lower()
    arguments = [a for a in inspect.signature(function).parameters if a not in EVIDENT]
    untold = [a for a in arguments if not all(w.rstrip("s") in docstring for w in a.split("_"))]
    assert untold == []


def test_every_call_is_in_the_reference() -> None:
    """The names of `import taylor_verify` are documented under those names."""
    calls = {f"taylor_verify.{name}" for name in taylor_verify.__all__ if name[0].islower()}
    assert calls <= {name for _, name in PUBLIC}
