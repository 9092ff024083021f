"""The shape of the tree: who may import whom, who may print, and what a file may be called."""

from __future__ import annotations

import ast
import functools
import graphlib
import itertools
from collections.abc import Callable, Iterable, Iterator, Mapping
from pathlib import Path
from typing import Final, NamedTuple

import pytest

pytest_plugins = ["pytester"]

TESTS: Final = Path(__file__).resolve().parents[1]
PACKAGE: Final = TESTS.parent / "verify" / "taylor_verify"

Sources = Mapping[str, str]
"""Module name to source text; a package goes by its own name, as in an import."""


# What a module imports


class Import(NamedTuple):
    """One imported name in full, such as ``taylor_verify.records.verdict.Verdict``."""

    target: str
    line: int
    for_types_only: bool


parse = functools.cache(ast.parse)


@functools.cache
def imports(source: str) -> tuple[Import, ...]:
    """Every import of a module: at its top, inside functions, and import_module of a literal."""
    return tuple(_imports_below(parse(source), for_types_only=False))


def _imports_below(node: ast.AST, for_types_only: bool) -> Iterator[Import]:
    for target in _imported(node):
        yield Import(target, node.lineno, for_types_only)
    guarded = node.body if isinstance(node, ast.If) and _is_type_checking(node.test) else []
    for child in ast.iter_child_nodes(node):
        yield from _imports_below(child, for_types_only or child in guarded)


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


def _is_type_checking(test: ast.expr) -> bool:
    return _last_name(test) == "TYPE_CHECKING"


def _last_name(node: ast.AST) -> str:
    match node:
        case ast.Name(id=name) | ast.Attribute(attr=name):
            return name
    return ""


# The rules: each takes (module name, source text) and yields what is wrong, with its place


Rule = Callable[[str, str], Iterator[str]]

# Rooms that a room knows nothing of. The truth must not lean on what it judges, nor the reverse.
WALLS: Final = {
    "exact": {"models", "solvers", "judge", "publish", "controls", "studies"},
    "models": {"exact", "judge", "solvers", "studies"},
    "solvers": {"exact", "judge", "studies"},
    # The ledger holds the texts to the truth, and to no form of their equations that a solver is given.
    "claims": {"models", "solvers", "judge", "publish", "controls", "studies"},
}


def within(name: str, *roots: str) -> bool:
    """Return True if a dotted name is one of these modules or something inside one."""
    return any(name == root or name.startswith(f"{root}.") for root in roots)


def room(module: str) -> str:
    """The room of a module: ``exact`` for ``taylor_verify.exact.euler.jacobi``, empty at the top level."""
    parts = module.split(".")
    return parts[1] if len(parts) > 1 else ""


def keeps_its_walls(module: str, source: str) -> Iterator[str]:
    """exact, models and solvers import nothing from the rooms they are walled off from."""
    forbidden = [f"taylor_verify.{other}" for other in WALLS.get(room(module), ())]
    for target, line, _ in imports(source):
        if within(target, *forbidden):
            yield f"expected nothing of {room(target)}, got {target} @ {module}:{line}"


def records_stand_alone(module: str, source: str) -> Iterator[str]:
    """records imports nothing of taylor_verify but records: every room may read it."""
    if room(module) == "records":
        yield from _beyond(["taylor_verify.records"], module, source)


def scenes_stand_alone(module: str, source: str) -> Iterator[str]:
    """scenes imports nothing of taylor_verify but scenes, numbers, and the names that all rooms share."""
    if room(module) == "scenes":
        shared = ["taylor_verify.records.quantities", "taylor_verify.records.precisions"]
        yield from _beyond(
            ["taylor_verify.scenes", "taylor_verify.numbers", *shared], module, source
        )


def numbers_stand_alone(module: str, source: str) -> Iterator[str]:
    """numbers imports nothing of taylor_verify but numbers: every room may compute with them."""
    if room(module) == "numbers":
        yield from _beyond(["taylor_verify.numbers"], module, source)


def publish_reads_records(module: str, source: str) -> Iterator[str]:
    """publish imports records only, and scenes for its type hints."""
    if room(module) == "publish":
        readable = ["taylor_verify.publish", "taylor_verify.records"]
        yield from _beyond(readable, module, source, for_types=["taylor_verify.scenes"])


# What lies above batch, and would make a circle of it; publish is written to from modules called report.
ABOVE_BATCH: Final = {"cli", "studies", "controls", "claims"}


def batch_stands_below_the_verbs(module: str, source: str) -> Iterator[str]:
    """batch imports nothing of the rooms above it, and publish in its modules `report` alone."""
    if room(module) != "batch":
        return
    is_report = module.endswith(".report")
    above = ABOVE_BATCH if is_report else ABOVE_BATCH | {"publish"}
    for target, line, _ in imports(source):
        if within(target, *(f"taylor_verify.{name}" for name in above)):
            yield f"expected nothing of {room(target)}, got {target} @ {module}:{line}"


def dask_has_its_place(module: str, source: str) -> Iterator[str]:
    """dask is imported in batch.cluster alone: all other code knows executors."""
    if module != "taylor_verify.batch.cluster":
        for target, line, _ in imports(source):
            if within(target, "dask", "distributed"):
                yield f"expected dask in batch.cluster only, got {target} @ {module}:{line}"


def studies_stand_below_the_verbs(module: str, source: str) -> Iterator[str]:
    """studies imports nothing of cli: a study is measured and published without a command line."""
    if room(module) == "studies":
        for target, line, _ in imports(source):
            if within(target, "taylor_verify.cli"):
                yield f"expected nothing of cli, got {target} @ {module}:{line}"


def draw_stands_below_studies(module: str, source: str) -> Iterator[str]:
    """draw imports nothing of studies, batch and cli: a study shows its pictures, and knows of more."""
    if room(module) == "draw":
        for target, line, _ in imports(source):
            if within(target, *(f"taylor_verify.{name}" for name in ("studies", "batch", "cli"))):
                yield f"expected nothing of {room(target)}, got {target} @ {module}:{line}"


def processes_have_their_place(module: str, source: str) -> Iterator[str]:
    """Executors and processes are made in batch; trade times a new process, heyoka has threads."""
    placed = within(
        module,
        "taylor_verify.batch",
        "taylor_verify.tradeoff.cold",
        "taylor_verify.solvers.taylor.ensemble",
    )
    for target, line, for_types_only in imports(source):
        if within(target, "concurrent", "multiprocessing") and not placed and not for_types_only:
            yield f"expected processes in batch only, got {target} @ {module}:{line}"


def stands_in_its_own_environment(module: str, source: str) -> Iterator[str]:
    """A program in solvers/outside imports nothing of taylor_verify: its environment lacks it."""
    if within(module, "taylor_verify.solvers.outside"):
        yield from _beyond([], module, source)


def _beyond(
    allowed: list[str], module: str, source: str, for_types: Iterable[str] = ()
) -> Iterator[str]:
    """Yield the imports of taylor_verify beyond these; type hints may use ``for_types`` too."""
    for target, line, for_types_only in imports(source):
        readable = [*allowed, *for_types] if for_types_only else allowed
        if within(target, "taylor_verify") and not within(target, *readable):
            expected = " or ".join(readable) or "nothing of taylor_verify"
            yield f"expected {expected}, got {target} @ {module}:{line}"


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
    for target, line, _ in imports(source):
        if within(target, *(f"taylor_verify.scenes.bodies.{name}" for name in _BODIES)):
            yield f"expected exact.registry.kind_of, got {target} @ {module}:{line}"


def heyoka_has_its_place(module: str, source: str) -> Iterator[str]:
    """heyoka is imported only in models and in solvers/taylor."""
    placed = within(module, "taylor_verify.models") or module.startswith(
        "taylor_verify.solvers.taylor"
    )
    for target, line, _ in imports(source):
        if within(target, "heyoka") and not placed:
            yield f"expected heyoka in models or solvers/taylor, got {target} @ {module}:{line}"


def imports_heyoka_late(module: str, source: str) -> Iterator[str]:
    """heyoka is imported inside functions, or for type hints alone: no module needs it to load."""
    for target, line in _imports_on_loading(parse(source)):
        if within(target, "heyoka"):
            yield f"expected heyoka inside a function, got {target} @ {module}:{line}"


def _imports_on_loading(node: ast.AST) -> Iterator[tuple[str, int]]:
    """Yield the imports outside every function, class bodies and conditions included."""
    for target in _imported(node):
        yield target, node.lineno
    if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda):
        return
    for_types = node.body if isinstance(node, ast.If) and _is_type_checking(node.test) else []
    for child in ast.iter_child_nodes(node):
        if child not in for_types:
            yield from _imports_on_loading(child)


def is_silent(module: str, source: str) -> Iterator[str]:
    """Printing is for cli and progress, and for the programs in solvers/outside."""
    if within(
        module, "taylor_verify.cli", "taylor_verify.progress", "taylor_verify.solvers.outside"
    ):
        return
    for target, line, _ in imports(source):
        if within(target, "rich", "sys.stdout", "sys.stderr"):
            yield f"expected printing in cli only, got {target} @ {module}:{line}"
    for node in ast.walk(parse(source)):
        match node:
            case ast.Call(func=ast.Name(id="print")):
                yield f"expected printing in cli only, got print() @ {module}:{node.lineno}"
            case ast.Attribute(value=ast.Name(id="sys"), attr="stdout" | "stderr"):
                yield f"expected printing in cli only, got sys.{node.attr} @ {module}:{node.lineno}"


def imports_in_full(module: str, source: str) -> Iterator[str]:
    """No import is relative, and none takes everything."""
    for target, line, _ in imports(source):
        if target.startswith(".") or target.endswith(".*"):
            yield f"expected an import of a full name, got {target} @ {module}:{line}"


def names_a_noun(module: str, source: str) -> Iterator[str]:
    """No file or folder is called utils, core, common or helpers."""
    for part in module.split("."):
        if part in {"utils", "core", "common", "helpers"}:
            yield f"expected a name that says what is returned, got {part} @ {module}"


def says_what_it_is(module: str, source: str) -> Iterator[str]:
    """Every module with something in it has a docstring."""
    if source.strip() and not ast.get_docstring(parse(source)):
        yield f"expected a docstring, got none @ {module}"


def is_small(module: str, source: str) -> Iterator[str]:
    """A file has at most 400 lines; beyond that a noun is missing."""
    lines = len(source.splitlines())
    if not lines <= 400:
        yield f"expected at most 400 lines, got {lines} @ {module}"


RULES: Final = (
    keeps_its_walls,
    records_stand_alone,
    scenes_stand_alone,
    numbers_stand_alone,
    publish_reads_records,
    asks_the_registry,
    heyoka_has_its_place,
    batch_stands_below_the_verbs,
    dask_has_its_place,
    studies_stand_below_the_verbs,
    draw_stands_below_studies,
    processes_have_their_place,
    imports_heyoka_late,
    is_silent,
    stands_in_its_own_environment,
    imports_in_full,
    names_a_noun,
    says_what_it_is,
    is_small,
)


# The rules about all modules together


def import_graph(sources: Sources) -> dict[str, set[str]]:
    """Return the modules that each module imports when it runs, function bodies included."""
    return {
        module: {
            owner
            for target, _, for_types_only in imports(source)
            if not for_types_only and (owner := _owner(target, sources)) not in {None, module}
        }
        for module, source in sources.items()
    }


def _owner(target: str, sources: Iterable[str]) -> str | None:
    """The module that an imported name belongs to: its longest prefix that is a module."""
    parts = target.split(".")
    prefixes = (".".join(parts[:n]) for n in range(len(parts), 0, -1))
    return next((prefix for prefix in prefixes if prefix in sources), None)


def circle(sources: Sources) -> list[str]:
    """Return a circle of imports, from a module back to itself; empty where there is none."""
    try:
        graphlib.TopologicalSorter(import_graph(sources)).prepare()
    except graphlib.CycleError as error:
        # graphlib lists it in the order of being imported.
        return list(reversed(error.args[1]))
    return []


def detours(sources: Sources) -> Iterator[str]:
    """Walls that are passed by way of a third room."""
    graph = import_graph(sources)
    for module in sources:
        forbidden = WALLS.get(room(module), set())
        for reached in sorted(_reachable(module, graph)):
            if room(reached) in forbidden:
                yield f"expected no way to {room(reached)}, got {reached} @ {module}"


def _reachable(module: str, graph: Mapping[str, set[str]]) -> set[str]:
    reached: set[str] = set()
    waiting = [module]
    while waiting:
        imported = graph[waiting.pop()] - reached
        reached |= imported
        waiting.extend(imported)
    return reached


# The tree itself


def read_package() -> dict[str, str]:
    files = sorted(PACKAGE.rglob("*.py"))
    return {_module_name(file): file.read_text(encoding="utf-8") for file in files}


def _module_name(file: Path) -> str:
    parts = file.relative_to(PACKAGE.parent).with_suffix("").parts
    return ".".join(part for part in parts if part != "__init__")


TREE: Final = read_package()


@pytest.mark.parametrize("rule", RULES, ids=lambda rule: rule.__name__)
def test_the_tree_keeps_the_rule(rule: Rule) -> None:
    """No module under verify/ breaks the rule."""
    assert [fault for module, source in TREE.items() for fault in rule(module, source)] == []


def test_no_import_circle() -> None:
    """No module imports itself by way of others, imports inside functions included."""
    assert " imports ".join(circle(TREE)) == ""


def test_no_detour_round_a_wall() -> None:
    """No import of exact, models and solvers leads to a forbidden room by way of another."""
    assert list(detours(TREE)) == []


@pytest.mark.parametrize("name", ["scenes", *WALLS])
def test_the_walls_have_something_behind_them(name: str) -> None:
    """Each room with a wall has code in it: no rule holds for want of modules."""
    assert any(source for module, source in TREE.items() if room(module) == name)


# The tests


def imports_no_tests(module: str, source: str) -> Iterator[str]:
    """No test module is imported: what two of them need stands in builders."""
    for target, line, _ in imports(source):
        if any(part.startswith("test_") for part in target.split(".")[:-1] or [target]):
            yield f"expected an import from builders, got {target} @ {module}:{line}"


def test_no_test_module_is_imported() -> None:
    """No file below tests imports a test module."""
    files = sorted(TESTS.rglob("*.py"))
    assert len(files) > 100
    faults = [imports_no_tests(file.stem, file.read_text(encoding="utf-8")) for file in files]
    assert list(itertools.chain(*faults)) == []


@pytest.mark.parametrize(
    "source", ["from test_reach import row", "import test_reach", "from reach.test_page import row"]
)
def test_an_import_of_a_test_module_is_named(source: str) -> None:
    """The fault names the module that is imported, and the file that imports it."""
    (fault,) = imports_no_tests("test_growth", source)
    assert "test_" in fault.partition(", got ")[2]
    assert fault.endswith(" @ test_growth:1")
    assert list(imports_no_tests("test_growth", "from builders.verdicts import row")) == []


# The checker must catch what is planted


PLANTED = [
    (
        keeps_its_walls,
        "taylor_verify.exact.theta",
        "from taylor_verify.models.euler import field",
        "models",
    ),
    (keeps_its_walls, "taylor_verify.exact.theta", "from taylor_verify import solvers", "solvers"),
    (
        keeps_its_walls,
        "taylor_verify.exact.theta",
        "import taylor_verify.judge.errors.state as e",
        "judge",
    ),
    (
        keeps_its_walls,
        "taylor_verify.exact.euler.theta",
        "def f():\n import taylor_verify.publish",
        "publish",
    ),
    (
        keeps_its_walls,
        "taylor_verify.exact",
        "import_module('taylor_verify_reports.controls.signs')",
        "controls",
    ),
    (
        keeps_its_walls,
        "taylor_verify.models.euler",
        "from taylor_verify.exact.theta import q",
        "exact",
    ),
    (
        keeps_its_walls,
        "taylor_verify.solvers.taylor",
        "from taylor_verify.judge import errors",
        "judge",
    ),
    (
        records_stand_alone,
        "taylor_verify.records.verdict",
        "from taylor_verify.scenes.scene import Scene",
        "scenes",
    ),
    (
        scenes_stand_alone,
        "taylor_verify.scenes.reading.reader",
        "from taylor_verify.run import run",
        "taylor_verify.run",
    ),
    (
        numbers_stand_alone,
        "taylor_verify.numbers.irrational",
        "from taylor_verify.scenes.precision import rounded",
        "scenes",
    ),
    (
        publish_reads_records,
        "taylor_verify.publish.plots",
        "from taylor_verify.judge import gates",
        "gates",
    ),
    (
        publish_reads_records,
        "taylor_verify.publish.plots",
        "import taylor_verify.scenes.scene",
        "scenes",
    ),
    (
        asks_the_registry,
        "taylor_verify.exact.units",
        "from taylor_verify.scenes.bodies import Body, RigidBody",
        "RigidBody",
    ),
    (heyoka_has_its_place, "taylor_verify.judge.errors.state", "import heyoka as hy", "heyoka"),
    (heyoka_has_its_place, "taylor_verify.solvers.scipy", "from heyoka import par", "heyoka.par"),
    (
        batch_stands_below_the_verbs,
        "taylor_verify.batch.judging",
        "from taylor_verify.cli.progress import advancing",
        "cli",
    ),
    (
        batch_stands_below_the_verbs,
        "taylor_verify.batch.judgements",
        "def f():\n from taylor_verify.publish import report",
        "publish",
    ),
    (
        dask_has_its_place,
        "taylor_verify.batch.sweeps.sweep",
        "def f():\n from distributed import Client",
        "distributed.Client",
    ),
    (
        studies_stand_below_the_verbs,
        "taylor_verify_reports.studies.growth.study",
        "def f():\n from taylor_verify.cli.streams import say",
        "cli",
    ),
    (
        draw_stands_below_studies,
        "taylor_verify.draw.polhode",
        "from taylor_verify_reports.studies.portraits.study import PORTRAITS",
        "studies",
    ),
    (
        processes_have_their_place,
        "taylor_verify_reports.studies.portraits.measure",
        "from concurrent.futures import ProcessPoolExecutor",
        "ProcessPoolExecutor",
    ),
    (
        processes_have_their_place,
        "taylor_verify_reports.studies.worst.measure",
        "import multiprocessing",
        "multiprocessing",
    ),
    (imports_heyoka_late, "taylor_verify.solvers.taylor.step", "import heyoka as hy", "heyoka"),
    (
        imports_heyoka_late,
        "taylor_verify.models.euler",
        "class A:\n try:\n  from heyoka import par\n except ImportError:\n  pass",
        "heyoka.par",
    ),
    (
        imports_heyoka_late,
        "taylor_verify.solvers.taylor.step",
        "hy = import_module('heyoka')",
        "heyoka",
    ),
    (is_silent, "taylor_verify.judge.errors.state", "print(1)", "print()"),
    (is_silent, "taylor_verify.run", "from rich.console import Console", "rich.console"),
    (is_silent, "taylor_verify.run", "import sys\nsys.stderr.write('')", "sys.stderr"),
    (
        stands_in_its_own_environment,
        "taylor_verify.solvers.outside.julia",
        "from taylor_verify.scenes import scene",
        "taylor_verify.scenes",
    ),
    (imports_in_full, "taylor_verify.exact.theta", "from ..models import euler", "..models"),
    (imports_in_full, "taylor_verify.exact.theta", "from mpmath import *", "mpmath.*"),
    (names_a_noun, "taylor_verify.exact.utils", "", "utils"),
    (names_a_noun, "taylor_verify.core.exact", "", "core"),
    (says_what_it_is, "taylor_verify.exact.theta", "x = 1", "docstring"),
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
    ("module", "source"),
    [
        ("taylor_verify.exact.theta", "from taylor_verify.scenes.scene import Scene"),
        ("taylor_verify.models.euler", "def f():\n import heyoka as hy"),
        ("taylor_verify.solvers.taylor.step", "if TYPE_CHECKING:\n from heyoka import par"),
        ("taylor_verify.publish.plots", "from taylor_verify.records.verdict import Verdict"),
        (
            "taylor_verify.publish.plots",
            "if TYPE_CHECKING:\n from taylor_verify.scenes.scene import Scene",
        ),
        ("taylor_verify.batch.report", "from taylor_verify.words.junit import junit"),
        ("taylor_verify.batch.sweeps.report", "from taylor_verify.words.cells import figure"),
        ("taylor_verify.batch.cluster", "d = import_module('distributed')"),
        ("taylor_verify.batch.pool", "import multiprocessing"),
        (
            "taylor_verify.run_many",
            "if TYPE_CHECKING:\n from concurrent.futures import Executor",
        ),
        ("taylor_verify.judge.errors.state", "from taylor_verify.modelscope import x"),
        ("taylor_verify.cli", "from rich.console import Console\nprint(1)"),
        ("taylor_verify.exact.theta", "x = 1\n" * 399),
    ],
)
def test_a_sound_module_passes(module: str, source: str) -> None:
    """No rule objects to a module that keeps all of them."""
    described = f'"""What it is."""\n{source}'
    assert [fault for rule in RULES for fault in rule(module, described)] == []


def test_a_circle_is_found_through_a_function() -> None:
    """An import inside a function closes a circle, and the circle is named in importing order."""
    sources = {
        "taylor_verify.a": "from taylor_verify.b import x",
        "taylor_verify.b": "def f():\n from taylor_verify.c import y",
        "taylor_verify.c": "import taylor_verify.a",
    }
    modules = circle(sources)
    assert set(modules) == set(sources)
    graph = import_graph(sources)
    assert all(target in graph[module] for module, target in itertools.pairwise(modules))


def test_a_type_hint_closes_no_circle() -> None:
    """An import for type hints alone is not executed, so it is no part of a circle."""
    sources = {
        "taylor_verify.a": "from taylor_verify.b import x",
        "taylor_verify.b": "if TYPE_CHECKING:\n from taylor_verify.a import y",
    }
    assert circle(sources) == []


def test_a_detour_is_found() -> None:
    """exact may not reach models by way of a room that may import both."""
    sources = {
        "taylor_verify.exact.theta": "from taylor_verify.batch.selection import x",
        "taylor_verify.batch.selection": "from taylor_verify.models.euler import y",
        "taylor_verify.models.euler": "",
    }
    assert [fault.partition(", got ")[2] for fault in detours(sources)] == [
        "taylor_verify.models.euler @ taylor_verify.exact.theta"
    ]


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
