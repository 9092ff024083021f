"""Every gate has a broken twin that it catches, and lets the sound solver pass on the same scene."""

import math

import pytest

from verify.controls.defects import DEFECTS, Defect
from verify.judge.verdict import Status
from verify.run import run

BY_NAME = [pytest.param(defect, id=defect.name) for defect in DEFECTS]


@pytest.mark.parametrize("defect", BY_NAME)
def test_defect_is_caught_by_the_gate_named_for_it(defect: Defect) -> None:
    """The quantity named for a defect fails, and by more than any rounding could explain."""
    verdicts = {v.quantity: v for v in run(defect.scene, defect, "f64").verdicts}
    caught = verdicts[defect.gate]
    assert caught.verdict is Status.FAIL
    # A NaN has no ratio; any other of these defects is at least a thousand times the floor, so that
    # no choice of the gate's factor could hide it.
    assert caught.ratio is None or math.isnan(caught.ratio) or caught.ratio >= 1000


@pytest.mark.parametrize("scene", sorted({defect.scene for defect in DEFECTS}))
def test_sound_solver_passes_where_the_defects_fail(scene: str) -> None:
    """What fails in a control is the defect, not the scene: the sound solver passes every gate."""
    assert {v.verdict for v in run(scene, "taylor", "f64").verdicts} == {Status.PASS}


@pytest.mark.parametrize("name", ["gyroscopic-sign", "no-gyroscopic-term", "one-sample-late"])
def test_conserved_quantities_are_blind_to_a_wrong_motion(name: str) -> None:
    """A wrong sign, a lost gyroscopic term and a late sample conserve T and |H|^2 all the same."""
    (defect,) = (d for d in DEFECTS if d.name == name)
    verdicts = {v.quantity: v.verdict for v in run(defect.scene, defect, "f64").verdicts}
    assert verdicts == {"omega": Status.FAIL, "T": Status.PASS, "H2": Status.PASS}


def test_one_nan_fails_every_gate() -> None:
    """A NaN in one sample is no pass for any quantity that is computed from it."""
    (defect,) = (d for d in DEFECTS if d.name == "one-nan")
    assert {v.verdict for v in run(defect.scene, defect, "f64").verdicts} == {Status.FAIL}
