"""The explanation of one run: the equations as built, the orbit, the terms of each gate."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import replace
from functools import partial
from os import PathLike
from typing import Any

from mpmath import mp

from taylor_verify.chain import judge_scene
from taylor_verify.exact import ellipsoid
from taylor_verify.exact.conditioning.condition import Path
from taylor_verify.exact.elements import Element, Elements, elements
from taylor_verify.exact.route import end_of_motion, solution
from taylor_verify.exact.solution import Unsettled
from taylor_verify.explain.loads import loads_document
from taylor_verify.judge.floor.arithmetic import truth_digits
from taylor_verify.judge.floor.attainable import orbit_of_run
from taylor_verify.judge.floor.carrying import Carrying, carrying
from taylor_verify.judge.judged_rows import question_record
from taylor_verify.judge.judgement import Judgement, judgement
from taylor_verify.models.form import Form
from taylor_verify.models.general import in_general_form, whole_form
from taylor_verify.models.problem import NotRepresentable, pose
from taylor_verify.numbers.patience import Patience
from taylor_verify.numbers.precision import Rung
from taylor_verify.numbers.precision import rung as rung_named
from taylor_verify.records.faults import shown
from taylor_verify.records.json_text import finite
from taylor_verify.records.quantities import TRACKED
from taylor_verify.records.reason import Cause, stated
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict
from taylor_verify.scenes.bodies import ImmersedBody
from taylor_verify.scenes.doubles import within_doubles
from taylor_verify.scenes.reading.reader import as_scene
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.files.file import Recorded
from taylor_verify.solvers.trajectory import Outcome

_DIGITS = 15
# Whoever asks for an explanation reads it at once.
_SECONDS = 8.0
_NO_ORBIT: Mapping[str, Any] = {"orbit": {}, "elements": [], "sentences": []}
# Digits beyond those of a rung, so that the exact number is rounded once.
_SPARE_DIGITS = 6
_FROM_RECORD = ("equations", "parameters", "units", "route", "truth_digits", "unit_roundoff")


def explanation(scene: Scene | str | PathLike[str], rung: Rung | str) -> dict[str, Any]:
    """Run the scene on a rung and return the document of ``explain``; no number is an estimate.

    Without heyoka the exact motion, rounded to the rung, is judged in place of an answer, and a warning
    says so.
    """
    rung = rung_named(rung)
    patience = Patience(_SECONDS)
    scene, ending = _before_end(as_scene(scene), patience)
    body = scene.body
    shape = ellipsoid.sentences(body) if isinstance(body, ImmersedBody) else []
    orbit = patience.made(partial(_orbit, scene), _NO_ORBIT)
    path = patience.made(partial(_loaded_path, scene, rung), None)
    loads = patience.made(partial(_loads, scene, path), None)
    too_long = _unjudged(scene, rung)
    judged, lacking = patience.made(partial(_judged, scene, rung), too_long)
    record = judged.record.document() if judged.record is not None else {}
    if lacking:
        with suppress(NotRepresentable, Unsettled):
            record = question_record(pose(scene, rung))
    first = judged.verdicts[0]
    effort = ("steps", "evaluations", "seconds")
    condition = partial(_condition, scene, path, rung)
    period = float(orbit["orbit"]["period"]) if "period" in orbit["orbit"] else None
    return {
        "scene": scene.name,
        "title": scene.title,
        "source": scene.source,
        "model": scene.model,
        "rung": rung.name,
        "bits": rung.bits,
        "track": sorted(quantity.name for quantity in scene.tracked),
        "warnings": [*scene.warnings, *ending, *lacking],
        "body": [*shape, *scene.notes],
        **{name: record.get(name) for name in _FROM_RECORD},
        "regime": solution(scene).regime,
        "rung_regime": record.get("regime"),
        "rounded": _rounded(scene, rung),
        "cost": {
            **_cost(scene, rung),
            **{name: None if lacking else getattr(first, name) for name in effort},
        },
        **orbit,
        "loads": loads,
        "condition": patience.made(lambda: condition(period) if judged.record else None, None),
        "outcome": first.outcome,
        "gates": [_gate(verdict) for verdict in judged.verdicts],
    }


def _unjudged(scene: Scene, rung: Rung) -> tuple[Judgement, list[str]]:
    """Return a judgement without a record, and a warning that says what is left out."""
    sentence = (
        f"left out: the run, its gates and the condition of the orbit take more than {_SECONDS:g} s of "
        "processor time (`run` takes the time that it needs)"
    )
    row = Verdict(
        *(scene.name, "taylor", rung.name, "", "scene", Status.UNDECIDED, Outcome.TIMED_OUT.value),
        reason=stated(Cause.UNFINISHED, sentence),
    )
    return Judgement((row,), None), [sentence]


def _before_end(scene: Scene, patience: Patience) -> tuple[Scene, list[str]]:
    """Return the scene up to its last sample before the motion ends, and a warning that says so."""
    clock = scene.clock
    end = patience.made(partial(end_of_motion, scene, clock.elapsed), None)
    if end is None or len(end.places) < 2:
        return scene, []
    instants = tuple(clock.instants[k] for k in end.places)
    sentence = f"explained up to t = {shown(instants[-1])}, where its motion is known: {end}"
    return replace(scene, clock=replace(clock, instants=instants)), [sentence]


def _loaded_path(scene: Scene, rung: Rung) -> Path | None:
    """Return the orbit under written loads; None without any, or where the motion is not known."""
    if scene.body.loads is None:
        return None
    try:
        with within_doubles(scene, Unsettled):
            return orbit_of_run(pose(scene, rung).given, scene, rung.bits)
    except (NotRepresentable, Unsettled):
        return None


def _loads(scene: Scene, path: Path | None) -> Mapping[str, Any] | None:
    """Return the loads along an orbit; None without one, or where their sizes are beyond the doubles."""
    with suppress(Unsettled), within_doubles(scene, Unsettled):
        return None if path is None else loads_document(scene, path)
    return None


def _judged(scene: Scene, rung: Rung) -> tuple[Judgement, list[str]]:
    """Return the judgement of heyoka's answer, or, without heyoka, of the exact motion and a warning."""
    judged = judge_scene(scene, "taylor", rung)
    first = judged.verdicts[0]
    lacks_heyoka = first.outcome == Outcome.NO_PACKAGE.value
    exact = _judged_exact_motion(scene, rung) if lacks_heyoka else None
    if exact is None:
        return judged, []
    instead = f"those of the exact motion rounded to {rung.name}, a step for each sample"
    return exact, [f"{first.because}; the gates are {instead}"]


def _judged_exact_motion(scene: Scene, rung: Rung) -> Judgement | None:
    """Return the judgement of the exact motion, rounded once to the rung; None if it cannot be computed."""
    try:
        problem = pose(scene, rung)
        digits = truth_digits(rung.bits, _SPARE_DIGITS)
        exact = solution(problem.given).motion(problem.given.clock.elapsed, digits)
        with mp.workprec(rung.bits):
            rounded = {name: +values for name, values in exact.quantities.items()}
        answer = Recorded(rounded, name="exact")
        return judgement(problem, answer, answer.solve(problem))
    except (NotRepresentable, Unsettled):
        return None


def _rounded(scene: Scene, rung: Rung) -> list[str]:
    """Name the data that the rung rounds: solver and truth then start from rounded numbers."""
    try:
        given = pose(scene, rung).given
    except NotRepresentable:
        return []
    pairs = {"body": (scene.body, given.body), "start": (scene.initial, given.initial)}
    return [name for name, (own, other) in pairs.items() if own.parts() != other.parts()]


def _orbit(scene: Scene) -> Mapping[str, Any]:
    """Return the numbers of the orbit by name, the meaning of each, and sentences about them.

    They follow from the scene's own numbers and from omega or the impulses; attitude and centre do not
    change them. All are empty if the digits cannot be computed.
    """
    try:
        with within_doubles(scene, Unsettled):
            orbit = elements(scene, _DIGITS)
    except Unsettled as doubt:
        orbit = Elements("", (), (str(doubt),))
    numbers = [_element(element) for element in orbit.numbers]
    return {
        "orbit": {number["name"]: number["value"] for number in numbers},
        "elements": numbers,
        "sentences": list(orbit.sentences),
    }


def _element(element: Element) -> dict[str, str]:
    words = {name: getattr(element, name) for name in ("unit", "meaning", "source")}
    return {"name": element.name, "value": str(mp.nstr(element.value, _DIGITS)), **words}


def _condition(
    scene: Scene, path: Path | None, rung: Rung, period: float | None
) -> dict[str, Any] | None:
    """Return the growth of an error at the first sample along the orbit; None if it is not known."""
    carried = None
    with suppress(Unsettled), within_doubles(scene, Unsettled):
        carried = carrying(scene, path)
    if carried is None:
        return None
    worst, pace = carried.worst, carried.pace
    per_period = None if pace is None or period is None else finite(pace * period)
    sentences = list(_condition_sentences(carried, rung, per_period))
    return {
        "from": carried.times[0],
        "worst": finite(carried.factors[worst]),
        "worst_at": carried.times[worst],
        "end": finite(carried.factors[-1]),
        "end_at": carried.times[-1],
        "per_period": per_period,
        "sentence": " ".join(sentences),
        "sentences": sentences,
    }


def _condition_sentences(carried: Carrying, rung: Rung, per_period: float | None) -> Iterator[str]:
    """Yield the factors in words, and the size that one rounding of this rung grows to."""
    worst, u = carried.worst, float(rung.unit_roundoff)
    becomes = u * carried.factors[worst]
    later = ""
    if worst < len(carried.times) - 1:
        later = f", and by {carried.factors[-1]:.3g} at the end (t = {carried.times[-1]:g})"
    yield (
        f"An error in the state at t = {carried.times[0]:g} is multiplied, each time relative to the "
        f"state, by {carried.factors[worst]:.3g} at worst (t = {carried.times[worst]:g}){later}."
    )
    pace, unit = (carried.pace, "time unit") if per_period is None else (per_period, "period")
    if pace is not None:
        yield f"It grows in proportion to time, by about {pace:.2g} per {unit}."
    lost = "; nothing of the state is left then" if not becomes < 1 else ""
    yield (
        f"On {rung.name} one rounding, u = {u:.2g}, has then become {becomes:.2g} at worst{lost}."
    )


def _gate(verdict: Verdict) -> dict[str, Any]:
    names = (
        "quantity",
        "max",
        "mean",
        "final",
        "at",
        "unit",
        "attainable",
        "bound",
        "ratio",
        "ratio_at",
        "because",
        "reason",
    )
    row = verdict.row()
    return {"verdict": verdict.verdict.value} | {name: row[name] for name in names}


_COUNTED = ("states", "parameters", "sums", "products", "quotients")


def _cost(scene: Scene, rung: Rung) -> dict[str, Any]:
    """Return the cost of an evaluation, that of other equations, and why these were chosen.

    ``general`` counts the general equations of all quantities that the model has. ``same`` counts the
    general equations of this body for the quantities of this scene, without coefficients that are zero.
    """
    try:
        problem = pose(scene, rung)
    except NotRepresentable:
        unknown = dict.fromkeys(_COUNTED)
        return {**unknown, "general": unknown, "same": unknown, "because": []}
    return {
        **_counts(problem.form),
        "general": _counts(whole_form(scene.body)),
        "same": _counts(in_general_form(problem).form),
        "because": [*problem.because, *_left_out(scene)],
    }


def _counts(form: Form) -> dict[str, Any]:
    operations = form.operations()
    return {
        "states": len(form.states),
        "parameters": len(form.entering()),
        **{name: operations[name] for name in ("sums", "products", "quotients")},
    }


def _left_out(scene: Scene) -> list[str]:
    """Return sentences on the quantities and the loads that the scene lacks."""
    possible = TRACKED[scene.model]
    sentences = [f"no {name}: it is not tracked" for name in possible if name not in scene.track]
    if scene.body.is_free:
        sentences.append(" and ".join(f"no {load}" for load in scene.body.load_names()))
    return sentences
