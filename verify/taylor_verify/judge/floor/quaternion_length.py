"""The length of a quaternion, as far as loads that read the frame depend on it.

A solver rounds its quaternion in every step, so that the length wanders. R(q) of a quaternion of length
1 + d is (1 + 2d) times a rotation, to first order. The attitude does not show it, but a load M that is made
of R(q) is wrong by d dM/dd as long as the length stays, and so is the rate of the centre. Such errors have
one sign for a long time, and add up in proportion to it: weight and thrust that nearly cancel leave them.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction
from typing import Any, Final

import numpy as np

from taylor_verify.exact.conditioning.condition import Path
from taylor_verify.judge.floor.loads import Along

Floats = np.ndarray[Any, np.dtype[np.float64]]

# No state of a scene has such a name.
LENGTH: Final = "|q|"
# A turn of the frame about three axes, of one rounding in each of four components of q, is twice the norm
# of the four; one of four directions is that of q itself.
_SHARE: Final = 3.0**0.5 / 4


def with_length(path: Path) -> Path:
    """Return the path with the length of the quaternion as the last of the scene's own states.

    It is the path itself where no load reads the frame.
    """
    loads = path.scene.body.loads
    if loads is None or not loads.reads_attitude:
        return path
    push, taken = _by_length(path)
    times = np.array([float(t) for t in path.elapsed])
    steps = []
    for k, step in enumerate(path.carried.steps):
        half = (times[k + 1] - times[k]) / 2
        column = step @ push[k] * half + push[k + 1] * half + taken[k + 1]
        steps.append(np.block([[step, column[:, None]], [np.zeros(len(step)), 1.0]]))
    ones: Mapping[str, Any] = {LENGTH: np.ones((len(times), 1))}
    carried = path.carried._replace(
        steps=np.array(steps).reshape(len(steps), push.shape[1] + 1, push.shape[1] + 1),
        own={**path.carried.own, **ones},
        own_units={**path.carried.own_units, LENGTH: Fraction(1)},
    )
    return replace(path, carried=carried)


def with_rounded_length(rounded: Floats, path: Path) -> Floats:
    """Return the roundings of a step by component, with that of the length where the path has it."""
    if LENGTH not in path.blocks:
        return rounded
    return np.hstack([rounded, _SHARE * rounded[:, path.span("attitude")][:, :1]])


def _by_length(path: Path) -> tuple[Floats, Floats]:
    """Return the errors of the rates and of held values by the length, (times, states), in units."""
    along = Along(path)
    push, taken = along.pushes(along.by_length())
    d = len(path.flow.components)
    if "centre" in path.blocks:
        current = np.array(along.loads.current, dtype=float)
        push[:, d + 3 : d + 6] = 2 * (along.rates()[2] - current)
    return push / along.sizes_of_state, taken / along.sizes_of_state
