"""Stored trajectories: one NPZ with an array for each scene and type of float, a block for each run.

`numpy.load` reads it: `file["oblique-f64"]` has shape (runs, samples, columns): those of float64 on the
scene engines/oblique. The row of a run in engines.json has its place there. Columns are those of an
answer: omega or the impulses, the quaternion, the centre where it is tracked. The bytes depend on the
numbers alone.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from io import BytesIO
from pathlib import Path
from typing import Any
from zipfile import BadZipFile

import numpy as np

from taylor_verify.studies.engines.answer import Answer
from taylor_verify.studies.engines.document import EngineRow
from taylor_verify.studies.engines.replay import States
from taylor_verify.studies.engines.stored import TRAJECTORIES


def packed(answers: Iterable[Answer]) -> tuple[list[EngineRow], bytes]:
    """Return the rows of answers with the places of their trajectories, and the file of trajectories."""
    rows, arrays = [], dict[str, list[States]]()
    for answer in answers:
        place = 0
        if answer.states is not None:
            stored = arrays.setdefault(answer.row.array, [])
            place = len(stored)
            stored.append(answer.states)
        rows.append(replace(answer.row, place=place))
    file = BytesIO()
    # numpy gives every member the same date.
    stacked: dict[str, Any] = {name: np.array(each) for name, each in arrays.items()}
    np.savez_compressed(file, **stacked)
    return rows, file.getvalue()


def load(folder: Path) -> Mapping[str, States]:
    """Return the arrays that are stored below a report folder.

    Raises OSError for a file that cannot be read, and ValueError for one that is something else.
    """
    place = folder / TRAJECTORIES
    try:
        with np.load(place, allow_pickle=False) as file:
            return {name: file[name] for name in file.files}
    except (BadZipFile, EOFError, AttributeError, ValueError) as error:
        # numpy takes any other file for a pickle, and refuses it.
        expected = "expected an NPZ of trajectories, got another file"
        raise ValueError(f"{expected} @ {place}") from error


def states_of(arrays: Mapping[str, States], row: EngineRow) -> States | None:
    """Return the trajectory of a row; None for a run without one.

    Raises ValueError where the file lacks it.
    """
    if not row.is_judged:
        return None
    array: Sequence[States] = arrays.get(row.array, np.empty(0))  # type: ignore[assignment]
    if not 0 <= row.place < len(array):
        raise ValueError(
            f"expected a trajectory {row.array}[{row.place}], got none @ {TRAJECTORIES}"
        )
    return array[row.place]
