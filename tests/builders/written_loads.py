"""Scenes under loads written as texts, and an integrator that reads the texts by itself.

The integrator is that of Gragg, Bulirsch and Stoer in mpmath, on the equations as the source texts have
them. Python's own ``eval`` reads the loads: nothing of the product's reading or of its series is shared.
Under a rotor of texts the state is the momentum P = R (I w + h) in space axes, P' = R M. Held values are
taken one instant after the other, each time all from what was before it.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Any, NamedTuple

from mpmath import mp, mpf

from builders.integrators import extrapolated
from builders.scenes import scene_text
from builders.text_functions import FUNCTIONS, Sides, tabulated, value
from taylor_verify.scenes.loads.states import Continuous, Held
from taylor_verify.scenes.reading.reader import read
from taylor_verify.scenes.scene import Scene

COLUMNS = 12
# The time in a condition or a step: that of the piece, so that a switch belongs to one of its sides.
_CLOCK = re.compile(r"\bt(?= [<>])|(?<=step\()t|(?<=sign\()t|(?<=floor\()t")
_WORD = re.compile(r"[A-Za-z]\w*")
_NUMBER = re.compile(r"(?<![\w.])(\d+\.?\d*(?:[eE][+-]?\d+)?|\.\d+)")
Vector = list[Any]

EULER = """
title = "Written loads"
model = "euler"
track = ["attitude"]
[body]
inertia = [[2, "1/8", 0], ["1/8", "5/4", "-1/16"], [0, "-1/16", "7/8"]]
moment = {moment}
{tables}
[initial]
omega = ["1/3", "-1/2", "2/5"]
attitude = [1, "1/4", "-1/8", "1/2"]
[time]
start = "1/4"
end = "{end}"
samples = 2
"""
KIRCHHOFF = """
title = "Written loads"
model = "kirchhoff"
track = ["attitude", "centre"]
[body]
force = {force}
couple = {couple}
{more}
[body.energy]
linear = [[1, "1/8", 0], ["1/8", "3/4", 0], [0, 0, "2/3"]]
coupling = [["1/16", 0, 0], [0, 0, "1/8"], [0, 0, "1/16"]]
angular = [[1, 0, "1/8"], [0, "5/4", 0], ["1/8", 0, "3/2"]]
{tables}
[initial]
linear_impulse = ["1/2", "1/4", "-1/3"]
angular_impulse = ["1/3", "-1/2", "1/4"]
attitude = [1, "1/4", "-1/8", "1/2"]
centre = [1, "1/2", "-1/4"]
[time]
start = "1/4"
end = "{end}"
samples = 2
"""
ABOUT_AXES = scene_text(
    "inertia = [1, 1, 1]\nmoment = {moment}", "omega = {omega}", time="end = {end}\nsamples = 2"
)


def about_axes(moment: str, omega: str = "[0, 0, 0]", end: str = "1") -> Scene:
    """A ball with omega for H, under a moment and from an omega as a scene has them."""
    return read(ABOUT_AXES.format(moment=moment, omega=omega, end=end), "about-axes")


def euler(moment: Sequence[str], end: str = "3/4", tables: str = "") -> Scene:
    """A rigid body with products of inertia under this moment."""
    return read(EULER.format(moment=_toml(moment), end=end, tables=tables), "written")


def kirchhoff(
    force: Sequence[str], couple: Sequence[str], end: str = "3/4", tables: str = "", more: str = ""
) -> Scene:
    """A solid with all kinds of coefficients under this force and couple."""
    vectors = {"force": _toml(force), "couple": _toml(couple)}
    return read(KIRCHHOFF.format(**vectors, end=end, tables=tables, more=more), "written")


def _toml(texts: Sequence[str]) -> str:
    return "[" + ", ".join(f'"{text}"' for text in texts) + "]"


class Evaluated:
    """The rates of a scene, its texts read by Python; y is state, quaternion, centre, and own states.

    ``values`` are the held ones by name.
    """

    def __init__(self, scene: Scene) -> None:
        body, loads = scene.body, scene.body.loads
        self._scene, self._loads = scene, loads
        self._is_euler = scene.model == "euler"
        self._matrix = [[value(c) for c in row] for row in body.energy_matrix]
        if self._is_euler:
            self._inverse = [[value(c) for c in row] for row in body.inverse_inertia]
        self._codes: dict[str, Any] = {}
        self.sides = Sides()
        self._constants: dict[str, Any] = {"pi": +mp.pi, **FUNCTIONS, **self.sides.functions()}
        if self._is_euler:
            self._constants |= {
                f"I{i + 1}{j + 1}": self._matrix[i][j] for i in range(3) for j in range(3)
            }
        entries = [e for _, es in (*loads.vectors, *loads.space) for e in es]
        entries += [e for _, e in loads.definitions]
        entries += [e for state in loads.states for e in state.entries]
        self.words = {word for e in entries if isinstance(e, str) for word in _WORD.findall(e)}
        self.clock = mpf(0)
        self._constant_wheels = [value(c) for c in body.parts().get("rotor", ())]
        self._moving = [s for s in loads.states if isinstance(s, Continuous)]
        self._sampled = [s for s in loads.states if isinstance(s, Held)]
        self.values = {
            name: value(number)
            for state in self._sampled
            for name, number in zip(
                state.components, state.start or [Fraction(0)] * len(state.value), strict=True
            )
        }

    @property
    def _size(self) -> int:
        """The number of components in front of the own states."""
        return 7 if self._is_euler else 13

    def start(self) -> Vector:
        initial = self._scene.initial
        q = [value(c) for c in initial.attitude]
        size = mp.sqrt(sum(c * c for c in q))
        centre = [] if self._is_euler else [value(c) for c in initial.centre]
        own = [value(c) for state in self._moving for c in state.start]
        z = [value(c) for c in initial.moving]
        if self._loads.rotor:
            wheels = self._wheels(value(self._loads.origin), own)
            z = _apply(rotation(q), _sum(_apply(self._matrix, z), wheels))
        return [*z, *(c / size for c in q), *centre, *own]

    def _own(self, t: Any, own: Vector) -> dict[str, Any]:
        names = [name for state in self._moving for name in state.components]
        return {**dict(zip(names, own, strict=True)), **self.values, "t": t, "clock": self.clock}

    def _wheels(self, t: Any, own: Vector) -> Vector:
        return [self._entry(entry, self._own(t, own)) for entry in self._loads.rotor]

    def omega(self, t: Any, y: Vector) -> Vector:
        """The angular velocity of a rigid body."""
        if not self._loads.rotor:
            return y[:3]
        momentum = _apply(_transposed(rotation(y[3:7])), y[:3])
        wheels = self._wheels(t, y[self._size :])
        return _apply(self._inverse, [a - h for a, h in zip(momentum, wheels, strict=True)])

    def own(self, y: Vector) -> dict[str, Vector]:
        """The components of each own state by its name."""
        names = self._own(mpf(0), y[self._size :])
        return {s.name: [names[n] for n in s.components] for s in self._loads.states}

    def take(self, t: Any, elapsed: Fraction, y: Vector) -> None:
        """Take the values of an elapsed time, all of them from what was before."""
        due = [
            state
            for state in self._sampled
            if elapsed >= state.offset and not (elapsed - state.offset) % state.every
        ]
        # Just behind the time: a switch belongs to the later piece.
        self.clock = t + mpf(10) ** -mp.dps
        names = self._meanings(t, y)
        taken = {
            name: self._entry(entry, names)
            for state in due
            for name, entry in zip(state.components, state.value, strict=True)
        }
        self.values |= taken

    def _meanings(self, t: Any, y: Vector) -> dict[str, Any]:
        """All names at a time."""
        n, own = (3 if self._is_euler else 6), self._own(t, y[self._size :])
        z, q, centre = y[:n], y[n : n + 4], y[n + 4 : self._size]
        if self._is_euler:
            w, u = self.omega(t, y), []
        else:
            u, w = _apply(self._matrix[:3], z), _apply(self._matrix[3:], z)
        self.sides.begin_evaluation()
        return self._names(own, z, q, rotation(q), w, u, centre)

    def rates(self, t: Any, y: Vector) -> Vector:
        n = 3 if self._is_euler else 6
        z, q = y[:n], y[n : n + 4]
        R = rotation(q)
        names = self._meanings(t, y)
        w, u = (
            [names[f"{letter}{i}"] for i in (1, 2, 3) if f"{letter}{i}" in names] for letter in "wu"
        )
        loads = [
            [self._entry(entry, names) for entry in entries] for _, entries in self._loads.vectors
        ]
        own = [self._entry(entry, names) for state in self._moving for entry in state.rate]
        for force, at in self._loads.hung:
            body_force = _apply(_transposed(R), [value(c) for c in force])
            parts = [body_force, _cross([value(c) for c in at], body_force)][-len(loads) :]
            loads = [_sum(a, b) for a, b in zip(loads, parts, strict=True)]
        turned = [
            -(q[1] * w[0] + q[2] * w[1] + q[3] * w[2]) / 2,
            (q[0] * w[0] + q[2] * w[2] - q[3] * w[1]) / 2,
            (q[0] * w[1] + q[3] * w[0] - q[1] * w[2]) / 2,
            (q[0] * w[2] + q[1] * w[1] - q[2] * w[0]) / 2,
        ]
        if self._loads.rotor:
            return [*_apply(R, loads[0]), *turned, *own]
        if self._is_euler:
            momentum = _apply(self._matrix, w)
            if self._constant_wheels:
                momentum = _sum(momentum, self._constant_wheels)
            return [*_apply(self._inverse, _sum(_cross(momentum, w), loads[0])), *turned, *own]
        x_rate = _sum(_cross(z[:3], w), loads[0])
        y_rate = _sum(_sum(_cross(z[3:], w), _cross(z[:3], u)), loads[1])
        drift = [value(c) for c in self._loads.current]
        return [*x_rate, *y_rate, *turned, *_sum(_apply(R, u), drift), *own]

    def _names(
        self, own: dict[str, Any], z: Vector, q: Vector, R: Any, w: Vector, u: Vector, c: Vector
    ) -> dict[str, Any]:
        names, tables = dict(own), self._loads.tables
        names |= {
            name: tabulated(table, own["t"], self.clock)
            for name, table in tables
            if name in self.words
        }
        names |= {f"q{i}": e for i, e in enumerate(q)}
        names |= {f"r{i + 1}{j + 1}": R[i][j] for i in range(3) for j in range(3)}
        for letter, vector in (("w", w), ("u", u), ("c", c)):
            names |= {f"{letter}{i}": e for i, e in enumerate(vector, 1)}
        if not self._is_euler:
            names |= {f"{a}{i + 1}": z[3 * k + i] for k, a in enumerate("xy") for i in range(3)}
        waiting = {name: e for name, e in self._loads.definitions if name in self.words}
        while waiting:
            for name, entry in list(waiting.items()):
                try:
                    names[name] = self._entry(entry, names)
                except NameError:
                    continue
                del waiting[name]
        for name, entries in self._loads.space:
            if self.words.isdisjoint(f"{name}{i}" for i in (1, 2, 3)):
                continue
            turned = _apply(_transposed(R), [self._entry(entry, names) for entry in entries])
            names |= {f"{name}{i}": e for i, e in enumerate(turned, 1)}
        return names

    def _entry(self, entry: Fraction | str, names: Mapping[str, Any]) -> Any:
        if not isinstance(entry, str):
            return value(entry)
        if entry not in self._codes:
            text = _NUMBER.sub(self._constant, _CLOCK.sub("clock", entry.replace("^", "**")))
            self._codes[entry] = compile(text, "load", "eval")
        return eval(self._codes[entry], self._constants, names)

    def _constant(self, number: re.Match[str]) -> str:
        """A name for a number, which Python would make a double."""
        name = f"number_{len(self._constants)}"
        self._constants[name] = mpf(number[1])
        return name


class End(NamedTuple):
    """State, quaternion and centre at the end, and what the last two columns of the table differ by.

    ``crosses`` is True if the motion went over a kink on its way: then the error is no such difference.
    ``own`` are the scene's own states by name.
    """

    state: Vector
    error: Any
    crosses: bool
    own: Mapping[str, Vector]


def end_of(
    scene: Scene,
    time: Fraction,
    digits: int,
    parts: int = 3,
    switches: Sequence[Fraction] = (),
    columns: int = COLUMNS,
) -> End:
    """The state at an elapsed time, to about so many digits.

    Steps end at the switches, which are times of the scene between its start and then.
    """
    with mp.workdps(digits + 15):
        equations = Evaluated(scene)
        start = scene.clock.start
        elapsed, end = Fraction(0), start + time
        ends = sorted({*switches, *instants(scene, time), end}, reverse=time < 0)
        y, now, error = equations.start(), value(start), mpf(0)
        for stop in ends:
            equations.take(now, elapsed, y)
            equations.sides.begin_piece()
            equations.clock = (now + value(stop)) / 2
            h = (value(stop) - now) / parts
            for _ in range(parts):
                y, missed = extrapolated(equations.rates, now, y, h, columns)
                now, error = now + h, error + missed
            now, elapsed = value(stop), stop - start
        equations.take(now, elapsed, y)
        if scene.model == "euler":
            y[:3] = equations.omega(now, y)
        return End(y, error, equations.sides.crosses, equations.own(y))


def instants(scene: Scene, time: Fraction) -> list[Fraction]:
    """The times of the scene after its start at which values are taken, up to an elapsed one."""
    loads = scene.body.loads
    return [
        scene.clock.start + elapsed
        for state in loads.states
        if isinstance(state, Held)
        for elapsed in (state.offset + k * state.every for k in range(int(time / state.every) + 1))
        if 0 < elapsed <= time
    ]


def rotation(q: Vector) -> list[Vector]:
    size = sum(c * c for c in q)
    a, b, c, d = q
    rows = [
        [a * a + b * b - c * c - d * d, 2 * (b * c - a * d), 2 * (b * d + a * c)],
        [2 * (b * c + a * d), a * a - b * b + c * c - d * d, 2 * (c * d - a * b)],
        [2 * (b * d - a * c), 2 * (c * d + a * b), a * a - b * b - c * c + d * d],
    ]
    return [[entry / size for entry in row] for row in rows]


def _apply(matrix: Sequence[Vector], vector: Vector) -> Vector:
    return [sum(a * b for a, b in zip(row, vector, strict=True)) for row in matrix]


def _transposed(matrix: list[Vector]) -> list[Vector]:
    return [list(column) for column in zip(*matrix, strict=True)]


def _sum(a: Vector, b: Vector) -> Vector:
    return [p + q for p, q in zip(a, b, strict=True)]


def _cross(a: Vector, b: Vector) -> Vector:
    return [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
