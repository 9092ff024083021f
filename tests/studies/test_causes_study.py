"""The confusion table of likely causes and its list of kinds; what is said of answers, vectors hold."""

from __future__ import annotations

from pathlib import Path

import pytest

from taylor_verify_reports.studies.causes import measure
from taylor_verify_reports.studies.causes.kinds import KINDS
from taylor_verify_reports.studies.causes.measure import OUTCOMES, Named, measured, page, table
from taylor_verify_reports.studies.unfinished import Parts


def test_sound_methods_are_kinds() -> None:
    """Sound methods and unknown laws are among the kinds, and silence is right for them."""
    silent = {kind.name for kind in KINDS if not kind.words}
    assert {"RK45 at 1e-4", "LSODA at 1e-6", "cubic drag", "growing load"} <= silent
    assert len({kind.name for kind in KINDS}) == len(KINDS)


def test_the_page_has_what_is_false() -> None:
    """Below the table each false sentence stands with its kind and its body."""
    answers = [Named("a", "free", "right", ("x",)), Named("b", "free", "false", ("y",))]
    assert page(answers).splitlines()[-1] == "- b, free: y"


def test_the_table_counts_every_answer() -> None:
    """The last row is the sum of all rows, outcome by outcome."""
    answers = [Named("a", "free", "right", ()), Named("b", "free", "false", ("x",))]
    assert table(answers).splitlines()[0] == f"| answers | {' | '.join(OUTCOMES)} |"
    assert table(answers).splitlines()[-1] == "| all | 1 | 0 | 0 | 0 | 0 | 1 |"


def test_a_finished_answer_is_not_made_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """After an interrupt the study goes on with the answers that are not finished yet."""
    kind = next(kind for kind in KINDS if kind.name == "degrees")
    (first,) = measured(1, 1, [kind], Parts(tmp_path))
    monkeypatch.setattr(measure, "_answer", lambda *asked: None)
    assert [*measured(1, 2, [kind], Parts(tmp_path))] == [first]
