"""Scenes under loads written as texts, and an integrator that reads the texts by itself.

The integrator is that of Gragg, Bulirsch and Stoer in mpmath, on the equations as the source texts have
them. Python's own ``eval`` reads the loads: nothing of the product's reading or of its series is shared.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from typing import Any, NamedTuple

from mpmath import mp, mpf

from taylor_verify.scenes.loads.tables import Table
from taylor_verify.scenes.reading.reader import read
from taylor_verify.scenes.scene import Scene

COLUMNS = 12
# The time in a condition or a step: that of the piece, so that a switch belongs to one of its sides.
_CLOCK = re.compile(r"\bt(?= [<>])|(?<=step\()t|(?<=sign\()t")
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
ABOUT_AXES = """
title = "About axes"
model = "euler"
[body]
inertia = [1, 1, 1]
moment = {moment}
[initial]
omega = {omega}
[time]
end = {end}
samples = 2
"""


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


def value(number: Fraction) -> Any:
    return mpf(number.numerator) / number.denominator


FUNCTIONS: Mapping[str, Callable[..., Any]] = {
    name: getattr(mp, name)
    for name in ("sqrt", "exp", "log", "sin", "cos", "tan", "asin", "acos", "atan", "atan2")
} | {
    "sinh": mp.sinh, "cosh": mp.cosh, "tanh": mp.tanh, "abs": abs, "min": min, "max": max,
    "pow": lambda a, b: a**b, "norm": lambda *parts: mp.sqrt(sum(p * p for p in parts)),
    "clip": lambda x, low, high: min(max(x, low), high),
    "step": lambda x: mpf(x >= 0), "sign": mp.sign,
}  # fmt: skip


class Sides:
    """The sides of its kinks on which a motion was, in the order in which its texts ask for them."""

    def __init__(self) -> None:
        self.crosses = False
        self.begin_piece()

    def begin_piece(self) -> None:
        self._signs: list[int] = []
        self.begin_evaluation()

    def begin_evaluation(self) -> None:
        self._next = 0

    def _watch(self, value: Any) -> None:
        side = int(mp.sign(value))
        if self._next == len(self._signs):
            self._signs.append(side)
        elif side and self._signs[self._next] != side:
            self.crosses |= bool(self._signs[self._next])
            self._signs[self._next] = side
        self._next += 1

    def functions(self) -> Mapping[str, Callable[..., Any]]:
        def watched(function: str, *differences: Callable[..., Any]) -> Callable[..., Any]:
            def value(*arguments: Any) -> Any:
                for difference in differences:
                    self._watch(difference(*arguments))
                return FUNCTIONS[function](*arguments)

            return value

        return {
            "abs": watched("abs", lambda a: a),
            "min": watched("min", lambda a, b: a - b),
            "max": watched("max", lambda a, b: a - b),
            "clip": watched("clip", lambda x, low, _: x - low, lambda x, _, high: x - high),
        }


def tabulated(table: Table, t: Any, clock: Any) -> Any:
    """The value of a table at t, which is in the same piece as the clock."""
    times, values = ([value(entry) for entry in entries] for entries in (table.times, table.values))
    k = sum(time <= clock for time in times) - 1
    if k < 0 or k == len(times) - 1:
        return values[max(k, 0)]
    if table.kind == "hold":
        return values[k]
    bends = _bends(times, values) if table.kind == "cubic" else [mpf(0)] * len(times)
    width = times[k + 1] - times[k]
    a, b = (times[k + 1] - t) / width, (t - times[k]) / width
    bend = (a**3 - a) * bends[k] + (b**3 - b) * bends[k + 1]
    return a * values[k] + b * values[k + 1] + bend * width**2 / 6


def _bends(times: Vector, values: Vector) -> Vector:
    """The second derivatives of the natural spline, by a linear system of all of them."""
    n = len(times)
    matrix, right = mp.eye(n), mp.zeros(n, 1)
    for k in range(1, n - 1):
        before, after = times[k] - times[k - 1], times[k + 1] - times[k]
        matrix[k, k - 1], matrix[k, k], matrix[k, k + 1] = before, 2 * (before + after), after
        right[k] = 6 * ((values[k + 1] - values[k]) / after - (values[k] - values[k - 1]) / before)
    return list(mp.lu_solve(matrix, right))


class Evaluated:
    """The rates of a scene, its texts read by Python; y is state, quaternion and centre."""

    def __init__(self, scene: Scene) -> None:
        body, loads = scene.body, scene.body.loads
        assert loads is not None
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
        self.words = {word for e in entries if isinstance(e, str) for word in _WORD.findall(e)}
        self.clock = mpf(0)

    def start(self) -> Vector:
        initial = self._scene.initial
        q = [value(c) for c in initial.attitude]
        size = mp.sqrt(sum(c * c for c in q))
        centre = [] if self._is_euler else [value(c) for c in initial.centre]
        return [*map(value, initial.moving), *(c / size for c in q), *centre]

    def rates(self, t: Any, y: Vector) -> Vector:
        n = 3 if self._is_euler else 6
        z, q = y[:n], y[n : n + 4]
        R = rotation(q)
        if self._is_euler:
            w, u = z, []
        else:
            u, w = _apply(self._matrix[:3], z), _apply(self._matrix[3:], z)
        self.sides.begin_evaluation()
        names = self._names(t, z, q, R, w, u, y[n + 4 :])
        loads = [
            [self._entry(entry, names) for entry in entries] for _, entries in self._loads.vectors
        ]
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
        if self._is_euler:
            momentum = _apply(self._matrix, w)
            return [*_apply(self._inverse, _sum(_cross(momentum, w), loads[0])), *turned]
        x_rate = _sum(_cross(z[:3], w), loads[0])
        y_rate = _sum(_sum(_cross(z[3:], w), _cross(z[:3], u)), loads[1])
        drift = [value(c) for c in self._loads.current]
        return [*x_rate, *y_rate, *turned, *_sum(_apply(R, u), drift)]

    def _names(self, t: Any, z: Vector, q: Vector, R: Any, w: Vector, u: Vector, c: Vector) -> Any:
        tables = self._loads.tables
        names = {
            name: tabulated(table, t, self.clock) for name, table in tables if name in self.words
        }
        names |= {"t": t, "clock": self.clock}
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
    """

    state: Vector
    error: Any
    crosses: bool


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
        ends = sorted([*switches, start + time], reverse=time < 0)
        y, now, error = equations.start(), value(start), mpf(0)
        for end in map(value, ends):
            equations.sides.begin_piece()
            equations.clock = (now + end) / 2
            h = (end - now) / parts
            for _ in range(parts):
                y, missed = _extrapolated(equations.rates, now, y, h, columns)
                now, error = now + h, error + missed
            now = end
        return End(y, error, equations.sides.crosses)


def _extrapolated(
    rates: Callable[[Any, Vector], Vector], t: Any, y: Vector, h: Any, columns: int
) -> tuple[Vector, Any]:
    """Take one large step: the modified midpoint rule at 2, 4, .. small ones, extrapolated to none."""
    table: list[list[Vector]] = []
    for j in range(1, columns + 1):
        row = [_midpoint(rates, t, y, h, 2 * j)]
        for k in range(1, j):
            ratio = (mpf(j) / (j - k)) ** 2
            row.append(
                [b + (b - a) / (ratio - 1) for a, b in zip(table[-1][k - 1], row[-1], strict=True)]
            )
        table.append(row)
    last, before = table[-1][-1], table[-2][-1]
    return last, max(abs(a - b) for a, b in zip(last, before, strict=True))


def _midpoint(
    rates: Callable[[Any, Vector], Vector], t: Any, y: Vector, h: Any, count: int
) -> Vector:
    s = h / count
    before, here = y, [a + s * r for a, r in zip(y, rates(t, y), strict=True)]
    for k in range(1, count):
        rate = rates(t + k * s, here)
        before, here = here, [a + 2 * s * r for a, r in zip(before, rate, strict=True)]
    rate = rates(t + h, here)
    return [(a + b + s * r) / 2 for a, b, r in zip(before, here, rate, strict=True)]


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
