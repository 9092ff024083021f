"""Hostile gyrostats: closed forms in balls, by mpmath and by enclosed Taylor series are one motion.

`python tests/hostile_gyrostats.py` judges as many as are asked for.
"""

from __future__ import annotations

import pytest
from builders.hostile_gyrostats import KINDS, disagreements, hostile
from mpmath import mpf

# Both sides have twenty digits.
ALLOWED = 3 * mpf(10) ** -20


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
def test_three_routes_agree_on_hostile_gyrostats(kind: str) -> None:
    """Eight bodies of every kind: all routes answer, and agree."""
    worst = [max(disagreements(hostile(kind, number))) for number in range(8)]
    assert all(part <= ALLOWED for part in worst)


@pytest.mark.parametrize(("kind", "number"), [("double point", 62), ("beside a double point", 96)])
def test_a_pole_at_no_finite_place_chooses_no_frame(kind: str, number: int) -> None:
    """Nor are poles beside three equal roots, all of them nearly zero, put on a root."""
    assert max(disagreements(hostile(kind, number))) <= ALLOWED
