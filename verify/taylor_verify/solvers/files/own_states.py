"""The columns of states of the scene's own: taken by their names alone, or as asked for."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from taylor_verify.records.faults import Faults, cut
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.files.columns.assigned import Request
from taylor_verify.solvers.files.columns.selection import Taken
from taylor_verify.solvers.files.formats.column import Column


def own_columns(scene: Scene | None) -> Mapping[str, tuple[str, ...]]:
    """Return the columns of each state of the scene's own, tracked or not."""
    states = () if scene is None else scene.own_states
    return {state.name: state.components for state in states}


def apart(
    columns: list[Column],
    wanted: Request,
    own: Mapping[str, tuple[str, ...]],
    place: str,
    faults: Faults,
) -> tuple[list[Taken], list[Column], Request]:
    """Return the columns of states of the scene's own, the others, and what is asked of those."""
    names = {name for group in own.values() for name in group}
    there, asked = {column.name for column in columns}, dict[str, str]()
    for ours, theirs in (pair for pair in wanted if pair[0] in names):
        if theirs not in there:
            faults.add(f"a column of the file for {ours}", f"`{cut(theirs)}`", place)
        elif ours in asked:
            faults.add("every name once", f"{ours} again", place)
        else:
            asked[ours] = theirs
    ours_of = {name: name for name in names - asked.keys()}
    ours_of |= {theirs: ours for ours, theirs in asked.items()}
    apart = [Taken(ours_of[column.name], column) for column in columns if column.name in ours_of]
    left = [column for column in columns if column.name not in ours_of]
    return apart, left, tuple(pair for pair in wanted if pair[0] not in names)


def whole(
    taken: Sequence[Taken], own: Mapping[str, tuple[str, ...]], place: str, faults: Faults
) -> dict[str, tuple[str, ...]]:
    """Return the states of the scene's own that are there; a part of one is a fault."""
    has = {column.name for column in taken}
    there = {group: names for group, names in own.items() if not has.isdisjoint(names)}
    for names in there.values():
        if missing := [name for name in names if name not in has]:
            faults.add(f"the columns {' '.join(names)}", f"no {' '.join(missing)}", place)
    return there
