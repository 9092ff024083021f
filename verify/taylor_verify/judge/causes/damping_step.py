"""Wrong damping: left out, of the wrong sign, of the wrong vector, or applied as a factor in each step.

An engine multiplies by a factor f once per step h: 1 - c h (explicit), 1/(1 + c h) (implicit) or e^{-c h}.
It does so before or after the step of the undamped motion. With f = e^{-c' h} it solves exactly

    z' = k Q(z) - c' z,    k = c' h/(1 - f) where the factor comes after the motion, f times that before it,

where Q is quadratic: after n steps the undamped motion has advanced by the time h (1 + f + ... + f^{n-1}).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from typing import Final

import numpy as np

from taylor_verify.judge.causes.equations import Equations
from taylor_verify.judge.causes.fit import fitted
from taylor_verify.judge.causes.flow import Floats
from taylor_verify.judge.causes.material import Candidate, Material, Pairs

# The search for h begins where a step damps by this much, or at the interval between two rows.
_FIRST_STEP: Final = 0.05
# The factor of one step as a function of x = c h.
_FACTORS: Final[tuple[tuple[str, str, Callable[[float], float]], ...]] = (
    ("explicit damping step", "1 - c h", lambda x: 1 - x),
    ("implicit damping step", "1/(1 + c h)", lambda x: 1 / (1 + x)),
    ("exponential damping step", "exp(-c h)", lambda x: float(np.exp(-x))),
)


def wrong_damping(material: Material) -> Iterator[Candidate]:
    """Yield the equations without the damping, with its other sign, and with that of the velocity."""
    right = material.equations
    if not right.damping:
        return
    given = "omega" if right.is_rigid else "U and W"
    needed = "I omega" if right.is_rigid else "x and y"
    begin = f"from row to row the {material.quantity} changes as if"
    of_velocity = replace(right, damping=0.0, drag=right.damping)
    yield from material.tried(
        [
            ("damping left out", f"{begin} there were none", replace(right, damping=0.0)),
            (
                "damping with the other sign",
                f"{begin} it were of the other sign",
                replace(right, damping=-right.damping),
            ),
            ("damping of the velocity", f"it takes c times {given}, not {needed}", of_velocity),
        ]
    )


def damping_step(material: Material) -> Iterator[Candidate]:
    """Yield the factors of a step, after the motion and before it, each with its best step h."""
    right, pairs = material.equations, material.pairs
    if not right.damping or np.any(right.load) or any(right.rotor):
        return
    unit = min(float(np.max(np.abs(pairs.spans))), _FIRST_STEP / abs(right.damping))
    for name, words, factor in _FACTORS:
        for place, is_after in (("after", True), ("before", False)):
            h, states = _best_step(pairs, partial(stepped, right, factor, is_after), unit)
            if h > 0:
                why = f"each step multiplies the {material.quantity} by {words} {place} the motion"
                yield material.candidate(name, f"{why}, with h = {h:.3g}", states, fitted=1)


def _best_step(
    pairs: Pairs, equations: Callable[[float], Equations], unit: float
) -> tuple[float, Floats]:
    """Return the step whose equations fit the answer best, in multiples of ``unit``, and its states."""

    def model(parameters: Floats) -> Floats:
        return pairs.moved([equations(unit * p) for (p,) in parameters])

    (best,), states = fitted(model, pairs.end, pairs.sizes, np.ones(1))
    return float(unit * best), states


def stepped(
    right: Equations, factor: Callable[[float], float], is_after: bool, h: float
) -> Equations:
    """Return the equations that an engine with this step and factor solves."""
    f = factor(right.damping * h)
    if not f > 0 or f == 1:
        return replace(right, damping=np.nan)
    damping = -np.log(f) / h
    slowed = right.slowed(damping * h / (1 - f) * (1.0 if is_after else f))
    return replace(slowed, damping=damping)
