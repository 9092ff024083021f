"""Families of scenes: what a template draws, that it can be repeated, and what is refused."""

from __future__ import annotations

import re
from decimal import Decimal
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from taylor_verify.records.faults import Refused
from taylor_verify.scenes.families.cube import Spread, places
from taylor_verify.scenes.families.distributions import Draw, number_text
from taylor_verify.scenes.families.family import Family
from taylor_verify.scenes.families.formula import formula
from taylor_verify.scenes.families.shipped import family, family_names
from taylor_verify.scenes.families.template import load_family, read_family
from taylor_verify.scenes.loads.steps import NoStep
from taylor_verify.scenes.reading.reader import read
from taylor_verify.scenes.reading.table import exact_number

REST = """
[initial]
omega = [1, 0.5, 0.25]
[time]
end = 1
samples = 2
"""


def template(body: str, sweep: str = "", rest: str = REST) -> Family:
    """The family of a template with this body."""
    text = f'title = "Drawn"\nmodel = "euler"\n{sweep}\n[body]\n{body}\n{rest}'
    return read_family(text, "drawn")


# What is drawn.


@given(st.floats(0, 1))
def test_a_draw_is_a_decimal_of_so_many_digits(share: float) -> None:
    """A drawn number has at most the digits asked for, and lies between the bounds, ends included."""
    for kind in ("uniform", "log_uniform"):
        value = Draw(kind, (Decimal("0.001"), Decimal(30)), 4).value(share)
        assert len(value.as_tuple().digits) <= 4
        assert Decimal("0.001") <= value <= 30


def test_distributions_have_their_middles() -> None:
    """A share of a half is the mean, the geometric mean, the mean, the later of two choices."""
    two = (Decimal("0.01"), Decimal(4))
    middles = {
        kind: Draw(kind, two, 9).value(0.5)
        for kind in ("uniform", "log_uniform", "normal", "choice")
    }
    assert middles == {
        "uniform": Decimal("2.005"),
        "log_uniform": Decimal("0.2"),
        "normal": Decimal("0.01"),
        "choice": Decimal(4),
    }


@given(st.fractions())
def test_a_number_reads_back_as_it_was(value: Fraction) -> None:
    """The text of a rational in a scene is that rational, as a decimal where it has one."""
    text = number_text(value)
    assert exact_number(text.strip('"') if text.startswith('"') else Decimal(text)) == value


def test_the_refusal_of_a_drawn_scene_has_the_number_of_its_file() -> None:
    """The fault of a drawn scene shows the number as its scene file has it."""
    drawn = template("inertia = [{ uniform = [-1, 1] }, 1, 1]", "[sweep]\ndigits = 3")
    assert "inertia = [-0.754, 1, 1]" in drawn.text([0.123])
    with pytest.raises(Refused, match=r"inertia, got -0\.754 @ body\.inertia\[0\]"):
        drawn.scene([0.123])


@pytest.mark.parametrize("spread", Spread)
def test_a_point_is_the_same_in_every_cut(spread: Spread) -> None:
    """Points asked for one by one, in parts, or all at once are equal; another seed has others."""
    whole = places(spread, 5, 3, 0, 40)
    parts = np.concatenate([places(spread, 5, 3, k, k + 8) for k in range(0, 40, 8)])
    singly = np.concatenate([places(spread, 5, 3, k, k + 1) for k in (0, 7, 39)])
    assert np.array_equal(whole, parts)
    assert np.array_equal(whole[[0, 7, 39]], singly)
    assert not np.array_equal(whole, places(spread, 5, 4, 0, 40))
    assert whole.min() >= 0
    assert whole.max() < 1


def test_a_random_point_is_that_of_any_machine() -> None:
    """The first numbers of seed 1 are these: a dataset can be drawn again years later."""
    first = places(Spread.RANDOM, 3, 1, 0, 1)[0].tolist()
    assert first == [0.3035680343067586, 0.8487087496857769, 0.1561347780434731]


# Formulas.


def test_a_formula_is_exact() -> None:
    """0.1 is one tenth, and + - * / and powers of rationals are rationals."""
    value = formula("-(a + 0.1)**2 / 3").value({"a": Fraction(1, 5)})
    assert value == Fraction(-3, 100)


def test_functions_are_rounded_to_twenty_digits() -> None:
    """sqrt, log and exp are the nearest decimals of twenty digits."""
    assert formula("sqrt(2)").value({}) == Fraction("1.4142135623730950488")
    assert formula("log(2)").value({}) == Fraction("0.69314718055994530942")
    assert formula("exp(1)").value({}) == Fraction("2.7182818284590452354")


@pytest.mark.parametrize(
    "text",
    [
        *("1/a", "sqrt(a - 1)", "log(a)", "exp(1e9)", "((2**20)**20)**20 + exp(1e4)"),
        *("__import__('os')", "a.b", "f(a)", "True", "", "2 a", 3),
    ],
)
def test_what_has_no_value_or_is_no_formula_is_refused(text: object) -> None:
    """A division by zero, a function outside its domain, and a text that is no expression of loads."""
    with pytest.raises(NoStep, match="expected"):
        formula(text).value({"a": Fraction(0)})


def test_a_formula_may_use_all_that_loads_do() -> None:
    """Other functions, powers, and conditions on numbers."""
    numbers = {"a": Fraction(1, 2), "b": Fraction(3)}
    assert formula("a^64").value(numbers) == Fraction(1, 2**64)
    assert formula("b^a").value(numbers) == Fraction("1.7320508075688772935")
    assert formula("atan2(b, a) + 0*sin(b)").value(numbers) == Fraction("1.4056476493802697810")
    assert formula("norm(b, 4) if a < b else a").value(numbers) == 5


# Templates.


def test_a_template_writes_scenes() -> None:
    """Numbers stand where their tables stood; formulas use those above, and a unit follows its number."""
    rest = REST.replace("[1, 0.5, 0.25]", '[{ grid = [2, 3], unit = "deg/s" }, "0", "0"]')
    drawn = template(
        'inertia = [{ formula = "a" }, { uniform = [1, 3] }, { formula = "a / 3" }]',
        "[sweep]\ndigits = 3\n[sweep.numbers]\na = { uniform = [1, 2] }",
        rest,
    )
    assert (drawn.free, drawn.nodes) == (2, 2)
    text = drawn.text([0.25, 0.5], 1)
    assert 'inertia = [1.25, 2, "5/12"]' in text
    assert 'omega = ["3 deg/s", "0", "0"]' in text
    assert "sweep" not in text
    read(text, "written")


def test_the_constants_of_loads_are_drawn() -> None:
    """A definition, and the interval and the start of a held state, are numbers like any other."""
    drawn = template(
        'inertia = [1, 2, 2]\nmoment = ["-k*w1 + m", 0, 0]',
        "[sweep]\ndigits = 3",
        "[define]\nk = { uniform = [1, 2] }\n[states]\n"
        'm = { every = { uniform = [0.2, 0.4] }, start = { uniform = [0, 1] }, value = "-w1" }\n'
        + REST,
    )
    loads = read(drawn.text([0.5, 0.5, 0.25], 1), "written").body.loads
    assert loads is not None
    assert dict(loads.definitions) == {"k": Fraction(3, 2)}
    (sampled,) = loads.states
    assert (sampled.every, sampled.start) == (Fraction(3, 10), (Fraction(1, 4),))


FAULTY = """
titel = "x"
model = "euler"
[sweep]
count = 0
seeds = 7
points = "halton"
[sweep.numbers]
a = { unifrom = [1, 2] }
b = { uniform = [2, 1] }
c = { formula = "q" }
d = 3
e = { normal = [0, 0] }
f = { uniform = [1, 2] }
h = { log_uniform = [0, 1] }
i = { uniform = [1.0000001, 2] }
m = { uniform = [1, 2], grid = [1] }
n = { normal = [1, 2, 2.5] }
[body]
inertia = [{ uniform = [1, 2], unit = 3 }, { gird = [2, 3] }, 4, 4]
[initial]
omega = [{ formula = "a + b + c + d + e + h + i + m + n" }, true, 1]
[time]
end = 0
samples = 5
"""


def test_all_faults_of_a_template_are_named_at_once() -> None:
    """Those of [sweep], of every number, and those of the scene that no faulty number can have caused."""
    with pytest.raises(Refused) as refused:
        read_family(FAULTY, "faulty")
    paths = [fault.rpartition(" @ ")[2].partition(" (")[0] for fault in refused.value.faults]
    assert paths == [
        *("sweep.count", "sweep.points", "sweep.seeds"),
        *("sweep.numbers.a", "sweep.numbers.b.uniform", "sweep.numbers.c.formula"),
        *("sweep.numbers.d", "sweep.numbers.e.normal", "sweep.numbers.h.log_uniform"),
        *("sweep.numbers.i.uniform", "sweep.numbers.m", "sweep.numbers.n.normal"),
        *("body.inertia[0].unit", "body.inertia[1]"),
        *("title", "initial.omega[1]", "time.end", "titel"),
    ]


def refusal_of(body: str, sweep: str = "", rest: str = REST) -> tuple[str, ...]:
    """The faults of a template with this body, which is refused."""
    with pytest.raises(Refused) as refused:
        template(body, sweep, rest)
    return refused.value.faults


def test_a_template_of_which_no_point_is_a_scene_is_refused() -> None:
    """The only fault says how many trial bodies were refused, shows one in decimals, and how to mend it."""
    (fault,) = refusal_of("inertia = [{ uniform = [-2, -1] }, 1, 1]")
    assert re.fullmatch(
        r"expected numbers of which some make a body, got 512 refused trial bodies, for example: "
        r"expected a positive moment of inertia, got -1\.\d+ @ body\.inertia\[0\] "
        r"\(widen or move the range\)",
        fault,
    )


def test_a_template_with_rare_bodies_is_accepted() -> None:
    """A template of which 2 % of the points are bodies is accepted, because there are many trial bodies."""
    drawn = template("inertia = [{ uniform = [-2, 0.05] }, 1, 1]")
    assert drawn.scene([0.99])
    with pytest.raises(Refused, match="positive moment of inertia"):
        drawn.scene([0.5])


def test_all_points_of_a_small_grid_are_tried() -> None:
    """A grid of which only the last point is a body is accepted; a grid without a body names its size."""
    values = ", ".join(map(str, range(-299, 2)))
    assert template(f"inertia = [{{ grid = [{values}] }}, 1, 1]").nodes == 301
    (fault,) = refusal_of("inertia = [{ grid = [-1.5, -2] }, { grid = [1] }, 1]")
    assert "got 2 refused trial bodies, for example: " in fault
    assert fault.endswith("got -1.5 @ body.inertia[0] (add other numbers)")
    (fault,) = refusal_of("inertia = [{ grid = [-1] }, 1, 1]")
    assert "got 1 refused trial body, for example: " in fault


def test_trial_bodies_come_from_all_parts_of_a_large_grid() -> None:
    """A grid of 2000 points of which the second half are bodies is accepted."""
    first, second = f"{{ grid = {[*range(1, 1001)]} }}", "{ grid = [-1, 1] }"
    assert template(f"inertia = [{first}, {second}, 1]").nodes == 2000
    assert template(f"inertia = [{second}, {first}, 1]").nodes == 2000


def test_a_fault_of_the_scene_stands_without_trial_bodies() -> None:
    """Faults that no drawn number causes are named alone, even where most points are no body."""
    rest = REST.replace("end = 1", "end = 0")
    faults = refusal_of("inertia = [{ uniform = [-2, 0.05] }, 1, 1]", rest=rest)
    assert [fault.rpartition(" @ ")[2] for fault in faults] == ["time.end (the time span is empty)"]
    (fault,) = refusal_of("inertia = [{ uniform = [1, 2] }, 1]")
    assert re.fullmatch(r"expected 3 numbers, got \[.*\] @ body\.inertia", fault)


def test_a_long_template_has_fewer_trial_bodies() -> None:
    """A template of 100 kB that makes no body is refused after 16 trial bodies."""
    instants = ", ".join(f"{k}.{'0' * 400}" for k in range(1, 250))
    long = REST.replace("end = 1\nsamples = 2", f"at = [{instants}]")
    (fault,) = refusal_of("inertia = [{ uniform = [-2, -1] }, 1, 1]", rest=long)
    assert "got 16 refused trial bodies" in fault


DISTRIBUTIONS = "uniform, log_uniform, normal, choice, grid, formula"


@pytest.mark.parametrize(
    ("body", "place"),
    [
        ("inertia = [{ triangular = [1, 2] }, { uniform = [1, 2] }, 1]", "body.inertia[0]"),
        (
            "inertia = [[{ uniform = [1, 2] }, 0, 0], [0, { cauchy = [1], unit = 1 }, 0], [0, 0, 1]]",
            "body.inertia[1][1]",
        ),
        ("inertia = [1, 1, 1]\ndamping = { weibull = [1, 2] }", "body.damping"),
    ],
)
def test_an_unknown_distribution_is_answered_with_all_names(body: str, place: str) -> None:
    """A table in place of a number is answered with all distributions, even if it resembles none."""
    (word,) = re.findall("triangular|cauchy|weibull", body)
    assert refusal_of(body) == (f"expected one of {DISTRIBUTIONS}, got `{word}` @ {place}",)


def test_a_misspelt_distribution_is_answered_with_the_near_one() -> None:
    """A misspelt distribution or unit is answered with the word that was meant."""
    assert refusal_of("inertia = [{ unifrom = [1, 2] }, 1, 1]") == (
        f"expected one of {DISTRIBUTIONS}, got `unifrom` @ body.inertia[0] (did you mean `uniform`?)",
    )
    assert refusal_of("inertia = [{ uniform = [1, 2], units = 1 }, 1, 1]") == (
        "expected at most `unit` beside `uniform`, got `units` @ body.inertia[0] "
        "(did you mean `unit`?)",
    )


@pytest.mark.parametrize(
    "rule",
    [
        '{ formula = "a**65" }',
        '{ formula = "2 a" }',
        '{ formula = "2 * a + q" }',
        '{ formla = "2 * a" }',
        '{ expression = "2 * a" }',
    ],
)
def test_a_faulty_formula_is_one_fault(rule: str) -> None:
    """A formula that cannot be read is one fault, at its place."""
    numbers = "[sweep.numbers]\na = { uniform = [1, 2] }"
    (fault,) = refusal_of(f"inertia = [{rule}, 1, 1]", numbers)
    assert "body.inertia[0]" in fault


def test_a_plain_scene_is_no_template() -> None:
    """A file in which nothing is drawn is refused, with an example of what could be."""
    with pytest.raises(
        Refused, match=r"expected a number that is drawn, got none @ drawn \(\{ uniform"
    ):
        template("inertia = [1, 2, 3]")


@pytest.mark.parametrize("text", ["title =", 'title = "nothing is drawn"', None])
def test_a_fault_of_the_whole_text_names_the_file(text: str | None, tmp_path: Path) -> None:
    """A fault without a place of its own, and a missing file, stand beside the path of the template."""
    file = tmp_path / "mine.toml"
    if text is not None:
        file.write_text(text)
    fault = "no such file " if text is None else ""
    with pytest.raises(Refused, match=rf"{fault}@ {re.escape(str(file))}"):
        load_family(file)


# The shipped families.


@pytest.mark.parametrize("name", family_names())
def test_every_point_of_a_shipped_family_is_a_scene(name: str) -> None:
    """Random points and both corners of the cube are scenes; the file says why it is there."""
    shipped = family(name)
    assert shipped.source.startswith("# Why: ")
    for place in [
        [0.0] * shipped.free,
        [1.0] * shipped.free,
        *places(Spread.RANDOM, shipped.free, 1, 0, 4),
    ]:
        assert shipped.scene(place).title == shipped.title


def test_an_unknown_family_is_refused_with_a_near_one() -> None:
    """A misspelt name is answered with the name that was meant."""
    with pytest.raises(Refused, match=r"got satelites \(did you mean satellites\?\)"):
        family("satelites")


@settings(max_examples=30)
@given(st.lists(st.floats(0, 1), min_size=7, max_size=7))
def test_near_separatrix_is_near_it(place: list[float]) -> None:
    """H^2 differs from 2 T I2 by a part of order `off`, and the moments are in their order."""
    drawn = family("near-separatrix")
    numbers = drawn.numbers(place)
    i1, i2, i3 = 1, numbers["i2"], numbers["i3"]
    one, three = numbers["s"] * numbers["third"], numbers["third"]
    assert i1 < i2 < i3
    assert one**2 * i1 * (i2 - i1) == three**2 * i3 * (i3 - i2)
