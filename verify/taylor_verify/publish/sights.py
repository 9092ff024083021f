"""What each gate saw of each defect, as stored: data/controls.json, written once and read again.

Defects are rows of words; verdicts are rows as everywhere, a defect's under its own name as solver
and its sound twin's under the twin's.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from taylor_verify.publish import data
from taylor_verify.publish.replacement import replace_files
from taylor_verify.records.quantities import STATES, is_conserved
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict, read_row

CONTROLS: Final = f"{data.FOLDER}/controls.json"

_MADE_BY: Final = {"made_by": "taylor-verify publish --controls; do not edit"}
_APART: Final = ("seconds", "provenance")
_SHIFT: Final = ("time_shift", "residual", "shift", "trend", "remains")


@dataclass(frozen=True)
class Sight:
    """One defect: its words, and the verdicts on it and on its sound twin by quantity.

    ``factor`` is the bound of every gate over what is attainable.
    """

    name: str
    scene: str
    gate: str
    what: str
    why: str
    told: bool
    twin: str
    factor: float
    verdicts: Mapping[str, Verdict]
    sound: Mapping[str, Verdict]

    @property
    def quantities(self) -> tuple[str, ...]:
        """What the scene has a gate for: the sound twin came to a verdict on all of them."""
        return tuple(self.sound)

    @property
    def conserved(self) -> tuple[str, ...]:
        return tuple(name for name in self.quantities if is_conserved(name))

    @property
    def state(self) -> tuple[str, ...]:
        return tuple(name for name in self.quantities if name in STATES)

    @property
    def is_finished(self) -> bool:
        """Whether the solver claimed success: only then is anything compared."""
        return any(verdict.at is not None for verdict in self.verdicts.values())

    @property
    def outcome(self) -> str:
        return next(iter(self.verdicts.values())).outcome

    def is_seen_by(self, quantity: str) -> bool:
        """The gate fails the defect and passes the sound twin."""
        judged, twin = self.verdicts.get(quantity), self.sound.get(quantity)
        if judged is None or not self.is_finished:
            return False
        sound = twin is None or twin.verdict is Status.PASS
        return judged.verdict is Status.FAIL and sound

    def is_missed_by(self, quantity: str) -> bool:
        """The gate passes the defect."""
        judged = self.verdicts.get(quantity)
        return judged is not None and judged.verdict is Status.PASS

    def over_bound(self, quantity: str) -> float | None:
        """The largest error over its bound; None where that is no finite number."""
        ratio = self.verdicts[quantity].ratio
        return None if ratio is None else ratio / self.factor

    @property
    def seen_by(self) -> tuple[str, ...]:
        return tuple(name for name in self.quantities if self.is_seen_by(name))


def write(folder: Path, document: Mapping[str, Any]) -> Path:
    """Store the rows of a controls run: ``factor``, ``defects``, and ``verdicts`` (of Verdict)."""
    verdicts: list[Verdict] = document["verdicts"]
    text = data.laid_out(
        {
            **_MADE_BY,
            "versions": data.versions(verdicts),
            "machine": data.machine(verdicts[0]) if verdicts else {},
            "factor": document["factor"],
            "defects": document["defects"],
            "verdicts": [_row(verdict) for verdict in verdicts],
        }
    )
    (file,) = replace_files(folder, {CONTROLS: text})
    return file


def load(folder: Path) -> tuple[Sight, ...]:
    """The sights of ``folder``/data/controls.json; none where there is no such file.

    Raises OSError for a file that cannot be read and ValueError for one that holds something else.
    """
    file = folder / CONTROLS
    if not file.exists():
        return ()
    stored = data.read_document(file)
    with data.expecting("the rows of a controls run", file):
        provenance = {"versions": stored["versions"], **stored.get("machine", {})}
        verdicts = [_verdict(row, provenance) for row in stored["verdicts"]]
        return tuple(_sight(row, verdicts, stored["factor"]) for row in stored["defects"])


def _row(verdict: Verdict) -> dict[str, Any]:
    # Which way roundings push the time is another draw on every machine.
    apart = _APART if verdict.verdict is Status.FAIL else (*_APART, *_SHIFT)
    return {name: value for name, value in verdict.row().items() if name not in apart}


def _verdict(row: Mapping[str, Any], provenance: dict[str, Any]) -> Verdict:
    return read_row({**row, "provenance": provenance})


def _sight(row: Mapping[str, Any], verdicts: Iterable[Verdict], factor: float) -> Sight:
    rows = list(verdicts)

    def of(solver: str, setting: str) -> dict[str, Verdict]:
        key = (row["scene"], solver, setting)
        return {v.quantity: v for v in rows if (v.scene, v.solver, v.setting) == key}

    found = of(row["name"], row["setting"])
    sound = of(row["twin"], row["twin_setting"])
    if not found or not sound:
        raise ValueError(f"expected verdicts on {row['name']} and its twin, got none")
    return Sight(
        name=row["name"],
        scene=row["scene"],
        gate=row["gate"],
        what=row["what"],
        why=row["why"],
        told=row["told"],
        twin=", ".join(word for word in (row["twin"], row["twin_setting"]) if word),
        factor=factor,
        verdicts=found,
        sound=sound,
    )
