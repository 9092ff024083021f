"""What a scene asks and how it is judged: the equations as built, the orbit, each gate's terms."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from mpmath import mp

from verify.exact.route import solution
from verify.exact.solution import NoClosedForm, Orbital
from verify.judge.verdict import Verdict
from verify.models.problem import NotRepresentable, pose
from verify.run import run
from verify.scenes.precision import rung as rung_named
from verify.scenes.reader import load
from verify.scenes.scene import Scene

_DIGITS = 15
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
        "orbit": _elements(scene),
        "outcome": first.outcome,
        "gates": [_gate(verdict) for verdict in found.verdicts],
    }


def _elements(scene: Scene) -> dict[str, str]:
    """Period, rate, parameter m = k^2 and 1 - m of the impulses' or omega's orbit, as decimals.

    They belong to the scene's own numbers, and exist where there is a closed form; attitude and
    centre do not change them.
    """
    try:
        exact = solution(replace(scene, track=frozenset()), "mpmath")
    except NoClosedForm:
        return {}
    if not isinstance(exact, Orbital):
        return {}
    return {name: str(mp.nstr(v, _DIGITS)) for name, v in exact.elements(_DIGITS).items()}


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
