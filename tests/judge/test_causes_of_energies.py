"""Another coefficient of the energy of a solid in a fluid has the name that the scene gives it."""

from __future__ import annotations

from typing import Any

import pytest
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
NO_PATH = SOLID.replace(', "centre"', "")


def of_motion(changed: str, text: str) -> tuple[Any, Any]:
    """The judgement of the exact motion of a changed scene, and a judge of it by other scenes."""
    own = read(text, "solid")
    times = list(own.clock.instants)
    motion = exact(read(changed, "changed"), times, 17).quantities.items()
    columns = {"t": [float(t) for t in times]} | {n: v.astype(float) for n, v in motion}
    judged = check(own, columns, tolerance=1e-8)
    return judged, lambda scene: check(scene, columns, tolerance=1e-8)


def printed(sentence: str, text: str) -> Scene:
    """The scene with the key that a sentence prints."""
    key = sentence.partition("as a scene: ")[2].strip()
    written = text[text.index("[body]") + len("[body]\n") : text.index("[initial]")]
    return read(text.replace(written, f"{key}\n"), "printed")


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
        3,
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


@pytest.mark.parametrize(
    "changes",
    by_turns(
        [
            [("p = 1,", "p = 1.2,"), ("p_prime = 1.5", "p_prime = 1.8")],
            [("q = 0.1", "q = 0.12"), ("q_prime = 0.2", "q_prime = 0.22")],
            [("p = 1,", "p = 1.1,"), ("r = 2", "r = 2.2"), ("q_prime = 0.2", "q_prime = 0.3")],
        ],
        2,
    ),
)
def test_several_coefficients_are_no_other_body_and_no_convention(
    changes: list[tuple[str, str]],
) -> None:
    """A body of these momenta with another path is not named, nor is a frame that the attitude turns in."""
    changed = SOLID
    for old, new in changes:
        changed = changed.replace(old, new)
    judged, judged_by = of_motion(changed, SOLID)
    for cause in judged.causes:
        assert judged_by(printed(cause.sentence, SOLID)).passed
