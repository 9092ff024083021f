"""Many bodies of one form in heyoka's batches in float64: one lane for each body.

heyoka steps the lanes of a batch together, and stops all of them where one is not finite. That one is
left out, and the others go again from their starts. A lane whose rate has grown, so that its longest step
was too long for it, goes again too, at the larger rate.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from math import ceil
from typing import Any, Final, Protocol

import numpy as np

from taylor_verify.models.form import Form
from taylor_verify.scenes.precision import rung
from taylor_verify.solvers.taylor.ensemble import batch_width, stepper
from taylor_verify.solvers.taylor.way import (
    LEAST_STEPS,
    MOST_RADIANS,
    ROWS_LOOKED_AT,
    SLACK,
    STEPS_PER_RADIAN,
    UNCUT,
    longest_step,
    outcome_of,
)
from taylor_verify.solvers.trajectory import Outcome

Floats = np.ndarray[Any, np.dtype[np.float64]]

# A lane goes again so often at most.
_MOST_WAYS: Final = 16
_RUNG: Final = rung("f64")
# Straight-line code of so many states compiles in a second, once for a machine, and runs twice as fast.
_STATES: Final = 13
# A batch is twice as wide as what a processor steps at once: half as many calls of heyoka. A batch of one
# would have another interface.
_WIDER: Final = 2


class Posed(Protocol):
    """n bodies of one form, in their units.

    ``parameters`` (p, n), ``starts`` (s, n), ``grid`` (n, m) of the times, and ``rates`` (n), the fastest
    ones at the starts.
    """

    @property
    def form(self) -> Form: ...
    @property
    def parameters(self) -> Floats: ...
    @property
    def starts(self) -> Floats: ...
    @property
    def grid(self) -> Floats: ...
    @property
    def rates(self) -> Floats: ...

    def __len__(self) -> int: ...

    def at(self, places: Any) -> Posed:
        """Return some of the bodies."""

    def grown(self, states: Floats, rates: Floats) -> Floats:
        """Return the fastest rate (n) at any of the states (s, n, m); 0 where it is not above ``rates``."""


@dataclass(frozen=True)
class Lanes:
    """The ends of n lanes: ``outcomes`` (n), ``rows`` (states, n, m), ``steps`` (n) and their order.

    The rows of a lane that has not FINISHED are no answer.
    """

    outcomes: list[Outcome]
    rows: Floats
    steps: np.ndarray[Any, np.dtype[np.int64]]
    ways: np.ndarray[Any, np.dtype[np.int64]]
    order: int


def prepare(form: Form, tolerance: Fraction | None = None) -> Any:
    """Return heyoka's integrator for such bodies, compiled or read from disk the first time."""
    return stepper(form, _RUNG, tolerance, _WIDER * batch_width(_RUNG), _STATES)


def propagate(bodies: Posed, tolerance: Fraction | None = None) -> Lanes:
    """Return the states of bodies at their times, in their units; ``tolerance`` is as in Taylor."""
    return _Propagation(bodies, tolerance).ended()


class _Propagation:
    def __init__(self, bodies: Posed, tolerance: Fraction | None) -> None:
        self._bodies, self._rates = bodies, bodies.rates
        grid = bodies.grid
        is_sampled = bool(grid.size) and not grid[:, 0].any()
        self._grid = grid if is_sampled else np.insert(grid, 0, 0.0, axis=1)
        self._first = 0 if is_sampled else 1
        self._stepper = prepare(bodies.form, tolerance)
        self._cap = longest_step(int(self._stepper.order))
        count = len(bodies)
        self._rows = np.full((len(bodies.form.states), count, self._grid.shape[1]), np.nan)
        self._steps = np.zeros(count, dtype=np.int64)
        self._uncut = np.zeros(count)
        self._ways = np.zeros(count, dtype=np.int64)
        self._outcomes = np.full(count, Outcome.INTERRUPTED, dtype=object)

    def ended(self) -> Lanes:
        waiting = self._startable()
        while waiting.size:
            waiting = waiting[np.argsort(self._radians(waiting), kind="stable")]
            width = self._stepper.batch_size
            left = [self._run(waiting[i : i + width]) for i in range(0, len(waiting), width)]
            again = np.concatenate(left)
            done = np.setdiff1d(waiting, again, assume_unique=True)
            waiting = np.concatenate([again, self._grown(done)]).astype(np.intp)
            waiting = waiting[self._ways[waiting] < _MOST_WAYS]
        return Lanes(
            self._outcomes.tolist(),
            self._rows[:, :, self._first :],
            self._steps,
            self._ways,
            int(self._stepper.order),
        )

    def _radians(self, lanes: Any) -> Floats:
        radians: Floats = self._rates[lanes] * abs(self._grid[lanes, -1])
        return radians

    def _startable(self) -> Any:
        """Return the lanes whose rates are finite and whose ways are not too long."""
        lanes = np.arange(len(self._rates))
        given = np.concatenate([self._bodies.parameters, self._bodies.starts, self._rates[None]])
        is_finite = np.isfinite(given).all(axis=0)
        is_short = self._radians(lanes) <= MOST_RADIANS
        for k in np.flatnonzero(~(is_finite & is_short)):
            self._outcomes[k] = Outcome.STEP_LIMIT if is_finite[k] else Outcome.NON_FINITE
        # A body that is almost at rest has a finite step too.
        self._rates = np.maximum(self._rates, 2.0**-10)
        return lanes[is_finite & is_short]

    def _run(self, lanes: Any) -> Any:
        """Go the way of at most a batch of lanes, and return those that others have stopped."""
        stepper, count = self._stepper, len(lanes)
        # Places left over repeat the first lane, unseen.
        missing = stepper.batch_size - count
        places = np.concatenate([lanes, np.repeat(lanes[:1], missing)]) if missing else lanes
        stepper.set_time(0.0)
        stepper.state[:] = self._bodies.starts[:, places]
        stepper.pars[:] = self._bodies.parameters[:, places]
        _, rows = stepper.propagate_grid(
            np.ascontiguousarray(self._grid[places].T),
            max_delta_t=self._cap / self._rates[places],
            max_steps=self._most_steps(places),
        )
        rows = rows[..., :count]
        statuses, _, uncut, steps = zip(*stepper.propagate_res[:count], strict=True)
        self._rows[:, lanes] = rows.transpose(1, 2, 0)
        self._uncut[lanes], self._steps[lanes] = uncut, steps
        self._ways[lanes] += 1
        self._outcomes[lanes] = Outcome.FINISHED
        stopped = []
        for k in np.flatnonzero(~np.isfinite(rows).all(axis=(0, 1))):
            lane, outcome = lanes[k], outcome_of(statuses[k])
            ended = outcome is Outcome.NON_FINITE or steps[k] >= self._most_steps(lanes[k : k + 1])
            self._outcomes[lane] = outcome if ended else Outcome.INTERRUPTED
            if not ended:
                stopped.append(lane)
        return np.array(stopped, dtype=np.intp)

    def _most_steps(self, lanes: Any) -> int:
        """Return a bound that no regular orbit comes near."""
        return LEAST_STEPS + int(STEPS_PER_RADIAN * self._radians(lanes).max())

    def _grown(self, lanes: Any) -> Any:
        """Return the lanes that must go again, because a step was too long for a rate on the way."""
        whole = lanes[self._outcomes[lanes] == Outcome.FINISHED]
        if not whole.size:
            return whole
        # Steps that were cut to the cap are left out of heyoka's longest.
        caps, uncut = self._cap / self._rates[whole], self._uncut[whole]
        longest = np.where((uncut > 0) & (uncut < UNCUT * caps), uncut, caps)
        stride = ceil(self._rows.shape[2] / ROWS_LOOKED_AT)
        some = self._rows[:, whole, ::-stride]
        met = self._bodies.at(whole).grown(some, SLACK * self._cap / longest)
        has_grown = met != 0
        again = whole[has_grown]
        self._rates[again] = met[has_grown]
        self._outcomes[again] = Outcome.INTERRUPTED
        return again
