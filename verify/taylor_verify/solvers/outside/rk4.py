# /// script
# requires-python = ">=3.10"
# dependencies = []
# ///
"""A worked example: the classical Runge-Kutta method as a program that can be judged.

    taylor-verify run euler/generic --solver "process:python rk4.py 0.01"

It reads a scene as JSON on stdin and writes a trajectory as JSON on stdout; nothing but the standard
library is needed. The argument is the longest step, in the scene's own time. The keys are explained
in solvers/process/protocol.py of taylor-verify; rk4.c beside it is the same program in C.

H  angular momentum   K  inverse inertia    M     moment            omega = K H
x  linear impulse     y  angular impulse    A B C  T = x.A x/2 + x.B y + y.C y/2
U = A x + B y         Omega = B^T x + C y   X L   force and couple  all in body axes
q  attitude, scalar first, body to space    c     centre, in space axes
d  damping, which takes d z from the rate of z, that is H, or x and y
z* the motion H*, or x* and y*, that loads which change with time are made for (rk4.c knows none)
"""

from __future__ import annotations

import json
import math
import sys
from collections.abc import Callable
from typing import Any

Vector = list[float]
Rates = Callable[[float, Vector], Vector]
# Of a momentum z, which is H, or x and y: its rate without loads, omega, and U where there is one.
Free = Callable[[Vector], tuple[Vector, Vector, Vector]]


def floats(number: Any) -> Any:
    """Return the doubles of a number, vector or matrix: each is there as `text` and as `hex`."""
    if isinstance(number, dict):
        return floats(number["hex"])
    if isinstance(number, list):
        return [floats(entry) for entry in number]
    return float.fromhex(number)


def cross(a: Vector, b: Vector) -> Vector:
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def apply(matrix: list[Vector], v: Vector) -> Vector:
    return [row[0] * v[0] + row[1] * v[1] + row[2] * v[2] for row in matrix]


def transpose(matrix: list[Vector]) -> list[Vector]:
    return [list(row) for row in zip(*matrix, strict=True)]


def add(*vectors: Vector) -> Vector:
    return [sum(entries) for entries in zip(*vectors, strict=True)]


def attitude_rate(q: Vector, w: Vector) -> Vector:
    """Return q' = q (0, omega) / 2."""
    return [
        (-q[1] * w[0] - q[2] * w[1] - q[3] * w[2]) / 2,
        (q[0] * w[0] + q[2] * w[2] - q[3] * w[1]) / 2,
        (q[0] * w[1] + q[3] * w[0] - q[1] * w[2]) / 2,
        (q[0] * w[2] + q[1] * w[1] - q[2] * w[0]) / 2,
    ]


def to_space(q: Vector, v: Vector) -> Vector:
    """Return the vector in space axes: v + 2 r x (r x v + q0 v), r = (q1, q2, q3)."""
    r = q[1:]
    inner = cross(r, v)
    turned = cross(r, [inner[i] + q[0] * v[i] for i in range(3)])
    return [v[i] + 2 * turned[i] for i in range(3)]


def euler(body: Any) -> Free:
    """Return the free motion H' = (H + r) x K H, r the momentum of wheels."""
    K = floats(body["inverse_inertia"])
    wheels = floats(body["rotor"]) if "rotor" in body else [0.0, 0.0, 0.0]

    def free(H: Vector) -> tuple[Vector, Vector, Vector]:
        w = apply(K, H)
        return cross(add(H, wheels), w), w, []

    return free


def kirchhoff(body: Any) -> Free:
    """Return the free motion x' = x x Omega, y' = y x Omega + x x U."""
    A, B, C = floats(body["linear"]), floats(body["coupling"]), floats(body["angular"])
    B_transposed = transpose(B)

    def free(z: Vector) -> tuple[Vector, Vector, Vector]:
        x, y = z[:3], z[3:]
        U = add(apply(A, x), apply(B, y))
        w = add(apply(B_transposed, x), apply(C, y))
        return cross(x, w) + add(cross(y, w), cross(x, U)), w, U

    return free


def rates_of(
    free: Free, constant: Vector, load: Callable[[float], Vector], damping: float
) -> Rates:
    """Return the rates of the momentum z, the attitude q and, where there is a U, of c' = R U."""
    n = len(constant)

    def rates(t: float, state: Vector) -> Vector:
        q = state[n : n + 4]
        rate, w, U = free(state[:n])
        decay = [-damping * z for z in state[:n]]
        return (
            add(rate, constant, load(t), decay)
            + attitude_rate(q, w)
            + (to_space(q, U) if U else [])
        )

    return rates


def loads_of(motion: Any, start: Vector, free: Free) -> Callable[[float], Vector]:
    """Return z*' less the free rates at z*: M, or X and L; zero of a scene whose loads are constant."""
    if motion is None:
        return lambda t: [0.0] * len(start)
    waves = [floats(motion[key]) for key in ("frequencies", "cosines", "sines")]

    def load(t: float) -> Vector:
        z, rate = start, [0.0] * len(start)
        for nu, a, b in zip(*waves, strict=True):
            c, s = math.cos(nu * t), math.sin(nu * t)
            z = [v + p * (c - 1) + r * s for v, p, r in zip(z, a, b, strict=True)]
            rate = [v + nu * (r * c - p * s) for v, p, r in zip(rate, a, b, strict=True)]
        return [v - f for v, f in zip(rate, free(z)[0], strict=True)]

    return load


def step(rates: Rates, t: float, state: Vector, h: float) -> Vector:
    """Take one step of the classical Runge-Kutta method."""

    def moved(k: Vector, by: float) -> Vector:
        return [s + by * r for s, r in zip(state, k, strict=True)]

    k1 = rates(t, state)
    k2 = rates(t + h / 2, moved(k1, h / 2))
    k3 = rates(t + h / 2, moved(k2, h / 2))
    k4 = rates(t + h, moved(k3, h))
    slopes = zip(state, k1, k2, k3, k4, strict=True)
    return [s + h / 6 * (a + 2 * b + 2 * c + d) for s, a, b, c, d in slopes]


# The columns of an answer that this program knows, in the order of its state with omega for H.
COLUMNS = {
    "euler": ["w1", "w2", "w3", "q0", "q1", "q2", "q3"],
    "kirchhoff": ["x1", "x2", "x3", "y1", "y2", "y3", "q0", "q1", "q2", "q3", "c1", "c2", "c3"],
}


def known_columns(scene: Any) -> list[str]:
    """Return the columns of the scene's model; exit with a sentence if the scene asks for others."""
    model, asked = scene["model"], scene["columns"][1:]
    if model not in COLUMNS:
        sys.exit(f"rk4: expected the model {' or '.join(COLUMNS)}, got {model}")
    if unknown := [name for name in asked if name not in COLUMNS[model]]:
        expected = " ".join(COLUMNS[model])
        sys.exit(f"rk4: expected columns among {expected}, got {' '.join(unknown)} @ columns")
    return COLUMNS[model]


def main() -> None:
    longest = float(sys.argv[1]) if len(sys.argv) > 1 else 0.01
    scene = json.load(sys.stdin)
    names = known_columns(scene)
    body, initial, time = scene["body"], scene["initial"], scene["time"]

    # The quaternion is given with any length.
    q = floats(initial["attitude"])
    length = math.sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3])
    q = [entry / length for entry in q]
    if scene["model"] == "euler":
        start, constant = floats(initial["angular_momentum"]), floats(body["moment"])
        free, centre = euler(body), []
    else:
        start = floats(initial["linear_impulse"]) + floats(initial["angular_impulse"])
        constant = floats(body["force"]) + floats(body["couple"])
        free, centre = kirchhoff(body), floats(initial["centre"])
    damping = floats(body["damping"]) if "damping" in body else 0.0
    rates = rates_of(free, constant, loads_of(scene.get("manufactured"), start, free), damping)
    state = start + q + centre

    rows, steps, now = [], 0, 0.0
    for instant in floats(time["elapsed"]):
        # Whole steps of equal length from sample to sample, so that none is interpolated.
        count = math.ceil(abs(instant - now) / longest)
        h = (instant - now) / count if count else 0.0
        for k in range(count):
            state = step(rates, now + k * h, state, h)
        steps, now = steps + count, instant
        # The answer has omega in place of H.
        rows.append(free(state[:3])[1] + state[3:] if scene["model"] == "euler" else state)

    # Hexadecimal floats are exact; plain numbers would do on f32 and f64.
    columns = dict(zip(names, zip(*rows, strict=True), strict=True))
    answer: dict[str, Any] = {"t": time["times"]["hex"], "steps": steps, "evaluations": 4 * steps}
    for name in scene["columns"][1:]:
        answer[name] = [value.hex() for value in columns[name]]
    json.dump(answer, sys.stdout)


if __name__ == "__main__":
    main()
