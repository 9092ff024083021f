"""Methods whose step needs more than the state: replayed from the start, one step after the other.

Over an arc the state is led back to where it was a step before: that tells the number of steps.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from itertools import pairwise, product
from typing import Any, Final

import numpy as np

from taylor_verify.judge.causes.changed_equations import Equations
from taylor_verify.judge.causes.float_answer import Answer, Motion
from taylor_verify.judge.causes.many_flows import Floats
from taylor_verify.judge.causes.many_frames import rotations, to_space
from taylor_verify.judge.causes.proof import LEAVES
from taylor_verify.judge.causes.replayed_methods import (
    METHODS,
    UPDATES,
    Method,
    with_unit_attitude,
)

# A step (equations, time, z, h, memory) with the memory for the next one; there is none at first.
_Step = Callable[[Equations, Floats, Floats, Floats, Any], tuple[Floats, Any]]


def _adams_bashforth(
    equations: Equations, time: Floats, z: Floats, h: Floats, before: Any
) -> tuple[Floats, Any]:
    rates = equations.rates(time, z)
    return z + h * (1.5 * rates - 0.5 * (rates if before is None else before)), rates


def _begun_by(
    first: str, equations: Equations, time: Floats, z: Floats, h: Floats, before: Any
) -> tuple[Floats, Any]:
    """Return a step of Adams and Bashforth's method whose first one is that of another method."""
    if before is None:
        return METHODS[first].step(equations, time, z, h), equations.rates(time, z)
    return _adams_bashforth(equations, time, z, h, before)


def _over_an_arc(equations: Equations, time: Floats, z: Floats, h: Floats) -> Floats:
    """Return a step of Adams and Bashforth's method from a state that moved exactly before."""
    earlier = METHODS["RK4"].step(equations, time, z, -h)
    return _adams_bashforth(equations, time, z, h, equations.rates(time - h, earlier))[0]


def runs(*steps: _Step) -> Callable[..., Motion | None]:
    """Return the motion that is nearest to an answer, of some ways to begin a method or to turn."""

    def run(answer: Answer, equations: Equations, h: float, components: int) -> Motion | None:
        nearest, least = None, (True, np.inf)
        with answer.budget.share(1 / 2):
            for step in steps:
                motion = _run(step, answer, equations, h, components)
                left = answer.leaves(motion)
                is_off = max(left[name] for name in answer.moving) >= LEAVES
                if (is_off, max(left.values())) < least:
                    nearest, least = motion, (is_off, max(left.values()))
                if least[1] < LEAVES:
                    break
        return nearest

    return run


def never_of_unit_length(method: Method) -> Method:
    """Return a method that leaves q as long as it becomes, which loads tell that read it as it is."""

    def step(
        equations: Equations, time: Floats, z: Floats, h: Floats, before: Any
    ) -> tuple[Floats, Any]:
        return method.step(equations, time, z, h), None

    def run(answer: Answer, equations: Equations, h: float, components: int) -> Motion:
        framed = equations.framed(method.frame or equations.frame)
        return _run(step, answer, framed, h, components, is_unit=False)

    return replace(method, run=run)


def _run(
    step: _Step,
    answer: Answer,
    equations: Equations,
    h: float,
    components: int,
    is_unit: bool = True,
) -> Motion:
    """Return the motion of steps of h, or a little less or more so that they end at each row."""
    n, all_ = answer.n, answer.with_start(equations.mass)
    frame = [part[0] for part in (answer.start.q, answer.start.c) if part is not None]
    z = np.concatenate([answer.first(equations.mass), *frame])[:components][None, :, None]
    rows, memory, price = [z], None, equations.price(components, 1)
    for begin, end in pairwise(all_.times.tolist()):
        count = max(1, round(abs(end - begin) / h))
        own = np.array([(end - begin) / count])
        answer.budget.spend(count * price)
        for k in range(count):
            z, memory = step(equations, begin + k * own, z, own, memory)
            if components > n and is_unit:
                z = with_unit_attitude(z, n)
        rows.append(z)
    made = np.concatenate(rows)[:, :, 0]
    if components > n:
        made = with_unit_attitude(made, n)
    q, c = made[:, n : n + 4], made[:, n + 4 : n + 7]
    motion = Motion(made[:, :n], q if q.size else None, c if c.size else None)
    return motion if answer.is_from_start else motion.at(np.s_[1:])


_ADAMS_BASHFORTH: Final = Method(
    2,
    _over_an_arc,
    has_frame=True,
    run=runs(_adams_bashforth, *(partial(_begun_by, name) for name in ("midpoint", "RK4"))),
)

# Added mass by accelerations that are known already, as plug-ins of simulators have it, who know the
# force of the fluid alone: that of the step before, or a filtered one (uuv_simulator has this number).
_FILTERS: Final = (
    ("added mass by the acceleration of the step before", 1.0),
    ("added mass by the accelerations of the steps before, low-pass with 0.3", 0.3),
)
_ENDS: Final = (
    "turned by the rate at the end of the step",
    "q + h q omega / 2 with the rate at the end",
)


def with_memory(right: Equations) -> dict[str, Method]:
    """Return the methods of a body whose step needs more than the state, by name."""
    methods = {"Adams-Bashforth 2": _ADAMS_BASHFORTH}
    if right.size != 6 or right.has_momenta or right.added is None or not np.any(right.added):
        return methods
    turns = ("", *_ENDS)
    # Where no load reads the attitude, the velocities do not tell how it turns.
    for (name, weight), some in product(
        _FILTERS, [turns] if right.coupled == right.size else [(turn,) for turn in turns]
    ):
        words = f"{name}, explicit Euler" + (f", attitude {some[0]}" if some[0] else "")
        ways = [partial(_with_acceleration, UPDATES.get(turn)) for turn in some]
        each = [partial(_lagging, *way, weight) for way in product((1.0, 0.0), ways)]
        over = partial(_lagging_over_an_arc, ways[0], weight)
        methods[words] = Method(1, over, has_frame=True, run=runs(*each))
    return methods


def _lagging(
    is_known: float,
    moved: Any,
    weight: float,
    equations: Equations,
    time: Floats,
    z: Floats,
    h: Floats,
    before: Any,
) -> tuple[Floats, Any]:
    """Return a step by the filtered acceleration of the steps before; at first it is known, or 0."""
    n, rates = equations.size, equations.rates(time, z)
    before = is_known * rates[:, :n] if before is None else before
    load = equations.mass @ rates[:, :n] - _added(equations) @ before
    own = np.linalg.inv(equations.mass - _added(equations)) @ load
    return moved(equations, z, rates, own, h), (1 - weight) * before + weight * own


def _lagging_over_an_arc(
    moved: Any, weight: float, equations: Equations, time: Floats, z: Floats, h: Floats
) -> Floats:
    """Return a step by the acceleration of so many steps before as a filter is late by."""
    n, rates, late = equations.size, equations.rates(time, z), h / weight
    earlier = METHODS["RK4"].step(equations, time, z, -late)
    change = (rates - equations.rates(time - late, earlier))[:, :n]
    own = rates[:, :n] + equations.inverse @ (_added(equations) @ change)
    return np.asarray(moved(equations, z, rates, own, h))


def _added(equations: Equations) -> Floats:
    assert equations.added is not None
    return equations.added


def _with_acceleration(
    update: Any, equations: Equations, z: Floats, rates: Floats, own: Floats, h: Floats
) -> Floats:
    """Return z after an explicit step by an acceleration; with an update the frame has its end's rates."""
    n, after = equations.size, z + h * rates
    after[:, :n] = z[:, :n] + h * own
    if update is not None and z.shape[1] > n:
        q = z[:, n : n + 4]
        after[:, n : n + 4] = update(q, z[:, 3:n], after[:, 3:n], h)
        moving = to_space(rotations(q), after[:, :3]) + equations.current[:, None]
        after[:, n + 4 :] = z[:, n + 4 :] + h * moving[:, : z.shape[1] - n - 4]
    return after
