"""Columns that are asked for by number, from 1, or under a usual name; files that nothing names."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final

from taylor_verify.records.faults import refusal
from taylor_verify.records.quantities import COLUMNS, IMPULSES, VELOCITIES
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.files.clock import is_fraction
from taylor_verify.solvers.files.columns.assigned import Request, is_ours
from taylor_verify.solvers.files.columns.readings import Name
from taylor_verify.solvers.files.formats.column import Column
from taylor_verify.solvers.values import Value, exact

# The columns of a trajectory of the TUM benchmark, t x y z qx qy qz qw, which has no header.
_TUM: Final = ("t", "c1", "c2", "c3", "q1", "q2", "q3", "q0")
_ANGLES: Final = ("yaw", "pitch", "roll")
_UNIT: Final = 0.01


def usual_names(
    columns: Sequence[Column], wanted: Request, scene: Scene | None, place: str
) -> tuple[Mapping[str, str], Request]:
    """Return the usual names that are asked for by those of the file, and the rest of the request by name.

    ``yaw=5`` and ``nanosec=2`` are such names. Raises Refused for columns without a name of which none is
    asked for.
    """
    names = [column.name for column in columns]
    numbers = [str(k) for k in range(1, len(names) + 1)]
    if names and not wanted and names in (numbers, _elements(names)):
        mend = f"say which is which: --columns {_example(names, scene)}"
        if len(names) == len(_TUM) and _is_unit(columns[4:]):
            mend += f"; of a TUM trajectory --columns {_asked(_TUM, names)}"
        got = f"numbers alone, in {len(names)} column{'s' * (len(names) > 1)}"
        raise refusal("a header line that names the columns", got, place, mend)

    def known(ours: str) -> bool:
        # A name that means nothing is refused with what was written beside it.
        return is_ours(ours) or _is_own(ours, scene) or _is_usual(ours, scene)

    by_text = dict(zip(numbers, names, strict=True)) | {name: name for name in names}
    # Where fractions of a second are asked for, the time beside them is in seconds.
    clock = "sec" if any(is_fraction(ours) for ours, _ in wanted) else "t"
    asked = [
        (clock if ours == "t" else ours, by_text.get(theirs, theirs) if known(ours) else theirs)
        for ours, theirs in wanted
    ]
    usual = {theirs: ours for ours, theirs in asked if theirs in names and _is_usual(ours, scene)}
    return usual, [(ours, theirs) for ours, theirs in asked if usual.get(theirs) != ours]


def _is_usual(name: str, scene: Scene | None) -> bool:
    """Return True for a name that is read where it stands in a header, and is none of ours."""
    is_known = bool(Name.of(name).readings) or is_fraction(name)
    return is_known and not is_ours(name) and not _is_own(name, scene)


def _is_own(name: str, scene: Scene | None) -> bool:
    """Return True for a component of a state of the scene's own."""
    return scene is not None and any(name in state.components for state in scene.own_states)


def _elements(names: Sequence[str]) -> list[str]:
    """Return the names of the columns of one matrix, if the first is one whose name says nothing."""
    stem, bracket, _ = names[0].partition("[")
    means = Name.of(names[0]).is_known
    return [f"{stem}[{k}]" for k in range(len(names))] if bracket and not means else []


def _example(names: Sequence[str], scene: Scene | None) -> str:
    """Return a request for whole groups, of all columns where they are enough.

    A simulator of a body in a fluid writes velocities. Three columns in place of a quaternion may be
    angles, and six beside velocities a centre and angles.
    """
    groups = [group.columns for group in scene.groups] if scene else [("w1", "w2", "w3")]
    if scene and scene.model == "kirchhoff":
        centre = [COLUMNS["centre"]] * (len(names) == 1 + len(IMPULSES) + 2 * len(_ANGLES))
        others = [group for group in groups if not set(group) <= {*IMPULSES, *COLUMNS["centre"]}]
        tracked = [group for group in groups if group == COLUMNS["centre"]]
        groups = [*(COLUMNS[name] for name in VELOCITIES), *(centre or tracked), *others]
        groups += [COLUMNS["quaternion"]] * (COLUMNS["quaternion"] not in groups)
    asked, angles = ["t"], ""
    for group in groups:
        left = len(names) - len(asked)
        if len(group) <= left:
            asked += group
        elif group == COLUMNS["quaternion"] and left == len(_ANGLES):
            angles = f",zyx_deg={names[-3]}:{names[-1]} for {' '.join(_ANGLES)}"
    return _asked(asked, names) + angles


def _asked(ours: Sequence[str], names: Sequence[str]) -> str:
    return ",".join(f"{own}={name}" for own, name in zip(ours, names, strict=False))


def _is_unit(columns: Sequence[Column]) -> bool:
    """Return True for the numbers of a quaternion in the first row."""
    try:
        row: Sequence[Value] = [exact(column.values[0]) for column in columns]
    except (ValueError, IndexError):
        return False
    return abs(float(sum(number * number for number in row)) - 1) < _UNIT
