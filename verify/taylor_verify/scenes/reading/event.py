"""The text of an event: ``EXPRESSION = EXPRESSION``, or ``extremum EXPRESSION``."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import Final, NamedTuple

from taylor_verify.records.faults import Refused, brief, refusal
from taylor_verify.scenes.loads.loads import Loads
from taylor_verify.scenes.loads.piece import FUNCTION, PieceReader
from taylor_verify.scenes.scene import Scene

_EXTREMUM: Final = re.compile(r"\s*extremum\b")
# x.y is the product of two vectors by their letters.
_PRODUCT: Final = re.compile(r"\b([wuxyc])\.([wuxyc])\b")
_FORM: Final = "`EXPRESSION = VALUE` or `extremum EXPRESSION`"


class Event(NamedTuple):
    """The times at which an expression is zero, or extremal; ``loads`` are a scene's, and have it."""

    text: str
    loads: Loads
    is_extremum: bool


def event_of(scene: Scene, text: str) -> Event:
    """Return the event that a text writes. Raises Refused with all of its faults."""
    if not isinstance(text, str):
        raise refusal(_FORM, brief(text), FUNCTION)
    extremum = _EXTREMUM.match(text)
    # Blanks stand for the word, so that columns stay what they are.
    written = " " * extremum.end() + text[extremum.end() :] if extremum else _difference(text)
    expression = _PRODUCT.sub(_sum_of_products, written)
    loads = replace(loads_of(scene), functions=(expression,))
    _check(loads, expression)
    return Event(text, loads, extremum is not None)


def loads_of(scene: Scene) -> Loads:
    """Return the loads of a scene's body, or loads that do nothing."""
    body = scene.body
    inertia = getattr(body, "inertia", None)
    return body.loads or Loads(scene.model, (), inertia=inertia, origin=scene.clock.start)


def _difference(text: str) -> str:
    left, equals, right = text.partition("=")
    if not equals or not left.strip() or not right.strip() or left[-1] in "<>!" or "=" in right:
        raise refusal(_FORM, f"`{text}`", FUNCTION)
    return f"{left}-({right})"


def _sum_of_products(match: re.Match[str]) -> str:
    first, second = match.groups()
    return "({})".format("+".join(f"{first}{i}*{second}{i}" for i in (1, 2, 3)))


def _check(loads: Loads, expression: str) -> None:
    reader = PieceReader(loads, is_scan=True)
    reader.look_at((expression,), FUNCTION, is_vector=False)
    jumps = sorted(reader.reads().intersection(loads.held_values))
    got = ", ".join(f"`{name}`" for name in jumps) or ("a jump by the time" if reader.jumps else "")
    faults = [
        f"expected {fault.expected}, got {fault.got} @ {fault.place}, column {fault.column}"
        for fault in reader.faults()
    ]
    if got:
        faults.append(f"expected an expression that does not jump, got {got} @ {FUNCTION}")
    if faults:
        raise Refused(faults)
