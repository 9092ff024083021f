"""The kinds of faults: a maker of answers, the bodies it is made for, and the words that are right.

``size`` is the relative size of a fault with a number: 3e-3, 0.06 or 0.5. A kind without words is a law
that the search does not have, or a sound method: there silence is right.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Final

import numpy as np

from taylor_verify_reports.studies.causes.bodies import Floats, Sample
from taylor_verify_reports.studies.causes.kind import FLUID, WITH_RATES, Kind, of, right, setting
from taylor_verify_reports.studies.causes.kinds_of_bodies import OF_BODIES, become
from taylor_verify_reports.studies.causes.kinds_of_loads import LATER_OF_LOADS, OF_LOADS
from taylor_verify_reports.studies.causes.kinds_of_rows import (
    AT_WHOLE_STEPS,
    LATER,
    LATER_OF_ROWS,
    OF_ROWS,
)
from taylor_verify_reports.studies.causes.kinds_of_steps import (
    DAMPING_STEP,
    LATER_OF_STEPS,
    OF_STEPS,
)
from taylor_verify_reports.studies.causes.simulated import (
    Law,
    Rows,
    integrated,
    law,
    rotation,
    stepped,
)
from taylor_verify_reports.studies.causes.stepping import (
    Draw,
    Make,
    backward,
    begin,
    by,
    euler,
    held_rate,
    heun,
    in_place,
    mean,
    rk4,
)


def _load_scale(sample: Sample) -> Floats:
    pace = float(np.linalg.norm(sample.v0[-3:]))
    return np.asarray(np.abs(sample.mass @ sample.v0) * pace + 0.05)


def _one(s: Sample, d: Draw, size: float) -> Floats:
    place = int(d.integers(s.n))
    return np.asarray(size * _load_scale(s)[place] * np.eye(s.n)[place])


def _three(s: Sample, d: Draw, size: float) -> Floats:
    part = np.zeros(s.n)
    part[-3:] = size * _load_scale(s)[-3:] * d.uniform(0.3, 1, 3)
    return part


def _coriolis(own: Law, matrix: Floats) -> None:
    own.coriolis, own.munk = matrix, matrix[:3].copy()


def _diagonal_entry(own: Law, s: Sample, d: Draw, size: float) -> None:
    place, mass = int(d.integers(s.n)), s.mass.copy()
    mass[place, place] *= 1 + size / 4
    become(own, mass)


def _coriolis_entry(own: Law, s: Sample, d: Draw, size: float) -> None:
    place, matrix = int(d.integers(s.n)), s.mass.copy()
    matrix[place, place] *= 1 + size
    _coriolis(own, matrix)


def _products(own: Law, s: Sample, d: Draw, size: float) -> None:
    become(own, np.diag(np.diag(s.mass)))


def _factor(own: Law, s: Sample, d: Draw, size: float) -> None:
    _coriolis(own, (1 + size) * s.mass)
    own.rotor = (1 + size) * s.rotor


def _no_term(own: Law, s: Sample, d: Draw, size: float) -> None:
    _coriolis(own, 0 * s.mass)
    own.rotor = 0 * s.rotor


def _munk(own: Law, s: Sample, d: Draw, size: float) -> None:
    own.munk = (1 + size) * s.mass[:3]


def _wheel(own: Law, s: Sample, d: Draw, size: float) -> None:
    own.rotor = s.rotor * np.where(np.arange(3) == int(d.integers(3)), 1 + size, 1)


def _moment_factor(own: Law, s: Sample, d: Draw, size: float) -> None:
    own.load = (1 + size) * s.load


def _in_space(own: Law, s: Sample, d: Draw, size: float) -> None:
    own.space, own.load = s.load.copy(), 0 * s.load


def _from_time(own: Law, s: Sample, d: Draw, size: float) -> None:
    own.load = s.load + _three(s, d, max(size, 0.06)) if s.n == 3 else _three(s, d, max(size, 0.06))
    own.from_time = float(s.times[len(s.times) // 3])


def _for_a_while(own: Law, s: Sample, d: Draw, size: float) -> None:
    own.load, count = _three(s, d, max(size, 0.06)), len(s.times)
    own.from_time, own.until_time = float(s.times[count // 4]), float(s.times[3 * count // 4])


def _cubic(own: Law, s: Sample, d: Draw, size: float) -> None:
    scale = size * _load_scale(s) / np.maximum(np.abs(s.v0), 0.1) ** 3
    own.loads_of = lambda t, v: -scale * v**3


def _growing(own: Law, s: Sample, d: Draw, size: float) -> None:
    load, end = _three(s, d, size), float(s.times[-1])
    own.loads_of = lambda t, v: load * (t / end) ** 2


def _waving(own: Law, s: Sample, d: Draw, size: float) -> None:
    load = _three(s, d, size)
    own.loads_of = lambda t, v: load * np.sin(2.3 * t)


# Conventions, times and rows, made of the right motion.


def _omega(rows: Rows, change: Callable[[Floats], Floats]) -> Rows:
    v = rows.v.copy()
    v[:, -3:] = change(v[:, -3:])
    return rows._replace(v=v)


def _sign(s: Sample, d: Draw, size: float) -> Rows:
    signs = np.ones(3)
    signs[int(d.integers(3))] = -1
    return _omega(right(s), lambda w: w * signs)


def _bias(s: Sample, d: Draw, size: float) -> Rows:
    return _omega(right(s), lambda w: w + size * d.uniform(0.3, 1, 3))


def _degrees(s: Sample, d: Draw, size: float) -> Rows:
    return _omega(right(s), lambda w: w * 180 / np.pi)


def _space_axes(s: Sample, d: Draw, size: float) -> Rows:
    rows = right(s)
    turns = np.array([rotation(q) for q in rows.q])
    return _omega(rows, lambda w: np.einsum("nij,nj->ni", turns, w))


def _conjugate(s: Sample, d: Draw, size: float) -> Rows:
    rows = right(s)
    return rows._replace(q=rows.q * np.array([1, -1, -1, -1]))


def _scalar_last(s: Sample, d: Draw, size: float) -> Rows:
    rows = right(s)
    return rows._replace(q=np.roll(rows.q, -1, axis=1))


def _space_turned(s: Sample, d: Draw, size: float) -> Rows:
    half, axis = size / 2, d.standard_normal(3)
    turn = np.array([np.cos(half), *(np.sin(half) * axis / np.linalg.norm(axis))])
    rows = right(s)
    a, u = turn[0], turn[1:]
    b, w = rows.q[:, :1], rows.q[:, 1:]
    q = np.hstack([a * b - w @ u[:, None], a * w + b * u + np.cross(u, w)])
    return rows._replace(q=q)


def _at(late: Callable[[Sample, Draw, float], Floats]) -> Make:
    """Return rows of the right motion at other times than their stamps."""

    def make(s: Sample, d: Draw, size: float) -> Rows:
        return right(s, late(s, d, size))._replace(times=s.times)

    return make


def _repeated(s: Sample, d: Draw, size: float) -> Rows:
    rows, k = right(s), int(d.integers(3, len(s.times) - 3))
    v, q = rows.v.copy(), rows.q.copy()
    v[k], q[k] = v[k - 1], q[k - 1]
    return Rows(rows.times, v, q)


def _interpolated(s: Sample, d: Draw, size: float) -> Rows:
    rows, every = right(s), int(d.integers(2, 6))
    nodes = np.arange(0, len(s.times), every)
    line = [np.interp(s.times, s.times[nodes], column[nodes]) for column in rows.v.T]
    turn = np.transpose([np.interp(s.times, s.times[nodes], c[nodes]) for c in rows.q.T])
    last = nodes[-1] + 1
    unit = turn / np.linalg.norm(turn, axis=1, keepdims=True)
    return Rows(rows.times[:last], np.transpose(line)[:last], unit[:last])


def _own_start(s: Sample, d: Draw, size: float) -> Rows:
    return integrated(replace(s, v0=s.v0 * (1 + size * d.uniform(0.3, 1, s.n))), law(s))


def _jump(s: Sample, d: Draw, size: float) -> Rows:
    rows, k = right(s), len(s.times) // 2
    kick = 1 + size * d.uniform(0.3, 1, s.n)
    later = replace(s, v0=rows.v[k] * kick, q0=rows.q[k], times=s.times[k:])
    after = integrated(later, law(later))
    return Rows(s.times, np.vstack([rows.v[:k], after.v]), np.vstack([rows.q[:k], after.q]))


def _asleep(s: Sample, d: Draw, size: float) -> Rows:
    rows, k = right(s), len(s.times) // 2
    v, q = rows.v.copy(), rows.q.copy()
    v[k:], q[k:] = 0, q[k]
    return Rows(s.times, v, q)


def _noise(s: Sample, d: Draw, size: float) -> Rows:
    rows = right(s)
    return rows._replace(v=rows.v * (1 + 1e-3 * size * d.standard_normal(rows.v.shape)))


def _coriolis_product(own: Law, s: Sample, d: Draw, size: float) -> None:
    """Put a product into the row of a force or a couple where a diagonal mass matrix has it."""
    i, column = int(d.integers(6)), int(d.integers(2))
    j, k = (i + 1 + column) % 3, 3 + (i + 2 - column) % 3
    if i > 2:
        j, k = (3 * column + (i + 1) % 3, 3 * column + (i + 2) % 3)
    own.loads_of = lambda t, v: size * np.eye(6)[i] * v[j] * v[k]


def _turning_frame(s: Sample, d: Draw, size: float) -> Rows:
    rows, rate = right(s), size * d.uniform(0.3, 1, 3)
    turns = np.array([rotation(q) for q in rows.q])
    return _omega(rows, lambda w: w - np.einsum("nij,i->nj", turns, rate))


def _tensor_in_space(s: Sample, d: Draw, size: float) -> Rows:
    """Return omega in space axes of a body whose tensor does not turn with it."""
    own = law(s)
    own.turn = lambda q, w: 0.5 * np.array([-q[1:] @ w, *(q[0] * w - np.cross(q[1:], w))])
    return integrated(replace(s, v0=rotation(s.q0) @ s.v0), own)


def _backwards(s: Sample, d: Draw, size: float) -> Rows:
    own = law(s)
    own.turn = lambda q, w: -0.5 * np.array([-q[1:] @ w, *(q[0] * w + np.cross(q[1:], w))])
    return integrated(s, own)


def _wrong_side(s: Sample, d: Draw, size: float) -> Rows:
    own = law(s)
    own.turn = lambda q, w: 0.5 * np.array([-q[1:] @ w, *(q[0] * w - np.cross(q[1:], w))])
    return integrated(s, own)


def _coarse(method: str, rtol: float) -> Make:
    return lambda s, d, size: integrated(s, law(s), method=method, rtol=rtol)


def _two(own: Law, s: Sample, d: Draw, size: float) -> None:
    own.load = own.load + _three(s, d, size)
    own.damping = 0.1 * size


def _fault_and_steps(s: Sample, d: Draw, size: float) -> Rows:
    own = law(s)
    own.load = own.load + _three(s, d, size)
    return stepped(s, euler, begin, int(d.integers(4, 20)), own)


_PACE: Final = ("clock", "factor of the gyroscopic term", "factor of the Coriolis terms")
_LOADS: Final = ("force", "couple", "moment", "loads", "factor of the inertia")
SIMPLE: Final = (
    Kind("clock factor", _PACE, setting("clock", lambda s, d, e: 1 + e)),
    Kind("gyroscopic factor", _PACE, of(_factor)),
    Kind("no gyroscopic term", ("no gyroscopic", "no Coriolis", "sphere"), of(_no_term)),
    Kind("Munk moment", ("Munk",), of(_munk), FLUID),
    Kind("wheel", ("wheel",), of(_wheel), ("wheels",)),
    Kind("wheels left out", ("wheel",), setting("rotor", lambda s, d, e: 0 * s.rotor), ("wheels",)),
    Kind(
        "load left out",
        ("moment left out",),
        setting("load", lambda s, d, e: 0 * s.load),
        ("moment",),
    ),
    Kind(
        "load of another size",
        ("factor of the moment", "factor of the inertia"),
        of(_moment_factor),
        ("moment",),
    ),
    Kind("load in space axes", ("space axes",), of(_in_space), ("moment",)),
    Kind(
        "one load more",
        ("body axes",),
        setting("load", lambda s, d, e: _one(s, d, e) + law(s).load),
    ),
    Kind(
        "moment more",
        ("in body axes",),
        setting("load", lambda s, d, e: _three(s, d, e) + law(s).load),
    ),
    Kind("moment in space", ("space axes",), setting("space", _three)),
    Kind("load from some time on", ("right up to",), of(_from_time)),
    Kind("drag on one axis", ("linear drag on axis",), setting("linear", _one)),
    Kind("drag on all rates", ("linear drag", "one drag on all rates"), setting("linear", _three)),
    Kind("quadratic drag", ("quadratic drag",), setting("quadratic", _three)),
    Kind("damping", ("damping",), setting("damping", lambda s, d, e: 0.1 * e)),
    Kind("entry of the tensor", ("I_", "M_"), of(_diagonal_entry)),
    Kind("entry in the Coriolis terms", ("I_", "M_", "tensor in"), of(_coriolis_entry)),
    Kind(
        "products left out",
        ("products of inertia left out", "off-diagonal masses left out"),
        of(_products),
    ),
    Kind("own start", ("another start",), _own_start),
    Kind("jump", ("jump", "first two rows"), _jump),
    Kind("asleep", ("at rest", "all velocities are 0"), _asleep),
    Kind("sign of an axis", ("other sign on axis", "contradicts"), _sign, WITH_RATES),
    Kind("bias", ("constant offset",), _bias),
    Kind("degrees", ("degrees",), _degrees, WITH_RATES),
    Kind("space axes", ("space axes",), _space_axes, WITH_RATES),
    Kind("conjugate", ("conjugate", "transposed"), _conjugate),
    Kind("scalar last", ("scalar last",), _scalar_last),
    Kind("space frame turned", ("fixed rotation", "space axes turned"), _space_turned),
    Kind("one row off", ("row k",), _at(lambda s, d, e: s.times + s.times[1])),
    Kind(
        "times rounded",
        ("times",),
        _at(lambda s, d, e: s.times + 4e-4 * d.uniform(-1, 1, len(s.times)) * (s.times > 0)),
    ),
    Kind(
        "early clock", ("early", "another start", "row k"), _at(lambda s, d, e: s.times + 0.3 * e)
    ),
    Kind("row repeated", ("repeat",), _repeated),
    Kind("linear interpolation", ("interpolation",), _interpolated),
    Kind("explicit Euler", ("explicit Euler", "attitude turned by"), by(euler, begin)),
    Kind("backward Euler", ("backward Euler", "attitude turned by"), by(backward, begin)),
    Kind("Heun", ("Heun", "attitude turned by"), by(heun, mean)),
    Kind("RK4", ("RK4", "attitude turned by"), by(rk4, mean)),
    Kind("held rate of the attitude", ("attitude turned by",), held_rate),
    Kind("attitude backwards", ("backwards", "turns by"), _backwards, WITH_RATES),
    Kind("attitude on the wrong side", ("wrong axes",), _wrong_side, WITH_RATES),
    Kind("two faults", ("damping", *_LOADS), of(_two)),
    Kind(
        "a fault and Euler steps",
        ("explicit Euler", "attitude turned by", *_LOADS),
        _fault_and_steps,
    ),
    Kind("cubic drag", (), of(_cubic)),
    Kind("growing load", (), of(_growing)),
    Kind("waving load", (), of(_waving)),
    Kind("noise", ("contradicts",), _noise),
    Kind("attitude in place", ("in place",), in_place),
    Kind("product in the Coriolis terms", ("C_", "Coriolis"), of(_coriolis_product), FLUID),
    Kind("frame that turns", ("frame that turns",), _turning_frame, WITH_RATES),
    Kind("tensor in space axes", ("space axes",), _tensor_in_space, ("free",)),
    Kind("RK45 at 1e-4", (), _coarse("RK45", 1e-4)),
    Kind("RK45 at 1e-7", (), _coarse("RK45", 1e-7)),
    Kind("RK23 at 1e-5", (), _coarse("RK23", 1e-5)),
    Kind("LSODA at 1e-6", (), _coarse("LSODA", 1e-6)),
    Kind("Radau at 1e-6", (), _coarse("Radau", 1e-6)),
    Kind("load for a while", ("from t =",), of(_for_a_while), ("free", "wheels", *FLUID)),
)
KINDS: Final = (
    *SIMPLE,
    *OF_ROWS,
    *OF_STEPS,
    *OF_LOADS,
    *LATER,
    DAMPING_STEP,
    AT_WHOLE_STEPS,
    *LATER_OF_ROWS,
    *LATER_OF_LOADS,
    *LATER_OF_STEPS,
    *OF_BODIES,
)
