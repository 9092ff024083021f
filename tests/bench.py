"""What the exact solutions cost, the suite around a propagation, and `check` of long files: `make bench`.

Times are those of one run, and ratios are within it.

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
from unittest.mock import patch

from bench_check import judging
from bench_instants import at_once
from builders.two_runs import two_runs
from mpmath import mpf

from taylor_verify.exact.conditioning.sensitivity import sensitivity
from taylor_verify.exact.elements import elements
from taylor_verify.exact.route import solution
from taylor_verify.exact.solution import NO_CLOSED_FORM, Solution, Unsettled
from taylor_verify.exact.taylor import TaylorSolution
from taylor_verify.models.problem import pose
from taylor_verify.scenes.instants import EquallySpaced
from taylor_verify.scenes.library import EXTREMES, STANDARD_SET, WORST, names
from taylor_verify.scenes.motion import Clock
from taylor_verify.scenes.precision import exact_value, rung
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.taylor import driver
from taylor_verify.solvers.taylor.driver import Taylor

ROUNDS = 5
FEW_TIMES, FEW_DIGITS = 40, 50
MANY_TIMES, MANY_DIGITS, MANY_ROUNDS = 10_000, 40, 3
SENSITIVE_TIMES, SENSITIVE_DIGITS = 10, 15
PERIODS, PERIOD_DIGITS = 10**9, 60
# One of every elliptic regime, and a body beside its separatrix.
ELLIPTIC = (
    "euler/with-attitude",
    "euler/full-tensor",
    "euler/tennis-racket",
    "kirchhoff/whole-motion",
    "kirchhoff/two-real-roots",
    "kirchhoff/cubic",
)
# Scenes without a closed form, in the standard set and beyond: what an enclosure costs beside two runs.
ENCLOSED_DIGITS, ENCLOSED_ROUNDS = 30, 3
ENCLOSED_BESIDE = ("extremes/kirchhoff-nearly-clebsch",)
SAMPLES, RUNGS = 10_000, ("f64", "f80", "mp237")
PROPAGATED = {
    "euler/generic": frozenset[str](),
    "kirchhoff/whole-motion": frozenset({"attitude", "centre"}),
}
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
    """The whole time, and that of the set-up with the first time alone."""
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


def enclosures(name: str) -> None:
    """The enclosure over two plain runs at the scene's own times: states alone, and with the frame."""
    cells = []
    for scene in (replace(load(name), track=frozenset()), tracking_all(name)):
        times = scene.clock.elapsed
        enclosure, plain = interleaved(
            [
                partial(TaylorSolution(scene).motion, times, ENCLOSED_DIGITS),
                partial(two_runs, scene, times, ENCLOSED_DIGITS),
            ],
            ENCLOSED_ROUNDS,
        )
        cells += [f"{1e3 * spent.best:.0f}" for spent in (enclosure, plain)]
        cells.append(f"{enclosure.best / plain.best:.2f}")
    print(line(name, *cells))


def without_closed_form(names_of: Sequence[str]) -> list[str]:
    """Return the scenes whose truth is an enclosure."""
    return [name for name in names_of if solution(load(name)).regime == NO_CLOSED_FORM]


def derivatives(name: str) -> None:
    """All derivatives by start and body, beside the motion alone; both from nothing."""
    scene, times = tracking_all(name), instants(SENSITIVE_TIMES)

    def motion() -> object:
        return solution(scene).motion(times, MANY_DIGITS)

    every, once = interleaved([partial(sensitivity, scene, times, SENSITIVE_DIGITS), motion])
    print(line(name, f"{every.best:.2f}", f"{every.median:.2f}", f"{every.best / once.best:.1f}"))


def after_a_billion_periods(names_of: Sequence[str]) -> None:
    """The widest proven radius and the longest computation of all scenes that have a closed form.

    Each with all that it tracks; where nothing recurs, after as many units of time.
    """
    radii: list[tuple[mpf, str]] = []
    seconds: list[tuple[float, str]] = []
    undecided: list[str] = []
    for name in names_of:
        scene = load(name)
        exact = solution(scene)
        if exact.regime == NO_CLOSED_FORM:
            continue
        orbit = elements(scene, PERIOD_DIGITS)
        period = exact_value(orbit["period"].value) if "period" in orbit else Fraction(1)
        begin = time.process_time()
        try:
            radii.append((exact.motion([PERIODS * period], MANY_DIGITS).radius[0], name))
        except Unsettled:
            undecided.append(name)
        seconds.append((time.process_time() - begin, name))
    widest, slowest = max(radii), max(seconds)
    print(f"{len(radii)} scenes proven, {len(undecided)} undecided {' '.join(undecided)}")
    print(f"widest radius {float(widest[0]):.1e} ({widest[1]})")
    print(f"longest computation {1e3 * slowest[0]:.0f} ms ({slowest[1]})")


# The suite around the integrator.


def lengthened(scene: Scene, periods: int | None) -> Scene:
    """Ten thousand samples over the scene's own span, or over so many periods of its motion."""
    start, end = scene.clock.start, scene.clock.instants[-1]
    if periods is not None:
        found = {number.name: number.value for number in elements(scene, 15).numbers}
        end = start + periods * Fraction(str(found["period"])).limit_denominator(1000)
    step = (end - start) / (SAMPLES - 1)
    return replace(scene, clock=Clock(start, EquallySpaced(start, step, SAMPLES)))


def around_the_integrator(name: str, track: frozenset[str], periods: int | None) -> None:
    """Posing and solving, once compiled, over the time inside heyoka's propagate_grid: the excess.

    No sample is made an exact number: that is the judge's wish, and is shown apart.
    """
    scene = lengthened(replace(load(name), track=track), periods)
    for rung_name in RUNGS if periods is None else RUNGS[:2]:
        onto, solver = rung(rung_name), Taylor()
        solver.solve(pose(scene, onto))
        excesses, insides, exact = [], [], []
        for _ in range(3 if rung_name.startswith("mp") else 15):
            gc.collect()
            begin = time.process_time()
            found = solver.solve(pose(scene, onto))
            spent = time.process_time() - begin
            inside = found.inner_seconds
            assert inside is not None
            insides.append(inside)
            excesses.append((spent - inside) / inside)
        if not rung_name.startswith("mp"):
            begin = time.process_time()
            list(found.quantities.values())
            exact.append(time.process_time() - begin)
        print(
            line(
                f"{name}, {'own span' if periods is None else f'{periods} periods'}, {rung_name}",
                f"{1e3 * statistics.median(insides):.2f}",
                f"{statistics.median(excesses):.1%}",
                f"{min(excesses):.1%}",
                f"{found.steps}",
                *(f"{1e3 * seconds:.0f}" for seconds in exact),
            )
        )


def line(name: str, *cells: str) -> str:
    return f"{name:38}" + "".join(f"{cell:>11}" for cell in cells)


def processor() -> str:
    """The processor's name as the kernel has it; empty where there is none."""
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

    print(
        f"\nRadius relative to each vector after {PERIODS:.0e} periods, {MANY_DIGITS} digits asked for."
    )
    after_a_billion_periods(names(*STANDARD_SET, EXTREMES, WORST))

    print(
        f"\nMilliseconds of the Taylor enclosure and of two plain runs, {ENCLOSED_DIGITS} digits;"
    )
    print("ratios of the best: states alone, and with attitude and centre.")
    print(line("", "enclosure", "two runs", "ratio", "with frame", "two runs", "ratio"))
    for name in (*without_closed_form(names(*STANDARD_SET)), *ENCLOSED_BESIDE):
        enclosures(name)

    print(f"\nWhat the suite adds to a propagation of {SAMPLES:,} samples, once compiled.")
    print(line("", "inside, ms", "added", "best", "steps", "exact, ms"))
    # What the driver times inside is processor time too, as all else here.
    with patch.object(driver, "perf_counter", time.process_time):
        for name, track in PROPAGATED.items():
            for periods in (None, 1000):
                around_the_integrator(name, track, periods)

    def best(each: Sequence[Callable[[], object]], rounds: int) -> list[float]:
        return [spent.best for spent in interleaved(each, rounds)]

    at_once(best, line)
    judging(best, line)

    print(f"\nSeconds of all derivatives by start and body, {SENSITIVE_TIMES} times,", end=" ")
    print(f"{SENSITIVE_DIGITS} digits; as a multiple of one motion.")
    print(line("", "seconds", "median", "motions"))
    for name in WHOLE:
        derivatives(name)


if __name__ == "__main__":
    main()
