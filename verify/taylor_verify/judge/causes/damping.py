"""Hypotheses of damping that was left on: isotropic, or against the angular velocity.

With z' = Q(z, z) - c z the size of the momentum decays as exp(-c t) for every body. The motion is
exp(-c t) Z((1 - exp(-c t))/c), where Z is the motion without damping. An engine that multiplies by 1 - c h
or by 1/(1 + c h) in each step has the same law with a slightly different c. If the scene has damping,
damping_step.py looks for the engine's step.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Final

import numpy as np

from taylor_verify.judge.causes.equations import Equations
from taylor_verify.judge.causes.fit import fitted
from taylor_verify.judge.causes.flow import Floats
from taylor_verify.judge.causes.material import Candidate, Material, Pairs

# A decay faster than this many rates of turn is not damping.
_FAST: Final = 1e3
# For a rigid body, and for a solid in a fluid.
_RIGID: Final = {
    "damping": "omega decays as exp(-c t) besides its motion (a moment -c I omega), with c = {:.6g}",
    "drag": "a moment -d omega acts besides, with d = {:.6g}",
}
_FLUID: Final = {
    "damping": "both impulses decay as exp(-c t) besides their motion (loads -c x and -c y), "
    "with c = {:.6g}",
    "drag": "a force -d U and a couple -d W act besides, with d = {:.6g}",
}


def damping(material: Material) -> Iterator[Candidate]:
    """Yield damping in proportion to the momentum and to the velocity, each with its best number."""
    right, pairs = material.equations, material.pairs
    rate = _decay(right, pairs)
    if not 0 < abs(rate) < _FAST / float(np.min(np.abs(pairs.spans))):
        return
    # A moment of inertia, or a mass, turns a rate into a coefficient of drag.
    sizes = np.linalg.eigvalsh(right.tensor)
    inertia = float(np.mean(sizes if right.is_rigid else 1 / sizes))
    tried = [("another damping" if right.damping else "damping left on", right)]
    if right.is_rigid and not right.damping:
        tried += [("no gyroscopic term and damping left on", replace(right, gyroscopic=0.0))]
    for name, equations in tried:
        for key, words in (_RIGID if right.is_rigid else _FLUID).items():
            unit = rate * inertia if key == "drag" else rate
            number, states = _fit(equations, key, unit, pairs)
            if number > 0:
                yield material.candidate(name, words.format(number), states, fitted=1)


def _decay(right: Equations, pairs: Pairs) -> float:
    """Return the rate at which the momentum decays, as the median over all pairs."""
    before, after = (
        np.linalg.norm(rows @ right.tensor if right.is_rigid else rows[:, :3], axis=1)
        for rows in (pairs.begin, pairs.end)
    )
    rates = -np.log(after / before) / pairs.spans
    return float(np.median(rates)) if np.all(np.isfinite(rates)) else 0.0


def _fit(equations: Equations, key: str, unit: float, pairs: Pairs) -> tuple[float, Floats]:
    """Return the best number for a key of the equations, in multiples of ``unit``, and its states."""

    def model(parameters: Floats) -> Floats:
        return pairs.moved([replace(equations, **{key: unit * p}) for (p,) in parameters])

    (best,), states = fitted(model, pairs.end, pairs.sizes, np.ones(1))
    return float(unit * best), states
