"""One process of `make bench`: takes some ratios, and adds them to a file of pyperf."""

from __future__ import annotations

import sys
from pathlib import Path

from benches.registry import RATIOS
from benches.suite import SECONDS, add, in_turns


def main(file: str, *names: str) -> None:
    """Take the ratios of these names."""
    for ratio in RATIOS:
        if ratio.name in names:
            add(ratio, in_turns(ratio, SECONDS), Path(file))


if __name__ == "__main__":
    main(*sys.argv[1:])
