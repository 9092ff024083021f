"""The shape of the tree: what a file may be called, and what ruff and import-linter do not see."""

from __future__ import annotations

import ast
import functools
import graphlib
import re
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Final

import grimp
import pytest

pytest_plugins = ["pytester"]

TESTS: Final = Path(__file__).resolve().parents[1]
SOURCES: Final = TESTS.parent / "verify"


# What a module imports


parse = functools.cache(ast.parse)


@functools.cache
def imports(source: str) -> tuple[tuple[str, int], ...]:
    """Return the full name and the line of every import: at the top, in functions, by import_module."""
    nodes = (node for node in ast.walk(parse(source)) if hasattr(node, "lineno"))
    return tuple((target, node.lineno) for node in nodes for target in _imported(node))


def _imported(node: ast.AST) -> list[str]:
    match node:
        case ast.Import(names=names):
            return [alias.name for alias in names]
        case ast.ImportFrom(module=module, names=names, level=level):
            # A relative import keeps its dots, which no rule below allows.
            base = "." * level + (module or "")
            return [f"{base}.{alias.name}" for alias in names]
        case ast.Call(func=function, args=[ast.Constant(value=str(name)), *_]):
            return [name] if _last_name(function) in {"import_module", "__import__"} else []
    return []


def _last_name(node: ast.AST) -> str:
    match node:
        case ast.Name(id=name) | ast.Attribute(attr=name):
            return name
    return ""


# What several rooms answer: the kinds of body, both sides of the wall between truth and solvers, a thing
# and its door, its document or its picture.
SHARED: Final = """
    __init__ acting certificate closed damping elements ellipsoid events field functions immersed
    invariants jacobi judgement kinks loaded loads manufactured missing_load native orbit provenance
    question regime registry rigid scene states sweep units
"""

# The rules: each takes (module name, source text) and yields what is wrong, with its place


Rule = Callable[[str, str], Iterator[str]]


def within(name: str, *roots: str) -> bool:
    """Return True if a dotted name is one of these modules or something inside one."""
    return any(name == root or name.startswith(f"{root}.") for root in roots)


def room(module: str) -> str:
    """The room of a module: ``exact`` for ``taylor_verify.exact.euler.jacobi``, empty at the top level."""
    parts = module.split(".")
    return parts[1] if len(parts) > 1 else ""


def hides_no_import(module: str, source: str) -> Iterator[str]:
    """An import that import-linter judges is a statement; dask is imported in batch.cluster alone."""
    if not re.search(r"import_module|__import__|\bdask\b|\bdistributed\b", source):
        return
    dask = () if module == "taylor_verify.batch.cluster" else ("dask", "distributed")
    hidden = ("taylor_verify", "taylor_verify_reports", "heyoka", *dask)
    for node in ast.walk(parse(source)):
        if isinstance(node, ast.Call):
            for target in _imported(node):
                if within(target, *hidden):
                    yield f"expected an import statement, got {target} @ {module}:{node.lineno}"
    for target, line in imports(source):
        if within(target, *dask):
            yield f"expected dask in batch.cluster only, got {target} @ {module}:{line}"


def stands_in_its_own_environment(module: str, source: str) -> Iterator[str]:
    """A program in solvers/outside imports nothing of taylor_verify: its environment lacks it."""
    if within(module, "taylor_verify.solvers.outside"):
        for target, line in imports(source):
            if within(target, "taylor_verify"):
                yield f"expected nothing of taylor_verify, got {target} @ {module}:{line}"


_BODIES: Final = ("RigidBody", "ImmersedBody")
# Types of bodies are named in the room of each, in the registry, and where ellipsoids are formed.
_NAMES_BODIES: Final = (
    *("taylor_verify.exact.euler", "taylor_verify.exact.kirchhoff", "taylor_verify.exact.registry"),
    "taylor_verify.exact.ellipsoid",
    "taylor_verify.exact.enclosure.system",
)


def asks_the_registry(module: str, source: str) -> Iterator[str]:
    """exact names a type of body in the room of that body only; all else asks exact.registry."""
    if room(module) != "exact" or within(module, *_NAMES_BODIES):
        return
    for target, line in imports(source):
        if within(target, *(f"taylor_verify.scenes.bodies.{name}" for name in _BODIES)):
            yield f"expected exact.registry.kind_of, got {target} @ {module}:{line}"


def names_a_noun(module: str, source: str) -> Iterator[str]:
    """No file or folder is called utils, core, common or helpers."""
    for part in module.split("."):
        if part in {"utils", "core", "common", "helpers"}:
            yield f"expected a name that says what is returned, got {part} @ {module}"


def is_small(module: str, source: str) -> Iterator[str]:
    """A file has at most 400 lines; beyond that a noun is missing."""
    lines = len(source.splitlines())
    if not lines <= 400:
        yield f"expected at most 400 lines, got {lines} @ {module}"


# A file of another program, which a docstring names.
_OF_OTHERS: Final = frozenset({"heyoka.py", "remus100.py"})
_TEXTS: Final = (ast.Module, ast.ClassDef, ast.FunctionDef)
_FILE_NAME: Final = re.compile(r"(?<![\w./])[a-z_0-9/]+\.py\b")


def names_files_that_are_there(module: str, source: str) -> Iterator[str]:
    """A file that a docstring or a comment names stands beside it, or is named from the package on."""
    if not _FILE_NAME.search(source):
        return
    holders = [node for node in ast.walk(parse(source)) if isinstance(node, _TEXTS)]
    texts = [ast.get_docstring(node) or "" for node in holders]
    texts += [line for line in source.splitlines() if line.lstrip().startswith("#")]
    package, *rooms = module.split(".")
    folders = {SOURCES.joinpath(package, *rooms), SOURCES.joinpath(package, *rooms[:-1])}
    for name in _FILE_NAME.findall("\n".join(texts)):
        places = folders | {SOURCES / "taylor_verify", TESTS.parent}
        if name not in _OF_OTHERS and not any((place / name).exists() for place in places):
            yield f"expected a file that is there, got {name} @ {module}"


RULES: Final = (
    hides_no_import,
    asks_the_registry,
    stands_in_its_own_environment,
    names_a_noun,
    names_files_that_are_there,
    is_small,
)


# The tree itself


def read_sources() -> dict[str, str]:
    """Module name to source text; a package goes by its own name, as in an import."""
    files = sorted(SOURCES.rglob("*.py"))
    return {_module_name(file): file.read_text(encoding="utf-8") for file in files}


def _module_name(file: Path) -> str:
    parts = file.relative_to(SOURCES).with_suffix("").parts
    return ".".join(part for part in parts if part != "__init__")


TREE: Final = read_sources()


@pytest.mark.parametrize("rule", RULES, ids=lambda rule: rule.__name__)
def test_the_tree_keeps_the_rule(rule: Rule) -> None:
    """No module under verify/ breaks the rule."""
    assert [fault for module, source in TREE.items() for fault in rule(module, source)] == []


def circle(graph: grimp.ImportGraph) -> list[str]:
    """Return a circle of imports between modules; empty where there is none."""
    imported = {module: graph.find_modules_directly_imported_by(module) for module in graph.modules}
    try:
        graphlib.TopologicalSorter(imported).prepare()
    except graphlib.CycleError as error:
        return [*error.args[1]]
    return []


def test_one_name_has_one_meaning() -> None:
    """Files of one name are one question in several rooms; the last line of a traceback tells which."""
    doors = SOURCES / "taylor_verify"
    names = Counter(path.stem for path in doors.rglob("*.py") if path.parent != doors)
    assert {name for name, files in names.items() if files > 1} == set(SHARED.split())
    published = SOURCES / "taylor_verify_reports"
    names = Counter(path.stem for path in published.rglob("*.py"))
    assert {name for name, files in names.items() if files > 1} == {"__init__"}


def test_no_import_circle() -> None:
    """No module imports itself by way of others, imports inside functions included."""
    graph = grimp.build_graph(
        "taylor_verify",
        "taylor_verify_reports",
        exclude_type_checking_imports=True,
        cache_dir=None,
    )
    assert len(graph.modules) > 500
    assert circle(graph) == []
    graph.add_import(importer="taylor_verify.records.verdict", imported="taylor_verify.run")
    assert {"taylor_verify.records.verdict", "taylor_verify.run"} <= {*circle(graph)}


# The checker must catch what is planted


PLANTED = [
    (
        hides_no_import,
        "taylor_verify.exact.theta",
        "import_module('taylor_verify.models.euler')",
        "models",
    ),
    (
        hides_no_import,
        "taylor_verify.batch.sweeps.sweep",
        "def f():\n from distributed import Client",
        "distributed.Client",
    ),
    (
        asks_the_registry,
        "taylor_verify.exact.units",
        "from taylor_verify.scenes.bodies import Body, RigidBody",
        "RigidBody",
    ),
    (
        stands_in_its_own_environment,
        "taylor_verify.solvers.outside.julia",
        "from taylor_verify.scenes import scene",
        "taylor_verify.scenes",
    ),
    (names_a_noun, "taylor_verify.exact.utils", "", "utils"),
    (names_a_noun, "taylor_verify.core.exact", "", "core"),
    (names_files_that_are_there, "taylor_verify.exact.theta", '"""As axes.py."""', "axes.py"),
    (is_small, "taylor_verify.exact.theta", "x = 1\n" * 401, "401"),
]


@pytest.mark.parametrize(("rule", "module", "source", "named"), PLANTED)
def test_a_planted_fault_is_named(rule: Rule, module: str, source: str, named: str) -> None:
    """A rule finds one fault in a module that breaks it, and says which name and where."""
    (fault,) = rule(module, source)
    assert named in fault
    assert fault.rpartition(" @ ")[2].partition(":")[0] == module


def test_every_rule_has_a_planted_fault() -> None:
    """Each rule has been seen to fail."""
    assert {rule for rule, *_ in PLANTED} == set(RULES)


@pytest.mark.parametrize(
    "leak", ["mpmath.mp.dps = 50", "mpmath.mp.prec += 1", "flint.ctx.prec = 200"]
)
def test_a_leaked_precision_fails_its_test(pytester: pytest.Pytester, leak: str) -> None:
    """A test that leaves a global precision changed is an error, and the next one starts afresh."""
    pytester.makeconftest((Path(__file__).parents[1] / "conftest.py").read_text(encoding="utf-8"))
    pytester.makepyfile(
        f"""
        import flint, mpmath
        before = mpmath.mp.prec, flint.ctx.prec
        def test_leaks():
            {leak}
        def test_after():
            assert (mpmath.mp.prec, flint.ctx.prec) == before
        """
    )
    result = pytester.runpytest_inprocess("-p", "no:xdist", "-p", "no:cacheprovider")
    result.assert_outcomes(passed=2, errors=1)
    result.stdout.fnmatch_lines(["*scope a precision with*"])
