"""Likely causes in single definitions and terms: held, standing still, in cycles, half of the wheels."""

from __future__ import annotations

import re

import pytest
from builders.scenes import text_of
from builders.turns import by_turns
from builders.wrong_dynamics import named_motion

FRAME = [0.8, 0.4, 0.2, 0.4]
MAGNET = text_of(
    {
        "inertia": [[1.2, 0.1, 0.05], [0.1, 0.9, -0.07], [0.05, -0.07, 1.6]],
        "moment": ["0.2*b3", "-0.3*b1 + push", "0.2*b1 - 0.1*w3"],
    },
    {"omega": [0.3, -0.5, 0.4], "attitude": FRAME},
    *(6, 31),
) + ('[define]\npush = "0.1*cos(0.9*t)"\n[space]\nb = ["cos(0.7*t)", "0.5", "-sin(0.7*t)"]\n')
# Along its first axis the vessel turns back, where no power but a whole one has a value.
VESSEL = text_of(
    {
        **{"mass": 2, "inertia": [0.3, 0.7, 0.8], "added_mass": [0.3, 1.5, 1.4, 0.05, 0.2, 0.2]},
        "force": ["0.4*sin(2*t) - 0.3*u1 - 0.2*u1^2", "-0.5*u2 + 0.1*u1*w3", "-0.6*u3"],
        "couple": ["-0.1*w1", "-0.1*w2", "-0.2*w3 - 0.3*u2"],
    },
    {"linear_velocity": [-0.5, -0.2, 0.1], "angular_velocity": [0.1, 0.2, -0.3]},
    *(4, 31),
)
WHEELS = text_of(
    {"inertia": [1.3, 0.9, 1.5], "rotor": ["0.2", "0.3*cos(t)", "0.4 + 0.1*sin(2*t)"]},
    {"omega": [0.3, -0.5, 0.4], "attitude": FRAME},
    *(6, 31),
)
CONSTANT = re.sub("rotor = .*", "rotor = [0.2, 0.3, 0.4]", WHEELS)


@pytest.mark.parametrize(
    ("text", "old", "new", "name"),
    by_turns(
        [
            (
                MAGNET,
                "cos(0.9*t)",
                "cos(0.9*floor(5*t)/5)",
                "push taken every 0.2 and held",
            ),
            (
                MAGNET,
                '"cos(0.7*t)", "0.5", "-sin(0.7*t)"',
                '"1", "0.5", "0"',
                "b of [space] stands still, as at the start",
            ),
            (MAGNET, "0.9*t", "5.654866776461628*t", "`0.9` in push, 0.1*cos(0.9*t), cycles and"),
            (VESSEL, " - 0.2*u1^2", "", "`0.2` in force 1"),
            (VESSEL, "- 0.3*u2", "+ 0.3*u2", "`0.3` in couple 3"),
            (
                VESSEL,
                '- 0.3*u1 - 0.2*u1^2", "-0.5*u2 + 0.1*u1*w3", "-0.6*u3"',
                '- 0.6*u1 - 0.4*u1^2", "-1.0*u2 + 0.1*u1*w3", "-1.2*u3"',
                "factor of all drag by single velocities in the force",
            ),
            (
                WHEELS,
                "[initial]",
                'moment = [0, "2*(w3*0.2 - w1*(0.4 + 0.1*sin(2*t)))", 0]\n[initial]',
                "gyroscopic term of the wheels with the other sign on axis 2",
            ),
            (
                CONSTANT,
                "[initial]",
                'moment = ["w2*0.4 - w3*0.3", 0, 0]\n[initial]',
                "gyroscopic term of the wheels left out on axis 1",
            ),
        ],
        4,
        lambda text, old, new, name: text,
    ),
)
def test_one_definition_or_term_is_named(text: str, old: str, new: str, name: str) -> None:
    """The motion of a scene with one other definition, or one other term, has the name of that."""
    assert old in text
    (cause,) = named_motion(text.replace(old, new), text)
    assert cause.startswith(name)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("text", "old", "new"),
    [
        (MAGNET, "cos(0.9*t)", "cos(0.9*(t - 0.05*sin(7*t)))"),
        (MAGNET, '"cos(0.7*t)", "0.5"', '"cos(0.1*t*t)", "0.5"'),
        (WHEELS, "[initial]", 'moment = ["w2*0.4 - w3*0.3", "0.3*w1*w3", 0]\n[initial]'),
    ],
)
def test_a_definition_of_another_law_has_no_such_name(text: str, old: str, new: str) -> None:
    """A time that sways, another phase, or another product of the rates is none of these faults."""
    assert old in text
    names = " ".join(named_motion(text.replace(old, new), text))
    assert not re.search("taken every|stands still|cycles|gyroscopic term of the wheels", names)
