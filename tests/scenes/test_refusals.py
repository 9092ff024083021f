"""What the reader refuses, file by file, as the first line of each file of cases/refused says."""

from __future__ import annotations

from pathlib import Path

import pytest
from builders.scenes import scene_text

from taylor_verify.records.faults import Refused
from taylor_verify.scenes import library
from taylor_verify.scenes.reading.reader import load

FILES = sorted((library.cases_directory() / "refused").glob("*.toml"))
FRAGMENT, COUNT = "# refused: ", "# faults: "


def promise(file: Path) -> str:
    """The first line of a file, which says what its refusal must be."""
    return file.read_text().splitlines()[0]


def refusal(scene: Path | str) -> Refused:
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
    (line,) = refusal(file).faults
    assert promise(file).removeprefix(FRAGMENT) in line


@pytest.mark.parametrize("file", having(COUNT), ids=lambda file: file.stem)
def test_all_faults_are_reported_at_once(file: Path) -> None:
    """A file with several faults is refused with as many lines, in the text too."""
    refused = refusal(file)
    assert len(refused.faults) == int(promise(file).removeprefix(COUNT))
    assert str(refused).splitlines() == list(refused.faults)


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_every_line_says_what_was_expected_what_was_found_and_where(file: Path) -> None:
    """Each fault reads ``expected ..., got ... @ ...``."""
    for line in refusal(file).faults:
        expected, _, rest = line.partition(", got ")
        assert expected.startswith("expected ")
        assert " @ " in rest


def test_a_missing_file_is_refused(tmp_path: Path) -> None:
    """A path that cannot be read is a fault, not a traceback."""
    line = str(refusal(tmp_path / "absent.toml"))
    assert "no such file" in line
    assert "absent.toml" in line


def test_bytes_that_are_no_text_are_refused(tmp_path: Path) -> None:
    """A file that is not UTF-8 is refused as such."""
    file = tmp_path / "latin.toml"
    file.write_bytes(b'title = "\xe9"\n')
    assert "not UTF-8" in str(refusal(file))


def test_an_unknown_name_is_refused_with_near_names() -> None:
    """A misspelt name of a shipped scene is answered with the name that was meant."""
    assert "euler/generic" in str(refusal("euler/genric"))
    assert "kirchhoff/remus-100" in str(refusal("remus"))


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
    assert fragment in str(refusal(file))
