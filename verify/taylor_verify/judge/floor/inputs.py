"""What a rounding of the input leaves: an answer is that of a body half a unit in the last place off.

Somebody else's program has its own numbers for the body and the start: decimals read once, a tensor
put together from parts, a quaternion normalised. Each of them is moved here by u of its size, on the
exact solution and not on its derivative, and what the motion makes of it is counted in the unit of
every gate:

    input(t) = [ sum_j |exact(p_j (1 + u), t) - exact(p_j, t)|^2 ]^(1/2).

Where there are many inputs all of them are moved at once, up or down at random: the mean square over
some such draws has the same sum for its expectation.

A manufactured motion has its coefficients and frequencies for inputs too, and the start apart from them:
the motion moved is that from the moved start, under the loads of the moved motion and body.
"""

from __future__ import annotations

import random
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any, Final

import numpy as np
from mpmath import mp

from taylor_verify.exact.invariants import invariants
from taylor_verify.exact.route import solution
from taylor_verify.exact.solution import Unsettled
from taylor_verify.exact.taylor import TaylorSolution
from taylor_verify.judge.errors.state import norms, state_errors
from taylor_verify.judge.floor.arithmetic import truth_digits, working_bits
from taylor_verify.judge.floor.attainable import looked_at
from taylor_verify.judge.velocities import (
    Velocity,
    angular_velocity,
    has_velocities,
    linear_velocity,
)
from taylor_verify.scenes.bodies import Body
from taylor_verify.scenes.manufactured import Manufactured, Wave
from taylor_verify.scenes.motion import Clock, Motion
from taylor_verify.scenes.parts import Part, Shape, Value
from taylor_verify.scenes.precision import Rung
from taylor_verify.scenes.scene import Scene
from taylor_verify.scenes.tensors import Matrix

Floats = np.ndarray[Any, np.dtype[np.float64]]

# Up to this many inputs one at a time; of more, this many draws give the sum to a third.
_MOST_DRAWS: Final = 8
_MORE_DIGITS: Final = 6
_ALL: Final = tuple((i, k) for i in range(3) for k in range(3))
_UPPER: Final = tuple((i, k) for i, k in _ALL if i <= k)


@dataclass(frozen=True)
class InputRounding:
    """The response of every gate, in its unit and at every sample, to a rounding of the input.

    ``moved`` says in words what was moved.
    """

    moved: str
    at_samples: Mapping[str, Floats]


def input_rounding(given: Scene, rung: Rung, asked: Scene | None = None) -> InputRounding:
    """The response to a rounding of each number of the body and of the start that is not zero.

    Where the rung does not hold every time, as it holds no 0.1, the times are moved likewise. The response
    is found where the floor looks at the orbit, of the scene as ``asked``: a body beside its unstable
    axis answers in the short times of its passages, and those may lie between samples chosen evenly.
    """
    samples = len(given.clock.instants)
    nodes = looked_at(given if asked is None else asked)
    instants = tuple(given.clock.instants[k] for k in nodes)
    scene = replace(given, clock=Clock(given.clock.start, instants))
    digits = truth_digits(rung.bits, _MORE_DIGITS)
    with mp.workprec(working_bits(rung.bits)):
        here = _motion(scene, digits)
        moved = [_Response.of(scene, here, _motion(s, digits)) for s in _moved(scene, rung)]
        total = _mean_square(moved, len(_numbers(scene)))
        what = "body and start" if scene.body.manufactured is None else "body, motion and start"
        words = f"each of the {len(_numbers(scene))} numbers of {what} that are not zero"
        if not all(rung.holds(t) for t in instants):
            late = _Response.of(scene, here, _motion(_late(scene, rung.unit_roundoff), digits))
            total = {name: total.get(name, 0.0) + late.squares[name] for name in late.squares}
            words += ", and every time"
    roots = {name: np.sqrt(square) for name, square in total.items()}
    return InputRounding(words, {name: _at_samples(r, nodes, samples) for name, r in roots.items()})


@dataclass(frozen=True)
class _Response:
    """The squares of what one move does to every gate, at the nodes."""

    squares: Mapping[str, Floats]

    @classmethod
    def of(cls, scene: Scene, here: Motion, there: Motion) -> _Response:
        """In the units of the gates: states against states, conserved quantities likewise."""
        found = {e.quantity: e.values for e in state_errors(scene, here, there)}
        for invariant in invariants(scene):
            change = invariant.value(there) - invariant.value(here)
            sizes = norms(change) if change.ndim > 1 else abs(change)
            found[invariant.name] = sizes / invariant.scale(here)
        if has_velocities(scene.body):
            found["omega"] = _of_velocity(angular_velocity, scene.body, here, there)
            found["velocity"] = _of_velocity(linear_velocity, scene.body, here, there)
        return cls({name: values.astype(float) ** 2 for name, values in found.items()})


def _of_velocity(of: Velocity, body: Body, here: Motion, there: Motion) -> Any:
    """|change of Omega| / max |Omega|, or of U likewise."""
    one, other = (of(body, m.quantities) for m in (here, there))
    largest = max(norms(one))
    return norms(other - one) / (largest or 1)


def _mean_square(moved: Sequence[_Response], inputs: int) -> dict[str, Floats]:
    """The sum over the inputs: of single moves as it is, of draws their mean."""
    draws = 1 if inputs <= _MOST_DRAWS else len(moved)
    names = moved[0].squares if moved else ()
    return {name: np.sum([m.squares[name] for m in moved], axis=0) / draws for name in names}


def _at_samples(at_nodes: Floats, nodes: Sequence[int], samples: int) -> Floats:
    """Between two nodes the larger of both."""
    places = np.arange(samples)
    later = np.searchsorted(nodes, places)
    earlier = np.searchsorted(nodes, places, side="right") - 1
    return np.maximum(at_nodes[later], at_nodes[earlier])


def _motion(scene: Scene, digits: int) -> Motion:
    """The exact motion; beside a degenerate orbit, where a closed form may not settle, by Taylor series."""
    elapsed = scene.clock.elapsed
    try:
        found = solution(scene).evaluate(elapsed, digits)
    except Unsettled:
        found = TaylorSolution(scene).evaluate(elapsed, digits)
    return Motion(found, np.array([mp.zero] * len(elapsed), dtype=object))


# Scenes with their numbers moved.


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


def _late(scene: Scene, u: Fraction) -> Scene:
    clock = scene.clock
    return replace(scene, clock=Clock(clock.start, tuple(t * (1 + u) for t in clock.instants)))


Place = tuple[str, int, int]


def _numbers(scene: Scene) -> list[Place]:
    """The places of all numbers that are not zero; what symmetry makes equal counts once."""
    body, start = scene.body, scene.initial
    asked = [part for part in start.PARTS if part.name in (*start.MOVING, *scene.track)]
    vectors = [part for part in asked if part.shape is not Shape.QUATERNION]
    frames = [part for part in asked if part.shape is Shape.QUATERNION]
    return [
        *(p for part in body.PARTS for p in _places(part, body.part(part), body.is_revolved)),
        *(p for part in vectors for p in _places(part, start.part(part))),
        *_of_motion(body.manufactured),
        *(p for part in frames for p in _places(part, start.part(part))),
    ]


def _of_motion(motion: Manufactured | None) -> list[Place]:
    """The coefficients and frequencies of a manufactured motion."""
    if motion is None:
        return []
    waves = [
        place
        for k, wave in enumerate(motion.waves)
        for place in (*_row(f"cosine{k}", wave.cosine), *_row(f"sine{k}", wave.sine))
    ]
    frequencies = [("frequency", k, k) for k in range(len(motion.waves))]
    return [*_row("constant", motion.constant), *waves, *frequencies]


def _places(part: Part, value: Value, revolved: bool = False) -> list[Place]:
    """The places of one part. Of a body of revolution entries go by twos: rounding leaves it one."""
    if part.shape is Shape.NUMBER:
        return _row(part.name, (value,))
    if part.shape in (Shape.VECTOR, Shape.QUATERNION):
        return _row(part.name, value)
    if revolved:
        return [(part.name, i, i) for i in (0, 2) if value[i][i]]
    places = _UPPER if part.shape is Shape.SYMMETRIC else _ALL
    return [(part.name, i, k) for i, k in places if value[i][k]]


def _row(name: str, vector: Sequence[Fraction]) -> list[Place]:
    return [(name, i, i) for i, entry in enumerate(vector) if entry]


def _with_factors(scene: Scene, factors: Mapping[Place, Fraction]) -> Scene:
    """The scene with these numbers multiplied."""

    def row(name: str, vector: Sequence[Fraction]) -> tuple[Fraction, ...]:
        return tuple(entry * factors.get((name, i, i), 1) for i, entry in enumerate(vector))

    def matrix(part: Part, entries: Matrix) -> Matrix:
        def factor(i: int, k: int) -> Fraction | int:
            if part.shape is Shape.SYMMETRIC and i > k:
                i, k = k, i
            # Axes 1 and 2 of a body of revolution are one number.
            twins = scene.body.is_revolved and i == k == 1
            return factors.get((part.name, 0, 0) if twins else (part.name, i, k), 1)

        return tuple(
            tuple(e * factor(i, k) for k, e in enumerate(line)) for i, line in enumerate(entries)
        )

    def changed(part: Part, value: Value) -> Value:
        if part.shape is Shape.NUMBER:
            return row(part.name, (value,))[0]
        if part.shape in (Shape.SYMMETRIC, Shape.MATRIX):
            return matrix(part, value)
        return row(part.name, value)

    def waves(motion: Manufactured | None) -> Manufactured | None:
        if motion is None:
            return None
        frequencies = row("frequency", [wave.frequency for wave in motion.waves])
        return Manufactured(
            row("constant", motion.constant),
            tuple(
                Wave(nu, row(f"cosine{k}", wave.cosine), row(f"sine{k}", wave.sine))
                for k, (nu, wave) in enumerate(zip(frequencies, motion.waves, strict=True))
            ),
        )

    body = scene.body.changed(changed).with_motion(waves(scene.body.manufactured))
    return replace(scene, body=body, initial=scene.initial.changed(changed))
