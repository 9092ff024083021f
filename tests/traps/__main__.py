"""Measure every trap anew, and write data/traps.json and tables/traps.* of the reports (`make traps`)."""

from __future__ import annotations

import sys
from pathlib import Path

from traps import page
from traps.table import study

REPORTS = Path(__file__).resolve().parents[2] / "reports"


def say(title: str) -> None:
    """Print the title of a trap that was measured, as progress."""
    print(title, file=sys.stderr)


for file in page.publish(REPORTS, study(finished=say)):
    print(file)
