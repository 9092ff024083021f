"""What is read of a trajectory file: a bounded part of it, in bounded memory, whatever the file claims."""

from __future__ import annotations

import os
import subprocess
import sys
import zipfile
from collections.abc import Callable
from io import BytesIO
from pathlib import Path

import numpy as np
import pyarrow as pa
import pytest
from pyarrow import parquet

import taylor_verify
from taylor_verify.records.faults import Refused
from taylor_verify.solvers.files.file import read
from taylor_verify.solvers.files.formats import content, echo
from taylor_verify.solvers.files.formats.column import BYTES, COLUMNS, KEYS, LINES, ROWS

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
    place = str(Path(taylor_verify.__file__).parents[1])
    ended = subprocess.run(
        [sys.executable, "-c", READ, str(file)],
        env={**os.environ, "PYTHONPATH": place},
        capture_output=True,
        text=True,
        check=True,
    )
    refusal, megabytes = ended.stdout.splitlines()
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
