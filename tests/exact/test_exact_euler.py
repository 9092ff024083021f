"""The regime of a free rigid body is decided exactly."""

from __future__ import annotations

from fractions import Fraction

import pytest
from builders.free_spins import (
    OBLIQUE,
    SPINS,
    near_separatrix,
    spinning,
    turned,
)
from builders.scenes import vector


@pytest.mark.parametrize("name", SPINS)
def test_regime_is_decided_exactly(name):
    """Each orbit is of the kind it was built to be, whatever axes it is described in."""
    word = name.split(",")[0]
    assert SPINS[name].regime == word
    assert turned(OBLIQUE, SPINS[name]).regime == word


@pytest.mark.parametrize(
    ("moments", "omega", "word"),
    [
        ((2, 2, 2), (0, 0, 0), "rest"),
        ((2, 2, 2), (1, 0, 0), "spherical"),
        ((2, 2, 1), (0, 0, 0), "rest"),
        ((2, 2, 1), (3, 4, 0), "steady"),
        ((2, 2, 1), (0, 0, 1), "steady"),
        ((3, 2, 1), (0, 1, 0), "steady"),
    ],
)
def test_the_simplest_description_wins(moments, omega, word):
    """Rest comes before the shape of the body, and a permanent rotation before its symmetry."""
    assert spinning(vector(*moments), vector(*omega)).regime == word


@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize("exponent", [20, 60, 400])
def test_regime_beside_the_separatrix(sign, exponent):
    """One part in 1e400 more or less of one component decides which axis is encircled."""
    spin = near_separatrix(Fraction(sign, 10**exponent))
    assert spin.regime == ("max-axis" if sign > 0 else "min-axis")
