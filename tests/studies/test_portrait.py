"""Portraits of the scenes are right, complete, and the same whenever they are made."""

from __future__ import annotations

import json
from dataclasses import replace
from fractions import Fraction
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from builders.reports import every_portrait, portrait_without_run

from taylor_verify.cli import main
from taylor_verify.draw.drawn_course import FIGURES
from taylor_verify.exact.route import solution
from taylor_verify.explain.explanation import explanation
from taylor_verify.records.file_names import of_scene
from taylor_verify.records.quantities import TRACKED
from taylor_verify.scenes.bodies import ImmersedBody, RigidBody
from taylor_verify.scenes.library import names
from taylor_verify.scenes.motion import Impulse
from taylor_verify.scenes.reading.reader import load
from taylor_verify_reports.studies.portraits.latex_equations import equations
from taylor_verify_reports.studies.portraits.stored_portraits import PORTRAITS

# Portraits of all scenes take most of a minute.
pytestmark = pytest.mark.slow

SCENES = names()
# A full tensor, an axis of symmetry that is not the third, and time that runs backward.
FRESH = ("euler/full-tensor", "kirchhoff/oblate-about-axis-1", "euler/backward")
# Half a unit of the ninth digit, of a number below 10.
HALF = 0.5 * 10.0 ** (1 - FIGURES)


@cache
def stored(scene: str) -> dict[str, Any]:
    own = PORTRAITS.find(every_portrait(), scene)
    assert own is not None
    return own


# What is there


def test_every_scene_has_its_portrait() -> None:
    """There is one for each scene of the standard set, made of the scene as it is now, and no other."""
    files = {file.stem for file in (every_portrait() / PORTRAITS.folder).glob("*.json")}
    assert files == {of_scene(name) for name in names()}
    assert {name: stored(name)["sha256"] for name in names()} == {
        name: load(name).digest for name in names()
    }


@pytest.mark.parametrize("scene", FRESH)
def test_a_portrait_is_the_same_when_made_again(scene: str) -> None:
    """A new portrait equals the stored one, except for the run on f64, which depends on the machine."""
    again = json.loads(json.dumps(portrait_without_run(scene)))
    before = dict(stored(scene))
    assert before.pop("made_by").endswith("do not edit")
    assert again.pop("explain") == {"cost": {"seconds": None}}
    assert before.pop("explain")["rung"] == "f64"
    assert again == before


# The motion


@pytest.mark.parametrize("scene", FRESH)
def test_the_course_is_the_motion_at_the_times_printed(scene: str) -> None:
    """Every number is within half a unit of its ninth digit of what the Taylor route finds."""
    asked, course = load(scene), portrait_without_run(scene)["course"]
    rows = range(0, len(course["t"]), 90)
    elapsed = [Fraction(repr(course["t"][k])) - asked.clock.start for k in rows]
    motion = solution(replace(asked, track=frozenset(TRACKED[asked.model])), "taylor").motion(
        elapsed, 15
    )
    for name, values in motion.quantities.items():
        for k, value in zip(rows, values, strict=True):
            exact = [float(entry) for entry in value.flat]
            assert max(map(abs, exact)) < 10
            assert np.abs(np.array(course[name][k]) - exact).max() <= 1.01 * HALF


# What is drawn besides


def test_the_principal_frame_makes_the_tensor_again() -> None:
    """The moments about the axes add up to the scene's tensor, and the axes are right-handed."""
    for name in SCENES:
        body, frame = load(name).body, stored(name)["body"]
        assert (frame is None) == isinstance(body, ImmersedBody)
        if isinstance(body, RigidBody):
            axes, moments = np.array(frame["axes"]), np.array(frame["principal_moments"])
            inertia = np.array([[float(entry) for entry in row] for row in body.inertia])
            assert np.linalg.det(axes) == pytest.approx(1, abs=1e-8)
            assert np.abs(axes.T @ np.diag(moments) @ axes - inertia).max() <= 1e-8 * moments.max()


# The equations


def test_the_equations_name_what_acts_and_what_is_tracked() -> None:
    """A load stands in them if it acts, the attitude and the centre if they are tracked."""
    for name in SCENES:
        scene = load(name)
        lines = "\n".join(equations(scene))
        body = scene.body
        if scene.model == "euler":
            # Wheels that a text writes are no moment.
            loads = body.loads
            acts = loads is None or loads.hung or any(any(own) for _, own in loads.vectors)
            assert (r"\mathbf M" in lines) == (not body.is_free and bool(acts))
        else:
            assert isinstance(scene.initial, Impulse)
            assert (r"+ \mathbf X" in lines) == bool(body.loads or any(body.force))
            assert (r"+ \mathbf L" in lines) == bool(body.loads or any(body.couple))
        assert (r"\dot{\mathsf R}" in lines) == bool(scene.track)
        assert (r"\dot{\mathbf c}" in lines) == ("centre" in scene.track)
        assert equations(scene) == stored(name)["tex"]


# The files


def test_the_command_writes_one_file_a_scene(
    tmp_path: Path, capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """`publish portraits` tells each scene as it ends; in the file is all that `explain` says."""
    monkeypatch.setattr("taylor_verify.scenes.library.names", lambda: ("euler/rest",))
    assert main(["publish", "portraits", "--from", str(tmp_path)]) == 0
    out, err = capfd.readouterr()
    assert "1/1 euler/rest" in err
    assert out.split() == [str(tmp_path / PORTRAITS.folder / "euler-rest.json")]
    explained = explanation("euler/rest", "f64")
    explained["cost"]["seconds"] = None
    written = PORTRAITS.find(tmp_path, "euler/rest")
    assert written is not None
    assert written["explain"] == json.loads(json.dumps(explained))
