"""Limits of loads, as actuators have them: others than the scene's, and new ones."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import partial
from typing import Final

import numpy as np

from taylor_verify.judge.causes.changed_equations import Changes, Equations
from taylor_verify.judge.causes.changed_texts import NAME, has_text
from taylor_verify.judge.causes.fit import Family
from taylor_verify.judge.causes.float_answer import Answer, velocities_of
from taylor_verify.judge.causes.limits import bounds
from taylor_verify.judge.causes.many_flows import Floats
from taylor_verify.judge.causes.written_numbers import Number, numbers
from taylor_verify.models.acting import Acting
from taylor_verify.numbers.tensors import ZERO_VECTOR
from taylor_verify.scenes.loads.loads import Loads

# Parts of the largest load at which the fit of a limit begins.
_BEGINS: Final = (0.1, 0.2, 0.35, 0.5, 0.65, 0.8, 0.92)
_FACTORS: Final = (0.1, 0.2, 0.35, 0.5, 0.65, 0.8, 0.92, 1.2, 1.6, 2.5)
_EACH: Final = "a limit of the {} on each axis"
_LENGTH: Final = "a limit of the length of the {}"


def own_limits(right: Equations) -> Iterator[tuple[Family, Floats]]:
    """Yield the limits that a scene has, and where their fits may begin: what none limits has no slope."""
    ends = bounds(right.loads)
    for number in numbers(right.loads) if right.loads is not None and ends else ():
        other = number.with_value(2 * number.value)
        if other is not None and _moved(number, ends, other) == 2:
            yield number.family(right), number.value * np.array(_FACTORS)


def _moved(number: Number, ends: Sequence[tuple[str, str]], other: Loads) -> int:
    """Return how many ends of a clip another value of a number moves, at most."""
    changed = zip(ends, bounds(other), strict=True)
    return max(
        sum(one != two or number.name in NAME.findall(one) for one, two in zip(*pair, strict=True))
        for pair in changed
    )


def new_limits(answer: Answer) -> Iterator[tuple[Family, Floats]]:
    """Yield limits that vectors of texts do not have, as actuators do, and where their fits may begin."""
    acting = answer.right.acting
    if acting is None:
        return
    for name, entries in acting.written.vectors:
        sizes = _sizes(answer, acting, name) if has_text(entries) else np.zeros(1)
        if not np.ptp(sizes) > 0:
            continue
        largest = float(np.max(sizes))
        for words in (_EACH, _LENGTH):
            changes = partial(_limited_by, acting, name, words is _EACH)
            family = Family(words.format(name), "limit", np.zeros(1), np.array([largest]), changes)
            yield family, largest * np.array(_BEGINS)


def _sizes(answer: Answer, acting: Acting, name: str) -> Floats:
    """Return the sizes of a vector of texts at the rows of the file."""
    loads, right = acting.written, answer.right
    vectors = tuple((n, own if n == name else ZERO_VECTOR) for n, own in loads.vectors)
    alone = acting.of(replace(loads, vectors=vectors, hung=()))
    z, nu = answer.states(right.coupled).T[None], velocities_of(right, answer.file.v).T[None]
    only = replace(right, acting=alone, load=np.zeros(right.size))
    return np.asarray(np.linalg.norm(only.loads_at(answer.times, z, nu)[0], axis=0))


def _limited_by(acting: Acting, name: str, is_each: bool, values: Floats) -> Changes:
    """Return a vector of texts within a limit; raises ValueError where it is none."""
    loads, limit = acting.written, float(values[0])
    if not limit > 0:
        raise ValueError(limit)
    entries = [f"({entry})" for entry in dict(loads.vectors)[name]]
    length = f"max(norm({', '.join(entries)}), {limit!r})"
    texts = tuple(
        f"clip({entry}, -{limit!r}, {limit!r})" if is_each else f"{entry}*{limit!r}/{length}"
        for entry in entries
    )
    vectors = tuple((n, texts if n == name else own) for n, own in loads.vectors)
    return {"acting": acting.of(replace(loads, vectors=vectors))}
