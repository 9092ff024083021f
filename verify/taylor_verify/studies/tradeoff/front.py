"""The Pareto front: the settings that no other beats in both time and error, and what they say."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from taylor_verify.records.standing import Standing
from taylor_verify.studies.tradeoff.point import Point, digits


def front(points: Iterable[Point]) -> list[Point]:
    """The sound points that none dominates, the fastest first; the error falls from each to the next.

    Of points equal in time and error all stay. A point that failed, or whose error is no number, is
    on no front and dominates nothing.
    """
    sound = sorted(sound_points(points), key=lambda p: (p.seconds, p.error))
    return [p for p in sound if not any(dominates(other, p) for other in sound)]


def sound_points(points: Iterable[Point]) -> list[Point]:
    # A comparison with NaN is false, so it cannot be among them whatever it is called.
    return [p for p in points if p.standing is Standing.SOUND and p.error < 1]


def dominates(one: Point, other: Point) -> bool:
    """No slower and no less accurate, and better in one of them."""
    no_worse = one.seconds <= other.seconds and one.error <= other.error
    return no_worse and (one.seconds < other.seconds or one.error < other.error)


def front_sentences(points: Sequence[Point]) -> list[str]:
    """The front in words, every ratio to the fastest of this very run."""
    found, sound = front(points), sound_points(points)
    if not found:
        return ["No setting gave an answer that is sound."]
    fastest = found[0].seconds
    said = [_sentence(p, fastest) for p in found]
    beaten = len(sound) - len(found)
    said.append(
        f"{beaten} of {len(sound)} sound settings are beaten in both time and error by one of these."
    )
    if (widest := max((p.timed.spread or 1.0 for p in found), default=1.0)) > 1:
        said.append(
            f"A setting's slowest solve took up to {widest:.2g} times its fastest: times nearer to "
            "each other than that are not told apart."
        )
    return said


def _sentence(p: Point, fastest: float) -> str:
    pace = f", {p.seconds / fastest:.2f} times the fastest" if p.seconds > fastest > 0 else ""
    return f"{_digits(p.error)} (error {p.error:.2g}): {p.label} in {p.seconds:.3g} s{pace}."


def request_sentences(points: Iterable[Point]) -> list[str]:
    """What a tolerance was read as, and what came of it: it bounds a step's error and no more."""
    said = []
    for p in sound_points(points):
        setting = p.timed.setting
        asked, got = p.asked_digits, digits(p.error)
        if asked is None or got is None or setting.requested is None:
            continue
        ratio = p.error / setting.requested
        compared = f"{ratio:.2g} times" if ratio >= 1 else f"1/{1 / ratio:.2g} of"
        said.append(
            f"{p.label}: {asked:.1f} digits asked for, {got:.1f} got; the error is {compared} the "
            "tolerance."
        )
    return said


def _digits(error: float) -> str:
    found = digits(error)
    return "All digits" if found is None else f"{found:.1f} digits"
