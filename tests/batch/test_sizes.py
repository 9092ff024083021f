"""Quantiles of a sweep's sizes, counted part by part."""

from __future__ import annotations

import numpy as np

from taylor_verify.batch.sweeps.sizes import Sizes


def test_quantiles_are_sizes_that_occurred() -> None:
    """Counted in parts, each quantile is at most a thousandth above the exact one; the largest is exact."""
    drawn = np.exp(np.random.default_rng(1).normal(0, 3, 5000))
    sizes = Sizes()
    for part in np.array_split(drawn, 7):
        sizes.add(part)
    quantiles = sizes.quantiles()
    assert quantiles is not None
    for share, size in (
        (0.5, quantiles.median),
        (0.9, quantiles.p90),
        (0.99, quantiles.p99),
    ):
        exact = np.sort(drawn)[int(np.ceil(share * len(drawn))) - 1]
        assert size in drawn
        assert exact <= size <= exact * 1.001
    assert quantiles.largest == drawn.max()


def test_nan_is_beyond_every_number() -> None:
    """One NaN among a hundred is the largest, and no number."""
    sizes = Sizes()
    sizes.add(np.array([*np.linspace(0, 1, 99), np.nan]))
    quantiles = sizes.quantiles()
    assert quantiles is not None
    assert quantiles.largest is None
    assert quantiles.p90 is not None
    assert Sizes().quantiles() is None
