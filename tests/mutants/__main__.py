"""Draw mutants with a seed, run the tests of each changed line, print who lived (`make mutants`)."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Mapping, Sequence
from typing import Final

from mutants.copied import copied
from mutants.draw import drawn, of_line
from mutants.mutant import Mutant
from mutants.trace import trace

ROOMS: Final = ("claims", "exact", "judge")
AIM: Final = 0.97


def within(names: Sequence[str], seconds: Mapping[str, float], budget: float) -> dict[str, float]:
    """Return the seconds of the first tests that stay within the budget together, of one at least."""
    chosen, spent = {}, 0.0
    for name in names:
        spent += seconds[name]
        if chosen and spent > budget:
            break
        chosen[name] = seconds[name]
    return chosen


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
    every = {one: measured.tests_of(one) for one in mutants}
    tests = {one: within(names, measured.seconds, given.budget) for one, names in every.items()}
    by: dict[Mutant, str] = {}
    with copied() as copy:
        for n, (one, name) in enumerate(copy.noticing(tests), 1):
            if name:
                by[one] = name
                print(
                    f"{n}/{len(mutants)} {one.path}:{one.line} {name}", file=sys.stderr, flush=True
                )
            else:
                of_all = f"{len(tests[one])} of the {len(every[one])} tests that run it"
                print(f"lived after {of_all}: {one}", flush=True)
        failing = copy.failing(mutants, {name: measured.seconds[name] for name in by.values()})
    for one in [one for one, name in by.items() if name in failing]:
        print(f"lived, for {by[one]} fails without it: {one}", flush=True)
        del by[one]
    score = len(by) / len(mutants)
    place = f"after {given.after} of seed {given.seed}"
    print(f"{len(by)} of {len(mutants)} mutants noticed: {score:.1%}, {place}")
    return 0 if score >= AIM else 1


if __name__ == "__main__":
    sys.exit(main())
