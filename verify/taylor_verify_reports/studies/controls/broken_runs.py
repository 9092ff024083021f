"""Measurement of the controls: every defect and its sound twin, run and judged on f64."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Final

from taylor_verify.judge.provenance import machine, packages
from taylor_verify.records.quantities import GATE_FACTOR
from taylor_verify.records.verdict import Verdict
from taylor_verify.run import run
from taylor_verify.solvers.solver import Solver
from taylor_verify_reports.controls.defect import Defect
from taylor_verify_reports.controls.defects import DEFECTS
from taylor_verify_reports.studies.controls.sight import ControlsStudy, DefectRow, Sight

RUNG: Final = "f64"

# Verdicts by quantity, and those on each twin by scene, solver and setting.
Verdicts = dict[str, Verdict]
Twins = dict[tuple[str, str, str], Verdicts]


def sights(
    defects: Iterable[Defect] = DEFECTS,
    finished: Callable[[str], None] | None = None,
    twins: Twins | None = None,
) -> list[Sight]:
    """Run every defect, and every sound twin once, even if several defects have the same twin.

    ``finished`` is called with the name of each defect as it ends. ``twins`` has verdicts on twins from
    earlier calls; new ones are added to it.
    """
    twins = {} if twins is None else twins
    rows = []
    for defect in defects:
        key = (defect.scene, defect.twin.name, defect.twin.setting)
        if key not in twins:
            twins[key] = _verdicts(defect.scene, defect.twin)
        verdicts = _verdicts(defect.scene, defect)
        rows.append(Sight(_row(defect), verdicts, twins[key], GATE_FACTOR))
        if finished is not None:
            finished(defect.name)
    return rows


def study(measured: Iterable[Sight]) -> ControlsStudy:
    """Return the document of the published table: each defect, and each verdict once."""
    rows = list(measured)
    verdicts = {
        (v.scene, v.solver, v.setting, v.quantity): v
        for sight in rows
        for v in (*sight.sound.values(), *sight.verdicts.values())
    }
    return ControlsStudy(
        versions=packages(),
        machine=machine(),
        factor=GATE_FACTOR,
        defects=tuple(sight.defect for sight in rows),
        verdicts=tuple(verdicts.values()),
    )


def _row(defect: Defect) -> DefectRow:
    return DefectRow(
        name=defect.name,
        setting=defect.setting,
        scene=defect.scene,
        gate=defect.gate,
        what=defect.what,
        why=defect.why,
        told=defect.is_common,
        twin=defect.twin.name,
        twin_setting=defect.twin.setting,
    )


def _verdicts(scene: str, solver: Solver) -> Verdicts:
    return {
        verdict.quantity: verdict for verdict in run(scene, solver, RUNG, causes=False).verdicts
    }
