"""What the exact solutions cost, as times of one run and as ratios within it: `make bench`.

No test asserts a time. What is compared is taken in turns within one process, several times over, with
the garbage collector off; in processor time, so that a neighbour on the machine counts little.
"""

from __future__ import annotations

import gc
import platform
import statistics
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import partial
from importlib.metadata import version
from pathlib import Path

from verify.exact.route import solution
from verify.exact.sensitivity import sensitivity
from verify.exact.solution import Solution
from verify.scenes.reader import load
from verify.scenes.scene import Scene

ROUNDS = 5
FEW_TIMES, FEW_DIGITS = 40, 50
MANY_TIMES, MANY_DIGITS, MANY_ROUNDS = 10_000, 40, 3
SENSITIVE_TIMES, SENSITIVE_DIGITS = 10, 15
# One of every elliptic regime, and a body beside its separatrix.
ELLIPTIC = (
    "euler/with-attitude",
    "euler/full-tensor",
    "euler/tennis-racket",
    "kirchhoff/whole-motion",
    "kirchhoff/two-real-roots",
    "kirchhoff/cubic",
)
WHOLE = ("euler/with-attitude", "kirchhoff/whole-motion")


@dataclass(frozen=True)
class Spent:
    """Seconds of processor time, one for each round."""

    seconds: tuple[float, ...]

    @property
    def best(self) -> float:
        return min(self.seconds)

    @property
    def median(self) -> float:
        return statistics.median(self.seconds)


def interleaved(actions: Sequence[Callable[[], object]], rounds: int = ROUNDS) -> list[Spent]:
    """Each action once per round, in turns."""
    found: list[list[float]] = [[] for _ in actions]
    for _ in range(rounds):
        for action, seconds in zip(actions, found, strict=True):
            gc.collect()
            begin = time.process_time()
            action()
            seconds.append(time.process_time() - begin)
    return [Spent(tuple(seconds)) for seconds in found]


def tracking_all(name: str) -> Scene:
    """The shipped scene with its attitude and, in a fluid, its centre."""
    scene = load(name)
    track = {"attitude"} if scene.model == "euler" else {"attitude", "centre"}
    return replace(scene, track=frozenset(track))


def instants(count: int) -> list[Fraction]:
    """Equally spaced over a hundred units of time, the start left out."""
    return [Fraction(100 * k, count) + Fraction(1, 7) for k in range(count)]


def first(scene: Scene, route: str, digits: int) -> Solution:
    """A solution that has answered once: what it sets up and keeps is there."""
    made = solution(scene, route)
    made.motion(instants(1), digits)
    return made


# The tables.


def compare_routes(name: str) -> None:
    """A time after the set-up, by arb, by mpmath's two agreeing evaluations and by one of them."""
    scene, times, digits = tracking_all(name), instants(FEW_TIMES), FEW_DIGITS
    arb, mpmath = (first(scene, route, digits) for route in ("arb", "mpmath"))
    each = interleaved(
        [
            partial(arb.motion, times, digits),
            partial(mpmath.motion, times, digits),
            partial(mpmath.evaluate, times, digits),
        ]
    )
    starts = interleaved([partial(first, scene, route, digits) for route in ("arb", "mpmath")])
    settled, single = (mpmath_spent.best / each[0].best for mpmath_spent in each[1:])
    print(
        line(
            f"{name}, {arb.regime}",
            *(f"{1e3 * s / FEW_TIMES:.3f}" for s in (each[0].best, each[0].median)),
            *(f"{1e3 * s / FEW_TIMES:.2f}" for s in (each[1].best, each[1].median)),
            f"{settled:.1f}",
            f"{single:.1f}",
            *(f"{1e3 * s.best:.1f}" for s in starts),
        )
    )


def many_times(name: str) -> None:
    """From nothing; the set-up, with the first time, is also measured by itself."""
    scene, times = tracking_all(name), instants(MANY_TIMES)

    def from_nothing() -> object:
        return solution(scene, "arb").motion(times, MANY_DIGITS)

    whole, start = interleaved(
        [from_nothing, partial(first, scene, "arb", MANY_DIGITS)], MANY_ROUNDS
    )
    each = 1e3 * (whole.best - start.best) / MANY_TIMES
    print(
        line(
            name,
            f"{whole.best:.2f}",
            f"{whole.median:.2f}",
            f"{1e3 * start.best:.1f}",
            f"{each:.3f}",
        )
    )


def derivatives(name: str) -> None:
    """All derivatives by start and body, beside the motion alone; both from nothing."""
    scene, times = tracking_all(name), instants(SENSITIVE_TIMES)

    def motion() -> object:
        return solution(scene).motion(times, MANY_DIGITS)

    every, once = interleaved([partial(sensitivity, scene, times, SENSITIVE_DIGITS), motion])
    print(line(name, f"{every.best:.2f}", f"{every.median:.2f}", f"{every.best / once.best:.1f}"))


def line(name: str, *cells: str) -> str:
    return f"{name:38}" + "".join(f"{cell:>11}" for cell in cells)


def processor() -> str:
    """As the kernel names it, where it does."""
    listing = Path("/proc/cpuinfo")
    for entry in listing.read_text().splitlines() if listing.exists() else []:
        if entry.startswith("model name"):
            return entry.partition(":")[2].strip()
    return platform.processor() or platform.machine()


def main() -> None:
    packages = ", ".join(f"{name} {version(name)}" for name in ("python-flint", "mpmath", "numpy"))
    print(f"{processor()}; Python {platform.python_version()}; {packages}")
    print("Processor time of rounds in turns: the best, and the median.")
    print("Everything is tracked: attitude, and in a fluid the centre.")
    gc.disable()

    print(f"\nMilliseconds per time, {FEW_DIGITS} digits, after the set-up; ratios of the best.")
    print("mpmath's motion is two evaluations that agree; /one is against a single one of them.")
    print(line("", "arb", "median", "mpmath", "median", "ratio", "/one", "set-up arb", "mpmath"))
    for name in ELLIPTIC:
        compare_routes(name)

    print(f"\nSeconds of {MANY_TIMES:,} times by arb, {MANY_DIGITS} digits, the set-up included.")
    print(line("", "seconds", "median", "set-up, ms", "a time, ms"))
    for name in WHOLE:
        many_times(name)

    print(f"\nSeconds of all derivatives by start and body, {SENSITIVE_TIMES} times,", end=" ")
    print(f"{SENSITIVE_DIGITS} digits; as a multiple of one motion.")
    print(line("", "seconds", "median", "motions"))
    for name in WHOLE:
        derivatives(name)


if __name__ == "__main__":
    main()
