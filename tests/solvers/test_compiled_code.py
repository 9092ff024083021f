"""What heyoka compiles: nothing is stored, and no decimal comma reaches it."""

from __future__ import annotations

import locale
import shutil
import subprocess
from pathlib import Path

import heyoka as hy
import pytest
from builders.processes import printed_by

from taylor_verify.models.problem import pose
from taylor_verify.numbers.decimal_point import decimal_point
from taylor_verify.numbers.precision import rung
from taylor_verify.scenes.reading.reader import load
from taylor_verify.solvers.taylor.driver import compiled


def test_heyoka_stores_nothing() -> None:
    """heyoka's own database, which damage turns into a crash, is never opened."""
    problem = pose(load("euler/generic"), rung("f64"))
    hy.llvm_state.set_diskcache_enabled(True)
    compiled.__wrapped__(problem.form, problem.rung, tolerance=None, is_optimised=True)
    assert not hy.llvm_state.get_diskcache_enabled()


# The locale.

COMMA = """
import locale
locale.setlocale(locale.LC_ALL, "de_DE.UTF-8")
from taylor_verify import run
print(run("euler/generic", rung="f128").passed, locale.localeconv()["decimal_point"])
"""


@pytest.fixture(scope="module")
def german(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the locale of Germany, whose decimal mark is a comma."""
    folder = tmp_path_factory.mktemp("locales")
    if not shutil.which("localedef"):
        pytest.skip("no localedef to make the locale de_DE with")
    words = ["localedef", "-i", "de_DE", "-f", "UTF-8", str(folder / "de_DE.UTF-8")]
    if subprocess.run(words, capture_output=True, check=False).returncode:
        pytest.skip("localedef cannot make the locale de_DE")
    return folder


def test_a_decimal_comma_reaches_no_code(german: Path) -> None:
    """heyoka is imported, and its code compiled, with decimal points; the comma comes back."""
    assert printed_by(COMMA, LOCPATH=str(german)) == "True ,\n"


def test_blocks_with_decimal_points_may_overlap(monkeypatch: pytest.MonkeyPatch) -> None:
    """The locale before the first block comes back behind the last, whoever ends it, and not before."""
    calls: list[str | None] = []

    def setlocale(category: int, name: str | None = None) -> str:
        assert category == locale.LC_NUMERIC
        calls.append(name)
        return "de_DE.UTF-8"

    monkeypatch.setattr(locale, "setlocale", setlocale)
    with decimal_point():
        with decimal_point():
            pass
        assert "de_DE.UTF-8" not in calls
    assert calls == [None, "C", "C", "de_DE.UTF-8"]
