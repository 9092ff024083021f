"""All traps in the order of the page, and the rows that the published table is made of."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Final

from taylor_verify.judge.provenance import packages, processor
from taylor_verify.records.provenance import Machine
from taylor_verify.records.quantities import GATE_FACTOR
from traps.bodies import BODIES
from traps.clock import CLOCK
from traps.document import TrapsStudy
from traps.numbers import NUMBERS
from traps.outcomes import OUTCOMES
from traps.stored_code import STORED_CODE
from traps.trap import Trap


def _place(trap: Trap) -> tuple[str, int, str]:
    """T before S, then by number, then by letter."""
    number = trap.key[1:].rstrip("abc")
    return {"T": "0", "S": "1"}[trap.key[0]], int(number), trap.key


TRAPS: Final = tuple(sorted((*BODIES, *NUMBERS, *CLOCK, *OUTCOMES, *STORED_CODE), key=_place))


def study(
    traps: Iterable[Trap] = TRAPS, finished: Callable[[str], None] | None = None
) -> TrapsStudy:
    """Measure every trap; ``finished`` is called with the title of each as it ends."""
    rows = []
    for trap in traps:
        rows.append(trap.row())
        if finished is not None:
            finished(trap.title)
    made_on = Machine(processor=processor(), command="make traps")
    return TrapsStudy(packages(), made_on, GATE_FACTOR, tuple(rows))
