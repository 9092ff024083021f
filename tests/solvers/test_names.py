"""Names of solvers that are wrong, family by family."""

from __future__ import annotations

import pytest

from taylor_verify.solvers.registry import solver_named


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("taylor?tol=0", r"expected a positive number, got '0' @ tol"),
        ("taylor?tol=many", r"got 'many' @ tol"),
        ("taylor?", r"expected \?tol=NUMBER after taylor, got none"),
        ("taylor?rtol=1e-6", r"got 'rtol'; did you mean tol\?"),
        ("taylor?tol=1&tol=2", r"got tol twice"),
        ("scipy:RK45?stop=never", r"expected yes or no, got 'never' @ stop"),
        ("taylor?code=fast", r"expected optimised, got 'fast' @ code"),
        ("taylor?code=optimised&tol=0", r"expected a positive number, got '0' @ tol"),
        ("taylor:tol=1e-6", r"expected a solver"),
        ("scipy:extra:RK45", r"expected a method"),
        ("geometric:spliting?step=1", r"got 'spliting'; did you mean splitting\?"),
        ("geometric:splitting", r"expected \?step=NUMBER after splitting, got none"),
        ("geometric:splitting?step=", r"expected \?step=NUMBER after splitting, got none"),
        ("geometric:splitting?step=NUMBER", r"got 'NUMBER' @ step"),
        ("geometric:splitting?step=0", r"expected a positive number, got '0' @ step"),
        ("geometric:splitting?step=-1", r"expected a positive number, got '-1' @ step"),
        ("geometric:splitting?step=nan", r"got 'nan' @ step"),
        ("geometric:splitting?stp=1", r"got 'stp'; did you mean step\?"),
        ("geometric:splitting?step=1&step=2", r"expected each setting once, got step twice"),
        ("geometric:", r"expected a method \(implicit-midpoint, .*\), got ''"),
        ("scipy:DOP854", r"got 'DOP854'; did you mean DOP853\?"),
        ("scipy:RK45?tol=1e-6", r"got 'tol'; did you mean"),
        ("scipy:RK45?rtol=1e-16", r"expected at least 2.22e-14, SciPy's own bound, .* @ rtol"),
        ("scipy:RK45?atol=0", r"expected a positive number, got '0' @ atol"),
        ("mpmath:odefunc", r"got 'odefunc'; did you mean odefun\?"),
        ("mpmath:odefun?tol=0", r"expected a positive number, got '0' @ tol"),
        ("mpmath:odefun?degree=2.5", r"whole number from 2 to 1000, got '2.5' @ degree"),
        ("mpmath:odefun?degree=1", r"whole number from 2 to 1000, got '1' @ degree"),
        ("mpmath:odefun?rtol=1", r"got 'rtol'; did you mean tol\?"),
        ("outside:cvode-bdg", "did you mean cvode-bdf"),
        ("outside:cvode-bdf?tol=1", "expected a setting"),
        ("outside:cvode-bdf?rtol=0", "expected a positive number"),
        ("outside:cvode-bdf?version=latest", "a version such as .*, got 'latest' @ version"),
        ("outside:cvode-bdf?version=1.0 ; evil", "@ version"),
        ("outside:cvode-bdf?version=", "@ version"),
        ("python:", "expected python:package.module:function, got python:"),
        ("python:nowhere_at_all:f", "No module named 'nowhere_at_all'"),
        ("python:math:nothing", "has no attribute 'nothing'"),
        ("python:math:pi", "expected a callable, got a float"),
        ("python:math:sin?step", "expected KEY=VALUE behind"),
        ("process: ", "expected a"),
        ("process:'open", "expected a"),
        ("proces:x", "expected a"),
        ("tailor", "expected a"),
    ],
)
def test_a_name_that_is_wrong_is_refused(name: str, words: str) -> None:
    """The refusal says what was expected, what came, and where."""
    with pytest.raises(ValueError, match=words):
        solver_named(name)
