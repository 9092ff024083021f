"""Three hundred drawn answers with one fault each, and what a judge should say of them."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache, partial
from itertools import cycle, islice
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Final

import numpy as np

import taylor_verify
from taylor_verify.records.faults import Refused
from taylor_verify.scenes.reading.reader import read
from taylor_verify_reports.studies.causes.kind import FLUID, RIGID, Kind
from taylor_verify_reports.studies.causes.kinds import SIMPLE
from taylor_verify_reports.studies.causes.simulated import integrated, law
from taylor_verify_reports.studies.vectors.bodies_in_water import (
    NOT_KNOWN_IN_WATER,
    WATER_KINDS,
)
from taylor_verify_reports.studies.vectors.bodies_under_loads import (
    FILE_FAULTS,
    LOADED_KINDS,
    NOT_KNOWN,
    OWN_STATES,
    WRITTEN,
    Columns,
    FileFault,
    columns_of,
)
from taylor_verify_reports.studies.vectors.expected_words import family, forbidden
from taylor_verify_reports.studies.vectors.questions import Question, questions

COUNT: Final = 300
TOLERANCE: Final = 1e-6
_SIZES: Final = (3e-3, 0.06, 0.5)
_LARGEST: Final = 1e3
_TRIES: Final = 8
_TRUNCATION: Final = "truncation of order"
_LOADED: Final = (*WRITTEN, *OWN_STATES, "driven")

Draw = np.random.Generator


@dataclass(frozen=True)
class Wrong:
    """A wrong answer: its question, fault and columns, and what should be said of it.

    A true sentence about it has a word of ``causes`` and none of ``never``. ``silence`` is True where a
    judge need not know the fault.
    """

    question: str
    fault: str
    family: str
    answer: Columns
    verdict: str
    causes: tuple[str, ...] = ()
    silence: bool = False
    never: tuple[str, ...] = ()


@dataclass(frozen=True)
class Said:
    """Words of `check` about an answer: the worst verdict, the sentences of causes and conventions."""

    verdict: str
    sentences: tuple[str, ...] = ()

    def meets(self, wrong: Wrong) -> bool:
        """Return True if that is the verdict, an expected cause is named and no false one.

        Of a sound method, or a law that nobody knows, any cause is false but the order of its steps.
        """
        is_named = wrong.silence or self.has(wrong.causes)
        if wrong.family == "sound" and not wrong.causes:
            is_named = all(_TRUNCATION in sentence for sentence in self.sentences)
        return self.verdict == wrong.verdict and is_named and not self.has(wrong.never)

    def has(self, words: Sequence[str]) -> bool:
        """Return True if one of the words stands in a sentence."""
        return any(word in sentence for word in words for sentence in self.sentences)


Maker = Callable[[Draw, Sequence[Question]], Wrong | None]


def wrong_answer(seed: int, number: int) -> tuple[Wrong | None, list[str]]:
    """Return the wrong answer of a number, and the false sentences that `check` said on the way.

    An answer fails, and `check` names its fault. What is too near to the right answer, or not named, is
    drawn again, after some tries with the next fault; None if nothing else comes.
    """
    asked, false = {question.name: question for question in questions(seed)}, list[str]()
    for attempt in range(3 * _TRIES):
        draw = np.random.default_rng([seed, number, attempt])
        maker = _makers()[(number + attempt // _TRIES) % COUNT]
        made = maker(draw, [*asked.values()])
        if made is None:
            continue
        words = judged(asked[made.question].text, made.answer)
        if words.has(made.never):
            false.append(f"{made.fault} ({made.question}): {' | '.join(words.sentences)}")
        elif words.meets(made):
            return made, false
    return None, false


def judged(scene: str, answer: Columns) -> Said:
    """Return what `check` says of an answer in a file."""
    with TemporaryDirectory() as folder:
        file = Path(folder) / "answer.json"
        file.write_text(json.dumps(answer), encoding="utf-8")
        try:
            judgement = taylor_verify.check(read(scene, "vector"), str(file), tolerance=TOLERANCE)
        except Refused:
            return Said("refused")
    findings = [*judgement.causes, *getattr(judgement, "conventions", ())]
    sentences = tuple(finding.sentence.partition("; leaves")[0] for finding in findings)
    verdicts = {str(verdict.verdict) for verdict in judgement.verdicts}
    worst = next((name for name in ("fail", "undecided") if name in verdicts), "pass")
    return Said(worst, sentences)


@cache
def _makers() -> list[Maker]:
    rigid = [partial(_of_kind, kind, RIGID) for kind in SIMPLE if set(kind.sorts) & set(RIGID)]
    general = ("times", "frames", "starts")
    moved = [k for k in SIMPLE if family(k.name) in general and k.name not in _BY_NUMBERS]
    in_water = [
        *(partial(_of_kind, kind, kind.sorts) for kind in WATER_KINDS),
        *(partial(_of_kind, kind, ("fluid",)) for kind in SIMPLE if kind.sorts == FLUID),
        *(partial(_of_kind, kind, _WITHOUT_STATES) for kind in SIMPLE if _is_of_water(kind)),
    ]
    under = [partial(_of_kind, k, _LOADED) for k in moved if family(k.name) != "starts"]
    written = [partial(_of_kind, kind, kind.sorts) for kind in LOADED_KINDS]
    files = [partial(_of_file, fault) for fault in FILE_FAULTS]
    shares = (rigid, 95), (in_water, 95), (under, 16), (written, 36), (files, 58)
    return [maker for makers, count in shares for maker in islice(cycle(makers), count)]


# These change the numbers of a body, which have another place in a written load.
_BY_NUMBERS: Final = ("load from some time on", "tensor in space axes")
# Of the bodies in water those that have no states of their own, which a new start would need too.
_WITHOUT_STATES: Final = ("vehicle", "current", "clebsch")


def _is_of_water(kind: Kind) -> bool:
    """Return True for a fault of any body that may be in water too."""
    return "fluid" in kind.sorts and kind.sorts != FLUID and kind.name not in _BY_NUMBERS


def _of_kind(
    kind: Kind, kinds: Sequence[str], draw: Draw, asked: Sequence[Question]
) -> Wrong | None:
    """Return an answer with a fault in what moves the body; None if it is of no moderate size."""
    fitting = set(kind.sorts) & set(kinds) or set(kinds)
    # A constant moment is the dearest of the three to search.
    if len(fitting) > 1:
        fitting -= {"moment"}
    question = _drawn([each for each in asked if each.kind in fitting], draw)
    with np.errstate(all="ignore"):
        rows = kind.make(question.body, draw, float(draw.choice(_SIZES)))
    if not np.all(np.isfinite(rows.v)) or np.max(np.abs(rows.v)) > _LARGEST:
        return None
    never = tuple(forbidden(kind.name, kind.words))
    answer = columns_of(rows, question.body.digits)
    silence = not kind.words or kind.name in (*NOT_KNOWN, *NOT_KNOWN_IN_WATER)
    return Wrong(
        question.name, kind.name, family(kind.name), answer, "fail", kind.words, silence, never
    )


def _of_file(fault: FileFault, draw: Draw, asked: Sequence[Question]) -> Wrong | None:
    """Return a right answer whose file has a fault."""
    question = _drawn([each for each in asked if each.kind in (*RIGID, *_LOADED[:-1])], draw)
    right = columns_of(integrated(question.body, law(question.body)), 12)
    never = tuple(forbidden(fault.name, fault.words))
    return Wrong(
        question.name,
        fault.name,
        "files",
        fault.change(right),
        fault.verdict,
        fault.words,
        not fault.words,
        never,
    )


def _drawn(questions: Sequence[Question], draw: Draw) -> Question:
    return questions[int(draw.integers(len(questions)))]
