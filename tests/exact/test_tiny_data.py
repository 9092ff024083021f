"""Nothing that is not zero becomes zero: what is tiny at first starts an unstable motion when it must."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from builders.scenes import one_instant, vector
from mpmath import mp, mpf

from taylor_verify.exact.route import solution
from taylor_verify.exact.taylor import TaylorSolution
from taylor_verify.numbers import tensors
from taylor_verify.numbers.tensors import ZERO_MATRIX, diagonal
from taylor_verify.scenes.bodies import ImmersedBody, RigidBody
from taylor_verify.scenes.motion import Impulse, Spin
from taylor_verify.scenes.scene import Scene

TRIAXIAL = RigidBody(diagonal(vector(1, 2, 3)))
# A disturbance of the spin about the middle axis grows by exp(0.577 t).
GROWTH = 0.577


def small_start(seed: Fraction) -> tuple[Scene, Scene]:
    spinning = one_instant(TRIAXIAL, Spin((seed, Fraction(1), Fraction(0))), "attitude")
    return spinning, spinning


def small_gap(seed: Fraction) -> tuple[Scene, Scene]:
    nearly = RigidBody(diagonal((Fraction(1), Fraction(2), 2 + seed)))
    spinning = one_instant(nearly, Spin((Fraction(1, 3), Fraction(1), Fraction(1, 7))))
    return spinning, spinning


def small_coefficient(seed: Fraction) -> tuple[Scene, Scene]:
    """With A = 1 and B = 0 the couple y moves as the momentum of the rigid body with K = C."""
    turned = (
        (Fraction(1), seed, Fraction(0)),
        (seed, Fraction(1, 2), Fraction(0)),
        vector(0, 0, "1/3"),
    )
    solid = ImmersedBody(diagonal(vector(1, 1, 1)), ZERO_MATRIX, turned)
    about = vector(0, 2, 0)
    rigid = RigidBody(tensors.inverse(turned))
    return (
        one_instant(solid, Impulse(vector(0, 0, 1), about)),
        one_instant(rigid, Spin(tensors.apply(turned, about))),
    )


SEEDED = {
    "start": small_start,
    "gap": small_gap,
    "coefficient": small_coefficient,
}


@pytest.mark.parametrize(("kind", "exponent"), [("start", 20), ("gap", 300), ("coefficient", 20)])
def test_a_tiny_datum_starts_an_unstable_motion(kind: str, exponent: int) -> None:
    """A start, coefficient or gap of 10^-300 is not lost: the body tumbles when it must."""
    enclosed, known = SEEDED[kind](Fraction(1, 10**exponent))
    late = [Fraction(round(exponent * 2.302585 / GROWTH) + 3)]
    motion, truth = (
        TaylorSolution(enclosed).motion(late, 12),
        solution(known, "arb").motion(late, 20),
    )
    with mp.workdps(60):
        if kind == "coefficient":
            assert isinstance(known.body, RigidBody)
            inertia = np.array([[mp.convert(c) for c in row] for row in known.body.inertia])
            one, other = motion["angular_impulse"][0], inertia @ truth["omega"][0]
        else:
            one, other = motion["omega"][0], truth["omega"][0]
        assert mp.norm(list(one - other)) <= mpf(10) ** -12 * mp.norm(list(other))
        if kind != "gap":
            # The spin about the middle axis has visibly ended.
            assert abs(abs(one[1]) / mp.norm(list(one)) - 1) > mpf("1e-4")
