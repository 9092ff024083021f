"""Files of every format that are cut, wrong or larger than they say: each is refused in one sentence."""

from __future__ import annotations

import re
import sqlite3
import struct
import zlib
from collections.abc import Callable, Mapping
from contextlib import closing
from pathlib import Path

import h5py
import numpy as np
import pytest
from builders import recordings
from builders.recordings import OMEGA, QUATERNION, WRITERS
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from mcap.writer import CompressionType
from mcap.writer import Writer as McapWriter
from scipy.io import savemat

from taylor_verify.records.faults import Refused
from taylor_verify.solvers.files.file import read
from taylor_verify.solvers.files.formats import database, mcap, rosbag
from taylor_verify.solvers.files.formats.column import BYTES, COLUMNS, ROWS
from taylor_verify.solvers.files.formats.reading import FORMATS

COLUMNS_WRITTEN = {name: [0.5, 0.25, 0.125] for name in (*OMEGA, *QUATERNION)} | {"t": [0, 1, 2]}
FILES = [name for name in WRITERS if "." in name]
HEADER = b"MATLAB 5.0 MAT-file".ljust(124) + b"\x00\x01IM"


def refusal(file: Path) -> str:
    """The one sentence with which a file is refused."""
    with pytest.raises(Refused) as refused:
        read(file)
    (line,) = refused.value.faults
    assert line.startswith("expected ")
    assert f" @ {file}" in line
    return line


# Any file.


def written(name: str, folder: Path) -> bytes:
    """The content of a sound file."""
    file = folder / f"sound-{name}"
    if not file.exists():
        WRITERS[name](file, COLUMNS_WRITTEN)
    return file.read_bytes()


@pytest.mark.parametrize("name", FILES)
@settings(max_examples=12, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(part=st.floats(0, 1, exclude_max=True))
def test_a_file_that_is_cut_is_refused(name: str, part: float, tmp_path: Path) -> None:
    """The beginning of a file of any length is refused, and never read as a shorter run."""
    file = tmp_path / name
    content = written(name, tmp_path)
    file.write_bytes(content[: int(part * len(content))])
    assert refusal(file)


@pytest.mark.parametrize("suffix", [s for s in FORMATS if s not in (".csv", ".tsv", ".txt")])
@given(content=st.binary(max_size=200))
@settings(max_examples=15, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_anything_else_is_refused(suffix: str, content: bytes, tmp_path: Path) -> None:
    """Bytes that are no file of the format are refused, whatever the library makes of them."""
    file = tmp_path / f"run{suffix}"
    file.write_bytes(content)
    assert refusal(file)


# MATLAB.


def element(code: int, data: bytes) -> bytes:
    return struct.pack("<II", code, len(data)) + data + bytes(-len(data) % 8)


def matrix(kind: int, name: bytes, content: bytes, shape: tuple[int, int] = (1, 1)) -> bytes:
    flags, sizes = struct.pack("<II", kind, 0), struct.pack("<ii", *shape)
    return element(14, element(6, flags) + element(5, sizes) + element(1, name) + content)


def nested_structs(depth: int) -> bytes:
    fields = element(5, struct.pack("<i", 8)) + element(1, b"field".ljust(8, b"\0"))
    inner = matrix(6, b"", element(9, bytes(8)))
    for _ in range(depth):
        inner = matrix(2, b"", fields + inner)
    return inner


def nested_cells(depth: int) -> bytes:
    """Cells in each other, their beginnings first: SciPy's process dies of twenty thousand."""
    inner = matrix(6, b"", element(9, bytes(8)))
    empty = matrix(1, b"x", b"")
    beginnings = [
        struct.pack("<II", 14, len(empty) - 8 + len(inner) + k * len(empty)) + empty[8:]
        for k in range(depth)
    ]
    return b"".join([*reversed(beginnings), inner])


def structs(count: int, names: bytes) -> bytes:
    """So many structs with names of one letter, and no content."""
    fields = element(5, struct.pack("<i", 1)) + element(1, names)
    return matrix(2, b"s", fields, (1, count))


def packed(content: bytes) -> bytes:
    """A compressed array."""
    data = zlib.compress(content)
    return struct.pack("<II", 15, len(data)) + data


def packed_zeros() -> bytes:
    """Gigabytes of zeros in some megabytes of a compressed array."""
    packer = zlib.compressobj()
    parts = [packer.compress(bytes(2**24)) for _ in range(2 * BYTES.most // 2**24)]
    return b"".join([*parts, packer.flush()])


HUGE = matrix(6, b"t", element(9, bytes(8)), (2**30, 2**30))
MATLAB: Mapping[str, tuple[Callable[[], bytes], str]] = {
    "declared": (lambda: HUGE, "8 bytes for the shape (1073741824, 1073741824) of t"),
    "negative": (lambda: matrix(6, b"t", element(9, bytes(8)), (-1, -1)), "the shape (-1, -1)"),
    "announced": (lambda: struct.pack("<II", 14, 2**31), "bytes announced where 0 are left"),
    "structs": (lambda: nested_structs(50), "structs nested more than 4 deep"),
    "cells": (lambda: nested_cells(20_000), "expected a column `t` of times, got none"),
    "packed": (lambda: struct.pack("<II", 15, 9) + zlib.compress(bytes(99))[:9], "ends early"),
    "many": (
        lambda: matrix(6, b"a", element(9, bytes(8))) * (COLUMNS.most + 1),
        f"expected at most {COLUMNS.most} columns",
    ),
    "fields": (lambda: packed(structs(1001, b"a" * 10**6)), "1000 columns, got 1001000000"),
    "nameless": (lambda: packed(structs(2**31 - 1, b"")), "1000 columns, got 2147483647"),
    # Each eight zeros are an element without data.
    "zeros": (lambda: packed(bytes(10**7)), "expected at most 1000 columns, got 1001 @"),
}


@pytest.mark.parametrize("what", MATLAB)
def test_hostile_arrays_of_matlab_are_refused(what: str, tmp_path: Path) -> None:
    """Sizes that are declared, and arrays in each other, are counted before anything is made of them."""
    content, expected = MATLAB[what]
    file = tmp_path / "run.mat"
    file.write_bytes(HEADER + content())
    with pytest.raises(Refused, match=re.escape(expected)):
        read(file)


@pytest.mark.slow
def test_arrays_that_unpack_to_gigabytes_are_refused(tmp_path: Path) -> None:
    """A compressed array is unpacked to the limit and no further."""
    packed = packed_zeros()
    (tmp_path / "run.mat").write_bytes(HEADER + struct.pack("<II", 15, len(packed)) + packed)
    assert f"expected at most {BYTES.most} bytes" in refusal(tmp_path / "run.mat")


def test_objects_in_a_mat_file_are_never_made(tmp_path: Path) -> None:
    """Cells, text and complex numbers are named as no numbers, and nothing of them is read."""
    arrays = {
        "t": np.arange(3.0),
        "c": np.array([{}, 1], dtype=object),
        "s": "x",
        "z": 1j * np.ones(3),
    }
    savemat(tmp_path / "run.mat", {**arrays, **dict.fromkeys(OMEGA, np.zeros(3))})
    (note,) = read(tmp_path / "run.mat").notes
    assert note == "not read, because they hold no real numbers: c, s, z"


def test_objects_of_matlab_are_refused_with_the_way_to_save_them(tmp_path: Path) -> None:
    """A timeseries is no array: the refusal says how to save its numbers."""
    names = b"".join(element(1, name) for name in (b"run", b"MCOS", b"timeseries"))
    content = element(14, element(6, struct.pack("<II", 17, 0)) + names)
    (tmp_path / "run.mat").write_bytes(HEADER + content)
    expected = "got the object `run` of class timeseries .*save the numbers: s.t = run.Time"
    with pytest.raises(Refused, match=expected):
        read(tmp_path / "run.mat")


# HDF5.


def hdf5(file: Path, **datasets: object) -> h5py.File:
    content = h5py.File(file, "w")
    for name in ("t", *OMEGA):
        content[name] = np.arange(3.0)
    return content


def test_declared_sizes_of_hdf5_are_refused(tmp_path: Path) -> None:
    """A dataset of a petabyte that is not there is refused by what it declares."""
    file = tmp_path / "run.h5"
    with h5py.File(file, "w") as content:
        content.create_dataset("t", (10**14,), dtype="f8", chunks=(1000,))
    assert f"expected at most {ROWS.most} rows" in refusal(file)
    with hdf5(file) as content:
        content.create_dataset("q", (3, 10**12), dtype="f8", chunks=(3, 1000))
    assert "columns" in refusal(file)


def test_numbers_of_other_files_are_not_read(tmp_path: Path) -> None:
    """External storage, virtual datasets and links lead out of the file, and are refused or left alone."""
    (tmp_path / "secret").write_bytes(bytes(24))
    file = tmp_path / "run.h5"
    with hdf5(file) as content:
        content.create_dataset("q", (3,), dtype="f8", external=[(str(tmp_path / "secret"), 0, 24)])
    assert "expected numbers in this file, got a reference to another" in refusal(file)
    with hdf5(file) as content:
        layout = h5py.VirtualLayout((3,), dtype="f8")
        layout[:] = h5py.VirtualSource(str(tmp_path / "other.h5"), "x", (3,))
        content.create_virtual_dataset("q", layout)
    assert "expected numbers in this file, got a reference to another" in refusal(file)
    with hdf5(file) as content:
        content["link"] = h5py.ExternalLink(str(tmp_path / "other.h5"), "/x")
        content["soft"] = h5py.SoftLink("/nowhere")
        content["circle"] = content["/"]
    assert read(file).notes == ()


def test_objects_in_hdf5_are_never_made(tmp_path: Path) -> None:
    """Text of any length, references and pickled bytes hold no numbers: they are named and left out."""
    with hdf5(tmp_path / "run.h5") as content:
        content["pickle"] = np.void(b"cos\nsystem\n(S'true'\ntR.")
        content["text"] = ["a", "b", "c"]
        content["refs"] = np.array([content["t"].ref] * 3, dtype=h5py.ref_dtype)
    (note,) = read(tmp_path / "run.h5").notes
    assert note == "not read, because they hold no real numbers: pickle, refs, text"


# MCAP and rosbags.


@pytest.mark.parametrize("compression", [CompressionType.ZSTD, CompressionType.LZ4])
def test_chunks_are_unpacked_to_the_limit(
    compression: CompressionType, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A small file with a chunk that becomes more than a file may have is refused."""
    file = tmp_path / "run.mcap"
    with file.open("wb") as stream:
        writer = McapWriter(stream, compression=compression)
        writer.start()
        channel = writer.register_channel("/zeros", "json", 0)
        writer.add_message(channel, 1, bytes(10**7), 1)
        writer.finish()
    assert file.stat().st_size < 10**5
    assert "expected messages of the types" in refusal(file)
    monkeypatch.setattr(mcap, "BYTES", BYTES._replace(most=10**6))
    assert "expected at most 1000000 bytes" in refusal(file)


def test_chunks_of_a_bag_are_unpacked_to_the_limit(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Chunks of ROS 1 are counted while they are unpacked."""
    from rosbags.rosbag1 import Writer

    file = tmp_path / "run.bag"
    recordings.write_rosbag1(file, COLUMNS_WRITTEN, Writer.CompressionFormat.BZ2)
    monkeypatch.setattr(rosbag, "BYTES", BYTES._replace(most=500))
    assert "expected at most 500 bytes" in refusal(file)


def test_messages_in_other_encodings_are_refused(tmp_path: Path) -> None:
    """A topic of the right type whose messages are protobuf is refused by what they are."""
    with (tmp_path / "run.mcap").open("wb") as stream:
        writer = McapWriter(stream)
        writer.start()
        schema = writer.register_schema("sensor_msgs/Imu", "protobuf", b"")
        channel = writer.register_channel("/imu", "protobuf", schema)
        writer.add_message(channel, 1, b"\x00", 1)
        writer.finish()
    expected = (
        "expected ROS 2 messages (cdr, ros2msg) or JSON, got protobuf with schemas in protobuf"
    )
    assert expected in refusal(tmp_path / "run.mcap")


# Databases of ROS 2.

ENDLESS = "WITH RECURSIVE n(k) AS (SELECT 1 UNION ALL SELECT k + 1 FROM n) SELECT"


@pytest.fixture
def bag(tmp_path: Path) -> Path:
    """A database of ROS 2 that is sound."""
    recordings.write_rosbag2(tmp_path / "bag", COLUMNS_WRITTEN)
    return tmp_path / "bag" / "bag.db3"


def changed(file: Path, *statements: str) -> Path:
    with closing(sqlite3.connect(file, isolation_level=None)) as connection:
        for statement in statements:
            connection.execute(statement)
    return file


def test_what_is_not_asked_of_a_database_is_never_looked_at(bag: Path) -> None:
    """A view without end in place of the definitions costs nothing, because no definition is read."""
    view = f"CREATE VIEW message_definitions AS {ENDLESS} k FROM n"
    assert read(changed(bag, "DROP TABLE message_definitions", view)).times == (0, 1, 2)


@pytest.mark.parametrize(
    "view",
    [
        f"CREATE VIEW messages AS {ENDLESS} k AS id, 1 AS topic_id, k AS timestamp, '' AS data FROM n",
        "CREATE VIRTUAL TABLE messages USING fts4(topic_id, timestamp, data)",
    ],
)
def test_messages_that_are_no_table_are_refused(view: str, bag: Path) -> None:
    """A view or a virtual table in place of the messages is refused before it is asked anything."""
    line = refusal(changed(bag, "DROP TABLE messages", view))
    assert "expected the tables topics and messages, got no messages" in line


def test_a_question_to_a_database_ends(bag: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """SQLite stops at a limit of steps, and at Ctrl-C, which its own loop does not see."""
    monkeypatch.setattr(database, "_STEPS_AT_ONCE", 1)
    monkeypatch.setattr(database, "_STEPS", database._STEPS._replace(most=3))
    assert "expected at most 3 million steps of SQLite, got more" in refusal(bag)
    monkeypatch.setattr(database.Database, "_goes_on", lambda database: 1 / 0)
    with pytest.raises(KeyboardInterrupt):
        read(bag)


def test_long_metadata_are_refused(bag: Path) -> None:
    """The metadata of a folder are no larger than a thousand topics make them."""
    with (bag.parent / "metadata.yaml").open("a") as file:
        file.write("# nothing\n" * 500_000)
    assert "expected at most 4194304 bytes" in refusal(bag.parent)
