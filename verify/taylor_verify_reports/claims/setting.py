"""Settings, the symbols that equations are about, and equations written as text in these symbols.

    CIRCLE = Exact({"x": 3, "y": 4}, "turn(x=-y, y=x)", roots={"r": "x**2 + y**2"})
    check = CIRCLE("d(x) = -y", "x**2 + y**2 = r**2")

An equation is a chain of members with `` = `` between them, each a Python expression: numbers, vectors and
matrices (`@` multiplies them), NumPy's functions of arrays, and d, the derivative with respect to time. A
statement with one thing changed is the text with other words in it. The texts are those of this package
alone, and every one is evaluated in the tests.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, reduce
from textwrap import dedent
from typing import Any, Final, final

import numpy as np
from mpmath import mp

from taylor_verify.numbers.rotation import rotation_matrix
from taylor_verify_reports.claims.check import Residual, Worded
from taylor_verify_reports.claims.field import Field, Point

_BECAUSE: Final = "expanded in exact rationals: an identity leaves zero"


class Setting(ABC):
    """The symbols that equations are about; called with equations, the check that they hold."""

    @abstractmethod
    def residual(self, equations: Iterable[str]) -> Residual:
        """Compare the members of each equation with its first."""

    def __call__(self, *equations: str) -> Equations:
        return Equations(self, equations)


@final
@dataclass(frozen=True)
class Equations(Worded):
    """The check that some equations hold in a setting."""

    setting: Setting
    texts: tuple[str, ...]

    def __call__(self) -> Residual:
        return self.setting.residual(self.texts)

    def says(self, words: str) -> bool:
        return any(words in text for text in self.texts)

    def but(self, old: str, new: str) -> Equations:
        return Equations(self.setting, tuple(text.replace(old, new) for text in self.texts))


def differences(equations: Iterable[str], symbols: dict[str, Any]) -> list[Any]:
    """The differences of all members from the first of their equation, arrays entry by entry."""
    result: list[Any] = []
    for equation in equations:
        first, *others = (np.asarray(eval(text, symbols)) for text in equation.split(" = "))
        if not others:
            raise ValueError(f"expected members with ' = ' between them, got {equation!r}")
        for other in others:
            result += [*np.ravel(first - other)]
    return result


@final
class Exact(Setting):
    """Symbols of a field: equations hold if their differences vanish identically.

    ``point`` and ``roots`` are those of a Field. ``definitions`` are lines of Python with the names of the
    field for variables; its last are often the rates, ``turn(x=...)``. A difference that is no zero
    has the size of its value at the point.
    """

    def __init__(
        self, point: Point, definitions: str = "", roots: Mapping[str, str] | None = None
    ) -> None:
        self._point, self._definitions, self._roots = point, definitions, roots

    @cached_property
    def field(self) -> Field:
        return Field(self._point, self._roots)

    @cached_property
    def symbols(self) -> dict[str, Any]:
        """The names by which equations are evaluated, made when they are first asked for."""
        field = self.field
        functions = {name: getattr(field, name) for name in ("turn", "partial", "grad", "at")}
        symbols = _FUNCTIONS | functions | {"d": field.rate} | field.symbols
        exec(dedent(self._definitions), symbols)
        return symbols

    def __getitem__(self, name: str) -> Any:
        return self.symbols[name]

    def residual(self, equations: Iterable[str]) -> Residual:
        elements = [self.field.element(d) for d in differences(equations, self.symbols)]
        if not elements:
            return Residual(float("nan"), bound=0.0, because="nothing was compared")
        nonzero = [self.field.size(d) for d in elements if not d.is_zero]
        # A polynomial that is no zero but vanishes at the point says nothing of its size.
        size = (max(nonzero) or float("nan")) if nonzero else 0.0
        return Residual(size, bound=0.0, because=_BECAUSE)


@final
class Numeric(Setting):
    """Numbers along a trajectory: equations hold if their differences stay within a bound.

    ``rows`` gives the names and their numbers at each time, to ``digits`` digits.
    """

    def __init__(
        self, rows: Callable[[], Iterable[dict[str, Any]]], digits: int, bound: float, because: str
    ) -> None:
        self._rows, self._digits, self._bound, self._because = rows, digits, bound, because

    def residual(self, equations: Iterable[str]) -> Residual:
        texts = list(equations)
        with mp.workdps(self._digits):
            sizes = (abs(d) for row in self._rows() for d in differences(texts, row))
            # A NaN is larger than any number.
            size = max(sizes, key=lambda size: (size != size, size))
            return Residual(float(size), self._bound, self._because)


# Functions for definitions and equations, besides those of NumPy.

LEVI_CIVITA: Final[Any] = np.array(
    [[[(i - j) * (j - k) * (k - i) // 2 for k in range(3)] for j in range(3)] for i in range(3)],
    dtype=object,
)
"""e_ijk, whose indices run over 0, 1, 2."""

QUATERNION: Final[Point] = {f"e{k}": Fraction(entry, 5) for k, entry in enumerate((1, 2, 2, 4))}
"""A rational quaternion of norm 1, for the points of fields with an attitude."""

UNIT: Final = {"e0": "1 - e1**2 - e2**2 - e3**2"}
"""The root that makes its norm 1."""


def rotation(*quaternion: Any) -> Any:
    """R of a quaternion, scalar first: v_space = R v_body."""
    return np.array(rotation_matrix(quaternion))


def quaternion_rates(e0: Any, e1: Any, e2: Any, e3: Any, omega: Any) -> dict[str, Any]:
    """e' = e (0, omega)/2, omega in body axes; then R' = R [omega]x."""
    w1, w2, w3 = omega
    return {
        "e0": (-e1 * w1 - e2 * w2 - e3 * w3) / 2,
        "e1": (e0 * w1 + e2 * w3 - e3 * w2) / 2,
        "e2": (e0 * w2 + e3 * w1 - e1 * w3) / 2,
        "e3": (e0 * w3 + e1 * w2 - e2 * w1) / 2,
    }


_FUNCTIONS: Final[dict[str, Any]] = {
    **{name: getattr(np, name) for name in ("array", "cross", "diag", "einsum", "outer")},
    **{name: getattr(np, name) for name in ("tensordot", "trace")},
    **{"epsilon": LEVI_CIVITA, "delta": np.eye(3, dtype=int).astype(object)},
    **{"reduce": reduce, "rotation": rotation, "quaternion_rates": quaternion_rates},
}
