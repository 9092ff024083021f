"""A family of scenes: a scene file in which some numbers are drawn, or follow from others."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from math import prod

from taylor_verify.records.faults import Refused
from taylor_verify.scenes.families.distributions import Draw, Grid, number_text, with_decimals
from taylor_verify.scenes.families.formula import Formula
from taylor_verify.scenes.loads.steps import NoStep
from taylor_verify.scenes.reading.reader import read
from taylor_verify.scenes.scene import Scene

Place = Sequence[float]


@dataclass(frozen=True)
class Variable:
    """A number of a family, by its name or by its place in the file (``body.inertia[1]``).

    ``unit`` is written after the number. A number that ``is_named`` stands nowhere in the file: formulas
    use it by its name.
    """

    path: str
    rule: Draw | Grid | Formula
    unit: str = ""
    is_named: bool = False

    @property
    def is_free(self) -> bool:
        """True for a number that is drawn or comes from a grid, and follows from no others."""
        return not isinstance(self.rule, Formula)


@dataclass(frozen=True)
class Family:
    """Scene file in which some numbers vary.

    ``pieces`` are the text of the file, cut where a variable stands; an int is the index of that
    variable. ``source`` is the text of the template. ``count``, ``seed`` and ``spread`` are those that
    the template gives, None if it gives none.
    """

    name: str
    title: str
    pieces: tuple[str | int, ...]
    variables: tuple[Variable, ...]
    source: str = ""
    count: int | None = None
    seed: int | None = None
    spread: str | None = None

    @cached_property
    def free(self) -> int:
        """The number of variables that are drawn: the dimension of the unit cube."""
        return sum(isinstance(each.rule, Draw) for each in self.variables)

    @cached_property
    def nodes(self) -> int:
        """The number of points of the grid; 1 without a grid."""
        return prod(len(v.rule.values) for v in self.variables if isinstance(v.rule, Grid))

    def numbers(self, place: Place, node: int = 0) -> dict[str, Fraction]:
        """Return the value of every variable by path, at a place of the unit cube and a point of the grid.

        Raises Refused where a formula has no value there.
        """
        shares, values = iter(place), dict[str, Fraction]()
        for variable in self.variables:
            rule = variable.rule
            if isinstance(rule, Draw):
                values[variable.path] = Fraction(rule.value(float(next(shares))))
            elif isinstance(rule, Grid):
                node, which = divmod(node, len(rule.values))
                values[variable.path] = Fraction(rule.values[which])
            else:
                try:
                    values[variable.path] = rule.value(values)
                except NoStep as error:
                    raise Refused([f"{error} @ {variable.path}"]) from None
        return values

    def drawn(self, numbers: Mapping[str, Fraction]) -> dict[str, float]:
        """Return the variables that were drawn or come from a grid, by path, as doubles."""
        return {v.path: float(numbers[v.path]) for v in self.variables if v.is_free}

    def text_of(self, numbers: Mapping[str, Fraction]) -> str:
        """Return the scene file with these numbers."""
        return "".join(
            piece if isinstance(piece, str) else self._written(self.variables[piece], numbers)
            for piece in self.pieces
        )

    def text(self, place: Place, node: int = 0) -> str:
        """Return the scene file of a place. Raises Refused where a formula has no value."""
        return self.text_of(self.numbers(place, node))

    def scene(self, place: Place, node: int = 0, name: str = "") -> Scene:
        """Return the scene of a place. Raises Refused where there is no body."""
        return self.scene_of(self.numbers(place, node), name)

    def scene_of(self, numbers: Mapping[str, Fraction], name: str = "") -> Scene:
        """Return the scene with these numbers.

        Raises Refused where they make no body. The faults have numbers as the scene file has them.
        """
        try:
            return read(self.text_of(numbers), name or self.name)
        except Refused as refused:
            raise Refused([with_decimals(fault) for fault in refused.faults]) from None

    @staticmethod
    def _written(variable: Variable, numbers: Mapping[str, Fraction]) -> str:
        text = number_text(numbers[variable.path])
        return f'"{text.strip(chr(34))} {variable.unit}"' if variable.unit else text
