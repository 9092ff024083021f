"""Measurement of the hard scenes: the verdicts of all extremes, the search and the reach."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final

from taylor_verify.batch.chosen_scenes import select
from taylor_verify.batch.judgements import Judgements
from taylor_verify.batch.judging import Progress, judge_all
from taylor_verify.judge.provenance import command, processor, versions
from taylor_verify.records import store
from taylor_verify.records.provenance import Machine, Provenance
from taylor_verify.records.status import Status
from taylor_verify.scenes.library import EXTREMES
from taylor_verify_reports.studies.hard.hard_scenes import (
    Expected,
    HardStudy,
    ReachRow,
    Search,
    Titled,
)
from taylor_verify_reports.studies.hard.members import FOLLOWED
from taylor_verify_reports.studies.hard.search import RUNG

_SOLVER: Final = "taylor"


def extremes(progress: Progress | None = None) -> Judgements:
    """Solve and judge every extreme on the published rung, which is that of `make verify`."""
    selection = select([EXTREMES], [RUNG])
    judgements = judge_all(selection.jobs(_SOLVER), progress)
    return Judgements(tuple(judgements), selection, _SOLVER)


def study(results: Judgements, reach: Iterable[ReachRow] = ()) -> HardStudy:
    """Return the document of these verdicts and rows, without a search.

    Raises ValueError for verdicts of different versions.
    """
    agreement, verdicts = results.agreement, results.verdicts
    expected = (
        Expected(*row, Status(wanted.verdict), wanted.why)
        for row, wanted in agreement.expected.items()
        if wanted.verdict != Status.PASS
    )
    return HardStudy(
        versions=store.versions(verdicts),
        machine=Machine(**store.machine(verdicts[0])) if verdicts else Machine(),
        scenes=tuple(Titled(scene.name, scene.title) for scene in results.selection.scenes_run),
        left_out=results.left_out,
        expected=tuple(expected),
        mismatches=tuple(str(mismatch) for mismatch in agreement.mismatches),
        families=tuple(family.described() for family in FOLLOWED),
        reach=tuple(reach),
        verdicts=verdicts,
    )


def searched(runs: int, seed: int) -> Search:
    """Return what is stored of a search beside its worst scenes."""
    return Search(RUNG, runs, seed, Provenance(versions(), processor(), command()))
