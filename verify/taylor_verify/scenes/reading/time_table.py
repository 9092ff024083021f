"""The ``[time]`` table of a scene becomes its exact instants."""

from __future__ import annotations

from fractions import Fraction
from typing import Final

from taylor_verify.numbers.tensors import Vector
from taylor_verify.records.faults import shown
from taylor_verify.scenes.instants import EquallySpaced
from taylor_verify.scenes.motion import Clock
from taylor_verify.scenes.reading.table import Table

MOST_SAMPLES: Final = 1_000_000


def clock(table: Table) -> Clock | None:
    """Return the start and the instants: those in ``at``, or equally spaced ones up to ``end``.

    None after a fault.
    """
    start = table.number("start", default=Fraction(0))
    return _listed(table, start) if table.has("at") else _equally_spaced(table, start)


def _listed(table: Table, start: Fraction | None) -> Clock | None:
    """Return the instants of ``at``; ``end`` and ``samples`` beside it are faults."""
    instants = table.numbers("at", most=MOST_SAMPLES)
    for key in ("end", "samples"):
        if table.has(key):
            table.take(key, "nothing")
            table.fault("either `at` or `end` with `samples`", "both", key, f"remove `{key}`")
    if instants is None or start is None or not _moves_away(table, instants, start):
        return None
    return Clock(start, instants)


def _moves_away(table: Table, instants: Vector, start: Fraction) -> bool:
    """Return True if the instants leave the start on one side of it and never turn back."""
    elapsed = [instant - start for instant in instants]
    side = next((time for time in elapsed if time != 0), None)
    if side is None:
        got = "only the start itself" if instants else "no instant"
        table.fault("an instant other than the start", got, "at")
        return False
    crossed = [i for i, time in enumerate(elapsed) if time * side < 0]
    turned = [i for i in range(1, len(elapsed)) if abs(elapsed[i]) <= abs(elapsed[i - 1])]
    for i in crossed:
        expected = f"all instants on one side of start = {shown(start)}"
        table.fault(expected, shown(instants[i]), f"at[{i}]")
    for i in sorted(set(turned).difference(crossed)):
        got = f"{shown(instants[i])} after {shown(instants[i - 1])}"
        table.fault("instants that move away from the start", got, f"at[{i}]")
    return not crossed and not turned


def _equally_spaced(table: Table, start: Fraction | None) -> Clock | None:
    """Return start + k (end - start)/(samples - 1), both ends included."""
    end, samples = table.number("end"), table.number("samples")
    if end is not None and end == start:
        table.fault("an end other than the start", shown(end), "end", "the time span is empty")
        end = None
    if samples is not None and (samples.denominator != 1 or not 2 <= samples <= MOST_SAMPLES):
        table.fault(f"an integer from 2 to {MOST_SAMPLES}", shown(samples), "samples")
        samples = None
    if start is None or end is None or samples is None:
        return None
    return Clock(start, EquallySpaced(start, (end - start) / (samples - 1), int(samples)))
