"""Hypotheses about a whole file: unit and origin of time, axes, and the author's reading of the body.

A shift of the clock is a hypothesis only if the file's first row becomes the scene's start or its first
instant. Any other shift would move the row at the start away from the start. That row alone shows whether
the file begins at the scene's initial state.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Final

from taylor_verify.judge.conventions.axis_orders import Frames
from taylor_verify.numbers import tensors
from taylor_verify.numbers.tensors import Matrix
from taylor_verify.scenes.scene import Scene

_SCALES: Final = (
    (Fraction(1, 1000), "thousandths of the scene's unit (milliseconds for seconds)"),
    (Fraction(1, 10**6), "millionths of the scene's unit (microseconds for seconds)"),
    (Fraction(1, 10**9), "1e-9 of the scene's unit (nanoseconds for seconds)"),
    (Fraction(60), "sixties of the scene's unit (minutes for seconds)"),
    (Fraction(3600), "3600 of the scene's unit (hours for seconds)"),
    (Fraction(86400), "86400 of the scene's unit (days for seconds)"),
)


@dataclass(frozen=True)
class World:
    """A hypothesis about the whole file: time of the scene = scale x t - shift, a body, and axes."""

    scene: Scene
    scale: Fraction = Fraction(1)
    shift: Fraction = Fraction(0)
    time_words: tuple[str, ...] = ()
    body_words: str = ""
    frames: Frames = Frames()  # noqa: RUF009 (frozen)
    axes_words: str = ""

    @property
    def cost(self) -> int:
        return len(self.time_words) + bool(self.body_words) + self.frames.cost

    @property
    def subjects(self) -> dict[str, str]:
        """Departures in words, by their subject."""
        time = "; ".join(self.time_words)
        every = {"time": time, "body": self.body_words, "axes": self.axes_words}
        return {subject: words for subject, words in every.items() if words}

    @property
    def words(self) -> str:
        return "; ".join(self.subjects.values())

    @property
    def moves_time(self) -> bool:
        return self.scale != 1 or self.shift != 0

    def times(self, instants: Iterable[Fraction]) -> tuple[Fraction, ...]:
        """Return the times of the scene at these times of the file."""
        if not self.moves_time:
            return tuple(instants)
        return tuple(self.scale * t - self.shift for t in instants)


def worlds(scene: Scene, times: Sequence[Fraction]) -> list[World]:
    """Return every world except the scene's own, for a file with rows at these times.

    Under written loads a motion that begins at another time, or of another body, is another motion: there
    are units of time alone.
    """
    if scene.body.loads is not None:
        return [clock for clock in _clocks(scene, times) if clock.scale != 1 and not clock.shift]
    every = [
        replace(clock, scene=other, body_words=words)
        for other, words in [(scene, ""), *_other_bodies(scene)]
        for clock in _clocks(scene, times)
    ]
    return every[1:]


def _clocks(scene: Scene, times: Sequence[Fraction]) -> Iterator[World]:
    """Yield units of time, each with the file's origin and with its first row at the scene's start."""
    start, instants = scene.clock.start, scene.clock.instants
    first = min(times[0], times[-1]) if instants[-1] > start else max(times[0], times[-1])
    for scale, unit in ((Fraction(1), ""), *_SCALES):
        words = (f"t counts {unit}",) if unit else ()
        yield World(scene, scale, time_words=words)
        if start / scale in times:
            continue
        for origin in dict.fromkeys((start, instants[0])):
            if shift := scale * first - origin:
                late = f"t is {'late' if shift > 0 else 'early'} by {float(abs(shift)):.15g}"
                yield World(scene, scale, shift, (*words, late))


def _other_bodies(scene: Scene) -> list[tuple[Scene, str]]:
    """Return the scene with a part of its body read by another convention, for each such part."""
    body, scenes = scene.body, []
    parts = body.parts()
    for name, (misread, words) in _MISREAD.items():
        if name not in parts or misread(parts[name]) == parts[name]:
            continue
        other = body.with_parts({name: misread(parts[name])})
        if tensors.is_positive_definite(other.energy_matrix):
            scenes.append((replace(scene, body=other), words))
    return scenes


def _with_products_negated(tensor: Matrix) -> Matrix:
    return tuple(
        tuple(entry if i == k else -entry for k, entry in enumerate(row))
        for i, row in enumerate(tensor)
    )


# Parts with two conventions: the function from one to the other, and the words for the reader.
_MISREAD: Final = {
    "inertia": (
        _with_products_negated,
        "the body has its products of inertia with the other sign (a scene writes components of "
        "the tensor, I_12 = -int xy dm)",
    ),
    "coupling": (
        tensors.transpose,
        "the body has its coupling B transposed (a scene's T has x.B y: its rows go with x)",
    ),
}
