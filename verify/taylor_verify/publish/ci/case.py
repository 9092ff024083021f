"""A case: one row as a CI shows it, its verdict and what else is said of it taken together.

A CI knows red and green, and the exit status has decided which: what is no pass, and not merely
unavailable or waived by the caller, is red here too, so that no table of test results is greener than
the command.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import NamedTuple

from taylor_verify.publish.cells import figure, instant, ratio
from taylor_verify.records.status import Status, gravest
from taylor_verify.records.verdict import Verdict, exit_status

Key = tuple[str, str, str, str, str]


class Remark(NamedTuple):
    """Remark on a row besides its verdict: a regression fails it, a doubt undecides it."""

    scene: str
    solver: str
    setting: str
    rung: str
    quantity: str
    status: Status
    text: str


@dataclass(frozen=True)
class Case:
    """Quantity of a run; ``verdict`` is None for a row that only a remark speaks of.

    ``status`` is the gravest of the verdict's and the remarks', ``sentences`` say why, none for a
    pass without a remark. ``counted`` is the status that colours the row: that of the remarks where they
    alone decide. ``mark`` tells runs of one scene and rung apart: the setting, such as a file; empty where
    there is one run alone.
    """

    scene: str
    solver: str
    setting: str
    rung: str
    quantity: str
    status: Status
    counted: Status
    sentences: tuple[str, ...]
    verdict: Verdict | None
    mark: str = ""

    @property
    def is_harmless(self) -> bool:
        """True if the row is no pass and yet leaves the exit status as it is."""
        is_waived = self.verdict is not None and self.verdict.is_waived
        return self.counted is Status.UNAVAILABLE or (is_waived and self.counted is Status.VACUOUS)

    @property
    def title(self) -> str:
        """The row and the status that colours it."""
        mark = f", {self.mark}" if self.mark else ""
        return f"{self.scene} on {self.rung}{mark}: {self.quantity} {self.counted}"

    @property
    def text(self) -> str:
        """The reasons, a line each."""
        return "\n".join(self.sentences)


def cases(
    verdicts: Iterable[Verdict], remarks: Iterable[Remark] = (), by_remarks: bool = False
) -> tuple[Case, ...]:
    """Return a case for every row, in the order of the verdicts; then those of remarks alone.

    ``by_remarks`` tells that the remarks alone decide, as with `--gate baseline`.
    """
    rows = {_key(verdict): verdict for verdict in verdicts}
    remarks_of: dict[Key, list[Remark]] = {key: [] for key in rows}
    for remark in remarks:
        remarks_of.setdefault(_key(remark), []).append(remark)
    runs = {(scene, rung, solver, setting) for scene, solver, setting, rung, _ in remarks_of}
    alike = Counter((scene, rung) for scene, rung, *_ in runs)
    every = (_case(key, rows.get(key), own, by_remarks) for key, own in remarks_of.items())
    return tuple(
        replace(case, mark=case.setting) if alike[case.scene, case.rung] > 1 else case
        for case in every
    )


def _key(row: Verdict | Remark) -> Key:
    return row.scene, row.solver, row.setting, row.rung, row.quantity


def _case(key: Key, verdict: Verdict | None, remarks: list[Remark], by_remarks: bool) -> Case:
    statuses = [remark.status for remark in remarks]
    own = [] if verdict is None else [verdict.verdict]
    counted = own
    if by_remarks and verdict is not None and exit_status([verdict]):
        counted = [Status.PASS]
    faults = [] if verdict is None or verdict.verdict is Status.PASS else [sentence(verdict)]
    sentences = (*faults, *(remark.text for remark in remarks))
    return Case(
        *key, gravest((*own, *statuses)), gravest((*counted, *statuses)), sentences, verdict
    )


def sentence(verdict: Verdict) -> str:
    """Return the sentence of a verdict, and the numbers that a person needs beside it."""
    if not verdict.is_compared:
        return verdict.sentence
    size = "not finite" if verdict.max is None else figure(verdict.max)
    unit = f" ({verdict.unit})" if verdict.unit else ""
    where = "" if verdict.ratio_at is None else f" at t = {instant(verdict.ratio_at)}"
    return (
        f"{verdict.sentence}; largest error {size}{unit} at t = {instant(verdict.at)}, where "
        f"{figure(verdict.bound)} is allowed; up to {ratio(verdict)} times what perfect rounding "
        f"would leave{where}"
    )
