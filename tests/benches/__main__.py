"""Take the ratios, print them beside the last ones and their targets (`make bench`)."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence

from rich.console import Console

from benches import history, suite
from benches.ratio import Ratio
from benches.registry import RATIOS
from benches.table import remarks, table
from taylor_verify.judge.provenance import processor


def main(words: Sequence[str] | None = None) -> int:
    """Print the table; 1 if targets are missed and that is to fail, 2 for a call that is wrong."""
    parser = argparse.ArgumentParser(prog="make bench", description=__doc__)
    parser.add_argument(
        "only", nargs="*", help="ratios whose name begins so; all of them by default"
    )
    parser.add_argument("--keep", action="store_true", help="append the ratios to the history")
    parser.add_argument("--strict", action="store_true", help="fail where a target is missed")
    parser.add_argument("--processes", type=_positive, default=suite.PROCESSES)
    asked = parser.parse_args(words)
    try:
        ratios = _chosen(asked.only)
        last = history.last(history.FILE, processor())
    except ValueError as error:
        parser.error(str(error))
    measured = suite.measured(ratios, asked.processes)
    page = Console(width=None if sys.stdout.isatty() else 140, highlight=False)
    page.print(f"{processor()}; processor time, medians of {asked.processes} processes")
    page.print(table(measured, last))
    for line in remarks(measured, last):
        page.print(line)
    if asked.keep:
        history.keep(measured, history.FILE, processor(), history.commit())
    return int(asked.strict and any(one.misses for one in measured))


def _chosen(names: Sequence[str]) -> list[Ratio]:
    """Return the ratios that are asked for."""
    chosen = [ratio for ratio in RATIOS if not names or ratio.name.startswith(tuple(names))]
    for name in names:
        if not any(ratio.name.startswith(name) for ratio in chosen):
            known = ", ".join(dict.fromkeys(ratio.name.partition("/")[0] for ratio in RATIOS))
            raise ValueError(
                f"expected the beginning of a ratio's name ({known}), got {name} @ only"
            )
    return chosen


def _positive(text: str) -> int:
    number = int(text)
    if number < 1:
        raise argparse.ArgumentTypeError(f"expected a positive number, got {number}")
    return number


if __name__ == "__main__":
    sys.exit(main())
