"""The verdicts of every gate on every deliberate defect, and on its sound twin."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, Final

from taylor_verify.records import store
from taylor_verify.records.json_text import complete, plain, read
from taylor_verify.records.provenance import Machine
from taylor_verify.records.quantities import STATES, is_conserved
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict
from taylor_verify_reports.studies.stored import Stored


@dataclass(frozen=True)
class DefectRow:
    """A deliberate defect in words; ``twin`` is the solver that differs only in not having it.

    ``gate`` is the quantity whose gate must see the defect; ``told`` is True for defects of the short
    table.
    """

    name: str
    setting: str
    scene: str
    gate: str
    what: str
    why: str
    told: bool
    twin: str
    twin_setting: str

    @property
    def sound_solver(self) -> str:
        """The twin with its setting."""
        return ", ".join(word for word in (self.twin, self.twin_setting) if word)


@dataclass(frozen=True)
class Sight:
    """A defect beside its sound twin, with the verdicts on both by quantity.

    ``verdicts`` are those on the defect, ``sound`` those on the twin. ``factor`` is the bound of every gate
    over what is attainable. A gate sees a defect if it fails the defect and passes the twin.
    """

    defect: DefectRow
    verdicts: Mapping[str, Verdict]
    sound: Mapping[str, Verdict]
    factor: int

    @property
    def quantities(self) -> tuple[str, ...]:
        """The quantities with a gate, which are those with a verdict on the sound twin."""
        return tuple(self.sound)

    @property
    def conserved(self) -> tuple[str, ...]:
        """The conserved quantities with a gate."""
        return tuple(name for name in self.quantities if is_conserved(name))

    @property
    def state(self) -> tuple[str, ...]:
        """The state quantities with a gate."""
        return tuple(name for name in self.quantities if name in STATES)

    @property
    def is_finished(self) -> bool:
        """True if the solver claimed success: only then is anything compared."""
        return any(verdict.is_compared for verdict in self.verdicts.values())

    def is_seen_by(self, quantity: str) -> bool:
        """Return True if the gate of ``quantity`` fails the defect and passes the sound twin."""
        judged, twin = self.verdicts.get(quantity), self.sound.get(quantity)
        if judged is None or not self.is_finished:
            return False
        sound = twin is None or twin.verdict is Status.PASS
        return judged.verdict is Status.FAIL and sound

    def is_missed_by(self, quantity: str) -> bool:
        """Return True if the gate of ``quantity`` passes the defect."""
        judged = self.verdicts.get(quantity)
        return judged is not None and judged.verdict is Status.PASS

    def over_bound(self, quantity: str) -> float | None:
        """Return the largest error over its bound; None if the error is no finite number."""
        ratio = self.verdicts[quantity].ratio
        return None if ratio is None else ratio / self.factor

    @property
    def seen_by(self) -> tuple[str, ...]:
        """The gates that see the defect."""
        return tuple(name for name in self.quantities if self.is_seen_by(name))


@dataclass(frozen=True)
class ControlsStudy:
    """All defects, and the verdicts on them and on their twins, in one list by solver and setting."""

    versions: dict[str, str]
    machine: Machine
    factor: int
    defects: tuple[DefectRow, ...]
    verdicts: tuple[Verdict, ...]

    @cached_property
    def sights(self) -> tuple[Sight, ...]:
        """The defects with their verdicts. Raises ValueError if a defect or its twin has no verdicts."""
        return tuple(self._sights())

    def _sights(self) -> Iterator[Sight]:
        for defect in self.defects:
            verdicts = self._verdicts_on(defect.scene, defect.name, defect.setting)
            sound = self._verdicts_on(defect.scene, defect.twin, defect.twin_setting)
            if not verdicts or not sound:
                raise ValueError(f"expected verdicts on {defect.name} and its twin, got none")
            yield Sight(defect, verdicts, sound, self.factor)

    def _verdicts_on(self, scene: str, solver: str, setting: str) -> dict[str, Verdict]:
        run = scene, solver, setting
        return {v.quantity: v for v in self.verdicts if (v.scene, v.solver, v.setting) == run}


# The document as data/controls.json has it.


def _fields(study: ControlsStudy) -> dict[str, Any]:
    """Return the stored keys and values; of a verdict only the fields that are the same in every run."""
    rows = [store.row(verdict, apart=("scene",)) for verdict in study.verdicts]
    return {**complete(study), "machine": plain(study.machine), "verdicts": rows}


def _checked(file: Path, kind: type[ControlsStudy]) -> ControlsStudy:
    """Return the document in a file. Raises ValueError for other content, or a defect without verdicts."""
    study = read(file, kind)
    try:
        _ = study.sights
    except ValueError as error:
        raise ValueError(f"{error} @ {file}") from error
    return study


CONTROLS: Final = Stored(ControlsStudy, "controls", _fields, _checked)
