"""H = I omega + h of a body whose wheels have a momentum h by texts."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction

from taylor_verify.exact.conserved.derivation import Derivation
from taylor_verify.exact.conserved.polynomial import TooLong, terms
from taylor_verify.exact.euler.invariants import momentum, space_momentum
from taylor_verify.exact.invariant import Array, Invariant
from taylor_verify.exact.registry import kind_of
from taylor_verify.exact.row_arithmetic import applied, norms, ones
from taylor_verify.numbers.tensors import Vector
from taylor_verify.scenes.loads.loads import Loads
from taylor_verify.scenes.motion import Motion
from taylor_verify.scenes.mpfr import real
from taylor_verify.scenes.scene import Scene


@dataclass(frozen=True)
class Wheels:
    """h as ``constant`` and exact multiples of the components of own states, by the state's name."""

    scene: Scene
    constant: Vector
    by_state: Mapping[str, tuple[Vector, ...]]

    def momentum(self, motion: Motion) -> Array:
        """H at every row (n, 3)."""
        H: Array = kind_of(self.scene.body).momentum_rows(self.scene.body, motion)
        H = H + real((self.constant,), H)
        for name, matrix in self.by_state.items():
            H = H + applied(matrix, motion[name])
        return H

    def felt_by(self, quantity: Invariant, slope: Callable[[Motion], Array]) -> Invariant:
        """The quantity with bounds of what own states add to it; it changes with H by at most ``slope``."""

        def sensitivity(motion: Motion) -> dict[str, Array]:
            size, like = slope(motion), motion["omega"]
            own = {name: size * _norm(matrix, like) for name, matrix in self.by_state.items()}
            return {**quantity.sensitivity(motion), **own}

        return replace(quantity, sensitivity=sensitivity)


def with_wheels(scene: Scene, loads: Loads) -> Iterator[Invariant]:
    """Yield |H|^2, and H in space where the attitude is tracked.

    None where h is no sum of multiples of own states that the scene tracks.
    """
    wheels = _wheels(scene, loads)
    if wheels is None:
        return
    H = wheels.momentum
    yield wheels.felt_by(momentum(H), lambda motion: 2 * norms(H(motion)))
    if "attitude" in scene.track:
        yield wheels.felt_by(space_momentum(H), lambda motion: ones(motion["omega"]))


def _wheels(scene: Scene, loads: Loads) -> Wheels | None:
    """Return h by own states, if it is so for all times."""
    if loads.switches:
        return None
    try:
        (derivation,) = Derivation.each(scene, [loads.piece(Fraction(0))])
        rows = [dict(terms(row)) for row in derivation.wheels]
    except TooLong:
        return None
    states = {s.name: s.components for s in loads.states if s.name in scene.states}
    names = {name for components in states.values() for name in components}
    if any(len(m) > 1 or not names.issuperset(m) for row in rows for m in row):
        return None
    zero = Fraction(0)
    constant = tuple(row.get((), zero) for row in rows)
    by_state = {
        state: tuple(tuple(row.get((name,), zero) for name in components) for row in rows)
        for state, components in states.items()
    }
    read = {state: matrix for state, matrix in by_state.items() if any(map(any, matrix))}
    return Wheels(scene, constant, read)


def _norm(matrix: tuple[Vector, ...], like: Array) -> Array:
    """The root of the sum of squares of all entries, at least the spectral norm, as a number."""
    size: Array = norms(real((tuple(entry for row in matrix for entry in row),), like))[0]
    return size
