"""The greeting: what the program does, and a command for each of its three uses."""

from __future__ import annotations

import argparse
from typing import Final

from taylor_verify.cli.answer import PASS, Answer
from taylor_verify.records.version import __version__

_USES: Final = {
    "judge a file of yours": "check my_run.csv --scene euler/generic",
    "judge a program of yours": 'run euler/generic --solver "process:./my_simulator"',
    "look up the exact motion": "exact euler/generic --at 0,10 --digits 40",
}


def answer(options: argparse.Namespace) -> Answer:
    """Return the answer to a call without a verb."""
    del options
    what = "how wrong is your simulation of a rigid body, or of a solid in an ideal fluid?"
    lines = [
        f"taylor-verify {__version__}: {what}",
        "",
        *(f"  {use}:\n    taylor-verify {command}" for use, command in _USES.items()),
        "",
        "`taylor-verify list` names the scenes, `taylor-verify --help` all verbs.",
    ]
    return Answer(PASS, {"version": __version__, "uses": _USES}, lambda: "\n".join(lines))
