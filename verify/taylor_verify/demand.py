"""What somebody's test demands of a judgement, and the words for a demand that is not met."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import inf
from typing import Final

from taylor_verify.judge.gates import TRUTH_SHARE
from taylor_verify.judge.judgement import Judgement
from taylor_verify.records.quantities import INITIAL, STATES
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict
from taylor_verify.scenes.faults import brief
from taylor_verify.scenes.positive import positive

Tolerance = float | Mapping[str, float] | None
Only = str | Collection[str] | None

CONSERVED: Final = "conserved"

_MEND: Final = {
    Status.UNDECIDED: "no fault of the solver, and no pass; a tolerance of your own may decide it",
    Status.VACUOUS: "rounding alone reaches the size of the motion, so that no answer could fail: "
    "take a wider rung, a tolerance of your own, or only='conserved'",
    Status.REFUSED: "the rung cannot hold this scene: take another",
    Status.UNAVAILABLE: "the solver does not run on this rung here: take another",
}


@dataclass(frozen=True)
class Demand:
    """One verdict, and the tolerance that the test has put in place of its bound, if any.

    ``truth_radius`` is how wide the truth is, in the verdict's unit.
    """

    verdict: Verdict
    truth_radius: float = 0.0
    tolerance: float | None = None

    @property
    def is_conserved(self) -> bool:
        return self.verdict.is_conserved

    @property
    def is_met(self) -> bool:
        if self.tolerance is None:
            return self.verdict.verdict is Status.PASS
        error = self.verdict.max
        return error is not None and error <= self.tolerance and self._is_decided

    @property
    def _is_decided(self) -> bool:
        return self.tolerance is None or self.truth_radius * TRUTH_SHARE <= self.tolerance


def demands(judgement: Judgement, tolerance: Tolerance = None, only: Only = None) -> list[Demand]:
    """Every verdict that is asked for, with what is demanded of it; never none.

    ``tolerance`` takes the place of the bound, one number or a number by quantity; ``only`` are the
    quantities asked for, or ``conserved`` for all that are. A judgement of a run that came to no truth is
    demanded whole: nothing of it can be left out. Raises ValueError
    for a quantity that is not there and for a tolerance that is no positive number.
    """
    verdicts = {verdict.quantity: verdict for verdict in judgement.verdicts}
    if judgement.record is None:
        return [Demand(verdict) for verdict in judgement.verdicts]
    radii = {gate.quantity: gate.truth_radius for gate in judgement.record.gates}
    tolerances = dict(_tolerances(tolerance, verdicts))
    if state := _state_of_start(verdicts):
        # The start is the first sample of a state: what holds for this state holds for its start.
        radii[INITIAL] = radii[state]
        if state in tolerances:
            tolerances.setdefault(INITIAL, tolerances[state])
    found = [
        # A verdict whose truth is of unknown width is held to the judge's own bound alone.
        Demand(verdict, radii.get(quantity, inf), tolerances.get(quantity))
        for quantity, verdict in verdicts.items()
    ]
    if only is None:
        return found
    if only == CONSERVED:
        return [demand for demand in found if demand.is_conserved]
    if not isinstance(only, str) and not (
        isinstance(only, Collection) and all(map(_is_text, only))
    ):
        raise ValueError(f"expected names of quantities, got {brief(only)} @ only")
    wanted = [only] if isinstance(only, str) else list(only)
    _check_known(wanted, [*verdicts, CONSERVED], "only")
    return [demand for demand in found if demand.verdict.quantity in wanted]


def _state_of_start(verdicts: Mapping[str, Verdict]) -> str:
    """The state that the row of the start compares, known by its unit; empty without such a row."""
    if INITIAL not in verdicts:
        return ""
    unit = verdicts[INITIAL].unit
    return next((name for name in STATES if name in verdicts and verdicts[name].unit == unit), "")


def _tolerances(tolerance: Tolerance, quantities: Collection[str]) -> Mapping[str, float]:
    if tolerance is None:
        return {}
    if not isinstance(tolerance, Mapping):
        tolerance = dict.fromkeys(quantities, tolerance)
    _check_known(list(tolerance), list(quantities), "tolerance")
    return {name: positive(value, "tolerance") for name, value in tolerance.items()}


def _is_text(name: object) -> bool:
    return isinstance(name, str)


def _check_known(names: Sequence[str], known: Sequence[str], place: str) -> None:
    unknown = [name for name in names if name not in known]
    if unknown or not names:
        got = ", ".join(map(str, unknown)) or "nothing"
        raise ValueError(f"expected some of {', '.join(known)}, got {got} @ {place}")


# The words.


def report(judgement: Judgement, demanded: Sequence[Demand]) -> str:
    """What was demanded and what was found, quantity by quantity, those not met first."""
    some = judgement.verdicts[0]
    ordered = sorted(demanded, key=lambda demand: demand.is_met)
    unmet = [demand for demand in ordered if not demand.is_met]
    lines = [
        f"{some.solver} on {some.scene}, {some.rung}: "
        f"{len(unmet)} of {len(ordered)} judged quantities are no pass"
    ]
    against = ""
    if judgement.record is not None:
        route, regime = judgement.record.route, judgement.record.regime
        against = f"the exact motion of the same rounded data (route {route}; {regime})"
    for demand in ordered:
        lines += _passed(demand) if demand.is_met else _failed(demand, against)
    return "\n".join([*lines, *_hints(ordered)])


def _passed(demand: Demand) -> list[str]:
    verdict = demand.verdict
    bound = verdict.bound if demand.tolerance is None else demand.tolerance
    return [f"{verdict.quantity}: pass, {_short(verdict.max)} <= {_short(bound)}{_unit(verdict)}"]


def _failed(demand: Demand, against: str) -> list[str]:
    verdict = demand.verdict
    status = Status.FAIL if demand.tolerance is not None else verdict.verdict
    if verdict.max is None:
        lines = [f"{verdict.quantity}: {status}, {verdict.outcome}; {_said(verdict)}"]
    elif demand.tolerance is None:
        lines = [f"{verdict.quantity}: {status}; {_said(verdict)}"]
    else:
        lines = [
            f"{verdict.quantity}: {status}, the error reaches {_short(verdict.max)}{_unit(verdict)} "
            f"at t = {_short(verdict.at)} (mean {_short(verdict.mean)}, "
            f"at the end {_short(verdict.final)})"
        ]
    lines += [f"    {name:<8} {text}" for name, text in _reasons(demand, against) if text]
    return lines


def _said(verdict: Verdict) -> str:
    """Return the sentence of a verdict without its quantity."""
    return verdict.sentence.removeprefix(f"{verdict.quantity}: ")


def _reasons(demand: Demand, against: str) -> Iterator[tuple[str, str]]:
    """The rest of what a person needs to act: each a word and what it says."""
    verdict, tolerance = demand.verdict, demand.tolerance
    if against:
        yield "against", f"its value on {against}" if demand.is_conserved else against
    if tolerance is not None:
        yield "bound", f"{_short(tolerance)}{_unit(verdict)}"
        yield "because", _own_tolerance(demand)
        if not demand._is_decided:
            width = _short(demand.truth_radius)
            yield "but", f"the truth itself is only known to {width}: undecided"
        yield "time", _time_shift(verdict)
    else:
        if verdict.bound is not None:
            yield "bound", f"{_short(verdict.bound)}{_unit(verdict)}{_times_attainable(verdict)}"
        yield "mend", _MEND.get(verdict.verdict, "")


def _own_tolerance(demand: Demand) -> str:
    floor, rung = demand.verdict.attainable, demand.verdict.rung
    told = f"the tolerance of this test; perfect rounding would leave {_short(floor)}"
    if floor is not None and demand.tolerance is not None and not floor <= demand.tolerance:
        told += f", so that nothing on {rung} can be held to it"
    return told


def _times_attainable(verdict: Verdict) -> str:
    if verdict.ratio is None:
        return ""
    where = "" if verdict.ratio_at == verdict.at else f" at t = {_short(verdict.ratio_at)}"
    return f"; the error is {_short(verdict.ratio)} times what perfect rounding would leave{where}"


def _time_shift(verdict: Verdict) -> str:
    """The judge's own reason says it of a verdict that fails, which a tolerance has put aside."""
    if verdict.shift is None or verdict.time_shift is None:
        return ""
    if verdict.shift == "none":
        return "no shift of time explains the error"
    if verdict.trend is not None:
        pace = "slow" if verdict.trend > 0 else "fast"
        return (
            f"a drifting shift: the clock runs {pace} by {_short(abs(verdict.trend))} of the time; "
            f"{_short(verdict.remains)}{_unit(verdict)} remains"
        )
    way = "late" if verdict.time_shift > 0 else "early"
    return (
        f"a {verdict.shift} shift; the best constant one, {_short(abs(verdict.time_shift))} {way}, "
        f"leaves {_short(verdict.residual)}{_unit(verdict)}"
    )


def _hints(demanded: Sequence[Demand]) -> list[str]:
    """What the pattern of passes and fails points at."""
    states = [d for d in demanded if d.verdict.quantity in STATES]
    conserved = [d for d in demanded if d.is_conserved]
    all_conserved = bool(conserved) and all(d.is_met for d in conserved)
    if states and all_conserved and not any(d.is_met for d in states):
        names = ", ".join(d.verdict.quantity for d in conserved)
        return [
            f"{names} hold and the state does not: the wrong place on an orbit that conserves as it "
            "should. Look at the time, a sign or the axes before the step"
        ]
    unmet = [d.verdict.quantity for d in demanded if not d.is_met]
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
