"""The columns that a caller assigns by name: ``w1=wx,t=Time [s]``, each NAME one of ours.

A NAME may also be a whole group, ``omega=gyro``: then ``gyro_x gyro_y gyro_z`` or ``gyro[0] ...`` are its
columns, in our order; ``omega=2:4`` and ``omega=p:r`` name its first and its last column, by number from 1
or by name; ``zyx=7:5`` goes backwards. A form of the attitude is a group too, in radians, or with a unit:
``zyx_deg=5:7``.
"""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterable, Mapping, Sequence
from typing import Final

from taylor_verify.records.faults import Faults, cut, near
from taylor_verify.solvers.files.columns.column_units import Unit, in_brackets
from taylor_verify.solvers.files.columns.forms import FORMS, SEQUENCES
from taylor_verify.solvers.files.columns.names import COMPONENTS, GROUPS, KNOWN
from taylor_verify.solvers.files.columns.readings import Name

# Pairs of a name of ours and a name of the file's.
Request = Sequence[tuple[str, str]]

# A comma belongs to the name of a column unless NAME= follows it.
_NEXT: Final = re.compile(r",(?=\s*\w+(?:\s*[\[(][^\[\](),=]{0,40}[\])])?\s*=)")
_MOST_NEAR: Final = 3
# The axes of a sequence by number: 321 is zyx.
_AXES: Final = str.maketrans("123", "xyz")


def request(texts: Iterable[str]) -> Request:
    """Return the pairs of each ``NAME=THEIRS,NAME=THEIRS``; nothing is looked up yet."""
    pairs = (pair.partition("=") for text in texts for pair in _NEXT.split(text))
    return tuple((name.strip(), _unquoted(theirs.strip())) for name, _, theirs in pairs)


def _unquoted(text: str) -> str:
    is_quoted = len(text) > 1 and text[0] == text[-1] and text[0] in "\"'"
    return text[1:-1] if is_quoted else text


def asked_columns(
    wanted: Request, names: Sequence[Name], place: str, faults: Faults
) -> tuple[Mapping[str, Name], Mapping[str, Unit]]:
    """Return the file's name for each of ours that is asked for, and the units that are said with it.

    What cannot be met is a fault.
    """
    by_text = {name.text: name for name in names}
    asked: dict[str, Name] = {}
    units: dict[str, Unit] = {}
    used: dict[str, str] = {}
    for name, theirs in wanted:
        at = f"columns {cut(name)}={cut(theirs)}"
        group, unit = _group(name)
        if group in GROUPS and not (name == theirs and name in by_text):
            pairs = _of_group(group, theirs, names, at, faults)
        elif name in KNOWN:
            pairs = [(name, theirs)]
        else:
            expected = "the name of one of our columns or groups"
            faults.add(expected, f"`{cut(name)}`", at, _near_ours(name))
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
                if unit and ours in FORMS[group].angles:
                    units[ours] = unit
    return asked, units


def is_ours(name: str) -> bool:
    """Return True for a name that may be asked for: of a column, a group, or a form with a unit."""
    return name in KNOWN or _group(name)[0] in GROUPS


def _near_ours(name: str) -> str:
    close = difflib.get_close_matches(name, (*KNOWN, *GROUPS), n=1)
    groups = [group for group in GROUPS if group not in SEQUENCES]
    return near(name, close or [*groups, f"{SEQUENCES[0]} to {SEQUENCES[-1]}"])


def _group(name: str) -> tuple[str, Unit | None]:
    """Return the group that a request names, and the unit behind the name of a form: ``zyx_deg``."""
    stem, _, unit = name.rpartition("_")
    for form, text in ((name, ""), (stem, unit)):
        sequence = form.lower().translate(_AXES)
        group = sequence if sequence in SEQUENCES else form
        if group in FORMS and (not text or (FORMS[group].angles and in_brackets(text, group))):
            return group, in_brackets(text, group)
    return name, None


def _of_group(
    group: str, theirs: str, names: Sequence[Name], at: str, faults: Faults
) -> list[tuple[str, str]]:
    """Return the columns of a whole group: between two ends, or with one word before each."""
    if group == "time":
        return [("t", theirs)]
    ends = theirs.split(":")
    if len(ends) == 2 and any(_place(end, names) is not None for end in ends):
        return _between(GROUPS[group], ends, names, at, faults)
    return _of_stem(group, theirs, names, at, faults)


def _between(
    ours: Sequence[str], ends: Sequence[str], names: Sequence[Name], at: str, faults: Faults
) -> list[tuple[str, str]]:
    """Return the columns from one end to the other."""
    first, last = (_place(end, names) for end in ends)
    if first is None or last is None:
        expected = f"a column of the file, by its name or by a number up to {len(names)}"
        faults.add(expected, f"`{cut(ends[first is not None])}`", at)
        return []
    step = 1 if first <= last else -1
    texts = [names[k].text for k in range(first, last + step, step)]
    if len(texts) != len(ours):
        faults.add(f"{len(ours)} columns", f"{len(texts)} from {ends[0]} to {ends[1]}", at)
        return []
    return list(zip(ours, texts, strict=True))


def _place(end: str, names: Sequence[Name]) -> int | None:
    """Return the index of the column that a name or a number from 1 means."""
    texts = [name.text for name in names]
    if end.strip() in texts:
        return texts.index(end.strip())
    is_number = end.strip().isdecimal() and 0 < int(end) <= len(names)
    return int(end) - 1 if is_number else None


def _of_stem(
    group: str, theirs: str, names: Sequence[Name], at: str, faults: Faults
) -> list[tuple[str, str]]:
    """Return the columns of a whole group, whose names begin with one word."""
    stem = Name.of(theirs).key
    by_key = {name.key: name.text for name in names}
    sets = [
        [by_key[stem + c] for c in components]
        for components in COMPONENTS[group]
        if all(stem + c in by_key for c in components)
    ]
    if len(sets) == 1:
        return list(zip(GROUPS[group], sets[0], strict=True))
    ways = " or ".join(f"{theirs}_{c[0]} ... {theirs}_{c[-1]}" for c in COMPONENTS[group])
    count_in_words = "several of them" if sets else f"none ({_near(theirs, names)})"
    faults.add(
        f"columns {cut(ways)}", count_in_words, at, f"name each of {' '.join(GROUPS[group])}"
    )
    return []


def _near(text: str, names: Sequence[Name]) -> str:
    """Return a phrase on the names of the file that are most like this one."""
    by_key = {name.key or name.text: name.text for name in names}
    close = difflib.get_close_matches(Name.of(text).key, by_key, n=_MOST_NEAR, cutoff=0.5)
    shown = ", ".join(f"`{cut(by_key[key])}`" for key in close or list(by_key)[:8])
    return f"near it: {shown}" if close else f"it has {shown}"
