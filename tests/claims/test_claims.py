"""Claims: fields that are exact or refuse, verdicts that no failed check can earn, numbers told.

That the fields find identities, and nothing else, is held by the entries of the ledger and their mutations.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from mpmath import mp

from taylor_verify.exact.invariants import invariants
from taylor_verify.models.euler import heinbockel_moment
from taylor_verify.models.kirchhoff import clebsch_rates, impulse_rates
from taylor_verify.numbers.tensors import dot
from taylor_verify.scenes.motion import Impulse
from taylor_verify_reports.claims.check import All, Residual, measured
from taylor_verify_reports.claims.claim import Claim, Verdict, examine
from taylor_verify_reports.claims.field import Field
from taylor_verify_reports.claims.heinbockel.equations import unsymmetric
from taylor_verify_reports.claims.hydromechanics.algebraic import quartic, quartics
from taylor_verify_reports.claims.hydromechanics.clebsch import clebsch
from taylor_verify_reports.claims.hydromechanics.fourth import (
    GENERIC,
    SECOND_CASE,
    STEKLOV,
    SYMMETRIC,
    integrals,
)
from taylor_verify_reports.claims.hydromechanics.poles import leading_coefficients
from taylor_verify_reports.claims.hydromechanics.solid import loaded
from taylor_verify_reports.claims.hydromechanics.spins import tilted
from taylor_verify_reports.claims.setting import Exact, Numeric
from taylor_verify_reports.claims.trajectory import scene_of, trajectory


def triangle() -> Field:
    """u, v and w with w^2 = u^2 + v^2, where u turns into v."""
    field = Field({"u": 3, "v": 4, "w": 5}, {"w": "u**2 + v**2"})
    field.turn(u=-field["v"], v=field["u"])
    return field


# The field.


def test_a_rate_that_a_root_cannot_have_is_refused() -> None:
    """w^2 = u^2 + v^2 with u' = v needs w' = u v/w; w' = 0 is refused."""
    field = Field({"u": 3, "v": 4, "w": 5}, {"w": "u**2 + v**2"})
    with pytest.raises(ValueError, match="expected the rate of a root, got another @ w"):
        field.turn(u=field["v"])
    field.turn(u=field["v"], w=field["u"] * field["v"] / field["w"])


def test_a_point_off_the_root_is_refused() -> None:
    """w = 6 is no root of 9 + 16."""
    with pytest.raises(ValueError, match="expected w\\^2 = 25"):
        Field({"u": 3, "v": 4, "w": 6}, {"w": "u**2 + v**2"})


def test_a_float_is_no_exact_number() -> None:
    """A third in binary would make an identity fail, or hold, by its rounding."""
    with pytest.raises(TypeError, match=r"expected an exact number, got 0\.333"):
        triangle()["u"] * (1 / 3)


def test_division_by_zero_is_refused() -> None:
    """A divisor that is zero by the relation of a root is seen."""
    field = triangle()
    with pytest.raises(ZeroDivisionError, match="not identically zero"):
        field["u"] / (field["w"] ** 2 - field["u"] ** 2 - field["v"] ** 2)


# Equations as text.

CIRCLE = Exact({"x": 3, "y": 4}, "turn(x=-y, y=x)", {"r": "x**2 + y**2"})


def test_equations_hold_if_all_members_are_equal() -> None:
    """Every member of a chain is compared with the first, arrays entry by entry."""
    assert CIRCLE("x**2 + y**2 = r**2", "d([x, y]) = [-y, x]", "d(r) = 0")().size == 0
    assert CIRCLE("x = x = y")().size == 1
    assert CIRCLE("[x, y, i*r] = 0")().size == 5


def test_a_conjunction_changes_the_checks_that_have_the_words() -> None:
    """The others are left out, so that their residuals cannot hide the change."""
    both = All(CIRCLE("d(x) = -y"), CIRCLE("d(y) = 2*x"), gives(7.0))
    assert both().size == 7
    assert both.says("2*x")
    assert not both.says("3*x")
    assert both.but("2*x", "x")().is_satisfied


def test_equations_without_differences_satisfy_nothing() -> None:
    """A form that compares nothing is a NaN, which is neither true nor false."""
    outcome = CIRCLE()()
    assert not outcome.is_satisfied
    assert not outcome.is_refuted
    with pytest.raises(ValueError, match="expected members with ' = ' between them, got 'x'"):
        CIRCLE("x")()


def test_a_nan_along_a_trajectory_satisfies_nothing() -> None:
    """One time without a number is enough, wherever it stands."""
    rows = [{"a": mp.mpf(0)}, {"a": mp.nan}, {"a": mp.mpf(1)}]
    for turned in (rows, rows[::-1]):
        outcome = Numeric(lambda turned=turned: turned, 15, 10.0, "")("a = 0")()
        assert math.isnan(outcome.size)
        assert not outcome.is_satisfied


# The equations of the ledger against those of the solvers, across the wall.


def test_the_laws_are_those_that_solvers_are_given() -> None:
    """48 (3), (4) with all 21 coefficients and Clebsch's form agree with models, written apart."""
    loads = loaded["force"], loaded["couple"]
    x_rate, y_rate = impulse_rates(*(loaded[n] for n in ("x", "y", "vel", "Omega")), *loads)
    for rate, own in zip(x_rate + y_rate, [*loaded["dx"], *loaded["dy"]], strict=True):
        assert (rate - own).is_zero
    x, y = clebsch["x"], clebsch["y"]
    six = [clebsch[name] for name in ("p", "pp", "q", "qq", "r", "rr")]
    rates = clebsch_rates(x, y, six, [0, 0, 0], [0, 0, 0])
    for rate, own in zip([*rates[0], *rates[1]], [*x, *y], strict=True):
        assert (clebsch.field.element(rate) - clebsch.field.rate(own)).is_zero


def test_the_tensor_form_of_euler_is_that_of_models() -> None:
    """(2.2.70) written twice, in models and in the ledger, with nine free entries of I."""
    theirs = heinbockel_moment(*(unsymmetric[name] for name in ("w", "dw", "I")))
    for rate, own in zip(theirs, unsymmetric["left_of_70"], strict=True):
        assert (rate - own).is_zero


# Counterexamples, number by number.


def test_the_numbers_of_the_counterexamples() -> None:
    """(11): 36 + 4 i against 24 + 8 i. (17): -56/13 against -112/13. Both at one state."""
    numbers = {
        "d(x1)": 36,
        "d(x2)": 4,
        "-r*x3*y2": 24,
        "r*x3*y1 - ((qq - q)*x3 + rr*y3)": 8,
        "F * (Omega[0]*x1 + Omega[1]*x2) / (F**2 - x3**2) - q*F": Fraction(-56, 13),
        "(FG - x3*y3) / (F**2 - x3**2) * F * r / root * d(x3)": Fraction(-112, 13),
        **{"F": 7, "FG": 20, "root": -7},
    }
    for text, number in numbers.items():
        assert clebsch.field.value(eval(text, clebsch.symbols)) == number


def test_what_the_transcribed_quartics_leave() -> None:
    """(28) as transcribed leaves 8 x (a x^4 + 3 (a + b) x^2 + b) of (27) and (29)."""
    X1, X2 = quartic("+", "+", "+"), quartic("-", "-", "-")
    assert quartics(
        f"(x + 1)**2 * {X1} + (x - 1)**2 * {X2} + 8*(a + b)*x**3"
        " = 8*x * (a*x**4 + 3*(a + b)*x**2 + b)"
    )().is_satisfied


# Bodies with and without a fourth integral.


def test_three_integrals_are_counted_for_every_body() -> None:
    """T, F^2 and FG are found for each, and y3 for a body of revolution alone."""
    assert [integrals(solid, 2) for solid in (GENERIC, SECOND_CASE, STEKLOV)] == [3, 4, 4]
    assert [integrals(solid, 1) for solid in (GENERIC, SYMMETRIC, STEKLOV)] == [0, 1, 0]


def test_poles_have_the_exponents_that_the_integrals_give() -> None:
    """-1 belongs to the place of a pole and 2 to each of T, F^2, FG; the trace leaves two that add to 1."""
    np = pytest.importorskip("numpy")
    from taylor_verify_reports.claims.hydromechanics.poles import jacobian

    leading = leading_coefficients(GENERIC)
    assert leading
    energy = np.array([[float(entry) for entry in row] for row in GENERIC.energy_matrix])
    for c in leading:
        exponents = sorted(
            np.linalg.eigvals(jacobian(energy, c) + np.eye(6)), key=lambda e: abs(e - 2)
        )
        assert (
            max(abs(e - 2) for e in exponents[:3]) <= 1e-9
        )  # doubles, with a condition of 10^5 granted
        rest = sorted(exponents[3:], key=lambda e: abs(e + 1))
        assert abs(rest[0] + 1) <= 1e-9
        assert abs(rest[1] + rest[2] - 1) <= 1e-9


def test_a_trajectory_of_the_ledger_keeps_what_the_text_says() -> None:
    """T, F^2, FG stay to 58 of 60 digits along a trajectory of a body with 21 coefficients."""
    start = Impulse(tuple(map(Fraction, (1, -2, 3))), tuple(map(Fraction, (2, 1, -1))))
    times = (Fraction(0), Fraction(1, 4), Fraction(1, 2))
    motion = trajectory(GENERIC, start, times)
    with mp.workdps(70):
        for invariant in invariants(scene_of(GENERIC, start, times)):
            values = invariant.value(motion)
            assert max(abs(v - values[0]) for v in values) <= mp.mpf(10) ** -58 * invariant.scale(
                motion
            )


# Verdicts.


def gives(size: float, bound: float = 0.0) -> Callable[[], Residual]:
    return lambda: Residual(size, bound, "a reason")


SOUND = Claim(
    id="text (1)",
    statement="a = b",
    domain="",
    method="",
    check=gives(0.0),
    mutants={},
)


@pytest.mark.parametrize(
    ("changed", "verdict"),
    [
        ({}, Verdict.HOLDS),
        ({"lost": "a bar"}, Verdict.RESTORED),
        ({"void": "no case"}, Verdict.VACUOUS),
        ({"gap": "the rest"}, Verdict.UNDECIDED),
        ({"check": gives(1.0)}, Verdict.UNDECIDED),
        ({"check": gives(math.nan)}, Verdict.UNDECIDED),
        ({"transcribed": gives(1.0)}, Verdict.FALSE),
        ({"transcribed": gives(1.0), "condition": "c"}, Verdict.ONLY_IF),
        ({"transcribed": gives(0.0)}, Verdict.HOLDS),
        ({"transcribed": gives(math.nan)}, Verdict.UNDECIDED),
        ({"transcribed": gives(2e-10, 1e-10)}, Verdict.UNDECIDED),
        ({"transcribed": gives(1.0), "check": gives(1.0)}, Verdict.UNDECIDED),
    ],
)
def test_a_verdict_is_what_the_checks_give(changed: dict[str, Any], verdict: Verdict) -> None:
    """A failed check, a NaN, or a false form that is only just missed is undecided."""
    assert examine(replace(SOUND, **changed)).verdict is verdict


def test_a_check_that_comes_to_no_number_is_a_nan() -> None:
    """An ArithmeticError in a check is an undecided claim with its reason, not a crash."""

    def check() -> Residual:
        raise ArithmeticError("two evaluations do not agree")

    outcome = measured(check)
    assert math.isnan(outcome.size)
    assert "do not agree" in outcome.because
    row = examine(replace(SOUND, check=check)).row()
    assert row.document()["residual"] == {"statement": None}


@given(st.fractions("1e-9", "1/2", max_denominator=10**9))
def test_a_tilted_start_has_the_length_of_e3(tilt: Fraction) -> None:
    """F = G = 1, exactly, whatever the tilt; and the sine of the angle is nearly the tilt."""
    start = tilted(tilt)
    assert dot(start.linear, start.linear) == dot(start.linear, start.angular) == 1
    assert abs(start.linear[0] - tilt) <= tilt**3
