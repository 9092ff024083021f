"""Texts of loads, whatever stands in them: read at once, or refused with the place of every fault."""

from __future__ import annotations

import json
import os
import time
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path
from random import Random

import pytest
from builders.scenes import read_scene, scene_text

from taylor_verify.exact import exact
from taylor_verify.records.faults import Refused
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene

# Seconds of the processor that any text may take.
PATIENCE = 1.0


def pushed(moment: str = "0, 0, 0") -> str:
    return f"inertia = [1, 2, 3]\nmoment = [{moment}]"


def of_texts(*texts: str, tables: str = "") -> Scene:
    moment = ", ".join(map(json.dumps, (*texts, "0", "0", "0")[:3]))
    return read_scene(pushed(moment), tables=tables)


def faults(*texts: str, tables: str = "") -> tuple[str, ...]:
    with pytest.raises(Refused) as refused:
        of_texts(*texts, tables=tables)
    return refused.value.faults


# Hostile texts.

WORDS = (
    "w1", "w2", "t", "pi", "q0", "r11", "I12", "u1", "x", "e", "nan", "inf", "None", "True", "lambda", "if",
    "else", "and", "not", "in", "is", "for", "await", "yield", "import", "__import__", "__class__", "eval",
    "print", "self", "o1", "d",
)  # fmt: skip
NUMBERS = (
    "0", "1", "2.5", ".5", "1.", "1e9", "1e5000", "1e-5000", "1e99999999999", "1_000", "0x10", "0b1", "1j",
    "007", "9" * 300, "64", "1/3", "-1", "\u0661", "\u00b2", "\uff11",
)  # fmt: skip
SIGNS = (
    "+", "-", "*", "/", "**", "^", "^^", "//", "%", "@", "<", "<=", "==", "!=", ":=", "=", "~", "&", "|",
    ",", ".", ":", ";", "(", ")", "()", "[", "]", "{", "}", "'", '"', "\\", "#", "!", "$", "?", "`", "\n",
    "\r", "\t", "\x00", "\x07", "\x1b[2J", "\u202e", "\u2028", "\ud7ff", "\U0001f600", " ",
)  # fmt: skip
FUNCTIONS = (
    "sin", "exp", "log", "sqrt", "asin", "atan2", "norm", "min", "max", "clip", "step", "sign", "floor",
    "pow", "tanh", "abs", "gamma", "range", "open",
)  # fmt: skip
FORMS: tuple[Callable[[Random, str], str], ...] = (
    lambda r, a: f"({a})^{r.choice(NUMBERS)}",
    lambda r, a: f"{r.choice(FUNCTIONS)}({a})",
    lambda r, a: f"{r.choice(FUNCTIONS)}({a}, {r.choice(WORDS)})",
    lambda r, a: f"{r.choice(FUNCTIONS)}(*{a}, k={a})",
    lambda r, a: f"{a} if {r.choice(WORDS)} < {r.choice(NUMBERS)} else {a}",
    lambda r, a: f"{a} < {a} < {a}",
    lambda r, a: f"({a})({a})",
    lambda r, a: f"({a}).{r.choice(WORDS)}",
    lambda r, a: f"lambda {r.choice(WORDS)}: {a}",
    lambda r, a: f"[{a} for {r.choice(WORDS)} in ({a})]",
    lambda r, a: f"f'{{{a}}}'",
    lambda r, a: f"{a} # {a}",
    lambda r, a: "-" * r.randrange(200) + a,
    lambda r, a: "(" * (n := r.randrange(300)) + a + ")" * n,
    lambda r, a: "+".join([a] * r.randrange(1, 30)),
    lambda r, a: "*".join([f"({a})^64"] * r.randrange(1, 5)),
)
WHOLE = (
    "", " ", "-" * 3999, "-" * 3999 + "1", "(" * 4000, "(" * 1900 + "1" + ")" * 1900, "(10**5000)**10000",
    "((10^64)^64)^64", "(((2^64)^64)^20)*(((3^64)^64)^12)", "2^2^2^2^2^2", "1" * 3999, "w1" + "+w1" * 1300,
    "sin(" * 1000, "1 if t < 1 else " * 200 + "0", "sqrt(" * 98 + "2" + ")" * 98, "x:=1", "(x:=1)", "*w1",
)  # fmt: skip


def drawn(random: Random) -> str:
    """A text out of what a grammar of Python has, and of what it has not."""
    if random.random() < 0.02:
        return random.choice(WHOLE)
    text = random.choice((*WORDS, *NUMBERS))
    for _ in range(random.randrange(7)):
        kind = random.randrange(4)
        if kind < 2:
            text = random.choice(FORMS)(random, text)
        elif kind == 2:
            text += random.choice(SIGNS) + random.choice((*WORDS, *NUMBERS))
        else:
            cut = random.randrange(len(text) + 1)
            text = text[:cut] + random.choice(SIGNS) + text[cut + random.randrange(2) :]
        text = text[:5000]
    return text


def answer(text: str) -> tuple[float, str]:
    """The seconds that a text takes in five places of a scene, and what is said."""
    quoted = json.dumps(text)
    states = f"h = {{ start = 0, rate = {quoted} }}\nm = {{ every = 1, value = {quoted} }}"
    tables = f"[define]\nd = {quoted}\n[space]\no = [1, {quoted}, 0]\n[states]\n{states}"
    began = time.process_time()
    try:
        loads = read_scene(pushed(f"{quoted}, 0, 0"), tables=tables).body.loads
        reply = "no steps" if loads is None else f"{len(loads.piece(loads.origin).steps)} steps"
    except Refused as refused:
        reply = str(refused)
    return time.process_time() - began, reply


def test_no_text_is_evaluated_or_takes_long() -> None:
    """Whatever is drawn is read or refused within a second, each fault one line with its place."""
    random = Random(1)
    for _ in range(300):
        text = drawn(random)
        seconds, reply = answer(text)
        assert seconds <= PATIENCE, text
        for line in reply.splitlines():
            assert "steps" in line or "expected " in line or "and more faults" in line, (
                text,
                reply,
            )
            assert len(line) <= 400


@pytest.mark.parametrize("text", WHOLE)
def test_texts_of_unusual_form_are_answered_at_once(text: str) -> None:
    """Deep, long and empty ones, and powers that no memory holds."""
    seconds, reply = answer(text)
    assert seconds <= PATIENCE
    assert reply


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ("1_000", "a decimal number, got 1_000 @ body.moment[0], column 1"),
        ("w1 + 0x10", "a decimal number, got 0x10 @ body.moment[0], column 6"),
        ("2*1j", "a decimal number, got 1j @ body.moment[0], column 3"),
        ("w1*\u0661", "got '\\u0661' @ body.moment[0], column 4"),
        ("  w1 * / 2", "an expression, got `/ 2` @ body.moment[0], column 8"),
        ("2 * (w1", "a `)` that closes this bracket, got none @ body.moment[0], column 5"),
        ("w1^2)", "a `(` for this bracket, got none @ body.moment[0], column 5"),
        ("w1^2 + nix", "a known name, got `nix` @ body.moment[0], column 8"),
        ("u1", "a known name, got `u1` @ body.moment[0], column 1"),
        ("__import__(1)", "got `__import__` @ body.moment[0], column 1"),
        ("w1(t)", "`w1` alone, as a name of the scene takes no arguments, got `w1(..)`"),
        ("w1.real", "got `w1.real` @ body.moment[0], column 1"),
        ("sin(x=w1)", "got `sin(x=w1)` @ body.moment[0], column 1"),
        ("sin(1, 2)", "one number in sin(), got 2 @ body.moment[0], column 1"),
        ("clip(w1, 0)", "3 numbers in clip(), got 2 @ body.moment[0], column 1"),
        ("norm()", "some numbers in norm(), got 0 @ body.moment[0], column 1"),
        ("1 < 2 < 3", "got `1 < 2 < 3` @ body.moment[0], column 1"),
        ("w1 if 0 < t < 1 else 0", "one comparison with < or >, got `0 < t < 1` @ body.moment[0]"),
        ("3*sign(w1)", "the load would jump with the state @ body.moment[0], column 3"),
        ("1 if w1 > 0 else 2", "the load would jump with the state @ body.moment[0], column 6"),
        ("step(t^2 - 1)", "linear in t alone"),
        ("w1/(2 - 2)", "a divisor that is not zero, got 0 @ body.moment[0], column 1"),
        ("sqrt(-1)", "a number of which there is a sqrt, got -1 @ body.moment[0], column 1"),
        ("w1^65", "a whole power of at most 64, got 65 @ body.moment[0], column 1"),
        ("w1\n+ 1", "got '\\n' @ body.moment[0], column 3"),
        ("2 deg/s", 'a number without a unit (units are any consistent set; `omega`'),
        ("3 N m", "a number without a unit"),
    ],
)  # fmt: skip
def test_a_fault_is_named_with_its_column(text: str, fault: str) -> None:
    """Columns count from 1, as editors do."""
    (line,) = faults(text)
    assert fault in line


def test_all_faults_of_all_texts_come_at_once() -> None:
    """Also two in one text, those of what nobody uses, and a wrong key elsewhere."""
    tables = '[define]\nunused = "sin()"\n[space]\no = [0, "1 +* t", 0]\n[other]'
    lines = faults("a + b", "w2", "2*)", tables=tables)
    assert [line.rpartition(" @ ")[2].partition(" (")[0] for line in lines] == [
        "body.moment[0], column 1",
        "body.moment[0], column 5",
        "body.moment[2], column 3",
        "define.unused, column 1",
        "space.o[1], column 4",
        "other",
    ]


def test_a_definition_is_checked_where_no_load_is_written() -> None:
    """A scene of numbers alone may have a vocabulary, which is read all the same."""
    with pytest.raises(Refused, match=r"got `nix` @ define\.d, column 5"):
        read_scene(tables='[define]\nd = "1 + nix"')


def test_a_fault_of_a_definition_is_said_once_and_where_it_stands() -> None:
    """However often and through however many others it is named, in no time."""
    chain = "\n".join(f'd{k} = "d{k + 1}*d{k + 1}"' for k in range(20))
    began = time.process_time()
    (line,) = faults("d0 + d5", "d0", tables=f'[define]\n{chain}\nd20 = "nix"')
    assert time.process_time() - began <= PATIENCE
    assert line.endswith("got `nix` @ define.d20, column 1")


@pytest.mark.parametrize(
    "tables",
    [
        '[define]\na = "a"',
        '[define]\na = "2*b"\nb = "c + 1"\nc = "sin(a)"',
        '[define]\na = "o2"\n[space]\no = [0, "a", 0]',
        '[space]\no = ["p1", 0, 0]\np = ["o1", 0, 0]',
    ],
    ids=["itself", "three", "through a vector", "two vectors"],
)
@pytest.mark.parametrize("moment", ["w1", "a", "o1"])
def test_a_definition_that_needs_itself_is_refused(tables: str, moment: str) -> None:
    """Whether a load names it or not."""
    assert any(
        "a definition without itself, got " in line for line in faults(moment, tables=tables)
    )


@pytest.mark.parametrize("length", [300, 3000])
def test_long_chains_of_names_are_refused(length: int) -> None:
    """A chain that is longer than a stack is one clear fault of some text."""
    chain = "\n".join(f'd{k} = "d{k + 1} + w1"' for k in range(length))
    lines = faults("d0", tables=f"[define]\n{chain}\nd{length} = 1")
    assert "a shorter chain of names" in lines[0]


def test_a_chain_of_thirty_names_is_read() -> None:
    """In any order of writing."""
    chain = [f'd{k} = "2*d{k + 1} + w1"' for k in range(30)]
    for order in (chain, chain[::-1]):
        assert of_texts("d0", tables="[define]\nd30 = 1\n" + "\n".join(order)).body.loads


@pytest.mark.parametrize(
    ("tables", "place"),
    [
        ('[define]\nw1 = "2"', "define.w1"),
        ('[define]\nu1 = "2"', "define.u1"),
        ('[define]\nsin = "2"', "define.sin"),
        ("[space]\natan = [1, 0, 0]", "space.atan"),
        ('[define]\nlambda = "2"', "define.lambda"),
        ("[space]\nw = [1, 0, 0]", "space.w"),
        ("[define]\nb2 = 1\n[space]\nb = [1, 0, 0]", "space.b"),
        ("[define]\np = 1\n[tables]\np = { times = [0], values = [1] }", "tables.p"),
    ],
)
def test_a_name_that_is_taken_is_refused(tables: str, place: str) -> None:
    """Names of the other model, functions, components of a vector, words of Python, or made twice."""
    lines = faults("w1", tables=tables)
    assert lines
    assert all(
        "a name that is free, got `" in line and line.endswith(f" @ {place}") for line in lines
    )


def test_a_function_lends_its_name_to_a_table() -> None:
    """Before a bracket it is the function, elsewhere the table: the contract's own table is `log`."""
    table = '[tables]\n{} = {{ times = [0, 1], values = [2, 3], kind = "linear" }}'
    named = of_texts("log(log)", tables=table.format("log"))
    plain = of_texts("log(profile)", tables=table.format("profile"))
    assert (exact(named, ["1/2"])["omega"] == exact(plain, ["1/2"])["omega"]).all()


def test_a_name_has_letters_digits_and_underscores() -> None:
    """And begins with a letter."""
    for name in ('"a b"', '"\u03c9"', "2x", "_a", '""'):
        assert "a name of letters" in faults("w1", tables=f"[define]\n{name} = 1")[0]


def test_long_exact_numbers_are_not_multiplied_for_long() -> None:
    """Each number is within its limit; all of them together are not."""
    tables = '[define]\na = "((7919/7907)^64)^56"\nb = "((6007/6011)^64)^53"'
    began = time.process_time()
    assert "bits in all" in faults("+".join(["0*(a*b)"] * 90), tables=tables)[0]
    assert time.process_time() - began <= PATIENCE


# Tables.


def of_file(tmp_path: Path, keys: str, content: str = "t,T\n0,1\n1,2\n") -> Scene:
    (tmp_path / "scene").mkdir(exist_ok=True)
    (tmp_path / "scene" / "data.csv").write_text(content, encoding="utf-8")
    text = scene_text(pushed('"p", 0, 0'), tables=f"[tables]\np = {{ {keys} }}")
    file = tmp_path / "scene" / "scene.toml"
    file.write_text(text, encoding="utf-8")
    return load(file)


COLUMNS = 'time = "t", column = "T"'


def test_a_table_is_read_from_a_file_beside_the_scene(tmp_path: Path) -> None:
    """Or from a folder below it; its numbers are exact decimals."""
    inside = of_file(
        tmp_path, f'file = "data.csv", {COLUMNS}', "T, t\n0.1,0\n1/3,2.50\n"
    ).body.loads
    (tmp_path / "scene" / "below").mkdir()
    (tmp_path / "scene" / "below" / "d.csv").write_text("t,T\n0,1\n", encoding="utf-8")
    assert inside is not None
    ((_, table),) = inside.tables
    assert table.times == (0, Fraction(5, 2))
    assert table.values == (Fraction(1, 10), Fraction(1, 3))
    assert of_file(tmp_path, f'file = "below/d.csv", {COLUMNS}').body.loads


@pytest.mark.parametrize(
    ("keys", "content", "fault"),
    [
        (f'file = "../data.csv", {COLUMNS}', "", "a file in the folder of the scene"),
        (f'file = "below/../../x.csv", {COLUMNS}', "", "a file in the folder of the scene"),
        (f'file = "/etc/passwd", {COLUMNS}', "", "a file in the folder of the scene"),
        (f'file = "link.csv", {COLUMNS}', "", "a file in the folder of the scene"),
        (f'file = "folder", {COLUMNS}', "", "got a folder"),
        (f'file = "pipe.csv", {COLUMNS}', "", "got a FIFO"),
        (f'file = "none.csv", {COLUMNS}', "", "got no such file"),
        (f'file = "a\\u0000b.csv", {COLUMNS}', "", "a name that no file has"),
        (f'file = "large.csv", {COLUMNS}', "", "at most 4194304 bytes"),
        (f'file = "data.csv", {COLUMNS}', "s,T\n0,1\n", "one of the columns s, T, got t @ tables.p.time"),
        (f'file = "data.csv", {COLUMNS}', "t,T,T\n0,1,2\n", "got `T` in 2 columns @ tables.p.column"),
        (f'file = "data.csv", {COLUMNS}', "t,T\n", "1 to 10000 rows, got 0"),
        (f'file = "data.csv", {COLUMNS}', "t,U\n0,1\n", "one of the columns t, U, got T @ tables.p.column"),
        (f'file = "data.csv", {COLUMNS}', "t,T\n0,one\n", 'a/b"), got one @ tables.p.file, line 2'),
        (f'file = "data.csv", {COLUMNS}', "t,T\n0,1\n1\n", "got nothing @ tables.p.file, line 3"),
        (f'file = "data.csv", {COLUMNS}', "t,T\n0,nan\n", "got nan @ tables.p.file, line 2"),
        (f'file = "data.csv", {COLUMNS}', "t,T\n1,1\n1,2\n", "got 1 after 1 @ tables.p.times[1]"),
        (f'file = "data.csv", {COLUMNS}', 't,T\n"0,1\n', "a CSV file in UTF-8"),
        (f'file = "data.csv", kind = "fourier", {COLUMNS}', None, "one of hold, linear, cubic"),
        (f'file = "data.csv", values = [1], {COLUMNS}', None, "a known key, got `values`"),
        ("times = [0, 1], values = [1]", None, "as many values as times"),
        ("times = [], values = []", None, "as many values as times, one at least"),
        ('times = [0, "x"], values = [1, 2]', None, "a number"),
    ],
)  # fmt: skip
def test_a_table_that_cannot_be_is_refused(
    tmp_path: Path, keys: str, content: str | None, fault: str
) -> None:
    """No link, path or device leads out of the folder of the scene; one clear fault for each."""
    folder = tmp_path / "scene"
    (folder / "folder").mkdir(parents=True)
    (tmp_path / "data.csv").write_text("t,T\n0,1\n", encoding="utf-8")
    (folder / "link.csv").symlink_to(tmp_path / "data.csv")
    os.mkfifo(folder / "pipe.csv")
    (folder / "large.csv").touch()
    os.truncate(folder / "large.csv", 2**22 + 1)
    with pytest.raises(Refused) as refused:
        of_file(tmp_path, keys, "t,T\n0,1\n1,2\n" if content is None else content)
    (line,) = refused.value.faults
    assert fault in line


@pytest.mark.parametrize("count", [101, 150, 500])
def test_brackets_are_at_most_a_hundred_deep(count: int) -> None:
    """A deeper text is refused by that limit, at its 101st bracket; a hundred brackets are read."""
    (fault,) = faults("(" * count + "t" + ")" * count)
    assert "at most 100 deep, got a deeper one @ body.moment[0], column 101" in fault
    assert of_texts("(" * 100 + "t" + ")" * 100).body.loads


@pytest.mark.parametrize("text", ["exp(1e9)", "cosh(-1e6)", "7^(1e5 + 1/2)"])
def test_numbers_of_too_many_bits_are_refused_before_they_are_made(text: str) -> None:
    """A text whose number has more than a hundred thousand bits is refused at once, as a longer one is."""
    (fault,) = faults(text)
    assert "expected numbers of at most 100000 bits, got a longer one @ body.moment[0]" in fault


def test_a_scene_in_no_folder_has_no_files() -> None:
    """A scene that is read from a text says so."""
    with pytest.raises(Refused, match=r"got a scene that is in no folder @ tables\.p\.file"):
        read_scene(tables=f'[tables]\np = {{ file = "data.csv", {COLUMNS} }}')
