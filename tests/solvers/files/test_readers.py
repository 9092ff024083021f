"""One motion in files of every format, made by the libraries of the formats, is one motion."""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Mapping
from fractions import Fraction
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest
import scipy.io
from builders import recordings
from builders.lacking import lacking
from builders.recordings import CLOCK, OMEGA, QUATERNION, WRITERS, Columns
from builders.trajectories import columns_at
from builders.worked import DOCS
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from mcap.writer import CompressionType
from rosbags import rosbag1, rosbag2

from taylor_verify.records.faults import Refused
from taylor_verify.scenes.reading.reader import load
from taylor_verify.solvers.files.file import read
from taylor_verify.solvers.files.formats.reading import FORMATS, read_table

SCENE = "euler/with-attitude"
NAMES = ("t", *OMEGA, *QUATERNION)
# Formats whose numbers are decimals, each of which is exact, and no binary ones.
DECIMAL = ("json.mcap",)


@pytest.fixture(scope="module")
def columns() -> Columns:
    """The exact motion of the scene at whole quarters of a second, which a stamp holds exactly."""
    scene = load(SCENE)
    return columns_at(scene, [Fraction(k, 4) for k in (0, 1, 7, 22, 100, 239, 400)])


# The same motion.


DOUBLES = st.floats(-1e300, 1e300)
ROWS = st.lists(st.tuples(*[DOUBLES] * 7), min_size=1, max_size=5)


@pytest.mark.parametrize("name", WRITERS)
@settings(max_examples=5, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(rows=ROWS, step=st.integers(1, 2**20))
def test_every_double_survives_its_format(
    name: str, rows: list[tuple[float, ...]], step: int, tmp_path: Path
) -> None:
    """Any doubles at any times of whole 2^-9 seconds are read as they were written."""
    times = [k * step / 2**9 for k in range(len(rows))]
    written = {"t": times, **dict(zip(NAMES[1:], zip(*rows, strict=True), strict=True))}
    folder = tmp_path / f"{len(list(tmp_path.iterdir()))}"
    folder.mkdir()
    WRITERS[name](folder / name, written)
    table = read(folder / name)
    exact = [[Fraction(repr(v) if name in DECIMAL else v) for v in row] for row in rows]
    assert table.times == tuple(map(Fraction, times))
    assert table.groups["omega"] == tuple(tuple(row[:3]) for row in exact)
    assert table.groups["quaternion"] == tuple(tuple(row[3:]) for row in exact)


def test_every_suffix_has_a_reader_and_is_named(tmp_path: Path) -> None:
    """A file of another kind is refused with the list of all suffixes."""
    (tmp_path / "run.xlsx").write_bytes(b"")
    with pytest.raises(Refused) as refused:
        read(tmp_path / "run.xlsx")
    assert all(suffix in str(refused.value) for suffix in FORMATS)


def test_every_suffix_is_documented() -> None:
    """The page of formats has a row for each suffix, and for no other."""
    page = (DOCS / "formats.md").read_text(encoding="utf-8")
    rows = [line.split("|")[1] for line in page.splitlines() if line.startswith("| `.")]
    assert set(re.findall(r"`(\.\w+)`", " ".join(rows))) == set(FORMATS)


def test_formats_name_what_they_need(tmp_path: Path) -> None:
    """`list` says of every suffix what it is, and of a package that is missing how to install it."""
    assert not any("pip install" in one.sentence for one in FORMATS.values())
    done = lacking(tmp_path, ["h5py", "rosbags"], "-m", "taylor_verify", "list")
    lines = {line.split()[0]: line for line in done.stdout.splitlines() if line.startswith("  .")}
    assert lines[".h5"].endswith("needs h5py: pip install 'taylor-verify[hdf5]'")
    assert lines[".bag"].endswith("needs rosbags: pip install 'taylor-verify[rosbag]'")
    assert "pip install" not in lines[".mcap"]


# Recordings of ROS.


@pytest.mark.parametrize(
    ("suffix", "packed"),
    [
        *(("mcap", packed) for packed in CompressionType),
        *(("bag", packed) for packed in rosbag1.Writer.CompressionFormat),
    ],
)
def test_recordings_are_read_however_they_are_packed(
    suffix: str, packed: Any, columns: Columns, tmp_path: Path
) -> None:
    """Chunks in zstd, lz4, bz2 and as they are hold the same messages."""
    write = {"mcap": recordings.write_mcap, "bag": recordings.write_rosbag1}[suffix]
    write(tmp_path / f"run.{suffix}", columns, compression=packed)
    assert len(read(tmp_path / f"run.{suffix}").times) == len(columns["t"])


def test_folders_of_ros_2_hold_either_storage(columns: Columns, tmp_path: Path) -> None:
    """A folder with MCAP in it, and a file of SQLite by itself, are read as the folder with SQLite."""
    recordings.write_rosbag2(tmp_path / "bag", columns)
    recordings.write_rosbag2(tmp_path / "mcap", columns, rosbag2.StoragePlugin.MCAP)
    whole = read(tmp_path / "bag")
    (database,) = (tmp_path / "bag").glob("*.db3")
    for other in (tmp_path / "mcap", database):
        table = read(other)
        assert (table.times, table.groups) == (whole.times, whole.groups)


@pytest.mark.parametrize("packed", [rosbag2.CompressionMode.FILE, rosbag2.CompressionMode.MESSAGE])
def test_packed_folders_are_refused(
    packed: rosbag2.CompressionMode, columns: Columns, tmp_path: Path
) -> None:
    """A bag that is packed file by file or message by message is refused with the way to unpack it."""
    plugin = rosbag2.StoragePlugin.SQLITE3
    recordings.write_rosbag2(tmp_path / "bag", columns, plugin, packed)
    with pytest.raises(Refused, match=r"expected a rosbag that is not packed.*ros2 bag convert"):
        read(tmp_path / "bag")


def test_a_topic_is_named_behind_the_file(columns: Columns, tmp_path: Path) -> None:
    """Two topics are each read by their name, with or without the slash; none is taken unasked."""
    file = tmp_path / "run.mcap"
    recordings.write_mcap(file, columns, topics=("/imu", "/left/imu"))
    with pytest.raises(Refused, match=r"expected one topic, got /imu .*/left/imu .*FILE#/imu"):
        read(file)
    for name in ("/left/imu", "left/imu"):
        table = read(f"{file}#{name}")
        assert "read from topic /left/imu (sensor_msgs/Imu, 7 messages)" in table.notes[0]
    with pytest.raises(Refused, match=r"expected a topic of the recording .*got `#/right`"):
        read(f"{file}#/right")


@pytest.mark.parametrize(("start", "first"), [(CLOCK, 0), (0, 0), (5, 5)])
def test_stamps_of_a_clock_count_from_the_first(
    start: int, first: int, columns: Columns, tmp_path: Path
) -> None:
    """Stamps after 2001 count from the first message, others are the time of a simulation; it is said."""
    recordings.write_mcap(tmp_path / "run.mcap", columns, start=start)
    table = read(tmp_path / "run.mcap")
    assert table.times[0] == first
    assert any("t counts from" in note for note in table.notes) is (start == CLOCK)


def test_nanoseconds_lose_nothing(tmp_path: Path) -> None:
    """Two stamps of a clock that are a nanosecond apart are 1/10^9 apart, where doubles are one."""
    columns = {name: [0.5, 0.25] for name in NAMES} | {"t": [0.0, 1e-9]}
    recordings.write_mcap(tmp_path / "run.mcap", columns)
    assert read(tmp_path / "run.mcap").times == (0, Fraction(1, 10**9))


def test_topics_without_a_motion_are_refused(tmp_path: Path) -> None:
    """A recording of text is refused with the types of messages that are read."""
    from mcap_ros2.writer import Writer

    with (tmp_path / "run.mcap").open("wb") as stream:
        writer = Writer(stream)
        schema = writer.register_msgdef("std_msgs/msg/String", "string data")
        writer.write_message("/chatter", schema, {"data": "hello"}, log_time=1)
        writer.finish()
    expected = r"expected messages of the types sensor_msgs/Imu, nav_msgs/Odometry, .* got /chatter"
    for name in ("run.mcap", "run.mcap#/chatter"):
        with pytest.raises(Refused, match=expected):
            read(str(tmp_path / name))


def test_the_twist_of_an_odometry_is_of_the_body(tmp_path: Path) -> None:
    """Pose and twist of nav_msgs/Odometry are q, c, w and u, the velocity of the origin."""
    from mcap.writer import Writer

    vector = {"x": 1, "y": 2, "z": 3}
    message = {
        "header": {"stamp": {"sec": 3, "nanosec": 7}, "frame_id": "odom"},
        "child_frame_id": "base_link",
        "pose": {"pose": {"position": vector, "orientation": {**vector, "w": 4}}},
        "twist": {"twist": {"linear": vector, "angular": {"x": 5, "y": 6, "z": 7}}},
    }
    with (tmp_path / "run.mcap").open("wb") as stream:
        writer = Writer(stream)
        writer.start()
        schema = writer.register_schema("nav_msgs/Odometry", "jsonschema", b"{}")
        channel = writer.register_channel("/odom", "json", schema)
        writer.add_message(channel, 1, json.dumps(message).encode(), 1)
        writer.finish()
    table = read_table(tmp_path / "run.mcap")
    numbers = {column.name: str(column.values[0]) for column in table.columns}
    assert numbers["stamp"] == "3.000000007"
    assert [numbers[f"q{i}"] for i in range(4)] == ["4", "1", "2", "3"]
    assert [numbers[f"{c}{i}"] for c in "cuw" for i in (1, 2, 3)] == [*"123", *"123", *"567"]
    assert "frame base_link to odom" in table.notes[0]


# Packages and the command.

PARQUET = "taylor_verify.solvers.files.formats.parquet"
LACKED: Mapping[str, tuple[str, str]] = {
    "run.h5": ("h5py", "hdf5"),
    "run.mcap": ("mcap", "mcap"),
    "ros2.mcap": ("mcap_ros2", "mcap"),
    "run.bag": ("rosbags", "rosbag"),
    "run.parquet": ("pyarrow", "parquet"),
}


@pytest.mark.parametrize("name", LACKED)
def test_a_missing_package_is_named_in_the_message(
    name: str, columns: Columns, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Every format that cannot be read has the command that installs its package in its message."""
    package, extra = LACKED[name]
    WRITERS[name.replace("ros2", "run")](tmp_path / name, columns)
    # The reader of Parquet imports its package at the top.
    for module in [m for m in sys.modules if m.partition(".")[0] == package or m == PARQUET]:
        monkeypatch.delitem(sys.modules, module)
    monkeypatch.setitem(sys.modules, package, None)
    with pytest.raises(Exception, match=rf"pip install 'taylor-verify\[{extra}\]'"):
        read(tmp_path / name)


# Arrays in HDF5, MATLAB and Parquet files: how they are called, and which of them are columns.


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
