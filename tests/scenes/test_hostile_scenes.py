"""What the reader refuses: each file of cases/refused, and scenes that mean harm, in a bounded text."""

from __future__ import annotations

import os
import time
from pathlib import Path

import pytest
from builders.scenes import LISTED_INSTANTS, scene_text

from taylor_verify.records.faults import Refused
from taylor_verify.scenes import library
from taylor_verify.scenes.reading import time_table
from taylor_verify.scenes.reading.reader import MOST_BYTES, load, read

# Seconds of the processor that a scene of a hundred kilobytes may take.
PATIENCE = 5.0
INSTANTS = '["0.5", 1, 2]'


def refusal(text: str) -> Refused:
    with pytest.raises(Refused) as refused:
        read(text, "hostile")
    return refused.value


@pytest.mark.parametrize("name", ["pipe.toml", "pipe"])
def test_a_pipe_is_never_opened(name: str, tmp_path: Path) -> None:
    """A pipe would wait for a writer; it is refused by its kind, or is no scene's name."""
    os.mkfifo(tmp_path / name)
    with pytest.raises(Refused, match=r"got a FIFO|expected a path or the name"):
        load(tmp_path / name)


def test_a_device_is_refused(tmp_path: Path) -> None:
    """A device has no end."""
    (tmp_path / "zero.toml").symlink_to("/dev/zero")
    with pytest.raises(Refused, match="expected a readable scene file, got a device @"):
        load(tmp_path / "zero.toml")


def test_a_large_file_is_refused_by_its_size(tmp_path: Path) -> None:
    """A scene is no larger than its million instants."""
    (tmp_path / "large.toml").touch()
    os.truncate(tmp_path / "large.toml", MOST_BYTES.most + 1)
    with pytest.raises(
        Refused, match=r"at most 33554432 bytes, got 33554433 .*\(a million instants"
    ):
        load(tmp_path / "large.toml")


@pytest.mark.parametrize(
    "name",
    ["a\0b.toml", "\ud800.toml", "a\0b", "x" * 5000, "x" * 5000 + ".toml"],
    ids=["NUL", "half a character", "NUL in a name", "long", "long path"],
)
def test_names_that_no_file_has_are_refused(name: str) -> None:
    """A NUL, half a character and a name beyond any file system's are no fault of this package."""
    with pytest.raises(Refused, match="expected a"):
        load(name)


def test_instants_are_no_more_than_samples(monkeypatch: pytest.MonkeyPatch) -> None:
    """`at` holds as many instants as `samples` may ask for, and no more."""
    monkeypatch.setattr(time_table, "MOST_SAMPLES", 1000)
    listed = "[" + ",".join(map(str, range(1, 1002))) + "]"
    (fault,) = refusal(LISTED_INSTANTS.replace(INSTANTS, listed)).faults
    assert fault == "expected at most 1000 numbers, got 1001 @ time.at"


@pytest.mark.parametrize(
    "key",
    [
        "a." * 50_000 + "a = 1",
        "[" + "a." * 50_000 + "a]",
        '"a" . ' * 50_000 + "a = 1",
        "x = {" + "a." * 50_000 + "a = 1}",
    ],
    ids=["dotted", "header", "quoted", "inline"],
)
def test_keys_of_many_parts_are_refused_at_once(key: str) -> None:
    """The reader of TOML takes the square of their number in time and memory; it is not asked."""
    began = time.process_time()
    (fault,) = refusal(f"{LISTED_INSTANTS}\n{key}\n").faults
    assert time.process_time() - began <= PATIENCE
    assert fault.startswith("expected a key of at most 16 parts, got more @ hostile, line ")


def test_a_sentence_with_dots_is_no_key() -> None:
    """Initials in a title, and paths in a comment, are left alone."""
    sentence = (
        "# " + "a." * 40 + "\n" + LISTED_INSTANTS.replace('title = "', 'title = "' + "A. " * 40)
    )
    assert read(sentence, "dots").title.startswith("A. A. ")


@pytest.mark.parametrize("deep", ["[" * 50_000 + "]" * 50_000, "{a=" * 50_000 + "1" + "}" * 50_000])
def test_deep_nesting_is_refused(deep: str) -> None:
    """Brackets beyond the stack are a fault of the text."""
    assert "nested too deeply" in str(refusal(f"{LISTED_INSTANTS}\nx = {deep}\n"))


@pytest.mark.parametrize(
    "number",
    [
        "1" * 1_000_000,
        "1." + "1" * 1_000_000,
        "0x" + "f" * 1_000_000,
        "1e999999999",
        '"1e999999999"',
    ],
    ids=["integer", "decimal", "hexadecimal", "exponent", "text"],
)
def test_numbers_of_a_million_digits_are_refused(number: str) -> None:
    """A number that is too long is refused before anything is built of it, in a short sentence."""
    began = time.process_time()
    fault = str(refusal(LISTED_INSTANTS.replace(INSTANTS, f"[{number}]")))
    assert time.process_time() - began <= PATIENCE
    assert len(fault) <= 300


@pytest.mark.parametrize(
    "extra",
    [
        "".join(f"k{i} = 1\n" for i in range(50_000)),
        "k" * 1_000_000 + " = 1\n",
    ],
    ids=["many keys", "a long key"],
)
def test_the_refusal_of_many_faults_is_short(extra: str) -> None:
    """A hundred faults are told, each cut short; a million would be read by nobody."""
    began = time.process_time()
    fault = refusal(f"{extra}{LISTED_INSTANTS}")
    assert time.process_time() - began <= PATIENCE
    assert len(fault.faults) <= 101
    assert len(str(fault)) <= 30_000


def test_many_wrong_instants_are_told_by_the_hundred() -> None:
    """The line after the hundredth says that there are more."""
    listed = "[" + ", ".join(['"x"'] * 10_000) + "]"
    faults = refusal(LISTED_INSTANTS.replace(INSTANTS, listed)).faults
    assert len(faults) == 101
    assert faults[-1] == "and more faults beyond these hundred"


def test_a_title_fits_into_a_cell() -> None:
    """A title of a million characters would fill the terminal."""
    long = LISTED_INSTANTS.replace('title = "', 'title = "' + "x" * 1_000_000)
    (fault,) = refusal(long).faults
    assert fault.startswith("expected at most 1000 characters, got 10000")


def test_a_byte_order_mark_is_no_content(tmp_path: Path) -> None:
    """A scene from another editor is the same scene."""
    (tmp_path / "mine.toml").write_bytes(b"\xef\xbb\xbf" + LISTED_INSTANTS.encode())
    assert load(tmp_path / "mine.toml").digest == read(LISTED_INSTANTS, "mine").digest


def test_a_fault_is_one_line() -> None:
    """A file's name may hold a line break; what a runner reads at a line's start is never a name."""
    assert Refused(["a\n::error::b"]).faults == ("a\\n::error::b",)


# Files of cases/refused, as the first line of each says

FILES = sorted((library.cases_directory() / "refused").glob("*.toml"))
FRAGMENT, COUNT = "# refused: ", "# faults: "


def promise(file: Path) -> str:
    """The first line of a file, which says what its refusal must be."""
    return file.read_text().splitlines()[0]


def refused_file(scene: Path | str) -> Refused:
    with pytest.raises(Refused) as caught:
        load(scene)
    return caught.value


def having(prefix: str) -> list[Path]:
    return [file for file in FILES if promise(file).startswith(prefix)]


def test_every_refused_file_says_what_must_be_said_of_it() -> None:
    """Each file promises a fragment or a count of faults, and there are both kinds."""
    assert len(having(FRAGMENT)) >= 14
    assert having(COUNT)
    assert {*having(FRAGMENT), *having(COUNT)} == set(FILES)


@pytest.mark.parametrize("file", having(FRAGMENT), ids=lambda file: file.stem)
def test_one_fault_gives_the_one_line_promised(file: Path) -> None:
    """A file with one fault is refused with one line, and the line holds the promised fragment."""
    (line,) = refused_file(file).faults
    assert promise(file).removeprefix(FRAGMENT) in line


@pytest.mark.parametrize("file", having(COUNT), ids=lambda file: file.stem)
def test_all_faults_are_reported_at_once(file: Path) -> None:
    """A file with several faults is refused with as many lines, in the text too."""
    refused = refused_file(file)
    assert len(refused.faults) == int(promise(file).removeprefix(COUNT))
    assert str(refused).splitlines() == list(refused.faults)


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_every_line_says_what_was_expected_what_was_found_and_where(file: Path) -> None:
    """Each fault reads ``expected ..., got ... @ ...``."""
    for line in refused_file(file).faults:
        expected, _, rest = line.partition(", got ")
        assert expected.startswith("expected ")
        assert " @ " in rest


def test_a_missing_file_is_refused(tmp_path: Path) -> None:
    """A path that cannot be read is a fault, not a traceback."""
    line = str(refused_file(tmp_path / "absent.toml"))
    assert "no such file" in line
    assert "absent.toml" in line


def test_bytes_that_are_no_text_are_refused(tmp_path: Path) -> None:
    """A file that is not UTF-8 is refused as such."""
    file = tmp_path / "latin.toml"
    file.write_bytes(b'title = "\xe9"\n')
    assert "not UTF-8" in str(refused_file(file))


def test_an_unknown_name_is_refused_with_near_names() -> None:
    """A misspelt name of a shipped scene is answered with the name that was meant."""
    assert "euler/generic" in str(refused_file("euler/genric"))
    assert "kirchhoff/remus-100" in str(refused_file("remus"))


HOSTILE = {
    "an exponent that no decimal holds": ("1e99999999999999999999", "powers of ten"),
    "a tiny power of ten": ("1e-6000", "powers of ten"),
    "a zero with a huge exponent": ("0e999999999", "powers of ten"),
    "a huge exponent in a string": ('"1e999999999"', "powers of ten"),
    "a longer hexadecimal integer than Python prints": ("0x" + "f" * 5000, "powers of ten"),
    "a longer integer than Python reads": ("9" * 5000, "4300 digits"),
    "a longer fraction than Python reads": (f'"{"9" * 5000}/7"', "at most 4000 digits"),
    "arrays nested too deeply": ("[" * 5000 + "]" * 5000, "nested too deeply"),
    "arrays nested as deeply as can be read": ("[" * 320 + "]" * 320, "a finite number"),
    "a date": ("1979-05-27", "a finite number"),
    "a binary fraction of another alphabet": ('"\N{ARABIC-INDIC DIGIT ONE}"', "a number"),
}


@pytest.mark.parametrize(("text", "fragment"), HOSTILE.values(), ids=HOSTILE)
def test_hostile_numbers_are_refused_before_they_are_built(
    text: str, fragment: str, tmp_path: Path
) -> None:
    """No literal, however large, long or deep, hangs the reader or escapes as another exception."""
    file = tmp_path / "hostile.toml"
    file.write_text(scene_text(initial=f"omega = [1, 2, {text}]"))
    assert fragment in str(refused_file(file))
