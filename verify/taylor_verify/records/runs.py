"""Verdicts gathered by run and put in reading order: Euler first, scenes by name, rungs upwards."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from taylor_verify.records import status
from taylor_verify.records.precisions import place_of_rung
from taylor_verify.records.quantities import CONSERVED, MAIN, is_state
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict

_MODELS = {MAIN["euler"]: "Euler", MAIN["kirchhoff"]: "Kirchhoff"}
_READING_ORDER = (*_MODELS.values(), "")


@dataclass(frozen=True)
class Run:
    """The verdicts of one scene, solver, setting and rung."""

    scene: str
    solver: str
    setting: str
    rung: str
    verdicts: tuple[Verdict, ...]

    @property
    def model(self) -> str:
        """The model that the main quantity belongs to; empty where only others were compared."""
        quantities = (verdict.quantity for verdict in self.verdicts)
        return next((_MODELS[name] for name in quantities if name in _MODELS), "")

    @property
    def state(self) -> tuple[Verdict, ...]:
        return tuple(v for v in self.verdicts if is_state(v.quantity))

    @property
    def conserved(self) -> dict[str, Verdict]:
        """The verdicts by conserved quantity; empty for a run that was not compared with anything."""
        return {v.quantity: v for v in self.verdicts if v.is_conserved}

    @property
    def drifts(self) -> tuple[Verdict, ...]:
        """The verdicts of the conserved quantities; a run that came to none has one verdict for all."""
        return tuple(self.conserved.values()) if self.is_scored else self.verdicts

    @property
    def is_scored(self) -> bool:
        return any(verdict.is_compared for verdict in self.verdicts)


def conserved_quantities(runs: Iterable[Run]) -> tuple[str, ...]:
    """Return the conserved quantities of all these runs, each once."""
    names = dict.fromkeys(name for run in runs for name in run.conserved)
    known = [name for name in CONSERVED if name in names]
    return (*known, *(name for name in names if name not in known))


def quantities_of_scene(run: Run, among: Sequence[Run]) -> tuple[str, ...]:
    """Return what the scene of a run conserves, known from other rungs or else from other scenes."""
    same = conserved_quantities(other for other in among if other.scene == run.scene)
    return same or conserved_quantities(other for other in among if other.model == run.model)


def gravest(verdicts: Iterable[Verdict]) -> Status:
    """Return the status of several verdicts taken together."""
    return status.gravest(verdict.verdict for verdict in verdicts)


def runs(verdicts: Iterable[Verdict]) -> tuple[Run, ...]:
    """Return the runs in reading order, each with its verdicts in the order in which they came."""
    gathered: dict[tuple[str, str, str, str], list[Verdict]] = {}
    for verdict in verdicts:
        gathered.setdefault(verdict.run, []).append(verdict)
    result = [Run(*key, tuple(rows)) for key, rows in gathered.items()]
    return tuple(sorted(result, key=_place))


def _place(run: Run) -> tuple[int, str, str, str, tuple[int, int, str]]:
    model = _READING_ORDER.index(run.model)
    return model, run.solver, run.setting, run.scene, place_of_rung(run.rung)
