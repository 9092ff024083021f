"""A small family to sweep, and the rows that a sweep leaves."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from pyarrow import dataset

from taylor_verify.batch.sweeps.sweep import sweep
from taylor_verify.records.sweep import SweepSummary

# It passes. Of fixed steps the same bodies fail.
SOLVER = "taylor"
FAILING = "geometric:splitting?step=0.05"
TEMPLATE = """
title = "Small"
model = "euler"
[sweep]
seed = 5
[sweep.numbers]
g = { grid = [0.5, 1] }
[body]
inertia = [{ uniform = [1, 2] }, 2, 3]
[initial]
omega = [{ formula = "g" }, 1, { uniform = [-1, 1] }]
[time]
end = 1
samples = 3
"""


def rows(folder: Path) -> list[dict[str, Any]]:
    """Return every row of a dataset, in the order of its parts."""
    table: list[dict[str, Any]] = dataset.dataset(folder / "verdicts").to_table().to_pylist()
    return table


def parts(folder: Path) -> dict[str, bytes]:
    """Return the bytes of every part of a dataset, by name."""
    return {file.name: file.read_bytes() for file in sorted((folder / "verdicts").glob("*"))}


def swept(template: str, out: Path, **options: Any) -> SweepSummary:
    """Return the summary of a sweep of ten points in this process, unless options say otherwise."""
    asked: dict[str, Any] = {"count": 10, "solver": SOLVER, "jobs": 1, **options}
    return sweep(template, out=out, **asked)
