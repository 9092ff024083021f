"""Judge thousands of hostile gyrostats by three routes: `python tests/hostile_gyrostats.py --each 120`.

A row for each kind: how far the closed form in balls is from mpmath and from enclosed Taylor series at the
most, and the slowest body in seconds of the processor. A fault names its body by kind and number.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Iterable

from builders.hostile_gyrostats import KINDS, disagreements, hostile
from mpmath import mp, mpf

# Both sides have twenty digits.
ALLOWED = 3 * mpf(10) ** -20


def main() -> int:
    """Judge the bodies asked for; 1 if two routes disagree or one of them ends."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--each", type=int, default=10, help="bodies of each kind")
    parser.add_argument(
        "--first", type=int, default=0, help="number of the first body of each kind"
    )
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("kinds", nargs="*", help=f"all of: {', '.join(KINDS)}")
    asked = parser.parse_args()
    numbers = range(asked.first, asked.first + asked.each)
    faults = [judged(kind, numbers, asked.seed) for kind in asked.kinds or KINDS]
    print(f"{len(faults) * len(numbers)} gyrostats, {sum(faults)} faults")
    return int(any(faults))


def judged(kind: str, numbers: Iterable[int], seed: int) -> int:
    """Print the row of a kind, and return how many faults it has."""
    words, slowest = [], 0.0
    worst = [mpf(0), mpf(0)]
    for number in numbers:
        began = time.process_time()
        try:
            parts = disagreements(hostile(kind, number, seed))
        except Exception as error:  # a fault is a row, whatever it is
            words.append(f"  {kind} {number}: {type(error).__name__}: {error}")
        else:
            if not all(part <= ALLOWED for part in parts):
                words.append(f"  {kind} {number}: {' '.join(mp.nstr(part, 3) for part in parts)}")
            worst = [max(pair) for pair in zip(worst, parts, strict=True)]
        slowest = max(slowest, time.process_time() - began)
    sizes = " ".join(f"{mp.nstr(part, 3):>10}" for part in worst)
    print(f"{kind:52} {sizes} {slowest:8.2f} s", *words, sep="\n", flush=True)
    return len(words)


if __name__ == "__main__":
    sys.exit(main())
