"""Another coefficient of the energy of a solid in a fluid has the name that the scene gives it."""

from __future__ import annotations

from itertools import product
from typing import Any

import numpy as np
import pytest
from builders.scenes import text_of
from builders.turns import by_turns

from taylor_verify import check, exact
from taylor_verify.scenes.reading.reader import read
from taylor_verify.scenes.scene import Scene

SOLID = """
title = "A solid in a fluid"
model = "kirchhoff"
track = ["attitude", "centre"]
[body]
clebsch = { p = 1, p_prime = 1.5, q = 0.1, q_prime = 0.2, r = 2, r_prime = 1 }
[initial]
linear_impulse = [0.5, -0.2, 0.9]
angular_impulse = [0.3, 0.4, 0.7]
[time]
end = 6
samples = 25
"""
CLEBSCH = SOLID[SOLID.index("clebsch") : SOLID.index("[initial]")]
GENERAL = SOLID.replace(
    CLEBSCH,
    "energy = { linear = [[1, 0.1, 0], [0.1, 1.3, 0], [0, 0, 0.8]], "
    "coupling = [[0.1, 0, 0.05], [0, 0.2, 0], [0, 0.1, 0.15]], "
    "angular = [[2, 0, 0.2], [0, 1.5, 0], [0.2, 0, 1]] }\n",
)
SCALED = (
    "clebsch = { p = 1.25, p_prime = 1.875, q = 0.125, q_prime = 0.25, r = 2.5, r_prime = 1.25 }\n"
)
NO_PATH = SOLID.replace(', "centre"', "")


def of_motion(changed: str, text: str, has_momenta: bool = True) -> tuple[Any, Any]:
    """The judgement of the exact motion of a changed scene, and a judge of it by other scenes."""
    own, other = read(text, "solid"), read(changed, "changed")
    times = list(own.clock.instants)
    motion = {n: v.astype(float) for n, v in exact(other, times, 17).quantities.items()}
    if not has_momenta:
        energy = np.array(other.body.energy_matrix, dtype=float)
        momenta = [motion.pop("linear_impulse"), motion.pop("angular_impulse")]
        linear, angular = np.split(np.hstack(momenta) @ energy, 2, axis=1)
        motion |= {"linear_velocity": linear, "omega": angular}
    columns = {"t": [float(t) for t in times]} | motion

    def judge(scene: Scene) -> Any:
        return check(scene, columns, tolerance=1e-8, partial=True)

    return judge(own), judge


def printed(sentence: str, text: str) -> Scene:
    """The scene with the keys that a sentence prints."""
    body, _, start = sentence.partition("as a scene: ")[2].partition("; and in [initial] ")
    written, begins = (
        text[text.index("[body]") : text.index("[initial]")],
        text[text.index("[initial]") :],
    )
    other = text.replace(written, f"[body]\n{body}\n")
    if start:
        keys = start.replace("; ", "\n")
        other = other.replace(begins[: begins.index("[time]")], f"[initial]\n{keys}\n")
    return read(other, "printed")


@pytest.mark.parametrize(
    ("text", "old", "new", "name"),
    by_turns(
        [
            (SOLID, "p_prime = 1.5", "p_prime = 1.4", "clebsch.p_prime = 1.4 for 1.5"),
            (SOLID, "r_prime = 1 ", "r_prime = 1.05 ", "clebsch.r_prime = 1.05 for 1"),
            (SOLID, " q = 0.1", " q = 0.12", "clebsch.q = 0.12 for 0.1"),
            (GENERAL, "[0, 0.2, 0]", "[0, 0.25, 0]", "energy.coupling 22 = 0.25 for 0.2"),
            (GENERAL, "0.8]]", "0.9]]", "energy.linear 33 = 0.9 for 0.8"),
        ],
        5,
    ),
)
def test_a_coefficient_is_named_and_its_scene_passes(
    text: str, old: str, new: str, name: str
) -> None:
    """The coefficient explains impulses, attitude and path; with the printed key in the scene all pass."""
    judged, judged_by = of_motion(text.replace(old, new), text)
    (cause,) = judged.causes
    assert cause.sentence.startswith(name)
    assert judged_by(printed(cause.sentence, text)).passed


def test_what_the_path_alone_would_tell_is_not_told_apart() -> None:
    """The impulses depend on p - p' alone, where no centre is tracked."""
    judged, _ = of_motion(NO_PATH.replace("p_prime = 1.5", "p_prime = 1.4"), NO_PATH)
    (cause,) = judged.causes
    assert cause.sentence.startswith("clebsch.p = 1.1 for 1")
    assert "not told apart from: clebsch.p_prime = 1.4 for 1.5" in cause.sentence


@pytest.mark.parametrize("has_momenta", [True, False])
@pytest.mark.parametrize(
    ("changes", "words"),
    by_turns(
        [
            (
                [("p = 1,", "p = 1.2,"), ("= 1.5", "= 1.8")],
                "factor of clebsch.p and clebsch.p_prime",
            ),
            (
                [("p = 1,", "p = 1.1,"), ("r = 2", "r = 2.2")],
                "clebsch.p = 1.1 for 1 (+10 %), clebsch.r =",
            ),
            (
                [("p = 1,", "p = 1.1,"), ("r = 2", "r = 2.2"), ("q_prime = 0.2", "q_prime = 0.3")],
                "clebsch.q_prime = 0.3 for 0.2 (+50 %), clebsch.r = 2.2 for 2 (+10 %)",
            ),
        ],
        3,
    ),
)
def test_several_coefficients_are_named_and_their_scene_passes(
    changes: list[tuple[str, str]], words: str, has_momenta: bool
) -> None:
    """The path tells what the impulses do not: A is known by these up to c 1 alone."""
    changed = SOLID
    for old, new in changes:
        changed = changed.replace(old, new)
    judged, judged_by = of_motion(changed, SOLID, has_momenta)
    (cause,) = judged.causes
    assert words in cause.sentence
    assert judged_by(printed(cause.sentence, SOLID)).passed


MASSES = {
    "mass_matrix": [
        [3, 0, 0, 0, 0.1, 0],
        [0, 5, 0, -0.1, 0, -0.2],
        [0, 0, 6, 0, 0.2, 0],
        [0, -0.1, 0, 0.3, 0, 0],
        [0.1, 0, 0.2, 0, 0.8, 0],
        [0, -0.2, 0, 0, 0, 0.7],
    ]
}
# One start, by velocities and by the impulses that these have.
VELOCITIES = {"linear_velocity": [1.5, -0.1, 0.2], "angular_velocity": [0.1, 0.3, 0.2]}
IMPULSES = {"linear_impulse": [4.53, -0.55, 1.26], "angular_impulse": [0.04, 0.43, 0.16]}
VEHICLE, BY_IMPULSES = (
    text_of(MASSES, start, 4, 33, "attitude", "centre") for start in (VELOCITIES, IMPULSES)
)


@pytest.mark.parametrize(
    ("text", "simulated", "has_momenta"),
    by_turns(
        [
            (VEHICLE, BY_IMPULSES, False),
            *product((BY_IMPULSES, VEHICLE), (BY_IMPULSES, VEHICLE), (True, False)),
        ],
        20,
    ),
)
def test_another_body_starts_with_what_the_first_row_shows(
    text: str, simulated: str, has_momenta: bool
) -> None:
    """It has the scene's impulses, or its velocities; what the scene does not write is printed."""
    changed = simulated.replace("[0, 0, 6,", "[0, 0, 6.4,")
    judged, judged_by = of_motion(changed, text, has_momenta)
    (cause,) = judged.causes
    assert cause.sentence.startswith("M_33 = 6.4 for 6")
    assert ("in [initial]" in cause.sentence) == (text != simulated)
    assert judged_by(printed(cause.sentence, text)).passed


def test_velocities_that_are_all_too_large_are_another_start_or_a_lighter_body() -> None:
    """A free motion in velocities tells no factor of the body: the first row does, or another start."""
    changed = SOLID.replace(CLEBSCH, SCALED)
    judged, _ = of_motion(changed, SOLID, has_momenta=False)
    (cause,) = judged.causes
    assert cause.name == "another start"
    assert (
        "not told apart from: factor of the mass matrix = 0.8, from the scene's momenta"
        in cause.sentence
    )


def test_another_start_is_no_other_body() -> None:
    """Velocities of the scene's body from another start have no factor, and no coefficient."""
    judged, _ = of_motion(
        SOLID.replace("[0.5, -0.2, 0.9]", "[0.5, -0.2, 0.8]"), SOLID, has_momenta=False
    )
    (cause,) = judged.causes
    assert cause.name == "another start"
    assert "not told apart" not in cause.sentence
