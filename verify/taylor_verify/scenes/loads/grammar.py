"""The grammar of expressions: a text becomes elementary steps, and nothing in it is evaluated by Python.

+ - * / and powers (^ or **, so that -x^2 is -(x^2)), brackets, functions, names, and ``A if t < B else C``.
Every fault of a text is noted with its column, counted from 1.
"""

from __future__ import annotations

import ast
import re
import warnings
from collections.abc import Callable
from contextlib import suppress
from decimal import Decimal
from fractions import Fraction
from operator import ge, gt, le, lt
from typing import Any, Final, NamedTuple

from taylor_verify.scenes.loads.steps import FUNCTIONS, JUMPS, NoStep, Steps

MOST_CHARACTERS: Final = 4000
MOST_DEPTH: Final = 100
# The depth of a text with all that its names lead to; a name counts as this many brackets.
_MOST_DEPTH_IN_ALL: Final = 150
_DEPTH_OF_NAME: Final = 3
_MOST_EXPONENT: Final = 5000
_NOT_SO_DEEP: Final = f"brackets, or sums without brackets, at most {MOST_DEPTH} deep"
_LITERAL: Final = re.compile(r"(?:\d+\.?\d*|\.\d+)(?:[eE]([+-]?\d+))?")
_NOT_ALLOWED: Final = re.compile(r"[^\w \t.,+\-*/^()<>=]|[^\x00-\x7f]")
# What Python says of a bracket that stands alone, and what is missing.
_BRACKETS: Final = {
    "'(' was never closed": "a `)` that closes this bracket",
    "unmatched ')'": "a `(` for this bracket",
}
_OPERATIONS: Final[dict[type[ast.operator], str]] = {
    ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/",
}  # fmt: skip
_OTHERS: Final = {"atan2": 2, "pow": 2, "clip": 3, **dict.fromkeys(JUMPS, 1)}
_OF_SEVERAL: Final = ("min", "max", "norm")
ALL_FUNCTIONS: Final = (*FUNCTIONS, *_OTHERS, *_OF_SEVERAL)
_COMPARISONS: Final[dict[type[ast.cmpop], Callable[[Any, Any], bool]]] = {
    ast.Lt: lt, ast.LtE: le, ast.Gt: gt, ast.GtE: ge,
}  # fmt: skip


class Fault(NamedTuple):
    """A fault of a text: the place of the text, the column, what was expected there, and what came."""

    place: str
    column: int
    expected: str
    got: str


class Unread(ValueError):
    """A text, or a name that leads to one, that has faults; they are noted, those of a text said."""


class Grammar:
    """Reads texts into steps.

    ``named`` gives the step of a name. It raises NoStep for one that is unknown. ``is_past`` says whether
    slope t + value is not negative: a switch belongs to the later piece; ``on_stairs`` gives its floor.
    With ``may_jump`` a text may jump with the state. ``faults`` are those of the texts read so far.
    """

    def __init__(
        self,
        steps: Steps,
        named: Callable[[str], int],
        is_past: Callable[[Fraction, Fraction], bool],
        on_stairs: Callable[[Fraction, Fraction], int],
    ) -> None:
        self.steps, self._named, self._is_past, self._on_stairs = steps, named, is_past, on_stairs
        self.may_jump = False
        self.faults: list[Fault] = []
        self._source = Source.of("0", "")
        self._outer_depth = 0

    def read(self, text: str, place: str = "") -> int:
        """The step that a text writes. Raises Unread after noting its faults with its place."""
        outer, before = self._source, len(self.faults)
        self._source = Source.of(text, place)
        try:
            step = self._place(self._tree(text), 0)
        finally:
            self._source = outer
        if step is None or len(self.faults) > before:
            raise Unread(
                "; ".join(f"expected {f.expected}, got {f.got}" for f in self.faults[before:])
            )
        return step

    def _tree(self, text: str) -> ast.expr:
        if len(text) > MOST_CHARACTERS:
            raise self._refusal(0, f"at most {MOST_CHARACTERS} characters", "more")
        if strange := _NOT_ALLOWED.search(text):
            expected = "numbers, names, brackets and + - * / ^"
            self.faults.append(
                Fault(self._source.place, strange.start() + 1, expected, ascii(strange[0]))
            )
            raise Unread
        if (column := _too_deep(text)) is not None:
            raise self._refusal(column, _NOT_SO_DEEP, "a deeper one")
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                return ast.parse(self._source.python, mode="eval").body
        except SyntaxError as error:
            offset = (error.offset or 1) - 1
            if error.msg in _BRACKETS:
                raise self._refusal(offset, _BRACKETS[error.msg], "none") from None
            rest = self._source.python[offset:].replace("**", "^")[:20]
            raise self._refusal(
                offset, "an expression", f"`{rest}`" if rest else "its end"
            ) from None
        except (ValueError, RecursionError, MemoryError):
            raise self._refusal(0, _NOT_SO_DEEP, "a deeper one") from None

    def _refusal(self, offset: int, expected: str, got: str) -> Unread:
        self.faults.append(Fault(self._source.place, self._source.column(offset), expected, got))
        return Unread()

    # The tree. A part with a fault is None, and so is everything that is made of it.

    def _place(self, node: ast.expr, depth: int) -> int | None:
        if depth > MOST_DEPTH:
            return self._fault(node, _NOT_SO_DEEP, "a deeper one")
        if self._outer_depth + depth > _MOST_DEPTH_IN_ALL:
            return self._fault(node, "a shorter chain of names", "one that is too deep")
        match node:
            case ast.Constant():
                return self._number(node)
            case ast.Name(id=name):
                return self._made(node, lambda: self._meaning(name, depth))
            case ast.UnaryOp(op=ast.UAdd(), operand=operand):
                return self._place(operand, depth + 1)
            case ast.UnaryOp(op=ast.USub(), operand=operand):
                a = self._place(operand, depth + 1)
                return None if a is None else self._negative(node, a)
            case ast.BinOp(left=left, op=ast.Pow(), right=right):
                return self._power(node, left, right, depth)
            case ast.BinOp(left=left, op=operator, right=right) if type(operator) in _OPERATIONS:
                a, b = self._place(left, depth + 1), self._place(right, depth + 1)
                if a is None or b is None:
                    return None
                name = _OPERATIONS[type(operator)]
                return self._made(node, lambda: self.steps.combined(name, a, b))
            case ast.Call(func=ast.Name(id=name), args=arguments, keywords=[]):
                return self._call(node, name, arguments, depth)
            case ast.IfExp(test=test, body=body, orelse=other):
                return self._choice(test, body, other, depth)
        return self._fault(node, "numbers, names, + - * / ^ and functions", self._shown(node))

    def _meaning(self, name: str, depth: int) -> int:
        outer, self._outer_depth = self._outer_depth, self._outer_depth + depth + _DEPTH_OF_NAME
        try:
            return self._named(name)
        finally:
            self._outer_depth = outer

    def _negative(self, node: ast.expr, a: int) -> int | None:
        zero = self.steps.number(Fraction(0))
        return self._made(node, lambda: self.steps.combined("-", zero, a))

    def _number(self, node: ast.Constant) -> int | None:
        literal = self._source.python[node.col_offset : node.end_col_offset]
        number = _LITERAL.fullmatch(literal)
        if number is None:
            return self._fault(node, "a decimal number", literal[:20])
        if abs(int(number[1] or 0)) > _MOST_EXPONENT:
            return self._fault(node, f"powers of ten up to {_MOST_EXPONENT}", literal[:20])
        return self._made(node, lambda: self.steps.number(Fraction(Decimal(literal))))

    def _power(self, node: ast.expr, base: ast.expr, exponent: ast.expr, depth: int) -> int | None:
        a, e = self._place(base, depth + 1), self._place(exponent, depth + 1)
        return None if a is None or e is None else self._made(node, lambda: self._raised(a, e))

    def _raised(self, a: int, e: int) -> int:
        """a^e: a rational power, or exp(e log a)."""
        exponent = self.steps.value(e)
        if exponent is not None:
            return self.steps.power(a, exponent)
        steps = self.steps
        return steps.function("exp", steps.combined("*", e, steps.function("log", a)))

    def _no_function(self, name: str) -> tuple[str, str]:
        """Return what was expected, and what came, where a name is called that is no function."""
        with suppress(NoStep, Unread):
            self._named(name)
            return f"`{name}` alone, as a name of the scene takes no arguments", f"`{name}(..)`"
        return f"a function ({', '.join(sorted(ALL_FUNCTIONS))})", f"`{name}`"

    def _call(self, node: ast.expr, name: str, arguments: list[ast.expr], depth: int) -> int | None:
        if name not in ALL_FUNCTIONS:
            return self._fault(node, *self._no_function(name))
        count = _OTHERS.get(name, 1)
        if (name in _OF_SEVERAL and not arguments) or (
            name not in _OF_SEVERAL and len(arguments) != count
        ):
            expected = "some numbers" if name in _OF_SEVERAL else _arguments(count)
            return self._fault(node, f"{expected} in {name}()", str(len(arguments)))
        places = [self._place(argument, depth + 1) for argument in arguments]
        known = [place for place in places if place is not None]
        if len(known) < len(places):
            return None
        return self._made(node, lambda: self._applied(name, known))

    def _applied(self, name: str, places: list[int]) -> int:
        steps = self.steps
        match name:
            case "min" | "max":
                place = places[0]
                for other in places[1:]:
                    place = steps.combined(name, place, other)
                return place
            case "norm":
                return steps.norm(tuple(places))
            case "clip":
                x, low, high = places
                return steps.combined("min", steps.combined("max", x, low), high)
            case "atan2":
                return steps.angle(*places)
            case "pow":
                return self._raised(*places)
            case "step" | "sign" | "floor":
                return self._jump(name, places[0])
        return steps.function(name, places[0])

    def _jump(self, name: str, place: int) -> int:
        """step, sign or floor: of a number, by the time alone, or else a step of its own."""
        value, line = self.steps.value(place), self.steps.line(place)
        if value is not None:
            return self.steps.number(JUMPS[name](value))
        if line is None:
            return self._by_state(name, (place,))
        if name == "floor":
            return self.steps.number(Fraction(self._on_stairs(*line)))
        is_past = self._is_past(*line)
        return self.steps.number(Fraction(int(is_past) if name == "step" else 2 * is_past - 1))

    def _by_state(self, name: str, operands: tuple[int, ...]) -> int:
        if self.may_jump:
            return self.steps.jump(name, operands)
        raise NoStep(
            "a condition that is linear in t alone, with rational numbers, outside held values",
            "another one: the load would jump with the state",
        )

    def _choice(self, test: ast.expr, body: ast.expr, other: ast.expr, depth: int) -> int | None:
        """The branch that the piece of time asks for; both are read, so that all faults are noted."""
        places = self._place(body, depth + 1), self._place(other, depth + 1)
        match test:
            case ast.Compare(left=left, ops=[operator], comparators=[right]) if isinstance(
                operator, ast.Lt | ast.LtE | ast.Gt | ast.GtE
            ):
                a, b = self._place(left, depth + 1), self._place(right, depth + 1)
            case _:
                return self._fault(test, "one comparison with < or >", self._shown(test))
        if a is None or b is None:
            return None
        first, second = places
        if first is None or second is None:
            return None
        return self._made(test, lambda: self._chosen(type(operator), (a, b), (first, second)))

    def _chosen(
        self, operator: type[ast.cmpop], sides: tuple[int, int], places: tuple[int, int]
    ) -> int:
        """The first place if the sides compare, else the second; by the time, equal sides do not matter."""
        is_less, is_swapped = operator in (ast.Lt, ast.LtE), operator in (ast.LtE, ast.Gt)
        difference = self.steps.combined("-", *sides)
        value, line = self.steps.value(difference), self.steps.line(difference)
        if value is not None:
            return places[int(not _COMPARISONS[operator](value, 0))]
        if line is not None:
            return places[int(self._is_past(*line) is is_less)]
        # With a - b >= 0, or b - a >= 0 where equal sides count on the other hand.
        condition = self.steps.combined("-", *sides[::-1]) if is_swapped else difference
        ordered = places[::-1] if operator in (ast.Lt, ast.Gt) else places
        return self._by_state("choose", (condition, *ordered))

    # Faults.

    def _made(self, node: ast.expr, make: Callable[[], int]) -> int | None:
        try:
            return make()
        except NoStep as fault:
            return self._fault(node, fault.expected, fault.got)
        except Unread:
            return None

    def _fault(self, node: ast.expr, expected: str, got: str) -> int | None:
        """Note a fault, and return what a part with one is."""
        self._refusal(node.col_offset, expected, got)
        return None

    def _shown(self, node: ast.expr) -> str:
        segment = self._source.python[node.col_offset : node.end_col_offset]
        return f"`{segment.replace('**', '^')[:20]}`"


def _too_deep(text: str) -> int | None:
    """Return the place of the bracket that is one too many within others; None without one."""
    depth = 0
    for place, character in enumerate(text):
        depth += (character == "(") - (character == ")")
        if depth > MOST_DEPTH:
            return place
    return None


def _arguments(count: int) -> str:
    return "one number" if count == 1 else f"{count} numbers"


class Source(NamedTuple):
    """A text as Python writes it, with the column in the text as written of each character.

    ``place`` is where the text stands in its scene.
    """

    python: str
    columns: list[int]
    place: str

    @classmethod
    def of(cls, text: str, place: str) -> Source:
        begin = len(text) - len(text.lstrip())
        written = [(text[i], i + 1) for i in range(begin, len(text))]
        pairs = [(c, column) for sign, column in written for c in ("**" if sign == "^" else sign)]
        return cls("".join(c for c, _ in pairs), [column for _, column in pairs], place)

    def column(self, offset: int) -> int:
        """The column of an offset; the one behind the end for what is missing there."""
        if offset < len(self.columns):
            return self.columns[offset]
        return self.columns[-1] + 1 if self.columns else 1
