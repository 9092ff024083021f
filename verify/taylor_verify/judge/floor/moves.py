"""The effect of a rounding of the input on a motion without closed form, by its derivative.

With eta an error of momentum, turn and centre, and p a number of body, loads or start,

    eta(t) = Phi(t, 0) eta_0(p) + int_0^t Phi(t, s) g_p(s) ds,

where g_p is p dF/dp. Exact motions beside this one would each cost as much as the truth.
"""

from __future__ import annotations

import random
from collections.abc import Iterable, Iterator, Sequence
from fractions import Fraction
from functools import cached_property
from typing import Any, Final

import numpy as np
from mpmath import mp

from taylor_verify.exact.conditioning.condition import Path
from taylor_verify.exact.registry import kind_of
from taylor_verify.exact.row_arithmetic import cross_matrices
from taylor_verify.judge.floor.loads import Along
from taylor_verify.numbers.rotation import rotation_matrix
from taylor_verify.scenes.motion import Motion
from taylor_verify.scenes.mpfr import real
from taylor_verify.scenes.scene import Scene

Floats = np.ndarray[Any, np.dtype[np.float64]]

# So small a change of a number shows the derivative to six digits.
CHANGE: Final = Fraction(1, 2**20)
_DRAWS: Final = 8


class Moves:
    """The motions beside an orbit, each of a number that is changed, at some of its times.

    Each of the scenes ``changed`` has a number of body or start that is larger by the part CHANGE of it.
    """

    def __init__(self, path: Path, changed: Iterable[Scene]) -> None:
        self._path, self._along = path, Along(path)
        kind = kind_of(path.scene.body)
        self._momentum = kind.momentum_matrix(path.scene.body).astype(float)
        self._responses = [*map(self._of_scene, changed), *self._of_numbers()]

    @property
    def count(self) -> int:
        """The numbers of body, start and loads."""
        return len(self._responses)

    def here(self, places: Sequence[int]) -> Motion:
        """Return the motion itself at these times of the path."""
        return self.beside(places, np.zeros((len(places), self._along.width)))

    def motions(self, places: Sequence[int], roundoff: float) -> Iterator[Motion]:
        """Yield draws of all numbers changed at once, up or down at random, at these times of the path."""
        coin = random.Random(1)
        for _ in range(_DRAWS):
            moved = sum(coin.choice((-1, 1)) * response for response in self._responses)
            yield self.beside(places, roundoff * np.asarray(moved)[places])

    def late(self, places: Sequence[int], roundoff: float) -> Motion:
        """Return the motion at times that are later by a rounding of each."""
        times = np.array(
            [float(t) for t in self._path.scene.clock.start + np.array(self._path.elapsed)]
        )
        rates, first = self._errors(*self._rates), len(self._momentum) + 6
        # Held values do not change between two instants.
        _, own, _, _ = self._along.split(self._along.outputs())
        rates[:, first : first + own.shape[1]] = own
        return self.beside(places, roundoff * (rates * times[:, None])[places])

    def beside(self, places: Sequence[int], errors: Floats) -> Motion:
        """Return the motion with these errors of momentum, turn and centre, in the scene's units."""
        along, scene = self._along, self._path.scene
        d = along.state.shape[1]
        inverse = np.linalg.inv(self._momentum)
        z = real(along.state[places]) + real(errors[:, :d] @ inverse.T)
        names = kind_of(scene.body).moving
        quantities = {name: z[:, 3 * k : 3 * k + 3] for k, name in enumerate(names)}
        if scene.track:
            R = along.attitude[places]
            turned = cross_matrices(errors[:, d : d + 3]) @ R
            quantities["attitude"] = real(R) + real(turned)
        if "centre" in scene.track:
            quantities["centre"] = real(along.centre[places]) + real(errors[:, d + 3 : d + 6])
        peaks, first = {}, d + 6
        for name, rows in self._path.carried.own.items():
            last = first + rows.shape[1]
            if name in scene.states:
                quantities[name] = real(rows[places]) + real(errors[:, first:last])
                largest = np.maximum.accumulate(np.linalg.norm(rows, axis=1))
                peaks[name] = real(largest[places])
            first = last
        zeros = np.array([mp.zero] * len(places), dtype=object)
        return Motion(quantities, zeros, peaks=peaks)

    @cached_property
    def _rates(self) -> tuple[Floats, Floats, Floats]:
        return self._along.rates()

    # The response to one number.

    def _errors(self, rate: Floats, turn: Floats, centre: Floats) -> Floats:
        """Return the rates of momentum, turn and centre, and zero for own states."""
        own = np.zeros((len(rate), self._along.width - len(self._momentum) - 6))
        return np.hstack([rate @ self._momentum.T, turn, centre, own])

    def _of_scene(self, changed: Scene) -> Floats:
        """Return the response to a change of body and start, over the change."""
        scene, kind = self._path.scene, kind_of(self._path.scene.body)
        z, other = (kind.state(s.initial) for s in (scene, changed))
        first, d = np.zeros(self._along.width), len(self._momentum)
        first[:d] = self._momentum @ [float(b - a) for a, b in zip(z, other, strict=True)]
        R, moved = (
            np.array(rotation_matrix(s.initial.attitude), dtype=object) for s in (scene, changed)
        )
        turn = (moved @ R.T).astype(float)
        first[d : d + 3] = turn[2, 1], turn[0, 2], turn[1, 0]
        ends = (kind.centre(s.initial) or (Fraction(0),) * 3 for s in (scene, changed))
        first[d + 3 : d + 6] = [float(b - a) for a, b in zip(*ends, strict=True)]
        push = np.zeros((len(self._path.elapsed), len(first)))
        if changed.body != scene.body:
            there = Along(self._path, changed.body).rates()
            pairs = zip(self._rates, there, strict=True)
            push = self._errors(*(after - before for before, after in pairs))
        return self._carried(first, push) / float(CHANGE)

    def _of_numbers(self) -> Iterator[Floats]:
        """Yield the response to each number of the texts, and of the starts of own states."""
        changes: dict[Fraction, Floats] = {}
        for piece in self._along.pieces():
            for number, by in piece.numbers().items():
                rows = np.zeros((len(self._path.elapsed), by.shape[1]))
                rows[piece.places] = by
                changes[number] = changes.get(number, 0) + rows
        unmoved = np.zeros(self._along.width)
        for change in changes.values():
            yield self._carried(unmoved, *self._along.pushes(change))
        still = np.zeros((len(self._path.elapsed), len(unmoved)))
        for k, value in enumerate(self._along.own_starts, start=len(self._momentum) + 6):
            if value:
                first = unmoved.copy()
                first[k] = value
                yield self._carried(first, still)

    def _carried(self, first: Floats, push: Floats, taken: Floats | None = None) -> Floats:
        """Return what errors of the start, of the rates and of ``taken`` values become at every time."""
        path = self._path
        size = self._along.sizes_of_state
        times = np.array([float(t) for t in path.elapsed])
        counted, error = push / size, first / size
        values = np.zeros_like(push) if taken is None else taken / size
        errors = [error + values[0]]
        for k, step in enumerate(path.carried.steps):
            span = (times[k + 1] - times[k]) / 2
            error = step @ (errors[-1] + span * counted[k]) + span * counted[k + 1] + values[k + 1]
            errors.append(error)
        every: Floats = np.array(errors) * size
        return every
