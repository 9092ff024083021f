"""A trap: a plain call of heyoka, what it reports, how wrong it is, and what the driver does there."""

from __future__ import annotations

import ast
import inspect
import textwrap
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from enum import StrEnum
from math import isfinite
from typing import Any, Final

from taylor_verify.solvers.taylor.cache import heyoka_cache_off

DOCS: Final = "https://bluescarni.github.io/heyoka.py"


class Cause(StrEnum):
    """Whose a trap is; the value is what is published."""

    DOCUMENTED = "by design, and documented"
    CONSEQUENCE = "follows from a documented rule"
    PARTLY = "documented in part"
    DESIGN = "by design, as we take it; not documented, as far as we found"
    CONTRADICTED = "the documentation says otherwise"
    FAULT = "a fault, as we see it"
    ARITHMETIC = "floating point, whoever computes"


@dataclass(frozen=True)
class Gate:
    """What a gate says of the plain answer: its verdict, and the largest error over its bound."""

    verdict: str
    over_bound: float | None


@dataclass(frozen=True)
class Case:
    """One measured use of the plain call, and of the driver on the same question.

    ``said`` is what heyoka reports and ``driver`` what the driver does. ``error`` and ``driver_error``
    are relative to the size of the true answer; None where nothing is returned that could have one.
    ``gates`` are the judge's on the plain answer, by quantity.
    """

    case: str
    said: str
    error: float | None
    driver: str
    driver_error: float | None = None
    steps: int | None = None
    gates: Mapping[str, Gate] = field(default_factory=dict)

    def row(self) -> dict[str, Any]:
        """As JSON holds it: an error that is not finite is told by ``said`` alone."""
        return {name: _finite(value) for name, value in asdict(self).items()}


@dataclass(frozen=True)
class Trap:
    """``calls`` are the functions that are published, ``cases`` measures them anew.

    ``silent`` tells a call that reports success, or reports nothing. ``documented`` is quoted from
    heyoka's documentation, ``where`` its page below DOCS; ``remark`` is what the quotation leaves
    open. ``script`` is the minimal reproduction.
    """

    key: str
    title: str
    calls: Sequence[Callable[..., Any]]
    cases: Callable[[], list[Case]]
    plain: str
    driver: str
    cause: Cause
    silent: bool = True
    documented: str = ""
    where: str = ""
    remark: str = ""
    script: str = ""

    def measured(self) -> list[Case]:
        """Return the cases, measured without heyoka's own disk cache, as the driver works."""
        heyoka_cache_off()
        return self.cases()

    def row(self) -> dict[str, Any]:
        """Words and numbers: what the page is made from."""
        return {
            "key": self.key,
            "title": self.title,
            "code": "\n\n\n".join(shown(call) for call in self.calls),
            "plain": self.plain,
            "driver": self.driver,
            "cause": self.cause.value,
            "silent": self.silent,
            "documented": self.documented,
            "where": f"{DOCS}/{self.where}" if self.where else "",
            "remark": self.remark,
            "script": self.script,
            "cases": [case.row() for case in self.measured()],
        }


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


def _finite(value: Any) -> Any:
    return None if isinstance(value, float) and not isfinite(value) else value
