"""A mutant: the text of a module with one operator, sign or small constant changed."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from typing import Final

VERIFY: Final = Path(__file__).resolve().parents[2] / "verify"
PACKAGE: Final = VERIFY / "taylor_verify"

_ARITHMETIC: Final[dict[type, type]] = {
    **{ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult},
    **{ast.FloorDiv: ast.Mult, ast.Mod: ast.Mult, ast.Pow: ast.Mult},
    **{ast.LShift: ast.RShift, ast.RShift: ast.LShift},
}
_COMPARISONS: Final[dict[type, type]] = {
    **{ast.Lt: ast.LtE, ast.LtE: ast.Lt, ast.Gt: ast.GtE, ast.GtE: ast.Gt},
    **{ast.Eq: ast.NotEq, ast.NotEq: ast.Eq, ast.Is: ast.IsNot, ast.IsNot: ast.Is},
    **{ast.In: ast.NotIn, ast.NotIn: ast.In},
}


@dataclass(frozen=True)
class Mutant:
    """One change of one module, told by the lines of the code that it makes differ."""

    path: str  # from the package on, with slashes
    place: int  # among all mutants of the module
    line: int
    statement: range  # the lines around it, without those of a body
    is_imported: bool  # run when the module is imported, and in no function
    before: str
    after: str
    text: str

    def __str__(self) -> str:
        return f"{self.path}:{self.line}\n  - {self.before}\n  + {self.after}"


def module_name(path: str) -> str:
    """Return the full name of the module at a path."""
    return "taylor_verify." + path.removesuffix(".py").replace("/", ".")


def lines(source: str) -> list[int]:
    """Return the line of each mutant of a module."""
    return [node.lineno for node, _ in _changes(ast.parse(source))]  # type: ignore[attr-defined]


def count(source: str) -> int:
    """Return how many mutants a module has."""
    return len(lines(source))


def changed(source: str, place: int) -> ast.Module:
    """Return the code of one mutant, with the lines that the source has."""
    tree = ast.parse(source)
    node, fields = next(islice(_changes(tree), place, None))
    node.__dict__.update(fields)
    return tree


def mutant(path: str, source: str, place: int) -> Mutant:
    """Return one mutant of a module, counted from 0 in the order of its code."""
    sound = ast.unparse(ast.parse(source)).splitlines()
    text = ast.unparse(changed(source, place))
    ((before, after),) = ((a, b) for a, b in zip(sound, text.splitlines(), strict=True) if a != b)
    line = lines(source)[place]
    statement, is_imported = _statement(ast.parse(source), line)
    return Mutant(path, place, line, statement, is_imported, before.strip(), after.strip(), text)


def _statement(tree: ast.AST, line: int) -> tuple[range, bool]:
    """Return the lines of the statement of a line, without its body; and whether an import runs it."""
    lines, is_imported = range(line, line + 1), True
    for node in ast.walk(tree):
        if isinstance(node, ast.stmt) and node.lineno <= line <= (node.end_lineno or node.lineno):
            body = getattr(node, "body", None)
            end = body[0].lineno if body else (node.end_lineno or node.lineno) + 1
            lines = range(node.lineno, end)
            is_imported &= not (isinstance(node, ast.FunctionDef) and line >= end)
    return lines, is_imported


def _changes(node: ast.AST) -> Iterator[tuple[ast.AST, dict[str, object]]]:
    """Yield each node that can be changed, with the fields that it then has."""
    match node:
        case ast.BinOp(op=op) | ast.AugAssign(op=op) if type(op) in _ARITHMETIC:
            yield node, {"op": _ARITHMETIC[type(op)]()}
        case ast.Compare(ops=[op, *others]):
            yield node, {"ops": [_COMPARISONS[type(op)](), *others]}
        case ast.BoolOp(op=op):
            yield node, {"op": ast.Or() if isinstance(op, ast.And) else ast.And()}
        case ast.UnaryOp(op=ast.USub()):
            yield node, {"op": ast.UAdd()}
        case ast.Constant(value=bool(value)):
            yield node, {"value": not value}
        case ast.Constant(value=int(value) | float(value)) if abs(value) <= 16:
            yield node, {"value": value + 1}
    for child in _read_when_run(node):
        yield from _changes(child)


def _read_when_run(node: ast.AST) -> Iterator[ast.AST]:
    """Yield the children of a node, but for types, decorators and words.

    A ``strict`` of zip is left out too: it is there for what never happens.
    """
    match node:
        case ast.JoinedStr():
            return
        case ast.keyword(arg="strict"):
            return
        case ast.Raise():
            return
    for name, value in ast.iter_fields(node):
        if name not in {"annotation", "returns", "decorator_list", "type_params"}:
            children = value if isinstance(value, list) else [value]
            yield from (child for child in children if isinstance(child, ast.AST))


def places(*rooms: str) -> list[tuple[str, int]]:
    """Return module and number of every mutant of these rooms, such as ``exact`` or ``judge/floor``."""
    return [
        (file.relative_to(PACKAGE).as_posix(), place)
        for room in rooms
        for file in sorted((PACKAGE / room).rglob("*.py"))
        for place in range(count(file.read_text(encoding="utf-8")))
    ]
