"""First-order steps for the gyroscopic term omega x (I omega + h): explicit and implicit.

In this term h is the momentum of the wheels, ``rotor``. Everywhere else in this file h is the step.

An explicit step is forward Euler on the term; an implicit step is one Newton step for backward Euler.
Each method is applied from every row to the next row. The rows need not be the steps of the engine: the
step h that fits best is found by iteration, because the defect of a first-order method is nearly
proportional to h.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Final

import numpy as np

from taylor_verify.judge.causes.equations import Equations
from taylor_verify.judge.causes.flow import Floats
from taylor_verify.judge.causes.material import Candidate, Material, Pairs

# The search for h begins with this turn in radians, for which a first-order method is asymptotic.
_FIRST_STEP: Final = 0.05
_SEARCHES: Final = 6
# Steps with a relative difference below this are equal.
_SAME_STEP: Final = 1e-3
# Limit for the number of steps from one row to the next.
_MOST_STEPS: Final = 5_000

# A function that makes one step of length h (n, 1) from every row of omega (n, 3).
_Step = Callable[[Equations, Floats, Floats], Floats]


def gyroscopic_step(material: Material) -> Iterator[Candidate]:
    """Yield the first-order methods for the gyroscopic term, each with its best step."""
    right, pairs = material.equations, material.pairs
    if not right.is_rigid:
        return
    momentum = "(I omega + wheels)" if any(right.rotor) else "I omega"
    for name, words, step in _STEPS:
        left, h = _best_step(step, right, pairs)
        why = words.format(momentum=momentum)
        yield Candidate(name, "omega", left, f"{why}, with h = {h:.3g}", fitted=1)


def _torque(body: Equations, omega: Floats) -> Floats:
    """Return M - omega x (I omega + rotor) - c I omega for every row."""
    momentum = omega @ body.tensor
    return body.load - np.cross(omega, momentum + body.rotor) - body.damping * momentum


def _explicit(body: Equations, omega: Floats, h: Floats) -> Floats:
    return omega + h * (_torque(body, omega) @ body.inverse)


def _explicit_of_fixed_size(body: Equations, omega: Floats, h: Floats) -> Floats:
    before = omega @ body.tensor
    after = before + h * _torque(body, omega)
    old, new = (np.linalg.norm(rows, axis=1, keepdims=True) for rows in (before, after))
    momentum: Floats = after * np.divide(old, new, out=np.ones_like(old), where=new > 0)
    return momentum @ body.inverse


def _implicit(body: Equations, omega: Floats, h: Floats) -> Floats:
    """Solve (I + h ([omega]x I - [H]x)) (omega' - omega) = h (M - omega x H), H = I omega + rotor."""
    slope = _cross(omega) @ body.tensor - _cross(omega @ body.tensor + body.rotor)
    right = (h * _torque(body, omega))[:, :, None]
    return omega + np.linalg.solve(body.tensor + h[:, :, None] * slope, right)[:, :, 0]


def _cross(vectors: Floats) -> Floats:
    """Return the matrices [v]x with [v]x u = v x u."""
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
    """Return the part of the error that the best step leaves, and that step."""
    longest = float(np.max(np.abs(pairs.spans)))
    h, best = min(longest, _FIRST_STEP / (_pace(body, pairs.begin) or 1.0)), (np.inf, 0.0)
    for _ in range(_SEARCHES):
        counts = np.maximum(1, np.rint(np.abs(pairs.spans) / h)).astype(int)
        if not np.max(counts) <= _MOST_STEPS:
            break
        states = _moved(step, body, pairs.begin, pairs.spans, counts)
        change = states - pairs.flow
        best = min(best, (pairs.left(states), longest / float(np.max(counts))))
        scale = float(np.sum(pairs.defect * change) / (np.sum(change**2) or np.inf))
        further = min(longest, h * scale)
        if not further > 0 or abs(further - h) <= _SAME_STEP * h:
            break
        h = further
    return best


def _pace(body: Equations, omega: Floats) -> float:
    """Return a bound of the rate of turn, in radians per unit of time."""
    ratio = np.linalg.norm(body.tensor, 2) * np.linalg.norm(body.inverse, 2)
    loads = np.sqrt(np.linalg.norm(body.inverse @ body.load))
    wheels = np.linalg.norm(body.inverse @ np.array(body.rotor))
    return float(ratio * np.max(np.linalg.norm(omega, axis=1)) + loads + wheels)


def _moved(step: _Step, body: Equations, omega: Floats, spans: Floats, counts: Floats) -> Floats:
    """Return omega after ``counts`` equal steps from each row, which together make its span."""
    h = (spans / counts)[:, None]
    for k in range(int(np.max(counts))):
        omega = np.where((k < counts)[:, None], step(body, omega, h), omega)
    return omega
