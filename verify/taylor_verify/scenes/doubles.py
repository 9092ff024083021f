"""Scenes whose sizes are beyond the doubles, by which steps, roundings and errors are estimated."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from fractions import Fraction
from typing import Final, Literal

import numpy as np

from taylor_verify.numbers.precision import float_text, floor_log2
from taylor_verify.scenes.named_numbers import numbers
from taylor_verify.scenes.scene import Scene

# A number within these powers of two makes no size that a double does not hold.
_MODERATE: Final = 64
_Answer = Literal["raise"] | None


@contextmanager
def within_doubles(
    scene: Scene, kind: Callable[[str], Exception], has_warnings: bool = True
) -> Iterator[None]:
    """Raise an error of a kind where a size is beyond the doubles: it names a number of the scene.

    With ``has_warnings`` what NumPy warns of is such a size too, in scenes that have far numbers, and an
    overflow by texts of loads. Of any other scene it is no fault, and the error stays as it is.
    """
    place, number = max(_numbers(scene), key=lambda pair: _powers(pair[1]))
    is_far, has_texts = _powers(number) > _MODERATE, scene.body.loads is not None
    over: _Answer = "raise" if has_warnings and (is_far or has_texts) else None
    others: _Answer = "raise" if has_warnings and is_far else None
    try:
        with np.errstate(over=over, divide=others, invalid=others):
            yield
    except (OverflowError, FloatingPointError) as error:
        if not (is_far or has_texts):
            raise
        got = f"{float_text(number)} @ {place}" if is_far else "others by its texts @ body"
        expected = "a scene whose sizes are doubles, which estimate steps and roundings"
        raise kind(f"expected {expected}, got {got}") from error


def _numbers(scene: Scene) -> Iterator[tuple[str, Fraction]]:
    """Yield the numbers of a scene that are not zero, each with its place."""
    body, clock = scene.body, scene.clock
    parts = [(f"initial.{name}", value) for name, value in scene.initial.parts().items()]
    # The coefficients of a solid in a fluid are made of what its scene writes.
    names = {part.name for part in body.PARTS if part.is_energy and scene.model != "euler"}
    for name, value in body.parts().items():
        parts.append(("body" if name in names else f"body.{name}", value))
    if body.loads is not None:
        parts.append(("body.current", body.loads.current))
        parts += [(f"states.{s.name}", (s.every, s.offset)) for s in body.loads.held_states]
    parts += [("time.start", clock.start), ("time", clock.elapsed[-1])]
    yield from ((place, n) for place, value in parts for n in numbers(value) if n)


def _powers(number: Fraction) -> int:
    """Return the powers of two between a number and one."""
    return abs(floor_log2(number))
