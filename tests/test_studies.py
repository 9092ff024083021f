"""Stored studies are read as typed documents, and written as they were."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from taylor_verify.publish import data, growth, prices, reach, trades
from taylor_verify.records.json_text import complete, read
from taylor_verify.records.studies.growth import GrowthStudy
from taylor_verify.records.studies.prices import PricesStudy
from taylor_verify.records.studies.reach import ReachStudy
from taylor_verify.records.studies.tradeoff import TradeNumbers, TradeTimings

REPORTS = Path(__file__).resolve().parents[1] / "reports"


@pytest.mark.parametrize(
    ("name", "option", "kind"),
    [
        (growth.GROWTH, "growth", GrowthStudy),
        (growth.LONG, "growth", GrowthStudy),
        (reach.REACH, "reach", ReachStudy),
        (prices.PRICES, "prices", PricesStudy),
        (trades.NUMBERS, "tradeoff", TradeNumbers),
        (trades.TIMINGS, "tradeoff", TradeTimings),
    ],
)
def test_a_stored_study_is_written_as_it_was(name: str, option: str, kind: type[Any]) -> None:
    """Keys, their order, lines and every digit are those of the committed file."""
    made_by = {"made_by": f"taylor-verify publish --{option}; do not edit"}
    text = data.laid_out({**made_by, **complete(read(REPORTS / name, kind))})
    assert text == (REPORTS / name).read_text(encoding="utf-8")
