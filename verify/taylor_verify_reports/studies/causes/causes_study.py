"""The study of likely causes: answers with known faults on random bodies, and what is said of each."""

from __future__ import annotations

from pathlib import Path
from typing import Final

from taylor_verify.records.replacement import replace_files
from taylor_verify_reports.studies.study import Measured, Option, Progress, Study

# The repository does not hold the page.
_PAGE: Final = "local/causes.md"
_SEED: Final = 1


def _measure(folder: Path, progress: Progress, count: int = 20) -> Measured:
    """Write the confusion table, and below it each false sentence; go on after an interrupt."""
    from taylor_verify_reports.studies.causes.kinds import KINDS
    from taylor_verify_reports.studies.causes.measured_causes import measured, page
    from taylor_verify_reports.studies.finished_parts import Parts, unfinished

    finished = progress.counting(count * len(KINDS))
    with unfinished(STUDY.name, folder) as place:
        answers = measured(_SEED, count, Parts(place), finished=finished)
        return Measured(replace_files(folder, {_PAGE: page(answers)}))


def _positive(text: str) -> int:
    if not text.isdecimal() or not int(text):
        raise ValueError(f"expected a positive integer, got {text!r}")
    return int(text)


STUDY: Final[Study[None]] = Study(
    name="causes",
    title="how often likely causes are right, on random bodies with known faults",
    duration="an hour",
    measure=_measure,
    needs_heyoka=False,
    options=(Option("count", "make N answers of each kind; default: 20", _positive),),
)
