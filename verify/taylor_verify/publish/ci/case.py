"""A case: one row as a CI shows it, its verdict and what else is said of it taken together.

A CI knows red and green, and the exit status has decided which: what is no pass, and not merely
unavailable or waived by the caller, is red here too, so that no table of test results is greener than
the command.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import NamedTuple

from taylor_verify.publish.cells import figure, instant, ratio
from taylor_verify.records.status import GRAVITY, Status
from taylor_verify.records.verdict import Verdict

Key = tuple[str, str, str, str, str]


class Remark(NamedTuple):
    """What is said of a row besides its verdict: a regression fails it, a doubt undecides it."""

    scene: str
    solver: str
    setting: str
    rung: str
    quantity: str
    status: Status
    text: str


@dataclass(frozen=True)
class Case:
    """One quantity of one run; ``verdict`` is None for a row that only a remark speaks of.

    ``status`` is the gravest of the verdict's and the remarks', ``sentences`` say why, none for a
    pass without a remark.
    """

    scene: str
    solver: str
    setting: str
    rung: str
    quantity: str
    status: Status
    sentences: tuple[str, ...]
    verdict: Verdict | None

    @property
    def is_harmless(self) -> bool:
        """Whether the row is no pass and yet leaves the exit status as it is."""
        is_waived = self.verdict is not None and self.verdict.is_waived
        return self.status is Status.UNAVAILABLE or (is_waived and self.status is Status.VACUOUS)

    @property
    def title(self) -> str:
        return f"{self.scene} on {self.rung}: {self.quantity} {self.status}"

    @property
    def text(self) -> str:
        return "\n".join(self.sentences)


def cases(verdicts: Iterable[Verdict], remarks: Iterable[Remark] = ()) -> tuple[Case, ...]:
    """A case for every row, in the order of the verdicts; then those that only remarks speak of."""
    rows = {_key(verdict): verdict for verdict in verdicts}
    said: dict[Key, list[Remark]] = {key: [] for key in rows}
    for remark in remarks:
        said.setdefault(_key(remark), []).append(remark)
    return tuple(_case(key, rows.get(key), told) for key, told in said.items())


def _key(row: Verdict | Remark) -> Key:
    return row.scene, row.solver, row.setting, row.rung, row.quantity


def _case(key: Key, verdict: Verdict | None, remarks: list[Remark]) -> Case:
    own = [] if verdict is None else [verdict.verdict]
    status = min((*own, *(remark.status for remark in remarks)), key=GRAVITY.index)
    return Case(*key, status, tuple(_sentences(verdict, remarks)), verdict)


def _sentences(verdict: Verdict | None, remarks: list[Remark]) -> Iterator[str]:
    if verdict is not None and verdict.verdict is not Status.PASS:
        yield sentence(verdict)
    for remark in remarks:
        yield remark.text


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
