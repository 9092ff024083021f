"""Columns in objects of Python: tables, data sets, arrays by name, SciPy's results.

An object is recognised by its attributes, so that no library is imported for it. Arrays of vectors become a
column for each component: ``omega`` (n, 3) is ``w1 w2 w3``, another name ``gyro`` is ``gyro[0] gyro[1]
gyro[2]``. Numbers are taken exactly, as the doubles, floats, long doubles or mpfs that they are.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Final

import numpy as np
from mpmath import isfinite, mpf

from taylor_verify.numbers.precision import exact_value
from taylor_verify.records.faults import Faults, Refused, brief, cut
from taylor_verify.records.quantities import COLUMNS, TRACKED, state_groups
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.files.columns.assigned import Request
from taylor_verify.solvers.files.columns.forms import FORMS
from taylor_verify.solvers.files.file import TrajectoryFile, from_columns
from taylor_verify.solvers.files.formats.column import Column, check_size
from taylor_verify.solvers.files.own_states import own_columns
from taylor_verify.solvers.files.rotation_objects import bare, groups_of, is_rotation
from taylor_verify.solvers.trajectory import Trajectory

# A form of the attitude, in radians or with a unit behind its name: zyx_deg.
FORM_COLUMNS: Final = {
    f"{form.name}{unit}": form.columns
    for form in FORMS.values()
    for unit in ("", *(("_deg", "_rad") if form.angles else ()))
}
_ACCEPTED: Final = (
    "a callable solve(problem), a trajectory file, a Trajectory, a DataFrame, an xarray Dataset, a dict of "
    "arrays or SciPy's OdeResult"
)


def trajectory(answer: Any, scene: Scene, columns: Request = ()) -> TrajectoryFile:
    """Return the trajectory that a Python object holds.

    Parameters
    ----------
    answer
        A Trajectory, DataFrame, Dataset, record array, arrays by name, or SciPy's OdeResult.
    scene
        The scene that it answers: it has the order of the states of an OdeResult.
    columns
        Pairs of a name of ours and the name that the object has for it.

    Returns
    -------
    solvers.files.file.TrajectoryFile
        The trajectory. Its name is the type of the object.

    Raises
    ------
    records.faults.Refused
        For columns that cannot be judged, with every fault.
    ValueError
        For an object of another kind.
    """
    place = f"the {type(answer).__name__}"
    if isinstance(answer, Trajectory):
        answer = {"t": answer.times, **answer.quantities}
    gathered = _Gathered(place, own_columns(scene))
    if hasattr(answer, "data_vars") and hasattr(answer, "dims"):
        gathered.take_data_set(answer)
    elif hasattr(answer, "columns") and hasattr(answer, "__getitem__"):
        gathered.take_table(answer)
    elif getattr(getattr(answer, "y", None), "ndim", 0) == 2 and hasattr(answer, "t"):
        gathered.take_states(answer, scene, in_order=not columns)
    elif names := getattr(getattr(answer, "dtype", None), "names", None):
        for name in names:
            gathered.take(name, answer[name])
    elif isinstance(answer, Mapping):
        gathered.count_rows(answer)
        for name, values in answer.items():
            gathered.take(name, values)
    else:
        got = f"{type(answer).__name__}: {brief(answer)}"
        if is_rotation(answer):
            got = f'a {type(answer).__name__} alone (write {{"t": times, "attitude": rotations}})'
        raise ValueError(f"expected {_ACCEPTED}, got {got}")
    if gathered.faults.lines:
        raise Refused(gathered.faults.lines)
    taken = gathered.columns
    check_size(len(taken), max((len(c.values) for c in taken), default=0), place)
    return from_columns(taken, place, columns, gathered.notes, scene)


class _Gathered:
    """The columns so far, notes about them, and faults of other columns.

    ``own`` are the columns of states of the scene's own.
    """

    def __init__(self, place: str, own: Mapping[str, tuple[str, ...]]) -> None:
        self.place, self.faults = place, Faults()
        self._groups = {**COLUMNS, **FORM_COLUMNS, **own}
        self._rows = 0
        self.columns: list[Column] = []
        self.notes: list[str] = []

    def count_rows(self, values: Mapping[Any, Any]) -> None:
        """Count the times, by which a stack of matrices 3 x 3 x n is known."""
        clock = next((values[name] for name in ("t", "time", "tout") if name in values), ())
        self._rows = len(clock) if hasattr(clock, "__len__") else 0

    def take_states(self, result: Any, scene: Scene, in_order: bool) -> None:
        """Take the states of SciPy's result, as the protocol orders them or as ``y[0] y[1] ...``."""
        count = len(result.y)
        names = self._state_names(count, scene) if in_order else [f"y[{k}]" for k in range(count)]
        for name, values in zip(("t", *names), (result.t, *result.y), strict=False):
            self._add(name, np.asarray(values))

    def _state_names(self, count: int, scene: Scene) -> list[str]:
        """Return the columns of the first groups of a state, so many together; none is a fault."""
        names: list[str] = []
        sizes: list[str] = []
        of_body = state_groups(scene.model, TRACKED[scene.model])
        for group in (*of_body, *(name for name in self._groups if name in scene.states)):
            names += self._groups[group]
            sizes.append(str(len(names)))
            if len(names) == count:
                taken = " ".join(names)
                self.notes.append(f"y[0] ... y[{count - 1}] taken as {taken}, the order of a state")
                return names
        expected = f"{', '.join(sizes)} states ({' '.join(names)})"
        mend = "name them: columns={'w1': 'y[0]', ...}"
        self.faults.add(expected, str(count), f"{self.place}, y", mend)
        return []

    def take_table(self, table: Any) -> None:
        """Take the columns of a table, and its index where that has a name of its own."""
        # The columns of an Arrow table are the arrays themselves.
        names = list(getattr(table, "column_names", table.columns))
        written = [_written(name) for name in names]
        if repeated := sorted({n for n in written if written.count(n) > 1}):
            for name in repeated:
                self.faults.add("every column once", f"`{cut(name)}` again", self.place)
            return
        index = getattr(table, "index", None)
        label = getattr(index, "name", None)
        if label is not None and _written(label) not in written:
            self.take(label, index)
        for name in names:
            self.take(name, table[name])

    def take_data_set(self, data: Any) -> None:
        """Take the variables and coordinates of a data set that are as long as its times."""
        clock = next((n for n in ("t", "time", *data.coords) if n in data.coords), None)
        along = data[clock].dims[0] if clock is not None and data[clock].dims else None
        for name in (*data.coords, *data.data_vars):
            variable = data[name]
            if along not in variable.dims:
                continue
            dims = [dim for dim in variable.dims if dim != along]
            labels = [
                [f".{v}" for v in data.coords[dim].values] if dim in data.coords else []
                for dim in dims
            ]
            unit = str(variable.attrs.get("units", ""))
            values = variable.transpose(along, *dims).values
            self.take(name, values, f" [{unit}]" if unit else "", labels)

    def take(
        self, key: Any, values: Any, unit: str = "", labels: Sequence[Sequence[str]] = ()
    ) -> None:
        """Take a named value: an array of any shape whose rows are the samples, or rotations.

        ``labels`` are the ends of the names of components along each axis, where they are no indices.
        """
        name = _written(key)
        if groups := groups_of(values):
            for group, rows in groups.items():
                self._own(group, rows, f"`{cut(name)}`, a {type(values).__name__},")
            return
        values, stated = bare(values)
        unit = f" [{stated}]" if stated else unit
        array = _array(values)
        if array is None:
            if name in self._groups:
                self._refuse("an array", "rows of different lengths", name)
            self.columns.append(Column(name, [_exact(value) for value in values]))
            return
        array = self._by_rows(array)
        if array.ndim == 1:
            self._add(name + unit, array)
        elif group := self._group(name, array):
            shape = " x ".join(str(size) for size in array.shape)
            self._own(group, _flat(array), f"`{cut(name)}` ({shape})", unit)
        elif array.ndim in (2, 3):
            for index, entries in zip(np.ndindex(array.shape[1:]), _flat(array).T, strict=True):
                ends = [
                    labels[axis][i] if axis < len(labels) and labels[axis] else f"[{i}]"
                    for axis, i in enumerate(index)
                ]
                self._add(f"{name}{''.join(ends)}{unit}", entries)

    def _by_rows(self, array: Any) -> Any:
        """Return an array by rows; Simulink stacks its matrices, 3 x 3 x n and 3 x 1 x n."""
        if array.ndim < 2 or len(array) == self._rows or self._rows not in array.shape:
            return array
        rows = np.moveaxis(array, array.shape.index(self._rows), 0)
        return rows.reshape(len(rows), *(size for size in rows.shape[1:] if size > 1))

    def _group(self, name: str, array: Any) -> str:
        """Return the group that an array is by its name, ours to the letter, and its shape; or empty."""
        if name not in self._groups:
            return ""
        group = "quaternion" if name == "attitude" and array.shape[1:] == (4,) else name
        shapes = ((3, 3), (9,)) if group == "attitude" else ((len(self._groups[group]),),)
        if array.shape[1:] in shapes:
            return group
        expected = " or ".join(str(("n", *shape)).replace("'", "") for shape in shapes)
        self._refuse(f"the shape {expected}", str(array.shape), name)
        return ""

    def _own(self, group: str, rows: Any, subject: str, unit: str = "") -> None:
        names = self._groups[group]
        order = ", scalar first" if group == "quaternion" else ""
        self.notes.append(f"{subject} taken as {' '.join(names)}{order}")
        form, _, stated = group.rpartition("_")
        angles = FORMS[form].angles if form in FORMS and stated in ("deg", "rad") else ()
        for name, values in zip(names, rows.T, strict=True):
            self._add(name + (f" [{stated}]" if name in angles else unit), values)

    def _add(self, name: str, values: Any) -> None:
        if values.dtype.kind == "m":
            name, values = f"{name} [ns]", values.astype("timedelta64[ns]").astype(np.int64)
        self.columns.append(Column(name, [_exact(value) for value in values]))

    def _refuse(self, expected: str, got: str, name: str) -> None:
        self.faults.add(expected, got, f"{self.place}, column {cut(name)}")


def _exact(value: Any) -> Any:
    """Return a number of mpmath as the rational that it is; any other value as it stands."""
    return exact_value(value) if isinstance(value, mpf) and isfinite(value) else value


def _array(values: Any) -> Any:
    """Return the array that a value is; None for rows of different lengths.

    NumPy would make texts of numbers that stand beside a text, and lose the mask of an array.
    """
    if isinstance(values, np.ndarray):
        return values
    try:
        array = np.asarray(values)
    except ValueError:
        return None
    return np.asarray(values, dtype=object) if array.dtype.kind in "US" else array


def _flat(array: Any) -> Any:
    """Return an array of rows of numbers, whatever the shape of a row."""
    return array.reshape(len(array), int(np.prod(array.shape[1:])))


def _written(name: Any) -> str:
    """Return the name of a column in one text; that of several levels has dots between them."""
    return ".".join(filter(None, map(str, name))) if isinstance(name, tuple) else str(name)


def pairs(columns: Mapping[str, str] | None) -> Request:
    """Return the columns that are asked for by name, as pairs of our name and the object's."""
    if columns is not None and not isinstance(columns, Mapping):
        raise ValueError(
            f"expected a dict of our names and the file's, got {brief(columns)} @ columns"
        )
    return tuple((str(ours), _written(theirs)) for ours, theirs in (columns or {}).items())
