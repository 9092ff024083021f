"""Scenes drawn to be difficult, each from a number: bodies, loads, starts, units and times of all kinds."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from random import Random
from typing import Any, Final, NamedTuple

import gmpy2
from gmpy2 import log2

from referee.bodies import Scene, apply, diagonal, inverse_of, read_scene, rotation
from referee.equations import power_series, start_of
from referee.equations import velocities as velocities_of

Vector = list[Fraction]
Matrix = list[Vector]
Part = dict[str, Any]
"""A table of a scene."""

DEEPEST: Final = 40
_TERMS: Final = 12


class Draw(NamedTuple):
    """A question: a scene, times and digits."""

    kind: str
    text: str
    times: list[str]
    digits: int

    @property
    def asked(self) -> tuple[str, list[str], int]:
        """The scene, the times and the digits, which are all that an answer depends on."""
        return self.text, self.times, self.digits

    def __str__(self) -> str:
        return f"[{self.kind}, {self.digits} digits, --at={','.join(self.times)}]\n{self.text}"


def draw(number: int) -> Draw:
    """Return the question of this number. The kinds take turns."""
    rng = Random(number)
    maker = KINDS[number % len(KINDS)]
    model, body, initial = maker(rng)
    # Two hundred digits are dear: few of them, and over short times.
    digits = rng.choices([10, 40, 200], [50, 45, 5])[0]
    top = {"title": maker.__name__, "model": model, "track": _track(rng, model)}
    start = rng.choice([Fraction(0), Fraction(0), number_of(rng), Fraction(-12345, 7)])
    if rng.random() < 0.7:
        initial["attitude"] = quaternion(rng)
    if model == "kirchhoff" and rng.random() < 0.7:
        initial["centre"] = vector(rng)
    time = {"start": start, "end": start + 1, "samples": 2}
    text = scene_text(top, {"body": body, "initial": initial, "time": time})
    times = [start + elapsed for elapsed in _elapsed(rng, digits, _unit_of_time(text))]
    return Draw(maker.__name__, text, [written(t) for t in times], digits)


def _track(rng: Random, model: str) -> list[str]:
    """Return what is asked beside the vectors that are always answered."""
    if model == "euler":
        return rng.choice([["omega"], ["omega", "attitude"]])
    return rng.choice([["impulse"], ["attitude"], ["attitude", "centre"]])


def _unit_of_time(text: str) -> float:
    """Return about the radius of the power series of U and W, and at most one radian of W.

    The start is moved by a tenth along every axis: what grows from 1e-40 will be as large.
    """
    with gmpy2.context(precision=64):
        scene = read_scene(text)
        path = power_series(scene, _moved(scene), _TERMS)
        sizes = {name: [sum(map(abs, c)) for c in zip(*path[name], strict=True)] for name in "UW"}
    growths = [
        log2(terms[k] / terms[0]) / k
        for terms in sizes.values()
        for k in range(_TERMS - 3, len(terms))
        if terms[k] and terms[0]
    ]
    turns = [log2(rate) for rate in sizes["W"][:1] if rate]
    return float(2 ** -max([*growths, *turns], default=0))


def _moved(scene: Scene) -> dict[str, list[Any]]:
    """Return the state whose velocities differ from those of the start by a tenth of the largest one."""
    parts = velocities_of(scene, start_of(scene)).values()
    moved = [entry + max(map(abs, part)) / 10 for part in parts for entry in part]
    momenta = apply(inverse_of(scene.inverse), moved)
    return {name: momenta[3 * k : 3 * k + 3] for k, name in enumerate(scene.state)}


def _elapsed(rng: Random, digits: int, unit: float) -> list[Fraction]:
    """Return one to three times since the start, of either sign, sometimes long ones."""
    most: float = {10: 4, 40: 2, 200: 0.3}[digits]
    if digits < 200 and rng.random() < 0.05:
        most *= 8
    sign = rng.choice([1, 1, -1])
    times = [sign * most * unit * rng.uniform(0.01, 1) for _ in range(rng.randint(1, 3))]
    # A short text, and a time on the other side of the start now and then.
    rounded = [Fraction(f"{t:.4g}") for t in times]
    return [t if rng.random() < 0.9 else -t for t in rounded]


# Numbers


def number_of(rng: Random, largest: int = 2) -> Fraction:
    """Return a number of either sign with a few digits, or a ratio."""
    return Fraction(rng.randint(-largest * 1000, largest * 1000), rng.choice([1000, 1000, 777]))


def positive(rng: Random) -> Fraction:
    """Return a number from a quarter to four."""
    return Fraction(rng.randint(250, 4000), 1000)


def seed(rng: Random) -> Fraction:
    """Return a small power of ten, of either sign, down to 1e-40."""
    return rng.choice([1, -1]) * Fraction(1, 10 ** rng.choice([1, 3, 5, 10, 20, 30, DEEPEST]))


def vector(rng: Random) -> Vector:
    """Return three numbers: of no kind, along an axis, or along one with a seed beside it."""
    axis = diagonal([Fraction(1)] * 3)[rng.randrange(3)]
    general = [number_of(rng) for _ in range(3)]
    size = number_of(rng) or Fraction(1)
    beside = rng.choice([seed(rng), seed(rng), Fraction(0)])
    if rng.random() < 0.6:
        return general
    return [size * a + beside * g for a, g in zip(axis, general, strict=True)]


def quaternion(rng: Random) -> Vector:
    """Return a quaternion of any length, at times the identity or half a turn."""
    drawn = [Fraction(rng.randint(-3, 3)) for _ in range(4)]
    return drawn if any(drawn) else [Fraction(0), Fraction(1), Fraction(0), Fraction(0)]


def positive_matrix(rng: Random, size: int) -> Matrix:
    """Return a symmetric matrix that is positive definite: a sum of squares."""
    rows = [[Fraction(rng.randint(-4, 4), 8) * (i > j) for j in range(size)] for i in range(size)]
    for i in range(size):
        rows[i][i] = Fraction(rng.randint(5, 12), 8)
    return [
        [sum((a * b for a, b in zip(p, q, strict=True)), Fraction(0)) for q in rows] for p in rows
    ]


def turned(matrix: Matrix, turn: Matrix) -> Matrix:
    """Return R S R^T."""
    half = [apply(matrix, row) for row in turn]
    return [apply(turn, row) for row in half]


# Bodies without a fluid


Drawn = tuple[str, Part, Part]


def principal(rng: Random) -> Drawn:
    """Three moments, no two alike."""
    return "euler", {"inertia": [positive(rng) for _ in range(3)]}, {"omega": vector(rng)}


def full_tensor(rng: Random) -> Drawn:
    """All six numbers of a tensor; two of its moments are perhaps equal, or all but equal."""
    moments = rng.choice([principal, nearly_equal])(rng)[1]["inertia"]
    tensor = turned(diagonal(moments), rotation(quaternion(rng)))
    return "euler", {"inertia": tensor}, {"omega": vector(rng)}


def nearly_equal(rng: Random) -> Drawn:
    """Two or three moments that differ by a seed, or not at all."""
    first = positive(rng)
    gaps = [rng.choice([abs(seed(rng)), Fraction(0)]) for _ in range(2)]
    moments = [first, first + gaps[0], rng.choice([first + gaps[1], positive(rng)])]
    rng.shuffle(moments)
    return "euler", {"inertia": moments}, {"omega": vector(rng)}


def needle(rng: Random) -> Drawn:
    """One moment far below the others, by up to 1e-12."""
    thin = positive(rng) * Fraction(1, 10 ** rng.randint(2, 12))
    moments = [thin, positive(rng), positive(rng)]
    rng.shuffle(moments)
    return "euler", {"inertia": moments}, {"omega": vector(rng)}


def beside_an_axis(rng: Random) -> Drawn:
    """A spin about a principal axis, stable or not, with 1e-5 to 1e-40 beside it."""
    omega = [number_of(rng) * Fraction(1, 10 ** rng.randint(5, DEEPEST)) for _ in range(3)]
    omega[rng.randrange(3)] = positive(rng)
    return "euler", {"inertia": [positive(rng) for _ in range(3)]}, {"omega": omega}


def separatrix(rng: Random) -> Drawn:
    """A start from which the body goes to its middle axis for ever: |H|^2 = 2 T J2, exactly."""
    j1, j3, w1, w3 = (positive(rng) for _ in range(4))
    j2 = (j1**2 * w1**2 + j3**2 * w3**2) / (j1 * w1**2 + j3 * w3**2)
    order = rng.sample(range(3), 3)
    moments, omega = [j1, j2, j3], [w1, number_of(rng), w3]
    if rng.random() < 0.2:
        # Beside it, by a little.
        omega[0] += seed(rng)
    inertia, start = ([values[k] for k in order] for values in (moments, omega))
    return "euler", {"inertia": inertia}, {"omega": start}


def wheels(rng: Random) -> Drawn:
    """A body with wheels, now and then with a moment or damping too."""
    model, body, initial = rng.choice([principal, full_tensor, nearly_equal])(rng)
    return model, body | {"rotor": vector(rng)} | _some_of(rng, _rigid_loads(rng)), initial


def loaded_rigid(rng: Random) -> Drawn:
    """A body under a constant moment, with damping of either sign, or both."""
    model, body, initial = rng.choice([principal, full_tensor, nearly_equal, beside_an_axis])(rng)
    return model, body | (_some_of(rng, _rigid_loads(rng)) or _rigid_loads(rng)), initial


def _rigid_loads(rng: Random) -> Part:
    return {"moment": vector(rng), "damping": number_of(rng, 1) / 2}


def in_units(rng: Random) -> Drawn:
    """A spin in degrees a second, turns a minute and radians a second, mixed."""
    model, body, initial = rng.choice([principal, full_tensor, nearly_equal, separatrix])(rng)
    return model, body, {"omega": with_units(rng, initial["omega"])}


def with_units(rng: Random, rates: Vector) -> list[str]:
    """Return rates of some size in units of all kinds."""
    units = rng.choice([["deg/s"], ["rpm"], ["deg/s", "rpm", "rad/s"]])
    sizes = {"rad/s": 1, "deg/s": 60, "rpm": 10}
    drawn = [(rate, rng.choice(units)) for rate in rates]
    return [f"{written(rate * sizes[unit])} {unit}" if rate else "0" for rate, unit in drawn]


# Bodies in a fluid


def clebsch(rng: Random) -> Drawn:
    """Six coefficients, at times with p and p' all but equal."""
    p, r, r_prime = (positive(rng) for _ in range(3))
    p_prime = rng.choice([positive(rng), positive(rng), p, p + abs(seed(rng))])
    q, q_prime = (number_of(rng, 1) / 4 for _ in range(2))
    six = {"p": p, "p_prime": p_prime, "q": q, "q_prime": q_prime, "r": r, "r_prime": r_prime}
    if rng.random() < 0.4:
        six |= {"q": Fraction(0), "q_prime": Fraction(0)}
    return "kirchhoff", {"clebsch": six} | _fluid_loads(rng), fluid_start(rng)


def energy(rng: Random) -> Drawn:
    """All 21 coefficients of T."""
    matrix = positive_matrix(rng, 6)
    blocks = {
        "linear": [row[:3] for row in matrix[:3]],
        "coupling": [row[3:] for row in matrix[:3]],
        "angular": [row[3:] for row in matrix[3:]],
    }
    return "kirchhoff", {"energy": blocks} | _fluid_loads(rng), fluid_start(rng)


def mass_matrix(rng: Random) -> Drawn:
    """A vehicle by its 36 masses, at times a diagonal of six."""
    matrix = positive_matrix(rng, 6)
    if rng.random() < 0.2:
        matrix = diagonal([positive(rng) for _ in range(6)])
    return "kirchhoff", {"mass_matrix": matrix} | _fluid_loads(rng), fluid_start(rng)


def ellipsoid(rng: Random) -> Drawn:
    """Three semi-axes, some of them perhaps equal or all but equal; light, neutral and heavy."""
    density, fluid = rng.choice([(1, 0), (1, 1), (1, 1), (8, 1), ("1/10", 1), (rng.random(), 2)])
    shape = {"semi_axes": semi_axes(rng), "density": density, "fluid_density": fluid}
    start = velocities(rng)
    if rng.random() < 0.5:
        start = as_impulses({"ellipsoid": shape}, start)
    return "kirchhoff", {"ellipsoid": shape} | _fluid_loads(rng), start


def semi_axes(rng: Random) -> Vector:
    """Return three lengths: triaxial, of a spheroid, a sphere, nearly one of these, a plate or a needle."""
    first, other = positive(rng) / 2, positive(rng)
    near, thin = first + abs(seed(rng)), positive(rng) / 10 ** rng.randint(1, 3)
    axes = rng.choice(
        [
            [first, positive(rng), other],
            [first, first, other],
            [first, near, other],
            [first, near, first],
            [first, first, first],
            [first, thin, other],
        ]
    )
    return rng.sample(axes, 3)


def as_impulses(body: Part, start: Part) -> Part:
    """Return impulses of three digits that are near those of a start by velocities."""
    scene = read_scene(
        scene_text({"model": "kirchhoff"}, {"body": body, "initial": start, "time": {}})
    )
    x, y = ([Fraction(f"{float(p):.3g}") for p in values] for values in scene.state.values())
    return {"linear_impulse": x, "angular_impulse": y}


def fluid_start(rng: Random) -> Part:
    """Two impulses, one perhaps zero, along the other or across it; or two velocities."""
    if rng.random() < 0.4:
        return velocities(rng)
    x, y = vector(rng), vector(rng)
    x, y = rng.choice(
        [(x, y), (x, y), (x, y), ([Fraction(0)] * 3, y), (x, x), (x, [x[1], -x[0], Fraction(0)])]
    )
    return {"linear_impulse": x, "angular_impulse": y}


def velocities(rng: Random) -> Part:
    """The velocity of the origin and the angular velocity, perhaps in other units."""
    spin = vector(rng)
    rates = with_units(rng, spin) if rng.random() < 0.4 else spin
    return {"linear_velocity": vector(rng), "angular_velocity": rates}


def _fluid_loads(rng: Random) -> Part:
    """Nothing for half of the bodies; else a force, a couple, damping, or some of them."""
    loads = {"force": vector(rng), "couple": vector(rng), "damping": number_of(rng, 1) / 2}
    return _some_of(rng, loads) if rng.random() < 0.5 else {}


def _some_of(rng: Random, part: Part) -> Part:
    """Return each entry of a table with probability one half."""
    return {key: value for key, value in part.items() if rng.random() < 0.5}


# Ellipsoids, whose coefficients are irrational, come twice as often.
KINDS: Final[Sequence[Callable[[Random], Drawn]]] = (
    principal,
    ellipsoid,
    full_tensor,
    clebsch,
    nearly_equal,
    energy,
    needle,
    ellipsoid,
    beside_an_axis,
    mass_matrix,
    separatrix,
    wheels,
    loaded_rigid,
    in_units,
)


# The text of a scene


def scene_text(top: Part, tables: Mapping[str, Part]) -> str:
    """Return a TOML document of plain values and tables."""
    parts = [_lines(top)] + [f"[{name}]\n{_lines(table)}" for name, table in tables.items()]
    return "\n".join(parts)


def _lines(table: Part) -> str:
    return "".join(f"{key} = {_toml(value)}\n" for key, value in table.items())


def _toml(value: Any) -> str:
    """Return a value as TOML writes it; a fraction as a decimal where it is one, else as "a/b"."""
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {_toml(entry)}" for key, entry in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(map(_toml, value)) + "]"
    if isinstance(value, Fraction):
        text = written(value)
        return json.dumps(text) if "/" in text else text
    return json.dumps(value)


def written(value: Fraction) -> str:
    """Return a number as an integer, as a decimal of at most fifty places, or as "a/b"."""
    if value.denominator == 1:
        return str(value.numerator)
    shifted = value * 10**50
    if shifted.denominator > 1:
        return str(value)
    sign, digits = "-" * (value < 0), f"{abs(shifted.numerator):051d}".rstrip()
    return f"{sign}{digits[:-50]}.{digits[-50:].rstrip('0')}"
