"""The system of a scene: of its body alone, of a manufactured motion, or under written loads."""

from __future__ import annotations

from taylor_verify.exact.enclosure.functions import Cosine, Sine
from taylor_verify.exact.enclosure.loaded import LoadedBody
from taylor_verify.exact.enclosure.operations import Time
from taylor_verify.exact.enclosure.system import System, always, natural
from taylor_verify.exact.enclosure.tape import Graph, Sum, Tape
from taylor_verify.exact.equations import Equations
from taylor_verify.exact.registry import kind_of
from taylor_verify.scenes.manufactured import Manufactured
from taylor_verify.scenes.scene import Scene


def posed(scene: Scene) -> System:
    """The equations of a scene's body, and where its motion begins."""
    body, kind = scene.body, kind_of(scene.body)
    if body.loads is not None:
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
