"""STK's attitude files (.a): keywords, then a line for each time.

STK gives the rotation from CoordinateAxes to the axes of the body, scalar last unless the format says
otherwise, and angular velocities in degrees a second in body axes. Times count from ScenarioEpoch. See
https://help.agi.com/stk/Content/stk/importfiles-01.htm.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Final

from taylor_verify.records.faults import Faults, Refused, cut, refusal
from taylor_verify.solvers.files.columns.forms import FORMS
from taylor_verify.solvers.files.formats.ccsds import is_turning
from taylor_verify.solvers.files.formats.column import ROWS, Column, Table, alike
from taylor_verify.solvers.files.formats.content import Content

_LAST: Final = ("q1", "q2", "q3", "q0")
_RATES: Final = tuple(f"w{k} [deg/s]" for k in (1, 2, 3))
# STK turns the reference axes into those of the body, row by row.
_MATRIX: Final = tuple(f"r{k}{i}" for i in (1, 2, 3) for k in (1, 2, 3))
_DATA: Final[Mapping[str, tuple[str, ...]]] = {
    "attitudetimequaternions": _LAST,
    "attitudetimequatscalarfirst": ("q0", "q1", "q2", "q3"),
    "attitudetimequatangvels": (*_LAST, *_RATES),
    "attitudetimeangvels": _RATES,
    "attitudetimedcm": _MATRIX,
    "attitudetimedcmangvels": (*_MATRIX, *_RATES),
}
_DIGITS: Final = str.maketrans("123", "xyz")
_POINTS, _AXES, _FORMAT = "numberofattitudepoints", "coordinateaxes", "timeformat"
_FIXED: Final = ("fixed", "fixednolibration", "ecf", "custom", "topocentric")


def read(file: Content, path: Path) -> Table:
    """Return t, q0 ... q3 and, where the file has it, w1 w2 w3."""
    keywords, names, rows = dict[str, str](), tuple[str, ...](), list[list[str]]()
    faults = Faults()
    with alike(faults, str(path)) as ragged:
        for place, words in _lines(file, path):
            word, rest = words[0].lower(), " ".join(words[1:])
            if word == "end" and names:
                break
            if names:
                if len(words) != len(names) + 1:
                    ragged(f"{len(names) + 1} numbers", str(len(words)), place)
                else:
                    rows.append(words)
                ROWS.check(len(rows), path)
            elif word.startswith("attitudetime"):
                names = _named(word, words[0], keywords.get("sequence", "313"), place)
            else:
                keywords[word] = rest
        else:
            faults.add("`END Attitude`", "the end of the file", str(path))
    _check(keywords, len(rows), path, faults)
    if faults.lines:
        raise Refused(faults.lines)
    columns = map(list, zip(*rows, strict=True)) if rows else ([] for _ in ("t", *names))
    read = [Column(name, values) for name, values in zip(("t", *names), columns, strict=True)]
    axes = cut(keywords.get(_AXES, "the axes of the file"))
    note = f"{axes} is taken for the space axes of the scene"
    return Table(read, (note,))


def _lines(file: Content, path: Path) -> Iterator[tuple[str, list[str]]]:
    for number, line in enumerate(file.lines(), start=1):
        if (words := line.split()) and not words[0].startswith(("#", "stk.v", "BEGIN")):
            yield f"{path}, line {number}", words


def _named(word: str, shown: str, sequence: str, place: str) -> tuple[str, ...]:
    axes = sequence.translate(_DIGITS)
    if word.startswith("attitudetimeeulerangles") and axes in FORMS:
        rates = [f"rate {k}" for k in (1, 2, 3)] if word.endswith("andrates") else []
        return (*(f"euler_{axes}_{k} [deg]" for k in (1, 2, 3)), *rates)
    if word not in _DATA:
        kinds = (
            "AttitudeTime with Quaternions, QuatScalarFirst, QuatAngVels, AngVels, DCM, DCMAngVels, or "
            "EulerAngles below a Sequence such as 321"
        )
        raise refusal(kinds, cut(shown), place, "write one of them, or a CSV file")
    return _DATA[word]


def _check(keywords: Mapping[str, str], rows: int, path: Path, faults: Faults) -> None:
    points = keywords.get(_POINTS, str(rows))
    if points != str(rows):
        faults.add(f"{cut(points)} points as {_POINTS} says", str(rows), str(path))
    axes = keywords.get(_AXES, "")
    if any(is_turning(word) or word.lower() in _FIXED for word in re.split(r"[\s/]+", axes)):
        mend = "write quaternions relative to inertial axes, such as ICRF or J2000"
        faults.add("CoordinateAxes that do not turn", cut(axes), str(path), mend)
    if keywords.get(_FORMAT, "EpSec").lower() != "epsec":
        faults.add("times in seconds (TimeFormat EpSec)", cut(keywords[_FORMAT]), str(path))
