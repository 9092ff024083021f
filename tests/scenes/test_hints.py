"""Keys that people try: each is refused with what to write instead, or with why it is not modelled."""

from __future__ import annotations

import re

import pytest
from builders.scenes import faults_of, read_scene

from taylor_verify.records.faults import Refused

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
