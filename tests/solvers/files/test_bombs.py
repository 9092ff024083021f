"""Small files that claim or hold a thousand times their size: each is refused before it is unpacked."""

from __future__ import annotations

import bz2
import os
import resource
import struct
import subprocess
import sys
import zipfile
from collections.abc import Callable
from pathlib import Path
from unittest.mock import patch

import h5py
import numpy as np
import pyarrow as pa
import pytest
from builders.recordings import IMU
from mcap.writer import CompressionType
from mcap.writer import Writer as McapWriter
from pyarrow import parquet

from taylor_verify.records.faults import Refused
from taylor_verify.records.limit import Limit
from taylor_verify.solvers.files.file import read
from taylor_verify.solvers.files.formats import memory
from taylor_verify.solvers.files.formats import parquet as reader
from taylor_verify.solvers.files.formats.column import CHUNK_BYTES, COLUMNS
from taylor_verify.solvers.files.formats.messages import MESSAGE_BYTES

ROWS = 8


def many_members(file: Path) -> None:
    with zipfile.ZipFile(file, "w") as archive:
        for k in range(COLUMNS.most + 1):
            archive.writestr(f"m{k}.npy", b"")


def large_chunk(file: Path) -> None:
    with h5py.File(file, "w") as content:
        content["t"] = np.zeros(ROWS)
        chunks = (CHUNK_BYTES.most // 8 + 1,)
        content.create_dataset("w1", (ROWS,), "f8", chunks=chunks, maxshape=(None,))


def packed_twice(file: Path) -> None:
    with h5py.File(file, "w") as content:
        content["t"] = np.zeros(ROWS)
        packing = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
        packing.set_chunk((ROWS,))
        packing.set_deflate(9)
        packing.set_filter(h5py.h5z.FILTER_LZF, h5py.h5z.FLAG_OPTIONAL, ())
        space = h5py.h5s.create_simple((ROWS,))
        h5py.h5d.create(content.id, b"w1", h5py.h5t.NATIVE_DOUBLE, space, packing)


def member_in_bzip2(file: Path) -> None:
    """An archive whose one member claims a thousand bytes and holds ten million."""
    with zipfile.ZipFile(file, "w", zipfile.ZIP_BZIP2) as archive:
        archive.writestr("t.npy", bytes(10**7))
    content = file.read_bytes()
    assert bz2.compress(bytes(10**7)) in content
    file.write_bytes(content.replace(struct.pack("<I", 10**7), struct.pack("<I", 1000)))


def chunk_of_mcap(file: Path) -> None:
    with file.open("wb") as stream:
        writer = McapWriter(stream, 2**40, CompressionType.ZSTD)
        writer.start()
        channel = writer.register_channel("/zeros", "json", 0)
        writer.add_message(channel, 1, bytes(CHUNK_BYTES.most), 1)
        writer.finish()


def one_message(definition: str, data: bytes) -> Callable[[Path], None]:
    """A writer of a file with one message of the type Imu, by a definition of its own."""

    def write(file: Path) -> None:
        with file.open("wb") as stream:
            writer = McapWriter(stream)
            writer.start()
            schema = writer.register_schema("sensor_msgs/msg/Imu", "ros2msg", definition.encode())
            channel = writer.register_channel("/imu", "cdr", schema)
            writer.add_message(channel, 1, data, 1)
            writer.finish()

    return write


# Each file with the fault that is said of it.
BOMBS: dict[str, tuple[str, Callable[[Path], None]]] = {
    "members.npz": ("^expected at most 1000 columns, got more @ [^ ]* .a traj", many_members),
    "chunk.h5": ("bytes in a packed part, got 67108872", large_chunk),
    "twice.h5": (r"numbers that are packed once, got the filters \[1, 32000\]", packed_twice),
    "member.npz": ("a member that is stored or deflated, got method 12", member_in_bzip2),
    "chunk.mcap": ("bytes in a packed part, got 67108865", chunk_of_mcap),
    "message.mcap": (
        "at most 1048576 bytes in a message, got 1048577",
        one_message(IMU, bytes(MESSAGE_BYTES.most + 1)),
    ),
    "nothing.mcap": (
        "got a fault in it: an array of no elements",
        one_message("n/N[] x\n=====\nMSG: n/N\nuint8[0] y\n", b"\x00\x01\x00\x00\xff\xff\xff\xff"),
    ),
}


@pytest.mark.parametrize("name", BOMBS)
def test_a_bomb_is_refused_by_what_it_claims(name: str, tmp_path: Path) -> None:
    """An unpacked part of a file has a limit of its size, whatever the part says."""
    fault, write = BOMBS[name]
    write(tmp_path / name)
    with pytest.raises(Refused, match=fault):
        read(tmp_path / name)


def test_text_that_nobody_asked_for_is_not_read(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A column of text that is longer than any numbers are is left out, and a note says so."""
    file = tmp_path / "mine.parquet"
    numbers = pa.array(np.arange(float(ROWS)))
    columns = dict.fromkeys(("t", "w1", "w2", "w3"), numbers)
    notes = pa.array(["x" * 10**6] + [""] * (ROWS - 1))
    parquet.write_table(pa.table({**columns, "notes": notes}), file, compression="zstd")
    monkeypatch.setattr(reader, "_TEXT_BYTES", 10**5)
    table = read(file)
    assert table.times == tuple(range(ROWS))
    assert "not read, because it is longer than numbers are: column notes" in table.notes


def liar(file: Path) -> None:
    """A text of 32 MB, of which the footer says that it has a hundred bytes."""
    texts = pa.array(["0", "1", "0" * 2**25])
    numbers = dict.fromkeys(("w1", "w2", "w3"), pa.array([1.0, 1.0, 1.0]))
    plain = {"use_dictionary": False, "write_statistics": False}
    parquet.write_table(pa.table({"t": texts, **numbers}), file, compression="brotli", **plain)
    group = parquet.ParquetFile(file).metadata.row_group(0)
    content = file.read_bytes()
    for size in (group.total_byte_size, group.column(0).total_uncompressed_size):
        content = content.replace(number(size), number(100, len(number(size))))
    file.write_bytes(content)


def refused_by_memory(file: Path) -> None:
    """Read the file where 16 MB more than now are allowed, and look at the limits afterwards."""
    before = resource.getrlimit(resource.RLIMIT_DATA)
    limit = Limit(2**24, "bytes of memory", "a reason")
    with (
        patch.object(memory, "MEMORY", limit),
        pytest.raises(Refused, match="expected at most 16777216 bytes of memory, got more @"),
    ):
        read(file)
    assert resource.getrlimit(resource.RLIMIT_DATA) == before


@pytest.mark.skipif(
    sys.platform != "linux", reason="elsewhere the memory of a process has no bound"
)
def test_a_page_that_is_larger_than_the_footer_says_is_refused(tmp_path: Path) -> None:
    """The memory of the reader has a bound, and that of the process none afterwards."""
    # In a process of its own: what others took, and have no more use for, would serve for reading.
    paths = os.pathsep.join([str(Path(__file__).parent), *sys.path])
    file = tmp_path / "liar.parquet"
    liar(file)
    call = (
        "import sys, pathlib, test_bombs; test_bombs.refused_by_memory(pathlib.Path(sys.argv[1]))"
    )
    environment = {**os.environ, "PYTHONPATH": paths}
    subprocess.run([sys.executable, "-c", call, str(file)], env=environment, check=True)
    assert file.stat().st_size < 5000


def number(value: int, length: int = 0) -> bytes:
    """A number in Thrift's compact form, with as many bytes of no value as make this length."""
    doubled, digits = 2 * value, []
    while doubled or len(digits) < length or not digits:
        digits.append(doubled & 0x7F)
        doubled >>= 7
    return bytes([*(digit | 0x80 for digit in digits[:-1]), digits[-1]])


def test_texts_and_numbers_in_dictionaries_are_read(tmp_path: Path) -> None:
    """Arrow's own dictionaries, which pandas makes of categories, hold what any column does."""
    file = tmp_path / "mine.parquet"
    columns = {
        "t": pa.array(["0", "1", "1e1"]).dictionary_encode(),
        "w1": pa.array([1.0, 1.0, 2.0]).dictionary_encode(),
        **dict.fromkeys(("w2", "w3"), pa.array([0.5, 0.5, 0.5])),
    }
    parquet.write_table(pa.table(columns), file)
    table = read(file)
    assert table.times == (0, 1, 10)
    assert [row[0] for row in table.groups["omega"]] == [1, 1, 2]
