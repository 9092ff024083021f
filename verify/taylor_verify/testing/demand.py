"""Verdicts that a test asks for, and the report on those that are no pass."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from typing import Final

from taylor_verify.judge.judgement import Judgement
from taylor_verify.records.quantities import STATES
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict
from taylor_verify.scenes.reading.faults import brief
from taylor_verify.solvers.trajectory import Outcome
from taylor_verify.words.opening import cause_lines, opening

Only = str | Collection[str] | None

CONSERVED: Final = "conserved"

_MEND: Final = {
    Status.UNDECIDED: "no fault of the solver, and no pass; a larger tolerance may decide it",
    Status.VACUOUS: "rounding alone reaches the size of the motion, so that no answer could fail: "
    "take a wider rung, a tolerance of your own, or only='conserved'",
    Status.REFUSED: "the rung cannot hold this scene: take another",
}
_MEND_UNAVAILABLE: Final = {
    Outcome.NO_PACKAGE.value: "install the package that is missing: the command stands above",
    Outcome.NO_FORMAT.value: "this machine lacks the number format of the rung: take another rung",
    Outcome.UNSUITED.value: "the solver is not made for it: take another solver, or another rung",
}


def demanded_rows(judgement: Judgement, only: Only = None) -> list[Verdict]:
    """Return the verdicts that a test asks for, at least one.

    ``only`` are the quantities asked for, or ``conserved`` for all conserved ones. If the judgement was not
    compared with the exact motion, all its verdicts are returned. Raises ValueError for a quantity that
    the scene does not have.
    """
    verdicts = list(judgement.verdicts)
    if judgement.record is None or only is None:
        return verdicts
    if only == CONSERVED:
        return [verdict for verdict in verdicts if verdict.is_conserved]
    if not isinstance(only, str) and not (
        isinstance(only, Collection) and all(isinstance(name, str) for name in only)
    ):
        raise ValueError(f"expected names of quantities, got {brief(only)} @ only")
    wanted = [only] if isinstance(only, str) else list(only)
    known = [*(verdict.quantity for verdict in verdicts), CONSERVED]
    unknown = [name for name in wanted if name not in known]
    if unknown or not wanted:
        got = ", ".join(unknown) or "nothing"
        raise ValueError(f"expected some of {', '.join(known)}, got {got} @ only")
    return [verdict for verdict in verdicts if verdict.quantity in wanted]


def is_met(verdict: Verdict) -> bool:
    """Return True for a pass; undecided, vacuous, refused and unavailable are none."""
    return verdict.verdict is Status.PASS


# The words.


def report(judgement: Judgement, demanded: Sequence[Verdict]) -> str:
    """Return the demanded verdicts as text, a quantity after the other, first those that are no pass."""
    some, record = judgement.verdicts[0], judgement.record
    unmet = [verdict for verdict in demanded if not is_met(verdict)]
    lines = [
        opening(demanded, judgement.causes),
        f"{some.solver} on {some.scene}, {some.rung}: "
        f"{len(unmet)} of {len(demanded)} judged quantities are no pass",
    ]
    against = ""
    if record is not None:
        against = (
            f"the exact motion of the same rounded data (route {record.route}; {record.regime})"
        )
    for verdict in unmet:
        outcome = f", {verdict.outcome}" if verdict.max is None else ""
        sentence = verdict.sentence.removeprefix(f"{verdict.quantity}: ")
        lines.append(f"{verdict.quantity}: {verdict.verdict}{outcome}; {sentence}")
        lines += [f"    {name:<8} {text}" for name, text in _reasons(verdict, against) if text]
    for verdict in filter(is_met, demanded):
        sizes = f"{_short(verdict.max)} <= {_short(verdict.bound)}{_unit(verdict)}"
        lines.append(f"{verdict.quantity}: pass, {sizes}")
    # A likely cause says more than the pattern of passes and fails.
    return "\n".join([*lines, *(cause_lines(judgement.causes) or _hints(demanded))])


def _reasons(verdict: Verdict, against: str) -> Iterator[tuple[str, str]]:
    """Yield the further lines of one verdict, each a word and its text."""
    if against:
        yield "against", f"its value on {against}" if verdict.is_conserved else against
    if verdict.bound is not None:
        yield "bound", f"{_short(verdict.bound)}{_unit(verdict)}{_times_attainable(verdict)}"
    yield "mend", _MEND.get(verdict.verdict, "")
    if verdict.verdict is Status.UNAVAILABLE:
        yield "mend", _MEND_UNAVAILABLE.get(verdict.outcome, "")


def _times_attainable(verdict: Verdict) -> str:
    if verdict.ratio is None:
        return ""
    where = "" if verdict.ratio_at == verdict.at else f" at t = {_short(verdict.ratio_at)}"
    return f"; the error is {_short(verdict.ratio)} times what perfect rounding would leave{where}"


def _hints(demanded: Sequence[Verdict]) -> list[str]:
    """Return the advice that the pattern of passes and fails gives."""
    states = [verdict for verdict in demanded if verdict.quantity in STATES]
    conserved = [verdict for verdict in demanded if verdict.is_conserved]
    all_conserved = bool(conserved) and all(map(is_met, conserved))
    if states and all_conserved and not any(map(is_met, states)):
        names = ", ".join(verdict.quantity for verdict in conserved)
        return [
            f"{names} hold and the state does not: the wrong place on an orbit that conserves as it "
            "should. Look at the time, a sign or the axes before the step"
        ]
    unmet = [verdict.quantity for verdict in demanded if not is_met(verdict)]
    if "attitude" in unmet and not {"omega", "impulse"} & set(unmet):
        return [
            "the body axes pass and the attitude does not: is it a quaternion, scalar first, from "
            "body to space, and of the method's full order?"
        ]
    return []


def _short(value: float | None) -> str:
    return "none" if value is None else f"{value:.3g}"


def _unit(verdict: Verdict) -> str:
    if not verdict.unit:
        return ""
    return " rad" if verdict.unit == "rad" else f" x {verdict.unit}"
