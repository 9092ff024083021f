"""The equations of a scene as tapes, one for each piece of time between two switches of its loads.

The state is z = omega, or z = (x, y), and what the scene and its loads add (`loaded`). All of it is exact;
numbers become balls at the precision of a course.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from flint import arb, arb_mat

from taylor_verify.exact.balls import balls
from taylor_verify.exact.enclosure.tape import Graph, Sum, Tape, vanishes
from taylor_verify.exact.quadratic_forms import Equations
from taylor_verify.numbers.tensors import Vector
from taylor_verify.scenes.loads.states import Instant


class Piece(NamedTuple):
    """A tape, and the first time at which it is another one, in the direction of the motion; or None.

    Where ``image`` is a tape, its outputs are omega, and stand in rows for the momentum.
    Those of ``functions`` are wanted all along the motion.
    """

    tape: Tape
    end: Fraction | None
    image: Tape | None = None
    functions: Tape | None = None


class Taken(NamedTuple):
    """A tape of values that are taken at one instant, and the places of the state that they go to."""

    tape: Tape
    places: Sequence[int]


@dataclass(frozen=True)
class System:
    """The equations as a tape for each piece of time, and the state at time zero, ``start``, exactly.

    ``pieces`` takes an elapsed time and whether the motion goes on to later ones. ``blocks`` are the ends
    of the vectors that z is made of. ``framed`` makes the nine entries of R of a state; None where the
    attitude is not tracked.

    ``begin`` makes balls of the start at a time, where that is no exact one. If values are taken there,
    ``exactly`` is the start in exact numbers, as far as it has any. ``own`` are the places of the scene's
    own states, behind all others. ``instants`` up to an elapsed time are those at which values are
    ``taken``; None where no value is held. ``step_text`` writes a step of the loads of an elapsed time
    as text, with its place in the scene. ``moving`` are the names of the first blocks.
    """

    pieces: Callable[[Fraction, bool], Piece]
    blocks: tuple[int, ...]
    start: Vector
    framed: Callable[[Sequence[arb]], list[arb]] | None = None
    begin: Callable[[Fraction], list[arb]] | None = None
    exactly: Sequence[Any] | None = None
    own: Mapping[str, range] = field(default_factory=dict)
    instants: Callable[[Fraction], Sequence[Instant]] | None = None
    taken: Callable[[Instant], Taken] | None = None
    step_text: Callable[[Fraction, bool, int], str] | None = None
    moving: Sequence[str] = ()

    def start_balls(self, time: Fraction = Fraction(0)) -> list[arb]:
        """The start in balls at the ambient precision, for a motion that begins at an elapsed time."""
        return balls(self.start) if self.begin is None else self.begin(time)

    @property
    def others(self) -> list[range]:
        """The places of each block but the own states."""
        return self.spans[: len(self.blocks) - len(self.own)]

    @property
    def named(self) -> dict[str, range]:
        """The places of each block that has a name."""
        return {**dict(zip(self.moving, self.spans, strict=False)), **self.own}

    @property
    def size(self) -> int:
        return len(self.start)

    @property
    def spans(self) -> list[range]:
        """The places of each block in z."""
        return [range(first, last) for first, last in pairwise((0, *self.blocks))]


def natural(graph: Graph, equations: Equations, z: Sequence[Sum]) -> list[Sum]:
    """N(z) = constant + linear z + z.hessian z/2."""
    rates = [Sum(constant) for constant in equations.constant]
    for (i, j), number in np.ndenumerate(equations.linear):
        rates[i] += z[j].times(number)
    for (i, a, b), number in np.ndenumerate(equations.hessian):
        if a <= b and not vanishes(number):
            share = Fraction(1, 2) if a == b else Fraction(1)
            rates[i] += graph.product(z[a], z[b]).times(share * number)
    return rates


def magnitudes(matrix: arb_mat) -> arb_mat:
    """Upper bounds of the magnitudes of the entries: exact numbers."""
    return mapped(arb.abs_upper, matrix)


def intervals(bounds: arb_mat) -> arb_mat:
    """The interval from -b to b in place of every bound b."""
    return mapped(lambda bound: arb(0, bound), bounds)


def reached(matrix: arb_mat, bounds: arb_mat) -> arb_mat:
    """Bounds of the components of matrix u for all |u_j| <= bounds_j, or of a matrix of such columns u."""
    return magnitudes(matrix * intervals(bounds))


def mapped(change: Callable[[arb], arb], matrix: arb_mat) -> arb_mat:
    """The matrix with every entry changed."""
    return arb_mat(matrix.nrows(), matrix.ncols(), [change(entry) for entry in matrix.entries()])


def column(entries: Sequence[arb]) -> arb_mat:
    return arb_mat(len(entries), 1, list(entries))
