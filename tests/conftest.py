"""What every test is held to: it leaves the precision of mpmath and python-flint as it found it.

Without heyoka a test that needs it is skipped, with one reason: a test that imports it, and a test that is
marked `heyoka` because it starts a process that does. `make test` has heyoka, and skips none.
"""

from __future__ import annotations

import gc
import sys
from collections.abc import Iterator
from importlib.abc import MetaPathFinder
from importlib.util import find_spec
from typing import Final

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


WITHOUT_HEYOKA: Final = find_spec("heyoka") is None
REASON: Final = "needs heyoka, which is not installed (pip install 'taylor-verify[taylor]')"


class Absent(MetaPathFinder):
    """Skips the test, or the file of tests, that imports heyoka where it is not installed."""

    def find_spec(self, name: str, *_: object) -> None:
        if name == "heyoka":
            pytest.skip(REASON, allow_module_level=True)


if WITHOUT_HEYOKA:
    sys.meta_path.insert(0, Absent())


# Files that take longest begin first: else one core waits at the end while the other is at such a file.
LONGEST: Final = ("test_vectors.py", "test_drawn_loads.py", "test_exact_by_referee.py")


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Begin with the longest files, and skip what needs heyoka where it is not installed."""
    items.sort(key=lambda item: item.path.name not in LONGEST)
    for item in items:
        if WITHOUT_HEYOKA and item.get_closest_marker("heyoka") is not None:
            item.add_marker(pytest.mark.skip(reason=REASON))


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


@pytest.fixture
def without_causes(monkeypatch: pytest.MonkeyPatch) -> None:
    """Search for no causes, which change no verdict: they are most of the work on an answer that fails."""
    from taylor_verify import chain
    from taylor_verify.judge.causes.likely import Explained
    from taylor_verify.judge.files import judgement

    monkeypatch.setattr(judgement, "causes_of_file", lambda *_: Explained())
    monkeypatch.setattr(chain, "with_causes", lambda judged, *_: judged)
