"""The factor of a clock that is not nearly right, from a grid of factors."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np

from taylor_verify.judge.causes.arcs import Arcs
from taylor_verify.judge.causes.fit import Family, Fitted, gauss_newton
from taylor_verify.judge.causes.proof import CAPS

_CLOCKS: Final = (*np.geomspace(1e-3, 8, 60), 0.0)
_FRAMES: Final = (10.0, 12.0, 24.0, 25.0, 30.0, 50.0, 60.0, 100.0, 120.0, 240.0)
# Beyond this factor arcs are so long that they take more steps, up to a limit.
_LONG: Final = 3
_MOST_STEPS: Final = 128


def by_factor(arcs: Arcs, family: Family, best: Fitted) -> Fitted:
    """Return the fit of a clock from the best factor of the grid, if that is better."""
    if best.size < CAPS[1] * arcs.size:
        return best
    tried = [
        (float(np.linalg.norm(defects)), factor)
        for factors, steps in ((_CLOCKS, max(arcs.steps, 4)), (_FRAMES, 32))
        for defects, factor in zip(
            arcs.defects([{"clock": f} for f in factors], steps), factors, strict=True
        )
    ]
    size, factor = min((each for each in tried if np.isfinite(each[0])), default=(np.inf, 1.0))
    if not size < best.size:
        return best
    if factor > _LONG:
        arcs = replace(arcs, steps_given=min(_MOST_STEPS, int(arcs.steps * np.ceil(factor))))
    fit = gauss_newton(arcs, family, np.array([factor]))
    return fit if fit.size < best.size else best
