"""The likely causes of a failure: every hypothesis tried on one answer, the best of them said.

To add a hypothesis: write a function from Material to candidates in the file of its family, name it in
HYPOTHESES, write its broken twin in tests/test_causes.py and its line in docs/verdicts.md.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Final

import numpy as np

from taylor_verify.judge.causes.candidate import Candidate, causes_of
from taylor_verify.judge.causes.damping import damping
from taylor_verify.judge.causes.gyroscopic import gyroscopic_step, gyroscopic_term
from taylor_verify.judge.causes.kinematics import in_body_axes, kinematics
from taylor_verify.judge.causes.material import Material
from taylor_verify.judge.causes.rows import other_rows
from taylor_verify.judge.causes.single_precision import single_precision
from taylor_verify.judge.causes.tensor import another_body, other_tensors
from taylor_verify.judge.causes.terms import fluid_terms, loads
from taylor_verify.judge.shift import LEAVES
from taylor_verify.records.answers import LikelyCause

Hypothesis = Callable[[Material], Iterator[Candidate]]

# Those about the states' own equations, those with no number to fit first.
DYNAMICS: Final[tuple[Hypothesis, ...]] = (
    gyroscopic_term,
    other_tensors,
    loads,
    fluid_terms,
    gyroscopic_step,
    damping,
    another_body,
)
# Those about rows, attitudes and numbers.
OTHERS: Final[tuple[Hypothesis, ...]] = (other_rows, kinematics, single_precision)


def likely_causes(material: Material) -> tuple[LikelyCause, ...]:
    """Return the causes that explain nearly all of an error, quantity by quantity; none by chance."""
    with np.errstate(all="ignore"):  # an answer that runs away has no cause here
        return causes_of(_candidates(material))


def _candidates(material: Material) -> Iterator[Candidate]:
    tried = list(_dynamics(material)) if material.quantity in material.failed else []
    if not any(one.leaves <= LEAVES for one in tried):
        tried += _space_axes(material) if material.quantity in material.failed else []
    yield from tried
    for hypothesis in OTHERS:
        yield from (one for one in hypothesis(material) if one.quantity in material.failed)


def _dynamics(material: Material) -> Iterator[Candidate]:
    if material.is_telling:
        for hypothesis in DYNAMICS:
            yield from hypothesis(material)


def _space_axes(material: Material) -> Iterator[Candidate]:
    """Yield omega in space axes where the answer's own attitude makes a motion of it, right or wrong."""
    if not material.is_telling:
        return
    for words, turned in in_body_axes(material):
        name = "omega in space axes"
        why = f"taken to body axes by the answer's own attitude it is the exact motion{words}"
        left = turned.pairs.largest / material.pairs.largest
        yield Candidate(name, "omega", left, why)
        if left > LEAVES:
            for one in _dynamics(turned):
                why = f"omega is in space axes{words}, and in body axes {one.why}"
                yield Candidate(f"omega in space axes, {one.name}", "omega", one.leaves, why, one.fitted)
