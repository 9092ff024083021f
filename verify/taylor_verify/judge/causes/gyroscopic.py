"""Steps of first order for the gyroscopic term omega x (I omega + h): explicit and implicit.

Legend: h is the step, except in this term, where it is the momentum of the wheels: ``rotor``.

An explicit step is forward Euler on the term, an implicit one a step of Newton's method for backward
Euler. Each is a map of one step, and its result is computed from every row to the next one. Rows need
not be the steps: the step h that fits best is found by iteration, because the defect of a method of first
order is nearly proportional to h.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Final

import numpy as np

from taylor_verify.judge.causes.equations import Equations
from taylor_verify.judge.causes.flow import Floats
from taylor_verify.judge.causes.material import Candidate, Material, Pairs

# The search for h begins with this part of a radian, where a method of first order is in its regime.
_FIRST_STEP: Final = 0.05
_SEARCHES: Final = 6
# Two steps that are as near as this are one.
_SAME_STEP: Final = 1e-3
# No more steps than this are made from one row to the next.
_MOST_STEPS: Final = 5_000

# One step of length h (n, 1) from every row of omega (n, 3).
_Step = Callable[[Equations, Floats, Floats], Floats]


def gyroscopic_step(material: Material) -> Iterator[Candidate]:
    """Yield the methods of first order for the term, each with its best step."""
    right, pairs = material.equations, material.pairs
    if not right.is_rigid:
        return
    momentum = "(I omega + wheels)" if any(right.rotor) else "I omega"
    for name, words, step in _STEPS:
        left, h = _best_step(step, right, pairs)
        why = words.format(momentum=momentum)
        yield Candidate(name, "omega", left, f"{why}, with h = {h:.3g}", fitted=1)


def _torque(body: Equations, omega: Floats) -> Floats:
    """M - omega x (I omega + rotor) - c I omega for every row."""
    momentum = omega @ body.tensor
    return body.load - np.cross(omega, momentum + body.rotor) - body.damping * momentum


def _explicit(body: Equations, omega: Floats, h: Floats) -> Floats:
    return omega + h * (_torque(body, omega) @ body.inverse)


def _explicit_of_fixed_size(body: Equations, omega: Floats, h: Floats) -> Floats:
    before = omega @ body.tensor
    after = before + h * _torque(body, omega)
    old, new = (np.linalg.norm(rows, axis=1, keepdims=True) for rows in (before, after))
    found: Floats = after * np.divide(old, new, out=np.ones_like(old), where=new > 0)
    return found @ body.inverse


def _implicit(body: Equations, omega: Floats, h: Floats) -> Floats:
    """(I + h ([omega]x I - [H]x)) (omega' - omega) = h (M - omega x H), H = I omega + rotor."""
    slope = _cross(omega) @ body.tensor - _cross(omega @ body.tensor + body.rotor)
    right = (h * _torque(body, omega))[:, :, None]
    return omega + np.linalg.solve(body.tensor + h[:, :, None] * slope, right)[:, :, 0]


def _cross(vectors: Floats) -> Floats:
    """The matrices [v]x with [v]x u = v x u."""
    return np.cross(np.eye(3), vectors[:, None])


_STEPS: Final[tuple[tuple[str, str, _Step], ...]] = (
    (
        "explicit gyroscopic step",
        "a step is omega + h I^-1 (M - omega x {momentum}), forward Euler on the gyroscopic term",
        _explicit,
    ),
    (
        "explicit gyroscopic step",
        "a step adds h (M - omega x {momentum}) to I omega, and restores its size",
        _explicit_of_fixed_size,
    ),
    (
        "implicit gyroscopic step",
        "a step is backward Euler on the gyroscopic term, or one of Newton's method for it",
        _implicit,
    ),
)


def _best_step(step: _Step, body: Equations, pairs: Pairs) -> tuple[float, float]:
    """The part that the best step leaves, and this step; the search ends where a step repeats itself."""
    longest = float(np.max(np.abs(pairs.spans)))
    h, best = min(longest, _FIRST_STEP / (_pace(body, pairs.begin) or 1.0)), (np.inf, 0.0)
    for _ in range(_SEARCHES):
        counts = np.maximum(1, np.rint(np.abs(pairs.spans) / h)).astype(int)
        if not np.max(counts) <= _MOST_STEPS:
            break
        states = _moved(step, body, pairs.begin, pairs.spans, counts)
        made = states - pairs.flow
        best = min(best, (pairs.left(states), longest / float(np.max(counts))))
        scale = float(np.sum(pairs.defect * made) / (np.sum(made**2) or np.inf))
        further = min(longest, h * scale)
        if not further > 0 or abs(further - h) <= _SAME_STEP * h:
            break
        h = further
    return best


def _pace(body: Equations, omega: Floats) -> float:
    """A bound of the rate of turn, in radians per unit of time."""
    ratio = np.linalg.norm(body.tensor, 2) * np.linalg.norm(body.inverse, 2)
    loads = np.sqrt(np.linalg.norm(body.inverse @ body.load))
    wheels = np.linalg.norm(body.inverse @ np.array(body.rotor))
    return float(ratio * np.max(np.linalg.norm(omega, axis=1)) + loads + wheels)


def _moved(step: _Step, body: Equations, omega: Floats, spans: Floats, counts: Floats) -> Floats:
    """omega after so many steps of each row, which together make its span."""
    h = (spans / counts)[:, None]
    for k in range(int(np.max(counts))):
        omega = np.where((k < counts)[:, None], step(body, omega, h), omega)
    return omega
