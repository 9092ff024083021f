# /// script
# requires-python = ">=3.11,<3.15"
# dependencies = [
#   "numba==0.68.1",
#   "numpy==2.4.6",
#   "scipy==1.17.1",
# ]
# [tool.taylor-verify]
# title = "Dormand-Prince 8(5,3), compiled by numba with the equations in it"
# serves = true
# [tool.taylor-verify.settings]
# rtol = 1e-9
# atol = "rtol"
# ///
"""DOP853 without a library: the method and the equations in one function, compiled by numba.

This is the fastest that the method can be on these equations: libraries call them by an address, or by way
of Python, and here they are in line. The coefficients are SciPy's, and so are the norm of the error, the
choice of steps and the interpolant, after Hairer, Norsett and Wanner, Solving Ordinary Differential
Equations I (1993), II.5, II.6 and II.10. The three evaluations that the interpolant takes are made in
those steps alone that hold a sample.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from question import (
    Question,
    Settings,
    Solved,
    answer,
    compiled_rates,
    once_for_equations,
    twice,
)

# The method as text: numba compiles the sums over stages written out, without the zeros among them.
# y  state, k0..k15  rates at the stages, h  step, z, w  rooms for states, c  the interpolant's coefficients
_METHOD = """
def propagate(y, instants, out, rtol, atol):
    {rooms}
    n, samples, end = {n}, len(instants), instants[-1]
    t, place, steps, evaluations = 0.0, 0, 0, 2
    while place < samples and instants[place] <= 0.0:
        out[place] = y
        place += 1
    fill(y, k0)
    h = first_step(fill, y, k0, z, k1, end, rtol, atol)
    grows = 10.0
    while place < samples:
        h = min(h, end - t)
        {stages}
        evaluations += 12
        e3 = e5 = 0.0
        for i in range(n):
            scale = atol + max(abs(y[i]), abs(z[i])) * rtol
            a, b = ({error5}) / scale, ({error3}) / scale
            e5, e3 = e5 + a * a, e3 + b * b
        down = e5 + 0.01 * e3
        error = h * e5 / math.sqrt(down * n) if down > 0.0 else 0.0
        if not error < 1.0:
            if not h > 1e-14 * (end + h):
                return steps, evaluations, False
            h *= max(0.2, 0.9 * error ** -0.125) if error > 0.0 else 0.2
            grows = 1.0
            continue
        steps += 1
        # What is left of the way after the last step is rounding.
        after = end if h >= (end - t) * (1.0 - 1e-15) else t + h
        if instants[place] <= after:
            {more}
            evaluations += 3
            for i in range(n):
                d = z[i] - y[i]
                c[0, i], c[1, i], c[2, i] = d, h * k0[i] - d, 2.0 * d - h * (k12[i] + k0[i])
                {dense}
            while place < samples and instants[place] <= after:
                x = (instants[place] - t) / h
                for i in range(n):
                    v = c[6, i] * x
                    v = (v + c[5, i]) * (1.0 - x)
                    v = (v + c[4, i]) * x
                    v = (v + c[3, i]) * (1.0 - x)
                    v = (v + c[2, i]) * x
                    v = (v + c[1, i]) * (1.0 - x)
                    out[place, i] = y[i] + (v + c[0, i]) * x
                place += 1
        h *= min(grows, max(0.2, 0.9 * error ** -0.125)) if error > 0.0 else grows
        grows = 10.0
        t = after
        for i in range(n):
            y[i], k0[i] = z[i], k12[i]
    return steps, evaluations, True


def first_step(fill, y, k0, z, k1, end, rtol, atol):
    d0 = d1 = d2 = 0.0
    n = {n}
    for i in range(n):
        scale = atol + abs(y[i]) * rtol
        d0, d1 = d0 + (y[i] / scale) ** 2, d1 + (k0[i] / scale) ** 2
    d0, d1 = math.sqrt(d0 / n), math.sqrt(d1 / n)
    h0 = min(1e-6 if d0 < 1e-5 or d1 < 1e-5 else 0.01 * d0 / d1, end)
    for i in range(n):
        z[i] = y[i] + h0 * k0[i]
    fill(z, k1)
    for i in range(n):
        d2 += ((k1[i] - k0[i]) / (atol + abs(y[i]) * rtol)) ** 2
    d2 = math.sqrt(d2 / n) / h0
    top = max(d1, d2)
    h1 = max(1e-6, h0 * 1e-3) if top <= 1e-15 else (0.01 / top) ** 0.125
    return min(100.0 * h0, h1, end)
"""


def solve(question: Question, settings: Settings) -> Solved:
    import numpy

    instants = numpy.array(question.instants)

    def propagate() -> tuple[Any, int, int, bool]:
        state = numpy.array(question.state)
        rows = numpy.empty((instants.size, state.size))
        compiled = _compiled(question)
        return rows, *compiled(state, instants, rows, settings.rtol, settings.atol)

    (rows, steps, evaluations, arrived), seconds, compiling = twice(propagate)
    if not arrived:
        raise SystemExit(f"DOP853: no step is short enough after {steps} steps")
    return Solved(rows, steps, evaluations, seconds, compiling, again=propagate)


@once_for_equations
def _compiled(question: Question) -> Any:
    import math

    from numba import njit

    jit = njit(fastmath={"contract"}, error_model="numpy")
    made: dict[str, Any] = {"math": math, "fill": compiled_rates(question)}
    exec(_text(len(question.state)), made)
    made["first_step"] = jit(made["first_step"])
    return jit(made["propagate"])


def _text(n: int) -> str:
    """Return the method for so many states."""
    from scipy.integrate._ivp import dop853_coefficients as of

    rooms = [f"k{s}" for s in range(of.N_STAGES_EXTENDED)]
    lines = {
        "rooms": [
            *(f"{room} = np.empty({n})" for room in [*rooms, "z", "w"]),
            f"c = np.empty((7, {n}))",
        ],
        "stages": [*_stages(of.A[1 : of.N_STAGES], 1), *_stages([of.B], of.N_STAGES)],
        "more": [*_stages(of.A[of.N_STAGES + 1 :], of.N_STAGES + 1, "w")],
        "dense": [f"c[{3 + j}, i] = h * ({_sum(row)})" for j, row in enumerate(of.D)],
    }
    text = _METHOD
    for name, code in lines.items():
        (line,) = [row for row in text.splitlines() if row.strip() == f"{{{name}}}"]
        indent = line[: -len(line.lstrip())]
        text = text.replace(line, "\n".join(indent + row for row in code))
    text = text.replace("{error5}", _sum(of.E5)).replace("{error3}", _sum(of.E3))
    return "import numpy as np\n" + text.replace("{n}", str(n))


def _stages(rows: Any, first: int, room: str = "z") -> Iterator[str]:
    """Yield the lines that fill the rates of some stages, the first of them of that number."""
    for stage, row in enumerate(rows, first):
        yield f"for i in range(n): {room}[i] = y[i] + h * ({_sum(row)})"
        yield f"fill({room}, k{stage})"


def _sum(row: Any) -> str:
    """Return the sum of the rates with these weights, without those of weight 0."""
    return " + ".join(f"{float(a)!r} * k{s}[i]" for s, a in enumerate(row) if a)


if __name__ == "__main__":
    answer(solve)
