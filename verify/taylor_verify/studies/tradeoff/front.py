"""The front of one run, and what came of each tolerance, in sentences."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from taylor_verify.records.standing import Standing
from taylor_verify.studies.tradeoff.pareto import pareto
from taylor_verify.studies.tradeoff.point import Point, digits


def front(points: Iterable[Point]) -> list[Point]:
    """Return the sound points that none beats in both time and error, the fastest first."""
    return pareto(sound_points(points), lambda p: (p.seconds, p.error))


def sound_points(points: Iterable[Point]) -> list[Point]:
    """Return the points that are compared. A comparison with NaN is false, so none has that error."""
    return [p for p in points if p.standing is Standing.SOUND and p.error < 1]


def front_sentences(points: Sequence[Point]) -> list[str]:
    """Return the front in words, every ratio to the fastest of this very run."""
    best, sound = front(points), sound_points(points)
    if not best:
        return ["No setting gave an answer that is sound."]
    said = [_sentence(p, best[0].seconds) for p in best]
    beaten = len(sound) - len(best)
    said.append(
        f"{beaten} of {len(sound)} sound settings are beaten in both time and error by one of these."
    )
    if (widest := max(p.timed.spread or 1.0 for p in best)) > 1:
        said.append(
            f"A setting's slowest solve took up to {widest:.2g} times its fastest: times nearer to "
            "each other than that are not told apart."
        )
    return said


def _sentence(p: Point, fastest: float) -> str:
    left = digits(p.error)
    named = "All digits" if left is None else f"{left:.1f} digits"
    pace = f", {p.seconds / fastest:.2f} times the fastest" if p.seconds > fastest > 0 else ""
    return f"{named} (error {p.error:.2g}): {p.label} in {p.seconds:.3g} s{pace}."


def request_sentences(points: Iterable[Point]) -> list[str]:
    """Return, for each tolerance, the digits asked for and got. It bounds a step's error and no more."""
    said = []
    for p in sound_points(points):
        asked, got, requested = p.asked_digits, digits(p.error), p.timed.setting.requested
        if asked is None or got is None or requested is None:
            continue
        ratio = p.error / requested
        compared = f"{ratio:.2g} times" if ratio >= 1 else f"1/{1 / ratio:.2g} of"
        said.append(
            f"{p.label}: {asked:.1f} digits asked for, {got:.1f} got; the error is {compared} the "
            "tolerance."
        )
    return said
