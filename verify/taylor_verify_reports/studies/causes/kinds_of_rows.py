"""Kinds of faults in the rows of a right motion: times, frames, points, interpolation, starts."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Final

import numpy as np

from taylor_verify_reports.studies.causes.bodies import Floats, Sample
from taylor_verify_reports.studies.causes.kind import WITH_RATES, Kind, of, right
from taylor_verify_reports.studies.causes.simulated import (
    Law,
    Rows,
    integrated,
    law,
    rates,
    rotation,
    turned,
)
from taylor_verify_reports.studies.causes.stepping import Draw, Make

_WITH_PATH: Final = ("fluid",)
_PACES: Final = (1 / 24, 1 / 60, 1 / 240, 24.0, 60.0)


def _changed(change: Callable[[Rows, Sample, Draw, float], Rows]) -> Make:
    return lambda s, d, size: change(right(s), s, d, size)


def _turns(rows: Rows) -> Floats:
    return np.array([rotation(q) for q in rows.q])


def _frames(s: Sample, d: Draw, size: float) -> Rows:
    pace = _PACES[int(d.integers(3))]
    return right(s, s.times * pace)._replace(times=s.times)


def _float32_sum(s: Sample, d: Draw, size: float) -> Rows:
    h = np.float32(s.times[1])
    stamps = np.r_[0, np.cumsum(np.full(len(s.times) - 1, h), dtype=np.float32)].astype(float)
    return right(s)._replace(times=stamps)


def _at_whole_steps(s: Sample, d: Draw, size: float) -> Rows:
    step = s.times[1] / d.uniform(1.5, 4.5)
    last = np.floor(s.times / step + 1e-9) * step
    return right(s, last)._replace(times=s.times)


def _jitter(s: Sample, d: Draw, size: float) -> Rows:
    late = 0.1 * size * s.times[1] * d.uniform(-1, 1, len(s.times)) * (s.times > 0)
    return right(s, s.times + late)._replace(times=s.times)


def _dropped(s: Sample, d: Draw, size: float) -> Rows:
    rows, k = (
        right(s, np.r_[s.times, s.times[-1] + s.times[1]]),
        int(d.integers(4, len(s.times) - 4)),
    )
    return Rows(s.times, np.delete(rows.v, k, 0), np.delete(rows.q, k, 0))


def _twice(rows: Rows, s: Sample, d: Draw, size: float) -> Rows:
    half = np.arange(len(s.times)) // 2 * 2
    return Rows(s.times, rows.v[half], rows.q[half])


def _outlier(rows: Rows, s: Sample, d: Draw, size: float) -> Rows:
    v, k = rows.v.copy(), int(d.integers(3, len(s.times) - 3))
    v[k] *= 1 + size
    return rows._replace(v=v)


def _body_turned(rows: Rows, s: Sample, d: Draw, size: float) -> Rows:
    axis = d.standard_normal(3)
    p = np.r_[np.cos(size / 2), np.sin(size / 2) * axis / np.linalg.norm(axis)]
    v = np.hstack([part @ rotation(p) for part in np.split(rows.v, s.n // 3, axis=1)])
    return rows._replace(v=v, q=np.array([2 * turned(q, p[1:]) + p[0] * q for q in rows.q]))


def _of_angles(rows: Rows, s: Sample, d: Draw, size: float) -> Rows:
    """Return rows with the rates of roll, pitch and yaw in the place of omega."""
    v = rows.v.copy()
    for k, (turn, w) in enumerate(zip(_turns(rows), rows.v[:, -3:], strict=True)):
        roll, pitch = np.arctan2(turn[2, 1], turn[2, 2]), -np.arcsin(turn[2, 0])
        about_roll = np.array([[np.cos(roll), -np.sin(roll)], [np.sin(roll), np.cos(roll)]]) @ w[1:]
        turns = about_roll[1] / np.cos(pitch)
        v[k, -3:] = w[0] + turns * np.sin(pitch), about_roll[0], turns
    return rows._replace(v=v)


def _exchanged(rows: Rows, s: Sample, d: Draw, size: float) -> Rows:
    v, n = rows.v.copy(), s.n
    v[:, [n - 3, n - 2]] = v[:, [n - 2, n - 3]]
    return rows._replace(v=v)


def _scaled(rows: Rows, s: Sample, d: Draw, size: float) -> Rows:
    factors = np.ones(s.n)
    factors[s.n - 3 + int(d.integers(3))] += size
    return rows._replace(v=rows.v * factors)


def _other_point(rows: Rows, s: Sample, d: Draw, size: float) -> Rows:
    v = rows.v.copy()
    v[:, :3] += np.cross(v[:, 3:], size * d.uniform(0.3, 1, 3))
    return rows._replace(v=v)


def _moving_frame(rows: Rows, s: Sample, d: Draw, size: float) -> Rows:
    v = rows.v.copy()
    v[:, :3] += np.einsum("nij,i->nj", _turns(rows), size * d.uniform(0.3, 1, 3))
    return rows._replace(v=v)


def _path(change: Callable[[Rows, Floats], Floats]) -> Make:
    """Return rows with another path, by a vector of three."""

    def make(s: Sample, d: Draw, size: float) -> Rows:
        rows = right(s)
        return rows._replace(c=change(rows, size * d.uniform(0.3, 1, 3)))

    return make


def _depth(rows: Rows, arm: Floats) -> Floats:
    assert rows.c is not None
    return np.asarray(rows.c * np.array([1, 1, -1]))


def _of_point(rows: Rows, arm: Floats) -> Floats:
    assert rows.c is not None
    return np.asarray(rows.c + _turns(rows) @ arm)


def _drifting(rows: Rows, arm: Floats) -> Floats:
    assert rows.c is not None
    return np.asarray(rows.c + rows.times[:, None] * arm)


def _by_transposed(own: Law, s: Sample, d: Draw, size: float) -> None:
    own.path = lambda turn, v, current: turn.T @ v + current


def _not_turned(own: Law, s: Sample, d: Draw, size: float) -> None:
    own.path = lambda turn, v, current: v + current


def _late_attitude(rows: Rows, s: Sample, d: Draw, size: float) -> Rows:
    return rows._replace(q=np.vstack([rows.q[:1], rows.q[:-1]]))


def _cubic(s: Sample, d: Draw, size: float) -> Rows:
    from scipy.interpolate import CubicHermiteSpline

    rows, own = right(s), law(s)
    nodes = np.arange(0, len(s.times), int(d.integers(3, 6)))
    slopes = [
        np.r_[rates(own, t, v, q, np.zeros(0)), turned(q, v[-3:])]
        for t, v, q in zip(s.times[nodes], rows.v[nodes], rows.q[nodes], strict=True)
    ]
    z = CubicHermiteSpline(s.times[nodes], np.hstack([rows.v, rows.q])[nodes], np.array(slopes))
    times = s.times[: nodes[-1] + 1]
    v, q = np.split(z(times), [s.n], axis=1)
    return Rows(times, v, q / np.linalg.norm(q, axis=1, keepdims=True))


def _slerp(s: Sample, d: Draw, size: float) -> Rows:
    from scipy.spatial.transform import Rotation, Slerp

    rows, nodes = right(s), np.arange(0, len(s.times), int(d.integers(3, 6)))
    times, known = s.times[: nodes[-1] + 1], s.times[nodes]
    v = np.stack([np.interp(times, known, column) for column in rows.v[nodes].T], axis=1)
    turns = Slerp(known, Rotation.from_quat(rows.q[nodes], scalar_first=True))(times)
    return Rows(times, v, turns.as_quat(scalar_first=True))


def _clock_steps(s: Sample, d: Draw, size: float) -> Rows:
    late = 0.3 * s.times[1] * (np.arange(len(s.times)) >= int(d.integers(5, len(s.times) - 5)))
    return right(s, s.times - late)._replace(times=s.times)


def _capped(s: Sample, d: Draw, size: float) -> Rows:
    """Return a motion whose velocities are cut down after the first row."""
    later = integrated(replace(s, v0=s.v0 / (1 + size)), law(s))
    return later._replace(v=np.vstack([s.v0, later.v[1:]]))


def _alone(s: Sample, d: Draw, size: float) -> Rows:
    own = law(s)
    own.coriolis = (1 + size) * own.coriolis
    return integrated(s, own)


_PACE: Final = ("clock", "factor of the gyroscopic term", "factor of the Coriolis terms")
_AXES: Final = ("fixed rotation", "space axes turned", "contradicts")
OF_ROWS: Final = (
    Kind("times in frames", _PACE, _frames),
    Kind("times by a float32 sum", ("float32", "times", "clock"), _float32_sum),
    Kind("times that scatter", ("times scatter", "times are rounded"), _jitter),
    Kind("rows dropped", ("rows dropped", "jump"), _dropped),
    Kind("rows saved twice", ("saved twice", "repeat", "held"), _changed(_twice)),
    Kind("one row wrong", ("one row is wrong",), _changed(_outlier)),
    Kind("body frame turned", _AXES, _changed(_body_turned), WITH_RATES),
    Kind("rates of Euler angles", ("rates of Euler angles",), _changed(_of_angles), WITH_RATES),
    Kind("axes exchanged", ("other axes", "contradicts"), _changed(_exchanged), WITH_RATES),
    Kind("scale of an axis", ("has factors", "contradicts"), _changed(_scaled), WITH_RATES),
    Kind("velocity of another point", ("another point",), _changed(_other_point), _WITH_PATH),
    Kind("constant current", ("moving frame", "drifts"), _changed(_moving_frame), _WITH_PATH),
    Kind("depth upward", ("other sign on axis 3",), _path(_depth), _WITH_PATH, has_centre=True),
    Kind(
        "path of another point",
        ("path of the body",),
        _path(_of_point),
        _WITH_PATH,
        has_centre=True,
    ),
    Kind("path that drifts", ("drifts",), _path(_drifting), _WITH_PATH, has_centre=True),
    Kind("cubic interpolation", ("interpolation",), _cubic),
    Kind("speed capped", ("first two rows", "jump"), _capped),
    Kind(
        "attitude alone",
        (*_PACE, "factor of the tensor", "tensor in the gyroscopic term alone"),
        _alone,
        ("free", "wheels"),
        has_rates=False,
    ),
)
# Kinds that came later stand last: a kind is drawn by its place.
LATER: Final = (
    Kind("path by R transposed", ("path by R^T",), of(_by_transposed), _WITH_PATH, has_centre=True),
    Kind(
        "path that is not turned",
        ("path without the attitude",),
        of(_not_turned),
        _WITH_PATH,
        has_centre=True,
    ),
    Kind("attitude a row late", ("attitude is late",), _changed(_late_attitude)),
)
# As many whole steps in each row are another pace of the clock.
AT_WHOLE_STEPS: Final = Kind(
    "rows at whole steps", ("the last whole step", "clock"), _at_whole_steps
)
LATER_OF_ROWS: Final = (
    Kind("slerp", ("interpolation and slerp",), _slerp),
    Kind("clock that steps", ("the clock is in time, and late",), _clock_steps),
)
