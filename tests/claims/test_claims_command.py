"""The verb `claims`: a table, JSON, exit statuses, and files that are refused."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest
from builders.studies.claims import STUDY
from builders.studies.stored import publish_document

from taylor_verify.cli import main
from taylor_verify_reports.claims import ledger
from taylor_verify_reports.claims.claim import Claim
from taylor_verify_reports.claims.ledger import claims
from taylor_verify_reports.studies.claims_page import CLAIMS
from taylor_verify_reports.studies.claims_page import STUDY as PUBLISHED

QUICK = "hydromechanics 49 (11)"
KEYS = {"id", "statement", "verdict", "correction", "residual"}


def transcribed_is_true(claim: Claim) -> Claim:
    """A false claim whose form as transcribed passes the check."""
    return replace(claim, transcribed=claim.check)


Captured = pytest.CaptureFixture[str]


def test_json_is_a_list_of_entries(capsys: Captured) -> None:
    """Id, LaTeX, verdict, correction and residuals of what was asked for, and nothing else on stdout."""
    assert main(["claims", QUICK, "hydromechanics 49 (2)", "--json"]) == 0
    second, eleventh = json.loads(capsys.readouterr().out)
    assert (second["id"], eleventh["id"]) == ("hydromechanics 49 (2)", QUICK)
    assert set(second) >= KEYS
    assert second["correction"] is None
    assert second["residual"] == {"statement": 0.0}
    assert eleventh["verdict"] == "false as transcribed"
    assert "(x_1 + x_2i) +" in eleventh["correction"]
    assert eleventh["residual"]["statement"] == 0.0
    assert eleventh["residual"]["transcribed"] == pytest.approx((12**2 + 4**2) ** 0.5)


def test_the_table_tells_an_entry_in_full(capsys: Captured) -> None:
    """Statement, correction and counterexample of an entry that was asked for, and the counts."""
    assert main(["claims", QUICK]) == 0
    text = capsys.readouterr().out
    for line in (
        "false as transcribed",
        "statement",
        "correct",
        "fails for",
        "36 + 4 i",
        "checked by",
    ):
        assert line in text
    assert text.rstrip().endswith("1 false as transcribed")


def test_an_unknown_id_is_a_wrong_call(capsys: Captured) -> None:
    """Exit status 2, and what may have been meant."""
    assert main(["claims", "hydromechanic 49 (17)"]) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert "got 'hydromechanic 49 (17)'; did you mean 'hydromechanics 49 (17)'?" in captured.err


def test_an_entry_that_lost_its_verdict_fails(
    capsys: Captured, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Exit status 1, and which verdict was expected; the row is told all the same."""
    changed = tuple(transcribed_is_true(c) if c.id == QUICK else c for c in claims())
    monkeypatch.setattr(ledger, "claims", lambda: changed)
    assert main(["claims", QUICK, "--json"]) == 1
    captured = capsys.readouterr()
    assert json.loads(captured.out)[0]["recorded"] == "false as transcribed"
    assert f"expected the verdict 'false as transcribed', got 'holds' @ {QUICK}" in captured.err


def test_a_file_of_something_else_is_refused(tmp_path: Path) -> None:
    """The message names the key, the entry and the file; so does a verdict that there is not."""
    publish_document(tmp_path, PUBLISHED, CLAIMS, STUDY)
    document = json.loads((tmp_path / CLAIMS.name).read_text(encoding="utf-8"))
    document["claims"][2]["verdict"] = "plausible"
    (tmp_path / CLAIMS.name).write_text(json.dumps(document), encoding="utf-8")
    with pytest.raises(ValueError, match=r"'plausible' @ claims\[2\]\.verdict @ .*claims\.json"):
        PUBLISHED.pages(tmp_path)
    (tmp_path / CLAIMS.name).write_text('{"provenance": {}}', encoding="utf-8")
    with pytest.raises(ValueError, match=r"expected a key cited, got none.*claims\.json"):
        PUBLISHED.pages(tmp_path)


def test_a_ledger_that_lost_a_verdict_is_not_published(
    capsys: Captured, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """Exit status 1, and no page."""
    (quick,) = (c for c in claims() if c.id == QUICK)
    monkeypatch.setattr(ledger, "claims", lambda: (transcribed_is_true(quick),))
    assert main(["publish", "claims", "--from", str(tmp_path)]) == 1
    assert f"@ {QUICK}" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []
