"""Notes on what cannot be judged, or is judged otherwise, under written loads."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Final

from taylor_verify.exact.invariants import invariants
from taylor_verify.records.verdict import Verdict
from taylor_verify.scenes.scene import Scene

NO_BALANCES: Final = (
    "the momenta are not judged, and of the energy only its value: the loads depend on more of the "
    "attitude or the centre than a row of the file determines"
)
NOTHING_CONSERVED: Final = (
    "no quantity was found that these loads conserve, so no conserved quantity is gated"
)
# One quantity of each model that every balance comes with.
_BALANCED: Final = ("H2", "F2")


def load_notes(scene: Scene, verdicts: Sequence[Verdict]) -> Iterator[str]:
    """Yield the notes of a judged answer; none without written loads."""
    if scene.body.loads is None:
        return
    if not any(invariant.is_conserved for invariant in invariants(scene)):
        yield NOTHING_CONSERVED
    if not any(verdict.quantity in _BALANCED for verdict in verdicts):
        yield NO_BALANCES
