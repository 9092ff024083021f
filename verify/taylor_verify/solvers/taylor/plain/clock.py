"""Time as heyoka keeps it (a sum of two numbers), as equations see it, and as a caller gives it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

Array = np.ndarray[Any, Any]


def driven(start: float, duration: float) -> tuple[Any, float]:
    """x' = cos(t - start) from x(start) = 0: after the duration, x is its sine."""
    import heyoka as hy

    x = hy.make_vars("x")
    ta = hy.taylor_adaptive([(x, hy.cos(hy.time - start))], [0.0], time=start)
    outcome, *_ = ta.propagate_for(duration)
    return outcome, ta.state[0]


def until(equations: Any, w: Sequence[float], start: float, end: float) -> tuple[Any, int, Array]:
    """Propagate from one late time to another."""
    import heyoka as hy

    ta = hy.taylor_adaptive(equations, w, time=start)
    outcome, _, _, steps, _, _ = ta.propagate_until(end)
    return outcome, steps, ta.state


def beyond(equations: Any, w: Sequence[float], end: float, asked: float) -> Array:
    """Continuous output up to the end, asked for a later time."""
    import heyoka as hy

    ta = hy.taylor_adaptive(equations, w)
    *_, c_out, _ = ta.propagate_until(end, c_output=True)
    return np.array(c_out(asked))


def kept(equations: Any, w: Sequence[float], first: float, second: float) -> Array:
    """Continuous output at two times, the first kept while the second is asked for."""
    import heyoka as hy

    ta = hy.taylor_adaptive(equations, w)
    *_, c_out, _ = ta.propagate_until(second, c_output=True)
    at_first = c_out(first)
    c_out(second)
    return np.array(at_first)
