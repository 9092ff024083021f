"""One motion in files of every format, made by the libraries of the formats, is one motion."""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Mapping
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest
from builders import recordings
from builders.lacking import lacking
from builders.recordings import CLOCK, OMEGA, QUATERNION, WRITERS, Columns
from builders.trajectories import columns_at, write_csv
from builders.turns import by_turns
from builders.worked import DOCS
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from mcap.writer import CompressionType
from rosbags import rosbag1, rosbag2

import taylor_verify
from taylor_verify.judge.files.judgement import FileJudgement
from taylor_verify.records.faults import Refused
from taylor_verify.records.status import Status
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


def hexadecimal(value: float) -> str:
    return float(value).hex()


def verdict_rows(scene: str, file: Path) -> list[dict[str, Any]]:
    """All of the verdicts but what names the file, the time it took and the machine."""
    judged = taylor_verify.check(scene, file, partial=True)
    assert isinstance(judged, FileJudgement)
    own = ("setting", "seconds", "provenance")
    return [{k: v for k, v in one.row().items() if k not in own} for one in judged.verdicts]


# The same motion.


@pytest.fixture(scope="module")
def of_csv(columns: Columns, tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    """The rows of the motion as CSV, in decimals and with all bits of its doubles."""
    file = tmp_path_factory.mktemp("csv") / "run.csv"
    spelled = {"decimal": repr, "binary": hexadecimal}
    return {
        name: verdict_rows(SCENE, Path(write_csv(file, columns, spell)))
        for name, spell in spelled.items()
    }


@pytest.mark.parametrize("name", WRITERS)
def test_verdicts_are_those_of_the_csv(
    name: str, columns: Columns, of_csv: dict[str, Any], tmp_path: Path
) -> None:
    """A motion in any format gives the rows that it gives as CSV, and passes."""
    WRITERS[name](tmp_path / name, columns)
    rows = verdict_rows(SCENE, tmp_path / name)
    assert rows == of_csv["decimal" if name in DECIMAL else "binary"]
    assert {row["verdict"] for row in rows if row["quantity"] != "complete"} == {"pass"}


@pytest.mark.parametrize("name", by_turns(WRITERS, 5))
def test_a_spoiled_row_is_seen_in_every_format(name: str, columns: Columns, tmp_path: Path) -> None:
    """A twin with one number changed by 1e-9 fails, at the time of that number."""
    spoiled = {key: list(values) for key, values in columns.items()}
    spoiled["w2"][4] += 1e-9
    WRITERS[name](tmp_path / name, spoiled)
    rows = {row["quantity"]: row for row in verdict_rows(SCENE, tmp_path / name)}
    assert (rows["omega"]["verdict"], rows["omega"]["at"]) == (Status.FAIL.value, 25.0)
    assert rows["attitude"]["verdict"] == Status.PASS.value


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


@pytest.mark.parametrize("compression", CompressionType)
def test_mcap_is_read_however_it_is_packed(
    compression: CompressionType, columns: Columns, tmp_path: Path
) -> None:
    """Chunks in zstd, in lz4 and as they are hold the same messages."""
    recordings.write_mcap(tmp_path / "run.mcap", columns, compression=compression)
    assert len(read(tmp_path / "run.mcap").times) == len(columns["t"])


@pytest.mark.parametrize("packed", rosbag1.Writer.CompressionFormat)
def test_bags_of_ros_1_are_read_however_they_are_packed(
    packed: rosbag1.Writer.CompressionFormat, columns: Columns, tmp_path: Path
) -> None:
    """Chunks in bz2 and lz4 hold the same messages."""
    recordings.write_rosbag1(tmp_path / "run.bag", columns, packed)
    assert len(read(tmp_path / "run.bag").times) == len(columns["t"])


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


def test_a_missing_package_is_exit_2(columns: Columns, tmp_path: Path) -> None:
    """Without its package a file is refused by the command in one line, with the command to install it."""
    WRITERS["run.h5"](tmp_path / "run.h5", columns)
    done = lacking(tmp_path, ["h5py"], "-m", "taylor_verify", "check", "run.h5", "--scene", SCENE)
    assert done.returncode == 2, done.stderr
    assert "pip install 'taylor-verify[hdf5]'" in done.stderr
    assert len(done.stderr.splitlines()) == 1


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
