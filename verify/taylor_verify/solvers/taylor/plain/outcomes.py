"""What heyoka reports when something ends otherwise than asked, or is asked otherwise than meant."""

from __future__ import annotations

import contextlib
import signal
import sqlite3
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

Array = np.ndarray[Any, Any]


def decay(x0: float, end: float, **options: Any) -> tuple[Any, Any]:
    """x' = -x: the integrator, and what propagate_until returned."""
    import heyoka as hy

    x = hy.make_vars("x")
    ta = hy.taylor_adaptive([(x, -x)], [x0])
    return ta, ta.propagate_until(end, **options)


def blow_up(x0: float, end: float) -> tuple[Any, Any]:
    """x' = x^2, which is infinite at t = 1/x0."""
    import heyoka as hy

    x = hy.make_vars("x")
    ta = hy.taylor_adaptive([(x, x * x)], [x0])
    return ta, ta.propagate_until(end)


def tolerance_of_zero() -> Any:
    """The tolerance of an integrator that was asked for none."""
    import heyoka as hy

    x = hy.make_vars("x")
    ta = hy.taylor_adaptive([(x, -x)], [1.0], tol=0.0)
    return ta.tol


def lanes(equations: Any, w: Array, end: float) -> tuple[list[Any], Array, Array]:
    """Several bodies side by side, a column of w each: outcomes, times and states."""
    import heyoka as hy

    ta = hy.taylor_adaptive_batch(equations, w)
    ta.propagate_until(end)
    return [outcome for outcome, *_ in ta.propagate_res], ta.time, ta.state


def swung(ta: Any, end: float) -> float:
    """How far a long run has come when it ends or is interrupted."""
    with contextlib.suppress(KeyboardInterrupt):
        ta.propagate_until(end)
    return float(ta.time)


def interrupted(seconds: float, end: float) -> float:
    """The time of the integrator when an interruption after so many seconds is heard of."""
    import heyoka as hy

    x, v = hy.make_vars("x", "v")
    ta = hy.taylor_adaptive([(x, v), (v, -hy.sin(x))], [1.0, 0.0])

    def interrupt(*_: object) -> None:
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGALRM, interrupt)
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        return swung(ta, end)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


def cache_key() -> str:
    """What the disk cache has stored of the surroundings in which a piece of code was compiled."""
    import heyoka as hy

    before = hy.llvm_state.get_diskcache_path()
    enabled = hy.llvm_state.get_diskcache_enabled()
    with TemporaryDirectory() as folder:
        hy.llvm_state.set_diskcache_enabled(True)
        hy.llvm_state.set_diskcache_path(folder)
        try:
            hy.llvm_state.clear_memcache()
            hy.taylor_adaptive([(hy.make_vars("x"), hy.expression(0.25))], [0.0])
            return stored_key(Path(folder, "cache.db"))
        finally:
            hy.llvm_state.set_diskcache_enabled(enabled)
            hy.llvm_state.set_diskcache_path(before)


def stored_by(processes: int) -> int:
    """How many pieces of code these processes leave on disk, each compiling one system in MPFR."""
    with TemporaryDirectory() as folder:
        for _ in range(processes):
            subprocess.run([sys.executable, "-c", _IN_MPFR, folder], check=True)
        connection = sqlite3.connect(Path(folder, "cache.db"))
        try:
            ((count,),) = connection.execute("SELECT count(*) FROM cache")
        finally:
            connection.close()
    return int(count)


_IN_MPFR = """
import sys
import heyoka as hy
hy.llvm_state.set_diskcache_path(sys.argv[1])
x, one = hy.make_vars("x"), hy.real(1, 237)
hy.taylor_adaptive([(x, -x)], [one], time=0 * one, fp_type=hy.real, compact_mode=True)
"""


def stored_key(database: Path) -> str:
    """What is stored beside each piece of code, to be found by."""
    connection = sqlite3.connect(database)
    try:
        ((key,),) = connection.execute("SELECT DISTINCT env_fingerprint FROM cache")
    finally:
        connection.close()
    return str(key)
