"""Float32 numbers are recognised in every form, and numbers of another origin are not taken for them."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from builders.trajectories import exact_columns, write_csv
from builders.turns import by_turns

import taylor_verify
from taylor_verify.cli import main
from taylor_verify.solvers.files.single_precision import are_single_precision

HINT = "judge them on f32 (--rung f32)"
SCENE = "euler/generic"
RANDOM = np.random.default_rng(7)
# Of all mantissas, and of one decade: there nine digits tell least, and most.
NUMBERS = {
    "wide": RANDOM.uniform(-1, 1, 200) * 10.0 ** RANDOM.integers(-8, 8, 200),
    "tenths": RANDOM.uniform(0.1, 0.12, 200),
    "ones": RANDOM.uniform(0.9, 1.0, 200),
}
FORMS: dict[str, Callable[[Any], object]] = {
    "%.9g": lambda v: f"{float(v):.9g}",
    "%.9e": lambda v: f"{float(v):.9e}",
    "%.17g": lambda v: f"{float(v):.17g}",
    "shortest": str,
    "hexadecimal": lambda v: float(v).hex(),
    "binary": float,
    "double of %.9g": lambda v: float(f"{float(v):.9g}"),
}


def are_float32(written: Sequence[Any]) -> bool:
    """The answer for one column, whose first entry is left out."""
    doubles = np.array([float.fromhex(v) if "0x" in str(v) else float(v) for v in written])
    return are_single_precision([(written, doubles)])


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("numbers", NUMBERS)
def test_float32_numbers_are_recognised(numbers: str, form: str) -> None:
    """Printed with nine digits or more, or as they are; the first row may be the scene's double."""
    single = NUMBERS[numbers].astype(np.float32)
    assert are_float32([0.1, *map(FORMS[form], single)])


@pytest.mark.parametrize("digits", range(1, 18))
@pytest.mark.parametrize("numbers", NUMBERS)
def test_doubles_are_not_taken_for_them(numbers: str, digits: int) -> None:
    """However many digits are printed: few digits tell nothing, many are not those of a float32."""
    assert not are_float32([f"{v:.{digits}g}" for v in NUMBERS[numbers]])
    assert not are_float32([float(f"{v:.{digits}g}") for v in NUMBERS[numbers]])
    assert not are_float32([f"{v:.{digits}f}" for v in NUMBERS[numbers]])


@pytest.mark.parametrize("door", ["csv", "npz", "object"])
def test_every_file_of_float32_has_the_hint(door: str, tmp_path: Path) -> None:
    """A file or a dict of float32 numbers, judged on f64, says on which precision to judge it."""
    columns = {name: values[:12] for name, values in exact_columns(SCENE).items()}
    rows = {name: np.array(values, np.float32) for name, values in columns.items() if name != "t"}
    file: Any = {"t": columns["t"], **rows}
    if door == "csv":
        file = write_csv(tmp_path / "mine.csv", file, FORMS["%.9g"])
    elif door == "npz":
        np.savez(tmp_path / "mine.npz", **file)
        file = tmp_path / "mine.npz"
    judged = taylor_verify.check(SCENE, file)
    assert not judged.passed
    assert any(note.endswith(HINT) for note in judged.notes)
    assert not any(HINT in note for note in taylor_verify.check(SCENE, file, rung="f32").notes)


ENGINE = """
import json, sys
import numpy as np
question = json.load(sys.stdin)
number = float.fromhex
inertia = np.array([list(map(number, row)) for row in question["body"]["inertia"]["hex"]], TYPE)
w = np.array([number(v) for v in question["initial"]["omega"]["hex"]], TYPE)
times = [number(v) for v in question["time"]["times"]["hex"]]
inverse, rows = np.linalg.inv(inertia), [w]
for before, now in zip(times, times[1:]):
    h = TYPE((now - before) / 8)
    for _ in range(8):
        middle = w + h / 2 * (inverse @ np.cross(inertia @ w, w))
        w = w + h * (inverse @ np.cross(inertia @ middle, middle))
    rows.append(w)
columns = {f"w{i + 1}": [FORM(float(row[i])) for row in rows] for i in range(3)}
print(json.dumps({"t": times, **columns}))
"""


@pytest.mark.parametrize(
    ("kind", "form"),
    by_turns(
        [
            ("np.float32", "float"),
            ("np.float32", "lambda v: f'{v:.9g}'"),
            ("np.float64", "lambda v: float(f'{v:.9g}')"),
        ],
        3,
    ),
)
def test_a_program_in_float32_has_the_hint(
    kind: str, form: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A program that fails on f64 is told that its numbers are float32, and only if they are."""
    script, program = tmp_path / "engine.py", tmp_path / "engine"
    script.write_text(ENGINE.replace("TYPE", kind).replace("FORM", f"({form})"), encoding="utf-8")
    program.write_text(f'#!/bin/sh\nexec "{sys.executable}" "{script}"\n', encoding="utf-8")
    program.chmod(0o755)
    assert main(["run", SCENE, "--solver", f"process:{program}"]) == 1
    is_single = kind == "np.float32"
    assert (HINT in " ".join(capsys.readouterr().out.split())) is is_single
