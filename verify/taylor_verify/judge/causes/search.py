"""The likely causes of a failure: every hypothesis tried on one answer, the best of them said.

To add a hypothesis: write a function from Material to candidates in the file of its family, name it in
HYPOTHESES, write its broken twin in tests/judge/test_causes.py and its line in docs/verdicts.md.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Final

from taylor_verify.judge.causes.another_scene import another_scene
from taylor_verify.judge.causes.candidate import Candidate, causes_of
from taylor_verify.judge.causes.damping import damping
from taylor_verify.judge.causes.gyroscopic import gyroscopic_step, gyroscopic_term
from taylor_verify.judge.causes.kinematics import kinematics
from taylor_verify.judge.causes.material import Material
from taylor_verify.judge.causes.rows import other_rows
from taylor_verify.judge.causes.single_precision import single_precision
from taylor_verify.judge.causes.space import space_loads, space_readings
from taylor_verify.judge.causes.start import attitude_reading
from taylor_verify.judge.causes.tensor import another_body, other_tensors
from taylor_verify.judge.causes.terms import fluid_terms, loads
from taylor_verify.judge.errors.shift import LEAVES
from taylor_verify.records.answers import LikelyCause
from taylor_verify.scenes.scene import Scene

Hypothesis = Callable[[Material], Iterator[Candidate]]

# Those about the states' own equations, those with no number to fit first.
DYNAMICS: Final[tuple[Hypothesis, ...]] = (
    gyroscopic_term,
    other_tensors,
    loads,
    space_loads,
    fluid_terms,
    gyroscopic_step,
    damping,
    another_body,
)
# Those about rows, attitudes and numbers.
OTHERS: Final[tuple[Hypothesis, ...]] = (other_rows, kinematics, single_precision)


def likely_causes(material: Material, scene: Scene) -> tuple[LikelyCause, ...]:
    """Return the causes that explain nearly all of an error, quantity by quantity; none by chance."""
    attitude, turned = attitude_reading(material)
    omega, read, tried = _read(turned)
    for hypothesis in OTHERS:
        tried += [one for one in hypothesis(read) if one.quantity in material.failed]
    others = list(another_scene(material, scene)) if material.failed else []
    if any(one.is_sure for one in others):
        omega, attitude, tried = [], [], []
    every = ([*omega, *attitude], tried, others)
    return tuple(cause for candidates in every for cause in causes_of(candidates))


def _read(material: Material) -> tuple[list[Candidate], Material, list[Candidate]]:
    """Return a reading of omega in space axes, if one is proven, the answer so read, its candidates."""
    plain = _dynamics(material)
    by_motion = bool(plain) and not any(one.leaves <= LEAVES for one in plain)
    for reading in space_readings(material) if "omega" in material.failed else ():
        if reading.is_refuted(material):
            continue
        tried = _dynamics(reading.material)
        left = reading.leaves(material, tried, by_motion)
        if left is not None:
            return [reading.candidate(left)], reading.material, tried
    return [], material, plain


def _dynamics(material: Material) -> list[Candidate]:
    """The candidates for the equations of the states, where their defects tell anything."""
    if material.quantity not in material.failed or not material.is_telling:
        return []
    return [one for hypothesis in DYNAMICS for one in hypothesis(material)]
