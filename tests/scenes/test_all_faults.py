"""All faults of a scene come at once, and what depends on one of them is no second fault."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import pytest
from builders.scenes import faults_of

from taylor_verify.scenes.loads.states import Held
from taylor_verify.scenes.reading.reader import load

TEXTS = 'inertia = [1, 2, 3]\nmoment = ["foo", "sign(w1)", "1/(2 - 2)*w2"]'
CYCLE = 'a = "b"\nb = "a"'
OF_TEXTS = [
    "body.moment[0], column 1", "body.moment[1], column 1", "body.moment[2], column 1",
    "define.b, column 1",
]  # fmt: skip


def places(body: str = TEXTS, define: str = CYCLE, top: str = 'model = "euler"') -> list[str]:
    """The places of all faults, sorted."""
    lines = faults_of(body, "omega = [1, 2, 0]", f"[define]\n{define}", top=top)
    return sorted(line.rpartition(" @ ")[2].split(" (")[0] for line in lines)


@pytest.mark.parametrize(
    ("tables", "place"),
    [
        ('[tables]\nm = { times = [0, 1], values = [1], kind = "hold" }', "tables.m"),
        ("[space]\no = [1, 2]", "space.o"),
        ("[states]\nh = { start = 1 }", "states.h.rate"),
        ('[states]\nh = { start = 1, rate = ["w1", "w2"] }', "states.h.start"),
        ('[states]\nh = { every = 0, value = "1" }', "states.h.every"),
    ],
)
def test_a_fault_of_a_shape_hides_no_fault_of_a_text(tables: str, place: str) -> None:
    """Neither do tables, vectors and states with faults hide the cycles of [define]."""
    assert places(define=f"{CYCLE}\n{tables}") == sorted([*OF_TEXTS, place])


@pytest.mark.parametrize(
    ("body", "place"),
    [
        ("weight = { force = [1, 2] }", "body.weight.force"),
        ("buoyancy = 3", "body.buoyancy"),
        ('rotor = ["t"]', "body.rotor"),
        ("damping = nan", "body.damping"),
    ],
)
def test_a_fault_of_the_body_hides_no_fault_of_a_text(body: str, place: str) -> None:
    """Weight and buoyancy in particular."""
    assert places(f"{TEXTS}\n{body}") == sorted([*OF_TEXTS, place])


def test_texts_in_a_vector_of_another_length_are_examined() -> None:
    """The faults of texts in loads and in [space] come together with those of their shapes."""
    tables = '[space]\no = ["cos(t)", "bar"]'
    body = 'inertia = [1, 2, 3]\nmoment = ["foo", "o1"]'
    assert places(body, tables) == [
        "body.moment", "body.moment[0], column 1", "space.o", "space.o[1], column 1",
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("reader", "tables", "place"),
    [
        ("m", "[tables]\nm = { times = [0, 1], values = [1] }", "tables.m"),
        ("o1 + o2", "[space]\no = [1, 2]", "space.o"),
        ("h2", "[states]\nh = { start = [0, 0] }", "states.h.rate"),
        ("h2", '[states]\nh = { start = [0, 0], rate = "w1" }', "states.h.start"),
        ("1/(k - 1)", "k = nan", "define.k"),
        ("1/(2*k - 2)", '[states]\nk = { every = "1/10", valu = "w1" }', "states.k.value"),
    ],
)
def test_a_text_that_reads_a_faulty_name_has_no_fault(reader: str, tables: str, place: str) -> None:
    """Nor has one that reads it by way of a definition."""
    body = f'inertia = [1, 2, 3]\nmoment = ["{reader}", "d", 0]'
    faulty = places(body, f'd = "2*({reader})"\n{tables}')
    assert [each for each in faulty if not each.endswith(".valu")] == [place]


def test_names_of_what_could_not_be_read_are_no_faults() -> None:
    """Such as those of a table that is none, of a model that is unknown, and of an inertia with a fault."""
    assert places(define=CYCLE, top='model = "euler"\ntables = 3') == sorted(
        ["tables", *OF_TEXTS[1:]]
    )
    top = 'model = "euler"\nstates = 3\ntrack = ["h"]'
    assert places(define=CYCLE, top=top) == sorted(["states", *OF_TEXTS[1:]])
    assert places(define='a = "sign(I11) + u1"', top='model = "eulr"') == ["model"]
    body = 'inertia = [1, -2, 3]\nmoment = ["sign(I11)", "foo", 0]'
    assert places(body) == ["body.inertia[1]", "body.moment[1], column 1", "define.b, column 1"]
    lost = 'r = "sign(w1)"\n[states]\nm = { start = 0, every = 1, valu = "r" }'
    assert places("inertia = [1, 2, 3]", lost) == ["states.m.valu", "states.m.value"]


def test_a_fault_of_a_table_does_not_hide_that_of_its_name() -> None:
    """A name that is taken is taken by what could not be read too."""
    tables = f"{CYCLE}\n[tables]\npi = {{ times = [0], values = [1, 2] }}"
    assert places(define=tables) == sorted([*OF_TEXTS, "tables.pi", "tables.pi"])


def test_a_vector_by_its_space_components_reads_no_state_of_the_body() -> None:
    """It reads the time, the centre, tables, and definitions that read these alone."""
    tables = """
s = "2*w1"
g = "t*T9 + pi"
[space]
o = ["2 + w2", "s", "g"]
p = ["g + 3*r11", "q0", "h"]
[tables]
T9 = { times = [0, 1], values = [0, 1] }
[states]
h = { start = 0, rate = "w1" }
"""
    assert places("inertia = [1, 2, 3]", tables) == [
        "space.o[0], column 5", "space.o[1], column 1", "space.p[0], column 7", "space.p[1], column 1",
        "space.p[2], column 1",
    ]  # fmt: skip


def test_the_equations_take_a_state_in_such_a_vector() -> None:
    """The search for causes puts held values in place of the numbers of a scene."""
    loads = load("loads/gravity-gradient").body.loads
    assert loads is not None
    one = (Fraction(1),)
    held = Held("m", one, one, Fraction(1), Fraction(0), is_vector=False)
    other = replace(loads, definitions=(("n", "m"),), states=(held,))
    assert "m" in other.inputs
    assert not [*other.faults()]
