"""The derivative of an orbit by its start, from differences of the exact solution at high precision.

It shares nothing with the equations that a solver is given.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Final

import numpy as np
from flint import arb, arb_mat, ctx
from mpmath import mp, mpf

from taylor_verify.exact.balls import midpoint
from taylor_verify.exact.conditioning.linearised import Flow, Steps
from taylor_verify.exact.conditioning.momentum import block_units, moved
from taylor_verify.exact.damping import decayed
from taylor_verify.exact.quadratic_forms import Floats
from taylor_verify.exact.registry import kind_of
from taylor_verify.exact.route import solution
from taylor_verify.exact.row_arithmetic import cross_matrices
from taylor_verify.exact.solution import Quantities, Unsettled
from taylor_verify.scenes.mpfr import precision, real, to_mpf, to_mpfr
from taylor_verify.scenes.scene import Scene

Array = np.ndarray[Any, Any]

# Momenta are changed by 10^-e of their size, with these e. The first attempt is for regular orbits.
_CLOSED_FORM_EXPONENTS: Final = (12, 25, 50, 100, 250)
_TAYLOR_EXPONENTS: Final = (12, 30, 60)
# Besides the e digits that a difference loses it has e of its own, and these.
_GUARD_DIGITS: Final = 12
# Norms are wanted to a digit or two; a single number, the determinant, stands for a whole matrix.
_VOLUME_ERROR: Final = mpf("1e-6")
# A determinant of six columns takes the digits of each: with so many times the precision of the
# differences, rounding in it adds nothing.
_SHARPER: Final = 6


def settled(scene: Scene, elapsed: Sequence[Fraction], least: int = 0) -> Derivatives:
    """Differences that conserve volume, of 10^-``least`` units or less.

    Both flows conserve volume, det D = 1, loads or not; a false digit in D shows in det D as it does in
    D_i D_k^-1, so precision rises until det D = 1 to six digits. Raises Unsettled if it never is.
    """
    exact = solution(scene)
    ladder = _TAYLOR_EXPONENTS if exact.route == "taylor" else _CLOSED_FORM_EXPONENTS
    first = max(least, ladder[0])
    for exponent in (first, *(higher for higher in ladder if higher > first)):
        digits = 2 * exponent + _GUARD_DIGITS
        differences = derivatives(scene, elapsed, exponent, digits)
        if differences.volume_error() <= _VOLUME_ERROR:
            return differences
    raise Unsettled(
        f"differences of the exact solution at {digits} digits do not conserve volume along the "
        f"orbit of {scene.name}: its transition matrix is not known"
    )


@dataclass(frozen=True)
class Derivatives:
    """The orbit's derivatives by its initial momentum, as object arrays of mpf.

    They are differences of 10^-``exponent`` units, formed with ``digits`` digits.
    ``momentum`` (n, d, d), d = 3 or 6, ``others`` (n, 3, d) by name (attitude, centre as tracked), the
    momenta themselves in ``state`` (n, d) and the ``centre`` (n, 3), empty where untracked. The flow turns
    a volume of 1 into ``volumes`` (n,), of which damping alone makes less or more. Momenta are
    measured in a power of two near the size of each component's block, in ``momentum`` and ``state``;
    everything else is in the scene's units. The centre counts from its place at the start.
    """

    exponent: int
    digits: int
    momentum: Array
    others: Mapping[str, Array]
    state: Array
    centre: Array
    volumes: Array

    def volume_error(self) -> mpf:
        """The largest |det D/volume - 1|; infinite where a derivative is not finite."""
        with mp.workdps(self.digits), ctx.workprec(_SHARPER * mp.prec):
            pairs = zip(self.momentum, self.volumes, strict=True)
            return max(midpoint(abs(_balls(D).det() / arb(v) - 1).upper()) for D, v in pairs)

    def steps(self, flow: Flow) -> tuple[Steps, float]:
        """The steps between the times in the flow's units, and the largest |D^-1|, over its volume's root.

        With D, A, C the derivatives of momentum, attitude and centre by the initial momentum, and c the
        centre, the derivatives by the initial state are

            momentum <- momentum  D
            attitude <- momentum  A     attitude <- attitude  1
            centre   <- momentum  C     centre   <- attitude  -[c - c(0)]x     centre <- centre  1

        since a rotation of the start turns the whole path about its start, and a shift moves it. This
        matrix at t_i, times the inverse of the one at t_k, is

            momentum <- momentum  D_i D_k^-1
            attitude <- momentum  (A_i - A_k) D_k^-1
            centre   <- momentum  (C_i - C_k + [c_i - c_k]x A_k) D_k^-1
            centre   <- attitude  -[c_i - c_k]x

        and 1 or 0 elsewhere.
        """
        n, d, _ = self.momentum.shape
        with mp.workdps(self.digits), ctx.workprec(_SHARPER * mp.prec):
            length = mp.convert(flow.length)
            nothing = np.full((n, 3, d), mpf(0), dtype=object)
            turn = self.others.get("attitude", nothing)
            shift = self.others.get("centre", nothing) / length
            path = self.centre / length if len(self.centre) else nothing[:, :, 0]
            inverses = [_balls(D).inv() for D in self.momentum]

            def carried(k: int, i: int) -> Floats:
                arm = cross_matrices(path[[i]] - path[[k]])[0]
                moved = shift[i] - shift[k] + arm @ turn[k]
                rows = np.concatenate([self.momentum[i], turn[i] - turn[k], moved])
                whole = np.eye(d + 6)
                whole[:, :d] = _floats(_balls(rows) * inverses[k])
                whole[d + 3 :, d : d + 3] = -arm.astype(float)
                return whole

            steps = np.array([carried(k, k + 1) for k in range(n - 1)]).reshape(-1, d + 6, d + 6)
            whole = np.array([carried(0, i) for i in range(n)])
            roots = [arb(mp.root(v, d)) for v in self.volumes]
            pairs = zip(inverses, roots, strict=True)
            sizes = [float(np.linalg.norm(_floats(inverse * root), 2)) for inverse, root in pairs]
            result = Steps(steps, whole, self.state.astype(float), path.astype(float))
        return result, max(sizes)


def derivatives(
    scene: Scene, elapsed: Sequence[Fraction], exponent: int, digits: int
) -> Derivatives:
    """Return one-sided differences at ``digits`` digits, each momentum changed by 10^-exponent units."""
    kind, step = kind_of(scene.body), Fraction(1, 10**exponent)
    expansion = Fraction(np.trace(kind.momentum_equations(scene.body).linear))
    with mp.workdps(digits):
        unmoved = solution(scene).evaluate(elapsed, digits)
        columns = []
        units = real((block_units(scene),))
        for j in range(units.size):
            beside = solution(moved(scene, j, step)).evaluate(elapsed, digits)
            columns.append(difference(unmoved, beside, mp.convert(step)))
        changes = [kind.momentum_rows(scene.body, column) for column in columns]
        centre = kind.centre(scene.initial)
        path = np.empty((0, 3), dtype=object)
        if "centre" in unmoved and centre is not None:
            path = unmoved["centre"] - real((centre,))
        return Derivatives(
            exponent=exponent,
            digits=digits,
            momentum=np.stack(changes, axis=2) / units.T,
            others={
                name: np.stack([column[name] for column in columns], axis=2)
                for name in ("attitude", "centre")
                if name in unmoved
            },
            state=kind.momentum_rows(scene.body, unmoved) / units,
            centre=path,
            volumes=np.array([decayed(-expansion * t, mp.convert) for t in elapsed], dtype=object),
        )


def difference(before: Quantities, after: Quantities, step: Any) -> dict[str, Array]:
    """(after - before)/step of every quantity, shape (n, 3); of attitudes the small turn between them."""
    change = {name: after[name] - before[name] for name in before if name != "attitude"}
    if "attitude" in before:
        R, moved_R = to_mpfr(before["attitude"]), to_mpfr(after["attitude"])
        j, k = [1, 2, 0], [2, 0, 1]
        with precision():
            turns = moved_R @ R.transpose(0, 2, 1)
            change["attitude"] = to_mpf((turns[:, k, j] - turns[:, j, k]) / 2)
    return {name: change[name] / step for name in before}


def _balls(matrix: Array) -> arb_mat:
    """The matrix, exactly."""
    return arb_mat([[arb(entry) for entry in row] for row in matrix])


def _floats(matrix: arb_mat) -> Floats:
    """The midpoints; infinite beyond float64."""
    return np.array([[float(entry) for entry in row] for row in matrix.table()])
