"""Notes on what cannot be judged, or is judged otherwise, under written loads."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from taylor_verify.exact.invariants import invariants
from taylor_verify.scenes.scene import Scene

NO_MOMENTA: Final = (
    "the momentum of body and wheels is not judged: that of the wheels is no sum of multiples of own "
    "states that the scene tracks"
)
NOTHING_CONSERVED: Final = (
    "no quantity was found that these loads conserve, so no conserved quantity is gated"
)
_HOLD: Final = "hold"


def breaks_of(scene: Scene) -> str:
    """Return where the equations of a scene jump in time, in words; empty where they do not.

    Of switches nothing is said where some of them are knots of a table without jumps.
    """
    loads, last = scene.body.loads, scene.clock.elapsed[-1]
    if loads is None:
        return ""
    inside = any(0 < abs(switch) < abs(last) for switch in loads.switches)
    jumps = all(table.kind == _HOLD for _, table in loads.tables)
    parts = ["the switches of the loads"] * (inside and jumps)
    parts += ["the instants of held states"] * bool(loads.instants(last))
    return " and ".join(parts)


def load_notes(scene: Scene) -> Iterator[str]:
    """Yield the notes of an answer that is judged; none without written loads."""
    if scene.body.loads is None:
        return
    known = invariants(scene)
    if not any(invariant.is_conserved for invariant in known):
        yield NOTHING_CONSERVED
    if scene.model == "euler" and all(invariant.name != "H2" for invariant in known):
        yield NO_MOMENTA
