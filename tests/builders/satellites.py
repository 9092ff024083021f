"""Random satellites: free rigid bodies in their principal axes, drawn from a seed."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Final

import numpy as np
from taylor_verify.models.bodies import Bodies, numbers

from taylor_verify.scenes.bodies import RigidBody
from taylor_verify.scenes.instants import EquallySpaced
from taylor_verify.scenes.motion import Clock, Spin
from taylor_verify.scenes.scene import Scene
from taylor_verify.scenes.tensors import diagonal

_CLOCK: Final = Clock(Fraction(0), EquallySpaced(Fraction(0), Fraction(1), 41))


def satellites(count: int, seed: int, tracks_attitude: bool = False) -> list[Scene]:
    """Return satellites whose moments obey the triangle inequality, turning by some dozens of radians."""
    draw = np.random.default_rng(seed)
    scenes = []
    for k in range(count):
        a, b, c = draw.uniform(0.2, 2, 3)
        end = _short(draw.uniform(20, 60))
        scenes.append(
            satellite(
                f"satellite{k}",
                (_short(b + c), _short(c + a), _short(a + b)),
                tuple(map(_short, draw.normal(size=3))),
                tuple(map(_short, draw.normal(size=4))) if tracks_attitude else None,
                Clock(Fraction(0), EquallySpaced(Fraction(0), end / 40, 41)),
            )
        )
    return scenes


def satellite(
    name: str,
    moments: tuple[Fraction, Fraction, Fraction],
    omega: tuple[Fraction, ...],
    attitude: tuple[Fraction, ...] | None = None,
    clock: Clock = _CLOCK,
) -> Scene:
    """Return the scene of one satellite, which tracks its attitude if there is one."""
    start = Spin(omega) if attitude is None else Spin(omega, attitude)
    track = frozenset[str]() if attitude is None else frozenset({"attitude"})
    return Scene(name, name, "euler", track, RigidBody(diagonal(moments)), start, clock)


def near_the_separatrix() -> list[Scene]:
    """Return bodies on both sides of their separatrices, with nomes from 0.3 to 0.43."""
    spins = ("0.576", "0.577", "0.5773", "0.5774", "0.5775", "0.578")
    attitude = tuple(map(Fraction, ("0.3", "-0.7", "0.45", "1.1")))
    moments = Fraction(1), Fraction(2), Fraction(3)
    return [
        satellite(spin, moments, (Fraction(1), Fraction("0.3"), Fraction(spin)), attitude)
        for spin in spins
    ]


def bodies_of(scenes: Sequence[Scene]) -> Bodies:
    """Return the bodies of scenes that are sampled equally often."""
    rows = [numbers(scene) for scene in scenes]
    times = np.array([[float(t) for t in scene.clock.elapsed] for scene in scenes])
    K, H, q = (np.array(values).T for values in zip(*rows, strict=True))
    return Bodies(K, H, times, q)


def _short(value: float) -> Fraction:
    return Fraction(round(value * 10**4), 10**4)
