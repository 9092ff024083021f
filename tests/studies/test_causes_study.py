"""The confusion table of likely causes and its list of kinds; what is said of answers, vectors hold."""

from __future__ import annotations

from taylor_verify_reports.studies.causes.kinds import KINDS
from taylor_verify_reports.studies.causes.measure import OUTCOMES, Named, page, table


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
