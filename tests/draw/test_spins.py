"""The steady spins of bodies with wheels: as many as the exact ones, and born where f is least."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from mpmath import mp

from taylor_verify.draw.spins import Wheels, number
from taylor_verify.exact.gyrostat.pencil import FreeGyrostat
from taylor_verify.exact.gyrostat.spins import steady_spins
from taylor_verify.numbers.tensors import diagonal

MOMENTS = (Fraction(1), Fraction(2), Fraction(3))
PLAIN = Wheels(np.array([1.0, 2.0, 3.0]), np.array([0.3, -0.2, 0.5]))


def exact(rotor: tuple[Fraction, ...], size: Fraction) -> list[tuple[float, float]]:
    """Rates omega.H/|H| and s^2 of the steady spins with H of this size along axis 1."""
    omega = (size - rotor[0], -rotor[1] / 2, -rotor[2] / 3)
    with mp.workdps(20):
        spins = steady_spins(FreeGyrostat(diagonal(MOMENTS), rotor, omega))
        return [(float(spin.rate), float(spin.square)) for spin in spins]


@pytest.mark.parametrize(
    "rotor", [(0.25, -0.125, 0.5), (0.75, 0.5, -1.0), (0.0, 0.25, 0.5), (0.0, 0.5, 0.0), (2, 1, 1)]
)
@pytest.mark.parametrize("size", [0.25, 1.0, 2.0, 8.0])
def test_regions_have_as_many_spins_as_there_are(rotor: tuple[float, ...], size: float) -> None:
    """The two pairs that the border tells apart are the exact steady spins beyond two."""
    first, second = number(PLAIN.moments, np.array(rotor), size)
    spins = exact(tuple(map(Fraction, rotor)), Fraction(size))
    assert 2 + 2 * (int(first > 0) + int(second > 0)) == len(spins)


def test_branches_are_the_exact_spins() -> None:
    """Each curve has the energy and the stability of a steady spin where |H| is 2, and of no other."""
    spins = exact((Fraction(3, 10), Fraction(-1, 5), Fraction(1, 2)), Fraction(2))
    branches = []
    for branch in PLAIN.branches(3.0):
        order = np.argsort(branch.sizes)
        if branch.sizes.min() <= 2 <= branch.sizes.max():
            momentum = np.array(
                [np.interp(2.0, branch.sizes[order], c) for c in branch.momenta[order].T]
            )
            omega = (momentum - PLAIN.rotor) / PLAIN.moments
            branches.append((float(omega @ momentum) / 2, branch.stable))
    assert [stable for _, stable in sorted(branches)] == [square < 0 for _, square in spins]
    assert np.array(sorted(branches))[:, 0] == pytest.approx([rate for rate, _ in spins], abs=2e-3)


def test_wheels_along_the_middle_axis_make_it_stable_up_to_a_birth() -> None:
    """With h along axis 2 the evolute's section is known: |H| = h/|1 - J2/J| at the cusps of that axis."""
    births = Wheels(np.array([1.0, 2.0, 3.0]), np.array([0.0, 4.0, 0.0])).births()
    assert births == pytest.approx([4.0, 12.0])


def test_extremes_are_beyond_every_other_energy() -> None:
    """The outer branches have the least and the greatest energy of any momentum of that size."""
    directions = np.random.default_rng(1).normal(size=(2000, 3))
    momenta = 2 * directions / np.linalg.norm(directions, axis=1, keepdims=True)
    for rotor in ([0.3, -0.2, 0.5], [0.0, 0.0, 0.5], [0.0, 4.0, 0.0], [0.0, 0.0, 0.0]):
        wheels = Wheels(PLAIN.moments, np.array(rotor))
        low, high = wheels.extremes(np.array([2.0]))
        energies = wheels.energy(momenta)
        spread = float(high[0] - low[0])
        assert low[0] <= energies.min() <= low[0] + 0.02 * spread
        assert high[0] - 0.02 * spread <= energies.max() <= high[0]
