"""Numbers between libraries: to doubles as `float` does, without a type, and to MPFR to the last bit."""

from __future__ import annotations

import operator
import sys
from collections.abc import Callable
from fractions import Fraction
from types import ModuleType, SimpleNamespace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from mpmath import mp, mpf

import taylor_verify
from taylor_verify.models.problem import Problem
from taylor_verify.numbers.convertible import Convertible, convertible
from taylor_verify.records.faults import Refused
from taylor_verify.scenes.mpfr import precision, sqrt, to_mpf, to_mpfr

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


# MPFR

OPERATIONS = (operator.add, operator.sub, operator.mul, operator.truediv)


def exactly(count: int, exponent: int) -> mpf:
    with mp.workprec(10_000):
        return mp.ldexp(mpf(count), exponent)


def column(*values: mpf) -> np.ndarray:
    return np.array(values, dtype=object)


# Far longer than what they are computed with.
numbers = st.builds(exactly, st.integers(-(2**600), 2**600), st.integers(-2000, 2000))


@given(numbers, st.integers(2, 400))
def test_the_way_there_and_back_is_exact_at_any_precision(value: mpf, bits: int) -> None:
    """No bit of a number is lost, however low the ambient precision is."""
    with mp.workprec(bits):
        (there_and_back,) = to_mpf(to_mpfr(column(value)))
    assert there_and_back._mpf_ == value._mpf_


@given(numbers, numbers, st.integers(2, 400))
def test_every_operation_rounds_as_mpmath_does(a: mpf, b: mpf, bits: int) -> None:
    """Sums, differences, products, quotients and roots are mpmath's to the last bit."""
    with mp.workprec(bits):
        p, q = to_mpfr(column(a)), to_mpfr(column(b))
        for operation in OPERATIONS:
            if operation is operator.truediv and b == 0:
                continue
            with precision():
                result = operation(p, q)
            assert to_mpf(result)[0]._mpf_ == operation(a, b)._mpf_
        with precision():
            root = sqrt(abs(p))
        assert to_mpf(root)[0]._mpf_ == mp.sqrt(abs(a))._mpf_


def test_what_is_not_finite_stays_so() -> None:
    """NaN and both infinities keep what they are, there and back."""
    nan, up, down = to_mpf(to_mpfr(column(mp.nan, mp.inf, -mp.inf)))
    assert mp.isnan(nan)
    assert (up, down) == (mp.inf, -mp.inf)
