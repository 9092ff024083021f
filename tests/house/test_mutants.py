"""The mutants of `make mutants`: what is changed, what is left alone, and who is known to be equivalent."""

from __future__ import annotations

import ast

import pytest
from mutants.draw import drawn, equivalents
from mutants.mutant import PACKAGE, count, mutant

CHANGED = [
    ("x = a + b", ["x = a - b"]),
    ("x = a * b / c", ["x = a * b * c", "x = a / b / c"]),
    ("x = a ** b", ["x = a * b"]),
    ("x -= b", ["x += b"]),
    ("x = -a", ["x = +a"]),
    ("x = a < b", ["x = a <= b"]),
    ("x = a == b", ["x = a != b"]),
    ("x = a is b and c", ["x = a is b or c", "x = a is not b and c"]),
    ("x = f(3, y=True)", ["x = f(4, y=True)", "x = f(3, y=False)"]),
    ("if a in b:\n    pass", ["if a not in b:"]),
]
LEFT_ALONE = [
    "x: Literal[1]",
    "def f(a: X[1]) -> Y[2]:\n    pass",
    "@cache(3)\ndef f():\n    pass",
    "raise ValueError(1)",
    "x = f'{1}'",
    "x = zip(a, b, strict=True)",
    "x = 1000",
]


@pytest.mark.parametrize(("source", "expected"), CHANGED)
def test_an_operator_a_sign_or_a_small_constant_is_changed(
    source: str, expected: list[str]
) -> None:
    """Each by itself, and told by the line that differs."""
    mutants = [mutant("a.py", source, place) for place in range(count(source))]
    assert [one.after for one in mutants] == expected
    assert {one.before for one in mutants} == {source.partition("\n")[0]}


@pytest.mark.parametrize("source", LEFT_ALONE)
def test_types_decorators_and_words_are_left_alone(source: str) -> None:
    """No test could notice a change of them, nor of a number of many."""
    assert count(source) == 0


def test_a_seed_draws_the_same_mutants() -> None:
    """Each is a module that can be compiled, and another seed draws others."""
    mutants = drawn(["judge/floor"], 12, seed=1)
    assert mutants == drawn(["judge/floor"], 12, seed=1)
    assert mutants != drawn(["judge/floor"], 12, seed=2)
    assert len(set(mutants)) == 12
    for one in mutants:
        assert ast.unparse(ast.parse(one.text)) == one.text
        assert one.before != one.after


def test_who_is_called_equivalent_is_a_mutant_still() -> None:
    """The code has the line yet, the change is one that is drawn, and the reason is a sentence."""
    for (path, before, after), why in equivalents().items():
        source = (PACKAGE / path).read_text(encoding="utf-8")
        every = (mutant(path, source, place) for place in range(count(source)))
        assert (before, after) in {(one.before, one.after) for one in every}, f"{path}: {before}"
        assert why.endswith(".")
