"""Random fields, followed by another integrator: `python -m benches.random_fields FIRST COUNT FILE`.

The file gets a line for each field, its seed and what was found. Those that it has are not followed again.
"""

from __future__ import annotations

import sys
from collections import Counter
from pathlib import Path

from builders.text_functions import drawn, verdict


def main(first: int, count: int, file: Path) -> None:
    """Follow so many fields; print how many are inside the proven bounds, refused, not judged, outside."""
    file.touch()
    verdicts = {int(seed): word for seed, word in map(_entry, file.read_text().splitlines())}
    for seed in range(first, first + count):
        if seed not in verdicts:
            verdicts[seed] = verdict(drawn(seed))
            with file.open("a") as lines:
                print(seed, verdicts[seed], file=lines)
    asked = {seed: verdicts[seed] for seed in range(first, first + count)}
    print(dict(Counter(asked.values())))
    print("outside:", [seed for seed, word in asked.items() if word == "outside"])


def _entry(line: str) -> tuple[str, str]:
    seed, _, word = line.partition(" ")
    return seed, word


if __name__ == "__main__":
    main(int(sys.argv[1]), int(sys.argv[2]), Path(sys.argv[3]))
