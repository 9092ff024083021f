"""Derivatives of the exact motion by its initial state and by its body.

    sensitivity(scene, [Fraction(10)])["attitude", "inertia"]

A derivative is a difference of the exact solution between -h and h, compared with one between -h and
the wider step 2h. As long as h^2 rules, the first errs by h^2/6 of the third derivative and the second
by twice that, so that their distance is the error. It is an estimate, and no proof, although each
number that enters is proven where the scene has a closed form. Nothing is differenced where the
dependence is known exactly: a turn or a shift of the start moves the whole later path.

Legend: I inertia, K = I^-1, H = I omega; T = x.A x/2 + x.B y + y.C y/2, U = A x + B y,
Omega = B^T x + C y; M, X, L the loads; theta a small turn in space axes, R -> exp([theta]x) R.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cache, partial
from math import ceil
from typing import Any, Final

import numpy as np
from mpmath import mp, mpf

from taylor_verify.exact.conditioning.differences import difference, real
from taylor_verify.exact.conditioning.inputs import (
    Input,
    body_input,
    damping_input,
    start_inputs,
)
from taylor_verify.exact.damping import is_solved
from taylor_verify.exact.enclosure.system import posed
from taylor_verify.exact.route import solution
from taylor_verify.exact.rows import cross_matrices, turned
from taylor_verify.exact.solution import Quantities, Unsettled
from taylor_verify.scenes.motion import Impulse
from taylor_verify.scenes.precision import floor_log2, power_of_two
from taylor_verify.scenes.scene import Scene
from taylor_verify.scenes.tensors import ZERO_VECTOR

Array = np.ndarray[Any, Any]
Pair = tuple[str, str]

# The first step is 10^-(digits/2 + 4) of an input's size: a central difference then errs by
# 10^-(digits + 8) of a third derivative. Where the time is so long or the orbit so unstable that this
# is too wide, the exponent is doubled, half a dozen times.
_STEP_GUARD_DIGITS: Final = 4
_ATTEMPTS: Final = 7
# Digits of the base motion beyond those asked for; no difference of it is taken.
_GUARD_DIGITS: Final = 8


@dataclass(frozen=True)
class Sensitivity:
    """Derivatives of the motion at the times ``elapsed`` since the start, as object arrays of mpf.

    ``by[quantity, input]`` (n, 3, k) holds d quantity_i / d input_j at [:, i, j], in the scene's units
    of the one per unit of the other. Quantities, as tracked: ``omega``, ``linear_impulse``,
    ``angular_impulse`` in body axes; ``attitude`` as the rotation vector theta in space axes
    (radians; R becomes exp([theta]x) R); ``centre`` in space axes. Inputs, each with all the
    others fixed:

        omega                              euler: at the start, body axes
        linear_impulse, angular_impulse    kirchhoff: at the start, body axes
        attitude, centre                   at the start, space axes, where tracked
        inertia                            euler: I11 I22 I33 I23 I13 I12, body axes; a product
                                           of inertia changes both symmetric entries
        clebsch                            kirchhoff: p p_prime q q_prime r r_prime, or, where T
        energy                             is not of Clebsch's form: A11 A22 A33 A23 A13 A12,
                                           B11 B12 B13 B21 ... B33, C11 ... C12, symmetric likewise
        damping                            c, where there is damping, and, at c = 0, of a body
                                           without loads and wheels

    ``error[quantity, input]`` (n, k) estimates, and does not prove, the Euclidean error of each
    column. ``flow[quantity]`` (n, 3) is the derivative by time, from the equations of motion (for the
    attitude R omega). ``components[input]`` names the k components.
    """

    elapsed: tuple[Fraction, ...]
    by: Mapping[Pair, Array]
    error: Mapping[Pair, Array]
    flow: Mapping[str, Array]
    components: Mapping[str, tuple[str, ...]]

    def __getitem__(self, pair: Pair) -> Array:
        return self.by[pair]


def sensitivity(scene: Scene, times_elapsed: Sequence[Fraction], digits: int = 15) -> Sensitivity:
    """The derivatives of every tracked quantity by the initial state and the body.

    The times ``times_elapsed`` count from the start, in any order and of either sign. The estimated
    error of each column is at most 10^-digits of the column, or of the quantity's size (1 for an
    attitude, the distance from the start for a centre) per size of the input where that is larger.

    Raises exact.solution.Unsettled where that cannot be had, ValueError for no times and for a
    manufactured motion. Costs three motions per component of the initial omega or impulses and of the
    body, and of the damping; by Taylor that is slow.
    """
    if scene.body.manufactured is not None:
        raise ValueError(
            f"expected loads that do not depend on the body, got a manufactured motion @ {scene.name}"
        )
    elapsed = tuple(Fraction(time) for time in times_elapsed)
    if not elapsed:
        raise ValueError("expected at least one time since the start, got none")
    working, scene = digits + _GUARD_DIGITS, _from_origin(scene)
    motion = solution(scene).motion(elapsed, working)
    with mp.workdps(working):
        evaluate = cache(partial(solution(scene).evaluate, elapsed))
        base = _Base(scene.name, elapsed, _sizes(motion.quantities), evaluate)
        columns_of_pairs = dict(_by_place(motion.quantities, working))
        flow = _flow(scene, motion.quantities)
    inputs = [*start_inputs(scene), body_input(scene)]
    # An undamped body with loads or wheels has no closed form with a small damping.
    if scene.body.damping or is_solved(scene):
        inputs.append(damping_input(scene))
    for cause in inputs:
        columns = [_column(base, cause, j, digits) for j in range(len(cause.units))]
        for name in base.sizes:
            columns_of_pairs[name, cause.name] = (
                np.stack([column[name][0] for column in columns], axis=2),
                np.stack([column[name][1] for column in columns], axis=1),
            )
    components = {cause.name: cause.components for cause in inputs}
    components.update(dict.fromkeys(_places(motion.quantities), ("1", "2", "3")))
    return Sensitivity(
        elapsed=elapsed,
        by={pair: values for pair, (values, _) in columns_of_pairs.items()},
        error={pair: errors for pair, (_, errors) in columns_of_pairs.items()},
        flow=flow,
        components=components,
    )


# Differences.


@dataclass(frozen=True)
class _Base:
    """The scene as it is: its motion at any precision, and the sizes that errors are measured by."""

    name: str
    elapsed: tuple[Fraction, ...]
    sizes: Mapping[str, Array]
    at: Callable[[int], Quantities]


Column = dict[str, tuple[Array, Array]]


def _column(base: _Base, by: Input, j: int, digits: int) -> Column:
    """The derivative of each quantity by component j (n, 3), and its estimated error (n,)."""
    exponent = ceil(digits / 2) + _STEP_GUARD_DIGITS
    for _ in range(_ATTEMPTS):
        # The rounding of a difference, 10^-working/step, is to stay below its error, step^2.
        working = 3 * exponent + _STEP_GUARD_DIGITS
        with mp.workdps(working):
            column = _attempt(base, by, j, exponent, working)
            target = {name: size / mp.convert(by.units[j]) for name, size in base.sizes.items()}
            if all(_is_settled(*column[name], target[name], digits) for name in target):
                return column
        exponent *= 2
    raise Unsettled(
        f"differences of the exact solution do not agree to {digits} digits on how {base.name} "
        f"depends on {by.name} {by.components[j]}: ask for earlier times or fewer digits"
    )


def _attempt(base: _Base, by: Input, j: int, exponent: int, working: int) -> Column:
    """The difference with a step of 10^-exponent units, and the estimate of its error."""
    # A power of two, so that perturbed data stay short.
    step = power_of_two(floor_log2(Fraction(1, 10**exponent))) * by.units[j]
    h, unmoved = mp.convert(step), base.at(working)
    # Each is a smooth function of the step, zero at zero; so is a small turn away from here.
    behind, ahead, wide = (
        difference(
            unmoved, solution(by.moved(j, multiple * step)).evaluate(base.elapsed, working), h
        )
        for multiple in (-1, 1, 2)
    )
    rounding = mpf(10) ** -working
    column: Column = {}
    for name, size in base.sizes.items():
        central = (ahead[name] - behind[name]) / 2
        lopsided = (wide[name] - 4 * behind[name]) / 6
        # Three times the distance, because h^2 may not rule alone.
        error = 3 * _lengths(lopsided - central) + rounding * (size / h + _lengths(central))
        column[name] = central, error
    return column


def _is_settled(column: Array, error: Array, floor: Array, digits: int) -> bool:
    """Return True if every error is small beside the column or the floor; NaN never is."""
    tolerance = mpf(10) ** -digits
    return all(
        e <= tolerance * max(length, f)
        for e, length, f in zip(error, _lengths(column), floor, strict=True)
    )


def _lengths(vectors: Array) -> Array:
    """The Euclidean length of every row, shape (n,)."""
    return np.array([mp.norm(list(row.flat)) for row in vectors], dtype=object)


def _sizes(motion: Quantities) -> dict[str, Array]:
    """The size that an error of each quantity is measured against at each time, shape (n,)."""
    sizes = {name: _lengths(rows) for name, rows in motion.items()}
    if "attitude" in sizes:
        sizes["attitude"] = np.full(len(sizes["attitude"]), mpf(1), dtype=object)
    return sizes


# Derivatives that are known exactly.


def _from_origin(scene: Scene) -> Scene:
    """A scene's motion with its centre at the origin: digits are those of the path, wherever it begins."""
    if not isinstance(scene.initial, Impulse):
        return scene
    return replace(scene, initial=replace(scene.initial, centre=ZERO_VECTOR))


def _by_place(motion: Quantities, working: int) -> Iterator[tuple[Pair, tuple[Array, Array]]]:
    """A turn of the start turns the path about its start, a shift moves it; nothing else changes."""
    for into in _places(motion):
        for out, rows in motion.items():
            values = np.full((len(rows), 3, 3), mpf(0), dtype=object)
            errors = np.full((len(rows), 3), mpf(0), dtype=object)
            if out == into:
                values[:, [0, 1, 2], [0, 1, 2]] = mpf(1)
            elif out == "centre":
                # theta x c = -[c]x theta.
                values = values - cross_matrices(rows)
                # Of the centre itself 10^-working is proven.
                errors += (mpf(10) ** -working * _lengths(rows))[:, None]
            yield (out, into), (values, errors)


def _places(motion: Quantities) -> list[str]:
    return [name for name in ("attitude", "centre") if name in motion]


def _flow(scene: Scene, motion: Quantities) -> dict[str, Array]:
    """The right-hand sides of the equations of motion, R omega for the turning, and R U."""
    equations = posed(scene).equations
    moving = [name for name in motion if name not in ("attitude", "centre")]
    z = np.concatenate([motion[name] for name in moving], axis=1)
    if z.shape[1] < len(equations.constant):
        z = np.hstack([z, real(np.ones((len(z), 1), dtype=object))])
    products = (z[:, :, None] * z[:, None, :]).reshape(len(z), -1)
    hessian = equations.hessian.reshape(len(equations.hessian), -1)
    rate = real([equations.constant]) + products @ real(hessian).T / 2
    rates = {name: rate[:, 3 * k : 3 * k + 3] for k, name in enumerate(moving)}
    for name, form in (("attitude", equations.spin), ("centre", equations.velocity)):
        if name in motion:
            rates[name] = turned(motion["attitude"], z @ real(form).T)
    return rates
