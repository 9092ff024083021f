"""A short measurement of the prices of a few variants."""

from __future__ import annotations

from functools import cache

import pytest

from taylor_verify.studies.prices import measure as prices
from taylor_verify.studies.prices import page as page
from taylor_verify.studies.prices.document import PricesStudy
from taylor_verify.studies.prices.variants import Variant, variants


def named(name: str) -> Variant:
    return next(variant for variant in variants() if variant.name == name)


@cache
def study() -> PricesStudy:
    """A short measurement of a few variants."""
    patch = pytest.MonkeyPatch()
    kept = tuple(named(n) for n in ("omega", "literals", "attitude", "impulse", "whole"))
    patch.setattr(prices, "variants", lambda: kept)
    patch.setattr(prices, "RUNGS", {"f64": 6})
    patch.setattr(prices, "_LEAST_SECONDS", 1e-4)
    told: list[str] = []
    try:
        found = prices.study(told.append)
    finally:
        patch.undo()
    assert told == ["f64"]
    return found
