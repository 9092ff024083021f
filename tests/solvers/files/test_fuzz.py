"""Damaged files of every format: each is read or refused in sentences, in bounded time and memory.

None of them passes with other numbers than the sound file has: what passes is rows of that file.
"""

from __future__ import annotations

import json
import os
import random
import resource
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any
from unittest.mock import patch

import numpy as np
import pytest
from builders import recordings
from builders.recordings import OMEGA, QUATERNION, WRITERS
from builders.scenes import text_of
from builders.trajectories import Columns, columns_at, write_csv

import taylor_verify
from taylor_verify import load
from taylor_verify.judge.causes.likely import Explained
from taylor_verify.judge.conventions.fits import Conventions
from taylor_verify.judge.conventions.worlds import World
from taylor_verify.judge.files import judgement
from taylor_verify.judge.files.judgement import FileJudgement, judge_file
from taylor_verify.judge.tolerances import tolerances
from taylor_verify.numbers.precision import rung
from taylor_verify.records.faults import Refused
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.files.file import TrajectoryFile, read

SCENE = text_of({"inertia": [1, 2, 3]}, {"omega": [1, "2/5", "3/10"]}, 2, 3, "omega", "attitude")
GROUPS = {"omega": OMEGA, "quaternion": QUATERNION}
TOLERANCE = 1e-9
# What the gates of that tolerance let pass.
NEAR = 10 * TOLERANCE
SECONDS, MEGABYTES = 10, 1000


@cache
def scene() -> Scene:
    with TemporaryDirectory() as folder:
        file = Path(folder, "turning.toml")
        file.write_text(SCENE)
        return load(file)


@cache
def columns() -> Columns:
    """The right answer to the scene, in doubles."""
    return columns_at(scene(), scene().clock.instants)


def write_database(file: Path) -> None:
    recordings.write_rosbag2(file.parent / "bag", columns())
    (file.parent / "bag" / "bag.db3").rename(file)


BESIDE: dict[str, Callable[[Path], object]] = {
    "run.csv": lambda file: write_csv(file, columns()),
    "run.json": lambda file: file.write_text(json.dumps(columns())),
    "run.xml": lambda file: recordings.write_aem(file, recordings.aem(columns())),
    "run.db3": write_database,
}


def sound(folder: Path) -> dict[str, bytes]:
    """The smallest sound file of each format, by its name."""
    for name, write in BESIDE.items():
        write(folder / name)
    for name, writer in WRITERS.items():
        if "." in name:
            writer(folder / name, columns())
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


def inputs(seed: int, count: int, folder: Path) -> Iterator[tuple[Path, frozenset[str]]]:
    """Write and yield damaged files, and the groups of the sound ones; the same for the same seed."""
    chance, files = random.Random(seed), list(sound(folder).items())
    groups = {name: frozenset(read(folder / name).groups) for name, _ in files}
    for number in range(count):
        name, content = files[number % len(files)]
        file = folder / f"damaged-{name}"
        file.write_bytes(damaged(content, chance))
        yield file, groups[name]


def read_all(seed: int, count: int, folder: Path) -> None:
    """Read and judge damaged files, each within the seconds that it may take."""
    for number, (file, groups) in enumerate(inputs(seed, count, folder)):
        began = time.process_time()
        try:
            faults = faults_of(file, groups)
            assert all(fault.startswith(("expected ", "and ")) for fault in faults)
        except BaseException as error:
            raise AssertionError(f"input {number} of seed {seed}, {file}: {error!r}") from error
        assert time.process_time() - began < SECONDS, (number, file)


def faults_of(file: Path, groups: frozenset[str]) -> tuple[str, ...]:
    """The faults for which a file is refused; one that is read passes with right rows only."""
    try:
        damaged = read(file)
        assert damaged.times
        if not are_rows_of_the_answer(damaged, groups):
            assert not judged_alone(damaged, groups).passed
    except Refused as refused:
        return refused.faults
    return ()


def are_rows_of_the_answer(file: TrajectoryFile, groups: frozenset[str]) -> bool:
    """True if all that is to be judged is there, and each row is one of the sound file."""
    if set(file.groups) != groups or file.apart or len(file.times) < 2:
        return False
    nothing = [()] * len(file.times)
    parts = (file.groups.get(name, nothing) for name in GROUPS)
    rows = np.array([row_of(*each) for each in zip(file.times, *parts, strict=True)])
    names = ("t", *(name for group in GROUPS if group in groups for name in GROUPS[group]))
    sound_rows = np.array([columns()[name] for name in names]).T
    with np.errstate(invalid="ignore", over="ignore"):
        distances = np.abs(rows[:, None] - sound_rows).max(axis=2).min(axis=1)
    covers = rows[:, 0].min() <= NEAR and rows[:, 0].max() >= 2 - NEAR
    return bool(covers and (distances <= NEAR).all())


def row_of(t: Any, omega: Sequence[Any], quaternion: Sequence[Any]) -> list[float]:
    """A row in doubles; a quaternion and its opposite are one attitude."""
    sign = -1.0 if quaternion and float(quaternion[0]) < 0 else 1.0
    return [float(t), *map(float, omega), *(sign * float(q) for q in quaternion)]


def judged_alone(file: TrajectoryFile, groups: frozenset[str]) -> FileJudgement:
    """Judge a file; the causes and conventions of a failure, which change no verdict, are left out."""
    known = Conventions((), World(scene()), {})
    searches = {"causes_of_file": lambda *_: Explained(), "conventions": lambda *_: known}
    asked = {"tolerances": tolerances(TOLERANCE, [scene()]), "partial": groups != {*GROUPS}}
    with patch.multiple(judgement, **searches):
        return judge_file(file, scene(), rung("f64"), **asked)


@pytest.mark.slow
def test_the_sound_files_pass(tmp_path: Path) -> None:
    """Files that are damaged next are right: their rows are the answer, and an answer of others fails."""
    for name in sound(tmp_path):
        file = read(tmp_path / name)
        groups = frozenset(file.groups)
        assert are_rows_of_the_answer(file, groups), name
        assert judged_alone(file, groups).passed, name
    (tmp_path / "other.csv").write_text((tmp_path / "run.csv").read_text().replace("0.3,", "0.4,"))
    other = read(tmp_path / "other.csv")
    assert not are_rows_of_the_answer(other, frozenset(GROUPS))
    assert not judged_alone(other, frozenset(GROUPS)).passed


def test_damaged_files_are_read_or_refused(tmp_path: Path) -> None:
    """Two hundred damaged files raise nothing but refusals, and none passes with other rows."""
    read_all(1, 200, tmp_path)


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
