"""A file of earlier verdicts is read whole, or refused."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import pytest
from builders.verdicts import row

from taylor_verify.batch.differences import compare
from taylor_verify.batch.earlier_file import load
from taylor_verify.records.status import Status
from taylor_verify.records.store import load as load_report
from taylor_verify.records.store import write


def test_both_documents_are_read(tmp_path: Path) -> None:
    """verdicts.json of --out, and the document of --json, give the rows that were written."""
    made = [row(), row(quantity="T"), row(quantity="H2", verdict=Status.FAIL, max=math.nan)]
    write(tmp_path, made, [])
    report, stored = load_report(tmp_path), load(tmp_path / "data" / "verdicts.json")
    assert (compare(report, stored).compared, compare(report, stored).all) == (3, ())
    file = tmp_path / "printed.json"
    document = {"verdicts": [{**v.row(), "of_later_versions": 1} for v in made], "summary": {}}
    file.write_text(json.dumps(document), encoding="utf-8")
    assert (compare(load(file), made).compared, compare(load(file), made).all) == (3, ())


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
        load(file)
    assert message in str(refused.value)
    assert str(file) in str(refused.value)
