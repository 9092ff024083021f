"""A conserved quantity of a free motion."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from taylor_verify.scenes.motion import Motion

Array = np.ndarray[Any, Any]


@dataclass(frozen=True)
class Invariant:
    """A quantity Q that a free motion conserves, for one body.

    It ``is_conserved`` unless what acts on the body changes it; ``because`` is a formula that says why
    written loads do not.

    ``value`` gives Q at every row of a motion, an object array (n,), or (n, 3) in space axes.
    ``scale`` gives a size of Q that vanishes with the motion only, and 1 there (then drift is
    absolute). ``sensitivity`` gives dQ/d(block) at every row, block by block: (n, 3) by component where
    a component that is zero adds nothing to Q, whoever disturbs it, and else its spectral norm (n,);
    blocks ``momentum`` (H, body axes) or ``linear_impulse`` and ``angular_impulse`` (body axes),
    ``attitude`` (a rotation vector in space axes, radians) and ``centre`` (space axes); a block
    that Q does not contain is absent.
    """

    name: str
    value: Callable[[Motion], Array]
    scale: Callable[[Motion], Any]
    sensitivity: Callable[[Motion], Mapping[str, Array]]
    is_conserved: bool = True
    because: str = ""
