"""Elementary steps: an expression as a list of operations, each on steps before it.

Rational numbers are computed exactly as the list grows. A function of a number that is no rational number,
such as sqrt(2), stays a step.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import reduce
from math import isqrt
from typing import Final

MOST_STEPS: Final = 2000
MOST_POWER: Final = 64
MOST_BITS: Final = 100_000
# Of all rational numbers that are combined: a few products of the longest ones take a tenth of a second.
MOST_BITS_IN_ALL: Final = 4_000_000

# Operations with one operand, and what they make of zero, if that is rational.
FUNCTIONS: Final[Mapping[str, int | None]] = {
    "sqrt": 0, "exp": 1, "log": None, "sin": 0, "cos": 1, "tan": 0, "asin": 0, "acos": None,
    "atan": 0, "sinh": 0, "cosh": 1, "tanh": 0, "abs": 0,
}  # fmt: skip
# What these make of a number has more bits than half of it.
_GROWING: Final = ("exp", "sinh", "cosh")
# Operations that jump with their one operand, at rational numbers.
JUMPS: Final[Mapping[str, Callable[[Fraction], Fraction]]] = {
    "step": lambda a: Fraction(int(a >= 0)),
    "sign": lambda a: Fraction((a > 0) - (a < 0)),
    "floor": lambda a: Fraction(a // 1),
}
_STRENGTH: Final = {"+": 1, "-": 1, "*": 2, "/": 2, "power": 3}
_STRONGEST, _LONGEST_TEXT = 9, 80
_ARITHMETIC: Final[Mapping[str, Callable[[Fraction, Fraction], Fraction]]] = {
    "+": lambda a, b: a + b,
    "-": lambda a, b: a - b,
    "*": lambda a, b: a * b,
    "/": lambda a, b: a / b,
    "min": min,
    "max": max,
}


class NoStep(ValueError):
    """A step that there is not: ``expected`` and ``got`` say why."""

    def __init__(self, expected: str, got: str) -> None:
        super().__init__(f"expected {expected}, got {got}")
        self.expected, self.got = expected, got


def too_long() -> NoStep:
    """Return the error for a number of more bits than a scene may have."""
    return NoStep(f"numbers of at most {MOST_BITS} bits", "a longer one")


@dataclass(frozen=True)
class Step:
    """Operation on the steps at the places ``operands``.

    ``number`` is the value of a "number" and the exponent of a "power"; ``name`` is that of an "input".
    """

    operation: str
    operands: tuple[int, ...] = ()
    number: Fraction | None = None
    name: str = ""


def needed(steps: Sequence[Step], places: Sequence[int]) -> list[int]:
    """Return the places of the steps that those at some places are made of, in order."""
    left, reached = list(places), set[int]()
    while left:
        place = left.pop()
        if place not in reached:
            reached.add(place)
            left += steps[place].operands
    return sorted(reached)


def text_of(steps: Sequence[Step], place: int) -> str:
    """Return a step as text in the grammar of the scene; of long parts, dots."""
    texts: dict[int, tuple[str, int]] = {}
    for k in needed(steps, [place]):
        text, strength = _text(steps[k], [texts[operand] for operand in steps[k].operands])
        is_short = len(text) <= _LONGEST_TEXT
        texts[k] = (text, strength) if is_short else (f"{steps[k].operation}(...)", _STRONGEST)
    return texts[place][0]


def text_with_address(steps: Sequence[Step], place: int, outputs: Iterable[tuple[str, int]]) -> str:
    """Return a step as text, with the address of the first output that needs it."""
    places = (address for address, output in outputs if place in needed(steps, [output]))
    return f"{text_of(steps, place)} in {next(places, 'a load')}"


def _text(step: Step, operands: Sequence[tuple[str, int]]) -> tuple[str, int]:
    """Return the text of a step from those of its operands, and how strongly it binds."""
    if step.operation in ("number", "input", "pi"):
        number = step.operation if step.number is None else str(step.number)
        return step.name or number, _STRONGEST
    strength = _STRENGTH.get(step.operation)
    if strength is None:
        return f"{step.operation}({', '.join(text for text, _ in operands)})", _STRONGEST
    parts = [
        f"({text})" if own < strength + place else text
        for place, (text, own) in enumerate(operands)
    ]
    if step.operation == "power":
        return f"{parts[0]}^({step.number})", strength
    if step.operation == "+":
        # 4 - t, and not -t + 4.
        parts.sort(key=lambda part: part.startswith("-"))
    text = f" {step.operation} ".join(parts)
    return text.replace("-1 * ", "-").replace("+ -", "- "), strength


class Steps:
    """A list of steps that grows; equal steps are one."""

    def __init__(self) -> None:
        self.steps: list[Step] = []
        self._places: dict[Step, int] = {}
        self._lines: list[tuple[Fraction, Fraction] | None] = []
        self._bits = 0

    def _count_bits(self, *values: Fraction) -> None:
        """Count what exact arithmetic works on. Raises NoStep where it is too much for one scene."""
        self._bits += sum(v.numerator.bit_length() + v.denominator.bit_length() for v in values)
        if self._bits > MOST_BITS_IN_ALL:
            raise NoStep(f"exact numbers of at most {MOST_BITS_IN_ALL} bits in all", "more")

    def number(self, value: Fraction) -> int:
        """The place of an exact number. Raises NoStep for a number of too many digits."""
        if max(value.numerator.bit_length(), value.denominator.bit_length()) > MOST_BITS:
            raise too_long()
        return self._place(Step("number", number=value), (Fraction(0), value))

    def input(self, name: str) -> int:
        """The place of an input, such as the time ``t``."""
        return self._place(Step("input", name=name), _TIME_ITSELF if name == "t" else None)

    def constant(self, name: str) -> int:
        """The place of a constant that no rational number is: "pi"."""
        return self._place(Step(name))

    def _place(self, step: Step, line: tuple[Fraction, Fraction] | None = None) -> int:
        if step not in self._places:
            if len(self.steps) >= MOST_STEPS:
                raise NoStep(f"at most {MOST_STEPS} steps in all", "more")
            self._places[step] = len(self.steps)
            self.steps.append(step)
            self._lines.append(line)
        return self._places[step]

    def value(self, place: int) -> Fraction | None:
        """The rational number that a step is, or None."""
        step = self.steps[place]
        return step.number if step.operation == "number" else None

    def line(self, place: int) -> tuple[Fraction, Fraction] | None:
        """Slope and value at t = 0 of a step that is linear in t alone, with rational numbers; or None."""
        return self._lines[place]

    # Operations.

    def combined(self, operation: str, a: int, b: int) -> int:
        """The place of a sum, difference, product, quotient, or of the smaller or larger of two steps."""
        p, q = self.value(a), self.value(b)
        if operation == "/" and q == 0:
            raise NoStep("a divisor that is not zero", "0")
        if p is not None and q is not None:
            self._count_bits(p, q)
            return self.number(_ARITHMETIC[operation](p, q))
        if (alike := self._unchanged(operation, a, b, p, q)) is not None:
            return alike
        line = self._line_of(operation, a, b)
        return self._place(Step(operation, (a, b))) if line is None else self._on_line(*line)

    def _on_line(self, slope: Fraction, value: Fraction) -> int:
        """The place of slope t + value, which is written in one way."""
        time = place = self.input("t")
        if slope != 1:
            factor = self.number(slope)
            place = self._place(Step("*", (factor, time)), (slope, Fraction(0)))
        if not slope or not value:
            return place if slope else self.number(value)
        return self._place(Step("+", (place, self.number(value))), (slope, value))

    def _unchanged(
        self, operation: str, a: int, b: int, p: Fraction | None, q: Fraction | None
    ) -> int | None:
        """The one of two operands, where the other changes nothing, or makes it zero."""
        if operation in ("min", "max") and a == b:
            return a
        if (operation in "+-" and q == 0) or (operation in "*/" and q == 1):
            return a
        if (operation == "+" and p == 0) or (operation == "*" and p == 1):
            return b
        if (operation in "*/" and p == 0) or (operation == "*" and q == 0):
            return self.number(Fraction(0))
        return None

    def _line_of(self, operation: str, a: int, b: int) -> tuple[Fraction, Fraction] | None:
        first, second = self._lines[a], self._lines[b]
        if first is None or second is None or operation in ("min", "max"):
            return None
        self._count_bits(*first, *second)
        if operation in "+-":
            rule = _ARITHMETIC[operation]
            return rule(first[0], second[0]), rule(first[1], second[1])
        if operation == "*" and not first[0]:
            first, second = second, first
        if second[0]:
            return None
        factor = second[1] if operation == "*" else 1 / second[1]
        return first[0] * factor, first[1] * factor

    def total(self, places: list[int]) -> int:
        """The place of the sum of steps."""
        return reduce(lambda a, b: self.combined("+", a, b), places, self.number(Fraction(0)))

    def function(self, name: str, a: int) -> int:
        """The place of a function of one step."""
        value = self.value(a)
        if value is not None:
            self._count_bits(value)
            if name in _GROWING and 3 * abs(value) > 2 * MOST_BITS:
                raise too_long()
            if name == "abs":
                return self.number(abs(value))
            if name == "log" and value == 1:
                return self.number(Fraction(0))
            if name in ("sqrt", "log") and (value < 0 or (name == "log" and not value)):
                raise NoStep(f"a number of which there is a {name}", str(value))
            if name in ("asin", "acos") and abs(value) > 1:
                raise NoStep(f"a number from -1 to 1 for {name}", str(value))
            if value == 0 and (at_zero := FUNCTIONS[name]) is not None:
                return self.number(Fraction(at_zero))
            if name == "sqrt" and (root := exact_root(value)) is not None:
                return self.number(root)
        return self._place(Step(name, (a,)))

    def jump(self, name: str, operands: tuple[int, ...]) -> int:
        """The place of "step", "sign" or "floor" of one step, or of "choose" among two by a third."""
        return self._place(Step(name, operands))

    def angle(self, y: int, x: int) -> int:
        """The place of atan2(y, x)."""
        if self.value(y) == 0 and self.value(x) == 0:
            raise NoStep("a point other than the origin for atan2", "0, 0")
        return self._place(Step("atan2", (y, x)))

    def norm(self, places: tuple[int, ...]) -> int:
        """The place of the root of the sum of squares."""
        values = [self.value(place) for place in places]
        known = [value for value in values if value is not None]
        if len(known) == len(values):
            self._count_bits(*known, *known)
            return self.function("sqrt", self.number(sum((v * v for v in known), Fraction(0))))
        moving = tuple(p for p, value in zip(places, values, strict=True) if value != 0)
        return (
            self.function("abs", moving[0])
            if len(moving) == 1
            else self._place(Step("norm", moving))
        )

    def power(self, a: int, exponent: Fraction) -> int:
        """The place of a step to a rational power."""
        if exponent == 1:
            return a
        if exponent == Fraction(1, 2):
            return self.function("sqrt", a)
        if exponent.denominator == 1 and abs(exponent) > MOST_POWER:
            raise NoStep(f"a whole power of at most {MOST_POWER}", str(exponent))
        value = self.value(a)
        if value is not None:
            self._count_bits(value)
            if value == 0 and exponent < 0:
                raise NoStep("a base that is not zero", "0")
            if exponent.denominator == 1:
                return self._whole_power(value, int(exponent))
            if value < 0:
                raise NoStep("a base that is not negative", str(value))
            _check_length(value, exponent)
        return self._place(Step("power", (a,), exponent)) if exponent else self.number(Fraction(1))

    def _whole_power(self, value: Fraction, exponent: int) -> int:
        _check_length(value, exponent)
        return self.number(value**exponent)


def _check_length(value: Fraction, exponent: Fraction | int) -> None:
    """Raise NoStep for a power of too many bits."""
    bits = max(value.numerator.bit_length(), value.denominator.bit_length())
    if bits * abs(Fraction(exponent)) > 2 * MOST_BITS:
        raise too_long()


_TIME_ITSELF: Final = (Fraction(1), Fraction(0))


def exact_root(value: Fraction) -> Fraction | None:
    """The square root of a rational number that is not negative, if it is rational."""
    above, below = isqrt(value.numerator), isqrt(value.denominator)
    root = Fraction(above, below)
    return root if root * root == value else None
