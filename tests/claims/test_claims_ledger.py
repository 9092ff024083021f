"""The ledger: complete, with its recorded verdicts and rejected mutations; and the verb `claims`."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import pytest
from builders.studies.claims import STUDY
from builders.studies.stored import publish_document
from builders.turns import by_turns

from taylor_verify.cli import main
from taylor_verify_reports.claims import ledger
from taylor_verify_reports.claims.check import measured
from taylor_verify_reports.claims.claim import Claim, Verdict, examine
from taylor_verify_reports.claims.ledger import claims, find
from taylor_verify_reports.claims.numbers import CITED, IN_ORDER, NUMBERED
from taylor_verify_reports.studies.claims_page import CLAIMS
from taylor_verify_reports.studies.claims_page import STUDY as PUBLISHED

LEDGER = claims()
MUTATIONS = [(claim, name) for claim in LEDGER for name in claim.mutants]
# Integrals over many periods, and a motion that falls away for ever: seconds each.
LONG = (
    "heinbockel constant moments",
    "hydromechanics 49 (18)",
    "hydromechanics 49 falls away ultimately",
)


def test_no_number_is_left_out_of_the_list() -> None:
    """Heinbockel's run from (2.2.67) to (2.2.72); section 48 has (3)-(10) and (i)-(iii), 49 (1)-(29)."""
    numbers = {
        text: [id for id in NUMBERED if id.startswith(text)]
        for text in ("heinbockel", "hydromechanics 48", "hydromechanics 49")
    }
    assert [len(ids) for ids in numbers.values()] == [6, 11, 29]
    plain = [re.search(r"\((?:2\.2\.)?(\d+)\)$", id) for id in NUMBERED]
    counted = [int(match[1]) for match in plain if match]
    steps = [after - before for before, after in pairwise(counted)]
    # Only from text to text is there a jump back; (i)-(iii) are no numbers here.
    assert sorted(set(steps)) == [3 - 72, 1 - 10, 1]


def test_an_id_is_given_once() -> None:
    """No two entries share an id, and none is also among those that are cited only."""
    ids = [claim.id for claim in LEDGER]
    assert len(ids) == len(set(ids))
    assert not set(ids) & set(CITED)


def test_the_order_is_that_of_the_texts() -> None:
    """The ledger has every entry of the list written from the texts, in its order, and no other."""
    assert [claim.id for claim in LEDGER] == list(IN_ORDER)


@pytest.mark.parametrize(
    "claim",
    [pytest.param(c, marks=pytest.mark.slow if c.id in LONG else (), id=c.id) for c in LEDGER],
)
def test_an_entry_gets_its_recorded_verdict(claim: Claim) -> None:
    """The checks lead to the verdict that is published."""
    finding = examine(claim)
    assert finding.verdict is claim.verdict, (finding.statement, finding.transcribed)


# One of each other entry, and some more.
@pytest.mark.parametrize(
    ("claim", "name"),
    by_turns([m for m in MUTATIONS if m[0].id not in LONG], 4, lambda claim, name: claim.id)
    + [pytest.param(*m, marks=pytest.mark.slow) for m in MUTATIONS if m[0].id in LONG],
    ids=lambda part: getattr(part, "id", part),
)
def test_a_mutation_is_rejected(claim: Claim, name: str) -> None:
    """A statement with one thing changed misses its bound by a factor that no carelessness explains."""
    outcome = measured(claim.changed(claim.mutants[name]))
    assert outcome.is_refuted, outcome


def test_every_entry_has_a_mutation() -> None:
    """No check has never been seen to fail."""
    assert [claim.id for claim in LEDGER if not claim.mutants] == []


@pytest.mark.parametrize("claim", LEDGER, ids=lambda claim: claim.id)
def test_an_entry_says_what_its_verdict_needs(claim: Claim) -> None:
    """False: correction and counterexample. Only if: the condition, and that it is needed. And so on."""
    assert claim.statement
    assert claim.domain
    assert claim.method
    assert bool(claim.transcribed) == bool(claim.counterexample)
    says = {
        Verdict.FALSE: [claim.correction, claim.counterexample, claim.transcribed],
        Verdict.ONLY_IF: [claim.condition, claim.counterexample, claim.transcribed],
        Verdict.RESTORED: [claim.lost],
        Verdict.UNDECIDED: [claim.gap],
        Verdict.VACUOUS: [claim.void],
        Verdict.HOLDS: [not claim.condition, not claim.gap, not claim.transcribed],
    }
    assert all(says[claim.verdict])


@pytest.mark.parametrize("claim", LEDGER, ids=lambda claim: claim.id)
def test_mathematics_can_be_set(claim: Claim) -> None:
    """Braces and environments close, and nothing ends the mathematics or a table's cell early."""
    for latex in filter(None, (claim.statement, claim.correction)):
        assert not set("$`|&#%") & set(latex)
        assert latex.count("{") == latex.count("}")
        assert latex.count(r"\begin") == latex.count(r"\end")
        assert latex.count(r"\Big[") == latex.count(r"\Big]")
        assert latex.count(r"\Big(") == latex.count(r"\Big)")
        depth = 0
        for sign in latex:
            depth += (sign == "{") - (sign == "}")
            assert depth >= 0


def test_an_entry_is_found_by_its_id_or_by_its_text() -> None:
    """In any case and spacing; a text or a section stands for all of its entries."""
    assert [c.id for c in find(["Hydromechanics  49 (17)"])] == ["hydromechanics 49 (17)"]
    assert len(find(["hydromechanics 48"])) == sum(
        c.id.startswith("hydromechanics 48 ") for c in LEDGER
    )
    assert len(find(["heinbockel", "heinbockel (2.2.70)"])) == len(find(["heinbockel"]))
    assert [c.id for c in find(["(2.2.70)", "49 (17)"])] == [
        "heinbockel (2.2.70)",
        "hydromechanics 49 (17)",
    ]
    assert find([]) == LEDGER


# The verb

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


def test_unknown_ids_are_a_wrong_call(capsys: Captured) -> None:
    """Exit status 2, and all of them at once, each with what may have been meant."""
    asked = ("hydromechanics 49 (30)", "heinbockel (2.2.7)", "hydromechanic 49 (17)")
    assert main(["claims", "hydromechanics 49 (1)", *asked]) == 2
    out, error = capsys.readouterr()
    assert out == ""
    near = (r"hydromechanics 49 \(\d", r"heinbockel \(2\.2\.\d", r"hydromechanics 49 \(17\)'\?")
    for line, id, meant in zip(error.splitlines(), asked, near, strict=True):
        assert re.search(rf"got '{re.escape(id)}'; did you mean '{meant}", line)


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
