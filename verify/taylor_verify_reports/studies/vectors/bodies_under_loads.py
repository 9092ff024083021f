"""Bodies under loads that the scene writes down, and with states of its own, in text and in numbers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Final

import numpy as np

from taylor_verify_reports.studies.causes.bodies import Acting, Floats, Sample, sample
from taylor_verify_reports.studies.causes.simulated import rotation

# A multiple of this is a double, and a short decimal text.
GRID: Final = 64
Draw = np.random.Generator
Loaded = Callable[[Sample, Draw], Sample]


def on_grid(values: Floats) -> Floats:
    """Return the nearest multiples of 1/64."""
    return np.asarray(np.round(np.asarray(values) * GRID) / GRID)


def plain(sort: str, draw: Draw, loaded: Loaded | None = None) -> Sample:
    """Draw a body whose numbers are multiples of 1/64, with 11 to 16 rows."""
    drawn = sample(sort, draw)
    pace = max(float(np.linalg.norm(drawn.v0[-3:])), 0.4)
    step = max(float(on_grid(np.asarray(0.45 / pace))), 1 / GRID)
    mass = on_grid(drawn.mass)
    body = replace(
        drawn,
        mass=(mass + mass.T) / 2,
        load=on_grid(2 * drawn.load),
        rotor=on_grid(drawn.rotor),
        v0=on_grid(drawn.v0),
        q0=on_grid(drawn.q0),
        times=step * np.arange(int(draw.integers(11, 17)), dtype=np.float64),
        digits=int(draw.choice([9, 12])),
    )
    return loaded(body, draw) if loaded else body


def numbers(draw: Draw, low: float, high: float, count: int = 3) -> Floats:
    """Draw multiples of 1/64."""
    return on_grid(draw.uniform(low, high, count))


def texts(lines: list[str]) -> str:
    """Return texts as a scene has them."""
    return "[" + ", ".join(f'"{line}"' for line in lines) + "]"


def _moment(lines: list[str]) -> tuple[str, ...]:
    return (f"moment = {texts(lines)}",)


def timed(body: Sample, draw: Draw) -> Sample:
    """A moment that is a function of time."""
    size, rate = numbers(draw, 0.1, 0.5), numbers(draw, 0.5, 2)
    lines = [f"{a}*sin({b}*t)" for a, b in zip(size, rate, strict=True)]
    acting = Acting(load=lambda t, v, q, own: size * np.sin(rate * t))
    return replace(body, lines=_moment(lines), acting=acting)


def braked(body: Sample, draw: Draw) -> Sample:
    """A moment against the angular velocity and its cube."""
    linear, cubic = numbers(draw, 0.05, 0.3), numbers(draw, 0.05, 0.3)
    lines = [f"-{linear[i]}*w{i + 1} - {cubic[i]}*w{i + 1}^3" for i in range(3)]
    acting = Acting(load=lambda t, v, q, own: -linear * v - cubic * v**3)
    return replace(body, lines=_moment(lines), acting=acting)


def heavy(body: Sample, draw: Draw) -> Sample:
    """A weight at a point of the body, written as a moment."""
    arm = numbers(draw, -0.4, 0.4)
    a, b, c = (float(x) for x in arm)
    lines = [f"{b}*d3 - {c}*d2", f"{c}*d1 - {a}*d3", f"{a}*d2 - {b}*d1"]
    down = np.array([0.0, 0.0, -1.0])
    acting = Acting(load=lambda t, v, q, own: np.cross(arm, rotation(q).T @ down))
    return replace(body, lines=_moment(lines), tables=("[space]", "d = [0, 0, -1]"), acting=acting)


def feedback(body: Sample, draw: Draw) -> Sample:
    """A moment by the attitude and the angular velocity."""
    kp, kd = (float(x) for x in numbers(draw, 0.2, 0.8, 2))
    lines = [f"-{kp}*q{i}*q0 - {kd}*w{i}" for i in (1, 2, 3)]
    acting = Acting(load=lambda t, v, q, own: -kp * q[1:] * q[0] - kd * v)
    return replace(body, lines=_moment(lines), acting=acting)


def pulsed(body: Sample, draw: Draw) -> Sample:
    """A moment about each axis until it is switched off."""
    size = numbers(draw, 0.2, 0.6)
    off = float(body.times[len(body.times) // 2] + 1 / (2 * GRID))
    lines = [f"{a} if t < {off} else 0" for a in size]
    acting = Acting(load=lambda t, v, q, own: size * (t < off), switches=(off,))
    return replace(body, lines=_moment(lines), acting=acting)


def lagging(body: Sample, draw: Draw) -> Sample:
    """An own state: the moment follows what a controller asks for with a lag."""
    kp, kd, pace = (float(x) for x in numbers(draw, 0.3, 0.9, 3))
    lines = [f"{pace}*(-{kp}*q{i} - {kd}*w{i} - m{i})" for i in (1, 2, 3)]
    tables = ("[states]", f"m = {{ start = [0, 0, 0], rate = {texts(lines)} }}")
    acting = Acting(
        load=lambda t, v, q, own: own,
        start=np.zeros(3),
        rate=lambda t, v, q, own: pace * (-kp * q[1:] - kd * v - own),
    )
    return replace(body, lines=_moment(["m1", "m2", "m3"]), tables=tables, acting=acting)


def sampled(body: Sample, draw: Draw) -> Sample:
    """An own state: a controller that takes its moment some times in each row and keeps it."""
    kp, kd = (float(x) for x in numbers(draw, 0.3, 0.9, 2))
    every = float(body.times[1]) / int(draw.choice([1, 2]))
    lines = [f"-{kp}*q{i} - {kd}*w{i}" for i in (1, 2, 3)]
    tables = ("[states]", f'm = {{ every = "{every}", value = {texts(lines)} }}')
    acting = Acting(
        load=lambda t, v, q, own: own,
        start=np.zeros(3),
        taken=lambda t, v, q, own: -kp * q[1:] - kd * v,
        every=every,
    )
    return replace(body, lines=_moment(["m1", "m2", "m3"]), tables=tables, acting=acting)


def driven(body: Sample, draw: Draw) -> Sample:
    """A solid in a fluid with thrust and a drag on all velocities."""
    thrust, drag = float(numbers(draw, 0.1, 0.4, 1)[0]), numbers(draw, 0.05, 0.3, 6)
    names = ("u1", "u2", "u3", "w1", "w2", "w3")
    lines = [f"-{drag[i]}*{names[i]}" for i in range(6)]
    lines[0] += f" + {thrust}"
    push = np.array([thrust, 0, 0, 0, 0, 0])
    acting = Acting(load=lambda t, v, q, own: push - drag * v)
    both = (f"force = {texts(lines[:3])}", f"couple = {texts(lines[3:])}")
    return replace(body, lines=both, acting=acting)


WRITTEN: Final[dict[str, Loaded]] = {
    "timed": timed,
    "braked": braked,
    "heavy": heavy,
    "feedback": feedback,
    "pulsed": pulsed,
}
OWN_STATES: Final[dict[str, Loaded]] = {"lagging": lagging, "sampled": sampled}
