"""The error that a rounding of the input causes: half a unit in the last place of each number.

Another program rounds the numbers of the body and the start in its own way: it reads decimals, computes
a tensor from parts, normalises a quaternion. Here each number is changed by u of its size, in the exact
solution and not in its derivative. The effect is measured in the unit of every gate:

    input(t) = [ sum_j |exact(p_j (1 + u), t) - exact(p_j, t)|^2 ]^(1/2).

If there are many inputs, all of them are changed at once, up or down at random. The expected mean square
over such draws is the same sum.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any, Final

import numpy as np
from mpmath import mp

from taylor_verify.exact.conditioning.condition import differs_dearly, path_of_run
from taylor_verify.exact.conditioning.loaded import frame, is_of_run
from taylor_verify.exact.damping import without_damping
from taylor_verify.exact.invariants import invariants
from taylor_verify.exact.route import solution
from taylor_verify.exact.row_arithmetic import norms as row_norms
from taylor_verify.exact.solution import Unsettled
from taylor_verify.exact.taylor import TaylorSolution
from taylor_verify.judge.errors.state import norms, state_errors
from taylor_verify.judge.floor.arithmetic import truth_digits, working_bits
from taylor_verify.judge.floor.attainable import (
    larger_neighbour,
    looked_at,
    orbit_of,
    orbit_of_run,
)
from taylor_verify.judge.floor.moves import CHANGE, Moves
from taylor_verify.judge.velocities import velocities
from taylor_verify.numbers.precision import Rung
from taylor_verify.records.quantities import GROUPS
from taylor_verify.scenes.motion import Clock, Motion
from taylor_verify.scenes.mpfr import in_mpfr, precision
from taylor_verify.scenes.named_numbers import Part, Shape, Value
from taylor_verify.scenes.scene import Scene

Floats = np.ndarray[Any, np.dtype[np.float64]]

# Up to this many inputs are changed one at a time; for more, this many draws give the sum to a third.
_MOST_DRAWS: Final = 8
_MORE_DIGITS: Final = 6


@dataclass(frozen=True)
class InputRounding:
    """The change of every gate's quantity by a rounding of the input, in its unit and at every sample.

    ``moved`` names the changed inputs in words.
    """

    moved: str
    at_samples: Mapping[str, Floats]


def input_rounding(given: Scene, rung: Rung, asked: Scene | None = None) -> InputRounding:
    """Return the response to a rounding of each nonzero number of the body and of the start.

    If the rung cannot represent every time, such as 0.1, the times are changed too. Where the motion has no
    closed form, or loses it by such a change, the response is that of its derivative: each changed motion
    would cost as much as the truth. Elsewhere it is computed at the samples of the floor, for the scene
    ``asked``: near an unstable axis the response is large during short passages, which evenly chosen
    samples could miss.
    """
    if is_of_run(given) or differs_dearly(given):
        return _by_derivative(given, rung)
    beside = [*_moved(given, rung)]
    if any(solution(scene).route == "taylor" for scene in beside):
        return _by_derivative(given, rung)
    nodes = looked_at(orbit_of(given if asked is None else asked))
    instants = tuple(given.clock.instants[k] for k in nodes)
    scene = replace(given, clock=Clock(given.clock.start, instants))
    digits, numbers = truth_digits(rung.bits, _MORE_DIGITS), len(_numbers(scene))
    with mp.workprec(working_bits(rung.bits)):
        gates = _Gates(scene, _motion(scene, digits))
        moved = [gates.squares(_motion(replace(s, clock=scene.clock), digits)) for s in beside]
        # Single changes are summed, random draws are averaged.
        draws = 1 if numbers <= _MOST_DRAWS else len(moved)
        names = moved[0] if moved else ()
        total = {
            name: np.sum([squares_of_move[name] for squares_of_move in moved], axis=0) / draws
            for name in names
        }
        words = f"each of the {numbers} numbers of body and start that are not zero"
        if not all(rung.holds(t) for t in instants):
            later = tuple(t * (1 + rung.unit_roundoff) for t in instants)
            late = replace(scene, clock=Clock(scene.clock.start, later))
            for name, squares in gates.squares(_motion(late, digits)).items():
                total[name] = total.get(name, 0.0) + squares
            words += ", and every time"
    return InputRounding(words, _at_samples(total, nodes, len(given.clock.instants)))


def _by_derivative(given: Scene, rung: Rung) -> InputRounding:
    """Return the response of a motion that comes with its derivative; numbers of loads are inputs too."""
    path = orbit_of_run(given, given, rung.bits) if is_of_run(given) else path_of_run(given)
    nodes = looked_at(path)
    places = {time: k for k, time in enumerate(path.elapsed)}
    rows = [places[given.clock.elapsed[k]] for k in nodes]
    instants = tuple(given.clock.instants[k] for k in nodes)
    scene = replace(given, clock=Clock(given.clock.start, instants))
    changed = [_with_factors(given, {place: 1 + CHANGE}) for place in _numbers(given)]
    with mp.workprec(working_bits(rung.bits)):
        moves, roundoff = Moves(path, changed), float(rung.unit_roundoff)
        gates = _Gates(scene, moves.here(rows))
        draws = [gates.squares(motion) for motion in moves.motions(rows, roundoff)]
        total = {name: np.mean([draw[name] for draw in draws], axis=0) for name in draws[0]}
        parts = "body and start" if given.body.loads is None else "body, loads and start"
        words = f"each of the {moves.count} numbers of {parts} that are not zero"
        if not all(rung.holds(t) for t in instants):
            for name, squares in gates.squares(moves.late(rows, roundoff)).items():
                total[name] = total[name] + squares
            words += ", and every time"
    return InputRounding(words, _at_samples(total, nodes, len(given.clock.instants)))


def _at_samples(
    squares: Mapping[str, Floats], nodes: Sequence[int], count: int
) -> dict[str, Floats]:
    """Return the roots of what is known at some samples, at all of them."""
    places, samples = np.array(nodes, dtype=float), np.arange(count, dtype=float)
    return {
        name: larger_neighbour(np.sqrt(values), places, samples) for name, values in squares.items()
    }


class _Gates:
    """The quantities that gates compare, beside the exact motion ``here`` of a scene.

    To be used at the ambient precision at which it was made.
    """

    def __init__(self, scene: Scene, here: Motion) -> None:
        self._scene, self._here, self._invariants = scene, here, invariants(scene)
        self._velocities = self._velocities_along(here)
        with precision():
            motion = self._undamped(here)
            self._conserved = [
                (each.value(motion), each.scale(motion)) for each in self._invariants
            ]

    def squares(self, there: Motion) -> dict[str, Floats]:
        """Return the squared change of every quantity by one move, in the units of the gates."""
        states = state_errors(self._scene, self._here, there)
        changes = {each.quantity: each.values for each in states}
        with precision():
            motion = self._undamped(there)
            for each, (before, scale) in zip(self._invariants, self._conserved, strict=True):
                change = each.value(motion) - before
                sizes = row_norms(change) if change.ndim > 1 else abs(change)
                changes[each.name] = sizes / scale
        for name, after in self._velocities_along(there).items():
            before = self._velocities[name]
            changes[name] = norms(after - before) / (max(norms(before)) or 1)
        return {name: values.astype(float) ** 2 for name, values in changes.items()}

    def _undamped(self, motion: Motion) -> Motion:
        """The motion in the numbers of MPFR, with the momenta that damping would not have changed."""
        return without_damping(self._scene, in_mpfr(motion), self._scene.clock.elapsed)

    def _velocities_along(self, motion: Motion) -> dict[str, Any]:
        if not self._scene.body.has_velocities:
            return {}
        rows = velocities(self._scene.body, motion.quantities)
        return {GROUPS[group].quantity: values for group, values in rows.items()}


def _motion(scene: Scene, digits: int) -> Motion:
    """Return the exact motion; by Taylor series if no closed form settles, as near a degenerate orbit."""
    elapsed = scene.clock.elapsed
    try:
        quantities = solution(scene).evaluate(elapsed, digits)
    except Unsettled:
        quantities = TaylorSolution(scene).evaluate(elapsed, digits)
    return Motion(quantities, np.array([mp.zero] * len(elapsed), dtype=object))


# Scenes with changed numbers.


def _moved(scene: Scene, rung: Rung) -> Iterator[Scene]:
    numbers, u = _numbers(scene), rung.unit_roundoff
    if len(numbers) <= _MOST_DRAWS:
        signs = [[int(i == j) for i in range(len(numbers))] for j in range(len(numbers))]
    else:
        coin = random.Random(1)
        signs = [[coin.choice((-1, 1)) for _ in numbers] for _ in range(_MOST_DRAWS)]
    for row in signs:
        factors = {place: 1 + sign * u for place, sign in zip(numbers, row, strict=True)}
        yield _with_factors(scene, factors)


Place = tuple[str, int, int]


def _numbers(scene: Scene) -> list[Place]:
    """Return the places of all nonzero numbers; numbers that symmetry makes equal count once."""
    places: dict[Place, None] = {}

    def note(place: Place, number: Fraction) -> Fraction:
        if number:
            places.setdefault(place)
        return number

    _changed(scene, note)
    start = scene.initial
    unasked = {part.name for part in start.PARTS} - {*start.MOVING, *frame(scene)}
    asked = [place for place in places if place[0] not in unasked]
    # The attitude comes last.
    return sorted(asked, key=lambda place: place[0] == "attitude")


def _with_factors(scene: Scene, factors: Mapping[Place, Fraction]) -> Scene:
    """Return the scene with these numbers multiplied by factors."""
    return _changed(scene, lambda place, number: number * factors.get(place, 1))


def _changed(scene: Scene, change: Callable[[Place, Fraction], Fraction]) -> Scene:
    """Return the scene with every number changed; numbers that symmetry makes equal share one place."""

    def row(name: str, vector: Sequence[Fraction]) -> tuple[Fraction, ...]:
        return tuple(change((name, i, i), entry) for i, entry in enumerate(vector))

    def place(part: Part, i: int, k: int) -> Place:
        if part.shape is Shape.SYMMETRIC and i > k:
            return part.name, k, i
        # Axes 1 and 2 of a body of revolution share one number, and rounding must not make two of it.
        twins = scene.body.is_revolved and i == k == 1
        return (part.name, 0, 0) if twins else (part.name, i, k)

    def changed(part: Part, value: Value) -> Value:
        if part.shape is Shape.NUMBER:
            return row(part.name, (value,))[0]
        if part.shape not in (Shape.SYMMETRIC, Shape.MATRIX):
            return row(part.name, value)
        return tuple(
            tuple(change(place(part, i, k), entry) for k, entry in enumerate(line))
            for i, line in enumerate(value)
        )

    body, initial = scene.body.changed(changed), scene.initial.changed(changed)
    return replace(scene, body=body, initial=initial)
