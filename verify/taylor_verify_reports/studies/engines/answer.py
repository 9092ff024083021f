"""Answer of a run of the board: its row, its trajectory and its time."""

from __future__ import annotations

import hashlib
import json
import shlex
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any, Final

import numpy as np

from taylor_verify.chain import posed
from taylor_verify.models.problem import Problem
from taylor_verify.numbers.precision import rung
from taylor_verify.records.json_text import complete, parsed
from taylor_verify.records.store import laid_out
from taylor_verify.run import solve
from taylor_verify.scenes.reading.reader import load
from taylor_verify.solvers.engines.engine import PREFIX, SCRIPTS, Outside, engines, solve_together
from taylor_verify.solvers.registry import PROCESS, PYTHON, solver_named
from taylor_verify.solvers.trajectory import Outcome, Trajectory
from taylor_verify_reports.studies.engines.document import EngineRow, Standing
from taylor_verify_reports.studies.engines.entry import Asked
from taylor_verify_reports.studies.engines.replay import States, errors_of, judged, states_of
from taylor_verify_reports.studies.finished_parts import Parts

_STANDINGS: Final = {
    Outcome.FINISHED: Standing.JUDGED,
    Outcome.NO_PACKAGE: Standing.UNAVAILABLE,
    Outcome.NO_FORMAT: Standing.UNAVAILABLE,
    Outcome.UNSUITED: Standing.UNSUITED,
}
_MOST_CHARACTERS: Final = 300


@dataclass(frozen=True)
class Answer:
    """A row, the seconds of its propagation, and its states (samples, columns); None without states."""

    row: EngineRow
    seconds: float = 0.0
    states: States | None = None

    def to_text(self) -> str:
        """Return the answer as JSON that `check` reads too; every float has all its bits."""
        columns = self.columns()
        kind = "" if self.states is None else self.states.dtype.str
        stored = _Stored(self.row, self.seconds, kind, tuple(columns)[1:])
        return laid_out({**complete(stored), **columns})

    def columns(self) -> dict[str, list[float]]:
        """Return the trajectory as the columns of a file, t first; empty without states."""
        if self.states is None:
            return {}
        scene = load(self.row.scene)
        names = [name for group in scene.groups for name in group.columns]
        times = [float(t) for t in scene.clock.instants]
        return {"t": times, **dict(zip(names, self.states.T.tolist(), strict=True))}

    @classmethod
    def from_text(cls, text: str) -> Answer:
        """Return the answer from its JSON. Raises ValueError for any other text."""
        stored, states = parsed(text.encode(), _Stored), None
        if stored.kind:
            numbers = json.loads(text)
            states = np.array([numbers[name] for name in stored.order], dtype=stored.kind).T
        return cls(stored.row, stored.seconds, states)


@dataclass(frozen=True)
class Answers(Parts):
    """Answers of runs, a file for each, so that a measurement that was stopped can go on."""

    def add(self, answer: Answer) -> None:
        """Store an answer. Raises OSError."""
        self.keep(answer.row.key.encode(), answer.to_text())

    def every(self) -> dict[Path, Answer]:
        """Return the stored answers by their files; damaged ones are skipped."""
        answers = {}
        for file in sorted(self.folder.glob(f"*{self.suffix}")):
            with suppress(ValueError):
                answers[file] = Answer.from_text(file.read_text(encoding="utf-8"))
        return answers


@dataclass(frozen=True)
class _Stored:
    """The stored form of an answer, without its columns, whose names are ``order``.

    ``kind`` is NumPy's name of the float type, empty without states.
    """

    row: EngineRow
    seconds: float
    kind: str = ""
    order: tuple[str, ...] = ()


def answered(asked: Sequence[Asked]) -> list[Answer]:
    """Run an engine in one version and precision on several scenes, and judge its answers."""
    trajectories = _trajectories(asked)
    return [_judged(run, answer) for run, answer in zip(asked, trajectories, strict=True)]


def _trajectories(asked: Sequence[Asked]) -> list[Trajectory]:
    """Return the trajectories of runs; the script of an environment answers all of them in one process."""
    solvers = [solver_named(run.solver) for run in asked]
    problems = [
        posed(load(run.scene), solver, rung(run.rung))
        for run, solver in zip(asked, solvers, strict=True)
    ]
    # A problem that cannot be posed is a trajectory that says so.
    trajectories = {
        k: problem for k, problem in enumerate(problems) if isinstance(problem, Trajectory)
    }
    pairs = {
        k: (solver, problem)
        for k, (solver, problem) in enumerate(zip(solvers, problems, strict=True))
        if isinstance(solver, Outside) and isinstance(problem, Problem)
    }
    if pairs:
        trajectories |= zip(pairs, solve_together([*pairs.values()]), strict=True)
    return [
        trajectories[k] if k in trajectories else solve(run.scene, run.solver, run.rung)
        for k, run in enumerate(asked)
    ]


def _judged(asked: Asked, trajectory: Trajectory) -> Answer:
    """Return the answer of a run: its row has the errors that the judge measures."""
    standing = _STANDINGS.get(trajectory.outcome, Standing.FAILED)
    if standing is not Standing.JUDGED:
        return Answer(row_of(asked, standing, detail=_reason(trajectory)))
    states, steps = states_of(load(asked.scene), trajectory), trajectory.steps
    errors = errors_of(judged(asked, states, steps), asked.scene)
    row = row_of(asked, standing, steps=steps, detail=trajectory.detail, **vars(errors))
    return Answer(row, trajectory.seconds, states)


def row_of(asked: Asked, standing: Standing, **numbers: Any) -> EngineRow:
    """Return the row of a run; ``numbers`` are further fields of EngineRow."""
    return EngineRow(
        engine=asked.entry.name,
        version=version_of(asked),
        variant=asked.variant,
        knob=asked.entry.knob,
        value=asked.value,
        scene=asked.scene,
        rung=asked.rung,
        solver=asked.solver,
        standing=standing,
        made_of=made_of(asked.scene, asked.entry.solver),
        shipped=asked.shipped,
        load=asked.entry.load if load(asked.scene).body.loads else "",
        **numbers,
    )


def version_of(asked: Asked) -> str:
    """Return the version of an engine: that of the list, asked for, pinned in its script, or installed."""
    if asked.entry.edition:
        return asked.entry.edition
    if asked.version or not asked.entry.package:
        return asked.version or _pinned(asked.entry.solver)
    try:
        return version(asked.entry.package)
    except PackageNotFoundError:
        return ""


@cache
def made_of(scene: str, solver: str) -> str:
    """Return the digest of a scene and of what moves it; another digest marks an outdated run."""
    digest = hashlib.sha256(load(scene).digest.encode())
    programs = _programs(solver)
    if solver.startswith(PREFIX) and load(scene).body.loads:
        programs.append(SCRIPTS / "acting.py")
    for file in programs:
        digest.update(file.read_bytes())
    return digest.hexdigest()[:12]


def _programs(solver: str) -> list[Path]:
    """Return the files that make a solver: an engine's script, or the files that a command names."""
    if solver.startswith(PREFIX):
        name = solver.removeprefix(PREFIX).partition("?")[0]
        return [engines()[name].script.path]
    words = shlex.split(solver.partition(":")[2]) if solver.startswith(PROCESS) else []
    if solver.startswith(PYTHON):
        words = [f"{solver.removeprefix(PYTHON).partition(':')[0].replace('.', '/')}.py"]
    return [Path(word) for word in words if Path(word).is_file()]


def _pinned(solver: str) -> str:
    """Return the version of its package that an engine's script requires; empty if there is none."""
    engine = engines().get(solver.removeprefix(PREFIX)) if solver.startswith(PREFIX) else None
    return engine.script.version if engine else ""


def _reason(trajectory: Trajectory) -> str:
    outcome = trajectory.outcome.value
    return f"{outcome}: {trajectory.detail}"[:_MOST_CHARACTERS] if trajectory.detail else outcome
