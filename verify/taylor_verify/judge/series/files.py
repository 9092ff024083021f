"""The judgement of several files of one solver: of each file, and of their order of convergence."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import pairwise
from os import PathLike, fspath
from os.path import samefile
from typing import Any, Final, TypeVar

from taylor_verify.judge.files.judgement import FileJudgement
from taylor_verify.judge.judgement import Judgement
from taylor_verify.judge.series.order import Sample, orders
from taylor_verify.records.answers import Order
from taylor_verify.records.faults import Refused, brief
from taylor_verify.records.json_text import complete
from taylor_verify.records.order_of_points import STEP
from taylor_verify.records.quantities import INITIAL, states_among
from taylor_verify.records.showing import counts, html_table
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import summary
from taylor_verify.scenes.reading.positive import positive
from taylor_verify.solvers.files.file import TrajectoryFile
from taylor_verify.solvers.files.stated_step import (
    STEP_COLUMNS,
    FileStep,
    Source,
    knob_of,
    step_in_name,
    step_of_rows,
)

Asked = TypeVar("Asked")

# Orders of two states that differ by more than this belong to different methods.
_LOWER: Final = 0.5
# An order below this is that of steps which do not end where the equations change.
_OVER_BREAKS: Final = 1.5
# Steps with a smaller ratio show no order, because noise dominates the ratio of the errors.
_ALIKE: Final = 1.01
_HOW: Final = (
    "say them with --steps 0.1,0.05,... (in Python steps=[...]), in the files' names (run_h0.05.csv) or "
    "in a comment of each file (# h = 0.05)"
)


@dataclass(frozen=True, repr=False)
class FilesJudgement(Judgement):
    """The verdicts on several files of one solver, and the order of convergence of each quantity.

    ``verdicts`` are the verdicts of all files; the ``setting`` of each names its file. ``files`` are the
    judgements of the single files, ``steps`` their steps (None if not known), ``order`` has a record for
    each quantity. ``notes`` are sentences on the source of the steps and on files that the order does not
    use.
    """

    files: tuple[FileJudgement, ...]
    steps: tuple[FileStep | None, ...]
    order: tuple[Order, ...]

    @property
    def knob(self) -> str:
        """The name of the number that differs from file to file, ``step`` by default."""
        named = {order.knob.removeprefix("1/") for order in self.order} - {STEP}
        return next(iter(named), "step")

    def document(self) -> dict[str, Any]:
        """Return the document that `check --json` prints for several files."""
        files = []
        for judged, step in zip(self.files, self.steps, strict=True):
            known = {} if step is None else {"step": step.value, "step_from": step.source.value}
            files.append({**judged.document(), **known})
        return {
            "files": files,
            "order": complete(self.order),
            "notes": list(self.notes),
            "summary": summary(self.verdicts),
        }

    def __repr__(self) -> str:
        first, word = self.verdicts[0], "passed" if self.passed else "not passed"
        run = f"{len(self.files)} files on {first.scene} {first.rung}"
        return f"<FilesJudgement of {run}: {word}; {counts(self.verdicts)}>"

    def _repr_html_(self) -> str:
        headings = ("quantity", "order", "best step", "in words")
        rows = []
        for o in self.order:
            order = "" if o.order is None else f"{o.order:.2f}"
            best = "" if o.best_step is None else f"{o.best_step:g}"
            rows.append((o.quantity, order, best, o.sentence))
        return html_table(repr(self)[1:-1], headings, rows)


def files_judgement(
    judged: Sequence[FileJudgement], steps: Sequence[float] | None = None, knob: str = ""
) -> FilesJudgement:
    """Return the judgement of several judged files, with their order of convergence.

    ``steps`` are the steps of the files, if the caller knows them. Otherwise a step is read from the file,
    its name or the spacing of its rows; with a ``knob`` the number of that name is, in place of a step.
    """
    known = _steps_of([judgement.file for judgement in judged], steps, knob)
    samples = [
        Sample(judgement, step.value, is_step=knob in ("", *STEP_COLUMNS))
        for judgement, step in zip(judged, known, strict=True)
        if step is not None
    ]
    if is_reciprocal := bool(knob) and _improves_upwards(samples):
        samples = [replace(sample, step=1 / sample.step) for sample in samples]
    # Errors grow with time, so a file may end at most one row before the longest file.
    longest = max((_span(sample.times) for sample in samples), default=Fraction(0))
    ends = [_span(sample.times) + _span(sample.times[-2:]) for sample in samples]
    whole = [sample for sample, end in zip(samples, ends, strict=True) if end >= longest]
    short = [sample for sample in samples if sample not in whole]
    # Steps that are nearly equal show no order.
    neighbours = pairwise(sorted(whole, key=lambda sample: sample.step))
    alike = [(small, large) for small, large in neighbours if large.step < _ALIKE * small.step]
    of = f"1/{knob}" if is_reciprocal else knob or STEP
    order = orders(whole, of) if len(whole) > 1 and not alike else ()
    notes = tuple(_notes(judged, known, short, alike, order, knob or STEP))
    verdicts = tuple(verdict for judgement in judged for verdict in judgement.verdicts)
    return FilesJudgement(verdicts, None, tuple(judged), known, order, notes=notes)


def _improves_upwards(samples: Sequence[Sample]) -> bool:
    """Return True if the error is smaller where the number is larger, as with substeps or iterations."""
    errors = []
    for sample in sorted(samples, key=lambda sample: sample.step):
        states = states_among([v.quantity for v in sample.judged.verdicts if v.is_compared])
        row = sample.row(states[0]) if states else None
        errors.append(row.max if row else None)
    known = [error for error in errors if error is not None]
    return len(known) > 1 and known[-1] < known[0]


def judge_files(
    files: Sequence[Any],
    steps: Iterable[Any] | None,
    judge: Callable[[Any], Judgement],
    knob: str = "",
) -> FilesJudgement:
    """Return the judgement of a list of files, each judged by ``judge(file)``.

    Raises ValueError for an empty list, for a repeated file, and for steps that `checked_steps` refuses.
    """
    if not files:
        raise ValueError("expected at least one trajectory file, got an empty list")
    if faults := repeated([file for file in files if isinstance(file, str | PathLike)]):
        raise ValueError("\n".join(faults))
    known = None if steps is None else checked_steps(steps, len(files))
    return files_judgement(judge_each(files, judge), known, knob)


def judge_each(files: Iterable[Asked], judge: Callable[[Asked], Judgement]) -> list[FileJudgement]:
    """Return ``judge(file)`` for each file. Raises Refused with the faults of all refused files."""
    judged: list[FileJudgement] = []
    faults: list[str] = []
    for file in files:
        try:
            judgement = judge(file)
        except Refused as error:
            faults += error.faults
            continue
        if not isinstance(judgement, FileJudgement):
            raise ValueError(f"expected trajectory files alone in a list, got {brief(file)}")
        judged.append(judgement)
    if faults:
        raise Refused(faults)
    return judged


def checked_steps(steps: Iterable[Any], count: int) -> list[float]:
    """Return a step for each of ``count`` files, as doubles.

    Raises ValueError for another number of steps, for a step that is not a positive number, and for a
    repeated step.
    """
    asked = None if isinstance(steps, str) or not isinstance(steps, Iterable) else [*steps]
    if asked is None or len(asked) != count:
        received = brief(steps) if asked is None else len(asked)
        raise ValueError(f"expected a step for each of {count} files, got {received} @ steps")
    values = [positive(step, f"steps[{i}]") for i, step in enumerate(asked)]
    if len(set(values)) < count:
        twice = next(value for value in values if values.count(value) > 1)
        raise ValueError(
            f"expected steps no two of which are the same, got {twice:g} again @ steps"
        )
    return values


def _steps_of(
    files: Sequence[TrajectoryFile], given: Sequence[float] | None = None, knob: str = ""
) -> tuple[FileStep | None, ...]:
    """Return the step of each file: as given, or from the file, its name or its rows; or another knob.

    The spacing of the rows is used only if no file or name states a step, the rows are equally spaced, and
    the spacing differs from file to file.
    """
    if given is not None:
        return tuple(FileStep(step, Source.CALL) for step in given)
    if knob:
        return tuple(knob_of(file.name, knob) for file in files)
    stated = tuple(file.step or step_in_name(file.name) for file in files)
    if any(stated):
        return stated
    rows = tuple(step_of_rows(file.times) for file in files)
    values = sorted(row.value for row in rows if row is not None)
    differ = all(large >= _ALIKE * small for small, large in pairwise(values))
    return rows if differ and len(values) == len(files) > 1 else stated


def repeated(files: Iterable[str | PathLike[str]]) -> list[str]:
    """Return a fault for each file that is named twice, by the same path or by another."""
    once: list[str] = []
    faults = []
    for name in [fspath(file) for file in files]:
        if any(name == other or _is_same(name, other) for other in once):
            faults.append(f"expected every file once, got {name} again")
        once.append(name)
    return faults


def _is_same(first: str, second: str) -> bool:
    try:
        return samefile(first, second)
    except (OSError, ValueError):
        return False


def _span(times: Sequence[Fraction]) -> Fraction:
    return abs(times[-1] - times[0])


# The notes.


def _notes(
    judged: Sequence[FileJudgement],
    steps: Sequence[FileStep | None],
    short: Iterable[Sample],
    alike: Iterable[tuple[Sample, Sample]],
    order: Sequence[Order],
    knob: str,
) -> Iterator[str]:
    yield from _source_notes(judged, steps, knob)
    for sample in short:
        yield f"{sample.judged.file.name} ends before the others do, and has no part in the order"
    for small, large in alike:
        named = "step, h" if knob == STEP else knob
        names = f"{small.judged.file.name} and {large.judged.file.name}"
        yield (
            f"no order of convergence: {names} have the same {named} = {small.step:g}; "
            "--steps says others"
        )
    known = {record.quantity: record.order for record in order if record.order is not None}
    # The body's own state comes first.
    states = states_among(known)
    breaks = next((judgement.breaks for judgement in judged if judgement.breaks), "")
    if breaks and states and known[states[0]] < _OVER_BREAKS:
        yield (
            f"{states[0]} is of order {known[states[0]]:.1f}: no method has a higher one than 1 unless its "
            f"steps end at {breaks}"
        )
    for name in states[1:]:
        first = states[0]
        if known[name] < known[first] - _LOWER:
            yield (
                f"{name} has a lower order ({known[name]:.1f}) than {first} ({known[first]:.1f}): it is "
                "integrated by a method of its own"
            )
    wrong = [
        judgement.file.name
        for judgement in judged
        if any(v.quantity == INITIAL and v.verdict is Status.FAIL for v in judgement.verdicts)
    ]
    for name in wrong if len(wrong) < len(judged) else ():
        yield f"{name} does not start as the scene does: is it a file of another scene?"


def _source_notes(
    judged: Sequence[FileJudgement], steps: Sequence[FileStep | None], knob: str
) -> Iterator[str]:
    is_step = knob == STEP
    if len(judged) == 1:
        yield "no order of convergence: one file alone shows none"
        return
    known = [step for step in steps if step is not None]
    if len(known) < 2:
        how = _HOW if is_step else f"say it in the files' names (run_{knob}1e-6.csv)"
        named = "the steps" if is_step else knob
        yield f"no order of convergence: {named} of the files {'are' if is_step else 'is'} not known; {how}"
        return
    sources = dict.fromkeys(step.source for step in known)
    if Source.ROWS in sources:
        yield f"assumed: {Source.ROWS} is the step, because nothing states it; --steps says others"
    elif Source.CALL not in sources:
        named = "the steps are" if is_step else f"{knob} is"
        yield f"{named} from {' and '.join(sources)}; --steps says others"
    for judgement, step in zip(judged, steps, strict=True):
        if step is None:
            named = f"the {'step' if is_step else knob} of {judgement.file.name}"
            yield f"{named} is not known: it has no part in the order"
