"""The judgement of a run beside an earlier one, which must pass too."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from os import PathLike
from typing import Any

from taylor_verify.batch.comparison import Comparison, Earlier
from taylor_verify.batch.earlier_file import of_document, read_baseline
from taylor_verify.judge.judgement import Judgement
from taylor_verify.records.faults import brief

_GATES = ("bound", "baseline")


@dataclass(frozen=True, repr=False)
class ComparedJudgement(Judgement):
    """A Judgement, and its ``comparison`` with a baseline: it passes where both do.

    A comparison that ``decides`` is asked alone.
    """

    comparison: Comparison

    @property
    def passed(self) -> bool:
        """True if the comparison passed and, unless it decides alone, the judgement too."""
        return self.comparison.passed and (self.comparison.decides or super().passed)

    def raise_for_failure(self) -> None:
        """Raise NotPassed, with the lines of the comparison or else of the judgement, unless it passed."""
        self.comparison.raise_for_failure()
        super().raise_for_failure()


def earlier(baseline: str | PathLike[str] | Mapping[str, Any] | None, gate: str) -> Earlier | None:
    """Return the rows of a baseline. Raises as `read_baseline` does, ValueError for a wrong gate."""
    if gate not in _GATES:
        raise ValueError(f"expected bound or baseline, got {brief(gate)} @ gate")
    if baseline is None:
        if gate == "baseline":
            raise ValueError("expected a baseline with the gate baseline, got none @ baseline")
        return None
    if isinstance(baseline, Mapping):
        return of_document(baseline)
    if not isinstance(baseline, str | PathLike):
        got = brief(baseline)
        raise ValueError(f"expected the path of a baseline or its document, got {got} @ baseline")
    return read_baseline(baseline)


def compared(judged: Judgement, before: Earlier, gate: str) -> ComparedJudgement:
    """Return a judgement with its comparison."""
    comparison = before.compare_as_baseline(judged, gate == "baseline")
    return ComparedJudgement(**judged.common, comparison=comparison)
