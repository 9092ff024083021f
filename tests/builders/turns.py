"""Cases of a test of which some are quick and the others slow, by turns."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable
from typing import Any

import pytest


def by_turns(
    cases: Iterable[Any], of: int = 4, kind: Callable[..., Hashable] = lambda *case: None
) -> list[Any]:
    """Return the cases as parameters of a test: one of every so many is quick, the others are slow.

    A case of several parameters is a tuple. The first case of each kind is a quick one.
    """
    parameters, kinds = [], set()
    for n, case in enumerate(cases):
        values = case if isinstance(case, tuple) else (case,)
        is_quick = n % of == 0 or kind(*values) not in kinds
        kinds.add(kind(*values))
        parameters.append(pytest.param(*values, marks=() if is_quick else pytest.mark.slow))
    return parameters
