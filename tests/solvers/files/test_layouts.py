"""Layouts and formats of files as people have them: each is read exactly, or refused with what to write.

`layouts.toml` has the files that are text, one motion in each layout, and a broken twin of most kinds.
"""

from __future__ import annotations

import struct
import tomllib
from collections.abc import Callable, Mapping
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pytest
import scipy.io
from builders.trajectories import columns_at, file_judgement, write_csv
from builders.verdicts import by_quantity
from pyarrow import parquet

from taylor_verify.records.faults import Refused
from taylor_verify.records.status import Status
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.files.columns.assigned import request
from taylor_verify.solvers.files.file import TrajectoryFile, read

LAYOUTS = tomllib.loads((Path(__file__).parent / "layouts.toml").read_text("utf-8"))["layout"]
TIMES = ("0", "1", "2")
OMEGA = (("1", "0.4", "0.3"), ("0.5", "-0.25", "0.125"), ("0.25", "0.5", "-0.75"))
MATRIX = np.array([[t, *w] for t, w in zip(TIMES, OMEGA, strict=True)], dtype=float)
W = MATRIX[:, 1:]


@pytest.fixture(scope="module")
def scene() -> Scene:
    """A scene with samples at whole seconds."""
    return load("euler/generic")


def written(layout: Mapping[str, Any], folder: Path) -> Path:
    file = folder / f"mine{layout.get('suffix', '.csv')}"
    file.write_bytes(layout["text"].removeprefix("\n").encode(layout.get("encoding", "utf-8")))
    return file


def asked(columns: str) -> Any:
    return request([columns] if columns else [])


def exact(rows: Any) -> tuple[tuple[Fraction, ...], ...]:
    return tuple(tuple(map(Fraction, row)) for row in rows)


def part_with(file: TrajectoryFile, group: str) -> TrajectoryFile:
    """The part of a file that has all rows of a group."""
    return next(part for part in (*file.apart, file) if group in part.groups)


@pytest.mark.parametrize("layout", LAYOUTS, ids=lambda layout: layout["name"])
def test_a_layout_is_read_exactly_or_refused(
    layout: Mapping[str, Any], scene: Scene, tmp_path: Path
) -> None:
    """A motion in any layout is the motion that it is, with a note where something was assumed."""
    file, columns = written(layout, tmp_path), asked(layout.get("columns", ""))
    if "refused" in layout:
        with pytest.raises(Refused) as refused:
            read(file, columns, scene)
        assert layout["refused"] in str(refused.value)
        return
    table = read(file, columns, scene)
    assert layout.get("note", "") in " | ".join(table.notes)
    if layout.get("omega", True):
        part = part_with(table, "omega")
        assert part.times == tuple(map(Fraction, layout.get("t", TIMES)))
        assert part.groups["omega"] == exact(OMEGA)
    if "q" in layout:
        part = part_with(table, "quaternion")
        assert part.times == tuple(map(Fraction, layout["q"]))
        first, last = part.groups["quaternion"][0], part.groups["quaternion"][-1]
        assert (first, last) == exact([(1, 0, 0, 0), (0, 1, 0, 0)])


def test_degrees_of_stk_are_radians(scene: Scene, tmp_path: Path) -> None:
    """180 degrees a second in a file of STK are pi, and -90 are -pi/2, to more digits than a double."""
    layout = next(one for one in LAYOUTS if one["name"].startswith("STK's attitudes and angular"))
    first = read(written(layout, tmp_path), (), scene).groups["omega"][0]
    assert [float(w) for w in first] == [np.pi, 0, -np.pi / 2]
    assert first[0] == -2 * first[2] != Fraction(np.pi)


def test_times_of_a_long_scene_are_no_clock(scene: Scene, tmp_path: Path) -> None:
    """Times of 10^9 are those of a clock only where the scene ends before them."""
    file = tmp_path / "mine.csv"
    file.write_text("t,w1,w2,w3\n1000000000,1,2,3\n1000000001,1,2,3\n")
    instants = tuple(k * Fraction(10**8) for k in range(21))
    long = replace(scene, clock=replace(scene.clock, instants=instants))
    assert read(file, (), scene).times == (0, 1)
    assert read(file, (), long).times == (10**9, 10**9 + 1)


@pytest.mark.parametrize("start", [10**12, 10**15, 10**18])
def test_times_that_fit_a_late_scene_as_they_stand_have_no_unit(
    start: int, scene: Scene, tmp_path: Path
) -> None:
    """Times of 10^12 are milliseconds only where they do not reach the scene as they stand."""
    file = tmp_path / "mine.csv"
    late = replace(scene, clock=replace(scene.clock, start=start, instants=(start, start + 10)))
    for first in (start, start + 5, start + 100):
        file.write_text(f"t,w1,w2,w3\n{first},1,2,3\n{first + 1},1,2,3\n")
        table = read(file, (), late)
        assert table.times == (first, first + 1)
        assert not table.notes
    assert 0 < read(file, (), scene).times[1] < 1


def test_lines_of_another_length_hide_no_bad_words(scene: Scene, tmp_path: Path) -> None:
    """A line that is too short or too long, and each word that is no number, are reported together."""
    file = tmp_path / "mine.csv"
    file.write_text("t,w1,w2,w3\n0,1,x,3\n1,1,2\n2,y,2,3,4\n3,1,2,3\n")
    with pytest.raises(Refused) as refused:
        read(file, (), scene)
    got = [line.partition(", got ")[2].split(" @ ")[0] for line in refused.value.faults]
    assert got == ["3", "5", "'y'", "'x'"]


# Binary formats.


def version4(name: str, values: Any, kind: int = 0) -> bytes:
    """A matrix of version 4 of MATLAB: 0 doubles, 20 integers of four bytes, 51 text."""
    form = {0: "<f8", 20: "<i4", 51: "<u1"}[kind]
    array = np.asarray(values, dtype=form)
    header = struct.pack("<5i", kind, *array.shape, 0, len(name) + 1)
    return header + name.encode() + b"\0" + array.tobytes(order="F")


def letters(texts: list[str]) -> list[list[int]]:
    width = max(map(len, texts))
    return [list(text.ljust(width).encode()) for text in texts]


def modelica(file: Path, column: int = 3) -> None:
    """A result of Dymola: w2 is stored with the other sign, and p is a parameter."""
    names = letters(["time", "wx", "wy", "wz", "p"])
    places = [[0, 1, 0, -1], [2, 2, 0, -1], [2, -column, 0, -1], [2, 4, 0, -1], [1, 2, 0, 0]]
    parts = [
        version4("Aclass", letters(["Atrajectory", "1.1", "", "binTrans"]), 51),
        version4("name", np.transpose(names), 51),
        version4("dataInfo", np.transpose(places), 20),
        version4("data_1", [[0, 2], [5, 5]]),
        version4("data_2", (MATRIX * [1, 1, -1, 1]).T),
    ]
    file.write_bytes(b"".join(parts))


def write_parquet(file: Path, **columns: Any) -> None:
    parquet.write_table(pa.table({"t": MATRIX[:, 0], **columns}), file)


def mat(version: str, **arrays: Any) -> Callable[[Path], None]:
    return lambda file: scipy.io.savemat(file, arrays, format=version)


BY_INDEX = "t=simdata[0],w1=simdata[1],w2=simdata[2],w3=simdata[3]"
STAMPS = pa.array([10**9 * t for t in range(1709294400, 1709294403)], pa.timestamp("ns"))
BINARY: Mapping[str, tuple[str, Callable[[Path], None], str]] = {
    "npy": (".npy", lambda file: np.save(file, MATRIX), "t=1,w1=2,w2=3,w3=4"),
    "npy by columns": (
        ".npy",
        lambda file: np.save(file, np.asfortranarray(MATRIX)),
        "t=1,w1=2,w2=3,w3=4",
    ),
    "npz of vectors": (".npz", lambda file: np.savez(file, t=MATRIX[:, 0], omega=W), ""),
    "npz with another array": (
        ".npz",
        lambda file: np.savez(file, t=MATRIX[:, 0], gyro=W, other=np.zeros((2, 5))),
        "",
    ),
    "npz with objects": (
        ".npz",
        lambda file: np.savez(file, t=MATRIX[:, 0], omega=W, o=np.array([{}, 1, 2], object)),
        "",
    ),
    "mat 5 by index": (".mat", mat("5", simdata=MATRIX), BY_INDEX),
    "mat 5 by number": (".mat", mat("5", simdata=MATRIX), "t=1,w1=2,w2=3,w3=4"),
    "mat 4 by index": (".mat", mat("4", simdata=MATRIX), BY_INDEX),
    "mat 4 transposed": (".mat", mat("4", simdata=MATRIX.T), BY_INDEX),
    "mat 4 of names": (".mat", mat("4", t=MATRIX[:, 0], omega=W, note="text"), ""),
    "mat 4 of Modelica": (".mat", modelica, ""),
    "parquet of lists": (".parquet", lambda file: write_parquet(file, omega=W.tolist()), ""),
    "parquet of lists of one size": (
        ".parquet",
        lambda file: write_parquet(file, omega=pa.array(W.tolist(), pa.list_(pa.float64(), 3))),
        "",
    ),
    "parquet with dates and bytes": (
        ".parquet",
        lambda file: parquet.write_table(
            pa.table({"time": STAMPS, "omega": W.tolist(), "raw": [b"1", b"2", b"3"]}), file
        ),
        "",
    ),
}


@pytest.mark.parametrize("name", BINARY)
def test_a_binary_layout_is_read_exactly(name: str, scene: Scene, tmp_path: Path) -> None:
    """Matrices by index or number, vectors and lists are read as the numbers that they are."""
    suffix, write, columns = BINARY[name]
    write(tmp_path / f"mine{suffix}")
    table = read(tmp_path / f"mine{suffix}", asked(columns), scene)
    assert table.times == (0, 1, 2)
    assert table.groups["omega"] == exact(W.tolist())


def signals(values: Any) -> dict[str, Any]:
    """A struct with time, as Simulink's block To Workspace saves it."""
    return {"time": MATRIX[:2, :1], "signals": {"values": values, "label": "w"}, "blockName": "m/w"}


def test_structs_with_time_of_simulink_are_read_together(scene: Scene, tmp_path: Path) -> None:
    """Signals of equal times are one trajectory; matrices are stacked, and the scalar of quat is first."""
    stack = np.moveaxis(np.array([np.eye(3)] * 2), 0, -1)
    parts = {"pqr": signals(W[:2]), "DCM_be": signals(stack)}
    scipy.io.savemat(tmp_path / "run.mat", parts)
    table = read(tmp_path / "run.mat", (), scene)
    assert table.groups["omega"] == exact(W[:2].tolist())
    assert table.groups["attitude"][1] == (1, 0, 0, 0, 1, 0, 0, 0, 1)
    late = signals(stack) | {"time": MATRIX[:2, :1] + 1}
    scipy.io.savemat(tmp_path / "late.mat", parts | {"DCM_be": late})
    with pytest.raises(Refused, match="times in the groups DCM_be, pqr"):
        read(tmp_path / "late.mat", (), scene)


def test_reports_of_42_are_read_together(scene: Scene, tmp_path: Path) -> None:
    """The times, angular velocities and attitudes of a folder are one file, the scalar of q last."""
    quaternions = [[0.5, -0.5, 0.1, 0.7]] * 3
    for name, rows in (("time", MATRIX[:, 0]), ("wbn", W), ("qbn", quaternions)):
        np.savetxt(tmp_path / f"{name}.42", rows, fmt="%g")
    table = read(tmp_path / "wbn.42", (), scene)
    assert table.groups["omega"] == exact(OMEGA)
    assert table.groups["quaternion"][0] == exact([("0.7", "0.5", "-0.5", "0.1")])[0]
    (tmp_path / "time.42").unlink()
    with pytest.raises(Refused, match=r"its times in time\.42 beside it"):
        read(tmp_path / "qbn.42", (), scene)


def test_text_of_octave_is_refused_with_the_way_to_save_numbers(tmp_path: Path) -> None:
    """Octave writes text into a .mat file where nothing is said, and `save -v7` writes what is read."""
    text = "# Created by Octave\n# name: t\n# type: matrix\n# rows: 1\n# columns: 2\n 0 1\n"
    (tmp_path / "run.mat").write_text(text)
    with pytest.raises(Refused, match=r"begins with '# Created ' .*save -v7"):
        read(tmp_path / "run.mat")


def test_a_matrix_of_stk_takes_space_to_body(scene: Scene, tmp_path: Path) -> None:
    """AttitudeTimeDCM has rows from the reference axes to those of the body."""
    rows = "".join(f"{t} 0 1 0 -1 0 0 0 0 1\n" for t in TIMES)
    (tmp_path / "run.a").write_text(f"BEGIN Attitude\nAttitudeTimeDCM\n{rows}END Attitude\n")
    table = read(tmp_path / "run.a", (), scene)
    assert table.groups["attitude"][0] == (0, -1, 0, 1, 0, 0, 0, 0, 1)


TWINS: Mapping[str, tuple[str, Callable[[Path], None], str, str]] = {
    "npy and no request": (".npy", lambda file: np.save(file, MATRIX), "", "--columns t=1,w1=2,"),
    "npy of objects": (
        ".npy",
        lambda file: np.save(file, np.array([{}, 1], object)),
        "",
        "a matrix of numbers",
    ),
    "mat and no request": (
        ".mat",
        mat("5", simdata=MATRIX),
        "",
        "--columns t=simdata[0],w1=simdata[1],",
    ),
    "mat and a wrong index": (
        ".mat",
        mat("5", simdata=MATRIX),
        BY_INDEX.replace("[3]", "[4]"),
        "`simdata[4]`",
    ),
    "mat 4 cut off": (
        ".mat",
        lambda file: file.write_bytes(version4("t", MATRIX)[:-1]) and None,
        "",
        "96 bytes announced where 95 are left",
    ),
    "Modelica beyond its columns": (
        ".mat",
        lambda file: modelica(file, column=5),
        "",
        "a column of data_2",
    ),
    "parquet of lists of two sizes": (
        ".parquet",
        lambda file: write_parquet(file, omega=[[1, 2, 3], [1, 2], [1, 2, 3]]),
        "",
        "lists of one length",
    ),
}


@pytest.mark.parametrize("name", TWINS)
def test_a_broken_binary_layout_is_refused(name: str, scene: Scene, tmp_path: Path) -> None:
    """A matrix that nothing names is refused with the request to write, a broken one with its fault."""
    suffix, write, columns, expected = TWINS[name]
    write(tmp_path / f"mine{suffix}")
    with pytest.raises(Refused) as refused:
        read(tmp_path / f"mine{suffix}", asked(columns), scene)
    assert expected in str(refused.value)


# Two rates, planar motions.


@pytest.mark.parametrize(
    ("spoiled", "failed"), [("", set()), ("w2", {"omega", "T", "H2"}), ("q2", {"attitude"})]
)
def test_each_group_is_judged_on_its_own_rows(
    spoiled: str, failed: set[str], tmp_path: Path
) -> None:
    """Attitudes in every fourth row are judged there and angular velocities in all: each by its own error.

    The spoiled w2 stands in a row without an attitude.
    """
    scene = load("euler/with-attitude")
    columns: dict[str, list[Any]] = dict(columns_at(scene, scene.clock.instants))
    row = {"w2": 7, "q2": 8}.get(spoiled, 0)
    if spoiled:
        columns[spoiled][row] += 1e-6
    for name in (f"q{i}" for i in range(4)):
        columns[name] = [q if k % 4 == 0 else "" for k, q in enumerate(columns[name])]
    text = write_csv(
        tmp_path / "mine.csv", columns, lambda value: repr(value) if value != "" else ""
    )
    rows = by_quantity(file_judgement(text, "euler/with-attitude"))
    states = {name: rows[name].verdict for name in rows}
    assert failed <= {name for name, status in states.items() if status is Status.FAIL}
    assert {"omega", "attitude"} - failed <= {n for n, s in states.items() if s is Status.PASS}
    assert "complete" not in rows


def test_planar_velocities_have_zeros_beside_them(tmp_path: Path) -> None:
    """u v r of a solid in a fluid are surge, sway and yaw rate: heave, roll and pitch rates are 0."""
    file = tmp_path / "mine.csv"
    file.write_text("t,u,v,r,x,y\n0,1,2,3,4,5\n1,1,2,3,4,5\n")
    table = read(file, (), load("kirchhoff/whole-motion"))
    assert table.groups["linear_velocity"][0] == (1, 2, 0)
    assert table.groups["omega"][0] == (0, 0, 3)
    assert table.groups["centre"][0] == (4, 5, 0)
    assert "a planar motion: w p q z are not in the file, and are taken as 0" in table.notes


def test_planar_names_mean_nothing_to_a_rigid_body(scene: Scene, tmp_path: Path) -> None:
    """A rigid body has no velocity of its origin, so u v r alone are no answer of its."""
    file = tmp_path / "mine.csv"
    file.write_text("t,u,v,r\n0,1,2,3\n1,1,2,3\n")
    assert read(file, (), scene).groups == {}


@pytest.mark.parametrize(
    ("omega", "quaternion", "rows"),
    [
        (".........", ".........", (9, 9)),
        (".........", ".n.n.n.n.", (9, 5)),
        (".........", "n.nn.nn.n", (9, 3)),
        (".n..n..n.", "n.nn.nn.n", (6, 3)),
        (".........", "......nnn", (9, 9)),
        (".........", "..n......", (9, 9)),
        (".........", ".nn.nn.nn", (9, 3)),
        (".........", ".n.n.nnnn", (9, 9)),
        ("..n......", "n.nn.nn.n", (9, 9)),
        ("nnnnnnnnn", ".........", (9, 9)),
        # A block, some blocks, and NaN in both are no rate; nor are two rows.
        (".........", "..nnnnn..", (9, 9)),
        (".........", "..nn..nn.", (9, 9)),
        (".n.n.n.n.", ".n.n.n.n.", (9, 9)),
        (".........", ".nnnnnnn.", (9, 9)),
        (".........", ".n.nnnnn.", (9, 9)),
    ],
)
def test_nan_is_an_answer_unless_it_is_the_row_of_another_rate(
    omega: str, quaternion: str, rows: tuple[int, int], tmp_path: Path
) -> None:
    """Rows of a slower group stand alone, at about equal distances; any other NaN is an answer."""
    # As C++ on Windows writes it.
    cells = {".": "1", "n": "-nan(ind)"}
    lines = [
        ",".join([str(k), *[cells[w]] * 3, *[cells[q]] * 4])
        for k, (w, q) in enumerate(zip(omega, quaternion, strict=True))
    ]
    file = tmp_path / "mine.csv"
    file.write_text("\n".join(["t,w1,w2,w3,q0,q1,q2,q3", *lines]))
    table = read(file)
    has = [len(part_with(table, group).times) for group in ("omega", "quaternion")]
    assert tuple(has) == rows
