"""`taylor-verify exact` by a referee that shares nothing with it, and that referee by textbook formulas."""

from __future__ import annotations

import ast
import copy
import subprocess
import sys
from collections.abc import Callable, Iterator
from fractions import Fraction
from operator import mul, sub
from pathlib import Path
from typing import Any, Final

import gmpy2
import pytest
from gmpy2 import cos, cosh, exp, log, mpfr, sin, sqrt, tanh

from referee.bodies import rotation
from referee.command import Command
from referee.comparison import faults
from referee.draws import KINDS, draw
from referee.judged import judged, judgement
from referee.lamb import lamb_integral
from referee.motion import Row, motion

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


def test_a_process_that_judges_has_not_loaded_the_package() -> None:
    """No detour leads from the comparison to taylor_verify."""
    modules = "referee.judged, sys; print([m for m in sys.modules if 'taylor_verify' in m])"
    run = [sys.executable, "-c", f"import {modules}"]
    shown = subprocess.run(run, cwd=HERE.parent, capture_output=True, text=True, check=True)
    assert shown.stdout == "[]\n"


# The referee against formulas of the textbooks.


def alone(body: str, initial: str, at: Fraction, track: str = '["omega"]', bits: int = 150) -> Row:
    """Return what the referee says about one time."""
    model = "euler" if "omega =" in initial else "kirchhoff"
    text = SCENE.format(model=model, track=track, body=body, initial=initial)
    return motion(text, [at], bits)[0]


def are_near(row: Row, name: str, formula: list[Any], digits: int = 38) -> bool:
    """Return True if a vector is that of a formula, and is known to as many digits."""
    return all(
        known.digits >= digits and abs(known.value - value) <= abs(value) / 10**digits
        for known, value in zip(row[name], formula, strict=True)
    )


def test_an_axisymmetric_body_precesses() -> None:
    """Omega turns about axis 3 at the rate (C - A)/A w3."""
    row = alone("inertia = [2, 2, 3]", "omega = [1, 0, 4]", Fraction(7, 3))
    with gmpy2.context(precision=150):
        angle = mpfr(Fraction(14, 3))
        assert are_near(row, "omega", [cos(angle), sin(angle), mpfr(4)])


def test_a_separatrix_is_a_hyperbolic_secant() -> None:
    """The body goes to its middle axis as sech and tanh go, where |H|^2 = 2 T I2."""
    # Here |H|^2 = 9/16 + 81/16 and 2 T = 9/16 + 9/4.
    row = alone('inertia = [1, 2, "9/4"]', "omega = [0.75, 0, 1]", Fraction(3, 2))
    with gmpy2.context(precision=150):
        # w2 tends to sqrt(2 T/I2); its rate at the start is (I3 - I1)/I2 w3 w1.
        limit = sqrt(mpfr(Fraction(45, 32)))
        rate = mpfr(Fraction(5, 8) * Fraction(3, 4)) / limit
        s = rate * mpfr(Fraction(3, 2))
        assert are_near(row, "omega", [mpfr("0.75") / cosh(s), limit * tanh(s), 1 / cosh(s)])


def test_damping_is_a_change_of_time() -> None:
    """Damping c makes omega(t) exp(-c t) times the free omega at (1 - exp(-c t))/c."""
    body, initial, t = "inertia = [1, 2, 4]", "omega = [1, -1, 0.5]", Fraction(2)
    damped = alone(f"{body}\ndamping = 0.25", initial, t)
    with gmpy2.context(precision=150):
        factor = exp(mpfr("-0.5"))
        free = alone(body, initial, Fraction(*map(int, ((1 - factor) * 4).as_integer_ratio())))
        assert are_near(damped, "omega", [factor * known.value for known in free["omega"]])


MASSES: Final = """mass_matrix = [
  [5, 1, 0, 0, 1, 0], [1, 6, 0, 0, 0, 1], [0, 0, 4, 1, 0, 0],
  [0, 0, 1, 3, 0, 0], [1, 0, 0, 0, 2, 0], [0, 1, 0, 0, 0, 4],
]"""
STARTED: Final = """linear_impulse = [1, 2, 3]
angular_impulse = [2, 0, -1]
attitude = [1, 2, 0, -1]
centre = [1, 1, 0]"""


def in_space(attitude: list[list[Any]], centre: list[Any], x: list[Any], y: list[Any]) -> list[Any]:
    """Return R x and R y + centre x R x: the impulse, and its moment about a point of space."""
    x, y = ([sum(map(mul, row, v)) for row in attitude] for v in (x, y))
    c = centre
    return x + [y[i] + c[i - 2] * x[i - 1] - c[i - 1] * x[i - 2] for i in range(3)]


def test_the_impulse_and_its_moment_stand_still_in_space() -> None:
    """R x and R y + centre x R x stay what they are at the start, for 21 coefficients."""
    row = alone(MASSES, STARTED, Fraction(2), '["centre"]')
    start = rotation([Fraction(n) for n in (1, 2, 0, -1)])
    before = in_space(start, [1, 1, 0], [1, 2, 3], [2, 0, -1])
    with gmpy2.context(precision=150):
        x, y, centre, r = (
            [known.value for known in row[name]]
            for name in ("linear_impulse", "angular_impulse", "centre", "attitude")
        )
        after = in_space([r[:3], r[3:6], r[6:]], centre, x, y)
        assert max(map(abs, map(sub, after, before))) <= mpfr("1e-38")


def test_lambs_integrals_are_those_of_a_sphere_and_of_a_prolate_spheroid() -> None:
    """Lamb's alpha is 2/3 in a sphere and 2 (1 - e^2)/e^3 (artanh e - e) along the axis of a spheroid."""
    with gmpy2.context(precision=300):
        near = mpfr("1e-85")
        assert abs(lamb_integral([4, 4, 4], [0]) - mpfr(2) / 3) <= near
        e = sqrt(mpfr(3)) / 2
        alpha = 2 * (1 - e**2) / e**3 * (log((1 + e) / (1 - e)) / 2 - e)
        assert abs(lamb_integral([4, 1, 1], [0]) - alpha) <= near


# The command.


@pytest.mark.parametrize("count", [FEW, pytest.param(5000, marks=pytest.mark.slow)])
def test_drawn_scenes_are_answered_as_the_referee_finds(command: Command, count: int) -> None:
    """Each printed number is within one unit of its last digit, and each radius holds."""
    verdicts = list(judged(command, range(count)))
    wrong = [verdict for verdict in verdicts if verdict.faults]
    refused = [verdict for verdict in verdicts if verdict.refusal]
    assert not wrong, "\n".join([f"{len(wrong)} of {count} answers are wrong", *map(str, wrong)])
    assert len(refused) <= MOST_REFUSED * count, "\n".join(map(str, refused))


def test_every_kind_is_drawn_at_every_precision() -> None:
    """The few questions that are always asked are of all kinds, with 10, 40 and 200 digits."""
    questions = [draw(number) for number in range(FEW)]
    assert {question.kind for question in questions} == {kind.__name__ for kind in KINDS}
    assert {question.digits for question in questions} == {10, 40, 200}


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
