"""The system of a scene: of its body alone, or under written loads."""

from __future__ import annotations

from taylor_verify.exact.enclosure.loaded import LoadedBody
from taylor_verify.exact.enclosure.system import System, always, natural
from taylor_verify.exact.enclosure.tape import Graph, Tape
from taylor_verify.exact.registry import kind_of
from taylor_verify.scenes.scene import Scene


def posed(scene: Scene) -> System:
    """The equations of a scene's body, and where its motion begins."""
    body, kind = scene.body, kind_of(scene.body)
    if body.loads is not None:
        return LoadedBody(scene, body.loads).system()
    start, equations, graph = kind.state(scene.initial), kind.equations(body), Graph()
    rates = natural(graph, equations, graph.states(len(start)))
    return always(
        Tape.of(graph, len(start), rates),
        tuple(range(3, len(start) + 1, 3)),
        start,
        equations.spin,
        equations.velocity,
    )
