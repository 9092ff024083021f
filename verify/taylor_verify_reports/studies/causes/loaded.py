"""Random bodies with loads that a scene writes as texts: the texts, and the same loads as plain code."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from taylor_verify_reports.studies.causes.bodies import SORTS, Acting, Floats, Sample, sample
from taylor_verify_reports.studies.causes.simulated import cross, rotation, skew

# A multiple of this is a double, and a short decimal text.
GRID: Final = 64
LOADED: Final = ("solid", "vehicle", "gradient", "pulse", "sampled", "lag", "surge")


@dataclass(frozen=True)
class Vehicle:
    """Thrust until some time, quadratic drag by the velocity in the water, and a weight that floats."""

    thrust: float
    until: float
    drag: Floats
    weight: float
    arm: Floats
    wind: Floats
    hangs_back: bool = False
    is_drag_in_space: bool = False

    @property
    def lines(self) -> tuple[str, ...]:
        """Lines of [body]."""
        d = [f"-{x!r}*abs({n})*{n}" for x, n in zip(self.drag.tolist(), _NAMES, strict=True)]
        d[0] = f"{self.thrust!r}*(1 if t < {self.until!r} else 0) {d[0].replace('-', '- ', 1)}"
        force, couple = (", ".join(f'"{text}"' for text in part) for part in (d[:3], d[3:]))
        return (
            f"force = [{force}]",
            f"couple = [{couple}]",
            f"weight = {{ force = [0, 0, {self.weight!r}], at = {self.arm.tolist()} }}",
            f"buoyancy = {{ force = [0, 0, {-self.weight!r}] }}",
        )

    def load(self, t: float, v: Floats, q: Floats, own: Floats) -> Floats:
        """Return force and couple; ``wind`` is a velocity in space axes that the drag counts as well.

        The weight ``hangs_back`` by R in the place of R^T.
        """
        turn = rotation(q)
        through = v + np.r_[turn.T @ self.wind, 0, 0, 0]
        if self.is_drag_in_space:
            through = np.r_[turn @ through[:3], turn @ through[3:]]
        load = -self.drag * np.abs(through) * through
        if self.is_drag_in_space:
            load = np.r_[turn.T @ load[:3], turn.T @ load[3:]]
        load[0] += self.thrust * (t < self.until)
        hung = (turn if self.hangs_back else turn.T) @ np.array([0, 0, self.weight])
        load[3:] += cross(self.arm, hung)
        return np.asarray(load)


_NAMES: Final = ("u1", "u2", "u3", "w1", "w2", "w3")


@dataclass(frozen=True)
class Gradient:
    """The moment of the gravity gradient along a fixed direction o of space, 3 n^2 o x I o."""

    n: float
    inertia: Floats
    is_back: bool = False

    @property
    def lines(self) -> tuple[str, ...]:
        """Lines of [body]; o is named under [space]."""
        rows = ["+".join(f"I{i}{k}*o{k}" for k in (1, 2, 3)) for i in (1, 2, 3)]
        texts = [
            f"3*n^2*(o{i}*({rows[k - 1]}) - o{k}*({rows[i - 1]}))"
            for i, k in ((2, 3), (3, 1), (1, 2))
        ]
        return (f"moment = [{', '.join(f'{chr(34)}{text}{chr(34)}' for text in texts)}]",)

    @property
    def tables(self) -> tuple[str, ...]:
        """Lines behind [time]."""
        return ("[define]", f'n = "{self.n!r}"', "[space]", "o = [1, 0, 0]")

    def load(self, t: float, v: Floats, q: Floats, own: Floats) -> Floats:
        """Return the moment; ``is_back`` turns the direction the wrong way."""
        turn = rotation(q)
        o = (turn if self.is_back else turn.T) @ np.array([1.0, 0, 0])
        return np.asarray(3 * self.n**2 * cross(o, self.inertia @ o))


@dataclass(frozen=True)
class Pulses:
    """Two pulses of a moment, about the axes 1 and 2."""

    size: float
    times: tuple[float, float, float, float]

    @property
    def lines(self) -> tuple[str, ...]:
        """Lines of [body]."""
        pairs = self.times[:2], self.times[2:]
        texts = [f'"{self.size!r}*(step(t - {a!r}) - step(t - {b!r}))"' for a, b in pairs]
        return (f"moment = [{', '.join(texts)}, 0]",)

    def load(self, t: float, v: Floats, q: Floats, own: Floats) -> Floats:
        """Return the moment."""
        a, b, c, e = self.times
        return self.size * np.array([a <= t < b, c <= t < e, 0.0])


@dataclass(frozen=True)
class Controller:
    """A moment -k omega, taken at whole multiples of ``every`` and used half of that time later.

    The ``delay`` counts halves of ``every``.
    """

    gain: float
    every: float
    delay: int = 1

    @property
    def lines(self) -> tuple[str, ...]:
        """Lines of [body]."""
        return ('moment = ["a1", "a2", "a3"]',)

    @property
    def tables(self) -> tuple[str, ...]:
        """Lines behind [time]."""
        values = ", ".join(f'"-{self.gain!r}*w{i}"' for i in (1, 2, 3))
        half = self.every / 2
        return (
            "[states]",
            f'm = {{ every = "{self.every!r}", value = [{values}] }}',
            f'a = {{ every = "{self.every!r}", offset = "{half!r}", start = [0, 0, 0], '
            'value = ["m1", "m2", "m3"] }',
        )

    @property
    def acting(self) -> Acting:
        """Texts in numbers: own states are the values that wait, and behind them the one that acts."""
        size = 3 * (self.delay + 1)

        def taken(t: float, v: Floats, q: Floats, own: Floats) -> Floats:
            k = round(2 * t / self.every)
            values = own.reshape(-1, 3).copy()
            if (k - self.delay) % 2 == 0:
                values[-1] = values[0] if k >= self.delay else 0.0
                values[:-2] = values[1:-1]
            if k % 2 == 0:
                values[max(0, (self.delay - 1) // 2)] = -self.gain * v
            return values.ravel()

        if not self.delay:
            return Acting(
                lambda t, v, q, own: own,
                np.zeros(3),
                taken=lambda t, v, q, own: -self.gain * v,
                every=self.every,
            )
        return Acting(
            lambda t, v, q, own: own[-3:], np.zeros(size), taken=taken, every=self.every / 2
        )


@dataclass(frozen=True)
class Surge:
    """A thrust and a quadratic drag along axis 1."""

    thrust: float
    drag: float

    @property
    def lines(self) -> tuple[str, ...]:
        """Lines of [body]."""
        return (f'force = ["{self.thrust!r} - {self.drag!r}*abs(u1)*u1", 0, 0]',)

    def load(self, t: float, v: Floats, q: Floats, own: Floats) -> Floats:
        """Return force and couple."""
        return np.asarray((self.thrust - self.drag * abs(v[0]) * v[0]) * np.eye(6)[0])


def on_grid(values: Floats) -> Floats:
    """Return the nearest multiples of 1/64."""
    return np.asarray(np.round(np.asarray(values) * GRID) / GRID)


def numbers(draw: np.random.Generator, low: float, high: float, count: int = 3) -> Floats:
    """Draw multiples of 1/64."""
    return on_grid(draw.uniform(low, high, count))


def texts(lines: list[str]) -> str:
    """Return texts as a scene has them."""
    return "[" + ", ".join(f'"{line}"' for line in lines) + "]"


def lagging(body: Sample, draw: np.random.Generator) -> Sample:
    """An own state: the moment follows what a controller asks for with a lag."""
    kp, kd, pace = (float(x) for x in numbers(draw, 0.3, 0.9, 3))
    lines = [f"{pace}*(-{kp}*q{i} - {kd}*w{i} - m{i})" for i in (1, 2, 3)]
    tables = ("[states]", f"m = {{ start = [0, 0, 0], rate = {texts(lines)} }}")
    acting = Acting(
        load=lambda t, v, q, own: own,
        start=np.zeros(3),
        rate=lambda t, v, q, own: pace * (-kp * q[1:] - kd * v - own),
    )
    return replace(body, lines=('moment = ["m1", "m2", "m3"]',), tables=tables, acting=acting)


def any_sample(sort: str, draw: np.random.Generator) -> Sample:
    """Draw a body of any sort."""
    return sample(sort, draw) if sort in SORTS else _MADE[sort](draw)


def held(load: Callable[[float, Floats, Floats, Floats], Floats], s: Sample) -> Acting:
    """Return a load that is taken at each row, and held in between."""
    empty = np.zeros(0)
    return Acting(
        lambda t, v, q, own: own,
        np.zeros(s.n),
        taken=lambda t, v, q, own: load(t, v, q, empty),
        every=float(s.times[1]),
    )


def solid_of(body: Sample, mass: float, inertia: Floats, centre: Floats, added: Floats) -> Sample:
    """Return a rigid body of principal moments about its centre of mass, with an added mass."""
    lever = skew(centre)
    tensor = np.diag(inertia) - mass * lever @ lever
    dry = np.block([[mass * np.eye(3), -mass * lever], [mass * lever, tensor]])
    keys = {"mass": mass, "inertia": inertia, "centre_of_mass": centre, "added_mass": added}
    return replace(body, mass=dry + np.diag(added), solid=keys, dry=dry)


def _solid(draw: np.random.Generator) -> Sample:
    s = sample("fluid", draw)
    heavy = float(np.round(draw.uniform(0.8, 1.5), 4))
    r = np.round(0.05 * draw.uniform(-1, 1, 3), 4)
    inertia = np.round(draw.uniform(0.2, 0.9, 3), 4)
    added = np.round(draw.uniform(0.1, 1.2, 6) * np.r_[1, 1, 1, 0.3, 0.3, 0.3], 4)
    return replace(solid_of(s, heavy, inertia, r, added), sort="solid")


def _vehicle(draw: np.random.Generator) -> Sample:
    s = _solid(draw)
    times = s.times[:40]
    until = float(np.round(times[len(times) // 3] + 0.4 * times[1], 4))
    drag = np.round(draw.uniform(0.05, 0.3, 6), 3)
    arm = np.r_[0, 0, np.round(draw.uniform(0.02, 0.1), 3)]
    of = Vehicle(float(np.round(draw.uniform(0.2, 0.6), 3)), until, drag, 9.0, arm, np.zeros(3))
    current = np.round(draw.uniform(0.1, 0.3, 3), 3)
    lines = (*of.lines, f"current = {current.tolist()}")
    acting = Acting(of.load, switches=(until,))
    return replace(
        s, sort="vehicle", lines=lines, acting=acting, source=of, times=times, current=current
    )


def _gradient(draw: np.random.Generator) -> Sample:
    s = sample("free", draw)
    of = Gradient(float(np.round(draw.uniform(0.2, 0.6), 3)), s.mass)
    times, acting = s.times[:40], Acting(of.load)
    return replace(
        s, sort="gradient", lines=of.lines, tables=of.tables, acting=acting, source=of, times=times
    )


def _pulse(draw: np.random.Generator) -> Sample:
    s = sample("free", draw)
    times = s.times[:40]
    h = float(times[1])
    edges = tuple(float(np.round((k + 0.4) * h, 4)) for k in (4, 9, 14, 20))
    of = Pulses(
        float(np.round(draw.uniform(0.1, 0.4), 3)), (edges[0], edges[1], edges[2], edges[3])
    )
    acting = Acting(of.load, switches=edges)
    return replace(s, sort="pulse", lines=of.lines, acting=acting, source=of, times=times)


def _sampled(draw: np.random.Generator) -> Sample:
    s = sample("free", draw)
    every = float(draw.choice([0.1, 0.2]))
    of = Controller(float(np.round(draw.uniform(0.2, 0.8), 3)), every)
    times = np.round(every / 2 * np.arange(30), 9)
    return replace(
        s,
        sort="sampled",
        lines=of.lines,
        tables=of.tables,
        acting=of.acting,
        source=of,
        times=times,
    )


def _lag(draw: np.random.Generator) -> Sample:
    s = sample("free", draw)
    return replace(lagging(s, draw), sort="lag", times=s.times[:40])


def _surge(draw: np.random.Generator) -> Sample:
    s = sample("fluid", draw)
    thrust, drag = np.round(draw.uniform(0.2, 0.9, 2), 1).tolist()
    of = Surge(thrust, drag)
    return replace(
        s,
        sort="surge",
        mass=np.diag(np.round(np.diag(s.mass), 2)),
        v0=np.r_[np.round(s.v0[0], 2), np.zeros(5)],
        lines=of.lines,
        acting=Acting(of.load),
        source=of,
        times=np.round(0.2 * np.arange(30), 9),
    )


_MADE: Final = {
    "solid": _solid,
    "vehicle": _vehicle,
    "gradient": _gradient,
    "pulse": _pulse,
    "sampled": _sampled,
    "lag": _lag,
    "surge": _surge,
}
