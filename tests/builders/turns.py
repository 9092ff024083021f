"""Cases of a test of which some are quick and the others slow, by turns."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import pytest


def by_turns(cases: Iterable[Any], of: int = 3) -> list[Any]:
    """Return the cases as parameters of a test: one of every so many is quick, the others are slow.

    A case of several parameters is a tuple. The first case is a quick one.
    """
    return [
        pytest.param(
            *(case if isinstance(case, tuple) else (case,)),
            marks=() if n % of == 0 else pytest.mark.slow,
        )
        for n, case in enumerate(cases)
    ]
