"""Verdicts gathered by run and put in reading order: Euler first, scenes by name, rungs upwards."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from taylor_verify.judge.verdict import STATES, Status, Verdict

STATE_QUANTITIES = STATES

# The order of columns: energy, momenta in body axes, momenta in space. Others come after these.
CONSERVED_QUANTITIES = (
    *("T", "H2", "H_space", "F2", "FG", "y1", "y2", "y3"),
    *("clebsch2", "neumann", "steklov", "lyapunov", "chaplygin", "sokolov", "x_space", "y_space"),
)

# The worst first.
GRAVITY = (
    Status.FAIL,
    Status.UNDECIDED,
    Status.REFUSED,
    Status.VACUOUS,
    Status.UNAVAILABLE,
    Status.PASS,
)

_MODELS = {"omega": "Euler", "impulse": "Kirchhoff"}
_READING_ORDER = (*_MODELS.values(), "")
_BITS = {"f32": 24, "f64": 53, "f80": 64, "f128": 113}


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
        return tuple(v for v in self.verdicts if v.quantity in STATE_QUANTITIES)

    @property
    def conserved(self) -> dict[str, Verdict]:
        """By quantity; empty for a run that was not compared with anything."""
        return {v.quantity: v for v in self.verdicts if v.is_conserved}

    @property
    def drifts(self) -> tuple[Verdict, ...]:
        """Of the conserved quantities; a run that came to none has one verdict for all."""
        return tuple(self.conserved.values()) if self.is_scored else self.verdicts

    @property
    def is_scored(self) -> bool:
        return any(is_scored(verdict) for verdict in self.verdicts)


def conserved_quantities(runs: Iterable[Run]) -> tuple[str, ...]:
    """Those of all these runs, each once."""
    found = dict.fromkeys(name for run in runs for name in run.conserved)
    known = [name for name in CONSERVED_QUANTITIES if name in found]
    return (*known, *(name for name in found if name not in known))


def quantities_of_scene(run: Run, among: Sequence[Run]) -> tuple[str, ...]:
    """What the run's scene conserves: known from other rungs, or else from other scenes."""
    same = conserved_quantities(other for other in among if other.scene == run.scene)
    return same or conserved_quantities(other for other in among if other.model == run.model)


def gravest(verdicts: Iterable[Verdict]) -> Status:
    """The status of several verdicts taken together."""
    return min((verdict.verdict for verdict in verdicts), key=GRAVITY.index)


def is_scored(verdict: Verdict) -> bool:
    """Whether a comparison was made: a run that never came to one has no time of an error."""
    return verdict.at is not None


def runs(verdicts: Iterable[Verdict]) -> tuple[Run, ...]:
    """The runs in reading order, each with its verdicts in the order in which they came."""
    gathered: dict[tuple[str, str, str, str], list[Verdict]] = {}
    for verdict in verdicts:
        key = (verdict.scene, verdict.solver, verdict.setting, verdict.rung)
        gathered.setdefault(key, []).append(verdict)
    found = [Run(*key, tuple(rows)) for key, rows in gathered.items()]
    return tuple(sorted(found, key=_place))


def _place(run: Run) -> tuple[int, str, str, str, tuple[int, int, str]]:
    model = _READING_ORDER.index(run.model)
    return model, run.solver, run.setting, run.scene, place_of_rung(run.rung)


def place_of_rung(rung: str) -> tuple[int, int, str]:
    """The ladder: the IEEE formats by their bits, then mpN by N, then anything else."""
    if rung in _BITS:
        return 0, _BITS[rung], rung
    multiple = re.fullmatch(r"mp([0-9]+)", rung)
    return (1, int(multiple[1]), rung) if multiple else (2, 0, rung)
