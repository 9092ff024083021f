"""Files as simulators with one known fault write them, re-enacted from public reports, and their causes.

Every state counts as failed, so that no truth but that of the search is computed.
"""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from builders.turns import by_turns
from builders.wrong_dynamics import failure

import taylor_verify
from taylor_verify.judge.causes.basis import coriolis_of
from taylor_verify.judge.causes.changed_scene import changed_scene
from taylor_verify.judge.causes.float_answer import Answer
from taylor_verify.judge.causes.likely import explained
from taylor_verify.judge.causes.material import material_of_file
from taylor_verify.judge.causes.written_numbers import numbers
from taylor_verify.judge.conventions.fits import Conventions
from taylor_verify.judge.conventions.worlds import World
from taylor_verify.numbers.precision import rung
from taylor_verify.records.quantities import GROUPS, with_needs
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.reading.reader import read as read_scene
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.files.file import read

CASES = Path(__file__).parent / "cases"
FREE = "euler/oblique-start"
STATES = ("omega", "impulse", "attitude")


def sentences(name: str, scene_name: str, failed: tuple[str, ...]) -> list[str]:
    """The causes of a file in which these states failed."""
    path = CASES / f"{scene_name}.toml"
    with np.errstate(all="ignore"):
        answer = compared(name, load(str(path) if path.exists() else scene_name), failed)
        return [cause.sentence for cause in explained(answer).causes]


def compared(name: str, scene: Scene, failed: tuple[str, ...]) -> Answer:
    """A file beside the exact motion of a scene."""
    file = read(str(CASES / f"{name}.csv"))
    tracked = with_needs({GROUPS[group].quantity for group in file.groups if group in GROUPS})
    scene = replace(scene, track=scene.track & tracked)
    known = Conventions((), World(scene), {})
    verdicts = [failure(scene, quantity) for quantity in failed]
    answer = material_of_file(file, rung("f64"), known, verdicts)
    assert answer is not None
    return answer


def changed(sentence: str, text: str) -> str:
    """The text of a scene with the keys that a cause has printed."""
    for line in sentence.partition("as a scene: ")[2].split("; "):
        key = line.partition(" = ")[0]
        without = re.sub(rf"^{key} *= *(\[\n.*?\n\]|[^\n]*)\n", "", text, flags=re.M | re.S)
        text = without.replace("[body]\n", f"[body]\n{line}\n")
    return text


@pytest.mark.parametrize(
    ("name", "scene", "words"),
    by_turns(
        [
            ("gyro-axis-2-flipped", FREE, ["omega has the other sign on axis 2"]),
            ("imu-mounted-askew", FREE, ["fixed rotation of 31.59 degrees, in omega and attitude"]),
            (
                "time-in-frames-60",
                FREE,
                ["60 times too slow, or t counts 1/60 of the unit of time"],
            ),
            ("wheels-inertia-1.2x", "wheels", ["factor of the inertia = 1.2;"]),
            ("wheel-2-missing", "wheels", ["wheel 2 left out"]),
            ("gyroscopic-half", "link", ["factor of the gyroscopic term = 0.5;"]),
            ("moment-one-sign", "thruster", ["moment = [0.05, 0.02, 0.08]"]),
            ("one-product-sign", "link", ["I_13 with the other sign"]),
            ("speed-capped-at-7", "racket", ["(|omega| is 10.01, then 7)"]),
            (
                "momentum-turned-explicitly",
                "link",
                ["the rate at the begin of the step, h = 0.00416667", "at the begin of the step"],
            ),
            (
                "local-inverse-inertia-in-world",
                "thruster",
                [
                    "omega is in space axes",
                    "not turned with the body",
                ],
            ),
            ("openhrp3-120", "link", ["omega is in space axes", "with omega in space axes"]),
            ("rosflight-460", "link", ["updated in place, h = 0.0025"]),
            (
                "jsbsim-1034-rotating-earth",
                "jsbsim-1034",
                ["all of the error arises between the first two rows, from t = 0 to 1"],
            ),
            ("gf_0.2_2_no_ca", "gf_0.2_2", ["lack the added mass (a rigid body of mass 31.0294)"]),
            ("gf_1.0_2_lower", "gf_1.0_2", ["no Munk moment of the masses"]),
            ("no_ca", "remus", ["the Coriolis terms lack the added mass"]),
            ("ca_twice", "remus", ["the Coriolis terms have the added mass twice"]),
            (
                "cg_not_in_C",
                "remus",
                ["another centre of mass (m r and three moments of inertia) in"],
            ),
            (
                "cg_nowhere",
                "remus",
                ["another centre of mass (m r and three moments of inertia)"],
            ),
            ("no_crb", "remus", ["the Coriolis terms lack the rigid body"]),
            ("br_thrust_on", "bluerov", ["force 1, body axes = 5;"]),
            ("br_net_buoyancy", "bluerov", ["force 3, space axes = -1.96;"]),
            ("br_linear_drag", "bluerov", ["linear drag = 4.03 6.22 5.18 0.07 0.07 0.07;"]),
        ]
    ),
)
def test_a_known_fault_is_named(name: str, scene: str, words: list[str]) -> None:
    """A simulator with one fault gets that word and no other, and one with two gets both."""
    causes = sentences(name, scene, STATES)
    assert len(causes) == len(words)
    assert all(word in sentence for word, sentence in zip(words, causes, strict=True))


@pytest.mark.parametrize(
    ("name", "scene", "failed", "words"),
    [
        (
            "fr_v_of_cg",
            "remus_path",
            "impulse",
            "is that of another point of the body, at (0, 0, 0.02)",
        ),
        ("fr_depth_sign", "remus_path", "centre", "the centre has the other sign on axis 3"),
        (
            "at_old_h0.025",
            "euler/with-attitude",
            "attitude",
            "attitude turned by the rate at the begin of the step, h = 0.025",
        ),
    ],
)
def test_the_quantity_that_failed_has_its_cause(
    name: str, scene: str, failed: str, words: str
) -> None:
    """A convention of one quantity, or a method of the attitude, is named where only that failed."""
    assert words in sentences(name, scene, (failed,))[0]


@pytest.mark.parametrize(
    ("name", "scene"),
    by_turns(
        [
            ("gyroscopic-half", "link"),
            ("one-product-sign", "link"),
            ("wheel-2-missing", "wheels"),
            ("moment-one-sign", "thruster"),
            ("no_ca", "remus"),
            ("cg_nowhere", "remus"),
            ("br_net_buoyancy", "bluerov"),
            ("br_linear_drag", "bluerov"),
        ],
        4,
    ),
)
def test_the_changed_scene_moves_as_the_file(name: str, scene: str) -> None:
    """The exact motion of the scene with the keys that a cause has printed is that of the file."""
    (sentence,) = sentences(name, scene, STATES)
    text = changed(sentence, (CASES / f"{scene}.toml").read_text())
    answer = compared(name, read_scene(text, scene), STATES)
    assert max(answer.worst.values()) < 1e-6


def test_a_key_that_two_faults_change_is_printed_once() -> None:
    """A force and a couple say the faults of a load's text and of the Coriolis terms."""
    text = (CASES / "bluerov.toml").read_text()
    dragged = text.replace("[body]\n", '[body]\nforce = ["-4*u1", 0, 0]\n')
    right = compared("br_linear_drag", read_scene(dragged, "dragged"), STATES).right
    first = numbers(right.loads)[0]
    changes = first.changes(right, np.array([2 * first.value]))
    changes["extra"] = right.basis.factors(products=coriolis_of(right.mass))
    keys = [line.partition(" = ")[0] for line in changed_scene(right, changes).split("; ")]
    assert sorted(keys) == ["couple", "force"]


def test_matrices_that_are_no_rotations_are_said() -> None:
    """A file whose matrices grow has a note, and the moment that explains its rows names no cause."""
    judged = taylor_verify.check(
        str(CASES / "block.toml"), str(CASES / "matrix-not-orthogonal.csv"), tolerance=1e-6
    )
    facts = [note for note in judged.notes if "no rotation" in note or "moment acts" in note]
    assert facts[0].startswith("r11 ... r33 are no rotation: R^T R is off by 0.12 at t = 20")
    assert facts[1].startswith(
        "no cause is proven; each row of omega follows from the row before if from "
        "t = 0 to 20 a moment acts"
    )
    assert judged.causes == ()


def test_a_convention_explains_what_it_reads(tmp_path: Path) -> None:
    """No missing moment is said where omega is right in space axes and the attitude alone is wrong."""
    lines = (CASES / "openhrp3-120.csv").read_text().splitlines()[:82]
    file = tmp_path / "run.csv"
    file.write_text("\n".join(lines))
    judged = taylor_verify.check(str(CASES / "link.toml"), file, partial=True, tolerance=1e-6)
    assert any("w1 w2 w3 are in space axes" in str(finding) for finding in judged.conventions)
    assert not any("moment acts" in note for note in judged.notes)
