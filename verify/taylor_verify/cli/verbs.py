"""What each verb does: options in, an answer out."""

from __future__ import annotations

import argparse
from collections.abc import Iterable, Sequence
from functools import partial
from typing import TYPE_CHECKING

from taylor_verify.cli.answer import PASS, UNDECIDED, WRONG_CALL, Answer, WrongCall, graver
from taylor_verify.cli.folders import IN_A_CHECKOUT, writable
from taylor_verify.cli.streams import say

if TYPE_CHECKING:
    from fractions import Fraction

    from taylor_verify.batch.comparison import Earlier
    from taylor_verify.batch.judgements import Judgements
    from taylor_verify.cli.ci import Outputs
    from taylor_verify.scenes.scene import Scene


def list_all(options: argparse.Namespace) -> Answer:
    """Everything that has a name."""
    from taylor_verify.cli.scene_text import names_text
    from taylor_verify.records.precisions import LADDER
    from taylor_verify.scenes.guide import GUIDE
    from taylor_verify.scenes.library import EXTREMES, WORST, names
    from taylor_verify.scenes.reading.reader import load
    from taylor_verify.solvers.files.formats.reading import FORMATS
    from taylor_verify.solvers.registry import remarks, solver_names

    del options
    scenes = {"scenes": list(names()), "extremes": list(names(EXTREMES, WORST))}
    titles = {name: load(name).title for group in scenes.values() for name in group}
    read = {suffix: one.sentence for suffix, one in FORMATS.items()}
    found = {
        **scenes,
        "solvers": list(solver_names()),
        "rungs": list(LADDER),
        "formats": list(read),
    }
    text = partial(names_text, found, {**titles, **remarks(), **read}, GUIDE)
    return Answer(PASS, {**found, "guide": dict(GUIDE)}, text)


def run(options: argparse.Namespace) -> Answer:
    """Run the whole chain for some scenes, or for the standard set."""
    from taylor_verify.batch.lock import Occupied
    from taylor_verify.batch.report import ReportNotWritten
    from taylor_verify.batch.selection import select
    from taylor_verify.cli.ci import outputs
    from taylor_verify.cli.progress import advancing
    from taylor_verify.cli.tolerance import read_tolerances
    from taylor_verify.run_many import run_many

    rungs = known_rungs(options.rung) if options.rung else None
    _known_solver(options.solver)
    selection = select(options.scenes or None, rungs)
    for warning in selection.warnings:
        say(f"warning: {warning}")
    if options.jobs is not None and not options.jobs >= 1:
        raise WrongCall(f"expected a number of at least 1, got {options.jobs} @ --jobs")
    folder = writable(options.out) if options.out is not None else None
    published = _published(options.against) if options.against is not None else None
    asked = outputs(options)
    tolerances = read_tolerances(options.tolerance, selection.scenes)
    try:
        with advancing() as progress:
            results = run_many(
                selection,
                options.solver,
                jobs=options.jobs,
                resume=options.resume,
                out=folder,
                progress=progress,
                tolerance=tolerances,
            )
    except Occupied as error:
        raise WrongCall(f"{error} (--out)") from error
    except ReportNotWritten as error:
        # A run that took hours is shown in any case.
        told = f"{error} (--out)"
        return _run_answer(error.results, asked, published, told, WRONG_CALL, options.explain)
    written = f"wrote {folder / 'tables'} and {folder / 'data'}" if folder is not None else ""
    return _run_answer(results, asked, published, written, explained=options.explain)


def _run_answer(
    results: Judgements,
    asked: Outputs,
    published: Earlier | None,
    written: str,
    status: int = PASS,
    explained: bool = False,
) -> Answer:
    """Return the answer of a run, with what comparisons and files add to it."""
    from taylor_verify.cli.answers_text import verdicts_text
    from taylor_verify.cli.ci import tell
    from taylor_verify.judge.costs import sentence
    from taylor_verify.records.answers import Against
    from taylor_verify.records.json_text import complete

    status = graver(status, results.exit_status)
    messages = [f"nothing was judged: {results.unjudged}"] * (results.exit_status == WRONG_CALL)
    messages += [written] * bool(written)
    document = results.document()
    if published is not None:
        comparison = published.compare_as_published(results)
        departures = [str(departure) for departure in comparison.failures]
        rows = f"{comparison.compared} rows compared with {published.source}"
        messages += [*departures, f"{rows}: {len(departures)} departures from their rounding class"]
        against = Against(published.source, comparison.compared, tuple(departures))
        document["against"] = complete(against)
        status = graver(status, comparison.exit_status)
    to_ci = tell(asked, results, status)
    messages += to_ci.messages
    messages += [f"not run: {o.scene} on {o.rung}: {o.why}" for o in results.left_out]
    if len(results.selection.scenes) > 1 and results.costs:
        messages.append(sentence(results.costs))
    text = partial(
        verdicts_text,
        results.verdicts,
        results.agreement,
        to_ci.stated_status,
        results.causes,
        explained,
    )
    return Answer(to_ci.status, {**document, **to_ci.document}, to_ci.closing(text), messages)


def _published(folder: str) -> Earlier:
    """Return the verdicts of the folder of --against."""
    from taylor_verify.batch.report import read_report

    try:
        return read_report(folder)
    except FileNotFoundError as error:
        raise WrongCall(
            f"expected a folder of `run --out`, got no such file @ --against {error.filename}; "
            f"{IN_A_CHECKOUT}"
        ) from error
    except ValueError as error:
        raise WrongCall(f"{error} (--against)") from error


def exact(options: argparse.Namespace) -> Answer:
    """The exact motion of one scene."""
    from taylor_verify.cli.progress import working
    from taylor_verify.cli.scene_text import exact_text
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


def explain(options: argparse.Namespace) -> Answer:
    """The arithmetic of one run."""
    from taylor_verify.cli.progress import working
    from taylor_verify.cli.scene_text import explanation_text
    from taylor_verify.explain.explanation import explanation

    (rung,) = known_rungs([options.rung])
    (scene,) = read_scenes([options.scene], warn=False)
    with working(f"explain {options.scene}"):
        found = explanation(scene, rung)
    return Answer(PASS, found, partial(explanation_text, found))


# What the verbs share.


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
    from taylor_verify.solvers.registry import solver_named

    try:
        solver_named(name)
    except ValueError as error:
        raise WrongCall(f"{error} @ --solver") from error


def read_scenes(names: Sequence[str], warn: bool = True) -> list[Scene]:
    """Read every scene before any work begins; the faults of all of them are reported at once."""
    from taylor_verify.batch.selection import read_all
    from taylor_verify.scenes.reading.faults import Refused

    try:
        scenes = read_all(names)
    except Refused as error:
        raise WrongCall(str(error)) from error
    for scene in scenes if warn else ():
        for warning in scene.warnings:
            say(f"warning: {warning} @ {scene.name}")
    return [*scenes]


def read_time(text: str) -> Fraction:
    return read_number(text, "--at")


def read_number(text: str, option: str) -> Fraction:
    """Return the decimal or a/b of an option. Raises WrongCall for any other text."""
    from taylor_verify.scenes.reading.table import exact_number

    try:
        return exact_number(text.strip())
    except ValueError as error:
        raise WrongCall(f"expected {error}, got {text!r} @ {option}") from error
