"""The motion at the times asked for, twice: what the two runs share is what the referee knows.

Both runs are Taylor series in MPFR. The second has more bits, a higher order and other steps, so that the
difference of the two is the error of the first.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction
from typing import Any, Final, NamedTuple

import gmpy2
from gmpy2 import log2, log10, mpfr

from referee.bodies import Scene, Vector, read_scene
from referee.equations import ROWS, Path, power_series, start_of, velocities

# A step is exp(-2) of the radius of convergence, so that a term is two natural logarithms below the last.
_BITS_A_TERM: Final = 2.88
_MORE_BITS: Final = 30
# Some terms vanish where a component is even or odd in time.
_ENDS: Final = 3


class Known(NamedTuple):
    """A number by the better of two runs, and how far the other one is from it."""

    value: Any
    error: Any

    @property
    def digits(self) -> int:
        """Number of significant digits on which the two runs agree; those of the better run if on all."""
        size = abs(self.value)
        error = max(self.error, size / mpfr(2) ** self.value.precision)
        return max(0, int(-log10(error / size))) if size else 0

    def __str__(self) -> str:
        return f"{self.value:.{self.digits or 1}g} (known to {self.digits} digits)"


Row = dict[str, list[Known]]


def motion(text: str, times: Sequence[Fraction], bits: int) -> list[Row]:
    """Return the tracked quantities of a scene at each time, from runs of so many bits and of more."""
    first = _run(text, times, bits)
    with gmpy2.context(precision=bits + _MORE_BITS):
        better = _run(text, times, bits + _MORE_BITS)
        return [
            {
                name: [Known(q, abs(p - q)) for p, q in zip(one[name], row[name], strict=True)]
                for name in row
            }
            for one, row in zip(first, better, strict=True)
        ]


def _run(text: str, times: Sequence[Fraction], bits: int) -> list[dict[str, Vector]]:
    """Return the tracked quantities at each time, by one run."""
    with gmpy2.context(precision=bits):
        scene = read_scene(text)
        elapsed = [time - scene.start for time in times]
        states = dict(_side(scene, [t for t in elapsed if t >= 0], bits))
        states |= _side(scene, [t for t in elapsed if t < 0], bits)
        return [_quantities(scene, states[t]) for t in elapsed]


def _side(
    scene: Scene, elapsed: Sequence[Fraction], bits: int
) -> Iterator[tuple[Fraction, dict[str, Vector]]]:
    """Yield the states at times on one side of the start, away from it."""
    order = int(bits / _BITS_A_TERM) + 2
    state, now = start_of(scene), Fraction(0)
    remaining = sorted(elapsed, key=abs)
    while remaining:
        path = power_series(scene, state, order)
        reach = _step(path, list(state), bits) or abs(remaining[-1])
        while remaining and abs(remaining[0] - now) <= reach:
            yield remaining[0], _values(path, list(state), remaining.pop(0) - now)
        if remaining:
            step = reach if remaining[0] > now else -reach
            state, now = _values(path, list(state), step), now + step


def _step(path: Path, names: Sequence[str], bits: int) -> Fraction | None:
    """Return a step after which the last terms are 2^-bits of each vector; None if they are all zero."""
    steps = [step for name in names if (step := _log_step(path, name, bits)) is not None]
    return Fraction(2 ** min(steps)) if steps else None


def _log_step(path: Path, name: str, bits: int) -> float | None:
    """Return the binary logarithm of the step that one vector allows, by its first and its last terms."""
    sizes = {k: _log_size(path.vector(name, k)) for k in range(len(path[name][0]))}
    terms = [(k, size) for k, size in sizes.items() if size is not None]
    first = [term for term in terms if term[0] < _ENDS]
    last = [term for term in terms if term[0] >= len(sizes) - _ENDS]
    # |c_n| h^n = 2^-bits |c_k| h^k for the largest of the first terms and each of the last.
    return min(
        (max((low - bits - high) / (n - k) for k, low in first) for n, high in last if first),
        default=None,
    )


def _log_size(values: Vector) -> float | None:
    """Return the binary logarithm of the largest entry; None where all are zero."""
    largest = max(map(abs, values))
    return float(log2(largest)) if largest else None


def _values(path: Path, names: Sequence[str], step: Fraction) -> dict[str, Vector]:
    """Return the vectors after a step, by Horner's rule."""
    t = mpfr(step)
    return {name: [_polynomial(component, t) for component in path[name]] for name in names}


def _polynomial(coefficients: Sequence[Any], t: Any) -> Any:
    """Return the value of a polynomial."""
    value = mpfr(0)
    for coefficient in reversed(coefficients):
        value = value * t + coefficient
    return value


def _quantities(scene: Scene, state: dict[str, Vector]) -> dict[str, Vector]:
    """Return the tracked quantities by the names that the command uses, a matrix row by row."""
    of = {"linear_impulse": "x", "angular_impulse": "y", "centre": "centre"}
    values = {name: state[of[name]] for name in scene.tracked if name in of}
    if "omega" in scene.tracked:
        values["omega"] = velocities(scene, state)["W"]
    if "attitude" in scene.tracked:
        values["attitude"] = [entry for row in ROWS for entry in state[row]]
    return values
