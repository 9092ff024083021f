"""The columns of anybody's file: usual names and units are taken and said, and nothing is guessed."""

from __future__ import annotations

import json
import random
from collections.abc import Mapping, Sequence
from fractions import Fraction
from pathlib import Path
from time import process_time

import pytest
from builders.trajectories import MATRIX, exact_columns, file_judgement, write_csv
from builders.turns import by_turns
from mpmath import mp

import taylor_verify
from taylor_verify.cli import main
from taylor_verify.judge.files.judgement import FileJudgement
from taylor_verify.records.faults import Refused
from taylor_verify.records.quantities import COLUMNS
from taylor_verify.records.status import Status
from taylor_verify.solvers.files.columns.assigned import request
from taylor_verify.solvers.files.columns.column_units import in_brackets, known_units
from taylor_verify.solvers.files.columns.forms import FORMS, SEQUENCES
from taylor_verify.solvers.files.columns.names import GROUPS, SPELLINGS, Spelling
from taylor_verify.solvers.files.file import TrajectoryFile, from_columns, read
from taylor_verify.solvers.files.formats.column import Column

SCENE = "euler/with-attitude"
# What a note says that columns were taken for.
WORDS = {
    group: FORMS[group].words if group in FORMS else " ".join(names)
    for group, names in GROUPS.items()
}


def made(names: str | Sequence[str], wanted: Mapping[str, str] | None = None) -> TrajectoryFile:
    """The trajectory in columns of these names, each with numbers of its own."""
    every = names.split() if isinstance(names, str) else names
    columns = [Column(name, [str(10 * k), str(10 * k + 7)]) for k, name in enumerate(every)]
    return from_columns(columns, "mine", tuple((wanted or {}).items()))


def refusal(names: str | Sequence[str], wanted: Mapping[str, str] | None = None) -> str:
    with pytest.raises(Refused) as refused:
        made(names, wanted)
    return str(refused.value)


def judged(path: Path, columns: Mapping[str, Sequence[object]], **options: object) -> FileJudgement:
    return file_judgement(write_csv(path / "mine.csv", columns, str), SCENE, **options)


# Every name of the table.


def _file_of(spelling: Spelling) -> list[str]:
    names = list(spelling.keys)
    if spelling.group != "time":
        names = ["t", *names]
    names += spelling.company
    return [*names, *COLUMNS["omega"]] if spelling.beside else names


@pytest.mark.parametrize(
    "spelling",
    # Those of programs stand in test_programs.py, with files.
    by_turns((s for s in SPELLINGS if not (s.doubt or s.unless or s.whose)), 4, lambda s: s.group),
    ids=lambda s: "-".join(s.keys[:2]),
)
def test_every_spelling_of_the_table_is_taken_in_any_order(spelling: Spelling) -> None:
    """The columns of a spelling are the group that the table says, component by component."""
    names = _file_of(spelling)
    values = {name: str(k) for k, name in enumerate(names)}
    for seed in range(3):
        order = random.Random(seed).sample(names, len(names))
        file = from_columns([Column(name, [values[name]]) for name in order], "mine")
        if spelling.group == "time":
            assert file.times == (Fraction(0),)
        else:
            form, row = FORMS.get(spelling.group), [Fraction(values[key]) for key in spelling.keys]
            (read,) = file.groups["quaternion" if form else spelling.group]
            assert list(read) == list(form.quaternion(row) if form else row)
        is_ours = spelling.keys == GROUPS[spelling.group]
        assert any(WORDS[spelling.group] in note for note in file.notes) is not is_ours


@pytest.mark.parametrize("spelling", [s for s in SPELLINGS if s.doubt], ids=lambda s: s.keys[0])
def test_a_spelling_in_doubt_is_refused_with_what_to_write(spelling: Spelling) -> None:
    """Four numbered components of a quaternion do not say where the scalar is."""
    message = refusal(["t", *spelling.keys])
    assert "the scalar is the first of them or the last" in message
    first = ",".join(f"{a}={b}" for a, b in zip(COLUMNS["quaternion"], spelling.keys, strict=True))
    assert f"say which: --columns {first} for the first, q0={spelling.keys[3]}," in message
    wanted = dict(zip(COLUMNS["quaternion"], spelling.keys, strict=True))
    assert set(made(["t", *spelling.keys], wanted).groups) == {"quaternion"}


# Forms of names, a file in a line; those of the table are tested above.
USUAL = {
    "omega": """
        t omega[0] omega[1] omega[2]
        t omega(1) omega(2) omega(3)
        t omega_1 omega_2 omega_3
        TIME Omega_X Omega_Y Omega_Z
        t angularVelocityX angularVelocityY angularVelocityZ
        t /imu/angular_velocity.x /imu/angular_velocity.y /imu/angular_velocity.z
        t odom.twist.twist.angular.x odom.twist.twist.angular.y odom.twist.twist.angular.z
        t ωx ωy ωz
        t ω_1 ω_2 ω_3
        time_s gyro_x gyro_y gyro_z
        timestamp wx(t) wy(t) wz(t)""",
    "quaternion": """
        t /pose/orientation.w /pose/orientation.x /pose/orientation.y /pose/orientation.z
        t q[0] q[1] q[2] q[3]
        t η ε1 ε2 ε3""",
    "centre": """
        t px py pz Lx Ly
        t px py pz /leg.Lx /leg.Ly /leg.Lz
        t pose.pose.position.x pose.pose.position.y pose.pose.position.z""",
    "linear_impulse": "t /body.px /body.py /body.pz /body.Lx /body.Ly /body.Lz",
    "angular_impulse": "t Lx_Nms Ly_Nms Lz_Nms px_Ns py_Ns pz_Ns",
    "linear_velocity": """
        t u v w p q r
        t twist.linear.x twist.linear.y twist.linear.z""",
    "attitude": """
        t R[0][0] R[0][1] R[0][2] R[1][0] R[1][1] R[1][2] R[2][0] R[2][1] R[2][2]
        t dcm_11 dcm_12 dcm_13 dcm_21 dcm_22 dcm_23 dcm_31 dcm_32 dcm_33""",
}


@pytest.mark.parametrize(
    ("names", "group"),
    [(line, group) for group, text in USUAL.items() for line in text.strip().splitlines()],
)
def test_usual_forms_of_names(names: str, group: str) -> None:
    """Capitals, brackets, dots, paths and Greek letters are read."""
    file = made(names)
    count = len(COLUMNS[group])
    assert file.groups[group][0] == tuple(Fraction(10 * k) for k in range(1, count + 1))
    assert file.times == (Fraction(0), Fraction(7))


def test_blanks_and_a_mark_at_the_beginning_of_a_name_are_no_part_of_it() -> None:
    """Names with blanks around them, and with a byte order mark, are the names."""
    assert set(made(["\ufefftime", " wx", "wy ", '"wz"']).groups) == {"omega"}


def test_rows_are_a_sequence() -> None:
    """Whoever reads `file.groups` takes a row, the last one, or some of them."""
    rows = made("t w1 w2 w3").groups["omega"]
    assert isinstance(rows, Sequence)
    assert (rows[0], rows[1:]) == ((10, 20, 30), (rows[-1],))


# Files are judged alike.


def test_verdicts_are_those_of_the_plain_file(tmp_path: Path) -> None:
    """Aircraft names, degrees and milliseconds: the same verdicts, and notes that say what was taken."""
    sound = {name: list(values) for name, values in exact_columns(SCENE).items()}
    with mp.workdps(30):
        spoken = {
            "qz": sound["q3"], "note": [0.0] * len(sound["t"]), "r [deg/s]": degrees(sound["w3"]),
            "p [deg/s]": degrees(sound["w1"]), "q [deg/s]": degrees(sound["w2"]),
            "Time (ms)": [str(Fraction(t) * 1000) for t in sound["t"]],
            "qw": sound["q0"], "qx": sound["q1"], "qy": sound["q2"],
        }  # fmt: skip
    plain, other = judged(tmp_path, sound), judged(tmp_path, spoken)
    assert {v.quantity: v.verdict for v in plain.verdicts} == {
        v.quantity: v.verdict for v in other.verdicts
    }
    assert {v.verdict for v in other.verdicts} == {Status.PASS}
    assert other.conventions == ()
    notes = "\n".join(other.notes)
    assert "`p [deg/s]` `q [deg/s]` `r [deg/s]` taken as w1 w2 w3, body axes" in notes
    assert "in degrees per unit of time" in notes
    assert "`Time (ms)` taken as t, in thousandths of the scene's unit of time" in notes
    assert "ignored: `note`" in notes


def degrees(values: Sequence[float]) -> list[str]:
    return [mp.nstr(mp.degrees(mp.mpf(value)), 25) for value in values]


# Units.


@pytest.mark.parametrize(
    ("name", "factor"),
    [
        *(("t [s]", 1), ("t_ms", Fraction(1, 1000)), ("timestamp_ns", Fraction(1, 10**9))),
        *(("time (µs)", Fraction(1, 10**6)), ("Time [min]", 60), ("t/h", 3600), ("elapsed_sec", 1)),
    ],
)
def test_units_of_time(name: str, factor: Fraction) -> None:
    """A unit in brackets or behind the name is used, exactly, and said."""
    file = made([name, "w1", "w2", "w3"])
    assert file.times[1] == 7 * factor
    assert "unit of time" in file.notes[0]


@pytest.mark.parametrize("form", ["{} [deg/s]", "{}(°/s)", "{}_dps", "{}_deg_s", "{} {{deg/sec}}"])
def test_degrees_are_degrees_to_400_bits(form: str) -> None:
    """A rate in degrees is pi/180 of it, right to 120 digits."""
    file = made(["t", *(form.format(name) for name in ("wx", "wy", "wz"))])
    with mp.workdps(150):
        right = 10 * mp.pi / 180
        value = file.groups["omega"][0][0]
        assert abs(mp.mpf(value.numerator) / value.denominator - right) < mp.mpf(10) ** -119


@pytest.mark.parametrize(
    ("names", "unit"),
    [
        (["t", "wx [furlong]", "wy", "wz"], "furlong"),
        (["t [fortnight]", "w1", "w2", "w3"], "fortnight"),
        (["t", "w1 [m]", "w2 [m]", "w3 [m]"], "m"),
    ],
)
def test_a_unit_nobody_uses_is_refused_with_those_that_are_known(
    names: list[str], unit: str
) -> None:
    """The message names the known units, the column, and how to take its numbers as they stand."""
    message = refusal(names)
    assert f"got `{unit}`" in message
    assert "expected a unit of " in message
    assert "in the scene's unit" in message
    name = next(name for name in names if unit in name)
    ours = "t" if name[0] == "t" else "w1"
    wanted = dict(zip(("w1", "w2", "w3"), names[1:], strict=True)) | {"t": names[0]}
    assert "omega" in made(names, wanted).groups
    assert f"--columns {ours}='{name}'" in message


# What is asked for.


def test_asked_columns_come_before_all_names() -> None:
    """Names with blanks, dots, brackets and commas; a column of our own name is then ignored."""
    names = ["Zeit, s", "w1", "rate, axis 1", "b.2", "c[3]"]
    wanted = {"t": "Zeit, s", "w1": "rate, axis 1", "w2": "b.2", "w3": "c[3]"}
    file = made(names, wanted)
    assert file.groups["omega"][0] == (20, 30, 40)
    assert "ignored: `w1`" in file.notes
    text = request(["t=Zeit, s,w1=rate, axis 1,w2=b.2", 'w3="c[3]"'])
    assert dict(text) == wanted


def test_a_group_is_asked_for_by_its_first_word() -> None:
    """omega=gyro names gyro_x gyro_y gyro_z, or gyro[0] ... gyro[2]."""
    for names in ("t g_x g_y g_z", "t g[0] g[1] g[2]", "t G1 G2 G3"):
        assert made(names, {"omega": "g"}).groups["omega"][0] == (10, 20, 30)
    message = refusal("t g_x g_y w1 w2 w3", {"omega": "g"})
    assert "name each of w1 w2 w3" in message


def test_faults_of_what_is_asked_for_come_all_at_once() -> None:
    """A name that is none of ours, a column that is none, and one column twice."""
    message = refusal("t a b c", {"w1": "a", "w2": "a", "spin": "c", "w3": "bb"})
    assert "got `spin` @ columns spin=c" in message
    assert "expected every column once, got `a`, which is w1" in message
    assert "got `bb` @ columns w3=bb (near it: `b`" in message
    # What follows from them is none of its own.
    assert "expected all of" not in message
    with pytest.raises(Refused, match="expected every name once, got w1 again"):
        from_columns([Column(n, ["1"]) for n in "tab"], "mine", (("w1", "a"), ("w1", "b")))


# What is not clear.


@pytest.mark.parametrize(
    ("names", "fault"),
    [
        (
            "t wx wy wz gyro_x gyro_y gyro_z",
            "expected w1 w2 w3 once, got `wx` `wy` `wz` and `gyro_x`",
        ),
        ("time timestamp w1 w2 w3", "expected t once, got `time` and `timestamp`"),
        ("t /a/wx /a/wy /a/wz /b/wx /b/wy /b/wz", "expected w1 w2 w3 once"),
        ("t qw qx qy qz " + " ".join(f"R{n[1:]}" for n in MATRIX), "expected the attitude once"),
        (
            "t x0 x1 x2 x3 x4 x5",
            "got `x0` `x4` `x5` beside them: are they the components of a state",
        ),
        ("t w1 w2 W_3x", r"got no w3 @ mine \(did you mean `W_3x`\? --columns w3=W_3x\)"),
        ("t w1 w2 wz", r"got no w3 @ mine \(did you mean `wz`\? --columns w3=wz\)"),
        ("w1 w2 w3 epoch", "expected a column `t` of times, got none .*the columns are .*`epoch`"),
        ("t Wx wx wy wz", "`Wx` `wx` are alike"),
    ],
)
def test_what_is_not_clear_is_refused(names: str, fault: str) -> None:
    """Two columns for one of ours, halves of a time and numbered states are never chosen from."""
    with pytest.raises(Refused, match=fault):
        made(names)


@pytest.mark.parametrize(
    "names", ["y[0] y[1] y[2] y[3]", "X1 X2 X3 X4", "W0 W1 W2 W3", "q[0] q[1] q[2] q[3] q[4]"]
)
def test_a_longer_row_of_numbered_columns_is_no_group(names: str) -> None:
    """The states of a system are not read for the sake of their letter, and are named."""
    file = made(f"t gyro_x gyro_y gyro_z {names}")
    assert set(file.groups) == {"omega"}
    assert file.notes[-1] == "ignored: " + " ".join(f"`{name}`" for name in names.split())


@pytest.mark.parametrize(
    "names", ["t w1 w2 w3 u v w", "t w1 w2 w3 acceleration.x acceleration.y acceleration.z"]
)
def test_letters_alone_need_company(names: str) -> None:
    """u v w are velocities beside p q r or another omega; the x of an acceleration is no position."""
    groups = set(made(names).groups)
    assert groups == ({"omega", "linear_velocity"} if "u" in names.split() else {"omega"})
    assert set(made("t qw qx qy qz u v w").groups) == {"quaternion"}
    assert set(made("t qw qx qy qz motor.w1 motor.w2 motor.w3").groups) == {"quaternion"}
    assert set(made("t u v w p q r x y z").groups) == {"omega", "linear_velocity", "centre"}


def test_a_name_of_any_length_is_read_at_once() -> None:
    """A million dots are no million paths, and blanks behind wx do not make it another name."""
    began = process_time()
    strange = ["." * 10**6 + "wx", "wx" + " " * 10**5 + "b", "wx" * 10**5, "[" * 10**6]
    file = made(["t", "w1", "w2", "w3", *strange])
    assert set(file.groups) == {"omega"}
    assert process_time() - began < 5


def test_what_is_ignored_is_named_once() -> None:
    """Eight names and the number of the others; a part of a group is said apart."""
    file = made(["t", "w1", "w2", "w3", "pos_x", "pos_y", *(f"load {k}" for k in range(10))])
    assert file.notes[0] == "`pos_x` `pos_y` not taken: nothing in the file is c3"
    assert file.notes[1].endswith("`load 5` and 4 more")


def test_a_file_of_times_alone_is_refused_with_what_was_ignored(tmp_path: Path) -> None:
    """A file of times alone is refused, and the ignored columns are named."""
    file = write_csv(tmp_path / "mine.csv", {"t": [0.0], "roll": [1.0], "pitch": [1.0]})
    with pytest.raises(
        Refused,
        match=r"expected w1 .* tracks, got t alone @ .*ignored: `roll` `pitch`; .*--columns w1=NAME",
    ):
        taylor_verify.check(SCENE, file)


def test_text_in_another_encoding_is_refused(tmp_path: Path) -> None:
    """UTF-16 without a byte order mark is never guessed at."""
    (tmp_path / "mine.csv").write_bytes("t,w1,w2,w3\n0,é,2,3\n".encode("utf-16-be"))
    with pytest.raises(Refused, match="expected text in UTF-8, got other bytes"):
        read(tmp_path / "mine.csv")


@pytest.mark.parametrize(
    ("cell", "expected"),
    [
        ("2 deg/s", "a number alone (a unit belongs to the name of the column: `wx [deg/s]`)"),
        ("", 'a number (an integer, a decimal or "a/b")'),
        # A pattern that goes back at each digit takes half a minute for it.
        ("9" * 100_000, "a number of at most 4000 digits"),
    ],
    ids=["unit", "blank", "digits"],
)
def test_a_cell_that_is_no_number_is_told_how_to_be_one(
    cell: str, expected: str, tmp_path: Path
) -> None:
    """A unit in the cell is named as such."""
    file = tmp_path / "mine.csv"
    file.write_text(f"t;w1;w2;w3\n0;1;{cell};3\n")
    with pytest.raises(Refused) as refused:
        read(file)
    (fault,) = refused.value.faults
    assert fault.startswith(f"expected {expected}, got {cell[:40]!r}"[:-1])
    assert fault.endswith(f" @ {file}, row 1, column w2")


# The command.


def test_command_takes_columns(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """--columns, repeated or with commas; a wrong one is exit 2 with every fault."""
    sound = exact_columns("euler/generic")
    names = {"t": "Zeit", "w1": "rate, axis 1", "w2": "b", "w3": "c"}
    path = tmp_path / "mine.csv"
    rows = zip(*sound.values(), strict=True)
    header = ",".join(f'"{names[name]}"' for name in sound)
    path.write_text("\n".join([header, *(",".join(map(repr, row)) for row in rows)]))
    call = ["check", str(path), "--scene", "euler/generic", "--json"]
    assert main([*call, "--columns", "t=Zeit,w1=rate, axis 1,w2=b", "--columns", "w3=c"]) == 0
    notes = json.loads(capsys.readouterr().out)["file"]["notes"]
    assert "`rate, axis 1` `b` `c` taken as w1 w2 w3, body axes" in notes
    assert main([*call, "--columns", "t=Zeit,w9=b,w1=rate"]) == 2
    errors = capsys.readouterr().err
    assert "got `w9` @ columns w9=b" in errors
    assert "got `rate` @ columns w1=rate" in errors


# The documentation.

PAGE = Path(__file__).resolve().parents[3] / "docs" / "columns.md"


def _documented(heading: str) -> list[tuple[str, str]]:
    """The table below a heading: the first cell, and each text in backquotes of the second."""
    _, _, below = PAGE.read_text(encoding="utf-8").partition(heading)
    lines = below.split("\n\n## ")[0].splitlines()
    table = [line.split("|")[1:-1] for line in lines if line.startswith("| ")]
    return [
        (first.strip(" `"), text) for first, *rest in table[1:] for text in rest[0].split("`")[1::2]
    ]


def test_names_of_the_page_are_taken() -> None:
    """Every name that the documentation shows is taken as the group that it says."""
    shown = _documented("## Other names")
    assert {group for group, _ in shown} == {g for g in GROUPS if g == "zyx" or g not in SEQUENCES}
    for group, names in shown:
        company = "t" if group != "time" else "w1 w2 w3"
        company += " p q r" if names == "u v w" else ""
        company += " Lx Ly Lz" if (group, names) == ("linear_impulse", "px py pz") else ""
        company += " px py pz" if names == "Lx Ly Lz" else ""
        file = made(f"{company} {names}")
        assert {group, "quaternion"} & set(file.groups) or group == "time", names
        assert any(" taken as " + WORDS[group] in note for note in file.notes)


def test_units_of_the_page_are_known() -> None:
    """The documentation shows the first name of every unit, and each of them is known."""
    of = {
        "an angle": "zyx",
        "a rate": "omega",
        "a velocity": "linear_velocity",
        "a length": "centre",
        "time": "time",
    }
    for kind, texts in _documented("## Units"):
        group = of.get(kind, "angular_impulse" if "m" in texts else "linear_impulse")
        assert all(in_brackets(text, group) is not None for text in texts.split())
        if kind in of:
            assert ", ".join(texts.split()) == known_units(group)
