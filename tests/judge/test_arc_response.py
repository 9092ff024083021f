"""Response of arcs to other loads: the derivative of their flow, and its small change."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from builders.wrong_dynamics import failure
from scipy.spatial.transform import Rotation

from taylor_verify import exact
from taylor_verify.judge.causes.arc_response import ArcResponse, sketched_rests
from taylor_verify.judge.causes.arcs import Arcs, row_to_row
from taylor_verify.judge.causes.changed_texts import rewritten
from taylor_verify.judge.causes.float_answer import Motion
from taylor_verify.judge.causes.material import material
from taylor_verify.judge.causes.quaternion_rows import steady_signs
from taylor_verify.models.problem import adopt
from taylor_verify.numbers.precision import rung
from taylor_verify.scenes.reading.reader import read

TOP = """
title = "A top with drag"
model = "euler"
track = ["attitude"]
[body]
inertia = [[2, 0.1, 0], [0.1, 1.5, 0.2], [0, 0.2, 1]]
moment = ["0.6*d2 - 0.2*w1", "-0.6*d1 - 0.1*abs(w2)*w2", "0.3*sin(t)"]
[space]
d = [0, 0, -1]
[initial]
omega = [0.3, -0.5, 0.4]
attitude = [0.8, 0.2, -0.4, 0.4]
[time]
end = 6
samples = 25
"""


def arcs_of(text: str) -> Arcs:
    """The arcs between the rows of the exact motion of another top, as an answer to TOP."""
    scene = read(TOP, "top")
    times = scene.clock.instants
    motion = exact(read(text, "other"), times, 17).quantities
    turns = Rotation.from_matrix(motion["attitude"].astype(float)).as_quat(scalar_first=True)
    file = Motion(motion["omega"].astype(float), steady_signs(turns))
    given = adopt(scene, rung("f64"), times).given
    verdicts = [failure(given, name) for name in ("omega", "attitude")]
    answer = material(given, file, False, (np.full(3, 1e-13), 1e-13, 0.0), verdicts)
    assert answer is not None
    return row_to_row(answer)


def changes_of(arcs: Arcs, old: str, new: str) -> dict[str, Any]:
    acting = arcs.answer.right.acting
    assert acting is not None
    return {"acting": acting.of(rewritten(acting.written, lambda text: text.replace(old, new)))}


@pytest.mark.parametrize(("old", "new"), [("0.6", "0.60006"), ("0.1*abs", "0.10001*abs")])
def test_the_response_is_the_difference_of_flows(old: str, new: str) -> None:
    """A load that differs by a ten-thousandth changes the ends as a flow through the arcs does."""
    arcs = arcs_of(TOP.replace("0.2*w1", "0.25*w1"))
    changes = changes_of(arcs, old, new)
    by_flow = arcs.of_right - arcs.defects([changes])[0]
    by_response = ArcResponse(arcs, 7).compared(arcs.answer.right.changed(changes))
    assert np.allclose(by_response, by_flow, rtol=0, atol=2e-3 * np.max(np.abs(by_flow)))


def test_what_leads_to_the_answer_is_asked_for_by_flows() -> None:
    """A change that is large and right leaves nothing, whatever its response is to first order."""
    arcs = arcs_of(TOP.replace("0.6*d", "(-0.6)*d"))
    right, wrong = (changes_of(arcs, "0.6*d", new) for new in ("(-0.6)*d", "1.2*d"))
    (left, more), size = sketched_rests(arcs, [right, wrong]), arcs.size
    assert np.linalg.norm(left) < 0.02 * size < size < np.linalg.norm(more)
