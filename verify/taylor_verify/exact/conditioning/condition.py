"""The condition of an orbit: how errors that are made along it grow and add up.

e(s)     sizes of independent errors, made in the components of the state at time s
Phi(t,s) the derivative of the state at t by the state at s
P(t)     the mean squares and products of the grown errors at time t

    P(t) = sum over s <= t of Phi(t, s) diag(e(s)^2) Phi(t, s)^T.

The state is the momentum z (H, or the impulses x and y), in body axes; the attitude, as a rotation
vector in space axes (R becomes exp([theta]x) R); and the centre, in space axes; these two where they
are tracked. Phi comes from differences of the exact solution, or from the variational equations in
float64: as steps from time to time, and P is carried along as a factor L of itself, P = L L^T.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from itertools import accumulate, pairwise
from math import ceil, inf, log10
from typing import Any, Final

import numpy as np

from taylor_verify.exact.conditioning.by_differences import settled
from taylor_verify.exact.conditioning.linearised import Flow, Steps
from taylor_verify.exact.conditioning.loaded import DIGITS, enclosed, frame, is_of_run
from taylor_verify.exact.conditioning.momentum import momentum, moved
from taylor_verify.exact.conditioning.path_times import few, many, times_of_run
from taylor_verify.exact.conditioning.variation import integrated
from taylor_verify.exact.quadratic_forms import Floats
from taylor_verify.exact.route import solution
from taylor_verify.exact.solution import Unsettled
from taylor_verify.numbers.precision import float_text, floor_log2
from taylor_verify.scenes.scene import Scene

Places = np.ndarray[Any, np.dtype[np.int64]]

# float64 reaches e^700, and squares of the errors are formed.
_MOST_DECAY: Final = 300
# If a derivative exceeds 1 + rate x time by more than this, the orbit passes an unstable motion. Then the
# moments at which an error is made and observed matter.
REGULAR: Final = 8.0
# Steps of float64 cost less than orbits of dozens of digits beside this one until there are many; they
# cost less than orbits of hundreds of digits until there are thousands.
_FEW_RADIANS: Final = 500
_MOST_RADIANS: Final = 2000
# Norms are needed to one or two digits, and the size of a too large norm to a tenth.
_SHARP: Final = 1e-3
_ROUGH: Final = 0.1
# Each step in float64 errs by about this part of what it leads on. If errors shrink again after they grew
# far, that may be more than what is left of them.
_STEP_ERROR: Final = 1e-15
# Too little growth for that: the square of it, times the error of a step, is nothing beside a new error.
_LITTLE_GROWTH: Final = 1e6
# Differences that are smaller take minutes.
_LARGEST_EXPONENT: Final = 500


@dataclass(frozen=True)
class Path:
    """An orbit at the times ``elapsed`` since the start, and the derivative of its motion.

    ``momentum`` (n, d) and ``centre`` (n, 3; from its start; no rows if it is not tracked) are the
    motion there, in ``units``: powers of two by name, of the blocks of the state and of ``omega``.
    Where the derivative comes from differences, they are of 10^-``exponent`` units.
    """

    scene: Scene
    elapsed: Sequence[Fraction]
    carried: Steps
    exponent: int = 0

    @cached_property
    def flow(self) -> Flow:
        return self.carried.flow or Flow.of(self.scene)

    @cached_property
    def durations(self) -> Floats:
        """The distance of each time from the start."""
        return np.array([abs(float(t)) for t in self.elapsed])

    @cached_property
    def blocks(self) -> tuple[str, ...]:
        """The blocks of the state: of three components each, but for states of the scene's own."""
        moved = frame(self.scene)
        tracked = (name for name in ("attitude", "centre") if name in moved)
        return (*self.flow.momenta, *tracked, *self.carried.own)

    @property
    def units(self) -> dict[str, Fraction]:
        return {**self.flow.units, **self.carried.own_units}

    @property
    def momentum(self) -> Floats:
        return self.carried.momentum

    @property
    def centre(self) -> Floats:
        return self.carried.centre

    def gathered(self, errors: Floats) -> dict[str, Floats]:
        """The size, root mean square, of what the errors up to each time have become there.

        ``errors`` (n, components) are their sizes at each time. By name of the block, ``omega`` too;
        in units, infinite beyond float64. Of errors that shrink again by more than float64 has digits, its
        rounding is left, which makes them larger and not smaller.
        """
        among = np.ix_(self.places, self.places)
        factors = [np.diag(errors[0])]
        with np.errstate(all="ignore"):
            for step, sizes in zip(self.carried.steps, errors[1:], strict=True):
                both = np.hstack([step[among] @ factors[-1], np.diag(sizes)])
                factors.append(_narrowed(both))
            return self._sizes(np.array(factors))

    def norms(self, out: str, into: str) -> Floats:
        """The spectral norms of d out(t) / d into(0) at each time, in the scene's units.

        ``into`` is a block of the state, and ``out`` another one, or ``omega`` = K momentum for a rigid
        body. What the scene does not track raises KeyError. A norm outside the range of float64 is inf.
        """
        places = {name: self.places[self.span(name)] for name in self.blocks}
        columns = self.carried.since_first[:, :, places[into]]
        if out == "omega" and "momentum" in places:
            rows = self.flow.equations.spin @ columns[:, places["momentum"]]
        else:
            rows = columns[:, places[out]]
        unit = floor_log2(self.units[out] / self.units[into])
        with np.errstate(over="ignore", under="ignore"):
            return np.ldexp(_spectral_norms(rows), unit)

    @property
    def growth(self) -> Floats:
        """|d momentum(t) / d momentum(0)| at each time, in units, over the root of the volume.

        So what damping does to every error alike is left out.
        """
        d = self.momentum.shape[1]
        elapsed = np.array([float(t / self.flow.time) for t in self.elapsed])
        alike = np.exp(-self.flow.expansion / d * elapsed)
        growth: Floats = _spectral_norms(self.carried.since_first[:, :d, :d]) * alike
        return growth

    @property
    def is_resolved(self) -> bool:
        """True if the errors of steps in float64 become small beside the errors that are carried.

        The carried errors are one unit in each component at each time. A step's own error is made in
        proportion to what it carries, and is carried on like any other error.
        """
        if self.growth.max() <= _LITTLE_GROWTH:
            return True
        made = np.ones((len(self.elapsed), len(self.places)))
        carried = self.gathered(made)
        with np.errstate(over="ignore"):
            size = np.sqrt(sum(carried[block] ** 2 for block in self.blocks))
        if not np.isfinite(size).all():
            return False
        noise = self.gathered(_STEP_ERROR * size[:, None] * made)
        return all((noise[block] <= _ROUGH * carried[block]).all() for block in self.blocks)

    @property
    def rate(self) -> float:
        """The largest norm of the Jacobian along the orbit, per unit of the scene's time."""
        norms = np.linalg.norm(self.flow.jacobian(self.momentum), 2, axis=(-2, -1))
        return float(max(norms)) / float(self.flow.time)

    @property
    def is_regular(self) -> bool:
        """True if errors grow no faster than in proportion to time."""
        return bool((self.growth <= REGULAR * (1 + self.rate * self.durations)).all())

    @cached_property
    def _spans(self) -> dict[str, slice]:
        own = self.carried.own
        lengths = (own[name].shape[1] if name in own else 3 for name in self.blocks)
        ends = pairwise(accumulate(lengths, initial=0))
        return {name: slice(*span) for name, span in zip(self.blocks, ends, strict=True)}

    def span(self, block: str) -> slice:
        """The components of a block among those of all blocks."""
        return self._spans[block]

    @cached_property
    def places(self) -> Places:
        """The components of all blocks in the derivative, which has turn and centre always."""
        own = sum(rows.shape[1] for rows in self.carried.own.values())
        body = 3 * (len(self.blocks) - len(self.carried.own))
        whole = self.momentum.shape[1] + 6
        places: Places = np.r_[0:body, whole : whole + own]
        return places

    def _sizes(self, factors: Floats) -> dict[str, Floats]:
        """Return the norm of the rows of each block at each time, and those of omega."""
        names = {name: factors[:, self.span(name)] for name in self.blocks}
        if "momentum" in names:
            names["omega"] = self.flow.equations.spin @ names["momentum"]
        return {name: _norms(rows) for name, rows in names.items()}


def _narrowed(factor: Floats) -> Floats:
    """A square L with the same L L^T; what is once beyond float64 is so for ever."""
    if np.isfinite(factor).all():
        upper: Any = np.linalg.qr(factor.T, mode="r")
        lower: Floats = upper.T
        return lower
    return np.full((len(factor), len(factor)), np.inf)


def _spectral_norms(matrices: Floats) -> Floats:
    """The largest singular value over the last two axes; inf where an entry is not finite."""
    return _norms(matrices, 2)


def _norms(matrices: Floats, order: int | None = None) -> Floats:
    """A norm over the last two axes, Frobenius's unless given; inf where an entry is not finite."""
    size = np.abs(matrices).max(axis=(-2, -1), keepdims=True)
    # Divided by their size, because squares of entries may be beyond the doubles.
    moderate = np.where(np.isfinite(size), matrices, 0.0) / np.where(size > 0, size, 1.0)
    norms = np.linalg.norm(moderate, order, axis=(-2, -1))
    sizes: Floats = np.where(np.isfinite(size[..., 0, 0]), norms * size[..., 0, 0], inf)
    return sizes


# The choice of the way to compute the derivative.


def transition(scene: Scene, elapsed: Sequence[Fraction]) -> Path:
    """The orbit at these times, ``elapsed`` since the start and sorted away from it.

    Raises Unsettled where the derivatives of the motion cannot be had.
    """
    _refuse_far_decay(scene, elapsed)
    if scene.body.loads is not None:
        return Path(scene, elapsed, enclosed(scene, elapsed))
    if differs_dearly(scene):
        steps = integrated(scene, elapsed)
        if steps is not None:
            return Path(scene, elapsed, steps)
    differences = settled(scene, elapsed)
    return Path(scene, elapsed, differences.steps(Flow.of(scene))[0], differences.exponent)


def path(scene: Scene, digits: int = DIGITS) -> Path:
    """The orbit of a scene at as many times as it takes; some or all samples are among them.

    ``digits`` are those of a motion that comes with its derivative.

    Raises Unsettled where the derivatives of the motion cannot be had.
    """
    elapsed = scene.clock.elapsed
    _refuse_far_decay(scene, elapsed)
    if is_of_run(scene):
        return path_of_run(scene, digits)
    coarse = _along(scene, few(elapsed))
    if coarse.is_regular:
        return coarse
    rate, growth = coarse.rate, coarse.growth.max()
    points = many(elapsed, rate)
    is_dear = differs_dearly(scene)
    if growth < inf and (is_dear or rate * abs(elapsed[-1]) <= _MOST_RADIANS):
        # The growth may magnify the last digit of the truth, so the truth gets as many more digits.
        steps = integrated(scene, points, ceil(log10(growth)))
        if steps is not None:
            followed = Path(scene, points, steps)
            if is_dear or followed.is_resolved:
                return followed
    if growth == inf:
        return sharp(scene, points, coarse.exponent)
    # Differences that give such growth to six digits.
    return sharp(scene, points, min(ceil(3 * log10(growth)) + 6, _LARGEST_EXPONENT))


def path_of_run(scene: Scene, digits: int = DIGITS) -> Path:
    """The orbit of a scene at its samples and some times between, from one run of the enclosure.

    Raises Unsettled where the motion is not reached.
    """
    times = times_of_run(scene)
    return Path(scene, times, enclosed(scene, times, digits))


def is_far_decay(scene: Scene, elapsed: Fraction) -> bool:
    """Return True if damping takes the errors out of the range of float64 in so much time."""
    return abs(scene.body.damping * elapsed) > _MOST_DECAY


def _refuse_far_decay(scene: Scene, elapsed: Sequence[Fraction]) -> None:
    """Raise Unsettled where damping leaves no floor."""
    if is_far_decay(scene, elapsed[-1]):
        exponent = abs(scene.body.damping * elapsed[-1])
        raise Unsettled(
            f"damping changes the momenta by e^{float_text(exponent)}: beyond e^{_MOST_DECAY} it is not "
            "known what becomes of an error"
        )


def differs_dearly(scene: Scene) -> bool:
    """Return True if each difference of the motion would cost a Taylor integration.

    One integration along it costs less. A start beside it may leave the closed form: Weber's loses FG = 0.
    """
    beside = (moved(scene, j, Fraction(1)) for j in range(len(scene.initial.moving)))
    return any(solution(start).route == "taylor" for start in (scene, *beside))


def sharp(scene: Scene, points: Sequence[Fraction], least: int = 0) -> Path:
    """A path from differences so small that products of F with its inverses have their leading digits.

    A step of 10^-e leaves an error of 10^-e |F|^2 in F, and that is multiplied by F^-1. The first step
    tells both sizes. If no exponent is enough, the result has noise, which makes it larger and not smaller.
    """
    differences = settled(scene, points, least)
    steps, shrinkage = differences.steps(Flow.of(scene))
    path = Path(scene, points, steps, differences.exponent)
    # In decades, because squares and powers may be beyond float64.
    lost = 2 * _decades(path.growth.max()) + _decades(shrinkage)
    enough = min(lost - _decades(_SHARP), _LARGEST_EXPONENT)
    is_enough = not enough > differences.exponent
    return path if is_enough else sharp(scene, points, ceil(enough))


def _decades(size: float) -> float:
    """Return log10 of a size that is no less than zero; NaN where it is none."""
    return log10(size) if 0 < size < inf else -inf if size == 0 else float(size)


def _along(scene: Scene, points: Sequence[Fraction]) -> Path:
    """Return the orbit at a few points."""
    if _is_short(scene) or differs_dearly(scene):
        steps = integrated(scene, points, is_rough=True)
        if steps is not None:
            return Path(scene, points, steps)
    return sharp(scene, points)


def _is_short(scene: Scene) -> bool:
    """Return True if steps of float64 along the orbit cost less than four or seven orbits beside it."""
    flow = Flow.of(scene)
    pairs = zip(momentum(scene.body, scene.initial), flow.components, strict=True)
    counted = np.array([float(value / unit) for value, unit in pairs])
    rate = float(flow.rate(counted)) / float(flow.time)
    return bool(rate * abs(float(scene.clock.elapsed[-1])) <= _FEW_RADIANS)
