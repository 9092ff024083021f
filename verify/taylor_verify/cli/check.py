"""The verb `check`: the judgement of a file: a trajectory, several of one solver, or times of an event."""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Sequence
from functools import partial
from typing import Final

from rich.text import Text

from taylor_verify.check import check
from taylor_verify.cli.answer import Answer, CallParts, WrongCall, wrong_calls
from taylor_verify.cli.ci import Outputs, concluded, outputs
from taylor_verify.cli.console import Page, bold, print_table
from taylor_verify.cli.inputs import (
    known_rungs,
    parse_tolerance,
    read_number,
    read_scene,
    read_tolerances,
)
from taylor_verify.cli.progress import working
from taylor_verify.cli.sentences import (
    figure,
    print_arithmetic,
    print_end,
    print_line,
    print_sentence,
    status_text,
)
from taylor_verify.cli.standard_input import scene_and_files
from taylor_verify.judge.events import EventsJudgement
from taylor_verify.judge.files.judgement import FileJudgement, judge_file
from taylor_verify.judge.judgement import Judgement
from taylor_verify.judge.series.files import FilesJudgement, checked_steps, judge_files, repeated
from taylor_verify.numbers.precision import rung
from taylor_verify.records.quantities import GATE_FACTOR, states_among
from taylor_verify.records.showing import counts
from taylor_verify.records.verdict import Verdict, exit_status
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.files.file import TrajectoryFile
from taylor_verify.words.account import cause_line, event_lines, note_line
from taylor_verify.words.opening import opening

_NUMBERS: Final = (
    "quantity",
    "verdict",
    ">error",
    ">at t",
    ">allowed",
    ">/floor",
    ">since t",
    "unit",
)


def answer(options: argparse.Namespace) -> Answer:
    """Judge somebody's trajectory; of several files also find the order of convergence."""
    parts = CallParts()
    rungs, asked = parts.read(known_rungs, [options.rung]), parts.read(outputs, options)
    if options.event is not None:
        return _of_events(options, parts, asked)
    parts.faults += repeated(options.files)
    steps = parts.read(_steps, options)
    with working(f"check {', '.join(options.files)}"):
        scene, files = scene_and_files(options, parts)
    tolerances = parts.read(read_tolerances, options.tolerance, scene and [scene])
    parts.end()
    (options.rung,), options.tolerances = rungs, tolerances
    if len(files) == 1:
        one = _judged(options, scene, files[0])
        text = partial(_text_of_one, one, scene.name, options.rung, options.explain)
        return concluded(asked, one, exit_status(one.verdicts), one.document(), text)
    several = judge_files(files, steps, partial(_judged, options, scene), options.knob or "")
    status = exit_status(several.verdicts)
    text = partial(_text_of_several, several, scene.name, options.rung)
    return concluded(asked, several, status, several.document(), text)


def _judged(options: argparse.Namespace, scene: Scene, file: TrajectoryFile) -> FileJudgement:
    """Judge one file as the options say."""
    as_asked = (options.accept_conventions, options.partial, options.tolerances)
    with working(f"check {file.name}"):
        return judge_file(file, scene, rung(options.rung), *as_asked)


def _steps(options: argparse.Namespace) -> list[float] | None:
    if options.knob and len(options.files) == 1:
        raise WrongCall("expected several files with --knob, got one @ --knob")
    if options.steps is None:
        return None
    if len(options.files) == 1:
        raise WrongCall("expected several files with --steps, got one @ --steps")
    steps = []
    for text in options.steps.split(","):
        steps.append(read_number(text, "--steps"))
        if not steps[-1] > 0:
            raise WrongCall(f"expected a positive step, got {text!r} @ --steps")
    with wrong_calls(" (--steps)"):
        return checked_steps(steps, len(options.files))


def _of_events(options: argparse.Namespace, parts: CallParts, asked: Outputs) -> Answer:
    """Judge the times of an event in one file."""
    if len(options.files) > 1:
        parts.faults.append(f"expected one file with --event, got {len(options.files)}")
    scene = parts.read(read_scene, options.scene)
    parts.read(read_tolerances, options.tolerance, None)
    parts.end()
    (file,) = options.files
    with working(f"check {file}"), wrong_calls():
        tolerance = parse_tolerance(options.tolerance)
        judged = check(scene, file, options.rung, tolerance=tolerance, event=options.event)
    content = judged.document()
    lines = list(event_lines(content))
    row = Judgement(judged.verdicts, None)
    text = partial(_text_of_events, judged, lines, options.explain)
    return concluded(asked, row, exit_status(row.verdicts), content, text)


def _text_of_events(
    judged: EventsJudgement, lines: Sequence[str], explained: bool, status: int | None
) -> str:
    event, page, verdicts = judged.true.text, Page(), judged.verdicts
    page.line(bold(event), judged.heading.removeprefix(event))
    for line in lines:
        page.line(line)
    for verdict in verdicts:
        print_sentence(page, verdict)
    if explained and any(verdict.is_compared for verdict in verdicts):
        print_arithmetic(page, verdicts)
    print_end(page, verdicts, counts(verdicts), status, explained)
    return page.text()


# The text about a file.


def _text_of_one(
    judged: FileJudgement, scene: str, rung: str, explained: bool, status: int | None
) -> str:
    """Return the sentence for each quantity, the likely causes, the numbers, and the counts.

    The conventions of the file come first. With ``explained`` the arithmetic of the bounds is there too.
    """
    page = Page()
    times = judged.file.times
    extent = f"{len(times)} row{'s' * (len(times) > 1)}"
    span = f"from t = {float(times[0]):g} to t = {float(times[-1]):g}"
    page.line(bold(judged.file.name), f": {extent} {span}")
    page.line(f"judged as an answer to {scene} in {rung} arithmetic")
    page.indented("", opening(judged.verdicts, judged.causes))
    _print_conventions(page, judged)
    page.line()
    for verdict in judged.verdicts:
        print_sentence(page, verdict)
    causes = (cause_line(cause.sentence) for cause in judged.causes)
    for line in (*causes, *map(note_line, judged.notes)):
        print_line(page, line)
    page.line()
    if any(verdict.is_compared for verdict in judged.verdicts):
        _print_numbers(page, judged.verdicts)
        page.line()
        if explained:
            print_arithmetic(page, judged.verdicts)
            page.line()
    print_end(page, judged.verdicts, counts(judged.verdicts), status, explained)
    return page.text()


def _print_conventions(page: Page, judged: FileJudgement) -> None:
    if not judged.conventions:
        return
    is_certain = any(finding.is_certain for finding in judged.conventions)
    if not is_certain:
        how = " in a way that this motion cannot tell"
    else:
        how = ", and was corrected" if judged.accepted else ", and was judged as it stands"
    page.line()
    page.line(bold(f"the file departs from the scene's conventions{how}", "yellow"))
    for finding in judged.conventions:
        page.indented("", note_line(finding.sentence))
    if is_certain and not judged.accepted:
        page.line("  (--accept-conventions corrects this and judges the rest)")


def _print_numbers(page: Page, verdicts: Sequence[Verdict]) -> None:
    """Print the numbers of all quantities, and what stands in the columns."""
    print_table(page.console, _NUMBERS, [_cells(verdict) for verdict in verdicts], keys=1)
    page.line()
    by_tolerance = any(verdict.tolerance is not None for verdict in verdicts)
    asked = "the tolerance that was asked for, where there is one; else " if by_tolerance else ""
    allowed = f"{asked}{GATE_FACTOR} times the roundoff floor, which perfect rounding would leave"
    page.indented("", f"allowed: {allowed}; /floor: the largest error over that floor")


def _cells(v: Verdict) -> list[str | Text]:
    since = "" if v.since is None else figure(v.since)
    numbers = (v.max, v.at, v.bound, v.ratio)
    figures = [figure(number) if v.is_compared else "" for number in numbers]
    return [v.quantity, status_text(v.verdict.value), *figures, since, v.unit]


# The text about several files.


def _text_of_several(judged: FilesJudgement, scene: str, rung: str, status: int | None) -> str:
    """Return the order of each quantity, a line for each file, and what is peculiar to a file."""
    del status
    page = Page()
    page.line(
        bold(f"{len(judged.files)} files"), f": judged as answers to {scene} in {rung} arithmetic"
    )
    page.indented("  ", *(order.sentence for order in judged.order))
    first, *others = judged.files
    common = [note for note in first.notes if all(note in one.notes for one in others)]
    for note in (*judged.notes, *common):
        print_line(page, note_line(note))
    page.line()
    _print_files(page, judged)
    for one in judged.files:
        if lines := [line for line in _peculiar(one) if line not in common]:
            page.line()
            page.line(bold(one.file.name))
            page.indented("  ", *lines)
    page.line()
    page.line(f"{counts(judged.verdicts)}; `check` of one file alone says the reasons")
    return page.text()


def _print_files(page: Page, judged: FilesJudgement) -> None:
    """Print the largest error of each state quantity in each file, the largest step first."""
    compared = {v.quantity for v in judged.verdicts if v.is_compared}
    states = states_among(sorted(compared))
    headings = ["file", f">{judged.knob}", ">rows", *(f">{name}" for name in states), "verdicts"]
    pairs = zip(judged.files, judged.steps, strict=True)
    rows = []
    for one, step in sorted(pairs, key=lambda pair: -pair[1].value if pair[1] else 0.0):
        errors = {v.quantity: v.max for v in one.verdicts if v.is_compared}
        begin = [one.file.name, f"{step.value:g}" if step else "", str(len(one.file.times))]
        rows.append([*begin, *(figure(errors.get(name)) for name in states), counts(one.verdicts)])
    print_table(page.console, headings, rows, keys=1)


def _peculiar(one: FileJudgement) -> Iterator[str]:
    """Return the conventions, the causes and the notes of a file, and why something was not compared."""
    for finding in one.conventions:
        yield finding.sentence
    for cause in one.causes:
        yield cause_line(cause.sentence)
    yield from one.notes
    for verdict in one.verdicts:
        if not verdict.is_compared:
            yield f"{verdict.verdict}: {verdict.quantity}: {verdict.because}"
