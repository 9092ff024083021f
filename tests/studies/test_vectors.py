"""Vectors: their expectations are what `check` says, and readers in four languages find what is wrong."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from collections import Counter
from dataclasses import asdict
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from builders.turns import by_turns
from builders.worked import ROOT
from jsonschema import Draft202012Validator

import taylor_verify
from taylor_verify.scenes.reading.reader import read
from taylor_verify_reports.studies.vectors.bodies_in_water import IN_WATER
from taylor_verify_reports.studies.vectors.expected_words import forbidden
from taylor_verify_reports.studies.vectors.questions import Question, answered, questions
from taylor_verify_reports.studies.vectors.vectors_file import FOLDER
from taylor_verify_reports.studies.vectors.wrong_answers import Wrong, judged, wrong_answer

PUBLISHED = ROOT / "reports" / FOLDER
WRITTEN = re.compile(r'(moment|force|couple) = \["')
TOLERANCES = {"reader.cpp": "1e-9", "reader.mjs": "1e-9", "reader.rs": "1e-9", "reader.m": "1e-7"}


@cache
def vectors() -> Any:
    return json.loads((PUBLISHED / "vectors.json").read_text(encoding="utf-8"))


def asked() -> dict[str, Any]:
    return {question["name"]: question for question in vectors()["questions"]}


def wrong() -> list[Wrong]:
    return [Wrong(**entry) for entry in vectors()["wrong"]]


def named(each: Any) -> str:
    return each["name"] if isinstance(each, dict) else f"{each.fault}, {each.question}"


def texts(value: Any) -> list[str]:
    return [text for each in value for text in texts(each)] if isinstance(value, list) else [value]


# The file.


def test_the_file_is_of_its_schema_and_small() -> None:
    """The file has a hundred questions and three hundred wrong answers; six files have two megabytes."""
    schema = json.loads((PUBLISHED / "schema.json").read_text(encoding="utf-8"))
    assert not [*Draft202012Validator(schema).iter_errors(vectors())]
    assert (len(asked()), len(wrong())) == (100, 300)
    files = [*PUBLISHED.iterdir()]
    assert len(files) <= 6
    assert sum(file.stat().st_size for file in files) <= 2e6


@pytest.mark.parametrize("reader", TOLERANCES)
def test_a_reader_is_short(reader: str) -> None:
    """It has 60 lines at most."""
    assert len((PUBLISHED / reader).read_text(encoding="utf-8").splitlines()) <= 60


def test_every_number_of_a_question_is_a_double() -> None:
    """The decimal text and the hexadecimal of each number are one number, which the scene has too."""
    for question in asked().values():
        for part in ("body", "initial", "time"):
            for numbers in question["question"][part].values():
                values = [float(text) for text in texts(numbers["text"])]
                assert values == [float.fromhex(text) for text in texts(numbers["hex"])]
                assert all(value * 2**10 % 1 == 0 for value in values)


def test_every_kind_of_fault_is_there() -> None:
    """Times, frames, starts, methods, terms, laws that nobody knows and files are all among the faults.

    So are written loads and states of one's own, by their questions; a third is in a fluid.
    """
    families = {"times", "frames", "starts", "methods", "terms", "sound", "files"}
    assert {each.family for each in wrong()} == families
    kinds = Counter(asked()[each.question]["kind"] for each in wrong())
    assert {"free", "wheels", "moment", "timed", "pulsed", "lagging", "sampled"} <= kinds.keys()
    assert all(kinds[name] >= 3 for name in IN_WATER)
    assert sum(kinds[name] for name in ("fluid", "driven", *IN_WATER)) >= 95


# What is expected.


def sort_of(question: Any) -> tuple[bool, ...]:
    """Return the parts of a scene that make its sort: a fluid, wheels, written loads, states."""
    words = ('"kirchhoff"', "rotor =", "[states]")
    return *(word in question["scene"] for word in words), bool(WRITTEN.search(question["scene"]))


@pytest.mark.parametrize("question", by_turns([*asked().values()], 100, sort_of), ids=named)
def test_the_right_answer_passes(question: Any, tmp_path: Path) -> None:
    """`check` accepts the rows of the truth in f64, without a tolerance, and no cause is named."""
    columns = {k: v for k, v in question["truth"]["columns"].items() if k != "radius"}
    file = tmp_path / "right.json"
    file.write_text(json.dumps(columns), encoding="utf-8")
    judgement = taylor_verify.check(read(question["scene"], question["name"]), str(file))
    assert judgement.passed
    assert not judgement.causes


@pytest.mark.parametrize("each", by_turns(wrong(), 300, lambda each: each.family), ids=named)
def test_check_says_what_is_expected(each: Wrong) -> None:
    """The verdict is the expected one, a named cause has an expected word and none has a false one."""
    words = judged(asked()[each.question]["scene"], each.answer)
    assert words.meets(each), words


def test_expectations_can_fail() -> None:
    """An answer is no other fault: the words of each are false for the next family."""
    each = next(each for each in wrong() if each.fault == "scalar last")
    words = judged(asked()[each.question]["scene"], each.answer)
    other = Wrong(each.question, "RK4", "methods", {}, "fail", ("RK4",), never=("scalar last",))
    assert not words.meets(other)
    assert "scalar last" in forbidden("RK4", ("RK4", "attitude"))


@pytest.mark.slow
def test_a_seed_makes_the_published_vectors() -> None:
    """Questions and answers are drawn again from the seed of the file."""
    drawn: list[Question] = questions(vectors()["seed"])
    assert answered(drawn[0]) == vectors()["questions"][0]
    made, false = wrong_answer(vectors()["seed"], 0)
    assert made is not None
    assert json.loads(json.dumps(asdict(made))) == vectors()["wrong"][0]
    assert not false


# The readers.


def command(reader: Path, folder: Path, quickly: bool) -> list[str]:
    """The command that runs a reader, which is compiled first where it must be: well, or quickly."""
    rustc = shutil.which("rustc") or shutil.which("rustc", path=Path.home() / ".cargo" / "bin")
    speed = "-O0" if quickly else "-O2"
    makers: dict[str, list[str | None]] = {
        ".cpp": [shutil.which("g++"), "-std=c++17", speed, "-Wall", "-Wextra", "-Werror"],
        ".rs": [rustc, *(() if quickly else ("-O",)), "-D", "warnings"],
        ".mjs": [shutil.which("node")],
        ".m": [shutil.which("octave"), "-q"],
    }
    program, *options = makers[reader.suffix]
    if program is None:
        pytest.skip(f"nothing here runs {reader.name}")
    words = [program, *map(str, options), str(reader)]
    if reader.suffix in (".mjs", ".m"):
        return words
    subprocess.run([*words, "-o", str(folder / "reader")], check=True, cwd=folder)
    return [str(folder / "reader")]


def ran(reader: Path, folder: Path, few: Path | None = None) -> tuple[int, str]:
    words = command(reader, folder, quickly=few is not None)
    words += [str(few or PUBLISHED / "vectors.json"), TOLERANCES[reader.name]]
    run = subprocess.run(words, capture_output=True, text=True, check=False)
    return run.returncode, run.stdout


@pytest.mark.parametrize(
    "name",
    [pytest.param(n, marks=() if n == "reader.mjs" else pytest.mark.slow) for n in TOLERANCES],
)
def test_a_reader_compares_its_solver_with_the_truth(name: str, tmp_path: Path) -> None:
    """The solver of each reader is right on all free bodies, with wheels and constant moments too."""
    status, printed = ran(PUBLISHED / name, tmp_path)
    kinds = [question["kind"] for question in asked().values()]
    tried = sum(kind in ("free", "wheels", "moment") for kind in kinds)
    assert status == 0
    assert f"{tried} right, 0 wrong" in printed


@pytest.mark.parametrize(
    ("name", "term", "twin"),
    [
        pytest.param("reader.cpp", "cross(H, w)", "cross(w, H)", marks=pytest.mark.slow),
        ("reader.mjs", "cross(H, w)", "cross(w, H)"),
        ("reader.rs", "cross(&momentum, w)", "cross(w, &momentum)"),
        ("reader.m", "cross(inertia * w + rotor, w)", "cross(w, inertia * w + rotor)"),
    ],
)
def test_a_reader_finds_a_wrong_solver(name: str, term: str, twin: str, tmp_path: Path) -> None:
    """The gyroscopic term with the other sign is wrong at the first question, and the status is 1."""
    text = (PUBLISHED / name).read_text(encoding="utf-8")
    assert text.count(term) == 1
    reader = tmp_path / name
    few = tmp_path / "few.json"
    lines = (PUBLISHED / "vectors.json").read_text(encoding="utf-8").splitlines()
    first = next(line for line in lines if '"kind":"free"' in line)
    few.write_text(f'{{"questions": [\n{first.rstrip(",")}\n]}}', encoding="utf-8")
    if name == "reader.m":
        # All questions are asked of it in a slow test alone.
        status, printed = ran(PUBLISHED / name, tmp_path, few)
        assert (status, "1 right, 0 wrong" in printed) == (0, True)
    reader.write_text(text.replace(term, twin), encoding="utf-8")
    status, printed = ran(reader, tmp_path, few)
    assert status == 1
    assert "0 right, 1 wrong" in printed
