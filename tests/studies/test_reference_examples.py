"""The Rust example beside the references: compiled, it meets the reference, and sees what does not."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from collections.abc import Sequence
from functools import cache
from itertools import pairwise
from pathlib import Path

import pytest
from builders import reports

from taylor_verify.scenes.reading.reader import load
from taylor_verify_reports.studies.reference import reference_page as reference_files
from taylor_verify_reports.studies.reference.exact_table import reference

MOMENTS = ("1", "2", "3")


@cache
def folder() -> Path:
    """The exact trajectory of one scene with the examples, as they are published."""
    place = reports.folder()
    return reference_files.write(place, [reference(load("euler/generic"))])[0].parent


def generic() -> Path:
    return folder() / "euler-generic.csv"


@pytest.fixture(scope="module")
def example(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The program, compiled with the standard library alone and with warnings as errors."""
    # Where rustup put it and no shell has been told.
    compiler = shutil.which("rustc") or shutil.which("rustc", path=Path.home() / ".cargo" / "bin")
    if compiler is None:
        pytest.skip("there is no rustc on this machine")
    program = tmp_path_factory.mktemp("rust") / "example"
    command = [compiler, "-O", "-D", "warnings", str(folder() / "example.rs"), "-o", str(program)]
    subprocess.run(command, check=True)
    return program


def run(example: Path, reference: Path, moments: Sequence[str], tolerance: str) -> tuple[int, str]:
    command = [str(example), str(reference), *moments, tolerance]
    ran = subprocess.run(command, capture_output=True, text=True, check=False)
    return ran.returncode, ran.stdout


def errors(printed: str) -> list[float]:
    return [float(number) for number in re.findall(r"error ([0-9.e+-]+|NaN|inf)", printed)]


def test_the_moments_of_the_page_are_those_of_the_scene() -> None:
    """The numbers on the command line are the principal moments that the JSON holds."""
    question = json.loads(generic().with_suffix(".json").read_text(encoding="utf-8"))
    diagonal = tuple(row[k] for k, row in enumerate(question["body"]["inertia"]))
    assert diagonal == MOMENTS
    page = (folder() / "README.md").read_text(encoding="utf-8")
    assert f"./example euler-generic.csv {' '.join(MOMENTS)} 1e-10" in page


def test_the_example_converges_to_the_reference(example: Path) -> None:
    """Status 0 at 1e-10, and each halving before leaves a sixteenth, as a method of order four does.

    The next term of the error is smaller by the step, 1/25 at the longest, so that the ratio is 16 to a
    tenth; and at 1e-10 roundings, 100 rows of 200 steps of some u each, are far below.
    """
    status, printed = run(example, generic(), MOMENTS, "1e-10")
    assert status == 0
    errors_by_step = errors(printed)
    assert len(errors_by_step) >= 3
    assert errors_by_step[-1] <= 1e-10
    assert all(abs(a / b / 16 - 1) <= 0.1 for a, b in pairwise(errors_by_step))


@pytest.mark.parametrize(
    ("moments", "tolerance"),
    [
        # The gyroscopic terms of another body; and less than any rounding leaves.
        (("1", "2", "2.9"), "1e-6"),
        (MOMENTS, "1e-17"),
        (("NaN", "2", "3"), "1e-6"),
    ],
)
def test_the_example_sees_what_is_wrong(
    example: Path, moments: Sequence[str], tolerance: str
) -> None:
    """Another body, a tolerance below roundoff and a NaN all end with status 1, at the shortest step."""
    status, printed = run(example, generic(), moments, tolerance)
    assert status == 1
    assert len(printed.splitlines()) == 8


def test_the_example_asks_for_its_arguments(example: Path) -> None:
    """A wrong call is status 2."""
    assert subprocess.run([str(example)], capture_output=True, check=False).returncode == 2
