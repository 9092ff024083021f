"""The numbers that a function gets convert to doubles as `float` does, without a type."""

from __future__ import annotations

import sys
from collections.abc import Callable
from fractions import Fraction
from types import ModuleType, SimpleNamespace
from typing import Any

import numpy as np
import pytest

import taylor_verify
from taylor_verify.models.problem import Problem
from taylor_verify.numbers.convertible import Convertible, convertible
from taylor_verify.records.faults import Refused

THIRDS = convertible(((Fraction(1, 3), Fraction(2, 3)), (Fraction(1), Fraction(0))))


def problem(scene: str, rung: str = "f64") -> Problem:
    """The problem that a function gets."""
    problems: list[Problem] = []
    taylor_verify.solve(scene, problems.append, rung)
    return problems[0]


def shown(part: Any) -> list[Any]:
    """All numbers, vectors, matrices and sequences of times that a part of a scene has by name."""
    names = [name for name in dir(part) if name[0].islower()]
    values = (getattr(part, name) for name in names)
    return [v for v in values if isinstance(v, Fraction | Convertible)]


def rounded(value: Any) -> Any:
    return [rounded(v) for v in value] if isinstance(value, tuple | list) else float(value)


def by_dlpack(value: Any) -> Any:
    """Return what PyTorch makes of an object that is no tensor and no array, by its own import."""
    assert value.__dlpack_device__() == (1, 0)
    return np.from_dlpack(value)


@pytest.mark.parametrize("convert", [np.asarray, by_dlpack])
@pytest.mark.parametrize("scene", ["euler/later-start", "kirchhoff/whole-motion"])
def test_every_number_converts(scene: str, convert: Callable[[Any], Any]) -> None:
    """Body, start and times become doubles bit by bit, what follows from them too."""
    given = problem(scene).given
    values = [value for part in (given.body, given.initial, given.clock) for value in shown(part)]
    assert len(values) >= 8
    for value in values:
        numbers = value if isinstance(value, tuple | Fraction) else list(value)
        converted = convert(value)
        assert str(converted.dtype).endswith("float64")
        assert np.array_equal(converted, rounded(numbers))


def test_lists_of_numbers_convert() -> None:
    """A list of rows, or of single numbers, is an array of doubles; as objects they stay exact."""
    row, single = THIRDS[0], THIRDS[0][0]
    assert np.asarray([row, [single, 0.5]]).tolist() == [[1 / 3, 2 / 3], [1 / 3, 0.5]]
    assert np.array([row, row], dtype=object).tolist() == [[Fraction(1, 3), Fraction(2, 3)]] * 2


def jax_of(monkeypatch: pytest.MonkeyPatch, kind: type) -> None:
    """Put a stand-in for JAX in place, whose numbers are of one kind."""
    stand_in = SimpleNamespace(asarray=lambda doubles: np.asarray(doubles, kind))
    monkeypatch.setitem(sys.modules, "jax", ModuleType("jax"))
    monkeypatch.setitem(sys.modules, "jax.numpy", stand_in)


def test_jax_gets_doubles(monkeypatch: pytest.MonkeyPatch) -> None:
    """JAX asks an object for its array; with 64 bits it is the one of doubles."""
    jax_of(monkeypatch, np.float64)
    assert THIRDS.__jax_array__().tolist() == rounded(THIRDS)


def test_jax_with_32_bits_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    """Numbers that would be rounded name the setting of JAX; those of 32 bits are taken."""
    jax_of(monkeypatch, np.float32)
    with pytest.raises(Refused, match="jax_enable_x64"):
        THIRDS.__jax_array__()
    assert THIRDS[1].__jax_array__().tolist() == [1, 0]


@pytest.mark.parametrize("rung", ["f64", "mp237"])
def test_exact_numbers_come_back_exact(rung: str) -> None:
    """An answer of the given numbers has no error, though no double holds a third."""

    def start(problem: Problem) -> Any:
        omega = problem.given.initial.omega
        return {"t": [*problem.given.clock.instants], "omega": [omega] * len(problem.times)}

    for solve in (start, lambda p: start(p)["omega"], lambda p: (start(p)["t"], start(p)["omega"])):
        judged = taylor_verify.check("euler/rest", solve, rung=rung)
        assert judged.passed
        assert all(v.max == 0 for v in judged.verdicts if v.quantity == "omega")


def test_more_than_a_double_stays_rational() -> None:
    """No number converts without a type on a precision beyond a double."""
    assert np.asarray(problem("euler/generic", "mp237").given.initial.omega).dtype == object
