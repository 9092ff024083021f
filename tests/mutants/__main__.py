"""Draw mutants with a seed, run the tests of each changed line, print who lived (`make mutants`)."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Mapping, Sequence
from typing import Final

from mutants.copied import Copy, copied
from mutants.draw import drawn, of_line
from mutants.mutant import Mutant
from mutants.trace import Trace, trace

ROOMS: Final = ("claims", "exact", "judge")
AIM: Final = 0.97
# Seconds of the tests that are tried first: most mutants are noticed by them.
FIRST: Final = 5


def stages(
    names: Sequence[str], seconds: Mapping[str, float], budget: float
) -> list[dict[str, float]]:
    """Return the first tests that take no longer than the budget together, at least one, in two lots."""
    lots: tuple[dict[str, float], dict[str, float]] = ({}, {})
    spent = 0.0
    for name in names:
        spent += seconds[name]
        if lots[0] and spent > budget:
            break
        lots[bool(lots[0]) and spent > FIRST][name] = seconds[name]
    return [lot for lot in lots if lot]


def noticed(
    mutants: Sequence[Mutant], measured: Trace, copy: Copy, budget: float
) -> tuple[dict[Mutant, str], list[Mutant]]:
    """Return who is noticed, by which test, and who lived. Both are printed as they come."""
    by: dict[Mutant, str] = {}
    lived = []
    for n, mutant in enumerate(mutants, 1):
        every = measured.tests_of(mutant)
        lots = stages(every, measured.seconds, budget)
        name = copy.noticing(mutant, lots)
        if name is None:
            lived.append(mutant)
            tried = sum(map(len, lots))
            print(f"lived {tried} of the {len(every)} tests that run it: {mutant}", flush=True)
        else:
            by[mutant] = name
            print(
                f"{n}/{len(mutants)} {mutant.path}:{mutant.line} {name}",
                file=sys.stderr,
                flush=True,
            )
    return by, lived


def main() -> int:
    """Print each mutant that lived, and the score; 1 if that is below the aim."""
    parser = argparse.ArgumentParser(prog="make mutants", description=__doc__)
    parser.add_argument("rooms", nargs="*", default=ROOMS, help="default: %(default)s")
    parser.add_argument("--count", type=int, default=60)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument(
        "--after", type=int, default=0, help="leave out so many that are drawn first"
    )
    parser.add_argument("--line", help="PATH:NUMBER: all mutants of a line, instead of a draw")
    parser.add_argument("--budget", type=float, default=120, help="seconds of tests for a mutant")
    given = parser.parse_args()
    os.nice(19)
    measured = trace(ROOMS, [f"tests/{room}" for room in ROOMS])
    if given.line:
        path, _, line = given.line.rpartition(":")
        mutants = of_line(path, int(line))
    else:
        mutants = drawn(given.rooms, given.after + given.count, given.seed)[given.after :]
    with copied() as copy:
        by, lived = noticed(mutants, measured, copy, given.budget)
        seconds = {name: measured.seconds[name] for name in by.values()}
        failing = copy.failing_without(list(by), seconds)
    for mutant, name in by.items():
        if name in failing:
            lived.append(mutant)
            print(f"lived, for {name} fails without it: {mutant}", flush=True)
    score = 1 - len(lived) / len(mutants)
    place = f"after {given.after} of seed {given.seed}"
    print(f"{len(mutants) - len(lived)} of {len(mutants)} mutants noticed: {score:.1%}, {place}")
    return 0 if score >= AIM else 1


if __name__ == "__main__":
    sys.exit(main())
