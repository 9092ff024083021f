"""Words of the house that no linter knows: beginnings of docstrings, and names that say nothing."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Final

import pytest

ROOT: Final = Path(__file__).resolve().parents[2]

# Prepositions, relatives, conjunctions and pronouns: such a first line names no thing and no action.
# A docstring stands at the top of a file, or below a line that ends in a colon.
BEGINNING: Final = re.compile(
    r'(?:\A|:\n)\s*"""('
    r"About|Above|After|Against|And|As|At|Before|Behind|Below|Beside|Between|Beyond|But|By|During|Each|Every"
    r"|Everything|For|From|How|If|In|Inside|Into|It|Its|Nor|Nothing|Of|Off|On|One|Or|Out|Over|Since|So|Than"
    r"|That|The same|Those|Through|To|Towards|Under|Until|Upon|What|When|Where|Wherever|Whether|Which|While"
    r"|Who|Whose|Why|With|Within|Without)\b.*"
)
# Participles, pronouns and verbs that do not say what a variable has. Held values are a term of the field.
NAMELESS: Final = re.compile(r"_*(found|told|kept|seen|looks|said|gone|begun|it)_*")
# Strings and comments, in which such words may stand.
PROSE: Final = re.compile(
    r'''"""(?:\\.|.)*?"""|"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])*'|\#[^\n]*''', re.DOTALL
)
# Keys of published JSON.
KEYS: Final = frozenset({("Convention", "found"), ("DefectRow", "told")})


def bad_beginnings(source: str) -> Iterator[str]:
    """Yield the place of every docstring that begins with a word of BEGINNING."""
    for docstring in BEGINNING.finditer(source):
        line = source.count("\n", 0, docstring.start(1)) + 1
        yield f"{line}: {source.splitlines()[line - 1].strip()}"


def nameless(source: str) -> Iterator[str]:
    """Yield the place of every variable, argument, function, class and import called by such a word."""
    if not re.search(rf"\b{NAMELESS.pattern}\b", PROSE.sub("", source)):
        return
    keys = set[ast.AST]()
    # A class comes before its fields.
    for node in ast.walk(ast.parse(source)):
        name: str | None = None
        if isinstance(node, ast.Name | ast.Attribute):
            if isinstance(node.ctx, ast.Store):
                name = node.id if isinstance(node, ast.Name) else node.attr
        elif isinstance(node, ast.ClassDef):
            fields = (line.target for line in node.body if isinstance(line, ast.AnnAssign))
            keys.update(field for field in fields if (node.name, ast.unparse(field)) in KEYS)
            name = node.name
        elif isinstance(node, ast.arg):
            name = node.arg
        elif isinstance(node, ast.alias):
            name = node.asname or node.name
        elif isinstance(
            node, ast.FunctionDef | ast.AsyncFunctionDef | ast.MatchAs | ast.ExceptHandler
        ):
            name = node.name
        if name and NAMELESS.fullmatch(name) and node not in keys:
            yield f"{node.lineno}: {name}"


@pytest.mark.parametrize(
    ("rule", "folders"),
    [(bad_beginnings, ["verify"]), (nameless, ["verify", "tests"])],
    ids=["docstrings", "names"],
)
def test_the_tree_keeps_the_rule(rule: object, folders: list[str]) -> None:
    """Docstrings of the package begin with a thing or an action; names, of tests too, say something."""
    assert callable(rule)
    files = [file for folder in folders for file in sorted((ROOT / folder).rglob("*.py"))]
    assert len(files) > 400
    faults = (
        f"{file.relative_to(ROOT)}:{fault}"
        for file in files
        for fault in rule(file.read_text(encoding="utf-8"))
    )
    assert list(faults) == []


@pytest.mark.parametrize(
    ("rule", "count", "source"),
    [
        (bad_beginnings, 1, '"""Of a body the mass."""'),
        (bad_beginnings, 1, 'def f():\n    """Whether it moves."""'),
        (bad_beginnings, 0, '"""Inertia of a body."""'),
        (bad_beginnings, 0, '"""Offset."""'),
        (nameless, 1, "found = 1"),
        (nameless, 1, "def f(seen): ..."),
        (nameless, 1, "def told(): ..."),
        (nameless, 1, "[kept for kept in ()]"),
        (nameless, 1, "self._seen = 1"),
        (nameless, 1, "if (said := 1): ..."),
        (nameless, 1, "from a import b as gone"),
        (nameless, 1, "match a:\n    case [found, *_]: ..."),
        (nameless, 1, "try: ...\nexcept OSError as said: ..."),
        (nameless, 0, "foundation = held_row = 1"),
    ],
)
def test_a_fault_is_noticed_and_nothing_else(rule: object, count: int, source: str) -> None:
    """Each kind of binding is looked through; a longer word is no fault."""
    assert callable(rule)
    assert len(list(rule(source))) == count
