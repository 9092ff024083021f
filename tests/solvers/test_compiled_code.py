"""Compiled integrators on disk: found again, kept apart by processor, and never trusted unread."""

from __future__ import annotations

import locale
import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path
from typing import Any

import heyoka as hy
import pytest
from builders.turns import by_turns

import taylor_verify
from taylor_verify.models.problem import pose
from taylor_verify.numbers.decimal_point import decimal_point
from taylor_verify.numbers.precision import rung
from taylor_verify.scenes.reading.reader import load
from taylor_verify.solvers.taylor import cache
from taylor_verify.solvers.taylor.driver import compiled


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A cache of the test's own, and the folder of this processor in it."""
    monkeypatch.setenv(cache.CACHE_VARIABLE, str(tmp_path))
    return tmp_path / cache.processor_key()


def compile_afresh(name: str = "f64", scene: str = "euler/generic", **options: Any) -> Any:
    """An integrator as a new process gets it: nothing compiled is in the memory of this one."""
    hy.llvm_state.clear_memcache()
    problem = pose(load(scene), rung(name))
    options = {"tolerance": None, "is_optimised": True} | options
    return compiled.__wrapped__(problem.form, problem.rung, **options)


def files(folder: Path) -> list[Path]:
    return sorted(folder.iterdir()) if folder.exists() else []


def test_code_is_stored_by_processor_and_found_again(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A second process compiles nothing: its integrator is read from the processor's folder."""
    first = compile_afresh()
    assert len(files(folder)) == 1
    monkeypatch.setattr(hy, "taylor_adaptive", _no_compilation)
    again = compile_afresh()
    assert str(again.decomposition) == str(first.decomposition)
    assert (again.order, again.tol) == (first.order, first.tol)


def _no_compilation(*_: Any, **__: Any) -> Any:
    raise AssertionError("compiled anew")


_no_compilation.__name__ = "taylor_adaptive"


def test_unlike_integrators_are_unlike_files(folder: Path) -> None:
    """Rung, tolerance, equations, literals and optimisation are each in the name of a file."""
    compile_afresh()
    compile_afresh("f80")
    for other in (
        {"name": "f32"},
        {"scene": "euler/with-attitude"},
        {"tolerance": Fraction(1, 1000)},
        {"tolerance": Fraction(1, 1001)},
        {"name": "f80", "is_optimised": False},
        {"name": "mp237"},
        {"name": "mp113"},
        {"name": "mp113", "tolerance": Fraction(1, 1000)},
    ):
        before = len(files(folder))
        compile_afresh(**other)
        assert len(files(folder)) == before + 1, other


_SOLVED_IN_MPFR = """
from taylor_verify.run import solve

rows = solve("euler/generic", rung="mp237").quantities["omega"]
print(*(value for row in rows for value in row))
"""


def test_code_for_mpfr_numbers_is_found_by_another_process(folder: Path) -> None:
    """Two processes store one piece of code, and it computes the same numbers in each."""
    answers = {
        subprocess.run(
            [sys.executable, "-c", _SOLVED_IN_MPFR], check=True, capture_output=True, text=True
        ).stdout
        for _ in range(2)
    }
    of_mpfr = {file.name for file in files(folder)}
    compile_afresh("f64")
    assert len(answers) == 1
    assert len(of_mpfr) == len(files(folder)) == 2, (
        "one in MPFR, and one that finds its fastest rate"
    )


def test_heyoka_stores_nothing_itself(folder: Path, tmp_path: Path) -> None:
    """heyoka's own database, which damage turns into a crash, is never opened."""
    compile_afresh()
    assert not hy.llvm_state.get_diskcache_enabled()
    assert not list(tmp_path.rglob("*.db*"))


def _truncated(file: Path) -> None:
    os.truncate(file, file.stat().st_size // 2)


def _beheaded(file: Path) -> None:
    content = file.read_bytes()
    file.write_bytes(bytes(100) + content[100:])


def _one_bit(file: Path) -> None:
    """Flip a bit of the machine code and keep the time of the file: no stamp shows the change."""
    before, content = file.stat(), bytearray(file.read_bytes())
    content[len(content) // 2] ^= 1
    file.write_bytes(content)
    os.utime(file, ns=(before.st_atime_ns, before.st_mtime_ns))


@pytest.mark.parametrize("damage", by_turns([_truncated, _beheaded, _one_bit]))
def test_damaged_code_is_compiled_anew_with_one_warning(
    folder: Path, damage: Callable[[Path], None], caplog: pytest.LogCaptureFixture
) -> None:
    """Every damaged file is seen before heyoka gets it, and is whole again after one warning."""
    compile_afresh()
    compile_afresh(scene="euler/with-attitude")
    stored = {file: file.stat().st_size for file in files(folder)}
    for file in stored:
        damage(file)
    for _ in range(2):
        compile_afresh()
        compile_afresh(scene="euler/with-attitude")
    expected = f"taylor-verify: warning: damaged compiled code is compiled anew @ {folder}"
    assert caplog.messages == [expected]
    assert {file: file.stat().st_size for file in files(folder)} == stored


@pytest.mark.skipif(not hasattr(os, "geteuid"), reason="files have no owner here")
@pytest.mark.parametrize("fault", ["writable by all", "another's", "pipe", "unreadable"])
def test_only_files_of_the_user_s_own_are_read(
    folder: Path, fault: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A file that anybody else could have written is not loaded; the integrator is compiled."""
    compile_afresh()
    (file,) = files(folder)
    if fault == "writable by all":
        file.chmod(0o666)
    elif fault == "another's":
        monkeypatch.setattr(os, "geteuid", lambda: 12345)
    elif fault == "pipe":
        file.unlink()
        os.mkfifo(file)
    elif os.geteuid() == 0:
        pytest.skip("root may read everything")
    else:
        file.chmod(0)
    monkeypatch.setattr(cache.pickle, "loads", lambda _: pytest.fail("it was loaded"))
    assert compile_afresh() is not None


def test_the_cache_has_a_largest_size(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Beyond it the files that were not used for longest go."""
    compile_afresh()
    (oldest,) = files(folder)
    os.utime(oldest, (0, 0))
    compile_afresh("f32")
    (younger,) = {*files(folder)} - {oldest}
    os.utime(younger, (1, 1))
    compile_afresh()  # used again: now the other is the one not used for longest
    monkeypatch.setattr(cache, "_LARGEST_CACHE", sum(f.stat().st_size for f in files(folder)))
    # Of a lower order, and so smaller than the one that has to go.
    compile_afresh("f32", tolerance=Fraction(1, 10))
    assert oldest in files(folder)
    assert younger not in files(folder)


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


def test_a_decimal_comma_reaches_no_code(german: Path, tmp_path: Path) -> None:
    """heyoka is imported, and its code compiled and stored, with decimal points; the comma comes back."""
    own = {"LOCPATH": str(german), cache.CACHE_VARIABLE: str(tmp_path)}
    package = str(Path(taylor_verify.__file__).parents[1])
    done = subprocess.run(
        [sys.executable, "-c", COMMA],
        env={**os.environ, **own, "PYTHONPATH": package},
        capture_output=True,
        text=True,
        check=False,
    )
    assert (done.returncode, done.stdout) == (0, "True ,\n"), done.stderr


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
