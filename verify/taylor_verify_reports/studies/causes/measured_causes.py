"""The confusion table: each kind of fault on random bodies, and what is said of it."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from dataclasses import asdict, dataclass, replace
from fractions import Fraction
from itertools import product
from operator import itemgetter
from typing import Final

import numpy as np

from taylor_verify.batch.work import run_all
from taylor_verify.judge.causes.float_answer import Motion
from taylor_verify.judge.causes.likely import explained
from taylor_verify.judge.causes.material import material, material_of_attitudes
from taylor_verify.judge.causes.quaternion_rows import steady_signs
from taylor_verify.judge.judgement import unjudged
from taylor_verify.models.problem import adopt
from taylor_verify.numbers.precision import rung
from taylor_verify.records.reason import Cause
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.files.file import Recorded
from taylor_verify_reports.studies.causes.bodies import Sample
from taylor_verify_reports.studies.causes.kind import Kind
from taylor_verify_reports.studies.causes.kinds import KINDS
from taylor_verify_reports.studies.causes.loaded import any_sample
from taylor_verify_reports.studies.causes.simulated import Rows, printed
from taylor_verify_reports.studies.finished_parts import Parts

SIZES: Final = (3e-3, 0.06, 0.5)
OUTCOMES: Final = ("right", "several", "half", "silent", "passes", "false")
_QUANTITIES: Final = ("omega", "impulse", "attitude", "centre")
# Kinds with two faults, of which a sentence may name one.
_TWO: Final = ("two faults", "a fault and Euler steps", "RK4 and another load")
_LARGEST: Final = 1e3
_TRIES: Final = 20


@dataclass(frozen=True)
class Named:
    """An answer: its kind and body, the outcome, and the sentences."""

    kind: str
    sort: str
    outcome: str
    sentences: tuple[str, ...]


# A seed, the name of a kind, and a number of an answer.
Asked = tuple[int, str, int]


def measured(
    seed: int,
    count: int,
    stored: Parts,
    kinds: Iterable[Kind] = KINDS,
    finished: Callable[[str], None] = lambda label: None,
) -> list[Named]:
    """Return what is said of so many answers of each kind, made by all cores, the first of each kind first.

    Those that are ``stored`` are not made again; ``finished`` is called with each label as it ends.
    """
    asked = [(seed, kind.name, number) for kind, number in product(kinds, range(count))]
    waiting = [each for each in asked if stored.find(_key(each)) is None]

    def ended(each: Asked, text: str) -> None:
        stored.keep(_key(each), text)
        finished(f"{each[1]} {each[2] + 1}")

    run_all(said_of, waiting, expense=itemgetter(2), ended=ended)
    texts = (stored.find(_key(each)) or "null" for each in asked)
    fields = [json.loads(text) for text in texts]
    return [Named(**{**f, "sentences": tuple(f["sentences"])}) for f in fields if f is not None]


def _key(asked: Asked) -> bytes:
    return json.dumps(asked).encode()


def said_of(asked: Asked) -> str:
    """Return what is said of an answer, as JSON; null where no answer of the kind is of moderate size."""
    seed, name, number = asked
    kind = next(kind for kind in KINDS if kind.name == name)
    answer = _answer(kind, seed, number)
    return json.dumps(None if answer is None else asdict(_named(kind, *answer)))


def _answer(kind: Kind, seed: int, number: int) -> tuple[Sample, Rows] | None:
    """Return an answer that stays of moderate size."""
    for attempt in range(_TRIES):
        draw = np.random.default_rng([seed, KINDS.index(kind), number, attempt])
        body = any_sample(str(draw.choice(kind.sorts)), draw)
        with np.errstate(all="ignore"):
            rows = kind.make(body, draw, SIZES[number % len(SIZES)])
        if np.all(np.isfinite(rows.v)) and np.max(np.abs(rows.v)) < _LARGEST:
            return body, rows
    return None


def _named(kind: Kind, body: Sample, rows: Rows) -> Named:
    has_momenta = body.sort == "momenta"
    mass = body.mass if rows.mass is None else rows.mass
    v, noise = printed(rows.v @ mass.T if has_momenta else rows.v, body.digits)
    q, of_q = printed(rows.q, body.digits)
    scene = body.scene
    given = adopt(scene, rung("f64"), tuple(Fraction(str(t)) for t in rows.times)).given
    motion, unit, of_c = Motion(v, steady_signs(q)), 2 * float(np.max(of_q)), np.zeros(3)
    if kind.has_centre and rows.c is not None:
        c, of_c = printed(rows.c, body.digits)
        motion = replace(motion, c=c)
    verdicts = [_failure(scene, name) for name in _QUANTITIES]
    with np.errstate(all="ignore"):
        if kind.has_rates:
            noises = noise, unit, float(np.max(of_c))
            answer = material(given, motion, has_momenta, noises, verdicts)
        else:
            answer = material_of_attitudes(given, rows.times, steady_signs(q), unit, verdicts[2:3])
        if answer is None or not answer.failed:
            return Named(kind.name, body.sort, "passes", ())
        sentences = tuple(cause.sentence for cause in explained(answer).causes)
    return Named(kind.name, body.sort, _outcome(kind, sentences), sentences)


def _failure(scene: Scene, quantity: str) -> Verdict:
    """Return a verdict that says no more than that a quantity failed."""
    solver = Recorded({}, setting="sample")
    judged = unjudged(scene, solver, rung("f64"), Status.FAIL, "made", Cause.NO_TRUTH)
    return replace(judged.verdicts[0], quantity=quantity)


def _outcome(kind: Kind, sentences: tuple[str, ...]) -> str:
    """Return how an answer was named; each sentence must have one of the right words.

    Of a kind without words, as a law that no family has, silence is right.
    """
    if not sentences:
        return "silent" if kind.words else "right"
    titles = [sentence.partition("; leaves")[0] for sentence in sentences]
    if all(sentence.startswith("truncation of order") for sentence in titles):
        return "right"
    rest = [s.partition("not told apart from: ")[2].partition("; as a scene")[0] for s in sentences]
    hits = [any(word in text for word in kind.words) for text in titles]
    others = [any(word in text for word in kind.words) for text in rest]
    if not all(hit or other for hit, other in zip(hits, others, strict=True)):
        return "false"
    is_whole = any(word in "".join(titles) for word in (" and ", " beside "))
    if kind.name in _TWO and not is_whole:
        return "half"
    return "right" if all(hits) and not any(rest) else "several"


def page(answers: Sequence[Named]) -> str:
    """Return the confusion table and each false sentence as Markdown."""
    false = [
        f"- {named.kind}, {named.sort}: {' | '.join(named.sentences)}"
        for named in answers
        if named.outcome == "false"
    ]
    return "\n".join([table(answers), "", *false, ""])


def table(answers: Iterable[Named]) -> str:
    """Return the confusion table as Markdown, a row for each kind."""
    counts: dict[str, Counter[str]] = {}
    for named in answers:
        counts.setdefault(named.kind, Counter())[named.outcome] += 1
    total = sum(counts.values(), Counter[str]())
    head = f"| answers | {' | '.join(OUTCOMES)} |\n|{'---|' * (len(OUTCOMES) + 1)}"
    rows = [
        f"| {name} | {' | '.join(str(own[outcome]) for outcome in OUTCOMES)} |"
        for name, own in [*counts.items(), ("all", total)]
    ]
    return "\n".join([head, *rows])
