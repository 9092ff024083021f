"""The ledger is complete, every entry gets its recorded verdict, and every mutation is rejected."""

from __future__ import annotations

import re
from itertools import pairwise

import pytest
from builders.turns import by_turns

from taylor_verify_reports.claims.check import measured
from taylor_verify_reports.claims.claim import Claim, Verdict, examine
from taylor_verify_reports.claims.ledger import UnknownClaim, claims, find
from taylor_verify_reports.claims.numbers import CITED, IN_ORDER, NUMBERED, SENTENCES

LEDGER = claims()
MUTATIONS = [(claim, name) for claim in LEDGER for name in claim.mutants]
# Integrals over many periods, and a motion that falls away for ever: seconds each.
LONG = (
    "heinbockel constant moments",
    "hydromechanics 49 (18)",
    "hydromechanics 49 falls away ultimately",
)


def test_every_number_of_the_texts_has_an_entry_and_no_other() -> None:
    """The list written from the texts and the entries are the same set."""
    assert set(NUMBERED) | set(SENTENCES) == {claim.id for claim in LEDGER}


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
    """The ledger is in the order of the list, which holds every entry once."""
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


def test_an_unknown_id_is_refused_with_the_nearest() -> None:
    """All unknown ids at once, each with what may have been meant."""
    with pytest.raises(UnknownClaim) as error:
        find(["hydromechanics 49 (30)", "heinbockel (2.2.7)", "hydromechanics 49 (1)"])
    first, second = str(error.value).splitlines()
    assert re.search(r"got 'hydromechanics 49 \(30\)'; did you mean 'hydromechanics 49 \(\d", first)
    assert re.search(r"got 'heinbockel \(2\.2\.7\)'; did you mean 'heinbockel \(2\.2\.\d", second)
