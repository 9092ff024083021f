"""All faults of a scene come at once, and each key that people try with what to write instead."""

from __future__ import annotations

import re
from dataclasses import replace
from fractions import Fraction

import pytest
from builders.scenes import faults_of, read_scene

from taylor_verify.records.faults import Refused
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


# Keys that people try

BODIES = {
    "euler": "inertia = [1, 2, 3]",
    "kirchhoff": "clebsch = { p = 1, p_prime = 2, q = 0, q_prime = 0, r = 1, r_prime = 0.5 }",
}
STARTS = {
    "euler": "omega = [1, 2, 3]",
    "kirchhoff": "linear_impulse = [1, 2, 3]\nangular_impulse = [1, 2, 3]",
}


def refusal(model: str, part: str, key: str) -> str:
    """The one fault of a sound scene with one key more."""
    extra = {name: f"{key} = 1" if name == part else "" for name in ("", "body", "initial", "time")}
    (line,) = faults_of(
        f"{BODIES[model]}\n{extra['body']}",
        f"{STARTS[model]}\n{extra['initial']}",
        time=f"end = 1\nsamples = 2\n{extra['time']}",
        top=f'model = "{model}"\n{extra[""]}',
    )
    return line


TRIED = [
    *(("kirchhoff", "body", key, "`mass_matrix`") for key in ("m_rb", "added_mass", "inertia")),
    *(("kirchhoff", "body", key, "write `weight = {") for key in ("gravity", "cob")),
    ("kirchhoff", "body", "drag", '"-20*u1 - 130*abs(u1)*u1"'),
    ("kirchhoff", "body", "thrust", "text in t and the state"),
    ("kirchhoff", "body", "flow", "write `current = ["),
    ("kirchhoff", "body", "torque", "`couple`"),
    ("kirchhoff", "body", "linear_damping", "write `damping`"),
    ("kirchhoff", "initial", "velocity", "`linear_velocity`"),
    ("kirchhoff", "initial", "omega", "`angular_velocity`"),
    ("kirchhoff", "initial", "position", "`centre`"),
    ("kirchhoff", "initial", "quaternion", "`attitude = [q0, q1, q2, q3]`"),
    ("euler", "body", "mass", "does not enter"),
    ("euler", "body", "added_mass", '`model = "kirchhoff"`'),
    ("euler", "body", "gravity", "write `weight = {"),
    ("euler", "body", "drag", '"-0.1*abs(w1)*w1"'),
    ("euler", "body", "gravity_gradient", "I33 - I22"),
    ("euler", "body", "torque", "`moment`"),
    ("euler", "body", "Ixx", "`inertia`"),
    *(("euler", "body", key, "write `rotor`") for key in ("wheels", "rw_momentum")),
    ("kirchhoff", "body", "rotor", "wheels turn in a body of the model euler"),
    ("euler", "body", "angular_damping", "write `damping`"),
    ("euler", "initial", "angular_velocity", "`omega`"),
    ("euler", "initial", "velocity", "not modelled"),
    ("euler", "initial", "position", "not modelled"),
    ("euler", "initial", "quaternion", "scalar first"),
    ("euler", "time", "dt", "`samples`"),
    ("euler", "", "gravity", "`weight`"),
    ("euler", "", "tolerance", "holds no tolerance"),
    *(("kirchhoff", "body", key, "buoyancy = {") for key in ("W", "B", "cg", "cb")),
    *(("kirchhoff", part, "wind", "write `current = [") for part in ("", "body")),
    *(("euler", part, "magnetic", "m2*b3 - m3*b2") for part in ("", "body")),
    *(("euler", part, "gravity_gradient", "(I33 - I22)*o2*o3") for part in ("", "body")),
    ("euler", "", "drag", "-0.1*abs(w1)*w1"),
    ("euler", "", "inertia", "write `inertia` in [body]"),
    ("euler", "body", "omega", "it stands in [initial]"),
    ("euler", "body", "samples", "write `samples` in [time]"),
    ("kirchhoff", "time", "couple", "write `couple` in [body]"),
    ("kirchhoff", "initial", "track", "write `track` at the top"),
    ("kirchhoff", "body", "omega", "write `angular_velocity` in [initial]"),
    ("kirchhoff", "time", "drag", "in [body] write `force = ["),
    ("euler", "", "cg", "in [body] write `weight = {"),
]


@pytest.mark.parametrize(("model", "part", "key", "fragment"), TRIED)
def test_a_key_that_people_try_is_answered(model: str, part: str, key: str, fragment: str) -> None:
    """The key is refused at its place, in whatever letters, and the sentence in brackets helps."""
    in_place = f"write `{key}`" in fragment
    for spelling in (key,) if in_place else (key, key.upper()):
        line = refusal(model, part, spelling)
        place = f"{part}.{spelling}" if part else spelling
        assert line.startswith(f"expected a known key, got `{spelling}` @ {place} (")
        assert fragment in line.split(" (", 1)[1]


def test_a_key_that_nobody_thought_of_is_answered_with_the_nearest() -> None:
    """Without a sentence of its own a key gets the known one most like it."""
    assert "did you mean `moment`?" in refusal("euler", "body", "momant")


WRITTEN = [
    *(("kirchhoff", key) for key in ("W", "magnetic", "drag", "wind")),
    *(("euler", key) for key in ("W", "magnetic", "drag", "gravity_gradient")),
]


@pytest.mark.parametrize(("model", "key"), WRITTEN)
def test_the_lines_of_a_sentence_are_read(model: str, key: str) -> None:
    """Lines that a sentence says to write are a part of a scene, with names from its tables."""
    lines = [line for line in re.findall("`([^`]+)`", refusal(model, "body", key)) if " = " in line]
    space = [line for line in lines if line[0] in "ob" and line[1] == " "]
    body = [line for line in lines if line not in space and not line.startswith("model")]
    assert body
    tables = ["[define]", "n = 1", "m1 = 1", "m2 = 2", "m3 = 3", "[space]", *space]
    scene = read_scene("\n".join([BODIES[model], *body]), STARTS[model], "\n".join(tables))
    assert scene.body.loads is not None or "current" in body[0]


@pytest.mark.parametrize(
    ("model", "line", "written"),
    [
        ("euler", "quaternion = [0.1, 0.2, 0.3, 0.9]", "attitude = [0.9, 0.1, 0.2, 0.3]"),
        ("euler", "attitude = [10, 5, 0]", 'euler = { sequence = "zyx", degrees = [10, 5, 0] }'),
        ("euler", "attitude = [10, 5, 0]", "rotation_vector = [10, 5, 0]"),
        ("kirchhoff", "eta = [1, 2, 3, 0.4, 0.5, 0.6]", "centre = [1, 2, 3]"),
        (
            "kirchhoff",
            "eta = [1, 2, 3, 0.4, 0.5, 0.6]",
            'euler = { sequence = "zyx", radians = [0.6, 0.5, 0.4] }',
        ),
        ("kirchhoff", "nu = [1, 2, 3, 4, 5, 6]", "angular_velocity = [4, 5, 6]"),
    ],
)
def test_a_start_in_the_order_of_others_is_written_in_ours(
    model: str, line: str, written: str
) -> None:
    """The sentence has the numbers in the lines of a scene."""
    with pytest.raises(Refused, match=re.escape(f"`{written}`")):
        read_scene(BODIES[model], f"{STARTS[model]}\n{line}")
