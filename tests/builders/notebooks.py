"""The notebooks of the gallery: cells read from Markdown, and executed in one process as a kernel does.

The pages themselves are executed by MyST-NB when they are built. Here the same cells are run without a
kernel, which would cost each test the time of a new process and of all imports.
"""

from __future__ import annotations

import ast
import contextlib
import io
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from builders.worked import DOCS

GALLERY: Final = DOCS / "gallery"
NOTEBOOKS: Final = sorted(GALLERY.glob("*.md"))
HIDDEN: Final = "remove-cell"

_CELL: Final = re.compile(
    r"^```\{code-cell\}[^\n]*\n(?P<options>(?::[^\n]*\n)*)(?P<code>.*?)^```$",
    re.MULTILINE | re.DOTALL,
)


@dataclass(frozen=True)
class Cell:
    """A cell: its code, the line on which its code begins, and whether readers see it."""

    code: str
    line: int
    is_shown: bool


@dataclass(frozen=True)
class Output:
    """A result of a cell: what it prints, and what it shows of its last expression."""

    printed: str
    shown: str


def cells(text: str) -> list[Cell]:
    """Return the cells of a notebook in their order."""
    return [
        Cell(cell["code"], text.count("\n", 0, cell.start("code")), HIDDEN not in cell["options"])
        for cell in _CELL.finditer(text)
    ]


def execute(text: str, name: str) -> list[Output]:
    """Execute all cells from top to bottom, and return what each puts out.

    An error of a cell is raised as it is, with the line of the page in its traceback.
    """
    names: dict[str, Any] = {"__name__": "__main__"}
    return [_executed(cell, name, names) for cell in cells(text)]


def _executed(cell: Cell, name: str, names: dict[str, Any]) -> Output:
    # Empty lines above make a traceback name the line of the page.
    tree = ast.parse("\n" * cell.line + cell.code, name)
    last = tree.body.pop() if tree.body and isinstance(tree.body[-1], ast.Expr) else None
    with contextlib.redirect_stdout(io.StringIO()) as out:
        exec(compile(tree, name, "exec"), names)
        value = eval(compile(ast.Expression(last.value), name, "eval"), names) if last else None
    return Output(out.getvalue(), "" if value is None else _shown(value))


def _shown(value: Any) -> str:
    """Return HTML where a value has it, as a notebook shows it, and else its text."""
    html = getattr(value, "_repr_html_", None)
    return str(html()) if html else repr(value)


def title(page: Path) -> str:
    """Return the title of a notebook."""
    return re.findall(r"^# (.+)$", page.read_text(encoding="utf-8"), re.MULTILINE)[0]
