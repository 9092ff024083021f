"""What each gate sees of a defect: the verdicts on it and on its sound twin, side by side."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any, Final

from taylor_verify.controls.defect import Defect
from taylor_verify.controls.defects import DEFECTS
from taylor_verify.records.quantities import GATE_FACTOR
from taylor_verify.records.verdict import Verdict
from taylor_verify.run import run
from taylor_verify.solvers.solver import Solver

RUNG: Final = "f64"


Twins = dict[tuple[str, str, str], tuple[Verdict, ...]]


@dataclass(frozen=True)
class Sight:
    """One defect on its scene, and the sound solver that differs from it by the defect alone."""

    defect: Defect
    verdicts: tuple[Verdict, ...]
    twin: tuple[Verdict, ...]


def sights(
    defects: Iterable[Defect] = DEFECTS,
    finished: Callable[[str], None] | None = None,
    twins: Twins | None = None,
) -> list[Sight]:
    """Run every defect and, once for all that share it, every sound twin.

    ``finished`` is told the name of each defect as it ends. ``twins`` has the verdicts of those that
    have run before, by scene, solver and setting, and is added to.
    """
    twins = {} if twins is None else twins
    found = []
    for defect in defects:
        key = (defect.scene, defect.twin.name, defect.twin.setting)
        if key not in twins:
            twins[key] = _verdicts(defect.scene, defect.twin)
        found.append(Sight(defect, _verdicts(defect.scene, defect), twins[key]))
        if finished is not None:
            finished(defect.name)
    return found


def document(found: Iterable[Sight]) -> dict[str, Any]:
    """The rows that the published table is made from: defects, and verdicts by solver and setting."""
    sights = list(found)
    verdicts = {
        (v.scene, v.solver, v.setting, v.quantity): v
        for sight in sights
        for v in (*sight.twin, *sight.verdicts)
    }
    return {
        "factor": GATE_FACTOR,
        "defects": [_row(sight.defect) for sight in sights],
        "verdicts": list(verdicts.values()),
    }


def _row(defect: Defect) -> dict[str, Any]:
    return {
        "name": defect.name,
        "setting": defect.setting,
        "scene": defect.scene,
        "gate": defect.gate,
        "what": defect.what,
        "why": defect.why,
        "told": defect.told,
        "twin": defect.twin.name,
        "twin_setting": defect.twin.setting,
    }


def _verdicts(scene: str, solver: Solver) -> tuple[Verdict, ...]:
    return run(scene, solver, RUNG).verdicts
