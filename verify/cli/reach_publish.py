"""`publish --reach`: measure how far each precision carries, then write it down."""

from __future__ import annotations

from itertools import count
from pathlib import Path

from verify.cli.answer import PASS, Answer
from verify.cli.streams import say


def publish_reach(folder: Path) -> Answer:
    """Follow every family of extremes on every rung, and write data, page and pictures."""
    from verify.publish import reach as pages
    from verify.trade.reach import document, members

    total, place = members(), count(1)
    found = document(lambda label: say(f"{next(place)}/{total} {label}"))
    written = [str(path) for path in pages.write(folder, found)]
    return Answer(PASS, {"written": written}, lambda: "\n".join(written))
