"""Solvers of other libraries and engines: `outside:NAME?version=VERSION&SETTING=VALUE`.

The scripts in solvers/outside are the registry. A script answers by the protocol of user programs, and runs
in its own environment with the versions that its metadata pins; `version` replaces the pin of its main
package. An environment is made when a solver solves, or by `prepare`; neither the standard run nor a list
of solvers makes one.
"""

from __future__ import annotations

import logging
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Final, final

from taylor_verify.models.problem import Problem, pose, pose_as_stored
from taylor_verify.numbers.precision import Rung
from taylor_verify.records.plugins import plugins, say_once, taken
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.engines.launcher import NotMade, Tell
from taylor_verify.solvers.engines.script import Script, read_script, scripts
from taylor_verify.solvers.options import Options, options
from taylor_verify.solvers.process import process
from taylor_verify.solvers.solver import Lack, Solver, made_without, not_started, refused
from taylor_verify.solvers.trajectory import Outcome, Trajectory

# What acts on a body that an engine takes, by what its script says of loads.
_CONSTANT: Final = ("moment", "force", "couple", "rotor", "damping")
_TAKEN: Final[Mapping[bool | str, Sequence[str]]] = {
    False: (),
    True: _CONSTANT,
    "written": (*_CONSTANT, "loads"),
}

PREFIX: Final = "outside:"
SCRIPTS: Final = Path(__file__).parents[1] / "outside"
_VERSION: Final = "version"

_log = logging.getLogger(__name__)
# Cache of the words that start the script of each block, or the reason why there are none.
_commands: dict[str, list[str] | Lack] = {}


@dataclass(frozen=True)
class Engine:
    """A method of a script, or a script without methods; ``method`` is empty there."""

    script: Script
    method: str = ""

    @property
    def name(self) -> str:
        return "-".join(filter(None, (self.script.library, self.method)))

    @property
    def title(self) -> str:
        about = self.script.about
        title = ": ".join(filter(None, (about.title, about.methods.get(self.method))))
        return ", ".join(filter(None, (title, self.script.origin)))

    @property
    def usage(self) -> str:
        """The name and the settings, NUMBER standing for one; words are shown as they are."""
        settings = [
            f"{key}={'|'.join(default) if isinstance(default, list) else 'NUMBER'}"
            for key, default in self.script.about.settings.items()
        ]
        return PREFIX + "?".join(filter(None, (self.name, "&".join(settings))))

    @property
    def unavailable(self) -> str:
        """The reason why it cannot run here; empty if it is ready, or would be after a download."""
        return process.unavailable() or self.script.launcher.unavailable()


@cache
def engines() -> Mapping[str, Engine]:
    """Return all engines by name, including unavailable ones; no environment is made."""
    every = (*scripts(SCRIPTS), *_plugged())
    each = [Engine(script, m) for script in every for m in script.about.methods or [""]]
    return {engine.name: engine for engine in each}


def _plugged() -> Iterator[Script]:
    """Yield the scripts of other packages; one that cannot be read, or has a known name, is named."""
    known = {script.library for script in scripts(SCRIPTS)}
    for plugin in plugins("engines"):
        try:
            script = replace(read_script(Path(plugin.content)), origin=plugin.origin)
            if script.library in known:
                raise ValueError(taken("engines", script.library, plugin.package))
        except ValueError as fault:
            say_once(str(fault))
        else:
            known.add(script.library)
            yield script


def usages() -> tuple[str, ...]:
    """Return the names to choose from, with their settings."""
    return tuple(engine.usage for engine in engines().values())


def remarks() -> dict[str, str]:
    """Return for each of the usages its title, with the reason if it is unavailable here."""
    return {
        engine.usage: engine.title
        + (f" (unavailable: {engine.unavailable})" if engine.unavailable else "")
        for engine in engines().values()
    }


def prepare(name: str, tell: Tell = _log.warning) -> None:
    """Make the environment of an engine, by `cvode-bdf` or a solver's whole name, if it is not there.

    ``tell`` receives progress messages, because this may take minutes. Raises NotMade with the reason, and
    ValueError for a name that is none.
    """
    solver = named(name if name.startswith(PREFIX) else f"{PREFIX}{name}")
    if reason := solver.engine.unavailable:
        raise NotMade(reason)
    _commands.pop(solver.block, None)
    if isinstance(answer := _command(solver, tell), Lack):
        raise NotMade(answer)


def command_of(solver: Outside) -> list[str] | Lack:
    """Return the words that start the script of an engine that stays, or the reason why there are none."""
    command = _command(solver)
    return command if isinstance(command, Lack) else [*command, "serve"]


def _command(solver: Outside, tell: Tell = _log.warning) -> list[str] | Lack:
    if solver.block not in _commands:
        script = solver.engine.script
        try:
            words = script.launcher.command(script.library, script.path, solver.block, tell)
            _commands[solver.block] = words
        except NotMade as reason:
            sentence = f"the environment of {script.library} could not be made: {reason}"
            _commands[solver.block] = Lack(sentence, Outcome.NO_PACKAGE)
    return _commands[solver.block]


@final
@dataclass(frozen=True)
class Outside(Solver):
    """An engine with its settings, as text; ``block`` is the metadata with the version asked for.

    Tolerances and steps count in the scene's own units.
    """

    engine: Engine = field(hash=False)
    name: str
    block: str
    settings: tuple[tuple[str, str], ...]
    time_limit: float = process.DEFAULT_LIMIT

    def unavailable(self, rung: Rung) -> str:
        rungs = self.engine.script.about.rungs
        if reason := self.engine.unavailable:
            return reason
        if rung.name not in rungs:
            return f"{self.name} is made for {' and '.join(rungs)} alone"
        answer = _commands.get(self.block)
        return answer if isinstance(answer, Lack) else ""

    def unsuited(self, problem: Problem) -> str:
        about = self.engine.script.about
        taken = _TAKEN[about.loads]
        if "loads" not in taken and (reason := super().unsuited(problem)):
            return reason
        if problem.given.model not in about.models:
            return f"{self.name} is made for {' and '.join(about.models)} alone"
        return made_without(self.name, problem.given.body, taken)

    def problem(self, scene: Scene, rung: Rung) -> Problem:
        # The truth starts from the same numbers as the engine.
        takes_tensor = self.engine.script.about.data == "tensor"
        return pose_as_stored(scene, rung) if takes_tensor else pose(scene, rung)

    def solve(self, problem: Problem) -> Trajectory:
        if reason := self.unsuited(problem):
            return refused(reason)
        if reason := self.unavailable(problem.rung):
            return not_started(reason)
        command = _command(self)
        if isinstance(command, Lack):
            return not_started(command)
        # Engines write logs into their working folder, so they get a temporary one.
        with TemporaryDirectory(ignore_cleanup_errors=True) as folder:
            words = [*command, *self.words]
            return process.program(words, self.time_limit, folder).solve(problem)

    @property
    def words(self) -> list[str]:
        """The arguments of the script: its method and the settings."""
        method = [f"method={self.engine.method}"] if self.engine.method else []
        return [*method, *(f"{key}={value}" for key, value in self.settings)]


def solve_together(asked: Sequence[tuple[Outside, Problem]]) -> list[Trajectory]:
    """Return the answers of solvers of one script and version; one process loads the library for all.

    Questions that this process leaves open, by its end, a fault or its time limit, are asked again in
    separate processes. So a failure belongs to one question, and is the same as without the others.
    """
    first, _ = asked[0]
    command = _command(first)
    answers: list[Trajectory | None] = [None] * len(asked)
    if len(asked) > 1 and not isinstance(command, Lack):
        questions = [(solver.words, problem) for solver, problem in asked]
        with TemporaryDirectory(ignore_cleanup_errors=True) as folder:
            answers = process.together(command, questions, first.time_limit, folder)
    return [
        solver.solve(problem) if answer is None else answer
        for answer, (solver, problem) in zip(answers, asked, strict=True)
    ]


def named(name: str) -> Outside:
    """Return the engine of that name with its settings.

    Raises ValueError for an engine or a setting that there is not, and for a value it cannot have.
    """
    known = engines()
    engine = known.get(name.removeprefix(PREFIX).partition("?")[0])
    defaults = engine.script.about.settings if engine else {}
    versions = [_VERSION] if engine and engine.script.package else []
    asked = options(name, known, [*defaults, *versions])
    engine = known[asked.method]
    settings: dict[str, str] = {}
    for key, default in defaults.items():
        settings[key] = _value(asked, key, default, settings)
    block = engine.script.block
    if _VERSION in asked:
        block = engine.script.at_version(asked.values[_VERSION])
    return Outside(engine, name, block, tuple(settings.items()), process.time_limit())


def _value(
    asked: Options, key: str, default: float | str | list[str], settings: Mapping[str, str]
) -> str:
    """Return the value of a setting: one of its words, or a number as a double prints it."""
    if isinstance(default, list):
        word = asked.values.get(key, default[0])
        if word not in default:
            raise ValueError(f"expected one of {', '.join(default)}, got {word!r:.60} @ {key}")
        return word
    fallback = settings[default] if isinstance(default, str) else repr(default)
    return repr(float(asked.positive(key, fallback)))
