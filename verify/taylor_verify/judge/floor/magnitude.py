"""The rounding of one step in each component of a state, from the magnitudes of the terms of its rate.

    r_i = |x_i| + h S_i(x)

S_i is the rate of x_i with every term in absolute value and every difference replaced by a sum. Arithmetic
that rounds each operation to within u has an error of about u S_i in the rate, even if terms cancel. The
equations of models are evaluated with numbers whose difference is a sum. Numbers that depend on the body's
data alone are computed as usual, with cancellation.

A solver whose state is the velocities (U, Omega) of a solid in a fluid rounds these. By (x, y) = M (U,
Omega) this changes x_i by u m_i, with

    m_i = [ sum over j of (M_ij V_j)^2 ]^(1/2),  V = (U, Omega),

which is |x_i| where M is diagonal, and more where terms of M V cancel.

H, x, y  momenta    q  quaternion    c  centre    h  length of a step
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any, Final

import numpy as np

from taylor_verify.exact.conditioning.condition import Path
from taylor_verify.judge.floor.loads import Along
from taylor_verify.models.algebra import is_absent
from taylor_verify.models.problem import Problem, pose
from taylor_verify.numbers import tensors
from taylor_verify.numbers.precision import Rung
from taylor_verify.records.precisions import FORMATS
from taylor_verify.records.quantities import COLUMNS
from taylor_verify.scenes.bodies import Body
from taylor_verify.scenes.motion import Clock
from taylor_verify.scenes.scene import Scene

Floats = np.ndarray[Any, np.dtype[np.float64]]

# Root mean square of the components of a unit quaternion.
_COMPONENT: Final = 0.5
# A change of a unit quaternion turns the frame by twice as much, in radians.
_ANGLE: Final = 2.0
_QUATERNION: Final = ("e0", "e1", "e2", "e3")
_COMPONENTS: Final = {
    "momentum": ("H1", "H2", "H3"),
    **{name: COLUMNS[name] for name in ("linear_impulse", "angular_impulse", "centre")},
}


@dataclass(frozen=True)
class Magnitude:
    """The sum of the magnitudes of an expression's terms, as rows of nonnegative numbers."""

    size: Any

    # NumPy leaves operations with this class to the class.
    __array_ufunc__ = None

    def __add__(self, other: Any) -> Magnitude:
        return Magnitude(self.size + _size(other))

    __radd__ = __sub__ = __rsub__ = __add__

    def __neg__(self) -> Magnitude:
        return self

    def __mul__(self, other: Any) -> Magnitude:
        return Magnitude(self.size * _size(other))

    __rmul__ = __mul__

    def __truediv__(self, other: Any) -> Magnitude:
        return Magnitude(self.size / _size(other))


def _size(term: Any) -> Any:
    return term.size if isinstance(term, Magnitude) else abs(term)


def roundings(given: Scene, path: Path, bits: int, steps: int, velocities: bool = False) -> Floats:
    """Return r at every time of the path, shape (n, components), in the path's units.

    The length of a step is the span over the number of steps, but at most the time in which the terms of
    the rates add up to the state, because a longer step does as much work inside. A rounding of a
    quaternion turns the frame about all axes equally. With ``velocities`` m_i replaces |x_i| where it is
    larger.
    """
    problem = _posed(given, path, bits)
    sizes = _sizes(problem, path)
    rates = _rates(problem, sizes)
    if given.body.loads is not None:
        rates = _with_loads(rates, problem, path)
    moving = [name for name in sizes if name[0] in "Hxy"]
    span = abs(float(given.clock.elapsed[-1] / problem.units.time))
    h = min(span / max(steps, 1), _largest(sizes, moving) / (_largest(rates, moving) or 1.0))
    rounded = {name: size + h * rates[name] for name, size in sizes.items()}
    if given.body.damping:
        # Below the least normal number the rounding is absolute.
        for name in moving:
            rounded[name] = np.where(sizes[name] > 0, np.maximum(rounded[name], _least(bits)), 0.0)
    columns = []
    for block in path.blocks:
        if block == "attitude":
            turn = _ANGLE * np.sqrt(sum(rounded[name] ** 2 for name in _QUATERNION))
            columns += [turn / np.sqrt(3.0)] * 3
        elif block not in path.carried.own:
            unit = float(_unit(problem, block) / path.units[block])
            columns += [rounded[name] * unit for name in _COMPONENTS[block]]
    roundings_at: Floats = np.column_stack(columns)
    if velocities and given.body.has_velocities:
        by_inertia = _through_velocities(given.body, path)
        roundings_at[:, :6] = np.maximum(roundings_at[:, :6], by_inertia)
    if path.carried.own:
        own = _of_own_states(path, h * float(problem.units.time))
        roundings_at = np.hstack([roundings_at, own])
    return roundings_at


def _of_own_states(path: Path, h: float) -> Floats:
    """Return r of states of the scene's own, those with a rate first; of a held one that of its value."""
    along, own = Along(path), path.carried.own
    _, rates, taken, _ = along.split(along.sizes())
    values = np.abs(np.hstack([*own.values()]))
    rounded = np.hstack([values[:, : rates.shape[1]] + h * rates, taken])
    units = [float(path.units[name]) for name, rows in own.items() for _ in rows[0]]
    counted: Floats = rounded / np.array(units)
    return counted


def _with_loads(rates: Mapping[str, Floats], problem: Problem, path: Path) -> dict[str, Floats]:
    """Return the rates with the sizes of the steps of the loads, each carried to the load."""
    sizes, more = Along(path).sizes(), dict(rates)
    for k, block in enumerate(path.flow.momenta):
        unit = float(problem.units.time / _unit(problem, block))
        for name, size in zip(_COMPONENTS[block], sizes[:, 3 * k : 3 * k + 3].T, strict=True):
            more[name] = more[name] + unit * size
    return more


def _through_velocities(body: Body, path: Path) -> Floats:
    """Return m at every time, shape (n, 6), in the path's units."""
    units = np.array([path.units[block] for block in path.blocks[:2] for _ in range(3)])
    energy, M = np.array(body.energy_matrix), np.array(tensors.inverse(body.energy_matrix))
    velocity = path.momentum @ (energy * units).astype(float).T
    terms = velocity[:, None, :] * (M / units[:, None]).astype(float)
    magnitudes: Floats = np.sqrt(np.sum(terms**2, axis=2))
    return magnitudes


def _posed(given: Scene, path: Path, bits: int) -> Problem:
    """Return the posed equations of the body at this precision, without written loads."""
    if given.body.loads is not None:
        frame = frozenset(path.blocks) & {"attitude", "centre"}
        given = replace(given, body=given.body.with_loads(None), track=frame)
    end = given.clock.instants[-1]
    return pose(replace(given, clock=Clock(given.clock.start, (end,))), Rung(f"mp{bits}", bits))


def _sizes(problem: Problem, path: Path) -> dict[str, Floats]:
    """Return |component| at every time, by name, in the problem's units."""
    sizes: dict[str, Floats] = {}
    for k, block in enumerate(path.flow.momenta):
        unit = float(path.units[block] / _unit(problem, block))
        rows = np.abs(path.momentum[:, 3 * k : 3 * k + 3]) * unit
        sizes |= dict(zip(_COMPONENTS[block], rows.T, strict=True))
    if "attitude" in path.blocks:
        sizes |= {name: np.full(len(path.elapsed), _COMPONENT) for name in _QUATERNION}
    if "centre" in path.blocks:
        length = problem.units.centre
        start = np.array([float(c / length) for c in problem.given.initial.parts()["centre"]])
        rows = np.abs(path.centre * float(path.units["centre"] / length) + start)
        sizes |= dict(zip(_COMPONENTS["centre"], rows.T, strict=True))
    return sizes


def _rates(problem: Problem, sizes: Mapping[str, Floats]) -> dict[str, Floats]:
    """Return S at every time, by name, in the problem's units; zero for a constant component."""
    form = problem.form
    states = [Magnitude(sizes[name]) for name in form.states]
    rates = form.rates(states, [float(value) for value in problem.parameters])
    magnitudes = {name: np.zeros_like(size) for name, size in sizes.items()}
    for name, rate in zip(form.states, rates, strict=True):
        if name in magnitudes and not is_absent(rate):
            magnitudes[name] = magnitudes[name] + _size(rate)
    return magnitudes


def _least(bits: int) -> float:
    """Return the least normal number of the format with this many bits; 0 for MPFR's numbers."""
    exponents = {each.bits: each.emin for each in FORMATS.values()}
    return 2.0 ** max(exponents[bits], -1074) if bits in exponents else 0.0


def _largest(columns: Mapping[str, Floats], names: Sequence[str]) -> float:
    """Return the largest norm at any time."""
    return float(np.sqrt(np.max(sum(columns[name] ** 2 for name in names))))


def _unit(problem: Problem, block: str) -> Fraction:
    units = problem.units
    by_block = {"linear_impulse": units.impulse, "centre": units.centre}
    return by_block.get(block, units.momentum)
