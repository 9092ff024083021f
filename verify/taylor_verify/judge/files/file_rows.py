"""The rows of a trajectory file as exact numbers, corrected if its conventions were accepted."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from operator import neg
from typing import Any, Final

import numpy as np
from mpmath import mp

from taylor_verify.exact.route import solution
from taylor_verify.judge.conventions.fits import Conventions
from taylor_verify.judge.conventions.meanings import Reading
from taylor_verify.judge.files.meant_times import meant_times
from taylor_verify.judge.floor.arithmetic import truth_digits
from taylor_verify.judge.velocities import momenta
from taylor_verify.models.problem import adopt
from taylor_verify.numbers.precision import Rung
from taylor_verify.records.quantities import GROUPS, MAIN, MOMENTA, VELOCITIES
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.files.file import TrajectoryFile
from taylor_verify.solvers.trajectory import ByRows

Array = np.ndarray[Any, Any]

# Numbers that are not dyadic, and corrected numbers, are rounded with this many more bits than the rung.
_SPARE_BITS: Final = 128


@dataclass(frozen=True)
class FileRows(ByRows):
    """Rows of a file, and the scene that they are compared with. ``times`` are the times of all rows.

    ``places`` are the compared rows, in the order away from the start.
    """

    scene: Scene
    times: Sequence[Fraction]
    file: TrajectoryFile
    rung: Rung
    readings: Mapping[str, Reading]
    places: range

    @classmethod
    def of(cls, file: TrajectoryFile, rung: Rung, conventions: Conventions) -> FileRows:
        """Return the rows of a file, read by these conventions."""
        world, places = conventions.world, range(len(file.times))
        times = meant_times(world.times(file.times), world.scene, rung)
        return cls(world.scene, times, file, rung, conventions.readings, places)

    @property
    def count(self) -> int:  # type: ignore[override]
        return len(self.places)

    @property
    def instants(self) -> tuple[Fraction, ...]:
        """Times of the compared rows."""
        return tuple(self.times[k] for k in self.places)

    def __iter__(self) -> Iterator[str]:
        momenta_names = MOMENTA[self.scene.model] if self.has_velocities else ()
        return iter((*self.file.groups, *momenta_names))

    def rows(self, places: Sequence[int]) -> dict[str, Array]:
        asked, bits = [self.places[k] for k in places], self.rung.bits + _SPARE_BITS
        values = {name: rows.as_mpf(asked, bits) for name, rows in self.file.groups.items()}
        if "attitude" in values:
            values["attitude"] = values["attitude"].reshape(-1, 3, 3)
        if self.readings:
            # The exact attitude converts vectors that are in space axes.
            given = adopt(self.scene, self.rung, tuple(self.times[k] for k in asked)).given
            tracked, digits = (
                replace(given, track=frozenset({"attitude"})),
                truth_digits(bits, more=0),
            )
            R = solution(tracked).motion(given.clock.elapsed, digits)["attitude"]
            with mp.workprec(bits):
                for name, reading in self.readings.items():
                    values[name] = reading.read(values[name], R)
        if self.has_velocities:
            with mp.workprec(bits):
                values |= momenta(self.scene.body, values)
        return values

    @property
    def has_velocities(self) -> bool:
        """True if the impulses are computed from velocities, because the file has no impulses."""
        has = set(self.file.groups)
        stands_for = self.scene.body.has_velocities and has.issuperset(VELOCITIES)
        return stands_for and not has & set(MOMENTA[self.scene.model])

    def sides(self) -> list[FileRows]:
        """Return the rows after the start and those before it, each in the order away from the start."""
        start, times = self.scene.clock.start, self.times
        rises = times[0] <= times[-1]
        value, key = (start, None) if rises else (-start, neg)
        at, beyond = (find(times, value, key=key) for find in (bisect_left, bisect_right))
        above, below = range(at - 1, -1, -1), range(beyond, len(times))
        later, earlier = (below, above) if rises else (above, below)
        # A row at the start belongs to the later side, or to the only side.
        first, second = (later, earlier) if later else (earlier, later)
        begin = first.start - first.step * (beyond - at)
        first = range(begin, first.stop, first.step) if first else range(at, beyond)
        return [replace(self, places=side) for side in (first, second) if side]


def first_flaw(file: TrajectoryFile, quantity: str) -> str:
    """Return the place of the first value of a quantity that is not finite; empty if there is none."""
    made_of = [name for name, group in GROUPS.items() if group.quantity == quantity]
    if quantity == MAIN["kirchhoff"]:
        made_of += VELOCITIES
    if quantity in file.groups:
        made_of.append(quantity)
    # A conserved quantity may need any group.
    groups = [name for name in made_of or file.columns if name in file.groups]
    lost = {name: np.flatnonzero(~file.groups[name].finite) for name in groups}
    first = {name: int(rows[0]) for name, rows in lost.items() if len(rows)}
    if not first:
        return ""
    group = min(first, key=lambda name: first[name])
    row = first[group]
    name, value = next(
        (name, value)
        for name, value in zip(file.columns[group], file.groups[group][row], strict=True)
        if not isinstance(value, Fraction)
    )
    return f"{name} is {value} in row {row + 1}, t = {float(file.times[row]):g}"


def first_zero_quaternion(file: TrajectoryFile) -> str:
    """Return the place of the first quaternion of length zero, which is no attitude; empty without one."""
    rows = file.groups.get("quaternion", ())
    row = next((k for k in range(len(rows)) if not any(rows[k])), None)
    if row is None:
        return ""
    names = " ".join(file.columns["quaternion"])
    return f"{names} are 0 in row {row + 1}, t = {float(file.times[row]):g}"
