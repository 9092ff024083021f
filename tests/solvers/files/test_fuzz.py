"""Damaged files of every format: each is read or refused in sentences, in bounded time and memory."""

from __future__ import annotations

import json
import os
import random
import resource
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from builders import recordings
from builders.recordings import OMEGA, QUATERNION, WRITERS

import taylor_verify
from taylor_verify.records.faults import Refused
from taylor_verify.solvers.files.file import read

COLUMNS = {name: [0.5, 0.25, 0.125] for name in (*OMEGA, *QUATERNION)} | {"t": [0, 1, 2]}
SECONDS, MEGABYTES = 10, 1000


def write_csv(file: Path) -> None:
    rows = zip(*COLUMNS.values(), strict=True)
    file.write_text("\n".join([",".join(COLUMNS), *(",".join(map(str, row)) for row in rows), ""]))


def write_database(file: Path) -> None:
    recordings.write_rosbag2(file.parent / "bag", COLUMNS)
    (file.parent / "bag" / "bag.db3").rename(file)


BESIDE: dict[str, Callable[[Path], object]] = {
    "run.csv": write_csv,
    "run.json": lambda file: file.write_text(json.dumps(COLUMNS)),
    "run.xml": lambda file: recordings.write_aem(file, recordings.aem(COLUMNS)),
    "run.db3": write_database,
}


def sound(folder: Path) -> dict[str, bytes]:
    """The smallest sound file of each format, by its name."""
    for name, write in BESIDE.items():
        write(folder / name)
    for name, writer in WRITERS.items():
        if "." in name:
            writer(folder / name, COLUMNS)
    return {name: (folder / name).read_bytes() for name in (*BESIDE, *WRITERS) if "." in name}


def damaged(content: bytes, chance: random.Random) -> bytes:
    """The content with bits flipped, a number stretched, or a part repeated, moved or cut."""
    changed = bytearray(content)
    for _ in range(chance.choice((1, 1, 2, 5))):
        place = chance.randrange(len(changed))
        length = min(chance.choice((1, 2, 4, 8, 64)), len(changed) - place)
        part = changed[place : place + length]
        match chance.randrange(6):
            case 0 | 1:
                changed[place] ^= 1 << chance.randrange(8)
            case 2:
                changed[place : place + length] = (
                    bytes([chance.choice((0, 0x7F, 0x80, 0xFF))]) * length
                )
            case 3:
                changed[place:place] = part * chance.choice((1, 3, 1000))
            case 4:
                other = chance.randrange(len(changed))
                changed[other : other + length] = part
            case _:
                del changed[place : place + length]
        if not changed:
            return b""
    return bytes(changed)


def inputs(seed: int, count: int, folder: Path) -> Iterator[Path]:
    """Write and yield damaged files, the same for the same seed."""
    chance, files = random.Random(seed), list(sound(folder).items())
    for number in range(count):
        name, content = files[number % len(files)]
        file = folder / f"damaged-{name}"
        file.write_bytes(damaged(content, chance))
        yield file


def read_all(seed: int, count: int, folder: Path) -> None:
    """Read damaged files: each has times or faults in sentences, within the seconds that it may take."""
    for number, file in enumerate(inputs(seed, count, folder)):
        began = time.process_time()
        try:
            assert all(fault.startswith(("expected ", "and ")) for fault in faults_of(file))
        except BaseException as error:
            raise AssertionError(f"input {number} of seed {seed}, {file}: {error!r}") from error
        assert time.process_time() - began < SECONDS, (number, file)


def faults_of(file: Path) -> tuple[str, ...]:
    try:
        assert read(file).times
    except Refused as refused:
        return refused.faults
    return ()


def test_damaged_files_are_read_or_refused(tmp_path: Path) -> None:
    """Five hundred damaged files raise nothing but refusals."""
    read_all(1, 500, tmp_path)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(2, 12))
def test_many_damaged_files_stay_within_their_memory(seed: int, tmp_path: Path) -> None:
    """Twenty thousand of them do, in processes that may not have more than a gigabyte."""
    call = f"import test_fuzz, pathlib; test_fuzz.read_all({seed}, 2000, pathlib.Path({str(tmp_path)!r}))"
    tests, package = Path(__file__).parent, Path(taylor_verify.__file__).parents[1]
    limit = 2**20 * MEGABYTES
    done = subprocess.run(
        [sys.executable, "-c", call],
        env={
            **os.environ,
            "PYTHONPATH": os.pathsep.join(map(str, (package, tests, tests.parents[1]))),
        },
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_DATA, (limit, limit)),
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
