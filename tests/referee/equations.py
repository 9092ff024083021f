"""The equations of motion, as they stand in the texts, for the coefficients of power series.

Legend: p = I w the momentum of a rigid body, h that of its wheels, M the moment; x and y the impulses of a
solid in a fluid, X and L the force and the couple; c the damping; U the velocity of the origin, W the
angular velocity; e1, e2, e3 the axes of space seen from the body, which are the rows of R.

A vector is three lists of coefficients, the k-th of t^k. Every product of two series is a convolution.
"""

from __future__ import annotations

from collections.abc import Sequence
from operator import mul
from typing import Any, Final

from gmpy2 import mpfr

from referee.bodies import Scene, Vector, apply

Series = list[list[Any]]


ROWS: Final = ("e1", "e2", "e3")
# The rotation of the body carries each of these along: v' = v x W and more.
TURNING: Final = ("p", "x", "y", *ROWS)


class Path(dict[str, Series]):
    """The power series of a motion by name, and with them those of U and W."""

    def vector(self, name: str, k: int) -> Vector:
        """Return the k-th coefficient of a vector."""
        return [component[k] for component in self[name]]


def start_of(scene: Scene) -> dict[str, Vector]:
    """Return the state that the equations move, rounded to the ambient precision."""
    state = dict(scene.state)
    if "attitude" in scene.tracked:
        state |= dict(zip(ROWS, scene.attitude, strict=True))
    if "centre" in scene.tracked:
        state["centre"] = scene.centre
    return {name: [mpfr(entry) for entry in values] for name, values in state.items()}


def power_series(scene: Scene, start: dict[str, Vector], order: int) -> Path:
    """Return the coefficients of t^0 to t^order of the motion from this state."""
    path = Path({name: [[entry] for entry in values] for name, values in start.items()})
    path |= {"U": [[], [], []], "W": [[], [], []]}
    for k in range(order):
        for name, values in velocities(scene, {n: path.vector(n, k) for n in scene.state}).items():
            _append(path[name], values)
        for name, rate in rates(scene, path, k).items():
            # The k-th coefficient of the derivative is k + 1 times the next one of the vector.
            _append(path[name], [entry / (k + 1) for entry in rate])
    return path


def velocities(scene: Scene, state: dict[str, Vector]) -> dict[str, Vector]:
    """Return W = K p of a rigid body, or U = A x + B y and W = B^T x + C y of a solid in a fluid."""
    if "p" in state:
        return {"W": apply(scene.inverse, state["p"])}
    both = apply(scene.inverse, state["x"] + state["y"])
    return {"U": both[:3], "W": both[3:]}


def rates(scene: Scene, path: Path, k: int) -> dict[str, Vector]:
    """Return the k-th coefficients of the derivatives of all vectors."""
    spin, flow = ([component[::-1] for component in path[name]] for name in ("W", "U"))
    derivatives = {name: cross(path[name], spin) for name in TURNING if name in path}
    for name in scene.state:
        load = scene.loads[name] if k == 0 else [0, 0, 0]
        derivatives[name] = [
            turn + pull - scene.damping * entry
            for turn, pull, entry in zip(derivatives[name], load, path.vector(name, k), strict=True)
        ]
    if "p" in path:
        # The wheels turn with the body: h x W.
        wheels = cross([[entry] for entry in scene.rotor], [component[:1] for component in spin])
        derivatives["p"] = plus(derivatives["p"], wheels)
    if "y" in path:
        derivatives["y"] = plus(derivatives["y"], cross(path["x"], flow))
    if "centre" in path:
        derivatives["centre"] = [dot(path[row], flow) for row in ROWS]
    return derivatives


def cross(a: Series, b: Series) -> Vector:
    """Return the last coefficient of a x b; the coefficients of b stand in reverse."""
    return [convolution(a[i - 2], b[i - 1]) - convolution(a[i - 1], b[i - 2]) for i in range(3)]


def dot(a: Series, b: Series) -> Any:
    """Return the last coefficient of a . b; the coefficients of b stand in reverse."""
    return sum(convolution(p, q) for p, q in zip(a, b, strict=True))


def convolution(a: Sequence[Any], b: Sequence[Any]) -> Any:
    """Return a_0 b_k + ... + a_k b_0; the coefficients of b stand in reverse."""
    return sum(map(mul, a, b), mpfr(0))


def plus(a: Vector, b: Vector) -> Vector:
    """Return the sum of two vectors."""
    return [p + q for p, q in zip(a, b, strict=True)]


def _append(series: Series, values: Vector) -> None:
    """Add one coefficient to each component."""
    for component, value in zip(series, values, strict=True):
        component.append(value)
