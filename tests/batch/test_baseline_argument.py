"""`run` and `run_many` take a baseline as the command line does: a file, or the document itself."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from taylor_verify import chain, run, run_many
from taylor_verify.records.faults import Refused
from taylor_verify.records.passing import NotPassed
from taylor_verify.records.sums import with_sum

SCENE = "euler/rest"
COARSE = "euler/generic"
# It passes by a wide tolerance, and by no bound that follows from the arithmetic.
ASKED: dict[str, Any] = {"solver": "scipy:RK45?rtol=1e-6&atol=1e-6", "tolerance": 1e-2}


@pytest.fixture(autouse=True)
def _without_causes(monkeypatch: pytest.MonkeyPatch) -> None:
    """No cause is looked for, which takes most of the time of a run that fails."""
    monkeypatch.setattr(chain, "with_causes", lambda judged, *_: judged)


@pytest.fixture(scope="module")
def document() -> dict[str, Any]:
    return run_many([SCENE, COARSE], jobs=1, **ASKED).document()


def much_better(document: dict[str, Any]) -> dict[str, Any]:
    """The document of a run whose errors were a millionth of these."""
    rows = [
        {
            **row,
            **{name: 1e-6 * row[name] for name in ("max", "mean", "final", "ratio", "attainable")},
        }
        for row in document["verdicts"]
    ]
    return with_sum({**document, "verdicts": rows})


@pytest.mark.parametrize("call", [run, run_many])
def test_a_result_passes_beside_itself_and_fails_beside_a_better_one(
    call: Any, document: dict[str, Any], tmp_path: Path
) -> None:
    """The document and its file are the same baseline; a regression has its line."""
    file = tmp_path / "base.json"
    file.write_text(json.dumps(document), encoding="utf-8")
    for baseline in (document, file, str(file)):
        result = call(COARSE, **ASKED, baseline=baseline)
        assert result.comparison.compared == len(result.verdicts)
        assert result.passed
    worse = call(COARSE, **ASKED, baseline=much_better(document))
    assert not worse
    with pytest.raises(NotPassed, match="@ euler/generic f64 omega max"):
        worse.raise_for_failure()


@pytest.mark.parametrize("call", [run, run_many])
def test_the_gate_baseline_asks_the_comparison_alone(call: Any, document: dict[str, Any]) -> None:
    """A run that fails its own bounds passes if it is no worse than it was, and not the other way round."""
    strict = {**ASKED, "tolerance": 1e-9}
    failed = run_many([COARSE], **strict).document()
    assert not call(COARSE, **strict, baseline=failed)
    assert call(COARSE, **strict, baseline=failed, gate="baseline")
    assert not call(COARSE, **ASKED, baseline=much_better(document), gate="baseline")


@pytest.mark.parametrize("call", [run, run_many])
def test_what_is_no_baseline_is_refused_before_anything_runs(call: Any, tmp_path: Path) -> None:
    """A missing file, another document, a wrong gate, and a gate without a baseline."""
    with pytest.raises(Refused, match="got no such file"):
        call(SCENE, baseline=tmp_path / "none.json")
    for baseline in ({}, {"verdicts": []}, {"verdicts": [{}]}, {"verdicts": {1}}, 5):
        with pytest.raises(ValueError, match=r"expected .* @ .*baseline"):
            call(SCENE, baseline=baseline)
    with pytest.raises(ValueError, match="expected bound or baseline, got 'both' @ gate"):
        call(SCENE, gate="both")
    with pytest.raises(ValueError, match="expected a baseline with the gate baseline"):
        call(SCENE, gate="baseline")
