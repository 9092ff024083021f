"""Run of all extremes, and its document with the expected verdicts."""

from __future__ import annotations

from typing import Final

from taylor_verify.batch.judgements import Judgements
from taylor_verify.batch.judging import Progress, judge_all
from taylor_verify.batch.selection import select
from taylor_verify.records import store
from taylor_verify.records.provenance import Machine
from taylor_verify.records.status import Status
from taylor_verify.scenes.library import EXTREMES
from taylor_verify_reports.studies.extremes.document import (
    Expected,
    ExtremesStudy,
    ExtremeVerdict,
    Titled,
)

# The rung on which the extremes are published, and on which `make verify` runs them.
_RUNG: Final = "f64"
_SOLVER: Final = "taylor"


def extremes(progress: Progress | None = None) -> Judgements:
    """Solve and judge every extreme on the published rung."""
    selection = select([EXTREMES], [_RUNG])
    judgements = judge_all(selection.jobs(_SOLVER), progress)
    return Judgements(tuple(judgements), selection, _SOLVER)


def extremes_study(results: Judgements) -> ExtremesStudy:
    """Return the document that the page of the extremes is made from.

    Raises ValueError for verdicts of different versions.
    """
    agreement, verdicts = results.agreement, results.verdicts
    expected = {row: Expected(Status(e.verdict), e.why) for row, e in agreement.expected.items()}
    return ExtremesStudy(
        versions=store.versions(verdicts),
        machine=Machine(**store.machine(verdicts[0])) if verdicts else Machine(),
        scenes=tuple(Titled(scene.name, scene.title) for scene in results.selection.scenes_run),
        left_out=results.left_out,
        mismatches=tuple(str(mismatch) for mismatch in agreement.mismatches),
        verdicts=tuple(
            ExtremeVerdict.of(v, expected.get((v.scene, v.rung, v.quantity))) for v in verdicts
        ),
    )
