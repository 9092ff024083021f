"""The processor time of an explanation: what takes longer is left out, and said."""

from __future__ import annotations

import pytest

from taylor_verify import explain
from taylor_verify.explain import explanation as explaining
from taylor_verify.numbers.patience import Patience


def endless() -> str:
    while True:
        pass


def test_what_takes_longer_is_left_out() -> None:
    """Work without end is given up; what is asked for afterwards is not begun."""
    patience = Patience(0.05)
    assert patience.made(lambda: "made", "") == "made"
    assert patience.made(endless, "left out") == "left out"
    assert patience.made(lambda: "made", "left out") == "left out"


def test_an_explanation_says_what_it_left_out(monkeypatch: pytest.MonkeyPatch) -> None:
    """Without the run there are no gates, one undecided row, a warning; orbit and equations are there."""
    equations = explain("euler/generic")["equations"]
    monkeypatch.setattr(explaining, "_judged", lambda *_: endless())
    monkeypatch.setattr(explaining, "_SECONDS", 1.0)
    content = explain("euler/generic")
    assert any(warning.startswith("left out: the run") for warning in content["warnings"])
    assert [row["verdict"] for row in content["gates"]] == ["undecided"]
    assert content["orbit"]["period"]
    assert content["equations"] == equations
