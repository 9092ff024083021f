"""Sentences about a file: the columns of it that are compared, and the others with the reason."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
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
)
from taylor_verify.scenes.reading.faults import Refused
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.files.file import TrajectoryFile


def comparable(file: TrajectoryFile, scene: Scene) -> list[str]:
    """Return the groups that the scene's motion has. A file without any is refused."""
    known = _known(scene)
    # A scene might track what the columns tell, and does not.
    untracked = {name for name in TRACKED[scene.model] if name not in scene.track}
    groups = [n for n in file.groups if n in known and GROUPS[n].quantity not in untracked]
    if groups:
        return groups
    foreign = [name for name in file.groups if name not in known]
    if foreign:
        expected = f"expected columns of a scene of model {scene.model} ({_columns(known)})"
        raise Refused([f"{expected}, got {_columns([name])} @ {file.name}" for name in foreign])
    wanted = state_groups(scene.model, scene.track)
    # Whoever has velocities has no impulses.
    instead = [VELOCITIES] if scene.model == "kirchhoff" else []
    expected = " or ".join(_columns(names) for names in (*instead, *([name] for name in wanted)))
    notes = "; ".join(
        (*file.notes, f"name other columns: --columns {COLUMNS[wanted[0]][0]}=NAME,...")
    )
    got = _columns(file.groups) or "t alone"
    raise Refused(
        [f"expected {expected}, which {scene.name} tracks, got {got} @ {file.name} ({notes})"]
    )


def _columns(groups: Iterable[str]) -> str:
    return " ".join(column for name in groups for column in COLUMNS[name])


def _known(scene: Scene) -> list[str]:
    """Return the groups that scenes of this model may have; of a solid in a fluid also its velocities."""
    quantities = {MAIN[scene.model], *TRACKED[scene.model]}
    velocities = VELOCITIES if scene.model == "kirchhoff" else ()
    return [n for n, group in GROUPS.items() if group.quantity in quantities or n in velocities]


def coverage_notes(file: TrajectoryFile, groups: Sequence[str], scene: Scene) -> Iterator[str]:
    """Yield a sentence for each group that is not compared, those without a meaning here first."""
    known = _known(scene)
    for name in sorted(file.groups, key=lambda name: name in known):
        if name not in known:
            why = f"{scene.name} is of model {scene.model}, whose motion has no {GROUPS[name].noun}"
        elif name not in groups:
            why = f"{scene.name} does not track the {GROUPS[name].noun}"
        else:
            continue
        yield f"{_columns([name])} not compared: {why}"
    for name in missing_groups(groups, scene):
        other = " or r11 ... r33" if name == "quaternion" else ""
        yield (f"the {GROUPS[name].noun} is not judged: the file has no {_columns([name])}{other}")


def missing_groups(groups: Sequence[str], scene: Scene) -> list[str]:
    """Return the groups that the scene asks for and the file lacks."""
    has = {"quaternion" if GROUPS[name].is_frame else name for name in groups}
    if scene.model == "kirchhoff" and has.issuperset(VELOCITIES):
        # Together they stand for the impulses.
        has |= set(MOMENTA["kirchhoff"])
    return [name for name in state_groups(scene.model, scene.track) if name not in has]


def span_notes(scene: Scene, times: Sequence[Fraction], extent: Extent) -> Iterator[str]:
    """Yield a sentence if no row is at the start, and one if the file stops before the scene does."""
    start, end = float(scene.clock.start), float(scene.clock.instants[-1])
    if all(float(time) != start for time in times):
        yield f"no row is at the start, t = {start:g}: the initial state was not compared"
    if extent.rows[-1] >= 0 and not extent.reaches_end:
        last = float(max(times, key=lambda t: abs(t - scene.clock.start)))
        yield (
            f"the last row is at t = {last:.12g}, and the scene ends at t = {end:.12g}: "
            "the rest was not judged"
        )
