"""What each verb does: options in, an answer out."""

from __future__ import annotations

import argparse
from collections.abc import Iterable, Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any

from taylor_verify.cli.answer import FAIL, PASS, UNDECIDED, WRONG_CALL, Answer, WrongCall
from taylor_verify.cli.folders import IN_A_CHECKOUT, alone_in, writable
from taylor_verify.cli.streams import say

if TYPE_CHECKING:
    from fractions import Fraction
    from pathlib import Path

    from taylor_verify.judge.judgement import Judgement
    from taylor_verify.judge.verdict import Verdict
    from taylor_verify.scenes.scene import Scene
    from taylor_verify.solvers.file import TrajectoryFile


def list_all(options: argparse.Namespace) -> Answer:
    """Everything that has a name."""
    from taylor_verify.cli.terminal import names_text
    from taylor_verify.scenes.library import EXTREMES, names
    from taylor_verify.scenes.precision import LADDER
    from taylor_verify.scenes.reader import load
    from taylor_verify.solvers.registry import NAMES

    del options
    scenes = {"scenes": list(names()), "extremes": list(names(EXTREMES))}
    titles = {name: load(name).title for group in scenes.values() for name in group}
    found = {**scenes, "solvers": list(NAMES), "rungs": list(LADDER)}
    return Answer(PASS, found, partial(names_text, found, titles))


def run(options: argparse.Namespace) -> Answer:
    """The whole chain for some scenes, or for the standard set."""
    from taylor_verify.scenes.expected import left_out
    from taylor_verify.scenes.library import named, names
    from taylor_verify.scenes.precision import LADDER

    rungs = known_rungs(options.rung or (["f64"] if options.scenes else LADDER))
    _known_solver(options.solver)
    without = left_out(options.scenes, rungs)
    options.scenes = [name for word in options.scenes for name in named(word)]
    scenes = list(dict.fromkeys(options.scenes)) or list(names())
    read_scenes(scenes)
    folder = writable(options.out) if options.out is not None else None
    with alone_in(folder):
        return _run(options, scenes, rungs, without, folder)


def _run(
    options: argparse.Namespace,
    scenes: Sequence[str],
    rungs: Sequence[str],
    without: Mapping[tuple[str, str], str],
    folder: Path | None,
) -> Answer:
    """Run scenes that are known to be sound, into a folder that nobody else writes to."""
    from taylor_verify.cli.ci import outputs, tell
    from taylor_verify.cli.terminal import verdicts_text
    from taylor_verify.expected import hold
    from taylor_verify.judge.verdict import summary

    published = _published(options, rungs) if options.against is not None else None
    asked = outputs(options)
    results = _judge(scenes, options.solver, rungs, without, options.resume, folder)
    verdicts = [verdict for result in results for verdict in result.verdicts]
    held = hold(verdicts)
    status, messages = held.exit_status(verdicts), []
    if status == WRONG_CALL:
        messages.append(f"nothing was judged: {held.unjudged(verdicts)}")
    if folder is not None:
        try:
            messages.append(_write_reports(folder, results))
        except (OSError, ValueError) as error:
            # A run that took hours is shown in any case.
            messages.append(f"expected to write the reports, got {error} @ --out {folder}")
            status = WRONG_CALL
    found: dict[str, Any] = {
        "verdicts": [held.row(v) for v in verdicts],
        "summary": summary(verdicts),
    }
    if held.expected:
        found["expected"] = held.document(verdicts)
    if without:
        found["left_out"] = [{"scene": s, "rung": r, "why": w} for (s, r), w in without.items()]
    if published is not None:
        found["against"], told = _held_against(options.against, published, verdicts)
        messages += told
        status = _status_against(found["against"], status)
    again = _asked_again(asked.baseline or (), options, rungs)
    to_ci = tell(asked, verdicts, status, again, held)
    text = partial(verdicts_text, verdicts, held)
    not_run = [f"not run: {scene} on {rung}: {why}" for (scene, rung), why in without.items()]
    messages += [*to_ci.messages, *not_run, *_dearest(scenes, results)]
    return Answer(to_ci.status, {**found, **to_ci.document}, text, messages)


def _dearest(scenes: Sequence[str], results: Iterable[Judgement]) -> list[str]:
    """Where the time of a set of scenes went."""
    from taylor_verify.judge.costs import sentence, total

    spent = total(result.costs for result in results)
    return [sentence(spent)] if len(scenes) > 1 and spent else []


def _published(options: argparse.Namespace, rungs: Sequence[str]) -> list[Verdict]:
    """What the folder of --against has of the solver, the rungs and, where named, the scenes."""
    from taylor_verify.publish import report

    try:
        verdicts = report.load(options.against)
    except FileNotFoundError as error:
        raise WrongCall(
            f"expected a folder of `run --out`, got no such file @ --against {error.filename}; "
            f"{IN_A_CHECKOUT}"
        ) from error
    except ValueError as error:
        raise WrongCall(f"{error} (--against)") from error
    return _asked_again(verdicts, options, rungs)


def _asked_again(
    verdicts: Iterable[Verdict], options: argparse.Namespace, rungs: Sequence[str]
) -> list[Verdict]:
    """The rows of the solver, the rungs and, where named, the scenes of this call."""
    asked = [v for v in verdicts if v.solver == options.solver and v.rung in rungs]
    return [v for v in asked if not options.scenes or v.scene in options.scenes]


def _held_against(
    folder: str, published: Iterable[Verdict], made: Iterable[Verdict]
) -> tuple[dict[str, Any], list[str]]:
    """The comparison as a document, and as messages: every departure, then how many rows."""
    from taylor_verify.judge.rounding_class import compare

    comparison = compare(published, made)
    told = [str(departure) for departure in comparison.departures]
    document = {"folder": folder, "compared": comparison.compared, "departures": told}
    rows = f"{comparison.compared} rows compared with {folder}"
    return document, [*told, f"{rows}: {len(told)} departures from their rounding class"]


def _status_against(found: Mapping[str, Any], status: int) -> int:
    """The graver of the run's own status and that of the comparison, undecided if it had no row."""
    if status == WRONG_CALL:
        return status
    if found["departures"]:
        return FAIL
    return status if found["compared"] else status or UNDECIDED


def exact(options: argparse.Namespace) -> Answer:
    """The exact motion of one scene."""
    from taylor_verify.cli.progress import working
    from taylor_verify.cli.terminal import exact_text
    from taylor_verify.exact.request import MOST_DIGITS

    if not 1 <= options.digits <= MOST_DIGITS:
        raise WrongCall(f"expected --digits from 1 to {MOST_DIGITS}, got {options.digits}")
    times = [(text.strip(), read_time(text)) for text in options.at.split(",")]
    (scene,) = read_scenes([options.scene])
    from taylor_verify.exact.ellipsoid import formed_to
    from taylor_verify.exact.printed import document
    from taylor_verify.exact.route import solution
    from taylor_verify.exact.solution import NoClosedForm

    try:
        with working(f"exact {scene.name}"):
            scene = formed_to(scene, options.digits)
            printed = document(scene, solution(scene, options.route), times, options.digits)
    except NoClosedForm as reason:
        because = (
            f"no closed form: {reason}; leave out --route, or use --route taylor @ {scene.name}"
        )
        return _without_rows(scene, options.digits, options.route, because)
    doubts = [printed["because"]] if "because" in printed else []
    text = partial(exact_text, printed) if printed["rows"] else _no_text
    return Answer(UNDECIDED if doubts else PASS, printed, text, doubts)


def _without_rows(scene: Scene, digits: int, route: str, because: str) -> Answer:
    """The answer that there is none, in the shape of one."""
    from taylor_verify.exact.solution import NO_CLOSED_FORM

    found = {
        "scene": scene.name,
        "route": route,
        "digits": digits,
        "regime": NO_CLOSED_FORM,
        "rows": [],
        "because": because,
    }
    return Answer(UNDECIDED, found, _no_text, [because])


def check(options: argparse.Namespace) -> Answer:
    """The judgement of somebody's trajectory."""
    from taylor_verify.cli.ci import outputs, tell
    from taylor_verify.cli.progress import working
    from taylor_verify.cli.terminal import check_text
    from taylor_verify.judge.answer import judge_file
    from taylor_verify.judge.verdict import exit_status
    from taylor_verify.scenes.precision import rung

    (name,) = known_rungs([options.rung])
    scene, file = _scene_and_file(options.scene, options.file)
    asked = outputs(options)
    with working(f"check {options.file}"):
        judged = judge_file(file, scene, rung(name), options.accept_conventions, options.partial)
    text = partial(check_text, judged, scene.name, name)
    again = [v for v in asked.baseline or () if _run_of(v) == _run_of(judged.verdicts[0])]
    to_ci = tell(asked, judged.verdicts, exit_status(judged.verdicts), again)
    document = {**judged.document(), **to_ci.document}
    return Answer(to_ci.status, document, text, to_ci.messages)


def _run_of(verdict: Verdict) -> tuple[str, ...]:
    return verdict.scene, verdict.solver, verdict.setting, verdict.rung


def _scene_and_file(scene: str, file: str) -> tuple[Scene, TrajectoryFile]:
    """Both read; the faults of both are reported at once."""
    from taylor_verify.scenes.faults import Refused
    from taylor_verify.solvers.file import read

    faults: list[str] = []
    try:
        scenes = read_scenes([scene])
    except WrongCall as error:
        faults.append(str(error))
    try:
        found = read(file)
    except Refused as error:
        faults.append(str(error))
    if faults:
        raise WrongCall("\n".join(faults))
    return scenes[0], found


def explain(options: argparse.Namespace) -> Answer:
    """The arithmetic of one run."""
    from taylor_verify.cli.progress import working
    from taylor_verify.cli.terminal import explanation_text
    from taylor_verify.explanation import explanation

    (rung,) = known_rungs([options.rung])
    (scene,) = read_scenes([options.scene], warn=False)
    with working(f"explain {options.scene}"):
        found = explanation(scene, rung)
    return Answer(PASS, found, partial(explanation_text, found))


# What the verbs share.


def _judge(
    scenes: Sequence[str],
    solver: str,
    rungs: Sequence[str],
    left_out: Iterable[tuple[str, str]] = (),
    resume: bool = False,
    out: Path | None = None,
) -> list[Judgement]:
    from taylor_verify.cli.progress import advancing
    from taylor_verify.job import jobs
    from taylor_verify.standard import run_all

    without = set(left_out)
    asked = [
        job
        for scene in scenes
        for job in jobs([scene], solver, [r for r in rungs if (scene, r) not in without])
        if job.rungs
    ]
    with advancing(len(asked)) as finished:
        return run_all(asked, finished, resume=resume, out=out)


def _no_text() -> str:
    """The messages have said it."""
    return ""


def known_rungs(rungs: Iterable[str]) -> list[str]:
    from taylor_verify.scenes.precision import rung

    try:
        return [rung(name).name for name in dict.fromkeys(rungs)]
    except ValueError as error:
        raise WrongCall(f"{error} @ --rung") from error


def _known_solver(name: str) -> None:
    from taylor_verify.solvers.registry import check_name

    try:
        check_name(name)
    except ValueError as error:
        raise WrongCall(f"{error} @ --solver") from error


def read_scenes(names: Sequence[str], warn: bool = True) -> list[Scene]:
    """Every scene, read before any work begins; the faults of all of them are reported at once."""
    from taylor_verify.scenes.faults import Refused
    from taylor_verify.scenes.reader import load

    scenes, faults = [], []
    for name in names:
        try:
            scenes.append(load(name))
        except Refused as error:
            heading = f"{name} is refused:\n" if len(names) > 1 else ""
            faults.append(f"{heading}{error}")
    if faults:
        raise WrongCall("\n".join(faults))
    for scene in scenes if warn else ():
        for warning in scene.warnings:
            say(f"warning: {warning} @ {scene.name}")
    return scenes


def read_time(text: str) -> Fraction:
    from taylor_verify.scenes.table import exact_number

    try:
        return exact_number(text)
    except ValueError as error:
        raise WrongCall(f"expected {error}, got {text!r} @ --at") from error


def _write_reports(folder: Path, results: Sequence[Judgement]) -> str:
    """Verdicts, records and tables; returns where they are."""
    from taylor_verify.publish import report

    verdicts = [verdict for result in results for verdict in result.verdicts]
    records = [result.record for result in results if result.record is not None]
    report.write(folder, verdicts, records)
    report.publish(folder)
    return f"wrote {folder / report.TABLES} and {folder / 'data'}"
