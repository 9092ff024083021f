"""The loads of a manufactured motion as expressions of the time."""

from __future__ import annotations

from taylor_verify.exact.enclosure.functions import Cosine, Sine
from taylor_verify.exact.enclosure.operations import Time
from taylor_verify.exact.enclosure.system import natural
from taylor_verify.exact.enclosure.tape import Graph, Sum
from taylor_verify.exact.equations import Equations
from taylor_verify.scenes.manufactured import Manufactured


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
