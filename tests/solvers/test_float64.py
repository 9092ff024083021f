"""Solvers that are made in float64 alone."""

from __future__ import annotations

import pytest

from taylor_verify.records.status import Status
from taylor_verify.run import run


@pytest.mark.parametrize(
    ("name", "wider"),
    [
        ("scipy:DOP853", "f128"),
        *(("geometric:lie-rk4?step=0.1", wider) for wider in ("f32", "f80", "mp237")),
    ],
)
def test_other_precisions_are_unavailable(name: str, wider: str) -> None:
    """NumPy's arrays of SciPy's methods and Python's floats are doubles, and the verdict says so."""
    (verdict,) = run("euler/generic", name, wider).verdicts
    assert verdict.verdict is Status.UNAVAILABLE
    assert verdict.because.endswith("is made in float64: f64 alone")
