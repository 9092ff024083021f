"""Search for the likely causes of a failure: every hypothesis is tested, and the best ones are returned.

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

# Two candidates explain equally well if the error that one leaves is at most three times the other's,
_ALIKE: Final = 3.0
# or if both leave less than this part of the error.
_NOTHING: Final = 1e-3

# Hypotheses about the equations of the states; those without fitted numbers come first.
DYNAMICS: Final[tuple[Hypothesis, ...]] = (
    other_tensors,
    loads,
    space_loads,
    wrong_terms,
    wrong_damping,
    gyroscopic_step,
    damping,
    damping_step,
    another_body,
)
# Hypotheses about rows, attitudes and number formats.
OTHERS: Final[tuple[Hypothesis, ...]] = (other_rows, kinematics, single_precision)


def likely_causes(material: Material | None, scene: Scene) -> tuple[LikelyCause, ...]:
    """Return the causes that explain nearly all of an error, quantity by quantity."""
    if material is None or not material.failed:
        return ()
    attitude, turned = attitude_reading(material)
    omega, read, tried = omega_reading(turned, _dynamics)
    for hypothesis in OTHERS:
        tried += [
            candidate for candidate in hypothesis(read) if candidate.quantity in material.failed
        ]
    others = list(another_scene(material, scene))
    if any(candidate.is_sure for candidate in others):
        omega, attitude, tried = [], [], []
    every = ([*omega, *attitude], tried, others)
    return tuple(cause for candidates in every for cause in _causes_of(candidates))


def _dynamics(material: Material) -> list[Candidate]:
    """Return the candidates for the equations of the states; none if the defects are roundoff."""
    if material.quantity not in material.failed or not material.is_telling:
        return []
    return [candidate for hypothesis in DYNAMICS for candidate in hypothesis(material)]


# The choice.


def _causes_of(candidates: Iterable[Candidate]) -> tuple[LikelyCause, ...]:
    """Return the best candidates for each quantity; none if none explains nearly all of the error."""
    good = [candidate for candidate in candidates if candidate.leaves <= LEAVES]
    quantities = dict.fromkeys(candidate.quantity for candidate in good)
    return tuple(
        candidate.cause()
        for quantity in quantities
        for candidate in _best([other for other in good if other.quantity == quantity])
    )


def _best(good: list[Candidate]) -> Iterable[Candidate]:
    """Return the candidates that explain best, with the fewest fitted numbers; one for each name."""
    least = max(min(candidate.leaves for candidate in good), _NOTHING)
    alike = [candidate for candidate in good if candidate.leaves <= _ALIKE * least]
    fewest = min(candidate.fitted for candidate in alike)
    simple = [candidate for candidate in alike if candidate.fitted == fewest]
    first: dict[str, Candidate] = {}
    for candidate in sorted(simple, key=lambda candidate: candidate.leaves):
        first.setdefault(candidate.name, candidate)
    return first.values()
