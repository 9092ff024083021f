"""The equations of motion of changed scenes, for many changes and many arcs at once.

    P = M nu;   P' = C(M) - damping P + rotor x W + (1 + extra) f,   nu' = M^-1 P'

A change is one of a scene: ``mass``, ``rotor``, ``damping``, and ``extra``, the factors of expressions f
in the texts of its loads. An array of states has the axes (parameters, components, arcs). A state has nu
(or the momenta P if ``has_momenta``), then the quaternion and the centre as far as they are asked for.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property, lru_cache
from math import nan
from typing import Any, Final

import numpy as np

from taylor_verify.judge.causes.basis import Basis, basis, coriolis_of, crossed
from taylor_verify.judge.causes.many_flows import Floats
from taylor_verify.judge.causes.many_frames import (
    AFTER,
    BEFORE,
    outer,
    rotations,
    to_body,
    to_space,
)
from taylor_verify.models.acting import Acting, Frame, of_unit_length
from taylor_verify.scenes.loads.grammar import Unread
from taylor_verify.scenes.loads.loads import Loads
from taylor_verify.scenes.loads.steps import NoStep

Changes = Mapping[str, Any]
# The rate of the centre by R, the linear velocity and the current.
Path = Callable[[Any, Floats, Floats], Floats]

# The number of axes that a parameter has without an axis of parameter sets.
_AXES: Final = (
    dict.fromkeys(("mass", "extra"), 2)
    | dict.fromkeys(("rotor", "turns", "load", "held"), 1)
    | dict.fromkeys(("damping", "clock", "ahead", "late", "loss"), 0)
)
# The work of texts, once, for each of their steps, and for each state.
_TEXTS: Final = 55.0
_STEP: Final = 2.5
_TEXTS_OF_ONE: Final = 0.2
# Another number in a text may make a constant that is none: log(0.05 - 1).
_NO_NUMBERS: Final = (NoStep, Unread)
_FRAMED: Final = frozenset({"frame", "turned loads"})


@dataclass(frozen=True)
class Equations:
    """Parameters of the equations of motion.

    ``load`` is the constant load of the scene; ``acting`` are those that it writes as texts; they are read
    ``late`` by so much time, their velocities are those of ``scene_mass``, and they read the values
    ``held``. ``turns`` (b, a) are the weights of q' = (b W q + a q W)/2, where W is omega + ``ahead``
    omega'; ``clock`` multiplies all rates, and the time that texts read. A damped step of h takes the part
    ``loss`` h of the velocities. ``in_world`` takes v for components in space axes, into which the loads
    are turned. ``added`` is the part of ``mass`` that the scene calls added mass; ``energy`` is the
    inverse of ``mass``, where the scene writes that. ``path`` is another rate of the centre; ``frame`` is
    how q is read, whose length may drift.
    """

    mass: Floats
    rotor: Floats
    load: Floats
    extra: Floats
    has_momenta: bool = False
    acting: Acting | None = None
    held: Floats | None = None
    scene_mass: Floats | None = None
    start: float = 0.0
    damping: Any = 0.0
    loss: Any = 0.0
    clock: Any = 1.0
    turns: Floats | None = None
    ahead: Any = 0.0
    late: Any = 0.0
    in_world: bool = False
    added: Floats | None = None
    energy: Floats | None = None
    path: Path | None = None
    frame: Frame = of_unit_length

    @property
    def size(self) -> int:
        """Number of components of nu: 3 or 6."""
        return int(self.mass.shape[-1])

    @property
    def basis(self) -> Basis:
        return basis(self.size)

    @property
    def has_loads(self) -> bool:
        """True if the scene has loads, constant or written as texts."""
        return self.acting is not None or bool(np.any(self.load))

    @property
    def loads(self) -> Loads | None:
        """The loads that the scene writes as texts."""
        return None if self.acting is None else self.acting.written

    @property
    def reads(self) -> int:
        """Number of components of attitude and centre that the texts read."""
        loads = self.loads
        return 0 if loads is None else 4 * loads.reads_attitude + 3 * loads.reads_centre

    @cached_property
    def switches(self) -> Floats:
        """The times between which the loads are smooth."""
        switches = np.array([] if self.loads is None else self.loads.switches, dtype=float)
        late, clock = np.broadcast_arrays(np.ravel(self.late), np.ravel(self.clock))
        return np.unique((switches[:, None] + late) / np.where(clock > 0, clock, 1.0))

    @cached_property
    def current(self) -> Floats:
        """The velocity of the fluid, in space axes."""
        return np.array((0, 0, 0) if self.loads is None else self.loads.current, dtype=float)

    @property
    def own(self) -> int:
        """Number of components of the scene's own states that have rates."""
        return 0 if self.loads is None else len(self.loads.continuous)

    @property
    def coupled(self) -> int:
        """Number of components of the state that the rates of v depend on."""
        return self.size + max(4 * self._reads_frame, self.reads)

    @property
    def _reads_frame(self) -> bool:
        return self.in_world or not _FRAMED.isdisjoint(self._columns)

    @property
    def sets(self) -> int:
        """Number of parameter sets."""
        shapes = [(np.shape(getattr(self, name)), axes) for name, axes in _AXES.items()]
        return max(shape[0] if len(shape) > axes else 1 for shape, axes in shapes)

    def changed(self, changes: Changes) -> Equations:
        """Return the equations with one set of other parameters."""
        return replace(self, **changes)

    def framed(self, frame: Frame) -> Equations:
        """Return the equations that read q in another way."""
        acting = self.acting and _framed(self.acting, frame)
        return replace(self, acting=acting, frame=frame)

    def copies(self, sets: Sequence[Changes]) -> Equations:
        """Return equations with an axis of parameter sets, if there are several.

        A set names the parameters that it changes; all sets have the texts of the first.
        """
        if len(sets) == 1:
            return self.changed(sets[0])
        names = {name for changes in sets for name in changes}
        right = {name: getattr(self, name) for name in names}
        if "turns" in names and self.turns is None:
            right["turns"] = np.array([0.0, 1.0])
        stacked: dict[str, Any] = {
            name: np.array([changes.get(name, right[name]) for changes in sets], dtype=float)
            for name in names - {"acting"}
        }
        if "acting" in names:
            stacked["acting"] = sets[0]["acting"]
        return replace(self, **stacked)

    @cached_property
    def inverse(self) -> Floats:
        return np.asarray(np.linalg.inv(self.mass))

    @cached_property
    def _factors(self) -> Floats:
        """The factors of all expressions in the rates of the momenta."""
        groups, n = self.basis.groups, self.size
        damping = np.asarray(self.damping, dtype=float)[..., None, None]
        products, damped = coriolis_of(self.mass), -damping * self.mass
        wheels = crossed(self.rotor)
        parts = (self.extra, products, damped, wheels)
        axes = np.broadcast_shapes(*(part.shape[:-2] for part in parts))
        factors = np.zeros((*axes, *self.extra.shape[-2:])) + self.extra
        factors[..., groups["products"]] += products
        factors[..., groups["velocities"]] += damped
        factors[..., n - 3 :, groups["velocities"]][..., n - 3 :] += wheels
        if self.has_loads:
            factors[..., groups["loads"]] += np.eye(n)
        else:
            factors[..., groups["loads"].start :] = 0.0
        return factors

    @cached_property
    def _columns(self) -> dict[str, Any]:
        """The columns of each group that have an effect."""
        factors = self._factors
        has_effect = np.any(factors != 0, axis=tuple(range(factors.ndim - 1)))
        columns = {
            name: np.flatnonzero(has_effect[part]) for name, part in self.basis.groups.items()
        }
        return {name: places for name, places in columns.items() if len(places)}

    @cached_property
    def _slopes(self) -> Floats:
        """The factors of the columns that have an effect, in the rates of v."""
        groups = self.basis.groups
        places = [groups[name].start + own for name, own in self._columns.items()]
        factors = self._factors[..., np.concatenate([np.empty(0, dtype=int), *places])]
        return factors if self.has_momenta else self.inverse @ factors

    def rates(self, time: Floats, z: Floats) -> Floats:
        """Return the rates of states with or without a quaternion, a centre, and the scene's own states."""
        n, nu = self.size, self.velocities(time, z)
        R: Any = None
        has_centre = z.shape[1] > n + 4 + self.own
        if has_centre or self._reads_frame:
            R = rotations(z[:, n : n + 4], self.frame)
        moving = self._slopes @ self._expressions(time, z, nu, R)
        if self.loads is not None and self.loads.rotor:
            moving = moving + np.cross(self.wheels(time, z), nu, axis=1)
        out = np.empty((max(len(moving), len(z)), *z.shape[1:]))
        out[:, :n] = moving
        if z.shape[1] > n:
            out[:, n : n + 4] = self._turned(z[:, n : n + 4], nu[:, -3:], moving)
        if has_centre:
            U, current = nu[:, :3], self.current[:, None]
            path = self.path(R, U, current) if self.path else to_space(R, U) + current
            out[:, n + 4 : n + 7] = path
        if self.own and z.shape[1] > n + 4:
            out[:, -self.own :] = self._written("rates", time, z, nu)
        return out if np.ndim(self.clock) == 0 and self.clock == 1 else out * _number(self.clock)

    def velocities(self, time: Floats, z: Floats) -> Floats:
        """Return nu of states, (parameters, components, arcs)."""
        momenta = z[:, : self.size]
        if not self.has_momenta:
            return momenta
        if self.loads is not None and self.loads.rotor:
            momenta = momenta - self.wheels(time, z)
        return np.asarray(self.inverse @ momenta)

    def wheels(self, time: Floats, z: Floats) -> Floats:
        """Return the momentum of wheels that a text writes, of the scene's own states."""
        assert self.acting is not None
        when = _spread(self._times_of_texts(time), (len(z), len(time)))
        return self._read("rotor", when, z.transpose(0, 2, 1), None)

    def price(self, components: int, states: int) -> float:
        """Return the work of the rates of so many states: about one for each microsecond."""
        once = 18.0 + 12.0 * (components > self.size) + 25.0 * self._reads_frame
        each = (0.016 if self._reads_frame else 0.008) * components
        if self.acting is not None:
            steps = 0
            with suppress(*_NO_NUMBERS):
                steps = len(self.acting.written.piece(Fraction(0)).steps)
            once += (_TEXTS + _STEP * steps) * (1 + bool(self.own))
            each += _TEXTS_OF_ONE
        return once + each * states

    def _expressions(self, time: Floats, z: Floats, nu: Floats, R: Any) -> Floats:
        """Return the values of the expressions that have an effect, (parameters, columns, arcs)."""
        loads = None
        if not {"loads", "turned loads"}.isdisjoint(self._columns):
            loads = self.loads_at(time, z, nu)
        sets, begin = max(len(each) for each in (nu, R, loads) if each is not None), 0
        values = np.empty((sets, self._slopes.shape[-1], z.shape[2]))
        for name, columns in self._columns.items():
            end = begin + len(columns)
            values[:, begin:end] = self._values(name, columns, nu, R, loads)
            begin = end
        return values

    def _values(self, name: str, columns: Any, nu: Floats, R: Any, loads: Any) -> Any:
        """Return some expressions of a group; R and the loads are known where the group needs them."""
        match name:
            case "constants":
                return 1.0
            case "velocities":
                return nu[:, columns]
            case "products":
                j, k = self._factors_of_products
                return nu[:, j] * nu[:, k]
            case "squares":
                return np.abs(nu[:, columns]) * nu[:, columns]
            case "speeds":
                vectors = nu.reshape(len(nu), -1, 3, nu.shape[2])
                speeds = np.repeat(np.linalg.norm(vectors, axis=2), 3, axis=1)
                return (speeds * nu)[:, columns]
            case "frame":
                return R.reshape(len(R), 9, -1)[:, columns]
            case "loads":
                return (to_space(R, loads) if self.in_world else loads)[:, columns]
        return to_body(R, loads)[:, columns]

    @cached_property
    def _factors_of_products(self) -> Floats:
        """The places of both factors of each product that has an effect."""
        return np.transpose(self.basis.pairs)[:, self._columns["products"]]

    def loads_at(self, time: Floats, z: Floats, nu: Floats) -> Floats:
        """Return the loads of the scene, (parameters, components, arcs)."""
        load = np.asarray(self.load)
        constant = np.asarray(load if load.ndim == 3 else load[None, :, None], dtype=float)
        if self.acting is None:
            return constant
        return np.asarray(constant + self._written("loads", time, z, nu))

    def _written(self, what: str, time: Floats, z: Floats, nu: Floats) -> Floats:
        """Return the loads, or the rates of own states, that the scene writes as texts."""
        state, when = self.states_of_texts(z, nu), self._times_of_texts(time)
        when = _spread(when, (max(len(when), len(state)), len(time)))
        state = _spread(state, (*when.shape, state.shape[2]))
        taken = self.held
        if taken is not None:
            taken = _spread(np.atleast_2d(taken)[:, None], (*when.shape, taken.shape[-1]))
        return self._read(what, when, state, taken)

    def _read(self, what: str, when: Floats, state: Floats, taken: Floats | None) -> Floats:
        """Return values of texts, (parameters, components, arcs)."""
        read, values = getattr(self.acting, what), None
        if when.size == 1:
            # Floats are ten times as fast as arrays of one number; what they refuse is no number there.
            inputs = [] if taken is None else [taken[0, 0]]
            with suppress(ArithmeticError, ValueError):
                values = read(when[0, 0], state[0, 0], *inputs)
        if values is None:
            count = {"rates": self.own, "rotor": 3}.get(what, self.size)
            values = np.full((*when.shape, count), nan)
            with suppress(*_NO_NUMBERS):
                values = read(when, state, *([] if taken is None else [taken]))
        return np.asarray(values).reshape(*when.shape, -1).transpose(0, 2, 1)

    def _times_of_texts(self, time: Floats) -> Floats:
        """Return the times at which texts are read, (parameters or 1, arcs)."""
        late, clock = (
            np.asarray(each, dtype=float).reshape(-1, 1) for each in (self.late, self.clock)
        )
        return np.asarray(self.start + clock * time - late)

    def states_of_texts(self, z: Floats, nu: Floats) -> Floats:
        """Return states as the texts of the scene read them, (parameters, arcs, components)."""
        n, mass = self.size, self.scene_mass
        moving = nu if n == 3 or mass is None else mass @ nu
        sets = max(len(moving), len(z))
        both = (_spread(each, (sets, *each.shape[1:])) for each in (moving, z[:, n:]))
        return np.concatenate([*both], axis=1).transpose(0, 2, 1)

    def _turned(self, q: Floats, W: Floats, moving: Floats) -> Floats:
        """Return the rates of the quaternion."""
        if np.any(self.ahead):
            acceleration = self.inverse @ moving if self.has_momenta else moving
            W = W + _number(self.ahead) * acceleration[:, -3:]
        return np.asarray(self._turning @ outer(q, W))

    @cached_property
    def _turning(self) -> Floats:
        """The factors of q_i W_j in the rates of q, (..., 4, 12)."""
        before, after = np.moveaxis(np.array([0, 1]) if self.turns is None else self.turns, -1, 0)
        both = before[..., None, None] * BEFORE + after[..., None, None] * AFTER
        return np.asarray(both)


@lru_cache(maxsize=8)
def _framed(acting: Acting, frame: Frame) -> Acting:
    return acting.framed(frame)


def _spread(array: Floats, shape: tuple[int, ...]) -> Floats:
    """Return an array of some shape; to broadcast it where it has that already takes long."""
    return array if array.shape == shape else np.broadcast_to(array, shape)


def _number(value: Any) -> Floats:
    """Return a number, or one for each parameter set, with the axes of an array of states."""
    return np.asarray(value, dtype=float).reshape(-1, 1, 1)
