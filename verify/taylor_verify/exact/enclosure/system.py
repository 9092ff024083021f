"""The equations of a scene as tapes, one for each piece of time between two switches of its loads.

The state is z = omega, or z = (x, y). The body's spin Omega = W z and, for a solid in a fluid, the
velocity of its origin U = Y z are linear in z. All of it is exact; numbers become balls at the precision of
a course.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from flint import arb, arb_mat

from taylor_verify.exact.balls import balls
from taylor_verify.exact.clocks import Exact
from taylor_verify.exact.enclosure.functions import Cosine, Sine
from taylor_verify.exact.enclosure.operations import Time
from taylor_verify.exact.enclosure.tape import Graph, Sum, Tape
from taylor_verify.exact.equations import Equations
from taylor_verify.exact.registry import kind_of
from taylor_verify.scenes.manufactured import Manufactured
from taylor_verify.scenes.scene import Scene
from taylor_verify.scenes.tensors import Vector


class Piece(NamedTuple):
    """A tape, and the first time at which it is another one, in the direction of the motion; or None."""

    tape: Tape
    end: Fraction | None


@dataclass(frozen=True)
class System:
    """The equations as a tape for each piece of time, and the state at time zero, ``start``, exactly.

    ``pieces`` takes an elapsed time and whether the motion goes on to later ones. ``blocks`` are the ends
    of the vectors that z is made of; ``spin`` and ``velocity`` are W and Y. The centre drifts with the
    ``current`` of the fluid, if there is one.
    """

    pieces: Callable[[Fraction, bool], Piece]
    blocks: tuple[int, ...]
    start: Vector
    spin: Exact
    velocity: Exact
    current: Vector = ()

    @property
    def size(self) -> int:
        return len(self.start)

    @property
    def spans(self) -> list[range]:
        """The places of each block in z."""
        return [range(first, last) for first, last in pairwise((0, *self.blocks))]


def posed(scene: Scene) -> System:
    """The equations of a scene's body, and where its motion begins."""
    body, kind = scene.body, kind_of(scene.body)
    if body.loads is not None:
        from taylor_verify.exact.enclosure.loaded import LoadedBody

        return LoadedBody(scene, body.loads).system()
    start, equations, graph = kind.state(scene.initial), kind.equations(body), Graph()
    rates = natural(graph, equations, graph.states(len(start)))
    if body.manufactured is not None:
        motion = driven(graph, equations, body.manufactured)
        rates = [rate + load for rate, load in zip(rates, motion, strict=True)]
    return always(
        Tape.of(graph, len(start), rates),
        tuple(range(3, len(start) + 1, 3)),
        start,
        equations.spin,
        equations.velocity,
    )


def always(
    tape: Tape, blocks: tuple[int, ...], start: Vector, spin: Exact, velocity: Exact
) -> System:
    """The system of one tape for all times."""
    return System(lambda time, is_later: Piece(tape, None), blocks, start, spin, velocity)


def natural(graph: Graph, equations: Equations, z: Sequence[Sum]) -> list[Sum]:
    """N(z) = constant + linear z + z.hessian z/2."""
    rates = [Sum(constant) for constant in equations.constant]
    for i, j in zip(*np.nonzero(equations.linear), strict=True):
        rates[i] += z[j].times(equations.linear[i, j])
    for i, a, b in zip(*np.nonzero(equations.hessian), strict=True):
        if a <= b:
            share = Fraction(1, 2) if a == b else Fraction(1)
            rates[i] += graph.product(z[a], z[b]).times(share * equations.hessian[i, a, b])
    return rates


def driven(graph: Graph, equations: Equations, motion: Manufactured) -> list[Sum]:
    """The loads z*' - N(z*) of a manufactured motion z*."""
    wanted, rates = (
        [Sum(constant) for constant in motion.constant],
        [Sum() for _ in motion.constant],
    )
    for wave in motion.waves:
        angle = graph.node(Time()).times(wave.frequency)
        sine, cosine = graph.pair(Sine, Cosine, angle)
        for i, (c, s) in enumerate(zip(wave.cosine, wave.sine, strict=True)):
            wanted[i] += cosine.times(c) + sine.times(s)
            rates[i] += cosine.times(wave.frequency * s) - sine.times(wave.frequency * c)
    needed = natural(graph, equations, wanted)
    return [rate - other for rate, other in zip(rates, needed, strict=True)]


@dataclass(frozen=True)
class Forms:
    """W and Y in balls, or bounds of them."""

    spin: arb_mat
    velocity: arb_mat

    @classmethod
    def of(cls, system: System) -> Forms:
        """The balls at the ambient precision."""
        return cls(
            *(arb_mat([balls(row) for row in form]) for form in (system.spin, system.velocity))
        )

    def magnitudes(self) -> Forms:
        """Upper bounds of the magnitudes."""
        return Forms(magnitudes(self.spin), magnitudes(self.velocity))


def magnitudes(matrix: arb_mat) -> arb_mat:
    """Upper bounds of the magnitudes of the entries: exact numbers."""
    return mapped(arb.abs_upper, matrix)


def mapped(change: Callable[[arb], arb], matrix: arb_mat) -> arb_mat:
    """The matrix with every entry changed."""
    return arb_mat(matrix.nrows(), matrix.ncols(), [change(entry) for entry in matrix.entries()])


def column(entries: Sequence[arb]) -> arb_mat:
    return arb_mat(len(entries), 1, list(entries))
