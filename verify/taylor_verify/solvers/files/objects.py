"""Columns in the objects that Python programs hold: tables, data sets, arrays by name, SciPy's results.

An object is known by what it has, so that no library is imported for it. Arrays of vectors become a
column for each component: ``omega`` (n, 3) is ``w1 w2 w3``, another name ``gyro`` is ``gyro[0] gyro[1]
gyro[2]``. Numbers are taken exactly, as the doubles, floats or long doubles that they are.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import product
from typing import Any, Final

import numpy as np

from taylor_verify.records.quantities import COLUMNS
from taylor_verify.scenes.reading.faults import Faults, Refused, brief, cut
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.files.columns.names import GROUPS
from taylor_verify.solvers.files.columns.request import Request
from taylor_verify.solvers.files.file import TrajectoryFile, from_columns
from taylor_verify.solvers.files.formats.column import Column, check_lengths, check_size

# The states of a solver in their order, model by model: a result has the first so many groups.
_STATES: Final[Mapping[str, tuple[str, ...]]] = {
    "euler": ("omega", "quaternion"),
    "kirchhoff": ("linear_impulse", "angular_impulse", "quaternion", "centre"),
}
_ACCEPTED: Final = (
    "a callable solve(problem), a trajectory file, a DataFrame, an xarray Dataset, a dict of arrays or "
    "SciPy's OdeResult"
)


def trajectory(held: Any, scene: Scene, columns: Request = ()) -> TrajectoryFile:
    """Return the trajectory that a Python object holds.

    Parameters
    ----------
    held
        A DataFrame, a Dataset, a record array, arrays by name, or SciPy's OdeResult.
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
    scenes.faults.Refused
        For columns that cannot be judged, with every fault.
    ValueError
        For an object of another kind.
    """
    place = f"the {type(held).__name__}"
    gathered = _Gathered(place)
    if hasattr(held, "data_vars") and hasattr(held, "dims"):
        gathered.take_data_set(held)
    elif hasattr(held, "columns") and hasattr(held, "__getitem__"):
        gathered.take_table(held)
    elif _is_ode_result(held):
        gathered.take_states(held, scene, in_order=not columns)
    elif getattr(getattr(held, "dtype", None), "names", None):
        for name in held.dtype.names:
            gathered.take(name, held[name])
    elif isinstance(held, Mapping):
        for name, values in held.items():
            gathered.take(name, values)
    else:
        raise ValueError(f"expected {_ACCEPTED}, got {_kind(held)}")
    if gathered.faults.lines:
        raise Refused(gathered.faults.lines)
    taken = gathered.columns
    check_lengths(taken, place)
    check_size(len(taken), max((len(c.values) for c in taken), default=0), place)
    return from_columns(taken, place, columns, gathered.notes)


def _kind(held: Any) -> str:
    if hasattr(held, "as_quat"):
        return f'a {type(held).__name__} alone (write {{"t": times, "attitude": rotations}})'
    return f"{type(held).__name__}: {brief(held)}"


def _is_ode_result(held: Any) -> bool:
    """Return True for what has t, (samples), and y, (states, samples), as attributes."""
    return getattr(getattr(held, "y", None), "ndim", 0) == 2 and hasattr(held, "t")


@dataclass
class _Gathered:
    """The columns so far, sentences about them, and what is wrong with others."""

    place: str
    columns: list[Column] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    faults: Faults = field(default_factory=Faults)

    def take_states(self, result: Any, scene: Scene, in_order: bool) -> None:
        """The states of SciPy's result, as the protocol orders them or as ``y[0] y[1] ...``."""
        names = [f"y[{k}]" for k in range(len(result.y))]
        if in_order:
            names = self._names_of_states(len(result.y), scene)
        for name, values in zip(("t", *names), (result.t, *result.y), strict=True):
            self._add(name, np.asarray(values))

    def _names_of_states(self, count: int, scene: Scene) -> list[str]:
        names: list[str] = []
        for group in _STATES[scene.model]:
            names += COLUMNS[group]
            if len(names) == count:
                taken = " ".join(names)
                self.notes.append(f"y[0] ... y[{count - 1}] taken as {taken}, the order of a state")
                return names
        lengths = [len(COLUMNS[group]) for group in _STATES[scene.model]]
        sizes = [str(sum(lengths[: k + 1])) for k in range(len(lengths))]
        expected = f"{', '.join(sizes)} states ({' '.join(names)})"
        mend = "name them: columns={'w1': 'y[0]', ...}"
        self.faults.add(expected, str(count), f"{self.place}, y", mend)
        return [f"y[{k}]" for k in range(count)]

    def take_table(self, table: Any) -> None:
        """The columns of a table, and its index where that has a name of its own."""
        # The columns of an Arrow table are the arrays themselves.
        names = list(getattr(table, "column_names", table.columns))
        written = [_written(name) for name in names]
        for name in sorted({n for n in written if written.count(n) > 1}):
            self.faults.add("every column once", f"`{cut(name)}` again", self.place)
        if self.faults.lines:
            return
        index = getattr(table, "index", None)
        label = getattr(index, "name", None)
        if label is not None and _written(label) not in written:
            self.take(label, index)
        for name in names:
            self.take(name, table[name])

    def take_data_set(self, data: Any) -> None:
        """The variables and coordinates of a data set, each as long as its times."""
        clock = next((n for n in ("t", "time", *data.coords) if n in data.coords), None)
        along = data[clock].dims[0] if clock is not None and data[clock].dims else None
        for name in (*data.coords, *data.data_vars):
            variable = data[name]
            dims = [dim for dim in variable.dims if dim != along]
            if along not in variable.dims:
                continue
            labels: list[Sequence[str]] = [
                [str(v) for v in data.coords[dim].values] if dim in data.coords else []
                for dim in dims
            ]
            unit = str(variable.attrs.get("units", ""))
            values = variable.transpose(along, *dims).values
            self.take(name, values, f" [{unit}]" if unit else "", labels)

    def take(
        self, key: Any, values: Any, unit: str = "", labels: Sequence[Sequence[str]] = ()
    ) -> None:
        """One named value: an array of any shape whose rows are the samples, or a Rotation."""
        name = _written(key)
        if hasattr(values, "as_quat") and hasattr(values, "as_matrix"):
            # Asked for in the order that SciPy has by default, scalar last.
            rows = np.atleast_2d(values.as_quat())[:, [3, 0, 1, 2]]
            self._own("quaternion", rows, f"`{cut(name)}`, a {type(values).__name__},")
            return
        array = _array(values)
        if array is None and name in COLUMNS:
            self.faults.add("an array", "rows of different lengths", self._at(name))
        if array is None:
            self.columns.append(Column(name, list(values)))
            return
        if array.ndim == 1:
            self._add(name + unit, array)
        elif group := self._group(name, array):
            shape = " x ".join(str(size) for size in array.shape)
            self._own(group, _flat(array), f"`{cut(name)}` ({shape})", unit)
        elif array.ndim in (2, 3):
            places = list(product(*(range(size) for size in array.shape[1:])))
            for index, values in zip(places, _flat(array).T, strict=True):
                label = "".join(_label(i, axis, labels) for axis, i in enumerate(index))
                self._add(name + label + unit, values)

    def _group(self, name: str, array: Any) -> str:
        """The group that an array is by its name, ours to the letter, and its shape; or empty."""
        if name not in COLUMNS:
            return ""
        group = "quaternion" if name == "attitude" and array.shape[1:] == (4,) else name
        shapes = ((3, 3), (9,)) if group == "attitude" else ((len(COLUMNS[group]),),)
        if array.shape[1:] in shapes:
            return group
        expected = " or ".join(str(("n", *shape)).replace("'", "") for shape in shapes)
        self.faults.add(f"the shape {expected}", str(array.shape), self._at(name))
        return ""

    def _own(self, group: str, rows: Any, said: str, unit: str = "") -> None:
        names = GROUPS[group]
        order = ", scalar first" if group == "quaternion" else ""
        self.notes.append(f"{said} taken as {' '.join(names)}{order}")
        for name, values in zip(names, rows.T, strict=True):
            self._add(name + unit, values)

    def _add(self, name: str, values: Any) -> None:
        if values.dtype.kind == "m":
            name, values = f"{name} [ns]", values.astype("timedelta64[ns]").astype(np.int64)
        self.columns.append(Column(name, list(values)))

    def _at(self, name: str) -> str:
        return f"{self.place}, column {cut(name)}"


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


def _label(index: int, axis: int, labels: Sequence[Sequence[str]]) -> str:
    return f".{labels[axis][index]}" if axis < len(labels) and labels[axis] else f"[{index}]"


def _written(name: Any) -> str:
    """The name of a column in one text; that of several levels has dots between them."""
    if isinstance(name, tuple):
        return ".".join(str(part) for part in name if str(part))
    return str(name)


def pairs(columns: Mapping[str, str] | None) -> Request:
    """Return the columns that are asked for by name, as pairs of our name and the object's."""
    return tuple(_each(columns)) if columns else ()


def _each(columns: Mapping[str, str]) -> Iterator[tuple[str, str]]:
    if not isinstance(columns, Mapping):
        raise ValueError(
            f"expected a dict of our names and the file's, got {brief(columns)} @ columns"
        )
    for ours, theirs in columns.items():
        yield str(ours), _written(theirs)


def _flat(array: Any) -> Any:
    """Return an array of rows of numbers, whatever the shape of a row."""
    return array.reshape(len(array), int(np.prod(array.shape[1:])))
