"""Many bodies of one form in heyoka's batches in float64: one lane for each body.

heyoka steps the lanes of a batch together, and stops all of them where one is not finite. That one is
left out, and the others go again from their starts. A lane whose rate has grown beyond the one that its
steps were made for goes again too, at the larger rate.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from taylor_verify.models.bodies import Bodies
from taylor_verify.scenes.precision import rung
from taylor_verify.solvers.taylor.ensemble import batch_width, stepper
from taylor_verify.solvers.taylor.way import (
    LEAST_STEPS,
    MOST_RADIANS,
    STEPS_PER_RADIAN,
    longest_step,
    outcome_of,
)
from taylor_verify.solvers.trajectory import Outcome

Floats = np.ndarray[Any, np.dtype[np.float64]]

# A lane goes again where its rate is more than this factor above that of its steps, so often at most.
_SLACK: Final = 1.25
_MOST_WAYS: Final = 16
_MOST_LOOKS: Final = 12
_RUNG: Final = rung("f64")
# Straight-line code of so many states compiles in a second, once for a machine, and runs twice as fast.
_STATES: Final = 7


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


def propagate(bodies: Bodies) -> Lanes:
    """Return the states of bodies at their times, in their units."""
    return _Propagation(bodies).ended()


class _Propagation:
    def __init__(self, bodies: Bodies) -> None:
        self._bodies, self._rates = bodies, bodies.rates
        grid = bodies.grid
        is_sampled = bool(grid.size) and not grid[:, 0].any()
        self._grid = grid if is_sampled else np.insert(grid, 0, 0.0, axis=1)
        self._first = 0 if is_sampled else 1
        # A batch of one has another interface.
        self._stepper = stepper(bodies.form, _RUNG, None, max(2, batch_width(_RUNG)), _STATES)
        count = len(bodies)
        self._rows = np.full((len(bodies.form.states), count, self._grid.shape[1]), np.nan)
        self._steps = np.zeros(count, dtype=np.int64)
        self._ways = np.zeros(count, dtype=np.int64)
        self._outcomes = [Outcome.INTERRUPTED] * count

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
            self._outcomes,
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
        places = np.concatenate([lanes, np.repeat(lanes[:1], stepper.batch_size - count)])
        limits = LEAST_STEPS + (STEPS_PER_RADIAN * self._radians(places)).astype(np.int64)
        stepper.set_time(0.0)
        stepper.state[:] = self._bodies.starts[:, places]
        stepper.pars[:] = self._bodies.parameters[:, places]
        _, rows = stepper.propagate_grid(
            np.ascontiguousarray(self._grid[places].T),
            max_delta_t=longest_step(int(stepper.order)) / self._rates[places],
            max_steps=int(limits.max()),
        )
        self._rows[:, lanes] = np.transpose(rows, (1, 2, 0))[:, :count]
        results = stepper.propagate_res[:count]
        self._steps[lanes] = [result[3] for result in results]
        self._ways[lanes] += 1
        is_whole: Any = np.isfinite(self._rows[:, lanes]).all(axis=(0, 2))
        stopped = []
        for k, whole, (status, *_, steps), limit in zip(
            lanes, is_whole.tolist(), results, limits, strict=False
        ):
            outcome = outcome_of(status)
            if whole:
                self._outcomes[k] = Outcome.FINISHED
            elif outcome is Outcome.NON_FINITE or steps >= limit:
                self._outcomes[k] = outcome
            else:
                stopped.append(k)
        return np.array(stopped, dtype=np.intp)

    def _grown(self, lanes: Any) -> Any:
        """Return the lanes that must go again, because their rate has grown."""
        whole = np.array([k for k in lanes if self._outcomes[k] is Outcome.FINISHED], dtype=np.intp)
        if not whole.size:
            return whole
        stride = self._rows.shape[2] // _MOST_LOOKS + 1
        some = self._rows[:, whole, ::-stride]
        met = self._bodies.at(whole).fastest(some)
        has_grown = ~(met <= _SLACK * self._rates[whole])
        again = whole[has_grown]
        self._rates[again] = met[has_grown]
        for k in again:
            self._outcomes[k] = Outcome.INTERRUPTED
        return again
