"""Trap: a plain call of heyoka, its report, its error, and the driver's behaviour."""

from __future__ import annotations

import ast
import inspect
import textwrap
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import Any, Final

from taylor_verify.solvers.taylor.cache import heyoka_cache_off
from traps.document import TrapCase, TrapRow

DOCS: Final = "https://bluescarni.github.io/heyoka.py"


class Cause(StrEnum):
    """The origin of a trap; the values are published."""

    DOCUMENTED = "by design, and documented"
    CONSEQUENCE = "follows from a documented rule"
    PARTLY = "documented in part"
    DESIGN = "by design, as we take it; not documented, as far as we found"
    CONTRADICTED = "the documentation says otherwise"
    FAULT = "a fault, as we see it"
    ARITHMETIC = "floating point, whoever computes"


@dataclass(frozen=True)
class Trap:
    """A trap; ``calls`` are the published functions, ``cases`` measures them.

    ``silent`` tells a call that reports success, or reports nothing. ``documented`` is quoted from
    heyoka's documentation, ``where`` its page below DOCS; ``remark`` is what the quotation leaves
    open. ``script`` is the minimal reproduction.
    """

    key: str
    title: str
    calls: Sequence[Callable[..., Any]]
    cases: Callable[[], list[TrapCase]]
    plain: str
    driver: str
    cause: Cause
    silent: bool = True
    documented: str = ""
    where: str = ""
    remark: str = ""
    script: str = ""

    def measured(self) -> list[TrapCase]:
        """Return the cases, measured without heyoka's own disk cache, as the driver works."""
        heyoka_cache_off()
        return self.cases()

    def row(self) -> TrapRow:
        """Return the words and the measured cases, which the page is made from."""
        return TrapRow(
            key=self.key,
            title=self.title,
            code="\n\n\n".join(shown(call) for call in self.calls),
            plain=self.plain,
            driver=self.driver,
            cause=self.cause.value,
            silent=self.silent,
            documented=self.documented,
            where=f"{DOCS}/{self.where}" if self.where else "",
            remark=self.remark,
            script=self.script,
            cases=tuple(self.measured()),
        )


def shown(function: Callable[..., Any]) -> str:
    """Return the source of a function without its docstring, type hints and import of heyoka.

    The other lines are those that were run.
    """
    lines, _ = inspect.getsourcelines(function)
    (definition,) = ast.parse(textwrap.dedent("".join(lines))).body
    assert isinstance(definition, ast.FunctionDef)
    body = [line for line in definition.body if not isinstance(line, ast.Import)]
    body = body[1:] if ast.get_docstring(definition) else body
    text = "".join(lines[body[0].lineno - 1 :]).rstrip()
    return f"def {definition.name}({_without_hints(definition.args)}):\n{text}"


def _without_hints(arguments: ast.arguments) -> str:
    for argument in [*arguments.args, *filter(None, [arguments.vararg, arguments.kwarg])]:
        argument.annotation = None
    # As the formatter has it, which looks into pages too.
    return ast.unparse(arguments).replace("'", '"')
