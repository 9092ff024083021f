"""CCSDS attitude ephemerides: frames, directions, orders and epochs, as the standard defines them."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from builders import recordings
from builders.recordings import OMEGA, QUATERNION, Columns
from builders.trajectories import columns_at, conjugate
from builders.turns import by_turns

import taylor_verify
from taylor_verify.judge.conventions.meanings import rotations
from taylor_verify.judge.velocities import velocities
from taylor_verify.numbers import rotation
from taylor_verify.records.faults import Refused
from taylor_verify.scenes.reading.reader import load
from taylor_verify.solvers.files.file import read
from taylor_verify.solvers.files.formats import ccsds
from taylor_verify.solvers.files.formats.column import ELEMENTS
from taylor_verify.solvers.files.formats.epochs import seconds

SCENE = "euler/with-attitude"


@pytest.fixture(scope="module")
def columns() -> Columns:
    """The exact motion of the scene at its start and some whole eighths of a second."""
    return columns_at(load(SCENE), [Fraction(k, 8) for k in (0, 1, 9, 30, 77, 300)])


def quaternions(columns: Columns) -> tuple[tuple[Fraction, ...], ...]:
    """The decimals that the writers print."""
    rows = zip(*(columns[name] for name in QUATERNION), strict=True)
    return tuple(tuple(Fraction(repr(value)) for value in row) for row in rows)


# Version 2.


def test_xml_holds_every_digit(columns: Columns, tmp_path: Path) -> None:
    """Quaternions and epochs are read as the decimals that they are, and times from START_TIME."""
    recordings.write_aem(tmp_path / "run.xml", recordings.aem(columns))
    table = read(tmp_path / "run.xml")
    assert table.times == tuple(map(Fraction, columns["t"]))
    assert table.groups["quaternion"] == quaternions(columns)
    assert table.digits == 17
    assert table.notes == (
        "t counts from START_TIME = 2024-03-01T00:00:00.0",
        "EME2000 is taken for the space axes of the scene",
    )


def test_the_attitude_passes_and_its_conjugate_does_not(columns: Columns, tmp_path: Path) -> None:
    """The quaternion from space to the body, as the standard has it, is ours from body to space."""
    for name, turned, status in (("a", columns, "pass"), ("b", conjugate(columns), "fail")):
        file = tmp_path / f"{name}.xml"
        recordings.write_aem(file, recordings.aem(turned))
        judged = taylor_verify.check(SCENE, file, partial=True)
        (attitude,) = [one for one in judged.verdicts if one.quantity == "attitude"]
        assert attitude.verdict.value == status


def test_the_body_may_be_the_first_frame(columns: Columns, tmp_path: Path) -> None:
    """A message whose REF_FRAME_A is the body holds the conjugate."""
    frames = {"ref_frame_a": "SC_BODY", "ref_frame_b": "ICRF"}
    recordings.write_aem(tmp_path / "run.xml", recordings.aem(conjugate(columns), **frames))
    assert read(tmp_path / "run.xml").groups["quaternion"] == quaternions(columns)


@pytest.mark.parametrize("frame", ["SC_BODY_1", "REF_FRAME_B", "EME2000", "REF_FRAME_A"])
def test_angular_velocities_are_turned_into_the_body(
    frame: str, columns: Columns, tmp_path: Path
) -> None:
    """ANGVEL is in degrees a second and in either frame; w1 w2 w3 are what the motion has."""
    stated = columns
    if frame in ("EME2000", "REF_FRAME_A"):
        stated = {**columns, **dict(zip(OMEGA, in_space(columns).T.tolist(), strict=True))}
    message = recordings.with_rates(recordings.aem(columns), stated, frame)
    recordings.write_aem(tmp_path / "run.xml", message)
    omega = np.array(read(tmp_path / "run.xml").groups["omega"], dtype=float)
    expected = np.array([columns[name] for name in OMEGA]).T
    assert np.abs(omega - expected).max() <= 1e-15


def in_space(columns: Columns) -> Any:
    """R w by the matrix of the quaternion."""
    q, omega = (np.array([columns[n] for n in names]).T for names in (QUATERNION, OMEGA))
    return np.einsum("nij,nj->ni", rotations(q), omega)


# Text. The library writes the scalar first in text of version 2, where the standard has it last.

METADATA = {
    "OBJECT_NAME": "TOP",
    "OBJECT_ID": "2024-001A",
    "REF_FRAME_A": "EME2000",
    "REF_FRAME_B": "SC_BODY_1",
    "TIME_SYSTEM": "UTC",
    "START_TIME": "2024-061T00:00:00",
    "STOP_TIME": "2024-061T00:00:10",
    "ATTITUDE_TYPE": "QUATERNION",
}
STATE = "2024-061T00:00:00.25 0.1 0.2 -0.3 0.4"


def text(*states: str, version: str = "2.0", **changed: str | None) -> str:
    """A message in text with these data lines; a keyword that is None is left out."""
    metadata = {name: value for name, value in {**METADATA, **changed}.items() if value}
    lines = [f"CCSDS_AEM_VERS = {version}", "CREATION_DATE = 2024-061T00:00:00", "ORIGINATOR = X"]
    lines += ["META_START", "COMMENT made by hand", *(f"{n} = {v}" for n, v in metadata.items())]
    return "\n".join([*lines, "META_STOP", "", "DATA_START", *(states or (STATE,)), "DATA_STOP\n"])


def written(folder: Path, content: str, name: str = "run.aem") -> Path:
    (folder / name).write_text(content)
    return folder / name


@pytest.mark.parametrize("name", ["run.aem", "run.kvn", "run.txt", "RUN.AEM"])
def test_text_of_version_2_has_the_scalar_last(name: str, tmp_path: Path) -> None:
    """A message in text is known by its first line, and its numbers are Q1 Q2 Q3 QC."""
    table = read(written(tmp_path, text(), name))
    assert table.times == (Fraction(1, 4),)
    assert table.groups["quaternion"] == (
        (Fraction(2, 5), Fraction(1, 10), Fraction(1, 5), Fraction(-3, 10)),
    )


@pytest.mark.parametrize("version", ["9.0", ""])
def test_a_version_that_is_not_known_is_refused(version: str, tmp_path: Path) -> None:
    """The order of the scalar follows from the version."""
    content = text(version=version)
    if not version:
        content = content.partition("\n")[2]
    with pytest.raises(Refused, match=r"version 1 or 2, got 9.0|1.0 or 2.0, got no version"):
        read(written(tmp_path, content))


@pytest.mark.parametrize(("order", "numbers"), [("FIRST", "4 1 2 -3"), ("LAST", "1 2 -3 4")])
@pytest.mark.parametrize(("direction", "sign"), [("A2B", 1), ("B2A", -1)])
def test_version_1_says_order_and_direction(
    order: str, numbers: str, direction: str, sign: int, tmp_path: Path
) -> None:
    """Keywords of version 1 say where the scalar is and what is turned."""
    keywords = {"QUATERNION_TYPE": order, "ATTITUDE_DIR": direction}
    content = text(f"2024-061T00:00:00 {numbers}", version="1.0", **keywords)
    table = read(written(tmp_path, content))
    assert table.groups["quaternion"] == ((4, sign, 2 * sign, -3 * sign),)


@pytest.mark.parametrize(
    ("kind", "numbers", "left"),
    [
        ("QUATERNION/RATE", "0.1 0.2 -0.3 0.4 1 2 3", "X_RATE Y_RATE Z_RATE of QUATERNION/RATE"),
        ("EULER_ANGLE/RATE", "10 20 30 1 2 3", "X_RATE Y_RATE Z_RATE of EULER_ANGLE/RATE"),
        (
            "SPIN/NUTATION",
            "10 20 30 9 1 2 3",
            "SPIN_ANGLE_VEL, NUTATION, NUTATION_PER, NUTATION_PH",
        ),
    ],
)
def test_what_a_type_has_beside_the_attitude_is_said(
    kind: str, numbers: str, left: str, tmp_path: Path
) -> None:
    """Rates that may be of angles, and those of an axis that moves, are left out by their names."""
    states = [f"2024-061T00:00:0{k} {k}{numbers}" for k in (0, 1)]
    order = {"QUATERNION_TYPE": "LAST", "EULER_ROT_SEQ": "123"}
    table = read(written(tmp_path, text(*states, version="1.0", ATTITUDE_TYPE=kind, **order)))
    assert set(table.groups) == {"quaternion"}
    assert any(note.startswith(left) for note in table.notes)


@pytest.mark.parametrize(("kind", "more"), [("SPIN", ""), ("SPIN/NUTATION_MOM", " 1 2 3")])
def test_a_spin_is_a_turn_about_an_axis_that_its_angles_name(
    kind: str, more: str, tmp_path: Path
) -> None:
    """The third axis points to right ascension and declination, and the body turns about it alone."""
    alpha, delta = np.radians([30, -50])
    states = [f"2024-061T00:00:0{t} 30 -50 {10 + 9 * t} 9{more}" for t in (0, 1)]
    table = read(written(tmp_path, text(*states, ATTITUDE_TYPE=kind)))
    first, second = rotations(table.groups["quaternion"].doubles())
    axis = [np.cos(alpha) * np.cos(delta), np.sin(alpha) * np.cos(delta), np.sin(delta)]
    assert np.allclose(first[:, 2], axis, rtol=0, atol=1e-15)
    c, s = np.cos(0.05 * np.pi), np.sin(0.05 * np.pi)
    turn = [[c, -s, 0], [s, c, 0], [0, 0, 1]]
    assert np.allclose(first.T @ second, turn, rtol=0, atol=1e-15)
    assert np.allclose(table.groups["omega"].doubles(), [0, 0, 0.05 * np.pi], rtol=0, atol=1e-15)


@pytest.mark.parametrize(("frame", "sign"), [("SC_BODY_1", 1), ("ICRF", -1)])
def test_rates_of_angles_are_an_angular_velocity(frame: str, sign: int, tmp_path: Path) -> None:
    """ANGLE_1_DOT ... are what the kinematics of yaw, pitch and roll say, from either frame."""
    other = {"SC_BODY_1": "ICRF", "ICRF": "SC_BODY_1"}[frame]
    numbers = np.array([[40, 20, 10], [3, -2, 1]])
    order = numbers if sign == 1 else -numbers[:, ::-1]
    state = " ".join(["2024-061T00:00:00", *map(str, order.ravel())])
    frames = {"REF_FRAME_A": other, "REF_FRAME_B": frame, "EULER_ROT_SEQ": "ZYX"[::sign]}
    content = text(state, ATTITUDE_TYPE="EULER_ANGLE/DERIVATIVE", **frames)
    (omega,) = read(written(tmp_path, content)).groups["omega"].doubles()
    (_, pitch, roll), (psi, theta, phi) = np.radians(numbers)
    p = phi - psi * np.sin(pitch)
    q = theta * np.cos(roll) + psi * np.cos(pitch) * np.sin(roll)
    r = psi * np.cos(pitch) * np.cos(roll) - theta * np.sin(roll)
    assert np.allclose(omega, [p, q, r], rtol=0, atol=1e-15)


ANGLES = "2024-061T00:00:00 90 0 -30"


@pytest.mark.parametrize(("frame", "sign"), [("SC_BODY_1", 1), ("ICRF", -1)])
def test_euler_angles_turn_a_into_b(frame: str, sign: int, tmp_path: Path) -> None:
    """90 degrees about z and then -30 about x are one rotation, and its inverse if the body is A."""
    other = {"SC_BODY_1": "ICRF", "ICRF": "SC_BODY_1"}[frame]
    frames = {"REF_FRAME_A": other, "REF_FRAME_B": frame, "EULER_ROT_SEQ": "ZYX"}
    content = text(ANGLES, ATTITUDE_TYPE="EULER_ANGLE", **frames)
    (q,) = read(written(tmp_path, content)).groups["quaternion"]
    half, quarter = np.sqrt(0.5), np.radians(15)
    about_z, about_x = (half, 0, 0, sign * half), (np.cos(quarter), -sign * np.sin(quarter), 0, 0)
    first, second = (about_z, about_x)[::sign]
    assert np.allclose(np.array(q, float), rotation.product(first, second), rtol=0, atol=1e-15)


ORBIT = """CCSDS_OEM_VERS = 2.0
ORIGINATOR = X
META_START
REF_FRAME = EME2000
TIME_SYSTEM = TAI
START_TIME = 2024-061T00:00:00
META_STOP
2024-061T00:00:00 1 2 3 4 5 6
2024-061T00:00:00.5 1.5 2 3 4 5 6
COVARIANCE_START
EPOCH = 2024-061T00:00:00
1.0
COVARIANCE_STOP
"""


def orbit_in_xml() -> str:
    """The same message in XML."""
    pairs = [line.partition(" = ") for line in ORBIT.splitlines() if " = " in line]
    metadata = "".join(f"<{key}>{value}</{key}>" for key, _, value in pairs[1:])
    rows = [line.split() for line in ORBIT.splitlines() if line.startswith("2024-") and "T" in line]
    names = ("EPOCH", "X", "Y", "Z", "X_DOT", "Y_DOT", "Z_DOT")
    states = [
        "".join(f"<{n}>{cell}</{n}>" for n, cell in zip(names, row, strict=False)) for row in rows
    ]
    data = "".join(f"<stateVector>{state}</stateVector>" for state in states)
    return (
        f"<ndm:oem xmlns:ndm='x'><segment><metadata>{metadata}</metadata>{data}</segment></ndm:oem>"
    )


@pytest.mark.parametrize("suffix", [".oem", ".xml"])
def test_orbit_ephemerides_have_the_centre(suffix: str, tmp_path: Path) -> None:
    """The position of an OEM is c1 c2 c3 in km, from START_TIME; covariances are passed over."""
    content = ORBIT if suffix == ".oem" else orbit_in_xml()
    table = read(written(tmp_path, content, f"run{suffix}"))
    assert (table.times, table.groups["centre"][1]) == ((0, Fraction(1, 2)), (1500, 2000, 3000))


@pytest.mark.parametrize(
    ("change", "to", "fault"),
    [
        ("EME2000", "ITRF-97", "a REF_FRAME that does not turn, got ITRF-97"),
        ("TAI", "SCLK", "a TIME_SYSTEM like UTC, TAI or TT, got SCLK"),
        (" 5 6", " 5", "expected an epoch, X Y Z and X_DOT Y_DOT Z_DOT, got 6 values @ .* line 8"),
        ("META_STOP", "META_END", "expected KEYWORD = value or .*, got 'META_END'"),
        ("START_TIME", "BEGIN", "got no START_TIME"),
    ],
)
def test_faults_of_an_orbit_are_refused(change: str, to: str, fault: str, tmp_path: Path) -> None:
    """A frame that turns, another clock and a state that is cut off are refused."""
    with pytest.raises(Refused, match=fault):
        read(written(tmp_path, ORBIT.replace(change, to), "run.oem"))


@pytest.mark.parametrize("spoiled", by_turns([None, 1, 4], 2), ids=["sound", "place", "velocity"])
def test_velocities_of_an_orbit_are_judged(spoiled: int | None, tmp_path: Path) -> None:
    """The velocity of the origin along space axes is compared with the exact one, and a sign shows."""
    scene = load("kirchhoff/whole-motion")
    columns = columns_at(scene, [Fraction(k, 4) for k in range(6)])
    given = np.array([columns[f"c{k}"] for k in (1, 2, 3)]).T
    motion = taylor_verify.exact(scene.name, [str(t) for t in columns["t"]], digits=25)
    U = velocities(scene.body, {n: motion[n] for n in ("linear_impulse", "angular_impulse")})
    u = np.einsum(
        "nij,nj->ni", np.array(motion["attitude"], float), np.array(U["linear_velocity"], float)
    )
    rows = np.hstack([given, u]) / 1000
    if spoiled is not None:
        rows[:, spoiled] *= -1
    states = [
        " ".join([f"2024-061T00:00:0{t}", *map(repr, row.tolist())])
        for t, row in zip(columns["t"], rows, strict=True)
    ]
    head = ORBIT.partition("META_STOP\n")[0]
    file = written(tmp_path, "\n".join([f"{head}META_STOP", *states, ""]), "run.oem")
    judged = taylor_verify.check(scene.name, file, partial=True)
    failed = {v.quantity for v in judged.verdicts if v.verdict.value == "fail"} - {"initial state"}
    assert {"centre", "velocity"} <= {v.quantity for v in judged.verdicts}
    assert failed == ({"centre"} if spoiled == 1 else {"velocity"} if spoiled else set())


FAULTS: dict[str, tuple[str, str]] = {
    "spin": (
        text(ATTITUDE_TYPE="SPIN", REF_FRAME_A="SC_BODY", REF_FRAME_B="ICRF"),
        "expected SC_BODY as REF_FRAME_B of SPIN, got SC_BODY as REF_FRAME_A",
    ),
    "a huge spin": (
        text("2024-061T00:00:00 1e999999 0 0 0", ATTITUDE_TYPE="SPIN"),
        r"got '1e999999 \+ 90' @ .*row 1, column euler_zxz_1",
    ),
    "a type of nobody": (
        text(ATTITUDE_TYPE="TUMBLE"),
        "expected an ATTITUDE_TYPE of QUATERNION, .*got TUMBLE .*write QUATERN",
    ),
    "a rate": (
        text(f"{STATE} 1 2 3 x", ATTITUDE_TYPE="QUATERNION/DERIVATIVE"),
        "got 0.1 0.2 -0.3 0.4|got 1 2 3 x @ .*state 1",
    ),
    "conjunction": (
        "CCSDS_CDM_VERS = 1.0\n",
        "an attitude ephemeris .CCSDS_AEM_VERS., got CCSDS_C",
    ),
    "angles by axis": (
        text(ANGLES, version="1.0", ATTITUDE_TYPE="EULER_ANGLE", EULER_ROT_SEQ="321"),
        "expected Euler angles of version 2, or EULER_ROT_SEQ = 123, got version 1.0",
    ),
    "no sequence": (text(ANGLES, ATTITUDE_TYPE="EULER_ANGLE"), "EULER_ROT_SEQ like ZYX, got none"),
    "star tracker": (text(REF_FRAME_B="STARTRACKER_1"), "expected SC_BODY as one of REF_FRAME_A"),
    "orbital frame": (text(REF_FRAME_A="LVLH"), "an inertial frame beside SC_BODY, got LVLH"),
    "earth": (text(REF_FRAME_A="ITRF-97"), "an inertial frame beside SC_BODY, got ITRF-97"),
    "no frame": (text(REF_FRAME_A=None), "got no REF_FRAME_A"),
    "direction": (text(ATTITUDE_DIR="B"), "expected ATTITUDE_DIR = A2B or B2A, got B"),
    "no order": (text(version="1.0"), "expected QUATERNION_TYPE = FIRST or LAST, got none"),
    "clock": (text(TIME_SYSTEM="SCLK"), "expected a TIME_SYSTEM like UTC, TAI or TT, got SCLK"),
    "start": (text(START_TIME="noon"), "an epoch like .*got noon @ .*START_TIME"),
    "epoch": (text(STATE.replace("061", "367")), "an epoch on a day .* @ .*state 1, EPOCH"),
    "number": (text(STATE.replace(" 0.2", " x")), "got 'x' @ .*row 1, column q2"),
    "few": (text("2024-061T00:00:00 0.1 0.2"), "expected EPOCH Q1 Q2 Q3 QC, got 3 values @ .*line"),
    "rates": (
        text(f"{STATE} 1 2 3", ATTITUDE_TYPE="QUATERNION/ANGVEL"),
        "expected ANGVEL_FRAME = EME2000 or SC_BODY_1, got none",
    ),
    "cut": (text()[: -len("DATA_STOP\n")], "expected DATA_STOP, got the end of the file"),
    "no data": ("CCSDS_AEM_VERS = 2.0\n", "expected a segment with states, got none"),
    "stranger": (text() + "hello\n", "expected KEYWORD = value or a block of data, got 'hello'"),
    "long": (text("1" * 5000), "expected at most 4096 characters in a line"),
}


XML_FAULTS: dict[str, tuple[str, str]] = {
    "bomb": (
        '<!DOCTYPE a [<!ENTITY b "c">]><aem>&b;</aem>',
        "expected XML without a document type",
    ),
    "cut in XML": ("<aem><body>", "expected an XML document, got a fault in it"),
    "another message": ("<opm/>", "expected an attitude or orbit ephemeris .*got <opm>"),
    "no metadata": ("<aem><attitudeState/></aem>", "expected metadata before the states"),
    "empty": ("<aem></aem>", "expected a segment with states, got none"),
}


@pytest.mark.parametrize("fault", [*FAULTS, *XML_FAULTS])
def test_faults_of_a_message_are_refused(fault: str, tmp_path: Path) -> None:
    """A fault against the standard, or against the scene, is refused with its place; so are entities of
    XML, and elements that are missing."""
    content, expected = (FAULTS | XML_FAULTS)[fault]
    name = "run.xml" if fault in XML_FAULTS else "run.aem"
    with pytest.raises(Refused, match=expected):
        read(written(tmp_path, content, name))


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16", "utf-16-le", "utf-16-be", "latin-1"])
def test_a_document_type_is_refused_in_any_encoding(encoding: str, tmp_path: Path) -> None:
    """A document type is refused by the parser that reads it, whatever its bytes look like."""
    file = tmp_path / "run.xml"
    file.write_bytes('<!DOCTYPE aem [<!ENTITY b "c">]><aem>&b;</aem>'.encode(encoding))
    with pytest.raises(
        Refused, match=r"expected (XML without a document type|text in UTF-8|KEYWORD = value)"
    ):
        read(file)


def test_a_file_of_empty_elements_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Elements are counted while they are read, whatever they are."""
    monkeypatch.setattr(ccsds, "ELEMENTS", ELEMENTS._replace(most=1000))
    with pytest.raises(Refused, match="expected at most 1000 elements, got more"):
        read(written(tmp_path, "<aem>" + "<a/>" * 1000 + "</aem>", "run.xml"))


# Epochs.


@pytest.mark.parametrize(
    ("first", "second", "is_utc", "elapsed"),
    [
        ("2024-02-28T23:59:59", "2024-03-01T00:00:00", False, 86401),
        ("2024-060T12:00:00Z", "2024-02-29T12:00:00", True, 0),
        ("2023-12-31T23:59:59.9999999999999", "2024-001T00:00:00", True, Fraction(1, 10**13)),
        ("2016-12-31T23:59:59", "2017-01-01T00:00:00", True, 2),
        ("2016-12-31T23:59:60.5", "2017-01-01T00:00:00", True, Fraction(1, 2)),
        ("2016-12-31T23:59:59", "2017-01-01T00:00:00", False, 1),
        ("1971-12-31T00:00:00", "2024-01-01T00:00:00", True, 18994 * 86400 + 27),
    ],
)
def test_epochs_differ_exactly(
    first: str, second: str, is_utc: bool, elapsed: Fraction | int
) -> None:
    """Days of the year, months, fractions of any length and the leap seconds of UTC are counted."""
    assert seconds(second, is_utc) - seconds(first, is_utc) == elapsed


@pytest.mark.parametrize(
    "epoch",
    [
        *("2024-13-01T00:00:00", "2023-366T00:00:00", "2024-000T00:00:00", "0000-001T00:00:00"),
        *("2024-01-01T24:00:00", "2024-01-01T00:60:00", "2024-01-01T23:59:60", "2016-366T22:59:60"),
        *("2024-01-01", "2024-01-01T00:00:0" + "0" * 50, ""),
    ],
)
def test_epochs_that_never_were_are_refused(epoch: str) -> None:
    """No day and no second is taken that the calendar does not have."""
    with pytest.raises(ValueError, match="an epoch"):
        seconds(epoch, is_utc=True)
