"""Words of the package: the beginnings of docstrings, names that say nothing, values without a name."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Final

import pytest

TESTS: Final = Path(__file__).resolve().parents[1]
SOURCES: Final = TESTS.parent / "verify"

# Prepositions, relatives, conjunctions and pronouns: such a first line names no thing and no action.
BEGINNING: Final = re.compile(
    r"(About|Above|After|Against|And|As|At|Before|Behind|Below|Beside|Between|Beyond|But|By|During|Each|Every"
    r"|Everything|For|From|How|If|In|Inside|Into|It|Its|Nor|Nothing|Of|Off|On|One|Or|Out|Over|Since|So|Than"
    r"|That|The same|Those|Through|To|Towards|Under|Until|Upon|What|When|Where|Wherever|Whether|Which|While"
    r"|Who|Whose|Why|With|Within|Without)\b"
)
# Participles, pronouns and verbs that do not say what a variable holds.
NAMELESS: Final = re.compile(r"_*(found|told|kept|held|seen|looks|said|gone|begun|it)_*")
# The rooms without such names, in the package and among the tests.
ROOMS: Final = (
    "judge",
    "exact",
    "models",
    "solvers",
    "scenes",
    "records",
    "batch",
    "cli",
    "draw",
    "explain",
    "testing",
    "numbers",
    "tradeoff",
    "words",
    "report",
    "plotting",
    "claims",
    "studies",
    "controls",
    "verbs",
)
# Rooms whose tests are among those of other rooms; and rooms of the tests alone.
_UNTESTED: Final = frozenset(
    {"records", "explain", "numbers", "tradeoff", "words", "report", "plotting", "verbs"}
)
TEST_ROOMS: Final = (
    *(room for room in ROOMS if room not in _UNTESTED),
    "publish",
    "site",
    "house",
    "builders",
    "benches",
)
# Functions of libraries, which take a flag without a name.
UNNAMED_FLAGS: Final = re.compile(r"set_\w+|Parse|Rotation|integrand|c_numba_cysolve_ivp")
# Keys of published JSON.
KEYS: Final = frozenset({("Convention", "found"), ("DefectRow", "told")})


def folder_of(room: str) -> Path:
    """The folder of a room, in the package that has it."""
    packages = (SOURCES / "taylor_verify", SOURCES / "taylor_verify_reports")
    (folder,) = (package / room for package in packages if (package / room).is_dir())
    return folder


def docstrings(source: str) -> Iterator[tuple[int, str]]:
    """Yield the line and the text of every docstring of a module, its classes and its functions."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef):
            text = ast.get_docstring(node)
            if text is not None:
                yield getattr(node, "lineno", 1), text


def bad_beginnings(source: str) -> Iterator[str]:
    """Yield the place and the first line of every docstring that begins with a word of BEGINNING."""
    for line, text in docstrings(source):
        if BEGINNING.match(text):
            yield f"{line}: {text.splitlines()[0]}"


def keys_of(node: ast.ClassDef) -> Iterator[ast.AST]:
    """Yield the names of the fields of a class that are keys of published JSON."""
    for field in node.body:
        match field:
            case ast.AnnAssign(target=ast.Name(id=name) as target) if (node.name, name) in KEYS:
                yield target


def bound_names(tree: ast.AST) -> Iterator[tuple[int, str]]:
    """Yield the line and the name of every variable, argument, function, class and import."""
    keys: set[ast.AST] = set()
    # A class comes before its fields.
    for node in ast.walk(tree):
        if isinstance(node, ast.ClassDef):
            keys.update(keys_of(node))
        match node:
            case ast.Name() if node in keys:
                pass
            case ast.Name(id=name, ctx=ast.Store()) | ast.arg(arg=name):
                yield node.lineno, name
            case ast.FunctionDef(name=name) | ast.AsyncFunctionDef(name=name):
                yield node.lineno, name
            case ast.ClassDef(name=name):
                yield node.lineno, name
            case ast.Attribute(attr=name, ctx=ast.Store()):
                yield node.lineno, name
            case ast.MatchAs(name=str(name)) | ast.ExceptHandler(name=str(name)):
                yield node.lineno, name
            case ast.alias(name=name, asname=None) | ast.alias(asname=str(name)):
                yield node.lineno, name


def nameless(source: str) -> Iterator[str]:
    """Yield the line and the name of every variable that is called by a word of NAMELESS."""
    for line, name in bound_names(ast.parse(source)):
        if NAMELESS.fullmatch(name):
            yield f"{line}: {name}"


def line_fillers(source: str) -> Iterator[str]:
    """Yield the line of every tuple or list unpacked where it is written, as in ``(*(a, b), c)``."""
    for node in ast.walk(ast.parse(source)) if re.search(r"\*[(\[]", source) else ():
        match node:
            case ast.Starred(value=ast.Tuple() | ast.List()):
                yield f"{node.lineno}: {ast.unparse(node)}"


def unnamed_flags(source: str) -> Iterator[str]:
    """Yield the line of every call that has a True or a False without the name of its argument."""
    may_have = re.search(r"[(,]\s*(True|False)\s*[,)]", source)
    for node in ast.walk(ast.parse(source)) if may_have else ():
        if isinstance(node, ast.Call):
            function = ast.unparse(node.func).rpartition(".")[2]
            flags = [
                a for a in node.args if isinstance(a, ast.Constant) and isinstance(a.value, bool)
            ]
            if flags and not UNNAMED_FLAGS.fullmatch(function):
                yield f"{node.lineno}: {ast.unparse(node)}"


def faults_in(folder: Path, rule: object) -> list[str]:
    """Return the faults by a rule in all files below a folder, with their places."""
    assert callable(rule)
    assert folder.is_dir(), folder
    return [
        f"{file.relative_to(TESTS.parent)}:{fault}"
        for file in sorted(folder.rglob("*.py"))
        for fault in rule(file.read_text(encoding="utf-8"))
    ]


def test_no_docstring_begins_with_a_preposition() -> None:
    """The first line of every docstring of the package begins with a thing or an action."""
    assert faults_in(SOURCES, bad_beginnings) == []


@pytest.mark.parametrize("room", ROOMS)
def test_variables_are_named_by_nouns(room: str) -> None:
    """No variable of these rooms is called found, told, kept or by another word that says nothing."""
    assert faults_in(folder_of(room), nameless) == []


@pytest.mark.parametrize("room", TEST_ROOMS)
def test_variables_of_tests_are_named_by_nouns(room: str) -> None:
    """No variable in the tests of these rooms is called by such a word either."""
    assert faults_in(TESTS / room, nameless) == []


@pytest.mark.parametrize("room", ROOMS)
@pytest.mark.parametrize("rule", [line_fillers, unnamed_flags])
def test_values_stand_in_their_own_lines_and_flags_have_names(room: str, rule: object) -> None:
    """No tuple of these rooms is unpacked to fill lines, and no call has a flag without a name."""
    assert faults_in(folder_of(room), rule) == []


@pytest.mark.parametrize(
    "text", ["Of a body the mass.", "What a body does.", "Whether it moves.", "In units of time."]
)
def test_a_preposition_is_noticed(text: str) -> None:
    """A docstring that begins with a preposition or a relative is a fault, of functions as well."""
    assert list(bad_beginnings(f'"""{text}"""')) == [f"1: {text}"]
    assert list(bad_beginnings(f'def f():\n    """{text}"""')) == [f"1: {text}"]


@pytest.mark.parametrize(
    "text", ["Inertia of a body.", "Return the mass.", "Offset.", "Format it."]
)
def test_a_noun_or_a_verb_may_begin(text: str) -> None:
    """A word that only begins like a preposition is no fault."""
    assert list(bad_beginnings(f'"""{text}"""')) == []


@pytest.mark.parametrize(
    "source",
    [
        "found = 1",
        "def f(held): ...",
        "def told(): ...",
        "[kept for kept in ()]",
        "self._seen = 1",
        "if (said := 1): ...",
        "from a import b as gone",
        "match a:\n    case [found, *_]: ...",
        "try: ...\nexcept OSError as said: ...",
    ],
)
def test_a_nameless_variable_is_noticed(source: str) -> None:
    """Assignments, arguments, functions, comprehensions, attributes and imports are all looked through."""
    assert len(list(nameless(source))) == 1


def test_a_longer_name_is_no_fault() -> None:
    """A word is a fault as a whole name only: foundation and held_row are names."""
    assert list(nameless("foundation = held_row = 1")) == []


def test_a_tuple_that_is_unpacked_to_fill_a_line_is_noticed() -> None:
    """A tuple and a list are faults, in a literal and in a call; a variable or a generator is none."""
    assert len(list(line_fillers("a = (*(b, c), d)\nf(*[b, c])"))) == 2
    assert list(line_fillers("a = (*b, *(c for c in d))\nf(*b)")) == []


def test_a_flag_without_a_name_is_noticed() -> None:
    """A flag with a name is no fault, and neither is one of a library that has no name for it."""
    assert len(list(unnamed_flags("f(a, True)\nb.f(False)"))) == 2
    assert list(unnamed_flags("f(a, strict=True)\nos.set_blocking(a, False)")) == []
