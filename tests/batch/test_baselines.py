"""Earlier verdicts as a baseline: a file of them, or the document itself, is read whole or refused."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import pytest
from builders.verdicts import row

from taylor_verify import chain, run, run_many
from taylor_verify.batch.differences import compare
from taylor_verify.batch.earlier_file import read_baseline
from taylor_verify.judge.judgement import Judgement
from taylor_verify.records.faults import Refused
from taylor_verify.records.passing import NotPassed
from taylor_verify.records.status import Status
from taylor_verify.records.store import load as load_report
from taylor_verify.records.store import write
from taylor_verify.records.sums import with_sum


def test_both_documents_are_read(tmp_path: Path) -> None:
    """verdicts.json of --out, and the document of --json, give the rows that were written."""
    made = [row(), row(quantity="T"), row(quantity="H2", verdict=Status.FAIL, max=math.nan)]
    write(tmp_path, made, [])
    report, stored = load_report(tmp_path), read_baseline(tmp_path / "data" / "verdicts.json")
    assert stored.edited is False
    same = compare(report, stored.verdicts)
    assert (same.compared, same.all) == (3, ())
    file = tmp_path / "printed.json"
    document = {"verdicts": [{**v.row(), "of_later_versions": 1} for v in made], "summary": {}}
    file.write_text(json.dumps(document), encoding="utf-8")
    printed = read_baseline(file)
    assert printed.edited is None
    same = compare(printed.verdicts, made)
    assert (same.compared, same.all) == (3, ())


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"max": math.nan}, "expected a JSON document, got a fault"),
        ({"max": -1e-15}, "not negative, got -1e-15 @ verdicts[1].max"),
        ({"max": "5e-15"}, "expected a number or null, got '5e-15' @ verdicts[1].max"),
        ({"ratio": True}, "got True @ verdicts[1].ratio"),
        ({"max": None}, "expected a number of a row that passed, got null @ verdicts[1].max"),
        ({"verdict": "passed"}, "got 'passed' @ verdicts[1].verdict"),
        ({"verdict": ["pass"]}, "got a list @ verdicts[1].verdict"),
        ({"steps": 1.5}, "expected a whole number, got 1.5 @ verdicts[1].steps"),
        ({"scene": None}, "expected a text, got None @ verdicts[1].scene"),
        ({"provenance": {}}, "got none @ verdicts[1].provenance.scene"),
        ({"provenance": None}, "expected an object, got None @ verdicts[1].provenance"),
        ({"mean": 1e-14}, "no more than the largest error 5e-15, got 1e-14 @ verdicts[1].mean"),
        (
            {"rung": "f63"},
            "expected a precision (f32 f64 f80 f128 mpN), got 'f63' @ verdicts[1].rung",
        ),
        ({"quantity": "omega"}, "every row once, got more of euler/generic taylor f64 omega"),
    ],
)
def test_a_row_that_is_none_is_refused_by_its_place(
    tmp_path: Path, changed: dict[str, Any], message: str
) -> None:
    """A baseline that is half understood would let all pass: it is refused whole."""
    rows = [row().row(), {**row(quantity="T").row(), **changed}]
    file = tmp_path / "spoiled.json"
    file.write_text(json.dumps({"verdicts": rows}), encoding="utf-8")
    with pytest.raises(ValueError, match="expected") as refused:
        read_baseline(file)
    assert message in str(refused.value)
    assert str(file) in str(refused.value)


DOCUMENT = {"verdicts": [row().row()], "summary": {"pass": 1}, "notes": ["a note, \u03c9"]}


def test_a_printed_document_has_the_sum_of_its_content(tmp_path: Path) -> None:
    """Another layout, order of keys or spelling of a number leaves it; another number or key does not."""
    file, summed = tmp_path / "printed.json", with_sum(DOCUMENT)
    respelt = json.dumps(dict(reversed(summed.items())), indent=4).replace("7.0", "70e-1")
    others = ({**summed, "notes": []}, {**summed, "sha256": ""}, {**summed, "more": 1})
    texts = {json.dumps(summed): False, respelt: False}
    for text, is_edited in (texts | dict.fromkeys(map(json.dumps, others), True)).items():
        file.write_text(text, encoding="utf-8")
        assert read_baseline(file).edited is is_edited


def test_nothing_passes_by_an_edited_baseline(tmp_path: Path) -> None:
    """A regression beside it is a failure all the same; without a sum there is a note."""
    write(tmp_path, [row()], [])
    file = tmp_path / "data" / "verdicts.json"
    same, worse = (Judgement((each,), None) for each in (row(), row(500.0, bound=1e-9)))
    assert read_baseline(file).compare_as_baseline(same).passed
    file.write_text(file.read_text().replace("5e-15", "6e-15"))
    doubted = read_baseline(file).compare_as_baseline(same)
    regressed = read_baseline(file).compare_as_baseline(worse)
    assert (doubted.exit_status, regressed.exit_status) == (3, 1)
    with pytest.raises(NotPassed, match="is not what a run has written, by its own sum"):
        doubted.raise_for_failure()
    file.with_name("verdicts.sha256").unlink()
    alone = read_baseline(file).compare_as_baseline(same)
    assert alone.passed
    assert "has no sum" in alone.notes[0]


# `run` and `run_many` take a baseline as the command line does: a file, or the document itself.


REST = "euler/rest"
COARSE = "euler/generic"
# It passes by a wide tolerance, and by no bound that follows from the arithmetic.
ASKED: dict[str, Any] = {"solver": "scipy:RK45?rtol=1e-6&atol=1e-6", "tolerance": 1e-2}


@pytest.fixture(autouse=True)
def _without_causes(monkeypatch: pytest.MonkeyPatch) -> None:
    """No cause is looked for, which takes most of the time of a run that fails."""
    monkeypatch.setattr(chain, "with_causes", lambda judged, *_: judged)


@pytest.fixture(scope="module")
def document() -> dict[str, Any]:
    return run_many([REST, COARSE], jobs=1, **ASKED).document()


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
        call(REST, baseline=tmp_path / "none.json")
    for baseline in ({}, {"verdicts": []}, {"verdicts": [{}]}, {"verdicts": {1}}, 5):
        with pytest.raises(ValueError, match=r"expected .* @ .*baseline"):
            call(REST, baseline=baseline)
    with pytest.raises(ValueError, match="expected bound or baseline, got 'both' @ gate"):
        call(REST, gate="both")
    with pytest.raises(ValueError, match="expected a baseline with the gate baseline"):
        call(REST, gate="baseline")
