"""Sentences about a file: what of it is compared, what is not and why."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction

from taylor_verify.judge.files.extent import Extent
from taylor_verify.records.quantities import (
    COLUMNS,
    GROUPS,
    MAIN,
    MOMENTA,
    TRACKED,
    VELOCITIES,
    state_groups,
    with_needs,
)
from taylor_verify.scenes.reading.faults import Refused
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.files.file import TrajectoryFile


def comparable(file: TrajectoryFile, scene: Scene) -> list[str]:
    """Return the groups that the scene's motion has. A file without any is refused."""
    foreign = _foreign(file, scene)
    groups = [name for name in file.groups if name not in foreign and _is_compared(name, scene)]
    if groups:
        return groups
    known = " ".join(" ".join(COLUMNS[name]) for name in _known(scene))
    faults = [
        f"expected columns of a scene of model {scene.model} ({known}), got "
        f"{' '.join(COLUMNS[name])} @ {file.name}"
        for name in foreign
    ]
    if not faults:
        wanted = state_groups(scene.model, scene.track)
        groups = [" ".join(COLUMNS[name]) for name in wanted]
        if scene.model == "kirchhoff":
            # Whoever has velocities has no impulses.
            groups.insert(0, " ".join(n for name in VELOCITIES for n in COLUMNS[name]))
        expected = " or ".join(groups)
        got = " ".join(n for name in file.groups for n in COLUMNS[name]) or "t alone"
        first = COLUMNS[wanted[0]][0]
        notes = "; ".join((*file.notes, f"name other columns: --columns {first}=NAME,..."))
        faults = [
            f"expected {expected}, which {scene.name} tracks, got {got} @ {file.name} ({notes})"
        ]
    raise Refused(faults)


def _foreign(file: TrajectoryFile, scene: Scene) -> list[str]:
    """The groups of a file that no scene of this model has."""
    return [name for name in file.groups if name not in _known(scene)]


def _known(scene: Scene) -> list[str]:
    """Return the groups that scenes of this model may have; of a solid in a fluid also its velocities."""
    quantities = {MAIN[scene.model], *TRACKED[scene.model]}
    velocities = VELOCITIES if scene.model == "kirchhoff" else ()
    return [n for n, group in GROUPS.items() if group.quantity in quantities or n in velocities]


def _is_compared(group: str, scene: Scene) -> bool:
    """Return True unless the scene might track what the columns tell, and does not."""
    quantity = GROUPS[group].quantity
    return quantity in scene.track or quantity not in TRACKED[scene.model]


def tracked(groups: Sequence[str]) -> frozenset[str]:
    """Return what a scene with these columns would track."""
    return with_needs({GROUPS[name].quantity for name in groups})


def coverage_notes(file: TrajectoryFile, groups: Sequence[str], scene: Scene) -> Iterator[str]:
    foreign = _foreign(file, scene)
    for name in foreign:
        yield (
            f"{' '.join(COLUMNS[name])} not compared: {scene.name} is of model {scene.model}, whose "
            f"motion has no {noun(name)}"
        )
    for name in file.groups:
        if name not in groups and name not in foreign:
            yield f"{' '.join(COLUMNS[name])} not compared: {scene.name} does not track the {noun(name)}"
    for name in missing_groups(groups, scene):
        other = " or r11 ... r33" if name == "quaternion" else ""
        columns = " ".join(COLUMNS[name])
        yield f"the {noun(name)} is not judged: the file has no {columns}{other}"


def missing_groups(groups: Sequence[str], scene: Scene) -> list[str]:
    """The groups that the scene asks for and the file lacks."""
    has = {"quaternion" if GROUPS[name].is_frame else name for name in groups}
    if scene.model == "kirchhoff" and has.issuperset(VELOCITIES):
        # Together they stand for the impulses.
        has |= set(MOMENTA["kirchhoff"])
    return [name for name in state_groups(scene.model, scene.track) if name not in has]


def no_start(scene: Scene, times: Sequence[Fraction]) -> Iterator[str]:
    """Whether the initial state could not be compared."""
    start = scene.clock.start
    if all(float(time) != float(start) for time in times):
        yield f"no row is at the start, t = {float(start):g}: the initial state was not compared"


def no_end(scene: Scene, times: Sequence[Fraction], extent: Extent) -> Iterator[str]:
    """Whether the file stops before the scene does."""
    if extent.reaches_end or extent.rows[-1] < 0:
        return
    last = max(times, key=lambda t: abs(t - scene.clock.start))
    end = float(scene.clock.instants[-1])
    yield (
        f"the last row is at t = {float(last):.12g}, and the scene ends at t = {end:.12g}: "
        "the rest was not judged"
    )


def noun(group: str) -> str:
    """Return the noun for what some columns tell."""
    return GROUPS[group].noun
