"""Faults with and without numbers, and the Gauss-Newton fit of those to the defects of arcs."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, Final

import numpy as np

from taylor_verify.judge.causes.arcs import Arcs, Evidence
from taylor_verify.judge.causes.changed_equations import Changes, Equations
from taylor_verify.judge.causes.float_answer import Answer, velocities_of
from taylor_verify.judge.causes.many_flows import Floats
from taylor_verify.judge.causes.proof import CAPS

# Part of each number's scale for a central difference.
DIFFERENCE: Final = 1e-4
_ROUNDS: Final = 8
# A factor that is far from 1 is reached by doubling it.
_ROUNDS_OF_ONE: Final = 16
# What moves by less than this part of the largest singular value is not seen.
_SEEN: Final = 1e-10
# Trial steps: directions below this part of the largest singular value are left alone; length of the step.
_TRIALS: Final = (
    (_SEEN, 1.0),
    (1e-7, 1.0),
    (1e-4, 1.0),
    (1e-2, 1.0),
    (1e-4, 0.3),
    (1e-2, 0.3),
    (0.1, 0.3),
)
_TRIALS_OF_ONE: Final = (((_SEEN, 1.0),), ((_SEEN, 0.3),))
_LONGEST: Final = 3.0
# A fit ends early if so much is left after three rounds, or if a round gains less than a twentieth.
_HOPELESS: Final = 0.3
_GAIN: Final = 0.95
# One number is fitted in a few rounds, each far better than the last.
_GAIN_OF_ONE: Final = 0.7
_NOTHING: Final = 1e-13
# A fit on the whole answer has few rounds, and is done when so much is left.
_FEW_ROUNDS: Final = 5
_SETTLED: Final = 1e-11
# Defects above this are measured with the few steps that derivatives take.
_COARSE: Final = 1e-3
# Factors of a clock that is not nearly right.
_CLOCKS: Final = (*np.geomspace(1e-3, 8, 60), 0.0)
FRAMES: Final = (10.0, 12.0, 24.0, 25.0, 30.0, 50.0, 60.0, 100.0, 120.0, 240.0)
# Beyond this factor arcs are so long that they take more steps, up to a limit.
_LONG: Final = 3
_MOST_STEPS: Final = 128

_Changing = Callable[[Floats], Changes]


@dataclass(frozen=True)
class Family:
    """Faults with numbers, or one without: ``right`` are the scene's, ``scale`` natural sizes of a change.

    ``kind`` is the class that a family belongs to; families of one kind are no alternatives.
    ``labels`` name the numbers of a body, whose changes are said one by one. ``written`` are the changes
    as a scene writes them, where they are not those that are computed with. ``parts`` are the families of
    which one is made.
    """

    name: str
    kind: str
    right: Floats
    scale: Floats
    changes: Callable[[Floats], Changes]
    labels: tuple[str, ...] = ()
    written: Callable[[Floats], Changes] | None = None
    parts: tuple[Family, ...] = ()

    @property
    def count(self) -> int:
        return len(self.right)

    def as_written(self, numbers: Floats) -> Changes:
        """Return the changes as a scene writes them."""
        return (self.written or self.changes)(numbers)

    def around(self, numbers: Floats) -> list[Changes]:
        """Return the changes at both ends of a central difference in every number."""
        shifts = DIFFERENCE * np.diag(self.scale)
        return [self.changes(numbers + sign * shift) for sign in (1, -1) for shift in shifts]

    @property
    def ahead(self) -> list[Changes]:
        """The changes of a forward difference from the right numbers, in every number."""
        return [self.changes(self.right + shift) for shift in DIFFERENCE * np.diag(self.scale)]

    def slopes(self, ends: Floats) -> Floats:
        """Return the derivatives (entries, numbers) from the values at ``around``."""
        flat = ends.reshape(2, self.count, -1)
        return np.asarray(((flat[0] - flat[1]) / (2 * DIFFERENCE * self.scale[:, None])).T)


def fault(name: str, kind: str, changes: Changes) -> Family:
    """Return a change of the scene that has no number to fit."""
    return Family(name, kind, np.zeros(0), np.zeros(0), lambda _: changes)


@dataclass(frozen=True)
class Sizes:
    """Natural sizes of an answer: velocities, roots of inertia, loads, and the pace of turn."""

    nu: Floats
    inertia: Floats
    load: Floats
    pace: float

    @classmethod
    def of(cls, answer: Answer) -> Sizes:
        right, truth = answer.right, answer.truth.v
        nu = velocities_of(right, truth)
        momentum = truth if right.has_momenta else truth @ right.mass
        span = float(np.max(np.abs(answer.times - answer.begins))) or 1.0
        pace = max(float(np.max(np.linalg.norm(nu[:, -3:], axis=1))), 1 / span)
        return cls(
            _largest(nu, 1e-6),
            np.sqrt(np.diag(right.mass)),
            _largest(momentum, 1.0) * pace,
            pace,
        )


def _largest(rows: Floats, least: float) -> Floats:
    """Return the largest size of each component, at least this part of its vector's."""
    vectors = np.linalg.norm(rows.reshape(len(rows), -1, 3), axis=2).max(axis=0)
    vectors = np.maximum(np.repeat(vectors, 3), 1e-300)
    return np.asarray(np.maximum(np.max(np.abs(rows), axis=0), least * vectors))


def linear(
    equations: Equations,
    name: str,
    kind: str,
    scale: Any,
    right: Any = None,
    labels: tuple[str, ...] = (),
    **along: Any,
) -> Family:
    """Return a family whose numbers change parameters linearly, each ``along`` a direction of its own.

    The numbers of the scene are ``right``, and 0 without it.
    """
    directions = {field: np.asarray(each, dtype=float) for field, each in along.items()}
    count = len(next(iter(directions.values())))
    own = np.zeros(count) if right is None else np.array(right, dtype=float)

    def changes(p: Floats) -> Changes:
        return {
            field: getattr(equations, field) + np.tensordot(p - own, each, axes=1)
            for field, each in directions.items()
        }

    scales = np.broadcast_to(np.asarray(scale, dtype=float), own.shape)
    return Family(name, kind, own, scales, changes, labels)


def both(equations: Equations, one: Family, other: Family) -> Family:
    """Return the family of the changes of two families together."""
    count = one.count

    def joined(of_one: _Changing, of_other: _Changing, p: Floats) -> Changes:
        first, second = of_one(p[:count]), of_other(p[count:])
        common = {
            field: first[field] + second[field] - getattr(equations, field)
            for field in first.keys() & second.keys()
        }
        return {**first, **second, **common}

    return Family(
        f"{one.name} and {other.name}",
        "pair",
        np.concatenate([one.right, other.right]),
        np.concatenate([one.scale, other.scale]),
        partial(joined, one.changes, other.changes),
        written=partial(joined, one.as_written, other.as_written),
        parts=(one, other),
    )


@dataclass(frozen=True)
class Fitted:
    """The numbers of a family that fit best, the size of the defects that they leave, and their errors.

    ``errors`` are those that defects of this size by chance would make; none where they are not known.
    Unless they ``are_seen``, some change of the numbers changes nothing.
    """

    numbers: Floats
    size: float
    errors: Floats | None = None
    are_seen: bool = True


def gauss_newton(evidence: Evidence, family: Family, begin: Floats | None = None) -> Fitted:
    """Return the best numbers of a family; of infinite size where they cannot be computed."""
    numbers = family.right if begin is None else begin
    measured = evidence.coarse if evidence.is_coarse else evidence.defects
    (defects,) = measured([family.changes(numbers)])
    first = size = float(np.linalg.norm(defects))
    for count in range(_ROUNDS_OF_ONE if family.count == 1 else _ROUNDS):
        if measured != evidence.defects and size <= _COARSE * np.sqrt(evidence.of_right.size):
            measured = evidence.defects
            (defects,) = measured([family.changes(numbers)])
            size = float(np.linalg.norm(defects))
        slopes = family.slopes(evidence.coarse(family.around(numbers)))
        if not (np.all(np.isfinite(slopes)) and np.isfinite(size) and np.any(slopes)):
            return Fitted(numbers, np.inf)
        before = size
        for trials in _trial_steps(slopes, defects.ravel(), family.scale, numbers):
            tried = measured([family.changes(numbers + step) for step in trials])
            sizes = _sizes(tried)
            best = int(np.argmin(sizes))
            if sizes[best] < size:
                numbers, defects, size = numbers + trials[best], tried[best], float(sizes[best])
                break
        else:
            break
        is_hopeless = count == 2 and size > _HOPELESS * first
        is_stuck = size > (_GAIN_OF_ONE if family.count == 1 else _GAIN) * before
        if is_hopeless or size < _NOTHING or (count > (family.count > 1) and is_stuck):
            break
    if measured != evidence.defects:
        size = float(_sizes(evidence.defects([family.changes(numbers)]))[0])
    scaled = slopes * family.scale
    _, singular, V = np.linalg.svd(scaled, full_matrices=False)
    is_seen = singular > _SEEN * max(singular[0], 1e-300)
    each = size / np.sqrt(len(scaled))
    errors = each * np.linalg.norm(V[is_seen] / singular[is_seen, None], axis=0)
    return Fitted(numbers, size, errors * family.scale, bool(np.all(is_seen)))


def by_factor(arcs: Arcs, family: Family, best: Fitted) -> Fitted:
    """Return the fit of a clock from the best factor of the grid, if that is better."""
    if best.size < CAPS[1] * arcs.size:
        return best
    tried = [
        (float(np.linalg.norm(defects)), factor)
        for factors, steps in ((_CLOCKS, max(arcs.steps, 4)), (FRAMES, 32))
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


def _trial_steps(
    slopes: Floats, defects: Floats, scale: Floats, numbers: Floats
) -> Iterator[list[Floats]]:
    """Yield steps that are tried together: of one number the full step, and then a shorter one."""
    longest = _LONGEST * np.maximum(1.0, np.abs(numbers) / scale)
    U, singular, V = np.linalg.svd(slopes * scale, full_matrices=False)
    along = U.T @ -defects
    for some in (_TRIALS,) if len(scale) > 1 else _TRIALS_OF_ONE:
        steps = []
        for cut, length in some:
            is_seen = singular > cut * singular[0]
            step = V[is_seen].T @ (along[is_seen] / singular[is_seen])
            far = max(1.0, float(np.max(np.abs(step) / longest)))
            steps.append(scale * step * length / far)
        yield steps


def _sizes(defects: Floats) -> Floats:
    sizes = np.linalg.norm(defects.reshape(len(defects), -1), axis=1)
    return np.where(np.isfinite(sizes), sizes, np.inf)


def orthonormal(columns: Floats, least: float) -> Floats:
    """Return an orthonormal basis of the columns, without directions below a part of the largest."""
    U, singular, _ = np.linalg.svd(columns, full_matrices=False)
    return np.asarray(U[:, singular > least * max(singular[0], 1e-300)])


def across(basis: Floats, vector: Floats) -> Floats:
    """Return a vector without its part in the span of an orthonormal basis."""
    return np.asarray(vector - basis @ (basis.T @ vector))


def least_rest(
    rest: Callable[[Floats], Floats], numbers: Floats, scale: Floats, shift: float, enough: float
) -> Floats:
    """Return numbers that leave less, or ``enough``, by Newton's method.

    Raises ValueError where no motion is reached.
    """
    last = np.inf
    for _ in range(_FEW_ROUNDS):
        base = rest(numbers)
        largest = float(np.max(np.abs(base)))
        if largest > 0.5 * last or largest < max(_SETTLED, enough):
            break
        ahead = [rest(numbers + step) for step in shift * np.diag(scale)]
        slopes = (np.array(ahead) - base).T / shift
        step = np.linalg.lstsq(slopes, base, rcond=1e-9)[0]
        last, numbers = largest, numbers - scale * step
    return numbers
