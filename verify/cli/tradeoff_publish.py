"""`publish --tradeoff`: measure speed against accuracy, then write it down."""

from __future__ import annotations

from pathlib import Path

from verify.cli.answer import PASS, Answer
from verify.cli.streams import say


def publish_tradeoff(folder: Path, outside: bool) -> Answer:
    """Measure the published scenes in fresh processes, and write data and page."""
    from verify.publish import report
    from verify.trade.measurement import measurement

    found = measurement(with_outside=outside, finished=say)
    paths = report.publish_tradeoff(folder, found.numbers(), found.times())
    written = [str(path) for path in paths]
    return Answer(PASS, {"written": written}, lambda: "\n".join(written))
