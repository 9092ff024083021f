"""Case of a CI report: one row with its verdict and all remarks.

A CI knows red and green, and the exit status decides between them. A row that is no pass is red here too,
unless it is unavailable or waived by the caller, so that no table of test results is greener than the
command.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import NamedTuple

from taylor_verify.records.status import Status, gravest
from taylor_verify.records.verdict import Verdict, exit_status
from taylor_verify.words.account import with_numbers

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
    """Quantity of a run; ``verdict`` is None for a row that has only remarks.

    ``status`` is the gravest of the verdict's and the remarks', and ``sentences`` are its reasons; a pass
    without a remark has none. ``counted`` is the status that colours the row: that of the remarks if they
    alone decide. ``mark`` distinguishes several runs of one scene and rung: the setting, such as a file;
    empty for a single run.
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
        """True if the row is no pass but does not change the exit status."""
        is_waived = self.verdict is not None and self.verdict.is_waived
        return self.counted is Status.UNAVAILABLE or (is_waived and self.counted is Status.VACUOUS)

    @property
    def title(self) -> str:
        """The row and the status that colours it."""
        mark = f", {self.mark}" if self.mark else ""
        return f"{self.scene} on {self.rung}{mark}: {self.quantity} {self.counted}"

    @property
    def text(self) -> str:
        """The reasons, one in each line."""
        return "\n".join(self.sentences)


def cases(
    verdicts: Iterable[Verdict], remarks: Iterable[Remark] = (), by_remarks: bool = False
) -> tuple[Case, ...]:
    """Return a case for every row in the order of the verdicts, then cases that have only remarks.

    ``by_remarks`` is true if the remarks alone decide, as with `--gate baseline`.
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
    faults = [] if verdict is None or verdict.verdict is Status.PASS else [with_numbers(verdict)]
    sentences = (*faults, *(remark.text for remark in remarks))
    return Case(
        *key, gravest((*own, *statuses)), gravest((*counted, *statuses)), sentences, verdict
    )
