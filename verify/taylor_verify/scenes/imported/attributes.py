"""Numbers of an XML file as exact decimals, or faults with the line they stand in."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Final

from taylor_verify.numbers import tensors
from taylor_verify.numbers.precision import as_decimal, decimal_text
from taylor_verify.numbers.tensors import Matrix, Vector
from taylor_verify.records.faults import Faults, shown
from taylor_verify.scenes.imported.tree import Node
from taylor_verify.scenes.reading.table import complete

_DECIMAL: Final = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]{1,3})?")
# These formats hold doubles. A product of a few numbers beyond these sizes could be too large for a scene.
_LONGEST: Final = 60
_SMALLEST: Final = Fraction(1, 10**100)
_LARGEST: Final = Fraction(10**100)


@dataclass(frozen=True)
class Reading:
    """Reads the numbers of one file; a method returns None where it recorded a fault."""

    file: str
    faults: Faults

    def fault(self, expected: str, got: str, node: Node, mend: str = "") -> None:
        self.faults.add(expected, got, f"{self.file}:{node.line} <{node.name}>", mend)

    def vector(
        self,
        node: Node,
        text: str | None,
        what: str,
        length: int = 3,
        default: Vector | None = None,
    ) -> Vector | None:
        """Return ``length`` numbers with blanks between them; ``what`` names them in a fault."""
        if text is None and default is not None:
            return default
        words = (text or "").split()
        if len(words) != length:
            got = shown(text.strip()) if text is not None else "nothing"
            numbers = "a number" if length == 1 else f"{length} numbers"
            self.fault(f"{numbers} for {what}", got, node, _mend(text))
            return None
        return complete([self._number(node, word, what) for word in words])

    def number(
        self, node: Node, text: str | None, what: str, default: Fraction | None = None
    ) -> Fraction | None:
        """Return one number."""
        only = None if default is None else (default,)
        vector = self.vector(node, text, what, length=1, default=only)
        return None if vector is None else vector[0]

    def inner(self, node: Node, name: str, length: int = 3) -> Vector | None:
        """Return the numbers in the child of this name; None where there is none."""
        child = node.child(name)
        return None if child is None else self.vector(child, child.text, name, length)

    def positive(self, node: Node, text: str | None, what: str) -> Fraction | None:
        """Return one number that is greater than zero."""
        number = self.number(node, text, what)
        if number is not None and number <= 0:
            self.fault(f"a positive {what}", shown(number), node)
            return None
        return number

    def tensor(self, node: Node, six: Sequence[Fraction | None]) -> Matrix | None:
        """Return the positive definite tensor of ixx, ixy, ixz, iyy, iyz, izz; None after a fault."""
        known = complete(six)
        if known is None:
            return None
        xx, xy, xz, yy, yz, zz = known
        tensor = ((xx, xy, xz), (xy, yy, yz), (xz, yz, zz))
        if not tensors.is_positive_definite(tensor):
            got = f"ixx, iyy, izz = {', '.join(map(shown, (xx, yy, zz)))} with their products"
            self.fault("a positive definite tensor of inertia", got, node)
            return None
        return tensor

    def _number(self, node: Node, word: str, what: str) -> Fraction | None:
        """Return the decimal, exactly."""
        if len(word) <= _LONGEST and _DECIMAL.fullmatch(word):
            number = Fraction(word)
            if number == 0 or _SMALLEST <= abs(number) <= _LARGEST:
                return number
        self.fault(f"a decimal of usual size for {what}", shown(word), node, _mend(word))
        return None


def _mend(text: str | None) -> str:
    return "xacro has yet to expand it" if text is not None and "${" in text else ""


def is_true(text: str | None) -> bool:
    """Return True for the words that XML Schema has for it."""
    return (text or "").strip().lower() in ("true", "1")


def decimal(value: Fraction) -> str | None:
    """Return the decimal that equals the number; None if it has no end."""
    exact = as_decimal(value)
    return None if exact is None else decimal_text(exact)
