"""Trajectories in memory: tables, data sets, arrays by name and SciPy's results, judged as files are."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from functools import cache
from typing import Any

import numpy as np
import pandas as pd
import pyarrow as pa
import pytest
import xarray as xr
from builders.processes import printed_by
from builders.trajectories import MATRIX, QUATERNION, VECTORS, exact_columns, rows_of
from scipy.optimize import OptimizeResult
from scipy.spatial.transform import Rotation

import taylor_verify
from taylor_verify.records.faults import Refused
from taylor_verify.records.quantities import COLUMNS
from taylor_verify.records.status import Status
from taylor_verify.scenes.reading.reader import load
from taylor_verify.solvers.files.file import TrajectoryFile
from taylor_verify.solvers.files.objects import pairs, trajectory

SCENE = "euler/with-attitude"
WHOLE = "kirchhoff/whole-motion"
OMEGA = VECTORS["omega"]


def made(answer: Any, scene: str = SCENE, **columns: str) -> TrajectoryFile:
    return trajectory(answer, load(scene), pairs(columns))


def arrays(scene: str = SCENE) -> dict[str, Any]:
    return {name: np.array(values) for name, values in exact_columns(scene).items()}


@cache
def plain() -> TrajectoryFile:
    return made(arrays())


def of_vectors() -> dict[str, Any]:
    columns = exact_columns(SCENE)
    return {
        "t": np.array(columns["t"]),
        "omega": rows_of(columns, OMEGA),
        "attitude": rows_of(columns, QUATERNION),
    }


def frame() -> pd.DataFrame:
    return pd.DataFrame(arrays())


def indexed() -> pd.DataFrame:
    names = {"w1": "omega_x", "w2": "omega_y", "w3": "omega_z"}
    return (
        frame()
        .rename(columns=names)
        .set_index(pd.Index(arrays()["t"], name="time"))
        .drop(columns="t")
    )


def levels() -> pd.DataFrame:
    table = frame()
    table.columns = pd.MultiIndex.from_tuples(
        [("t", ""), *(("omega", c) for c in "xyz"), *(("orientation", c) for c in "wxyz")]
    )
    return table


def data_set(letters: bool = True) -> xr.Dataset:
    motion = of_vectors()
    coords: dict[str, Any] = {"time": motion["t"]}
    if letters:
        coords |= {"axis": list("xyz"), "part": list("wxyz")}
    values = {
        "angular_velocity": (("axis", "time"), motion["omega"].T, {"units": "rad/s"}),
        ("orientation" if letters else "quaternion"): (("time", "part"), motion["attitude"]),
        "mass": ((), 3.0),
    }
    return xr.Dataset(values, coords)


def ode_result() -> OptimizeResult:
    motion = of_vectors()
    states = np.concatenate([motion["omega"], motion["attitude"]], axis=1)
    return OptimizeResult(t=motion["t"], y=states.T, success=True)


def with_rotation() -> dict[str, Any]:
    motion = of_vectors()
    return {**motion, "attitude": Rotation.from_quat(np.roll(motion["attitude"], -1, axis=1))}


def arrow() -> Any:
    return pa.table(frame())


def with_states_beside() -> xr.Dataset:
    """A data set that has t and y, as a result of SciPy's has."""
    data = data_set(False).rename(time="t")
    return data.assign(y=(("t", "part"), np.zeros((len(data["t"]), 4))))


def structured() -> Any:
    return frame().to_records(index=False)


@pytest.mark.parametrize(
    "build",
    [
        of_vectors,
        frame,
        indexed,
        levels,
        data_set,
        lambda: data_set(False),
        ode_result,
        structured,
        arrow,
        with_states_beside,
    ],
)
def test_objects_hold_the_same_trajectory(build: Any) -> None:
    """Times and numbers are those of the plain columns, exactly."""
    file = made(build())
    assert (file.times, file.groups) == (plain().times, plain().groups)


def test_a_rotation_is_asked_for_its_scalar() -> None:
    """SciPy's Rotation has its scalar last; the trajectory has it first, and passes."""
    file = made(with_rotation())
    own, right = (
        np.array([[float(v) for v in row] for row in f.groups["quaternion"]])
        for f in (file, plain())
    )
    assert np.abs(np.abs(np.sum(own * right, axis=1)) - 1).max() < 1e-15
    assert "`attitude`, a Rotation, taken as q0 q1 q2 q3, scalar first" in file.notes
    judgement = taylor_verify.check(SCENE, with_rotation())
    assert {v.verdict for v in judgement.verdicts} == {Status.PASS}


@pytest.mark.parametrize("shape", [(-1, 9), (-1, 3, 3)])
def test_matrices_are_attitudes(shape: tuple[int, ...]) -> None:
    """attitude (n, 3, 3) is r11 ... r33; another name in it is read as its brackets are."""
    columns = exact_columns(SCENE, matrix=True)
    matrices = rows_of(columns, MATRIX)
    file = made({"t": columns["t"], "attitude": matrices.reshape(shape)})
    assert file.groups["attitude"][3] == tuple(map(Fraction, matrices[3]))
    if len(shape) == 3:
        other = made({"t": columns["t"], "dcm": matrices.reshape(shape)})
        assert other.groups == file.groups
        asked = made({"t": columns["t"], "A_bn": matrices.reshape(shape)}, attitude="A_bn")
        assert asked.groups == file.groups


def test_all_groups_of_a_solid_in_a_fluid() -> None:
    """Impulses, attitude and centre by our names of groups, and the states of a solver in their order."""
    columns = exact_columns(WHOLE)
    groups = {
        group: rows_of(columns, names) for group, names in VECTORS.items() if group != "omega"
    }
    groups["quaternion"] = rows_of(columns, QUATERNION)
    file = made({"t": columns["t"], **groups}, WHOLE)
    order = ("linear_impulse", "angular_impulse", "quaternion", "centre")
    states = np.concatenate([groups[name] for name in order], axis=1)
    result = made(OptimizeResult(t=np.array(columns["t"]), y=states.T), WHOLE)
    assert result.groups == file.groups
    assert set(file.groups) == set(order)
    assert "y[0] ... y[12] taken as x1 x2 x3 y1" in result.notes[0]


def test_states_of_another_number_are_refused_or_named() -> None:
    """Six states are no state of a rigid body, unless the caller says which are which."""
    motion = of_vectors()
    states = np.concatenate([motion["omega"], motion["omega"]], axis=1).T
    result = OptimizeResult(t=motion["t"], y=states)
    with pytest.raises(Refused, match=r"expected 3, 7 states .*, got 6 @ the OptimizeResult, y"):
        made(result)
    file = made(result, w1="y[3]", w2="y[4]", w3="y[5]")
    assert file.groups == {"omega": plain().groups["omega"]}


def test_judgement_is_that_of_the_file() -> None:
    """`check` judges a DataFrame of usual names with a mapping, and a spoiled one fails."""
    table = frame().rename(columns={"w1": "rate about 1", "w2": "w.2", "w3": "w.3", "t": "time"})
    mapping = {"w1": "rate about 1", "w2": "w.2", "w3": "w.3"}
    judgement = taylor_verify.check(SCENE, table, columns=mapping)
    assert {v.verdict for v in judgement.verdicts} == {Status.PASS}
    assert judgement.file.name == "the DataFrame"
    assert "`time` taken as t" in judgement.notes
    table["w.2"] *= 1 + 1e-9
    assert not taylor_verify.check(SCENE, table, columns=mapping).passed


@pytest.mark.parametrize("scene", [SCENE, pytest.param(WHOLE, marks=pytest.mark.slow)])
def test_our_own_results_are_answers(scene: str) -> None:
    """`check` takes the arrays of `exact`, which pass; the groups of a Trajectory are its own."""
    times = load(scene).times
    motion = taylor_verify.exact(scene, times, 30)
    assert taylor_verify.check(scene, {"t": times, **motion.quantities}).passed
    answer = taylor_verify.solve(scene, "mpmath:odefun?tol=1e-8")
    groups = made(answer, scene).groups
    assert set(groups) == set(answer.quantities)
    for name, rows in groups.items():
        assert [float(x) for row in rows for x in row] == [float(x) for x in answer[name].flat]


def test_floats_are_taken_as_they_are() -> None:
    """A float32 is the number that it is; so are long doubles, integers, fractions and texts."""
    kinds: Mapping[str, Sequence[Any]] = {
        "w1": np.array([0.1], dtype=np.float32),
        "w2": np.array([1], dtype=np.longdouble) / 3,
        "w3": [Fraction(1, 3)],
        "c1": ["0.1"],
        "c2": [7],
        "c3": np.array([2**60], dtype=np.int64),
    }
    file = made({"t": [0], **kinds}, WHOLE)
    third = (np.longdouble(1) / 3).as_integer_ratio()
    assert file.groups["omega"][0] == (
        Fraction(float(np.float32(0.1))), Fraction(*third), Fraction(1, 3)
    )  # fmt: skip
    assert file.groups["centre"][0] == (Fraction(1, 10), 7, 2**60)


def test_what_is_not_read_may_be_anything() -> None:
    """Dates, words, complex numbers, masks and matrices of other names are ignored, and named."""
    odd = {
        "when": np.array(["2024-01-01"] * 2, dtype="datetime64[s]"),
        "who": ["me", "you"],
        "z": [1j, 2j],
        "gap": np.ma.masked_array([0.0, 1.0], [True, False]),
        "ragged": [[1], [1, 2]],
        "mass": 3.0,
    }
    file = made({"t": [0, 1], "omega": [[1, 2, 3], [1, 2, 3]], **odd})
    assert set(file.groups) == {"omega"}
    assert file.notes[-1] == "ignored: `when` `who` `z` `gap` `ragged`"


def test_units_of_a_data_set_are_used() -> None:
    """The attribute `units` is a unit in brackets; differences of time are seconds."""
    data = data_set()
    data["angular_velocity"].attrs["units"] = "deg/s"
    data = data.assign_coords(time=pd.to_timedelta(np.arange(len(data["time"])), unit="ms"))
    file = made(data)
    assert file.times[:2] == (0, Fraction(1, 1000))
    assert any("in degrees per unit of time" in note for note in file.notes)
    data["angular_velocity"].attrs["units"] = "furlong"
    with pytest.raises(Refused, match=r"got `furlong` @ the Dataset, column angular_velocity\.x"):
        made(data)


@pytest.mark.parametrize(
    ("answer", "fault"),
    [
        ({"t": [0.0], "w1": ["x"], "w2": [0], "w3": [0]}, "got 'x' @ the dict, row 1, column w1"),
        (
            {"t": [0.0, 0.0], "w1": [1, 2], "w2": [1, 2], "w3": [1, 2]},
            "no time twice, got 0 again @ the dict, row 2",
        ),
        (
            {"t": [0.0], "w1": [1, 2], "w2": [1], "w3": [1]},
            "expected 1 values as in t, got 2 @ the dict",
        ),
        (
            {"t": [0.0], "omega": [[1, 2]]},
            r"expected the shape \(n, 3\), got \(1, 2\) @ the dict, column",
        ),
        ({"t": [0.0], "omega": [[1, 2], [1]]}, "expected an array, got rows of different lengths"),
        (
            {"t": np.ma.masked_array([0.0], [True]), "omega": [[1, 2, 3]]},
            "expected a number, got -- @ the dict, row 1, column t",
        ),
        (
            {"t": [0.0], **dict.fromkeys(("w1", "w2", "w3"), np.array(["2024-01-01"], "M8[s]"))},
            r"expected a number, the time since the start \(subtract the first date\), got 2024-01-01",
        ),
        ({"omega": [[1, 2, 3]]}, "expected a column `t` of times, got none @ the dict"),
        (pd.DataFrame([[0, 1, 2]], columns=["t", "w1", "w1"]), "every column once, got `w1` again"),
    ],
)
def test_faults_name_the_object(answer: Any, fault: str) -> None:
    """The place of a fault is the object and its column."""
    with pytest.raises(Refused, match=fault):
        made(answer)


@pytest.mark.parametrize("answer", [7, None, np.zeros((3, 4)), [1, 2], Rotation.identity(3)])
def test_what_is_no_trajectory_is_refused(answer: Any) -> None:
    """A matrix without names, a list and a Rotation alone have no times."""
    with pytest.raises(ValueError, match=r"expected a callable solve\(problem\), a trajectory"):
        taylor_verify.check(SCENE, answer)


def test_no_library_is_imported_for_it() -> None:
    """A dict is judged without pandas, xarray or SciPy in the process."""
    code = (
        "import sys\n"
        "from taylor_verify.scenes.reading.reader import load\n"
        "from taylor_verify.solvers.files.objects import trajectory\n"
        "trajectory({'t': [0], 'omega': [[1, 2, 3]]}, load('euler/generic'))\n"
        "print([n for n in ('pandas', 'xarray', 'scipy') if n in sys.modules])\n"
    )
    assert printed_by(code) == "[]\n"
    assert COLUMNS["omega"] == OMEGA
