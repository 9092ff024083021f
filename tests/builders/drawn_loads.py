"""Scenes under loads that are drawn: every function and every name, in both directions of time.

With states of their own they have wheels that are driven, lags, integrals, and values that are held, late,
and jump with the state; then they run forward.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from random import Random
from typing import NamedTuple

from taylor_verify.scenes.reading.reader import read
from taylor_verify.scenes.scene import Scene

EULER = """
title = "Drawn loads"
model = "euler"
track = ["attitude"{track}]
[body]
inertia = {body}
moment = {loads[0]}
{hung}
{tables}
{states}
[initial]
omega = {start[0]}
attitude = {attitude}
[time]
start = "{begin}"
at = ["{end}"]
"""
KIRCHHOFF = """
title = "Drawn loads"
model = "kirchhoff"
track = ["attitude", "centre"{track}]
[body]
{body}
force = {loads[0]}
couple = {loads[1]}
{hung}
{tables}
{states}
[initial]
linear_impulse = {start[0]}
angular_impulse = {start[1]}
attitude = {attitude}
centre = {start[2]}
[time]
start = "{begin}"
at = ["{end}"]
"""
INERTIAS = (
    "[1, 2, 3]",
    "[2, 2, 1]",
    '[[2, "1/8", 0], ["1/8", "5/4", "-1/16"], [0, "-1/16", "7/8"]]',
)
SOLIDS = (
    "clebsch = { p = 1, p_prime = 2, q = 0, q_prime = 0, r = 1, r_prime = 0.5 }",
    'clebsch = { p = "3/4", p_prime = 1, q = "1/8", q_prime = "-1/16", r = "2/3", r_prime = 1 }',
    'energy = { linear = [[1, "1/8", 0], ["1/8", "3/4", 0], [0, 0, "2/3"]], '
    'coupling = [["1/16", 0, 0], [0, 0, "1/8"], [0, 0, "1/16"]], '
    'angular = [[1, 0, "1/8"], [0, "5/4", 0], ["1/8", 0, "3/2"]] }',
    "mass = 2\ninertia = [1, 2, 1.5]\ncentre_of_mass = [0, 0, 0.1]\nadded_mass = [0.1, 1, 1, 0, 0.5, 0.5]",
)
HUNG = "weight = {{ force = {0}, at = {1} }}\nbuoyancy = {{ force = {2} }}"
CURRENT = "current = {0}"
TABLES = """
[define]
n = "1/2"
v = "norm(w1, w2, w3, n)"
[space]
b = ["cos(n*t)", "sin(n*t)/2", "1/3"]
[tables]
p = {{ times = [{times}], values = [{values}], kind = "{kind}" }}
"""
NUMBERS = ("1", "2", "0.5", "1/3", "3/4", "0.2", "1.5")
# What a formula is made of others by. The places of roots, logarithms and divisors stay where they exist.
FORMS = (
    "{a} + {b}", "{a} - {b}", "({a})*({b})", "-({a})", "({a})^2", "({a})^3/4", "({a})/(2 + cos({b}))",
    "sqrt(3 + sin({a}))", "log(3 + cos({a}))", "exp(-({a})^2)", "exp(sin({a}))", "sin({a})", "cos({a})",
    "tan(sin({a})/2)", "asin(tanh({a})/2)", "acos(sin({a})/3)", "atan({a})", "atan2({a}, 2 + sin({b}))",
    "atan2(2 + sin({a}), {b})", "sinh(sin({a}))", "cosh(tanh({a}))", "tanh(3*({a}))", "(2 + cos({a}))^-1.5",
    "(2 + sin({a}))^(2/3)", "pow(3 + sin({a}), -1/3)", "(2 + sin({a}))^(tanh({b}))", "norm({a}, {b}, 1/3)",
)  # fmt: skip
KINKS = ("abs({a})", "min({a}, {b})", "max({a}, {b})", "clip({a}, -{c}, {c})")
SWITCHED = (
    "({a} if t < {s} else {b})",
    "({a} if t >= {s} else {b})",
    "step(t - {s})*({a})",
    "sign(t - {s})*({a})",
)


JUMPS = (
    "sign({a})", "step({a} - {c})", "floor(3*({a}))/4", "({a} if {b} > {c} else -{c})",
    "({a} if {a} <= {b} else {b})", "(0 if abs({a}) < {c} else {b})", "floor(t*{n})/{n}",
)  # fmt: skip
ROTORS = (
    ("h1", "h2", "h3"), ("h1 + f/3", "0.2", "-h3/2"), ("tanh(h1)", "sin(2*t)/5", "h2*h3"),
    ("1/3", "f", "0"),
    ("clip(h1, -2, 2)", "k2/4", "exp(-f^2)/3"),
)  # fmt: skip


class Drawn(NamedTuple):
    """A scene, its one time since the start, and the switches on the way, as times of the scene."""

    scene: Scene
    text: str
    elapsed: Fraction
    switches: Sequence[Fraction]


class _Formulas:
    """Formulas of some names, whose switches come from one list of times."""

    def __init__(self, random: Random, names: Sequence[str], times: Sequence[Fraction]) -> None:
        self._random, self._names, self._times = random, names, times
        self.may_jump = False
        self.switches: set[Fraction] = set()
        self.reads_table = False

    def vector(self, size: int = 3) -> str:
        return "[" + ", ".join(f'"{self.entry()}"' for _ in range(size)) + "]"

    def entry(self) -> str:
        kind = self._random.randrange(8)
        if kind == 0:
            return "0"
        factor = self._random.choice(("1/2", "-1/3", "0.4", "-0.25"))
        return f"{factor}*({self.formula(2 if kind < 4 else 1)})"

    def formula(self, depth: int) -> str:
        random = self._random
        if not depth:
            name, number = random.choice(self._names), random.choice(NUMBERS)
            self.reads_table |= name == "p"
            return random.choice((name, name, f"{number}*{name}", f"{name} - {number}"))
        kinds = (FORMS, FORMS, FORMS, FORMS, KINKS, SWITCHED)
        form = random.choice(random.choice((*kinds, JUMPS, JUMPS) if self.may_jump else kinds))
        switch = random.choice(self._times)
        if "{s}" in form:
            self.switches.add(switch)
        a, b = self.formula(depth - 1), self.formula(depth - 1)
        return form.format(a=a, b=b, c=random.choice(NUMBERS), s=switch, n=random.choice((2, 5, 8)))


class _States:
    """States of a scene's own: wheels h, a lag f, an integral k, held m, and a that is late."""

    names = ("h1", "h2", "h3", "f", "k1", "k2", "m1", "m2", "a")

    def __init__(self, random: Random, formulas: _Formulas, elapsed: Fraction) -> None:
        self._random, self._formulas, self._elapsed = random, formulas, elapsed

    def table(self) -> str:
        f, random = self._formulas, self._random
        rates = {"h": f.vector(), "f": f'"{f.entry()} - 3*f"', "k": f.vector(2)}
        starts = {"h": _vector(random), "f": random.choice(("0", '"1/3"')), "k": "[0, -0.5]"}
        lines = [f"{n} = {{ start = {starts[n]}, rate = {rates[n]} }}" for n in rates]
        f.may_jump = True
        late = f'"{random.choice(("m1", "m2/2 + a/3", f.entry()))}"'
        every = [self._elapsed * Fraction(random.choice((1, 2, 3)), 8) for _ in range(2)]
        offset = random.choice((Fraction(0), self._elapsed / 16, self._elapsed / 3))
        lines += [
            f'm = {{ every = "{every[0]}", start = [0, "1/4"], value = {f.vector(2)} }}',
            f'a = {{ every = "{every[1]}", offset = "{offset}", start = 0.5, value = {late} }}',
        ]
        f.may_jump = False
        return "\n".join(["[states]", *lines])


def drawn(random: Random, with_states: bool = False) -> Drawn:
    """A scene whose span is short, with what it needs to be followed by any integrator."""
    is_euler = random.random() < 0.5
    begin = Fraction(random.choice(("0", "1/4", "-2")))
    elapsed = Fraction(random.choice((1, 2, 3)), 8) * random.choice((1, 1, -1))
    elapsed = abs(elapsed) if with_states else elapsed
    end = begin + elapsed
    times = [begin + elapsed * Fraction(k, 8) for k in (1, 3, 5, 6)]
    names = _names(random, is_euler)
    formulas = _Formulas(random, [*names, *_States.names * 2] if with_states else names, times)
    states = _States(random, formulas, elapsed).table() if with_states else ""
    loads = [formulas.vector() for _ in range(1 if is_euler else 2)]
    knots = sorted({begin + elapsed * Fraction(k, 8) for k in (-1, 2, 4, 7)})
    tables = TABLES.format(
        times=", ".join(f'"{time}"' for time in knots),
        values=", ".join(random.choice(("0", '"1/2"', "-1", "0.3")) for _ in knots),
        kind=random.choice(("hold", "linear", "cubic")),
    )
    switches = formulas.switches | (set(knots) if formulas.reads_table else set())
    text = (EULER if is_euler else KIRCHHOFF).format(
        body=random.choice(INERTIAS if is_euler else SOLIDS),
        loads=loads,
        hung=_hung(random, is_euler) + (_rotor(random) if with_states and is_euler else ""),
        states=states,
        track=', "h", "f", "k", "m", "a"' if with_states else "",
        tables=tables,
        start=[_vector(random) for _ in range(3)],
        attitude='[1, "1/4", "-1/8", "1/2"]' if random.random() < 0.8 else "[0, 1, 0, 0]",
        begin=begin,
        end=end,
    )
    low, high = sorted((begin, end))
    inside = sorted(time for time in switches if low < time < high)
    return Drawn(read(text, "drawn"), text, elapsed, inside)


def _names(random: Random, is_euler: bool) -> Sequence[str]:
    """Return the names of the momenta, or these with the attitude, or all."""
    names = ["w1", "w2", "w3", "t", "p", "v", "pi"]
    names += ["I11", "I23"] if is_euler else [f"{a}{i}" for a in "uxy" for i in (1, 2, 3)]
    more = random.randrange(3)
    if more:
        names += ["b1", "b2", "b3", "q0", "q2", "r12", "r31", "r33"]
    if more == 2 and not is_euler:
        names += ["c1", "c2", "c3"]
    return names


def _hung(random: Random, is_euler: bool) -> str:
    lines = []
    if random.random() < 0.3:
        vectors = [_vector(random) for _ in range(3)]
        lines.append(HUNG.format(*vectors))
    if not is_euler and random.random() < 0.3:
        lines.append(CURRENT.format(_vector(random)))
    return "\n".join(lines)


def _rotor(random: Random) -> str:
    """Wheels that are driven, in most scenes."""
    texts = ", ".join(f'"{text}"' for text in random.choice(ROTORS))
    return f"\nrotor = [{texts}]" if random.random() < 0.7 else ""


def _vector(random: Random) -> str:
    """Three numbers, many of which are exactly zero."""
    picked = (random.choice(("0", "0", '"1/3"', "-0.5", '"2/5"', "1", "1e-30")) for _ in range(3))
    return f"[{', '.join(picked)}]"
