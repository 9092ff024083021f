"""The memory of long runs and of large sweeps, each in a process of its own."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from builders.scenes import sampled

from benches.ratio import Ratio, Side, Target
from taylor_verify.batch.sweeps.sweep import sweep
from taylor_verify.run import run
from taylor_verify.scenes.reading.reader import load

_SCENE: Final = "euler/generic"
_FAMILY: Final = "satellites"
_FEW_SAMPLES, _MANY_SAMPLES = 10_000, 100_000
_FEW_BODIES, _MANY_BODIES = 100, 1_000
_STATUS: Final = Path("/proc/self/status")

_SAMPLES: Final = Target(
    1.25, "samples are judged some thousands at once: what stays of each is its time and its answer"
)
_BODIES: Final = Target(
    1.1, "a chunk that has ended is on the disk; a tenth is what two equal processes differ by"
)


@dataclass(frozen=True)
class Peak:
    """The most memory that a process has had by its end; it does what the words say."""

    what: str
    number: int

    def cost(self) -> float:
        """Return the bytes."""
        command = [sys.executable, "-m", "benches.memory", self.what, str(self.number)]
        done = subprocess.run(command, check=True, capture_output=True, text=True)
        return float(done.stdout.splitlines()[-1])


def peak() -> int:
    """Return the most bytes that this process has had in memory.

    Linux counts what a process had before it became this program into getrusage: the status does not.
    """
    if _STATUS.exists():
        (line,) = (line for line in _STATUS.read_text().splitlines() if line.startswith("VmHWM"))
        return 1024 * int(line.split()[1])
    import resource

    most = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return most if sys.platform == "darwin" else 1024 * most


def ratios() -> Iterator[Ratio]:
    """Yield what memory grows by."""
    asked = (
        ("samples", _SCENE, _MANY_SAMPLES, _FEW_SAMPLES, _SAMPLES),
        ("bodies", _FAMILY, _MANY_BODIES, _FEW_BODIES, _BODIES),
    )
    for what, of, many, few, target in asked:

        def pair(what: str = what, many: int = many, few: int = few) -> tuple[Side, Side]:
            return Peak(what, many), Peak(what, few)

        yield Ratio(
            f"memory/{what}",
            f"the peak of a process that solves and judges {of} with {many:,} {what}, over {few:,}",
            pair,
            target,
            unit="process",
            measure="byte",
            rounds=1,
        )


def main(what: str, number: str) -> None:
    """Do the work in this process, and print its peak."""
    if what == "samples":
        run(sampled(load(_SCENE), int(number)), "taylor", "f64")
    else:
        sweep(_FAMILY, count=int(number), seed=1, jobs=1)
    print(peak())


if __name__ == "__main__":
    main(*sys.argv[1:])
