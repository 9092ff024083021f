"""The columns that a caller assigns by name: ``w1=wx,t=Time [s]``, each NAME one of ours.

A NAME may also be a whole group, ``omega=gyro``: then ``gyro_x gyro_y gyro_z`` or ``gyro[0] ...`` are its
columns, in our order.
"""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterable, Mapping, Sequence
from typing import Final

from taylor_verify.records.faults import Faults, cut, near
from taylor_verify.solvers.files.columns.names import COMPONENTS, GROUPS, KNOWN
from taylor_verify.solvers.files.columns.readings import Name
from taylor_verify.solvers.files.formats.column import Column

# Pairs of a name of ours and a name of the file's.
Request = Sequence[tuple[str, str]]

# A comma belongs to the name of a column unless NAME= follows it.
_NEXT: Final = re.compile(r",(?=\s*\w+\s*=)")
_MOST_NEAR: Final = 3


def request(texts: Iterable[str]) -> Request:
    """Return the pairs of each ``NAME=THEIRS,NAME=THEIRS``; nothing is looked up yet."""
    pairs = (pair.partition("=") for text in texts for pair in _NEXT.split(text))
    return tuple((name.strip(), _unquoted(theirs.strip())) for name, _, theirs in pairs)


def _unquoted(text: str) -> str:
    is_quoted = len(text) > 1 and text[0] == text[-1] and text[0] in "\"'"
    return text[1:-1] if is_quoted else text


def asked_columns(
    wanted: Request, names: Sequence[Name], place: str, faults: Faults
) -> Mapping[str, Name]:
    """Return the file's name for each of ours that is asked for; what cannot be met is a fault."""
    by_text = {name.text: name for name in names}
    asked: dict[str, Name] = {}
    used: dict[str, str] = {}
    for name, theirs in wanted:
        at = f"columns {cut(name)}={cut(theirs)}"
        if name in GROUPS and not (name == theirs and name in by_text):
            pairs = _of_group(name, theirs, names, at, faults)
        elif name in KNOWN:
            pairs = [(name, theirs)]
        else:
            expected = "the name of one of our columns or groups"
            faults.add(expected, f"`{cut(name)}`", at, near(name, (*KNOWN, *GROUPS)))
            continue
        for ours, own in pairs:
            if own not in by_text:
                expected = f"the name of a column of {place}"
                faults.add(expected, f"`{cut(own)}`", at, _near(own, names))
            elif ours in asked:
                faults.add("every name once", f"{ours} again", at)
            elif own in used:
                faults.add("every column once", f"`{cut(own)}`, which is {used[own]}", at)
            else:
                asked[ours], used[own] = by_text[own], ours
    return asked


def _of_group(
    group: str, theirs: str, names: Sequence[Name], at: str, faults: Faults
) -> list[tuple[str, str]]:
    """Return the columns of a whole group, whose names begin with one word."""
    if group == "time":
        return [("t", theirs)]
    stem = _key(theirs)
    texts = {name.key: name.text for name in names}
    sets = [
        [texts[stem + c] for c in components]
        for components in COMPONENTS[group]
        if all(stem + c in texts for c in components)
    ]
    if len(sets) == 1:
        return list(zip(GROUPS[group], sets[0], strict=True))
    ways = " or ".join(f"{theirs}_{c[0]} ... {theirs}_{c[-1]}" for c in COMPONENTS[group])
    count_in_words = "several of them" if sets else f"none ({_near(theirs, names)})"
    faults.add(
        f"columns {cut(ways)}", count_in_words, at, f"name each of {' '.join(GROUPS[group])}"
    )
    return []


def _key(text: str) -> str:
    return Name(Column(text, ())).key


def _near(text: str, names: Sequence[Name]) -> str:
    """Return a phrase on the names of the file that are most like this one."""
    by_key = {name.key or name.text: name.text for name in names}
    close = difflib.get_close_matches(_key(text), by_key, n=_MOST_NEAR, cutoff=0.5)
    shown = ", ".join(f"`{cut(by_key[key])}`" for key in close or list(by_key)[:8])
    return f"near it: {shown}" if close else f"it has {shown}"
