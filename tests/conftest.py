"""What every test is held to: it leaves the precision of mpmath and python-flint as it found it."""

from __future__ import annotations

import gc
from collections.abc import Iterator

import flint
import pytest
from hypothesis import settings
from mpmath import mp

# An example has no deadline: the first use of an integrator compiles it, and machines are shared. The
# examples are the same every time, so that a test that fails was made to fail by a change; to search
# further: pytest --hypothesis-profile=search.
settings.register_profile("house", deadline=None, derandomize=True)
settings.register_profile("search", deadline=None)
settings.load_profile("house")
# An assertion in a shared builder shows its values as one in a test does.
pytest.register_assert_rewrite("builders")


def pytest_collection_finish() -> None:
    """Leave what is collected to the end: the search for garbage need not pass it again and again."""
    gc.collect()
    gc.freeze()


@pytest.fixture(autouse=True)
def ambient_precision() -> Iterator[None]:
    """Fail a test that changes a global precision, and restore it for the next one."""
    before = mp.prec, flint.ctx.prec
    yield
    after = mp.prec, flint.ctx.prec
    mp.prec, flint.ctx.prec = before
    assert after == before, (
        f"expected mp.prec and flint.ctx.prec as before the test, {before}, got {after}; "
        "scope a precision with mp.workprec, mp.workdps or flint.ctx.workprec"
    )
