"""Widths of `enclose` beside those of codac: `python -m benches.beside_codac`, with tests on the path.

Each example goes from a point that doubles hold to t = 1. codac's tubes have steps of 1/500. The true error
is that of the middle of a box; the truth has 40 digits. A second table has our widths of what CAPD and
TaylorModels.jl print of themselves.
"""

from __future__ import annotations

import json
import re
import subprocess
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Final

from mpmath import mp, mpf

from taylor_verify import enclose

SCRIPT: Final = Path(__file__).with_name("with_codac.py")
STEP: Final = 1 / 500
DIGITS: Final = 30
CUBE: Final = "(sqrt(sqr(x) + sqr(y))*(sqr(x) + sqr(y)))"

# The start and the rates by name. Those that read the time, codac's contractor does not take.
EXAMPLES: Final[dict[str, tuple[dict[str, float], Sequence[str]]]] = {
    "Lorenz": ({"x": 1, "y": 1, "z": 1}, ("10*(y - x)", "x*(28 - z) - y", "x*y - z*8/3")),
    "Henon-Heiles": (
        {"x": 0.125, "y": -0.25, "p": 0.3125, "q": 0},
        ("p", "q", "-x - 2*x*y", "-y - sqr(x) + sqr(y)"),
    ),
    "Kepler": (
        {"x": 0.875, "y": 0, "u": 0, "v": 1.125},
        ("u", "v", f"-x/{CUBE}", f"-y/{CUBE}"),
    ),
    "van der Pol": ({"x": 2, "v": 0}, ("v", "(1 - sqr(x))*v - x")),
    "DETEST A2": ({"y": 1}, ("-y*sqr(y)/2",)),
    "DETEST B1": ({"a": 1, "b": 3}, ("2*(a - a*b)", "-(b - a*b)")),
    "rigid body": ({"a": 1, "b": 0, "c": 0.875}, ("-2*b*c", "1.25*a*c", "-a*b/2")),
    "pendulum": ({"a": 2, "b": 0}, ("b", "-sin(a)")),
}

# The start, the rates, the first and the last time of each.
PRINTED: Final[dict[str, tuple[dict[str, Any], dict[str, str], int, float]]] = {
    "CAPD, ITimeMapSolutionCurveExample": (
        {"x": 1, "v": 2}, {"x": "v", "v": "sin(t) - sin(x)"}, 4, 10,
    ),
    "ReachabilityAnalysis.jl, issue 415": (
        {"x": "1.4", "v": "2.4"}, {"x": "v", "v": "(1 - x^2)*v - x"}, 0, 0.17843191487722487,
    ),
    "TaylorModels.jl, issue 114": (
        {"x": 1, "y": 1}, {"x": "1 + x^2*y - 2.5*x", "y": "1.5*x - x^2*y"}, 0, 30,
    ),
}  # fmt: skip


def main() -> None:
    """Print a row for each example: width, error of the middle and processor time of both."""
    print("| equations | width | error | time | codac: width | error | time |")
    print("|---|---|---|---|---|---|---|")
    for (name, (start, rates)), (box, seconds) in zip(EXAMPLES.items(), _by_codac(), strict=True):
        texts = {n: _as_ours(rate) for n, rate in zip(start, rates, strict=True)}
        truth = [motion[0] for motion in _by_enclose(texts, start, 40)[0]]
        entries, ours = _by_enclose(texts, start, DIGITS)
        middles = [(mpf(low) + mpf(high)) / 2 for low, high in box]
        figures = [
            *_figures([2 * e for _, e in entries], [m for m, _ in entries], truth, ours),
            *_figures([mpf(high) - mpf(low) for low, high in box], middles, truth, seconds),
        ]
        print("|", " | ".join((name, *figures)), "|")
    print("| printed by | width | time |")
    print("|---|---|---|")
    for name, (begin, texts, first, last) in PRINTED.items():
        entries, ours = _by_enclose(texts, begin, DIGITS, first, last)
        print(
            "|",
            " | ".join((name, mp.nstr(max(2 * e for _, e in entries), 2), f"{ours:.2g} s")),
            "|",
        )


def _as_ours(rate: str) -> str:
    return re.sub(r"sqr\((\w)\)", r"\1^2", rate)


def _figures(
    widths: Sequence[Any], middles: Sequence[Any], truth: Sequence[Any], seconds: float
) -> list[str]:
    with mp.workdps(60):
        error = max(abs(middle - exact) for middle, exact in zip(middles, truth, strict=True))
    return [mp.nstr(max(widths), 2), mp.nstr(error, 2), f"{seconds:.2g} s"]


def _by_codac() -> Any:
    asked = [
        {"names": [*start], "rates": rates, "start": [*start.values()], "end": 1.0, "step": STEP}
        for start, rates in EXAMPLES.values()
    ]
    words = ["uv", "run", "--no-project", str(SCRIPT)]
    answer = subprocess.run(
        words, input=json.dumps(asked), capture_output=True, text=True, check=True
    )
    return json.loads(answer.stdout)


def _by_enclose(
    rates: dict[str, str], start: dict[str, Any], digits: int, begin: int = 0, end: float = 1
) -> tuple[list[tuple[Any, Any]], float]:
    """The middle and the proven error of each number at the end, and the processor time."""
    began = time.process_time()
    motion = enclose(rates, start, [end], digits, begin)
    seconds = time.process_time() - began
    return [(motion[name][0], motion.errors[name][0]) for name in start], seconds


if __name__ == "__main__":
    main()
