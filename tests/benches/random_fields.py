"""Random fields, followed by another integrator: `python -m benches.random_fields [SEED [COUNT]]`."""

from __future__ import annotations

import sys
from collections import Counter

from builders.fields import drawn, verdict


def main(first: int = 0, count: int = 1000) -> None:
    """Print how many are inside the proven bounds, refused, not judged, and outside with their seeds."""
    verdicts = {seed: verdict(drawn(seed)) for seed in range(first, first + count)}
    print(dict(Counter(verdicts.values())))
    print("outside:", [seed for seed, word in verdicts.items() if word == "outside"])


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
