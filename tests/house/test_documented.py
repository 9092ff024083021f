"""Completeness of the docs: every verb, option, key, word, error and public call has its place.

Each list is made from the code, so that a name that is new and nowhere explained fails here.
"""

from __future__ import annotations

import builtins
import importlib
import importlib.util
import inspect
import re
import tomllib
from collections.abc import Iterable
from contextlib import redirect_stdout
from dataclasses import fields, is_dataclass
from io import StringIO
from pathlib import Path
from typing import get_args, get_type_hints

import pytest
from builders.worked import DOCS, ROOT

import taylor_verify
from taylor_verify.cli.arguments import parse
from taylor_verify.records import answers, reason
from taylor_verify.records.error_kind import ErrorKind
from taylor_verify.records.faults import Refused
from taylor_verify.scenes.library import cases_directory, find, names
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.reading.table import Table
from taylor_verify_reports.claims.claim_row import Verdict as ClaimVerdict

PACKAGE = Path(taylor_verify.__file__).parent
COMMAND_LINE = DOCS / "command-line.md"
VERDICTS = DOCS / "verdicts.md"
SCENES = ROOT / "cases" / "README.md"
PAGES = (
    *(page for page in sorted(DOCS.rglob("*.md")) if "_build" not in page.parts),
    *(ROOT / "README.md", SCENES),
)


def code_of(page: Path) -> str:
    """Everything on a page that is marked as code: spans and blocks."""
    text = page.read_text(encoding="utf-8")
    blocks = re.findall(r"^ *```.*?^ *```", text, re.MULTILINE | re.DOTALL)
    rest = re.sub(r"^ *```.*?^ *```", "", text, flags=re.MULTILINE | re.DOTALL)
    return "\n".join([*blocks, *re.findall(r"`([^`\n]+)`", rest)])


def missing(words: Iterable[str], page: Path) -> list[str]:
    """The words that no code of a page has."""
    code = code_of(page)
    return sorted(
        w for w in set(words) if not re.search(rf"(?<![\w-]){re.escape(w)}(?![\w-])", code)
    )


def help_of(*words: str) -> str:
    with redirect_stdout(StringIO()) as out, pytest.raises(SystemExit):
        parse([*words, "--help"])
    return out.getvalue()


VERBS = re.findall(r"^    (\w+)  ", help_of(), re.MULTILINE)


# The command line.


def test_every_verb_has_a_section() -> None:
    """Each verb of --help has a heading on the page of the command line, and a call in its first block."""
    assert {"list", "run", "sweep", "question"} <= set(VERBS)
    page = COMMAND_LINE.read_text(encoding="utf-8")
    headings = re.findall(r"^## (\w+)$", page, re.MULTILINE)
    assert set(VERBS) <= set(headings)
    first = re.findall(r"^```\n(.*?)^```$", page, re.MULTILINE | re.DOTALL)[0]
    assert {verb for verb in VERBS if f"taylor-verify {verb} " not in first} <= {"list"}


def test_every_option_is_on_the_site() -> None:
    """The page of the command line, as the site has it, ends the section of each verb with its --help."""
    spec = importlib.util.spec_from_file_location("conf", DOCS / "conf.py")
    assert spec is not None
    assert spec.loader is not None
    conf = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(conf)
    content = [COMMAND_LINE.read_text(encoding="utf-8")]
    conf.with_help(None, "docs/command-line", content)
    sections = dict(re.findall(r"^## (\w+)$(.*?)(?=^## )", content[0], re.MULTILINE | re.DOTALL))
    for verb in VERBS:
        options = set(re.findall(r"--[a-z][a-z-]*", help_of(verb)))
        assert "--json" in options
        assert {option for option in options if option not in sections[verb]} == set()


# Scenes.


def test_every_key_of_a_scene_is_documented(monkeypatch: pytest.MonkeyPatch) -> None:
    """Each key that the reader asks for, of any shipped or refused scene, is in the tables of cases."""
    asked, has = set(), Table.has

    def recorded(table: Table, key: str) -> bool:
        asked.add(re.sub(r"\[\d+\]", "", key))
        return has(table, key)

    monkeypatch.setattr(Table, "has", recorded)
    refused = sorted((cases_directory() / "refused").glob("*.toml"))
    for scene in [*names(), *refused]:
        try:
            load(scene)
        except Refused:
            assert scene in refused
    assert {"title", "omega", "samples", "fluid_density", "cosine", "rotor", "damping"} <= asked
    assert missing(asked - names_of_their_own(), SCENES) == []


def names_of_their_own() -> set[str]:
    """The names that the shipped scenes make in the tables for names."""
    scenes = [tomllib.loads(find(name).read_text(encoding="utf-8")) for name in names()]
    tables = ("define", "space", "tables", "states")
    return {name for scene in scenes for table in tables for name in scene.get(table, {})}


# Verdicts.


@pytest.mark.parametrize(
    "words", [reason.Cause, reason.Kind, ErrorKind, answers.Stall, ClaimVerdict]
)
def test_every_word_of_a_verdict_is_documented(words: type[reason.Cause]) -> None:
    """The page of verdicts has each word that a program may read in a row."""
    assert missing((word.value for word in words), VERDICTS) == []


PARTS = [
    kind
    for module in (reason, answers)
    for kind in vars(module).values()
    if inspect.isclass(kind) and is_dataclass(kind) and kind.__module__ == module.__name__
]


@pytest.mark.parametrize("part", PARTS, ids=lambda part: part.__name__)
def test_every_key_of_an_answer_is_documented(part: type) -> None:
    """Each key of the JSON documents, and of the reason in a row, stands on the page of verdicts."""
    assert missing((field.name for field in fields(part)), VERDICTS) == []


# Errors.


def exceptions() -> set[str]:
    """Every exception of both packages that has a public name, as it is imported.

    They are read from the sources: to import all of these would take seconds.
    """
    kinds = [
        (".".join(file.relative_to(PACKAGE.parent).with_suffix("").parts), name, base)
        for file in PACKAGE.parent.rglob("*.py")
        if "outside" not in file.parts
        for name, base in re.findall(r"^class ([A-Z]\w+)\((\w+)\):", file.read_text("utf-8"), re.M)
    ]
    known = {
        n
        for n, kind in vars(builtins).items()
        if inspect.isclass(kind) and issubclass(kind, BaseException)
    }
    public: set[str] = set()
    while more := {(m, n) for m, n, base in kinds if base in known and f"{m}.{n}" not in public}:
        public |= {f"{module}.{name}" for module, name in more}
        known |= {name for _, name in more}
    return public


def test_every_exception_of_a_call_is_documented() -> None:
    """Errors has each exception of the reference, with the text when, and none that there is not."""
    page = (DOCS / "errors.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| `(taylor_verify[\w.]+)` \| (.+) \| (.+) \|$", page, re.MULTILINE)
    texts = [page.read_text(encoding="utf-8") for page in (DOCS / "reference").glob("*.md")]
    public = {name for text in texts for name in re.findall(r"autoexception:: ([\w.]+)", text)}
    assert public <= {name for name, *_ in rows} <= exceptions()
    assert len(rows) == len({name for name, *_ in rows})


# Python.


def referenced() -> set[str]:
    """The names that the pages of the reference document."""
    texts = [page.read_text(encoding="utf-8") for page in (DOCS / "reference").glob("*.md")]
    return {name for text in texts for name in re.findall(r"^\.\. auto\w+:: ([\w.]+)", text, re.M)}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_what_a_page_imports_is_in_the_reference(page: Path) -> None:
    """Each name that the code of a page takes from a module of the package is documented."""
    imports = re.findall(
        r"^ *from (taylor_verify[\w.]*) import ([\w, ]+)$", code_of(page), re.MULTILINE
    )
    taken = {
        f"{module}.{name.split(' as ')[0].strip()}"
        for module, line in imports
        for name in line.split(",")
    }
    assert taken - referenced() == set()


def classes_in(annotations: Iterable[object], module: str) -> set[str]:
    """The classes of the package that annotations of a module name, as they are imported."""
    text = (PACKAGE.parent / f"{module.replace('.', '/')}.py").read_text(encoding="utf-8")
    classes = set()
    for name in re.findall(r"[A-Z]\w+", " ".join(map(str, annotations))):
        source = re.search(
            rf"^ *from (taylor_verify[\w.]*) import [^\n]*\b{name}\b(?! as )", text, re.M
        )
        if source or re.search(rf"^class {name}\b", text, re.M):
            kind = getattr(importlib.import_module(source[1] if source else module), name)
            classes |= {f"{kind.__module__}.{name}"} if inspect.isclass(kind) else set()
    return classes


CALLS = [n for n in taylor_verify.__all__ if inspect.isfunction(getattr(taylor_verify, n))]
# These return a dictionary, whose keys are those of --json.
PLAIN = {"explain"}
# The words of these stand in a table of docs/verdicts.md.
WORDS_ELSEWHERE = {"taylor_verify_reports.claims.claim_row.Verdict"}


@pytest.mark.parametrize("call", CALLS)
def test_what_a_call_returns_is_in_the_reference(call: str) -> None:
    """The class that a public call returns is documented, and so is every class that its fields hold."""
    hint = get_type_hints(getattr(taylor_verify, call))["return"]
    kinds = [kind for kind in get_args(hint) or [hint] if inspect.isclass(kind)]
    each = {f"{kind.__module__}.{kind.__name__}" for kind in kinds}
    returned = {name for name in each if name.startswith("taylor_verify")}
    assert bool(returned) != (call in PLAIN)
    assert returned <= referenced()
    for name in returned:
        module, _, last = name.rpartition(".")
        kind = getattr(importlib.import_module(module), last)
        within = classes_in(getattr(kind, "__annotations__", {}).values(), module)
        assert within - referenced() - WORDS_ELSEWHERE == set()


REFERENCES = re.compile(r"^\.\. auto\w+:: ([\w.]+)[^\n]*((?:\n   [^\n]*)*)", re.MULTILINE)


@pytest.mark.parametrize("page", sorted((DOCS / "reference").glob("*.md")), ids=lambda p: p.stem)
def test_what_the_reference_names_exists(page: Path) -> None:
    """Each function, class and member of the reference is there, so that `make docs` finds it."""
    for path, options in REFERENCES.findall(page.read_text(encoding="utf-8")):
        module, _, name = path.rpartition(".")
        documented = getattr(importlib.import_module(module), name)
        members = re.search(r":members:([^:]*)", options)
        for member in re.findall(r"\w+", members[1] if members else ""):
            known = {each.name for each in fields(documented)} if is_dataclass(documented) else ()
            assert hasattr(documented, member) or member in known, f"{path}.{member}"
