"""Stored trajectories: one NPZ file with an array for each scene and type of float.

`numpy.load` reads the file: `file["oblique-f64"]` has shape (runs, samples, columns), and all runs on the
scene engines/oblique in float64. The row of a run in engines.json has its index, ``place``. Columns are
those of an answer: omega or the impulses, the quaternion, and the centre if the scene tracks it. The bytes
of the file depend only on the numbers.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from io import BytesIO
from pathlib import Path
from typing import Any
from zipfile import BadZipFile

import numpy as np

from taylor_verify.records.json_text import DOCUMENT
from taylor_verify.records.regular_file import bounded_bytes
from taylor_verify_reports.studies.engines.answer import Answer
from taylor_verify_reports.studies.engines.document import NOT_STORED, EngineRow
from taylor_verify_reports.studies.engines.entry import BOARDS
from taylor_verify_reports.studies.engines.replay import States
from taylor_verify_reports.studies.engines.stored import places


def packed(answers: Iterable[Answer]) -> tuple[list[EngineRow], bytes]:
    """Return the rows of answers with the places of their trajectories, and the file of trajectories.

    The file has the trajectories of the newest version of each engine, the first in its rows.
    """
    rows, arrays, newest = [], dict[str, list[States]](), dict[str, str]()
    for answer in answers:
        place = NOT_STORED
        is_newest = newest.setdefault(answer.row.engine, answer.row.version) == answer.row.version
        if answer.states is not None and is_newest:
            stored = arrays.setdefault(answer.row.array, [])
            place = len(stored)
            stored.append(answer.states)
        rows.append(replace(answer.row, place=place))
    file = BytesIO()
    # NumPy gives all arrays in the file the same date.
    stacked: dict[str, Any] = {name: np.array(each) for name, each in arrays.items()}
    np.savez_compressed(file, **stacked)
    return rows, file.getvalue()


def load(folder: Path, board: str = BOARDS[0]) -> Mapping[str, States]:
    """Return the arrays of a board that are stored below a report folder, by their names.

    There are none before the board was measured in this checkout: their files are not committed.
    Raises OSError for a file that cannot be read, and ValueError for one that is something else.
    """
    place = folder / places(board).trajectories
    if not place.exists():
        return {}
    try:
        content = BytesIO(bounded_bytes(place, "an NPZ of trajectories", DOCUMENT))
        with np.load(content, allow_pickle=False) as file:
            return {name: file[name] for name in file.files}
    except (BadZipFile, EOFError, AttributeError, ValueError) as error:
        # NumPy takes any other file for a pickle, and refuses to read it.
        expected = "expected an NPZ of trajectories, got another file"
        raise ValueError(f"{expected} @ {place}") from error


def states_of(arrays: Mapping[str, States], row: EngineRow) -> States | None:
    """Return the trajectory (samples, columns) of a row; None for a row without one, or without a file.

    Raises ValueError if the arrays lack it.
    """
    if not row.is_stored or not arrays:
        return None
    array: Sequence[States] = arrays.get(row.array, np.empty(0))  # type: ignore[assignment]
    if not 0 <= row.place < len(array):
        raise ValueError(
            f"expected a trajectory {row.array}[{row.place}], got none @ row {row.key}"
        )
    return array[row.place]
