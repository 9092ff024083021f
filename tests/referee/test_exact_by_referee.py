"""`taylor-verify exact` by a referee that shares nothing with it."""

from __future__ import annotations

import ast
import copy
import sys
from collections.abc import Callable, Iterator
from fractions import Fraction
from pathlib import Path
from typing import Any, Final

import pytest

from referee.command import Command
from referee.comparison import faults
from referee.draws import draw
from referee.judged import judged, judgement

HERE: Final = Path(__file__).parent
MOST_REFUSED: Final = Fraction(2, 100)
FEW: Final = 40

SCENE: Final = """
title = "A body"
model = "{model}"
track = {track}
[body]
{body}
[initial]
{initial}
[time]
end = 1
samples = 2
"""


@pytest.fixture(scope="module")
def command(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Command]:
    """One child process for all questions of this file."""
    with Command(tmp_path_factory.mktemp("referee")) as child:
        yield child


# The referee shares nothing with what it judges.


def imported(source: str) -> set[str]:
    """Return the first part of the name of every module that a text imports."""
    names = set()
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        if isinstance(node, ast.ImportFrom):
            names.add(node.module or ".")
    return {name.partition(".")[0] for name in names}


@pytest.mark.parametrize("file", sorted(HERE.glob("*.py")), ids=lambda file: file.stem)
def test_the_referee_imports_the_standard_library_and_gmpy2_alone(file: Path) -> None:
    """No module of the referee imports the package that it judges, nor what the package is made of."""
    allowed = {*sys.stdlib_module_names, "gmpy2", "pytest", "referee"}
    assert imported(file.read_text(encoding="utf-8")) <= allowed


# The command.


@pytest.mark.parametrize("count", [FEW, pytest.param(5000, marks=pytest.mark.slow)])
def test_drawn_scenes_are_answered_as_the_referee_finds(command: Command, count: int) -> None:
    """Each printed number is within one unit of its last digit, and each radius holds."""
    verdicts = list(judged(command, range(count)))
    wrong = [verdict for verdict in verdicts if verdict.faults]
    refused = [verdict for verdict in verdicts if verdict.refusal]
    assert not wrong, "\n".join([f"{len(wrong)} of {count} answers are wrong", *map(str, wrong)])
    assert len(refused) <= MOST_REFUSED * count, "\n".join(map(str, refused))


def test_a_refused_scene_counts_as_refused(command: Command) -> None:
    """A body that the reader does not accept is no answer that agrees."""
    question = draw(0)._replace(text=draw(0).text.replace("inertia = [", "inertia = [-"))
    assert "exit 2: " in (judgement(question, command.exact(*question.asked)).refusal or "")


# The comparison must catch what is planted.

SPINNING: Final = SCENE.format(
    model="euler",
    track='["attitude"]',
    body="inertia = [1, 2, 3]",
    initial="omega = [0.3, 1, 0.2]\nattitude = [1, 2, 3, 4]",
)
STEADY: Final = SCENE.format(
    model="euler", track='["attitude"]', body="inertia = [1, 2, 3]", initial="omega = [0, 0, 1]"
)
Document = dict[str, Any]


def changed_digit(row: Document) -> None:
    """Count the digit at place 39 up by one; nine becomes eight."""
    text = row["omega"][1]
    digit = int(text[-2])
    row["omega"][1] = f"{text[:-2]}{digit + 1 if digit < 9 else 8}{text[-1]}"


def small_radius(row: Document) -> None:
    row["radius"] = "1e-42"


def empty_radius(row: Document) -> None:
    row["radius"] = "1"


def short_number(row: Document) -> None:
    row["omega"][2] = row["omega"][2][:20]


def zero(row: Document) -> None:
    row["omega"][2] = "0"


def wide_zero(row: Document) -> None:
    row["omega"][2], row["absolute"] = "0", {"omega": "10"}


def narrow_zero(row: Document) -> None:
    row["omega"][2], row["absolute"] = "0", {"omega": "1e-41"}


def without_attitude(row: Document) -> None:
    del row["attitude"]


def short_vector(row: Document) -> None:
    row["omega"].pop()


def other_time(row: Document) -> None:
    row["t"] = "1"


def noise(row: Document) -> None:
    row["attitude"][0][2] = "3.141592653589793238462643383279502884197e-50"


@pytest.fixture(scope="module")
def answers(command: Command) -> dict[str, Document]:
    """Answers to forty digits, in which the referee finds no fault."""
    documents = {text: command.exact(text, ["2"], 40).document for text in (SPINNING, STEADY)}
    for text, document in documents.items():
        assert faults(text, ["2"], 40, document) == []
    return documents


@pytest.mark.parametrize(
    ("plant", "reason"),
    [
        (changed_digit, "more than one unit of the last digit"),
        (small_radius, "smaller than the error"),
        (empty_radius, "larger than one unit"),
        (short_number, "fewer digits"),
        (zero, "not zero"),
        (wide_zero, "too large to say anything"),
        (narrow_zero, "larger than the bound"),
        (without_attitude, "not the tracked quantities"),
        (short_vector, "not so many components"),
        (other_time, "not at the times asked for"),
    ],
)
def test_a_planted_fault_is_caught(
    answers: dict[str, Document], plant: Callable[[Document], None], reason: str
) -> None:
    """A change of an answer of forty digits is found, with its reason."""
    document = copy.deepcopy(answers[SPINNING])
    plant(document["rows"][0])
    assert reason in str(faults(SPINNING, ["2"], 40, document)[0])


def test_noise_in_place_of_zero_is_caught(answers: dict[str, Document]) -> None:
    """Forty digits of a rounding error are forty wrong digits."""
    document = copy.deepcopy(answers[STEADY])
    noise(document["rows"][0])
    (fault, *_) = faults(STEADY, ["2"], 40, document)
    assert (fault.quantity, fault.component) == ("attitude", "[0][2]")


def test_a_fault_says_where_it_is(answers: dict[str, Document]) -> None:
    """A fault names time, quantity and component, the printed number and the right one."""
    document = copy.deepcopy(answers[SPINNING])
    changed_digit(document["rows"][0])
    (fault, *_) = faults(SPINNING, ["2"], 40, document)
    shown, right = (d["rows"][0]["omega"][1] for d in (document, answers[SPINNING]))
    assert str(fault).startswith("omega[1] at t = 2: ")
    assert f"printed {shown}\n" in str(fault)
    # The last digits printed are rounded.
    assert f"right   {right[:35]}" in str(fault)
