"""A long file is judged block of rows by block of rows, and its verdicts do not depend on the blocks."""

from __future__ import annotations

import math
import subprocess
import sys
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from builders.scenes import sampled
from builders.trajectories import Columns, columns_at, write_csv
from mpmath import mp

from taylor_verify import check
from taylor_verify.exact.invariants import decisive, invariants
from taylor_verify.exact.route import solution
from taylor_verify.judge.errors import measured
from taylor_verify.judge.errors.state import Series
from taylor_verify.scenes.mpfr import in_mpfr, precision
from taylor_verify.scenes.reading.reader import load
from taylor_verify.solvers.files.compact_rows import Rows
from taylor_verify.solvers.files.file import read
from taylor_verify.solvers.values import as_mpf, exact

pytestmark = pytest.mark.usefixtures("without_causes")
ROWS = 61
BLOCK = 7
# The exact motion of few instants has other roundings than that of many. Each is proven to forty bits more
# than its 19 digits, about 1e-31, and no error here is below 1e-18.
SAME = 1e-13


def columns_of(name: str) -> Columns:
    """The exact motion in doubles, column by column."""
    scene = sampled(load(name), ROWS)
    return columns_at(scene, scene.clock.instants)


def late(columns: Columns) -> None:
    """A clock that runs slow: an error that grows, and has a cause."""
    columns["t"] = [t * (1 + 1e-6) for t in columns["t"]]


def stray(columns: Columns) -> None:
    columns["w1"][40] += 0.5


def lost(columns: Columns) -> None:
    columns["w2"][33] = math.nan


def before_too(columns: Columns) -> None:
    """Rows on either side of the start; a body without loads comes back by the same way."""
    columns["t"] = [t - 30 for t in columns["t"]]


def without_attitude(columns: Columns) -> None:
    for column in ("q0", "q1", "q2", "q3"):
        del columns[column]


def as_it_is(columns: Columns) -> None:
    del columns


def alike(one: Any, other: Any) -> bool:
    """Return True if two fields of verdicts are equal, numbers as far as the exact motion is known."""
    if isinstance(one, float) and isinstance(other, float):
        return (one != one and other != other) or abs(one - other) <= SAME * abs(one)
    return bool(one == other)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "changed"),
    [
        ("euler/generic", as_it_is),
        ("euler/generic", before_too),
        ("euler/with-attitude", late),
        ("euler/with-attitude", stray),
        ("euler/with-attitude", lost),
        ("euler/with-attitude", without_attitude),
        ("kirchhoff/whole-motion", as_it_is),
        ("kirchhoff/constant-loads", as_it_is),
        ("kirchhoff/general-body", as_it_is),
    ],
)
def test_the_blocks_change_no_verdict(
    name: str,
    changed: Callable[[Columns], None],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Nine blocks and one give the same verdicts, rows, ratios and shifts."""
    columns = columns_of(name)
    changed(columns)
    path = write_csv(tmp_path / "run.csv", columns)
    whole = check(name, path).verdicts
    monkeypatch.setattr(measured, "BLOCK", BLOCK)
    monkeypatch.setattr(measured, "BLOCK_OF_SERIES", BLOCK)
    parts = check(name, path).verdicts
    assert [v.quantity for v in parts] == [v.quantity for v in whole]
    for one, other in zip(whole, parts, strict=True):
        unlike = {k for k, value in one.row().items() if not alike(value, other.row()[k])}
        assert not unlike, (one.quantity, unlike)


def test_a_scale_that_is_forgotten_changes_a_verdict(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A twin that leaves every error over the scale of the first block is caught by that comparison."""
    path = write_csv(tmp_path / "run.csv", columns_of("kirchhoff/whole-motion"))
    (whole,) = (v for v in check("kirchhoff/whole-motion", path).verdicts if v.quantity == "centre")

    def forgotten(self: Series) -> tuple[Any, Any]:
        return np.concatenate(self._blocks), self._scale

    monkeypatch.setattr(measured, "BLOCK", BLOCK)
    monkeypatch.setattr(Series, "joined", forgotten)
    (twin,) = (v for v in check("kirchhoff/whole-motion", path).verdicts if v.quantity == "centre")
    assert not alike(twin.max, whole.max)


def test_the_worst_row_of_a_long_file_is_among_those_of_its_shift(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A single wrong row that no even choice meets is no part of a clock that runs slow: it is a stray."""
    columns = columns_of("euler/with-attitude")
    late(columns)
    columns["w1"][41] += 0.5
    path = write_csv(tmp_path / "run.csv", columns)
    monkeypatch.setattr(measured, "BLOCK", BLOCK)
    monkeypatch.setattr(measured, "MOST_SHIFTED", 21)
    (omega,) = (v for v in check("euler/with-attitude", path).verdicts if v.quantity == "omega")
    assert omega.max == pytest.approx(0.5 / 1.1, rel=0.2)
    assert omega.at == columns["t"][41]
    assert omega.reason.shift.strays == (columns["t"][41],)
    # Twenty-one that are evenly chosen, and the worst.
    assert omega.reason.shift.rows == 22


@pytest.mark.parametrize(
    "name",
    [
        *(
            "euler/with-attitude",
            "euler/rest",
            "kirchhoff/whole-motion",
            "kirchhoff/constant-loads",
        ),
        *("kirchhoff/zero-impulse", "kirchhoff/steklov", "kirchhoff/clebsch-second-case"),
    ],
)
def test_a_few_rows_have_the_scale_of_all(name: str) -> None:
    """The scale of every invariant is that of its decisive rows, to the last bit."""
    scene = load(name)
    motion = in_mpfr(solution(scene).motion(scene.clock.elapsed, 20))
    with precision():
        few = motion.at(decisive(scene, motion))
        assert len(few.radius) <= 4
        for invariant in invariants(scene):
            assert invariant.scale(few) == invariant.scale(motion)


def test_rows_are_formed_as_their_values_are() -> None:
    """Short decimals, which are formed many at once, and all other numbers, one by one, to the last bit."""
    short = ["0.1", "-3", "+2.50", "7.e-3", "1e22", " 0.3 ", "-0", "12345678901234567890.123456789"]
    other = ["0x1.8p-3", "1/3", "1e-400", "0." + "1" * 60, "nan", "-inf", "2", "0.1"]
    text = np.dtypes.StringDType()
    packed = [np.array(column, dtype=text) for column in (short, other)]
    for column in (short, other, *packed, np.array([0.1, -2.5, 1e-300]), np.array([3, 4, 5])):
        values = [exact(raw) for raw in column]
        rows = Rows([column])
        assert [row[0] for row in rows][:4] == values[:4]
        places = range(len(column))
        wanted = [as_mpf(value, 181) for value in values]
        for mine, theirs in zip(rows.as_mpf(places, 181)[:, 0], wanted, strict=True):
            assert mine == theirs or (mp.isnan(mine) and mp.isnan(theirs))
        doubles = [float(value) for value in values]
        np.testing.assert_array_equal(rows.doubles()[:, 0], np.array(doubles))
        assert rows.as_mpf([2, 0], 181)[:, 0].tolist() == [wanted[2], wanted[0]]


def test_a_file_tells_which_rows_are_numbers(tmp_path: Path) -> None:
    """The rows that are not finite are known without forming the others; a part is a file again."""
    columns = columns_of("euler/with-attitude")
    lost(columns)
    file = read(write_csv(tmp_path / "run.csv", columns))
    assert np.flatnonzero(~file.finite).tolist() == [33]
    few = file.at([3, 5])
    assert few.times == (Fraction(repr(columns["t"][3])), Fraction(repr(columns["t"][5])))
    assert few.groups["omega"][1][0] == Fraction(repr(columns["w1"][5]))
    assert few.groups["omega"].doubles()[0, 2] == columns["w3"][3]


MEMORY = """
import resource, sys
from taylor_verify import check
found = check("euler/generic", sys.argv[1])
assert found.verdicts[1].max is not None
print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * (1 if sys.platform == "darwin" else 1024))
"""
# The rational of a time takes 130 bytes and the text of a row 70; errors, floors and their copies of three
# gates some 40 doubles. What begins anew as it grows, a list or a sum of arrays, takes as much again.
BYTES_A_ROW = 1000


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no getrusage")
def test_a_row_takes_a_kilobyte(tmp_path: Path) -> None:
    """Each of 30 000 further rows takes a kilobyte at most; in mpmath's numbers they took seven."""
    taken = []
    for rows in (10_000, 40_000):
        path = tmp_path / f"{rows}.csv"
        step = 100 / rows
        lines = [f"{k * step!r},1.0,0.4,0.30000000000000004" for k in range(rows)]
        path.write_text("t,w1,w2,w3\n" + "\n".join(lines) + "\n")
        ran = subprocess.run(
            [sys.executable, "-c", MEMORY, str(path)], capture_output=True, text=True, check=True
        )
        taken.append(int(ran.stdout))
    assert (taken[1] - taken[0]) / 30_000 <= BYTES_A_ROW
