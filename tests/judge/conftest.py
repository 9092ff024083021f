"""Fixtures of tests that are about verdicts, and not about the likely causes of a failure."""

from __future__ import annotations

import pytest

from taylor_verify import chain
from taylor_verify.judge.causes.likely import Explained
from taylor_verify.judge.files import judgement


@pytest.fixture
def without_causes(monkeypatch: pytest.MonkeyPatch) -> None:
    """Search for no causes, which change no verdict: they are most of the work on a file that fails."""
    monkeypatch.setattr(judgement, "causes_of_file", lambda *_: Explained())
    monkeypatch.setattr(chain, "with_causes", lambda judged, *_: judged)
