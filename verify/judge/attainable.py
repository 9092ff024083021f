"""What perfect rounding would leave: the floor under every solver that works on a rung.

A solver that rounds each step to the nearest commits, at step k, an error of about u |state(t_k)|
in a random direction. The orbit's own transition matrix Phi carries it on, so that after N steps

    attainable(t) = u [ sum_k |Phi(t, t_k)|^2 |state(t_k)|^2 ]^(1/2).

For a conserved quantity the gradient takes the place of Phi, because the orbit carries a change of
it unchanged. This is a model of independent roundings, not a bound; gates leave a factor for it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from typing import Any

import numpy as np

from verify.exact.condition import Transition, transition
from verify.exact.invariants import Invariant
from verify.judge.errors import Errors, norms
from verify.scenes import tensors
from verify.scenes.bodies import RigidBody
from verify.scenes.motion import Motion
from verify.scenes.scene import Scene

Floats = np.ndarray[Any, np.dtype[np.float64]]

# More nodes than this refine the sum over the steps by nothing that shows in two digits.
_MOST_NODES = 41
# Below this floor, rounding the scene's data moves the orbit too little to change its condition.
_SAME_ORBIT = 1e-3
# A rounding of the components of a unit quaternion turns the frame by twice as much.
_ATTITUDE_SIZE = 2.0


@dataclass(frozen=True)
class Floor:
    """Everything needed to say what is attainable on one run.

    ``nodes`` are indices of samples; the roundings of the steps between two nodes are injected at
    the later one, ``steps_at[k]`` of them. ``sizes`` holds |block| at each node.
    """

    unit_roundoff: float
    samples: int
    nodes: tuple[int, ...]
    steps_at: Floats
    sizes: Mapping[str, Floats]
    orbit: Transition

    def of_state(self, errors: Errors) -> Floats:
        """The attainable error at every sample, in the unit of the errors; the larger part counts."""
        parts = [self._of_part(part) / float(scale) for part, scale in errors.parts.items()]
        return self._at_samples(np.max(parts, axis=0))

    def of_invariant(self, invariant: Invariant, motion: Motion, scale: Any) -> Floats:
        """The attainable drift at every sample, over the invariant's scale."""
        gradients = invariant.sensitivity(motion)
        injected = np.zeros(len(self.nodes))
        for block, gradient in gradients.items():
            at_nodes = np.array([float(gradient[k]) for k in self.nodes])
            injected += (at_nodes * self.sizes[block]) ** 2
        drift = self.unit_roundoff * np.sqrt(np.cumsum(self.steps_at * injected))
        return self._at_samples(drift / float(scale))

    def reason(self, attainable: Floats, sample: int, carried: str) -> str:
        """The arithmetic of the floor at one sample, in one sentence."""
        steps = round(float(np.sum(self.steps_at[: np.searchsorted(self.nodes, sample) + 1])))
        floor_there = float(attainable[sample])
        growth = floor_there / (self.unit_roundoff * steps**0.5)
        what = "the orbit's transition matrix" if carried == "orbit" else "the gradient"
        return (
            f"attainable = u sqrt(N) x growth = {self.unit_roundoff:.2g} x sqrt({steps}) x "
            f"{growth:.3g} = {floor_there:.2g}: one rounding a step, carried by {what}"
        )

    def _of_part(self, part: str) -> Floats:
        carried = np.zeros(len(self.nodes))
        for block, size in self.sizes.items():
            growth = self.orbit.norms(part, block)
            carried += (growth**2) @ (self.steps_at * size**2)
        return self.unit_roundoff * np.sqrt(carried)

    def _at_samples(self, at_nodes: Floats) -> Floats:
        """Between two nodes the larger of both."""
        samples = np.arange(self.samples)
        later = np.searchsorted(self.nodes, samples)
        earlier = np.searchsorted(self.nodes, samples, side="right") - 1
        return np.maximum(at_nodes[later], at_nodes[np.maximum(earlier, 0)])


def floor(given: Scene, asked: Scene, truth: Motion, unit_roundoff: Fraction, steps: int) -> Floor:
    """The floor for a run of ``steps`` steps on the rounded scene ``given``.

    The condition of the orbit is that of the scene as asked, computed once for all rungs, unless the
    rounding of the data moves the orbit so much that the rounded one needs a condition of its own.
    """
    nodes = _nodes(len(given.clock.instants))
    shared = _floor(given, asked, nodes, truth, unit_roundoff, steps)
    if _worst(shared, asked) <= _SAME_ORBIT:
        return shared
    return _floor(given, given, nodes, truth, unit_roundoff, steps)


def _floor(
    given: Scene,
    conditioned: Scene,
    nodes: tuple[int, ...],
    truth: Motion,
    unit_roundoff: Fraction,
    steps: int,
) -> Floor:
    elapsed = given.clock.elapsed
    return Floor(
        unit_roundoff=float(unit_roundoff),
        samples=len(elapsed),
        nodes=nodes,
        steps_at=_steps_at([elapsed[k] for k in nodes], steps),
        sizes=_sizes(given, truth, nodes),
        orbit=_orbit(conditioned, tuple(conditioned.clock.elapsed[k] for k in nodes)),
    )


def condition(scene: Scene) -> Transition:
    """How errors travel along the scene's own orbit: what the floor of its runs was made with."""
    elapsed = scene.clock.elapsed
    return _orbit(scene, tuple(elapsed[k] for k in _nodes(len(elapsed))))


@lru_cache(maxsize=64)
def _orbit(scene: Scene, elapsed: tuple[Fraction, ...]) -> Transition:
    return transition(scene, elapsed)


def _worst(found: Floor, scene: Scene) -> float:
    """The largest attainable error of the motion, relative to its own size."""
    parts = ("omega",) if scene.model == "euler" else ("linear_impulse", "angular_impulse")
    blocks = ("momentum",) if scene.model == "euler" else parts
    scales = [float(np.max(found.sizes[block])) for block in blocks]
    if scene.model == "euler":
        body = scene.body
        assert isinstance(body, RigidBody)
        scales = [scales[0] * float(min(_diagonal(body.inverse_inertia)))]
    worst = [
        float(np.max(found._of_part(part))) / (scale or 1.0)
        for part, scale in zip(parts, scales, strict=True)
    ]
    return max(worst)


def _diagonal(matrix: tensors.Matrix) -> list[Fraction]:
    return [matrix[i][i] for i in range(3)]


def _nodes(samples: int) -> tuple[int, ...]:
    """Evenly chosen samples, first and last among them."""
    count = min(samples, _MOST_NODES)
    return tuple(sorted({round(k * (samples - 1) / max(count - 1, 1)) for k in range(count)}))


def _steps_at(elapsed: Sequence[Fraction], steps: int) -> Floats:
    """The steps up to each node since the one before, in proportion to time; never less than one."""
    span = elapsed[-1] or Fraction(1)
    shares = np.diff([float(t / span) for t in elapsed], prepend=0.0)
    found: Floats = np.maximum(1.0, shares * max(steps, len(elapsed)))
    return found


def _sizes(scene: Scene, truth: Motion, nodes: Sequence[int]) -> dict[str, Floats]:
    """|block| at the nodes."""

    def at_nodes(rows: Any) -> Floats:
        return np.array([float(value) for value in norms(rows[list(nodes)])])

    sizes = {}
    if isinstance(scene.body, RigidBody):
        inertia = np.array([[float(v) for v in row] for row in scene.body.inertia])
        omega = truth["omega"].astype(float)
        sizes["momentum"] = at_nodes(omega @ inertia.T)
    else:
        sizes["linear_impulse"] = at_nodes(truth["linear_impulse"])
        sizes["angular_impulse"] = at_nodes(truth["angular_impulse"])
    if "attitude" in scene.track:
        sizes["attitude"] = np.full(len(nodes), _ATTITUDE_SIZE)
    if "centre" in scene.track:
        sizes["centre"] = at_nodes(truth["centre"])
    return sizes
