"""A short measurement of the prices of a few variants."""

from __future__ import annotations

from functools import cache

import pytest

from taylor_verify_reports.studies.prices import measure as prices
from taylor_verify_reports.studies.prices.document import PricesStudy
from taylor_verify_reports.studies.prices.variants import Variant, variants


def named(name: str) -> Variant:
    return next(variant for variant in variants() if variant.name == name)


@cache
def study() -> PricesStudy:
    """A short measurement of a few variants."""
    patch = pytest.MonkeyPatch()
    few = tuple(named(n) for n in ("omega", "literals", "attitude", "impulse", "whole"))
    patch.setattr(prices, "variants", lambda: few)
    patch.setattr(prices, "_LEAST_SECONDS", 1e-4)
    messages: list[str] = []
    try:
        measured = prices.study(messages.append, rounds=6)
    finally:
        patch.undo()
    assert len(messages) == 2
    return measured
