"""What a scene asks and how it is judged: the equations as built, the orbit, each gate's terms."""

from __future__ import annotations

from typing import Any

from verify.judge.verdict import Verdict
from verify.models.problem import NotRepresentable, pose
from verify.run import run
from verify.scenes.precision import rung as rung_named
from verify.scenes.reader import load
from verify.scenes.scene import Scene

_FROM_RECORD = (
    *("equations", "parameters", "units", "regime", "route", "truth_digits", "unit_roundoff"),
)


def explanation(scene: Scene | str, rung: str) -> dict[str, Any]:
    """One run of the scene, told by its record: nothing here is an estimate.

    What a run that came to no comparison has not found out is None. Raises scenes.faults.Refused
    for a scene that cannot be read.
    """
    scene = load(scene) if isinstance(scene, str) else scene
    found = run(scene, "taylor", rung)
    record = found.record.document() if found.record is not None else {}
    first = found.verdicts[0]
    return {
        "scene": scene.name,
        "title": scene.title,
        "source": scene.source,
        "model": scene.model,
        "rung": rung,
        "bits": rung_named(rung).bits,
        "track": sorted({"omega" if scene.model == "euler" else "impulse"} | scene.track),
        "warnings": list(scene.warnings),
        **{name: record.get(name) for name in _FROM_RECORD},
        "cost": {
            **_cost(scene, rung),
            "steps": first.steps,
            "evaluations": first.evaluations,
            "seconds": first.seconds,
        },
        "outcome": first.outcome,
        "gates": [_gate(verdict) for verdict in found.verdicts],
    }


def _gate(verdict: Verdict) -> dict[str, Any]:
    names = (
        *("quantity", "max", "mean", "final", "at", "unit", "attainable", "bound", "ratio"),
        *("ratio_at", "because"),
    )
    row = verdict.row()
    return {"verdict": verdict.verdict.value} | {name: row[name] for name in names}


def _cost(scene: Scene, rung: str) -> dict[str, int | None]:
    try:
        form = pose(scene, rung_named(rung)).form
    except NotRepresentable:
        return dict.fromkeys(("states", "sums", "products", "quotients"))
    return {"states": len(form.states), **form.operations()}
