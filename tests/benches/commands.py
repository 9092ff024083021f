"""The work of `make verify` by this checkout beside that by another one, cold and warm."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Final

from benches.ratio import Ratio, Side, Target

_HERE: Final = Path(__file__).resolve().parents[2]
# The folders of the two calls of `make verify`, and their rungs.
_RUNS: Final = (
    (("euler", "kirchhoff", "manufactured"), ("f32", "f64", "f80", "f128", "mp237")),
    (("extremes",), ("f64",)),
)
_CACHES: Final = ("XDG_CACHE_HOME", "HEYOKA_CACHE_DIR")
_PAIRS: Final = 2

_NO_SLOWER: Final = Target(
    1.05, "a change makes the standard set no slower; a twentieth are apart two runs of one code"
)


@dataclass(frozen=True)
class Verification:
    """Scenes of the standard set and of the extremes by the sources of a checkout.

    ``calls`` are the words of each call. ``cache`` is the folder of caches, its own. It is emptied before
    each run that ``is_cold``, and filled by a run of its own before the first that is not.
    """

    checkout: Path
    calls: tuple[tuple[str, ...], ...]
    cache: Path
    is_cold: bool

    def cost(self) -> float:
        """Return the seconds that somebody waits.

        Raises ChildProcessError where a scene does not pass: less work would be quicker.
        """
        if self.is_cold:
            shutil.rmtree(self.cache, ignore_errors=True)
        elif not self.cache.exists():
            self._run()
        began = time.perf_counter()
        self._run()
        return time.perf_counter() - began

    def _run(self) -> None:
        environment = os.environ | dict.fromkeys(_CACHES, str(self.cache))
        environment["PYTHONPATH"] = str(self.checkout / "verify")
        with TemporaryDirectory() as place:
            for words in self.calls:
                command = [sys.executable, "-m", "taylor_verify", "run", *words, "--out", words[-1]]
                done = subprocess.run(
                    command, cwd=place, env=environment, check=False, capture_output=True, text=True
                )
                if done.returncode:
                    message = done.stderr or done.stdout
                    got = f"{done.returncode} of `run {words[0]} ...` @ {self.checkout}"
                    raise ChildProcessError(f"expected status 0, got {got}: {message}")


def ratios(other: Path, caches: Path) -> Iterator[Ratio]:
    """Yield this checkout over the other one, their caches in a folder that exists as long as these.

    Both judge the scenes that both have, unchanged: a scene that was added is no slowness. Raises
    ValueError if there is none.
    """
    shared = [([*_shared(other, folders)], rungs) for folders, rungs in _RUNS]
    calls = tuple((*names, "--rung", *rungs) for names, rungs in shared if names)
    if not calls:
        raise ValueError(f"expected a checkout with scenes of this one, got {other} @ --against")

    def pair(is_cold: bool) -> tuple[Side, Side]:
        return (
            Verification(_HERE, calls, caches / "here", is_cold),
            Verification(other.resolve(), calls, caches / "other", is_cold),
        )

    for word, is_cold in (("cold", True), ("warm", False)):
        caches_are = "empty" if is_cold else "filled"
        yield Ratio(
            f"verify/{word}",
            f"standard set and extremes that both have, with {caches_are} caches, over {other}",
            partial(pair, is_cold),
            _NO_SLOWER,
            unit="command",
            rounds=_PAIRS,
        )


def _shared(other: Path, folders: Sequence[str]) -> Iterator[str]:
    """Yield the names of the scenes in these folders that both checkouts have, word for word."""
    for folder in folders:
        for file in sorted((_HERE / "cases" / folder).glob("*.toml")):
            theirs = other / "cases" / folder / file.name
            is_scene = not file.stem.isupper()
            if is_scene and theirs.exists() and theirs.read_bytes() == file.read_bytes():
                yield f"{folder}/{file.stem}"
