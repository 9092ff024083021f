"""Draw mutants with a seed, run the tests of each changed line, print who lived (`make mutants`)."""

from __future__ import annotations

import argparse
import os
import shutil
import signal
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Final

from mutants.draw import drawn
from mutants.mutant import VERIFY, Mutant
from mutants.trace import ROOT, TESTS, Trace, trace

ROOMS: Final = ("claims", "exact", "judge")
AIM: Final = 0.97
# A mutant that runs on and on is noticed: what takes this many times as long, and a start of Python.
PATIENCE, START = 10, 60


def is_noticed(mutant: Mutant, tests: Sequence[str], seconds: float) -> bool:
    """Return True if one of the tests fails or does not end, in a copy of the sources with the mutant."""
    with TemporaryDirectory(prefix="mutant-") as place:
        sources = Path(place) / "verify"
        shutil.copytree(VERIFY, sources, ignore=shutil.ignore_patterns("__pycache__"))
        (Path(place) / "cases").symlink_to(ROOT / "cases")
        (sources / "taylor_verify" / mutant.path).write_text(mutant.text, encoding="utf-8")
        chosen = Path(place) / "chosen"
        chosen.write_text("\n".join(tests), encoding="utf-8")
        files = dict.fromkeys(name.partition("::")[0] for name in tests)
        environment = {
            **os.environ,
            "PYTHONPATH": os.pathsep.join(
                (str(sources), str(TESTS), os.environ.get("PYTHONPATH", ""))
            ),
            # A copy of the same size and second would be taken for the one before.
            "PYTHONDONTWRITEBYTECODE": "1",
            "MUTANTS_CHOSEN": str(chosen),
        }
        command = [
            *(sys.executable, "-m", "pytest", "-x", "-q", "-p", "mutants.choosing"),
            *("-p", "no:cacheprovider", *files),
        ]
        with subprocess.Popen(
            command,
            cwd=ROOT,
            env=environment,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            start_new_session=True,
        ) as running:
            try:
                return running.wait(START + PATIENCE * seconds) != 0
            except subprocess.TimeoutExpired:
                os.killpg(running.pid, signal.SIGKILL)
                return True


def within(tests: Sequence[str], trace: Trace, budget: float) -> list[str]:
    """Return the first tests that take no longer than the budget together, at least one of them."""
    chosen, spent = [], 0.0
    for name in tests:
        spent += trace.seconds[name]
        if chosen and spent > budget:
            break
        chosen.append(name)
    return chosen


def main() -> int:
    """Print each mutant that lived, and the score; 1 if that is below the aim."""
    parser = argparse.ArgumentParser(prog="make mutants", description=__doc__)
    parser.add_argument("rooms", nargs="*", default=ROOMS, help="default: %(default)s")
    parser.add_argument("--count", type=int, default=60)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--budget", type=float, default=120, help="seconds of tests for a mutant")
    given = parser.parse_args()
    os.nice(19)
    measured = trace(ROOMS, [f"tests/{room}" for room in ROOMS])
    chosen, lived = drawn(given.rooms, given.count, given.seed), 0
    for n, one in enumerate(chosen, 1):
        every = measured.tests_of(one)
        tests = within(every, measured, given.budget)
        if tests and is_noticed(one, tests, sum(measured.seconds[name] for name in tests)):
            print(f"{n}/{len(chosen)} noticed {one.path}:{one.line}", file=sys.stderr)
            continue
        lived += 1
        print(f"lived after {len(tests)} of the {len(every)} tests that run it: {one}", flush=True)
    score = 1 - lived / len(chosen)
    print(f"{len(chosen) - lived} of {len(chosen)} mutants noticed: {score:.1%}, seed {given.seed}")
    return 0 if score >= AIM else 1


if __name__ == "__main__":
    sys.exit(main())
