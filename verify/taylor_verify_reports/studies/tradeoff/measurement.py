"""Published measurement: every setting on a few scenes, in several fresh processes.

The sample is a number of processes, and not of solves. The hash seed of a process, the places of its arrays
and code in memory and the processor's frequency are random, but the same for all of its solves. So solves
of one process agree better than solves of different ones. Each process gives the median of its rounds.

Errors and times are stored separately: errors are the same on other machines except for rounding, times
are not.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import replace
from fractions import Fraction
from importlib.metadata import PackageNotFoundError, version
from math import inf
from typing import Final

from taylor_verify.batch.work import run_all
from taylor_verify.judge.provenance import machine, packages
from taylor_verify.numbers.precision import rung as rung_named
from taylor_verify.scenes.bodies import RigidBody
from taylor_verify.scenes.motion import Clock
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.engines.engine import prepare
from taylor_verify.solvers.engines.launcher import NotMade
from taylor_verify.solvers.engines.session import end_sessions
from taylor_verify.solvers.registry import TAYLOR
from taylor_verify.tradeoff.setting import (
    Name,
    Setting,
    geometric,
    library,
    outside,
    setting,
    taylor,
)
from taylor_verify.tradeoff.solves import SEED
from taylor_verify.tradeoff.trade_off import (
    TradeOff,
    sound_points,
    trade_off,
)
from taylor_verify_reports.studies.tradeoff.medians import estimate
from taylor_verify_reports.studies.tradeoff.rounds import (
    ROUNDS,
    YARDSTICK,
    Measured,
    measured,
    method,
)
from taylor_verify_reports.studies.tradeoff.trades import (
    UNTIL,
    TradeNumbers,
    TradeScene,
    TradeTiming,
    TradeTimings,
)

# The last scene is chaotic beyond its end: no method has six digits there after a hundred periods.
SCENES: Final = (
    "euler/generic",
    "euler/with-attitude",
    "kirchhoff/whole-motion",
    "kirchhoff/general-body",
    f"euler/generic{UNTIL}800",
    f"euler/with-attitude{UNTIL}800",
    f"kirchhoff/whole-motion{UNTIL}1600",
)
_SAMPLES: Final = 101
# With fewer processes not even the least and the greatest time enclose the median with 95 %.
PROCESSES: Final = 6
# Every power of ten, so that the cheapest setting for each number of digits is among them. RK45 would
# take seconds for the last one, and the two solvers for stiff equations much earlier.
_EVERY_DIGIT: Final = tuple(f"1e-{digits}" for digits in range(3, 14))
_SCIPY: Final = {
    "scipy:RK45": _EVERY_DIGIT[:-1],
    "scipy:DOP853": _EVERY_DIGIT,
    "scipy:LSODA": _EVERY_DIGIT,
    "scipy:Radau": ("1e-3", "1e-6"),
    "scipy:BDF": ("1e-3", "1e-6"),
}
_ODEFUN: Final = "mpmath:odefun?tol=1e-6"
# Integrators of other libraries that are compiled like heyoka's. They and taylor are measured at every
# power of ten, for the columns of the table.
PEERS: Final = ("dop853", "cyrk-dop853", "cvode-adams", "diffrax-dopri8")
_FOR_THE_COLUMNS: Final = tuple(f"1e-{digits}" for digits in range(5, 16))
_OF_TAYLOR: Final = ("1e-3", *_FOR_THE_COLUMNS)
_OWN_TOLERANCE: Final = ("f32", "f80", "f128", "mp237")

# A scene with the names of its settings.
Asked = tuple[Scene, Sequence[Name]]


def measurement(
    names: Sequence[str] = SCENES,
    processes: int = PROCESSES,
    rounds: int = ROUNDS,
    with_outside: bool = False,
    seed: int = SEED,
    finished: Callable[[str], None] = lambda part: None,
) -> tuple[TradeNumbers, TradeTimings]:
    """Solve the scenes with every published setting, then time the sound ones in fresh processes.

    ``names`` are those of scenes, as in SCENES. ``with_outside`` adds the compiled integrators of other
    libraries; one whose environment cannot be made is not run. ``finished`` is called with the name of each
    part as it ends.
    """
    if with_outside:
        for name in PEERS:
            with suppress(NotMade):
                prepare(name, finished)
    trades = []
    for scene in map(scene_named, names):
        settings = tuple(published_settings(scene, with_outside))
        # No limit of patience: the published settings must not depend on the machine's load.
        trades.append(trade_off(scene, settings, 0, seed, patience=inf))
        finished(f"errors of {scene.name}")
    end_sessions()
    asked = [
        (trade.scene, [p.timed.setting.name for p in sound_points(trade.points)])
        for trade in trades
    ]
    by_process = []
    for number in range(processes):
        # With one piece of work a pool has one process, which is new and ends with it.
        by_process += run_all(one_process, [(asked, seed + number, rounds)], workers=1)
        finished(f"times, process {number + 1} of {processes}")
    numbers = TradeNumbers(
        versions=_versions(),
        yardstick=" ".join(YARDSTICK),
        scenes=tuple(map(_scene, trades)),
        points=tuple(p.on(trade.scene.name) for trade in trades for p in trade.points),
    )
    times = TradeTimings(
        machine=machine(),
        method=method(processes, rounds, seed),
        timings=tuple(_timings(asked, by_process)),
    )
    return numbers, times


def _versions() -> dict[str, str]:
    """Return the versions of all packages, including SciPy, which no verdict depends on."""
    used = packages()
    with suppress(PackageNotFoundError):
        used["scipy"] = version("scipy")
    return used


def scene_named(name: str) -> Scene:
    """Return a shipped scene, or one that is followed until a later time, by its name in ``SCENES``."""
    shipped, _, end = name.partition(UNTIL)
    scene = load(shipped)
    if not end:
        return scene
    instants = tuple(Fraction(end) * k / (_SAMPLES - 1) for k in range(_SAMPLES))
    title = f"{scene.title}{UNTIL}{end}"
    return replace(scene, name=name, title=title, digest="", clock=Clock(Fraction(0), instants))


def published_settings(scene: Scene, with_outside: bool = False) -> Iterator[Setting]:
    """Yield the settings family by family, the coarsest first: taylor on every rung, all others on f64.

    A scene that is followed beyond its own end has only taylor on f64 and the peers.
    """
    f64, is_long = rung_named("f64"), UNTIL in scene.name
    yield from taylor(f64, _OF_TAYLOR)
    if not is_long:
        yield from _for_short_scenes(scene)
    if with_outside:
        for tolerance in _FOR_THE_COLUMNS:
            yield setting(f"{TAYLOR}?tol={tolerance}&code=optimised", f64)
        yield from outside(["f64"], PEERS, _FOR_THE_COLUMNS)


def _for_short_scenes(scene: Scene) -> Iterator[Setting]:
    """Yield the settings of short scenes only; on long ones many of them would take seconds for a solve."""
    f64 = rung_named("f64")
    for name in _OWN_TOLERANCE:
        yield setting(YARDSTICK[0], rung_named(name))
    for solver, tolerances in _SCIPY.items():
        yield from library([solver], tolerances, f64)
    if isinstance(scene.body, RigidBody):
        yield from geometric(scene, f64)
        if not scene.track - {"omega"}:
            # A solve takes seconds: the scene with the fewest equations is enough.
            yield setting(_ODEFUN, f64)


def one_process(work: tuple[Sequence[Asked], int, int]) -> dict[str, dict[Name, Measured]]:
    """Return the measurements of this process by scene; ``work`` has the scenes, a seed and the rounds.

    The order of the scenes is random too. It is called in a new process, so that everything is
    compiled anew.
    """
    asked, seed, rounds = work
    scenes = list(asked)
    random.Random(seed).shuffle(scenes)
    answers = {scene.name: measured(scene, names, seed, rounds) for scene, names in scenes}
    end_sessions()
    return answers


def _timings(
    asked: Sequence[Asked], by_process: Sequence[dict[str, dict[Name, Measured]]]
) -> Iterator[TradeTiming]:
    """Yield the times of every setting that finished in all processes."""
    for scene, names in asked:
        scene_times = [process[scene.name] for process in by_process]
        for name in names:
            if scene_times and all(name in process for process in scene_times):
                yield _timing(scene.name, name, [process[name] for process in scene_times])


def _timing(scene: str, name: Name, every: Sequence[Measured]) -> TradeTiming:
    """Return the time of a setting from its measurements in all processes, in six digits.

    They are a hundred times as many as repeat.
    """
    inner = [times.inner for times in every if times.inner is not None]
    ratio = estimate(times.ratio for times in every)
    solver, rung = name
    return TradeTiming(
        scene=scene,
        solver=solver,
        rung=rung,
        seconds=_six(estimate(times.seconds for times in every).median),
        inner_seconds=_six(estimate(inner).median) if len(inner) == len(every) else None,
        ratio=_six(ratio.median),
        low=None if ratio.low is None else _six(ratio.low),
        high=None if ratio.high is None else _six(ratio.high),
        processes=len(every),
        setup_seconds=_six(max(times.setup for times in every)),
    )


def _six(number: float) -> float:
    """Return a number in six significant digits."""
    return float(f"{number:.6g}")


def _scene(trade: TradeOff) -> TradeScene:
    """Return a measured scene in its stored form."""
    return TradeScene(
        scene=trade.scene.name,
        title=trade.scene.title,
        track=tuple(sorted(trade.scene.track)),
        sha256=trade.scene.digest,
        attainable=trade.attainable,
    )
