"""Arrays in HDF5, MATLAB and Parquet files: how they are called, and which of them are columns."""

from __future__ import annotations

from pathlib import Path

import h5py
import numpy as np
import pytest
import scipy.io
from builders.recordings import OMEGA

from taylor_verify.records.faults import Refused
from taylor_verify.solvers.files.file import read
from taylor_verify.solvers.files.formats.reading import read_table


def names_of(file: str | Path) -> list[str]:
    return [column.name for column in read_table(file).columns]


def test_groups_and_structs_are_dotted_names(tmp_path: Path) -> None:
    """Arrays in groups and structs are named by them; a part of the file is named without it."""
    omega = np.arange(12.0).reshape(4, 3)
    with h5py.File(tmp_path / "run.h5", "w") as content:
        content["t"] = np.arange(4.0)
        content["imu/omega"] = omega
        content["other/R"] = np.zeros((4, 3, 3))
    scipy.io.savemat(
        tmp_path / "run.mat", {"t": np.arange(4.0), "imu": {"omega": omega, "deep": {"q": omega.T}}}
    )
    omegas = [f"imu.omega[{i}]" for i in range(3)]
    matrix = [f"other.R[{i}][{k}]" for i in range(3) for k in range(3)]
    assert sorted(names_of(tmp_path / "run.h5")) == sorted(["t", *omegas, *matrix])
    deep = [f"imu.deep.q[{i}]" for i in range(3)]
    assert sorted(names_of(tmp_path / "run.mat")) == sorted(["t", *omegas, *deep])
    table = read_table(tmp_path / "run.mat")
    by_name = {column.name: list(column.values) for column in table.columns}
    assert by_name["imu.omega[1]"] == by_name["imu.deep.q[1]"] == [1, 4, 7, 10]


@pytest.mark.parametrize("clock", ["t", "simTime", "n"])
def test_a_matrix_of_few_rows_may_be_wider_than_long(clock: str, tmp_path: Path) -> None:
    """Its rows are those of a vector beside it, whatever that is called."""
    matrix = np.arange(48.0).reshape(4, 12)
    np.savez(tmp_path / "run.npz", simData=matrix, **{clock: np.arange(4.0)})
    by_name = {
        column.name: list(column.values) for column in read_table(tmp_path / "run.npz").columns
    }
    assert by_name == {clock: [0, 1, 2, 3]} | {
        f"simData[{k}]": list(column) for k, column in enumerate(matrix.T)
    }


def test_several_trajectories_in_groups_are_asked_for(tmp_path: Path) -> None:
    """Times in two groups are two trajectories, and one of them has to be named."""
    with h5py.File(tmp_path / "run.h5", "w") as content:
        for group in ("a", "b/c"):
            for name in ("t", *OMEGA):
                content[f"{group}/{name}"] = np.arange(3.0)
    with pytest.raises(Refused, match=r"got times in the groups a, b\.c @ "):
        read(tmp_path / "run.h5")
    for part in ("a", "b/c", "/b.c"):
        assert len(read(f"{tmp_path / 'run.h5'}#{part}").times) == 3
    with pytest.raises(
        Refused, match=r"expected one of the groups in the file \(a, b.c\), got `#d`"
    ):
        read(f"{tmp_path / 'run.h5'}#d")


def test_matlab_7_3_has_its_axes_reversed(tmp_path: Path) -> None:
    """A file of version 7.3 is HDF5 with the axes the other way round; SciPy ships one of MATLAB's."""
    data = Path(scipy.io.matlab.__file__).parent / "tests" / "data" / "testhdf5_7.4_GLNX86.mat"
    with h5py.File(data) as content:
        expected = content["testdouble"][:, 0].tolist()
    table = read_table(data)
    assert [(c.name, list(c.values)) for c in table.columns] == [("testdouble", expected)]
    file = tmp_path / "run.mat"
    with h5py.File(file, "w", userblock_size=512) as content:
        for name, values in {
            "t": np.arange(4.0)[:, None],
            "q": np.arange(16.0).reshape(4, 4).T,
        }.items():
            content[f"log/{name}"] = values
            content[f"log/{name}"].attrs["MATLAB_class"] = np.bytes_("double")
    with file.open("r+b") as stream:
        stream.write(b"MATLAB 7.3 MAT-file".ljust(124) + b"\x00\x02IM")
    by_name = {c.name: list(c.values) for c in read_table(file).columns}
    assert by_name["t"] == [0, 1, 2, 3]
    assert by_name["q[1]"] == [1, 5, 9, 13]
