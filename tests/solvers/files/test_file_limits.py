"""What is read of a trajectory file: a bounded part of it, in bounded memory, whatever the file claims."""

from __future__ import annotations

import bz2
import os
import resource
import struct
import sys
import zipfile
from collections.abc import Callable
from io import BytesIO
from pathlib import Path
from unittest.mock import patch

import h5py
import numpy as np
import pyarrow as pa
import pytest
from builders.processes import printed_by
from builders.recordings import IMU
from mcap.writer import CompressionType
from mcap.writer import Writer as McapWriter
from pyarrow import parquet

from taylor_verify.records.faults import Refused
from taylor_verify.records.limit import Limit
from taylor_verify.solvers.files.file import read
from taylor_verify.solvers.files.formats import content, echo, memory
from taylor_verify.solvers.files.formats import parquet as reader
from taylor_verify.solvers.files.formats.column import (
    BYTES,
    CHUNK_BYTES,
    COLUMNS,
    KEYS,
    LINES,
    ROWS,
)
from taylor_verify.solvers.files.formats.messages import MESSAGE_BYTES

NAMES = ("t", "w1", "w2", "w3")
LONG = 3 * ROWS.most
# An interpreter with NumPy and pyarrow takes a hundred megabytes; what is refused is a gigabyte, once read.
MOST_MEGABYTES = 300

READ = """
import sys
from taylor_verify.records.faults import Refused
from taylor_verify.solvers.files.file import read
try:
    read(sys.argv[1])
except Refused as refused:
    print(refused)
# Not getrusage, whose maximum is in part that of the process before its program was started.
(peak,) = [line for line in open("/proc/self/status") if line.startswith("VmHWM")]
print(int(peak.split()[1]) // 1024)
"""


def npy(values: object) -> bytes:
    content = BytesIO()
    np.save(content, np.asarray(values))
    return content.getvalue()


def claiming(shape: tuple[int, ...], data: bytes = bytes(24), descr: str = "<f8") -> bytes:
    """An array whose header says this shape, whatever the data."""
    content = BytesIO()
    header = {"descr": descr, "fortran_order": False, "shape": shape}
    np.lib.format.write_array_header_1_0(content, header)
    return content.getvalue() + data


def archive(file: Path, **members: bytes) -> Path:
    """An NPZ archive of sound columns but for these members."""
    sound = {f"{name}.npy": npy([0.0, 1.0, 2.0]) for name in NAMES}
    changed = {name.replace("__", "."): content for name, content in members.items()}
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as written:
        for name, content in {**sound, **changed}.items():
            written.writestr(name, content)
    return file


def long_csv(file: Path) -> None:
    with file.open("w") as lines:
        lines.write("t,w1,w2,w3\n")
        for start in range(0, LONG, 1000):
            lines.write("".join(f"{t},0,0,0\n" for t in range(start, start + 1000)))


def long_json(file: Path) -> None:
    zeros = "[" + "0, " * (LONG - 1) + "0]"
    file.write_text("{" + ", ".join(f'"{name}": {zeros}' for name in NAMES) + "}")


def long_npz(file: Path) -> None:
    np.savez_compressed(file, **dict.fromkeys(NAMES, np.zeros(5 * LONG)))


def long_parquet(file: Path) -> None:
    zeros = pa.array(np.zeros(5 * LONG))
    parquet.write_table(pa.table(dict.fromkeys(NAMES, zeros)), file)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "write"),
    [
        ("long.csv", long_csv),
        ("long.json", long_json),
        ("long.npz", long_npz),
        ("long.parquet", long_parquet),
    ],
)
def test_too_many_rows_are_refused_in_bounded_memory(
    name: str, write: Callable[[Path], None], tmp_path: Path
) -> None:
    """Millions of rows are refused before they are made numbers, in every format."""
    file = tmp_path / name
    write(file)
    refusal, megabytes = printed_by(READ, str(file)).splitlines()
    assert refusal.startswith(f"expected at most {ROWS.most} rows, got ")
    assert refusal.endswith(f"({ROWS.because})")
    assert int(megabytes) <= MOST_MEGABYTES


def test_every_limit_has_a_reason() -> None:
    """A refusal at a limit says the limit, the reason for it and the place."""
    with pytest.raises(Refused, match=r"at most 1000 columns, got 1001 @ here \(a trajectory has"):
        COLUMNS.check(1001, "here")


def test_a_file_that_is_too_large_is_not_opened(tmp_path: Path) -> None:
    """The size on disk is looked at first; a file with a hole is as large as it says."""
    file = tmp_path / "mine.csv"
    file.touch()
    os.truncate(file, BYTES.most + 1)
    with pytest.raises(Refused, match=f"expected at most {BYTES.most} bytes, got {BYTES.most + 1}"):
        read(file)


@pytest.mark.parametrize(
    ("members", "fault"),
    [
        (
            {"t__npy": claiming((10**12,))},
            "expected 8000000000000 bytes of data as its header says",
        ),
        ({"t__npy": claiming((2,))}, "expected 16 bytes of data as its header says, got 24 @"),
        ({"t__npy": claiming((-3,))}, r"got shape \(-3,\) of float64 @ .* column t"),
        ({"t__npy": claiming((10**9,), b"", "|V0")}, "expected a column `t` of times, got none"),
        (
            {"t__npy": claiming((3,), bytes(3 * 4 * 4001), "<U4001")},
            "characters in a number, got 4001",
        ),
        ({"t__npy": b"no array at all"}, "expected an array in NPY form, got .* @ .* column t"),
        ({"t__npy": b""}, "expected an array in NPY form, got .* @ .* column t"),
        ({"t__npy": b"\x93NUMPY\x01\x00\x10\x00{'descr': '<f8',"}, "expected an array in NPY form"),
        ({"t__npy": b"\x93NUMPY\x09\x00\x02\x00{}"}, r"got 'format version \(9, 0\)'"),
        ({"read__me": b"hello"}, "expected an array in NPY form, got .* @ .* column read.me"),
        ({"t": npy([0.0, 1.0, 2.0])}, "expected every column once, got `t` again"),
    ],
)
def test_members_that_are_no_columns_are_refused(
    members: dict[str, bytes], fault: str, tmp_path: Path
) -> None:
    """A member that is no array, or not as long as it says, is the file's fault and nobody else's."""
    with pytest.raises(Refused, match=fault):
        read(archive(tmp_path / "mine.npz", **members))


def test_a_key_twice_is_refused_in_json(tmp_path: Path) -> None:
    """JSON takes the last of two equal keys in silence; here they are a fault."""
    file = tmp_path / "mine.json"
    file.write_text('{"t": [0], "w1": [0], "w2": [0], "w3": [0], "w1": [1]}')
    with pytest.raises(Refused, match="the key 'w1' twice"):
        read(file)


def test_a_long_text_that_many_rows_repeat_is_refused(tmp_path: Path) -> None:
    """A dictionary holds a text once; a thousand rows of it are not made a thousand texts."""
    file = tmp_path / "mine.parquet"
    text = pa.DictionaryArray.from_arrays(pa.array([0] * 1000, pa.int32()), ["9" * 5000])
    numbers = pa.array(np.arange(1000.0))
    columns = {"t": numbers, "w1": text.cast(pa.string()), "w2": numbers, "w3": numbers}
    parquet.write_table(pa.table(columns), file)
    with pytest.raises(Refused, match="expected at most 4000 characters in a number, got 5000"):
        read(file)


def test_a_line_without_end_is_refused(tmp_path: Path) -> None:
    """A line is read up to a bound, so that a file of one line is no file in memory."""
    file = tmp_path / "mine.csv"
    file.write_text("t,w1,w2,w3\n" + "1" * 2**21 + ",0,0,0\n")
    with pytest.raises(Refused, match=r"characters in a line, got more @ .* line 2"):
        read(file)


def test_numbers_are_counted_before_a_table_is_made_of_them(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A message of ROS is held to a limit while it is read."""
    monkeypatch.setattr(echo, "KEYS", KEYS._replace(most=100))
    file = tmp_path / "mine.txt"
    file.write_text("header:\n  a: 1\nb:\n" + "- 1\n" * 101)
    with pytest.raises(Refused, match="expected at most 100 keys and brackets"):
        read(file)


def test_a_message_that_is_cut_off_is_refused(tmp_path: Path) -> None:
    """ROS prints what is zero: a component that is missing at the end of an echo is none."""
    file = tmp_path / "mine.yaml"
    message = "header:\n  stamp:\n    sec: {}\n    nanosec: 0\nangular_velocity:\n"
    message += "  x: 1.0\n  y: 2.0\n  z: 3.0\n"
    first, last = message.format(1), message.format(2)
    file.write_text(f"{first}---\n{last}---\n")
    assert len(read(file).times) == 2
    file.write_text(f"{first}---\n{last.partition('  z')[0]}")
    with pytest.raises(
        Refused, match=r"whole messages, got one that ends with `y: 2\.0` @ .*line 16"
    ):
        read(file)


@pytest.mark.parametrize("line", ["\n", "# nothing\n", "0,0,0,0\n"])
def test_lines_are_counted_whatever_is_in_them(
    line: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Blank lines and comments count too: nobody waits for a file of nothing else."""
    monkeypatch.setattr(content, "LINES", LINES._replace(most=100))
    file = tmp_path / "mine.csv"
    file.write_text("t,w1,w2,w3\n" + 100 * line)
    with pytest.raises(Refused, match="expected at most 100 lines, got more @"):
        read(file)


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ("{" + ",".join(f'"a{k}": 0' for k in range(KEYS.most)) + "}", "keys and brackets"),
        ("[" + "{}," * KEYS.most + "0]", "keys and brackets"),
        ("{" + ",".join(f'"a{k}": []' for k in range(1001)) + "}", "1000 columns, got 1001"),
    ],
)
def test_keys_and_brackets_of_json_are_counted(text: str, fault: str, tmp_path: Path) -> None:
    """An object takes much more memory than its text, so none is made of more than a bounded number."""
    file = tmp_path / "mine.json"
    file.write_text(text)
    with pytest.raises(Refused, match=f"expected at most .*{fault}"):
        read(file)


@pytest.mark.parametrize("ending", [b"\n", b"\r\n", b"\r"])
def test_line_ends_and_byte_order_marks_are_no_content(ending: bytes, tmp_path: Path) -> None:
    """A file from another system is the same file."""
    file = tmp_path / "mine.csv"
    file.write_bytes(b"\xef\xbb\xbf" + ending.join([b"t,w1,w2,w3", b"0,1,2,3", b"1,1,2,3", b""]))
    assert read(file).times == (0, 1)


@pytest.mark.parametrize("name", ["mine.csv", "mine.npz", "mine.json", "mine.parquet"])
def test_pipes_and_devices_are_never_opened(name: str, tmp_path: Path) -> None:
    """A pipe would block for ever and a device never ends: both are refused by their kind."""
    os.mkfifo(tmp_path / name)
    with pytest.raises(Refused, match="expected a trajectory file, got a FIFO @"):
        read(tmp_path / name)
    device = tmp_path / f"device-{name}"
    device.symlink_to("/dev/zero")
    with pytest.raises(Refused, match="expected a trajectory file, got a device @"):
        read(device)


# Small files that claim or hold a thousand times their size: each is refused before it is unpacked.


LENGTH = 8


def many_members(file: Path) -> None:
    with zipfile.ZipFile(file, "w") as archive:
        for k in range(COLUMNS.most + 1):
            archive.writestr(f"m{k}.npy", b"")


def large_chunk(file: Path) -> None:
    with h5py.File(file, "w") as content:
        content["t"] = np.zeros(LENGTH)
        chunks = (CHUNK_BYTES.most // 8 + 1,)
        content.create_dataset("w1", (LENGTH,), "f8", chunks=chunks, maxshape=(None,))


def packed_twice(file: Path) -> None:
    with h5py.File(file, "w") as content:
        content["t"] = np.zeros(LENGTH)
        packing = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
        packing.set_chunk((LENGTH,))
        packing.set_deflate(9)
        packing.set_filter(h5py.h5z.FILTER_LZF, h5py.h5z.FLAG_OPTIONAL, ())
        space = h5py.h5s.create_simple((LENGTH,))
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
    numbers = pa.array(np.arange(float(LENGTH)))
    columns = dict.fromkeys(("t", "w1", "w2", "w3"), numbers)
    notes = pa.array(["x" * 10**6] + [""] * (LENGTH - 1))
    parquet.write_table(pa.table({**columns, "notes": notes}), file, compression="zstd")
    monkeypatch.setattr(reader, "_TEXT_BYTES", 10**5)
    table = read(file)
    assert table.times == tuple(range(LENGTH))
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
    call = f"import test_file_limits as t; t.refused_by_memory(t.Path({str(file)!r}))"
    printed_by(call, PYTHONPATH=paths)
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
