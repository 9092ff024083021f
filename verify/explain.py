"""What a scene asks and how it is judged: the equations as built, the orbit, each gate's terms."""

from __future__ import annotations

from typing import Any

from verify.run import run
from verify.scenes.reader import load


def explanation(scene_name: str, rung: str) -> dict[str, Any]:
    """One run of the scene, told by its record: nothing here is an estimate.

    Raises scenes.faults.Refused for a scene that cannot be read.
    """
    scene = load(scene_name)
    found = run(scene, "taylor", rung)
    record = found.record.document() if found.record is not None else {}
    gates = [
        {
            "quantity": verdict.quantity,
            "verdict": verdict.verdict.value,
            "error": verdict.max,
            "at": verdict.at,
            "unit": verdict.unit,
            "attainable": verdict.attainable,
            "bound": verdict.bound,
            "because": verdict.because,
        }
        for verdict in found.verdicts
    ]
    first = found.verdicts[0]
    told = (
        "equations", "parameters", "units", "regime", "route", "truth_digits", "unit_roundoff",
    )
    return {
        "scene": scene.name,
        "title": scene.title,
        "source": scene.source,
        "model": scene.model,
        "rung": rung,
        "track": sorted({"omega" if scene.model == "euler" else "impulse"} | scene.track),
        "warnings": list(scene.warnings),
        **{name: record.get(name) for name in told},
        "cost": {
            "states": len(record.get("equations", ())),
            "steps": first.steps,
            "evaluations": first.evaluations,
            "seconds": first.seconds,
        },
        "outcome": first.outcome,
        "gates": gates,
    }
