"""Damping that was left on: isotropic, or against the angular velocity; with and without gyroscopic term.

With z' = Q(z, z) - c z the size of the momentum decays as exp(-c t), whatever the body, and the motion is
exp(-c t) Z((1 - exp(-c t))/c), Z the motion without damping. An engine that multiplies by 1 - c h or by
1/(1 + c h) in each step has the same law with a slightly different c.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Final

import numpy as np

from taylor_verify.judge.causes.candidate import Candidate
from taylor_verify.judge.causes.equations import Equations
from taylor_verify.judge.causes.fit import fitted
from taylor_verify.judge.causes.flow import Floats
from taylor_verify.judge.causes.material import Material, Pairs

# Where the parameter is counted in units of a rate of turn, a decay by more than this is no damping.
_FAST: Final = 1e3


def damping(material: Material) -> Iterator[Candidate]:
    """Yield damping in proportion to the momentum and to the velocity, each with its best number."""
    right, pairs = material.equations, material.pairs
    rate = _decay(right, pairs)
    if not 0 < abs(rate) < _FAST * _pace(pairs):
        return
    for name, equations in _equations(right):
        for key, unit, words in (
            ("damping", rate, _ISOTROPIC[right.is_rigid]),
            ("drag", rate * _scale(right), _DRAG[right.is_rigid]),
        ):
            number, states = _fit(equations, key, unit, pairs)
            if number > 0:
                why = words.format(c=f"{number:.6g}")
                yield Candidate(name, material.quantity, pairs.left(states), why, fitted=1)


_ISOTROPIC: Final = {
    True: "omega decays as exp(-c t) besides its motion (a moment -c I omega), with c = {c}",
    False: "both impulses decay as exp(-c t) besides their motion (loads -c x and -c y), with c = {c}",
}
_DRAG: Final = {
    True: "a moment -d omega acts besides, with d = {c}",
    False: "a force -d U and a couple -d W act besides, with d = {c}",
}


def _equations(right: Equations) -> Iterator[tuple[str, Equations]]:
    yield "damping left on", right
    if right.is_rigid:
        yield "no gyroscopic term and damping left on", replace(right, gyroscopic=0.0)


def _decay(right: Equations, pairs: Pairs) -> float:
    """The rate at which the momentum decays, by the median of all pairs."""
    before, after = (
        np.linalg.norm(rows @ right.tensor if right.is_rigid else rows[:, :3], axis=1)
        for rows in (pairs.begin, pairs.end)
    )
    rates = -np.log(after / before) / pairs.spans
    return float(np.median(rates)) if np.all(np.isfinite(rates)) else 0.0


def _pace(pairs: Pairs) -> float:
    return 1 / float(np.min(np.abs(pairs.spans)))


def _scale(right: Equations) -> float:
    """A moment of inertia, or a mass, that makes a coefficient of drag of a rate."""
    values = np.linalg.eigvalsh(right.tensor)
    return float(np.mean(values) if right.is_rigid else np.mean(1 / values))


def _fit(equations: Equations, key: str, unit: float, pairs: Pairs) -> tuple[float, Floats]:
    """The best number for a key of the equations, counted in ``unit``, and its states."""

    def model(parameters: Floats) -> Floats:
        return pairs.moved([replace(equations, **{key: unit * p}) for (p,) in parameters])

    (best,), states = fitted(model, pairs.end, pairs.sizes, np.ones(1))
    return float(unit * best), states
