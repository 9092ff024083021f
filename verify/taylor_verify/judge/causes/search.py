"""The likely causes of a failure: every hypothesis tried on one answer, the best of them said.

To add a hypothesis: write a function from Material to candidates in the file of its family, name it in
DYNAMICS or OTHERS, write its broken twin in tests/judge/test_causes.py and its line in docs/verdicts.md.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from typing import Final

from taylor_verify.judge.causes.damping import damping
from taylor_verify.judge.causes.damping_step import damping_step, wrong_damping
from taylor_verify.judge.causes.gyroscopic import gyroscopic_step
from taylor_verify.judge.causes.kinematics import kinematics
from taylor_verify.judge.causes.material import Candidate, Material
from taylor_verify.judge.causes.readings import attitude_reading, omega_reading
from taylor_verify.judge.causes.rows import another_scene, other_rows
from taylor_verify.judge.causes.single_precision import single_precision
from taylor_verify.judge.causes.tensor import another_body, other_tensors
from taylor_verify.judge.causes.terms import loads, space_loads, wrong_terms
from taylor_verify.judge.errors.shift import LEAVES
from taylor_verify.records.answers import LikelyCause
from taylor_verify.scenes.scene import Scene

Hypothesis = Callable[[Material], Iterator[Candidate]]

# Two candidates explain equally well if the better one leaves at least a third of what the other leaves,
_ALIKE: Final = 3.0
# or if both leave less than this part of the error.
_NOTHING: Final = 1e-3

# Those about the states' own equations, those with no number to fit first.
DYNAMICS: Final[tuple[Hypothesis, ...]] = (
    *(other_tensors, loads, space_loads, wrong_terms, wrong_damping),
    *(gyroscopic_step, damping, damping_step, another_body),
)
# Those about rows, attitudes and numbers.
OTHERS: Final[tuple[Hypothesis, ...]] = (other_rows, kinematics, single_precision)


def likely_causes(material: Material | None, scene: Scene) -> tuple[LikelyCause, ...]:
    """Return the causes that explain nearly all of an error, quantity by quantity; none by chance."""
    if material is None or not material.failed:
        return ()
    attitude, turned = attitude_reading(material)
    omega, read, tried = omega_reading(turned, _dynamics)
    for hypothesis in OTHERS:
        tried += [one for one in hypothesis(read) if one.quantity in material.failed]
    others = list(another_scene(material, scene))
    if any(one.is_sure for one in others):
        omega, attitude, tried = [], [], []
    every = ([*omega, *attitude], tried, others)
    return tuple(cause for candidates in every for cause in _causes_of(candidates))


def _dynamics(material: Material) -> list[Candidate]:
    """The candidates for the equations of the states, where their defects tell anything."""
    if material.quantity not in material.failed or not material.is_telling:
        return []
    return [one for hypothesis in DYNAMICS for one in hypothesis(material)]


# The choice.


def _causes_of(candidates: Iterable[Candidate]) -> tuple[LikelyCause, ...]:
    """Return the best candidates for each quantity; none where no candidate explains nearly all."""
    good = [one for one in candidates if one.leaves <= LEAVES]
    quantities = dict.fromkeys(one.quantity for one in good)
    return tuple(
        one.cause()
        for quantity in quantities
        for one in _best([one for one in good if one.quantity == quantity])
    )


def _best(good: list[Candidate]) -> Iterable[Candidate]:
    """The candidates that explain as well as any with the fewest fitted numbers, by name."""
    least = max(min(one.leaves for one in good), _NOTHING)
    alike = [one for one in good if one.leaves <= _ALIKE * least]
    fewest = min(one.fitted for one in alike)
    simple = sorted((one for one in alike if one.fitted == fewest), key=lambda one: one.leaves)
    first: dict[str, Candidate] = {}
    for one in simple:
        first.setdefault(one.name, one)
    return first.values()
