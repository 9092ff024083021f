"""The documents that `run --json` and `check --json` print."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import Annotated

from msgspec import Meta

from taylor_verify.records.json_text import Count, Size, about
from taylor_verify.records.observed_order import CLEAR
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict

Sentences = tuple[Annotated[str, Meta(min_length=1)], ...]


@dataclass(frozen=True)
class Convention:
    """A convention of a file that differs from the scene's."""

    about: Annotated[str, about("time, body, axes or a group of columns.")]
    found: str
    ambiguous: Annotated[bool, about("True if this motion cannot tell it from the alternatives.")]
    corrected: Annotated[
        bool, about("True if it was accepted: the verdicts are of the corrected file.")
    ]
    sentence: str
    alternatives: tuple[str, ...] = ()
    error_without: Annotated[Size | None, about("Relative, or in radians.")] = None
    error_with: Size | None = None


@dataclass(frozen=True)
class LikelyCause:
    """A hypothesis about wrong dynamics that explains nearly all of the error of a quantity.

    ``leaves`` is the part of the error that it does not explain. If two hypotheses explain equally well,
    both are given. In the answer of `run`, which may have many runs, ``scene`` and ``rung`` name the run.
    """

    name: Annotated[str, Meta(min_length=1, description="no gyroscopic term, damping, ...")]
    quantity: str
    leaves: Size
    sentence: str
    scene: str = ""
    rung: str = ""


@dataclass(frozen=True)
class MissingLoad:
    """A constant load, body axes, with which the scene's motion leads from a row to the next.

    ``load`` is a moment, or a force and a couple; it acts from the time ``t`` to ``until`` and says what a
    file's rows do, where no cause is proven.
    """

    t: float
    until: float
    load: tuple[float, ...]


@dataclass(frozen=True)
class FileRead:
    """A trajectory file as it was read; ``notes`` say what was not compared, and why."""

    name: str
    rows: Count
    columns: tuple[str, ...]
    notes: Sentences = ()


@dataclass(frozen=True)
class Against:
    """The comparison with a published folder: the rows that left their rounding class."""

    folder: str
    compared: Count
    departures: Sentences


@dataclass(frozen=True)
class AgainstBaseline:
    """The comparison with an earlier run.

    ``regressions`` are worse by more than rounding explains, ``undecided`` could not be compared, and
    ``changes`` are all other differences. ``notes`` say how rows were paired.
    """

    file: str
    compared: Count
    regressions: Sentences
    undecided: Sentences
    changes: Sentences
    notes: Sentences = ()
    gate: Annotated[
        str,
        about(
            "bound: the verdicts and the comparison decide the exit status. baseline: the comparison "
            "alone does."
        ),
    ] = "bound"


@dataclass(frozen=True)
class ExpectationsMet:
    """The rows of the extremes that are expected not to pass: the number that agree, and the others."""

    met: Count
    mismatches: Sentences


@dataclass(frozen=True)
class LeftOut:
    """A run that was left out, and the reason."""

    scene: str
    rung: str
    why: str


class Stall(StrEnum):
    """The reason why smaller steps do not make an error smaller."""

    ROUNDOFF = "roundoff"
    DIGITS = "printed digits"
    OTHER = "other"


@dataclass(frozen=True)
class OrderPoint:
    """The largest error of one quantity in one file, and the roundoff floor at its step.

    ``local`` is the order from the next larger step to this one.
    """

    file: str
    step: Size
    error: Size | None
    attainable: Size | None
    local: float | None = None


@dataclass(frozen=True)
class Order:
    """The order of convergence of one quantity over files of several steps, the largest step first.

    ``order`` is the slope of log(error) against log(step) from the step ``largest`` to ``smallest``, and
    ``low`` to ``high`` its 95 % interval; None if no order fits. Steps below ``stalls_at`` do not make the
    error smaller, for the reason ``stall``. The step of the file ``suspect`` does not fit the others; its
    error would fit at ``suspect_step``. ``knob`` names what differs from file to file: the step ``h``, or
    another number, or one over it where larger numbers have smaller errors.
    """

    quantity: str
    unit: str
    points: tuple[OrderPoint, ...]
    sentence: str
    order: float | None = None
    low: float | None = None
    high: float | None = None
    largest: Size | None = None
    smallest: Size | None = None
    best_step: Size | None = None
    best_error: Size | None = None
    stalls_at: Size | None = None
    stall: Stall | None = None
    suspect: str | None = None
    suspect_step: Size | None = None
    knob: str = "h"

    @property
    def clear(self) -> list[OrderPoint]:
        """The points whose error is the method's own: far above roundoff, and before errors stall."""
        level = 0.0 if self.stall is None else self.best_error or 0.0
        return [
            point
            for point in self.points
            if point.error
            and point.error > CLEAR * max(point.attainable or 0.0, level)
            and (self.stalls_at is None or point.step > self.stalls_at)
        ]


@dataclass(frozen=True)
class Answer:
    """The verdicts of `run` or `check`, and what they were compared with."""

    verdicts: tuple[Verdict, ...]
    summary: Annotated[dict[Status, Count], about("The number of verdicts of each status.")]
    expected: ExpectationsMet | None = None
    left_out: tuple[LeftOut, ...] = ()
    against: Against | None = None
    baseline: AgainstBaseline | None = None
    conventions: tuple[Convention, ...] = ()
    causes: tuple[LikelyCause, ...] = ()
    missing_load: tuple[MissingLoad, ...] = ()
    notes: Annotated[Sentences, about("Facts about the answers of a run that failed.")] = ()
    file: FileRead | None = None
    step: Annotated[Size | None, about("The step that the integrator of the file took.")] = None
    step_from: Annotated[str, about("The source that states the step.")] = ""
    sha256: Annotated[str, about("The sum of the content, which `--baseline` asks.")] = ""


@dataclass(frozen=True)
class FilesAnswer:
    """The answer of `check` for several files: a document for each file, and the order of convergence.

    Each of ``files`` is the document of that file alone. The worst of them decides the exit status.
    """

    files: tuple[Answer, ...]
    order: tuple[Order, ...]
    summary: dict[Status, Count]
    notes: Sentences = ()
    baseline: AgainstBaseline | None = None
    sha256: str = ""
