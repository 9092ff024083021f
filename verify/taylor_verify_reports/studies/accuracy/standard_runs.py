"""The study of accuracy: tables of the verdicts on the standard set on every rung."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Final

from taylor_verify.records import store
from taylor_verify.records.runs import Run
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict
from taylor_verify.report.folder import TABLES
from taylor_verify_reports.studies.study import Bulk, Departed, Measured, Progress, Published, Study

if TYPE_CHECKING:
    from taylor_verify.batch.job import Job
    from taylor_verify.judge.judgement import Judgement

_SOLVER: Final = "taylor"
# A run that was never judged has no record.
_UNJUDGED: Final = (Status.REFUSED, Status.UNAVAILABLE)

Verdicts = Sequence[Verdict]


def _measure(folder: Path, progress: Progress) -> Measured:
    """Run the standard set on every rung, as `run --out` does."""
    from taylor_verify.batch.chosen_scenes import select
    from taylor_verify.batch.judgements import Judgements
    from taylor_verify.batch.judging import judge_all

    selection = select()
    with progress.jobs() as bar:
        judgements = tuple(judge_all(selection.jobs(_SOLVER), bar))
    results = Judgements(judgements, selection, _SOLVER)
    written = store.write(folder, results.verdicts, results.records)
    return Measured(written, status=results.exit_status)


def _find(folder: Path) -> Verdicts | None:
    return store.load(folder) if (folder / store.FOLDER / store.VERDICTS).exists() else None


# Files that the repository leaves out: records with every sample.


def _runs_lacking(report: Published) -> tuple[Run, ...]:
    """Return the runs without a record; all runs if the records belong to other verdicts."""
    data = report.folder / store.FOLDER
    own = [run for run in report.runs if run.solver == _SOLVER and not run.setting]
    judged = [run for run in own if any(v.verdict not in _UNJUDGED for v in run.verdicts)]
    if not store.has_own_records(report.folder):
        return tuple(judged)
    names = [store.record_name(run.scene, run.solver, run.rung) for run in judged]
    return tuple(run for run, name in zip(judged, names, strict=True) if not (data / name).exists())


def _add_records(folder: Path, lacking: Sequence[Run], progress: Progress) -> tuple[Path, ...]:
    """Run the published runs once more; the records of a scene are written as its runs end.

    Raises Departed at the end; a scene whose numbers are not the published ones has no records.
    """
    from taylor_verify.batch.differences import compare
    from taylor_verify.batch.failure import Failed
    from taylor_verify.batch.job import Job
    from taylor_verify.batch.judging import run_job
    from taylor_verify.batch.work import run_all

    published: dict[str, list[Run]] = {}
    for run in lacking:
        published.setdefault(run.scene, []).append(run)
    jobs = [Job(s, _SOLVER, tuple(run.rung for run in own)) for s, own in published.items()]
    finished, written = progress.counting(len(jobs)), dict[Path, None]()
    departures: list[str] = []

    def keep(job: Job, judged: Sequence[Judgement]) -> None:
        before = (verdict for run in published[job.name] for verdict in run.verdicts)
        after = (verdict for one in judged for verdict in one.verdicts)
        if departed := compare(before, after).departures:
            departures.extend(map(str, departed))
        else:
            records = [one.record for one in judged if one.record is not None]
            written.update(dict.fromkeys(store.add_records(folder, records)))
        finished(str(job))

    run_all(run_job, jobs, ended=keep, raises=Failed)
    if departures:
        raise Departed("\n".join(departures))
    return tuple(written)


STUDY: Final = Study(
    name="accuracy",
    title="the errors of the standard set on every rung, beside what is attainable",
    duration="two minutes, all cores",
    measure=_measure,
    find=_find,
    page=lambda verdicts, folder: TABLES["tables/accuracy.md"](verdicts),
    beside={path: make for path, make in TABLES.items() if "accuracy" not in path},
    bulk=(
        Bulk(
            what="records of runs",
            patterns=("data/records/",),
            lacking=_runs_lacking,
            make=_add_records,
        ),
    ),
)
