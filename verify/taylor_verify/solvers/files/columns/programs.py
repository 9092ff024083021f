"""The tables of this folder: the names that programs write, usual names and units, an entry in a line.

What a name does not say and the program's manual does stands there too: a unit, a frame, a convention.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from importlib.resources import files
from itertools import product
from typing import Final

from taylor_verify.solvers.files.columns.spelling import Frame, Spelling, Turn

_OF_PROGRAMS: Final = ("program", "group", "names", "beside", "unit", "frame", "turn", "source")


def entries() -> Iterator[dict[str, str]]:
    """Yield the entries of the table of programs, each field by its name."""
    return entries_of("programs.txt", _OF_PROGRAMS)


def usual() -> Iterator[dict[str, str]]:
    """Yield the entries of usual names, each stem by itself."""
    for entry in entries_of("usual.txt", ("group", "names", "frame", "turn")):
        names = entry["names"]
        for each in names.split() if "*" in names else [names]:
            yield entry | {"names": each}


def entries_of(file: str, fields: Sequence[str]) -> Iterator[dict[str, str]]:
    """Yield the entries of a table of this folder, one in a line, each field by its name."""
    for line in files(__package__).joinpath(file).read_text(encoding="utf-8").splitlines():
        if line and not line.startswith("#"):
            yield dict(zip(fields, (field.strip() for field in line.split("|")), strict=True))


def spellings_of(entry: Mapping[str, str], remark: str = "") -> Iterator[Spelling]:
    """Yield the spelling of an entry; three for names with a star."""
    together = [sign.split("+") for sign in entry.get("beside", "").split()]
    for names in _written_out(entry["names"].split(), entry["group"]):
        yield Spelling(
            group=entry["group"],
            keys=tuple(map(letters, names)),
            remark="" if entry["turn"] else remark,
            whose=entry.get("program", ""),
            is_behind=names[0].startswith("_"),
            signs=tuple(tuple(map(letters, signs)) for signs in together),
            unit=entry.get("unit", ""),
            frame=Frame[entry["frame"].upper() or "UNSAID"],
            turn=Turn(entry["turn"]),
        )


def _written_out(names: Sequence[str], group: str) -> Iterator[Sequence[str]]:
    (stem, star), *more = (name.partition("*")[:2] for name in names)
    if not star:
        yield names
        return
    assert not more
    for components in ("xyz", "123", "012"):
        yield [
            stem + "".join(each) for each in product(components, repeat=2 - (group != "attitude"))
        ]


def letters(text: str) -> str:
    """Return the letters and the digits of a text, the letters small."""
    return re.sub(r"[^a-z0-9]", "", text.lower())
