"""Mutants drawn with a seed, without those that are known to behave like the code."""

from __future__ import annotations

import random
import tomllib
from collections.abc import Sequence
from itertools import islice
from pathlib import Path
from typing import Final

from mutants.mutant import PACKAGE, Mutant, lines, mutant, places

EQUIVALENT: Final = Path(__file__).with_name("equivalent.toml")


def equivalents() -> dict[tuple[str, str, str], str]:
    """Return why some mutants behave like the code, by path, line before and line after."""
    table = tomllib.loads(EQUIVALENT.read_text(encoding="utf-8"))
    return {(one["path"], one["before"], one["after"]): one["why"] for one in table["mutant"]}


def of_line(path: str, line: int) -> list[Mutant]:
    """Return every mutant of a line, also those that are equivalent."""
    source = (PACKAGE / path).read_text(encoding="utf-8")
    return [mutant(path, source, place) for place, at in enumerate(lines(source)) if at == line]


def drawn(rooms: Sequence[str], number: int, seed: int) -> list[Mutant]:
    """Return so many mutants, each as likely as any other, without those that are equivalent.

    Each mutant has a number of its own by which they are ordered: a change of one module moves no other.
    """
    known = equivalents()
    every = sorted(places(*rooms), key=lambda place: random.Random(f"{seed} {place}").random())
    sources = {path: (PACKAGE / path).read_text(encoding="utf-8") for path, _ in every}
    made = (mutant(path, sources[path], place) for path, place in every)
    return list(islice((m for m in made if (m.path, m.before, m.after) not in known), number))
