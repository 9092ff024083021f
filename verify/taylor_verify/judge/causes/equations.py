"""The equations of motion with every fault as a parameter, for many parameters and arcs at once.

    P = M nu;  P' = clock (x_t x W + X, y x W + x_m x U + L) - damping P,   nu' = M^-1 P'
    x_t = turn nu,  y = gyro nu + rotor,  x_m = munk nu

nu is omega of a rigid body, or (U, W) in a fluid. In the right equations ``turn``, ``gyro`` and ``munk``
are rows of the mass matrix M. A state has the components v (nu, or the momenta P if ``has_momenta``),
then the quaternion and the centre as far as they are asked for; the axes of an array of states are
(parameters, components, arcs). A parameter may have an axis of parameter sets in front.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Final

import numpy as np

from taylor_verify.judge.causes.flow import Floats
from taylor_verify.models.acting import Acting
from taylor_verify.models.algebra import ABSENT, add, cross
from taylor_verify.models.frame import attitude_rate, centre_rate, rotation
from taylor_verify.models.kirchhoff import impulse_rates

Changes = Mapping[str, Any]

# The number of axes that a parameter has without an axis of parameter sets.
_AXES: Final = {
    **dict.fromkeys(("mass", "turn", "gyro", "munk"), 2),
    **dict.fromkeys(
        ("rotor", "load", "weights", "space", "arm", "linear", "quadratic", "turns"), 1
    ),
    **dict.fromkeys(("damping", "clock", "ahead", "late", "in_space"), 0),
}


@dataclass(frozen=True)
class Equations:
    """Parameters of the equations of motion.

    ``load`` is constant in body axes, ``space`` in space axes, ``arm`` x R^T e3 is a couple; ``linear``
    and ``quadratic`` are drags on each component of nu. ``acting`` are the loads that the scene writes as
    texts, read ``late`` by so much time; all loads of the scene are multiplied by ``weights``, and are
    those in space axes if ``in_space`` is 1. ``turns`` (b, a) are the weights of q' = (b W q + a q W)/2,
    where W is omega + ``ahead`` omega'. ``current`` moves the centre.
    """

    mass: Floats
    gyro: Floats
    turn: Floats
    munk: Floats
    rotor: Floats
    load: Floats
    has_momenta: bool = False
    acting: Acting | None = None
    reads: int = 0
    scene_mass: Floats | None = None
    start: float = 0.0
    current: Floats | None = None
    switches: Floats | None = None
    weights: Floats | None = None
    space: Floats | None = None
    arm: Floats | None = None
    linear: Floats | None = None
    quadratic: Floats | None = None
    damping: Any = 0.0
    clock: Any = 1.0
    turns: Floats | None = None
    ahead: Any = 0.0
    late: Any = 0.0
    in_space: Any = 0.0

    @classmethod
    def of_mass(cls, mass: Floats, rotor: Floats) -> Equations:
        """Return the right equations of a free body with wheels of this momentum."""
        rows = mass[:3]
        return cls(mass, mass[-3:], rows, rows, rotor, np.zeros(len(mass)), scene_mass=mass)

    @property
    def size(self) -> int:
        """Number of components of nu: 3 or 6."""
        return int(self.mass.shape[-1])

    @property
    def coupled(self) -> int:
        """Number of components of the state that the rates of v depend on."""
        return self.size + max(4 * self._has_frame, self.reads)

    @property
    def _has_frame(self) -> bool:
        return self.space is not None or self.arm is not None or "in_space" in self._has

    @property
    def sets(self) -> int:
        """Number of parameter sets."""
        return max(
            len(value) if np.ndim(value := getattr(self, name)) > axes else 1
            for name, axes in _AXES.items()
        )

    @cached_property
    def inverse(self) -> Floats:
        return np.asarray(np.linalg.inv(self.mass))

    @cached_property
    def _has(self) -> frozenset[str]:
        """The names of the parameters that have an effect."""
        plain = {
            "clock": 1.0,
            **dict.fromkeys(("damping", "ahead", "rotor", "load", "in_space"), 0.0),
        }
        return frozenset(n for n, v in plain.items() if np.any(np.asarray(getattr(self, n)) != v))

    def changed(self, changes: Changes) -> Equations:
        """Return the equations with one set of other parameters."""
        return replace(self, **changes)

    def copies(self, sets: Sequence[Changes]) -> Equations:
        """Return equations with an axis of parameter sets; a set names the parameters that it changes."""
        stacked: dict[str, Any] = {}
        for name in {name for changes in sets for name in changes}:
            values = [changes.get(name, getattr(self, name)) for changes in sets]
            shape = np.shape(next(value for value in values if value is not None))
            plain = {"weights": np.ones(shape), "turns": np.array([0.0, 1.0])}
            empty = plain.get(name, np.zeros(shape))
            filled = [empty if value is None else value for value in values]
            stacked[name] = np.array(filled, dtype=float)
        return replace(self, **stacked)

    def rates(self, time: Floats, z: Floats) -> Floats:
        """Return the rates of states with or without a quaternion and a centre."""
        n, count = self.size, z.shape[1]
        nu = self.inverse @ z[:, :n] if self.has_momenta else z[:, :n]
        momentum = self._forces(time, z, nu)
        out = np.empty((max(len(momentum), len(z)), *z.shape[1:]))
        acceleration = None
        if not self.has_momenta or "ahead" in self._has:
            acceleration = self.inverse @ momentum
        out[:, :n] = momentum if self.has_momenta else acceleration
        if count > n:
            q, W = _parts(z[:, n : n + 4]), _parts(nu[:, -3:])
            if acceleration is not None and "ahead" in self._has:
                W = _parts(nu[:, -3:] + _number(self.ahead) * acceleration[:, -3:])
            for i, component in enumerate(self._turned(q, W)):
                out[:, n + i] = component
        if count > n + 4:
            for i, component in enumerate(centre_rate(_parts(z[:, n : n + 4]), _parts(nu[:, :3]))):
                out[:, n + 4 + i] = (
                    component if self.current is None else component + self.current[i]
                )
        return out * _number(self.clock) if "clock" in self._has else out

    @cached_property
    def _has_loads(self) -> bool:
        parts = (self.acting, self.space, self.arm, self.linear, self.quadratic)
        return "load" in self._has or any(part is not None for part in parts)

    def _forces(self, time: Floats, z: Floats, nu: Floats) -> Floats:
        """Return the rates of the momenta without the factor of the clock."""
        n = self.size
        W, turning = _parts(nu[:, -3:]), self.gyro @ nu
        y = _parts(turning + _column(self.rotor) if "rotor" in self._has else turning)
        load = self._loads(time, z, nu)
        if n == 3:
            rates = add(cross(y, W), load)
        else:
            x, U = _parts(self.turn @ nu), _parts(nu[:, :3])
            of_x, of_y = impulse_rates(x, y, U, W, load[:3], load[3:])
            if self.munk is not self.turn:
                apart = _parts((self.munk - self.turn) @ nu)
                of_y = add(of_y, cross(apart, U))
            rates = [*of_x, *of_y]
        total = _stacked(rates)
        if "damping" in self._has:
            momentum = z[:, :n] if self.has_momenta else self.mass @ nu
            total = total - _number(self.damping) * momentum
        return total

    def _loads(self, time: Floats, z: Floats, nu: Floats) -> list[Any]:
        """Return the components of all loads but damping, body axes."""
        n = self.size
        total: Any = _column(self.load)
        if not self._has_loads:
            return [ABSENT] * n
        if self.acting is not None:
            total = total + self._written(time, z, nu)
        if self.weights is not None:
            total = total * _column(self.weights)
        if z.shape[1] > n and self._has_frame:
            q = z[:, n : n + 4]
            R = rotation(_parts(q / np.sqrt(np.sum(q * q, axis=1, keepdims=True))))
            if "in_space" in self._has:
                vectors = np.broadcast_to(total, (len(total), n, z.shape[2]))
                total = total + _number(self.in_space) * (_to_body(R, vectors) - total)
            if self.space is not None:
                total = total + _to_body(R, _column(self.space))
            if self.arm is not None:
                couple = np.stack(cross(_parts(_column(self.arm)), R[2]), axis=1)
                total = total + (couple if n == 3 else np.concatenate([0 * couple, couple], axis=1))
        if self.linear is not None:
            total = total - _column(self.linear) * nu
        if self.quadratic is not None:
            total = total - _column(self.quadratic) * np.abs(nu) * nu
        return _parts(total)

    def _written(self, time: Floats, z: Floats, nu: Floats) -> Floats:
        """Return the loads that are texts, (parameters, components, arcs)."""
        assert self.acting is not None
        n, late = self.size, np.asarray(self.late, dtype=float).reshape(-1, 1)
        moving = nu if n == 3 or self.scene_mass is None else self.scene_mass @ nu
        state = np.concatenate([moving, z[:, n:]], axis=1).transpose(0, 2, 1)
        when = np.broadcast_to(self.start + time - late, (max(len(late), len(state)), len(time)))
        values = self.acting.loads(when, np.broadcast_to(state, (*when.shape, state.shape[2])))
        stacked = values if n == 3 else np.concatenate(values, axis=-1)
        return np.asarray(stacked).transpose(0, 2, 1)

    def _turned(self, q: list[Floats], W: list[Floats]) -> list[Any]:
        right = attitude_rate(q, W)
        if self.turns is None:
            return right
        weights = np.asarray(self.turns, dtype=float)
        conjugate = [q[0], -q[1], -q[2], -q[3]]
        # W q is the conjugate of q* W*, and W* = -W.
        r0, *r = attitude_rate(conjugate, [-w for w in W])
        left = [r0, *(-component for component in r)]
        before, after = _number(weights[..., 0])[..., 0], _number(weights[..., 1])[..., 0]
        return [before * a + after * b for a, b in zip(left, right, strict=True)]


def _parts(rows: Floats) -> list[Floats]:
    """Return the components, each (parameters, arcs)."""
    return [rows[:, i] for i in range(rows.shape[1])]


def _column(vector: Floats) -> Floats:
    """Return (components,) or (parameters, components) with the axes of an array of states."""
    if np.ndim(vector) == 3:
        return vector
    return vector[..., :, None] if np.ndim(vector) == 2 else vector[None, :, None]


def _number(value: Any) -> Floats:
    """Return a number, or one for each parameter set, with the axes of an array of states."""
    return np.asarray(value, dtype=float).reshape(-1, 1, 1)


def _to_body(R: list[list[Any]], vectors: Floats) -> Floats:
    """Return R^T v for every vector of three components."""
    turned = [
        sum(R[k][i] * vectors[:, first + k] for k in range(3))
        for first in range(0, vectors.shape[1], 3)
        for i in range(3)
    ]
    return _stacked(turned)


def _stacked(parts: Sequence[Any]) -> Floats:
    """Return components (parameters or 1, arcs) as one array."""
    sets, arcs = max(len(part) for part in parts), max(part.shape[1] for part in parts)
    stacked = np.empty((sets, len(parts), arcs))
    for i, part in enumerate(parts):
        stacked[:, i] = part
    return stacked
