"""Hypotheses about a whole file: its unit and origin of time, and how its author read the body."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Final

from verify.scenes import tensors
from verify.scenes.bodies import RigidBody
from verify.scenes.scene import Scene

# Two shifts this near are one.
_SAME_SHIFT: Final = 1e-3
_SCALES: Final = (
    (Fraction(1, 1000), "thousandths of the scene's unit (milliseconds for seconds)"),
    (Fraction(1, 10**6), "millionths of the scene's unit (microseconds for seconds)"),
    (Fraction(1, 10**9), "1e-9 of the scene's unit (nanoseconds for seconds)"),
    (Fraction(60), "sixties of the scene's unit (minutes for seconds)"),
    (Fraction(3600), "3600 of the scene's unit (hours for seconds)"),
)


@dataclass(frozen=True)
class World:
    """A hypothesis about the whole file: time of the scene = scale x t - shift, and a body."""

    scene: Scene
    scale: Fraction = Fraction(1)
    shift: Fraction = Fraction(0)
    time_words: tuple[str, ...] = ()
    body_words: str = ""

    @property
    def cost(self) -> int:
        return len(self.time_words) + bool(self.body_words)

    @property
    def words(self) -> str:
        return "; ".join((*self.time_words, *([self.body_words] if self.body_words else ())))

    def is_nearly(self, other: World) -> bool:
        """Whether both say the same but for digits of the shift that no answer tells."""
        near = abs(self.shift - other.shift) <= _SAME_SHIFT * abs(other.shift)
        return near and (self.scale, self.scene.body) == (other.scale, other.scene.body)

    def times(self, instants: Iterable[Fraction]) -> tuple[Fraction, ...]:
        return tuple(self.scale * t - self.shift for t in instants)


def worlds(scene: Scene, first: Fraction) -> list[World]:
    """Every hypothesis but the scene's own: bodies, units of time, and another first instant."""
    found = [
        World(other, scale, shift, time_words, body_words)
        for other, body_words in [(scene, ""), *_other_bodies(scene)]
        for scale, shift, time_words in _clocks(scene, first)
    ]
    return found[1:]


def _clocks(scene: Scene, first: Fraction) -> list[tuple[Fraction, Fraction, tuple[str, ...]]]:
    """Units of time, each with the file's origin and with its first row at the scene's own."""
    clocks: list[tuple[Fraction, Fraction, tuple[str, ...]]] = []
    for scale, unit in ((Fraction(1), ""), *_SCALES):
        words = (f"t counts {unit}",) if unit else ()
        clocks.append((scale, Fraction(0), words))
        for origin in dict.fromkeys((scene.clock.start, scene.clock.instants[0])):
            if shift := scale * first - origin:
                clocks.append((scale, shift, (*words, late(shift))))
    return clocks


def _other_bodies(scene: Scene) -> list[tuple[Scene, str]]:
    """The same numbers by the other convention: products of inertia, and the order of the coupling."""
    body = scene.body
    if isinstance(body, RigidBody):
        turned = tuple(
            tuple(entry if i == k else -entry for k, entry in enumerate(row))
            for i, row in enumerate(body.inertia)
        )
        if turned == body.inertia or not tensors.is_positive_definite(turned):
            return []
        words = (
            "the body has its products of inertia with the other sign (a scene writes components of "
            "the tensor, I_12 = -int xy dm)"
        )
        return [(replace(scene, body=replace(body, inertia=turned)), words)]
    transposed = tensors.transpose(body.coupling)
    other = replace(body, coupling=transposed)
    if transposed == body.coupling or not tensors.is_positive_definite(other.energy_matrix):
        return []
    words = "the body has its coupling B transposed (a scene's T has x.B y: its rows go with x)"
    return [(replace(scene, body=other), words)]


def late(shift: Fraction) -> str:
    return f"t is {'late' if shift > 0 else 'early'} by {float(abs(shift)):.15g}"
