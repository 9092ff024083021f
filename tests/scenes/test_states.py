"""States of a scene's own: read exactly, in the scene's order, or refused with all faults at once."""

from __future__ import annotations

from fractions import Fraction

import pytest
from builders.scenes import read_scene

from taylor_verify.numbers.precision import rung
from taylor_verify.records.faults import Refused
from taylor_verify.scenes.loads.loads import Loads, Piece
from taylor_verify.scenes.reading.reader import read
from taylor_verify.scenes.scene import Scene

RIGID = "inertia = [1, 2, 3]"


def scene(tables: str = "", *, body: str = "", **others: str) -> Scene:
    """A rigid body with these tables."""
    body = body if "inertia" in body else f"{RIGID}\n{body}"
    return read_scene(body, tables=tables, **{"time": "end = 2\nsamples = 3"} | others)


def states(text: str, **others: str) -> Loads:
    """The loads of a scene with these states."""
    loads = scene(f"[states]\n{text}", **others).body.loads
    assert loads is not None
    return loads


def faults(text: str, **others: str) -> str:
    with pytest.raises(Refused) as refused:
        scene(f"[states]\n{text}", **others)
    return str(refused.value)


def value(piece: Piece, place: int, inputs: dict[str, Fraction]) -> Fraction:
    """The value of a step in rationals, by an arithmetic of its own."""
    step = piece.steps[place]
    a = [value(piece, k, inputs) for k in step.operands if step.operation != "choose"]
    match step.operation:
        case "input":
            return inputs[step.name]
        case "number":
            return step.number or Fraction(0)
        case "+":
            return a[0] + a[1]
        case "-":
            return a[0] - a[1]
        case "*":
            return a[0] * a[1]
        case "/":
            return a[0] / a[1]
        case "step":
            return Fraction(int(a[0] >= 0))
        case "sign":
            return Fraction((a[0] > 0) - (a[0] < 0))
        case "floor":
            return Fraction(a[0] // 1)
        case "choose":
            condition, first, second = step.operands
            chosen = first if value(piece, condition, inputs) >= 0 else second
            return value(piece, chosen, inputs)
    raise AssertionError(step)


def test_states_are_listed_in_the_order_of_the_scene() -> None:
    """Vectors give numbered components, and a number gives its own name."""
    loads = states(
        """
        h = { start = [0, "1/3"], rate = ["w1", "-h2*m"] }
        m = { every = "1/2", value = "h1 + w2" }
        f = { start = 2, rate = 1 }
        """,
        body='moment = ["h1*m", 0, "f"]',
    )
    assert loads.continuous == ("h1", "h2", "f")
    assert loads.held_values == ("m",)
    piece, inputs = loads.piece(Fraction(0)), {"h1": Fraction(3), "h2": Fraction(5)}
    inputs |= {"m": Fraction(7), "f": Fraction(11), "w1": Fraction(1), "w2": Fraction(2)}
    results = [
        [value(piece, k, inputs) for k in places]
        for places in (piece.outputs, piece.rates, piece.values)
    ]
    assert results == [[21, 0, 11], [1, -35, 1], [5]]


@pytest.mark.parametrize(
    ("text", "at_less", "at_equal", "at_more"),
    [
        ("1 if w1 < 2 else 0", 1, 0, 0),
        ("1 if w1 <= 2 else 0", 1, 1, 0),
        ("1 if w1 > 2 else 0", 0, 0, 1),
        ("1 if w1 >= 2 else 0", 0, 1, 1),
        ("sign(w1 - 2)", -1, 0, 1),
        ("step(w1 - 2)", 0, 1, 1),
        ("floor(w1/2)", 0, 1, 1),
        ("1/(w1 - 2) if w1 > 2 else 5", 5, 5, 1),
        ("1 if 2 <= 2 else w1", 1, 1, 1),
    ],
)
def test_a_held_value_may_jump_with_the_state(
    text: str, at_less: int, at_equal: int, at_more: int
) -> None:
    """Each comparison counts its equal sides as it is written; what is not chosen needs no value."""
    loads = states(f'm = {{ every = 1, value = "{text}" }}')
    piece = loads.piece(Fraction(0))
    results = [value(piece, piece.values[0], {"w1": Fraction(w)}) for w in (1, 2, 3)]
    assert results == [at_less, at_equal, at_more]


def test_definitions_of_values_alone_may_jump() -> None:
    """A definition that a load names besides is refused at its own place."""
    tables = '[define]\nu = "sign(w1)"\n[states]\nm = { every = 1, value = "u" }'
    assert scene(tables).body.loads is not None
    with pytest.raises(Refused, match=r"outside held values.*@ define\.u, column 1"):
        scene(tables, body='moment = ["u", 0, 0]')


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("m = { every = 0, value = 1 }", "a positive time from instant to instant, got 0"),
        ("m = { every = 1, offset = -1, value = 1 }", "an offset that is not negative, got -1"),
        ("m = { every = 1, offset = 1, value = 1 }", "a start, as the state is read before"),
        ('m = { every = 1, value = "m + 1" }', "a start, as the state is read before"),
        (
            'm = { every = 1, value = "n" }\nn = { every = 1, value = 1 }',
            "before it is first taken, got nothing @ states.n",
        ),
        ('h = { rate = "w1" }', "got nothing @ states.h.start"),
        ("h = { start = 1 }", "got nothing @ states.h.rate"),
        (
            'h = { start = [1], rate = "w1" }',
            "expected one number, got an array of 1 @ states.h.start",
        ),
        ('h = { start = 1, rate = ["w1"] }', "an array of 1, got one number @ states.h.start"),
        ("h = { start = [], rate = [] }", "from 1 to 100 entries, got 0 @ states.h.rate"),
        ("h = { start = 1, rate = 1, value = 2 }", "got nothing @ states.h.every"),
        ("w = { start = [0], rate = [0] }", "a name that is free, got `w1` @ states.w"),
        ("if = { start = 0, rate = 0 }", "a name that is free, got `if`"),
        ("sin = { start = 0, rate = 0 }", "a name that is free, got `sin`"),
        ("omega = { start = 0, rate = 0 }", "a name that is no quantity of the motion"),
        ("T = { start = 0, rate = 0 }", "a name that is no quantity of the motion"),
        ('h = { start = 0, rate = "sign(w1)" }', "@ states.h.rate, column 1"),
        ('h = { start = [0], rate = ["w9"] }', "a known name, got `w9` @ states.h.rate[0]"),
        ('m = { every = 1, value = "v" }', "a known name, got `v` @ states.m.value, column 1"),
        ("m = { every = 1, value = 1, dt = 2 }", "write `every`"),
        ('m = { every = "1/10000", value = 1 }', "at most 10000 instants"),
        ("h = 3", "expected a table, got 3 @ states.h"),
    ],
)
def test_a_fault_of_a_state_is_named(text: str, expected: str) -> None:
    """The place is that of the key, and the sentence says what was expected there."""
    assert expected in faults(text)


def test_all_faults_of_states_come_at_once() -> None:
    """Those of shapes, of names, of texts, and of a body whose inertia is malformed."""
    text = faults(
        'h = { start = 1, rate = "w9" }\nm = { every = 0, value = 1 }',
        body='inertia = [1, -2, 3]\nmoment = ["sin(", 0, "v"]',
    )
    for place in ("inertia[1]", "moment[0]", "moment[2]", "states.m.every"):
        assert place in text


def test_a_malformed_number_hides_no_other_fault() -> None:
    """It stands as a number while texts are examined, and a state that has no shape lends them no name."""
    text = faults(
        'w1 = { start = ["x"], rate = ["w2"] }\nm = { every = "a", offset = 1, value = "m + w9" }',
        body='moment = ["1/0", "sign(w1)", "2*k"]\nrotor = ["m", "w2", 0]',
        top='define = { k = "1/0" }',
    )
    assert [line.rpartition("@ ")[2] for line in text.splitlines()] == [
        "states.w1.start[0]", "states.m.every", "body.moment[0]", "define.k", "body.moment[1], column 1",
        "states.m.value, column 5", "body.rotor[0], column 1", "body.rotor[1], column 1", "states.m",
    ]  # fmt: skip
    shapeless = faults('h = { start = [0, 0], rte = ["w1", "w2"] }', body='moment = ["h1", 0, 0]')
    assert "h1" not in shapeless


@pytest.mark.parametrize(
    ("rotor", "got"),
    [
        ("m", "states that have a rate, got `m`"),
        ("2*d", "states that have a rate, got `m`"),
        ("w1 + t", "states that have a rate, got `w1`"),
        ("step(t - 1)", "got a jump by the time"),
        ("1 if t < 1 else 2", "got a jump by the time"),
        ("floor(t)", "got a jump by the time"),
        ("p", "got a jump by the time"),
    ],
)
def test_a_rotor_does_not_jump(rotor: str, got: str) -> None:
    """Wheels that jump would make the angular velocity jump."""
    tables = """
    [define]
    d = "m"
    [tables]
    p = { times = [0, 1], values = [0, 1], kind = "hold" }
    [states]
    m = { every = 1, value = "w1" }
    """
    with pytest.raises(Refused, match=r"a rotor.*body\.rotor\[1\]") as refused:
        scene(tables, body=f'rotor = [0, "{rotor}", 0]')
    assert got in str(refused.value)


def test_a_rotor_is_text_or_a_number() -> None:
    """A text may have kinks; numbers alone are those of a gyrostat."""
    loads = states('h = { start = 1, rate = "-h" }', body='rotor = ["clip(h, -1, t)", 2, "1/3"]')
    piece = loads.piece(Fraction(0))
    assert len(piece.rotor) == 3
    assert value(piece, piece.rotor[2], {}) == Fraction(1, 3)
    constant = states('h = { start = 1, rate = "-h" }', body='rotor = [1, "2", 3]')
    assert constant.rotor == constant.piece(Fraction(0)).rotor == ()


def test_states_beside_constant_loads_keep_these() -> None:
    """A constant moment is the load of a scene whose states nothing reads."""
    loads = states('h = { start = 1, rate = "-h" }', body="moment = [1, 0, 2]")
    piece = loads.piece(Fraction(0))
    assert [value(piece, k, {}) for k in piece.outputs] == [1, 0, 2]


def test_held_states_run_forward() -> None:
    """A scene that ends before it starts is refused; its continuous states alone are not."""
    backward = "end = -1\nsamples = 2"
    assert "run forward" in faults("m = { every = 1, value = 1 }", time=backward)
    assert states("h = { start = 1, rate = 1 }", time=backward).continuous == ("h",)


def test_instants_are_offset_plus_k_every() -> None:
    """Both ends count; two states that are taken at one time are taken there together."""
    loads = states(
        """
        a = { every = "1/2", value = ["w1", "w2"] }
        b = { every = "3/4", offset = "1/4", start = 0, value = "a1" }
        """
    )
    instants = loads.instants(Fraction(2))
    assert [(str(i.time), i.names, i.places) for i in instants] == [
        ("0", ("a",), (0, 1)),
        ("1/4", ("b",), (2,)),
        ("1/2", ("a",), (0, 1)),
        ("1", ("a", "b"), (0, 1, 2)),
        ("3/2", ("a",), (0, 1)),
        ("7/4", ("b",), (2,)),
        ("2", ("a",), (0, 1)),
    ]


def test_instants_on_a_rung_are_rounded_once() -> None:
    """k every is formed exactly, never summed; the third tenth is the number nearest to 3/10."""
    loads = states('m = { every = "1/10", value = 1 }').on_rung(rung("f64"))
    third = loads.instants(Fraction(1))[3].time
    assert third == Fraction(0.3)
    close = states('m = { every = "1e-12", offset = 1, start = 0, value = 1 }', time="at = [1]")
    with pytest.raises(ValueError, match="instants that differ"):
        close.on_rung(rung("f32")).instants(1 + Fraction(1, 10**9))


def test_instants_switches_and_knots_at_one_time_stay_at_one_time() -> None:
    """3/10 is no number of f64: whatever happens then happens at the number nearest to it."""
    tables = """
    [tables]
    p = { times = [0, 0.3], values = [1, 2], kind = "hold" }
    [states]
    m = { every = "1/10", value = "p + step(t - 0.3)" }
    """
    loads = scene(tables).body.loads
    assert loads is not None
    rounded = loads.on_rung(rung("f64"))
    time = rounded.instants(Fraction(1))[3].time
    assert time in rounded.switches
    piece = rounded.piece(time)
    assert value(piece, piece.values[0], {}) == 3


def test_floor_of_the_time_is_a_staircase() -> None:
    """It switches within the scene, its last stair is known, and none beyond it is guessed."""
    loads = states('h = { start = 0, rate = "floor(2*t - 1/2)" }')
    piece = loads.piece(Fraction(1, 2))
    assert (piece.begin, piece.end) == (Fraction(1, 4), Fraction(3, 4))
    assert value(piece, piece.rates[0], {}) == 0
    last = loads.piece(Fraction(2))
    assert value(last, last.rates[0], {}) == 3
    with pytest.raises(ValueError, match="between 0 and 2"):
        loads.piece(Fraction(3))
    beyond = loads.reaching(Fraction(30)).piece(Fraction(29))
    assert value(beyond, beyond.rates[0], {}) == 57
    assert "at most 10000 switches" in faults('h = { start = 0, rate = "floor(6000*t)" }')


def test_tracked_states_are_quantities_of_the_scene() -> None:
    """`track` names some of them; their columns follow those of the frame."""
    tracked = scene(
        "[states]\nh = { start = [0, 0], rate = [1, 2] }\nf = { start = 0, rate = 1 }",
        top='track = ["h", "attitude"]',
    )
    assert [quantity.name for quantity in tracked.tracked] == ["omega", "attitude", "h"]
    assert tracked.groups[-1].columns == ("h1", "h2")
    assert tracked.track == {"attitude"}
    with pytest.raises(Refused, match="one of attitude, h, omega"):
        scene("[states]\nh = { start = 0, rate = 1 }", top='track = ["k"]')


def test_states_beside_a_manufactured_motion_are_refused() -> None:
    """That motion has loads of its own."""
    text = """
title = "Both"
model = "euler"
[body]
inertia = [1, 2, 3]
[states]
h = { start = 0, rate = 1 }
[manufactured]
constant = [1, 2, 3]
[[manufactured.waves]]
frequency = 1
cosine = [1, 0, 0]
sine = [0, 1, 0]
[time]
end = 1
samples = 2
"""
    with pytest.raises(Refused, match="beside a manufactured motion"):
        read(text, "both")
