"""The entry list of a board, such as engines.toml, and the runs that it asks for.

name       the engine, in the name of its page and for `--only`; several rows may have the same
title      the name of the engine as its authors write it
solver     the name of a solver, without settings; or a whole one, with {step} in the place of the value
versions   optional: the oldest first. The last one is run on every scene, the others on scenes with `sweep`
settings   optional: each option with its values, which are run in all combinations
knob       the option that sets the accuracy, `step` unless given
values     its values, from coarse to fine, as text
rungs      optional: the precisions of the arithmetic, f64 unless given
only       optional: the scenes that are run; without them all scenes that the solver takes
without    optional: scenes that are not run
shipped    optional: the options that restore the engine's defaults; they are run with the second of the
           values only
warning    optional: the fault of an engine as shipped, in words
edition    optional: the version that is shown, for an entrant made of published equations
load       optional: how the loads of a scene reach the engine, in words
package    optional: the installed package whose version is shown, for a solver that runs here
plain      true for a solver of differential equations that is no engine
"""

from __future__ import annotations

import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from itertools import product
from pathlib import Path
from typing import Final

from taylor_verify.records.json_text import converted

BOARDS: Final = ("engines", "satellite", "underwater")
"""The boards in their order; the first one is that of free bodies."""


STEP: Final = "{step}"
"""The place of the step in the name of a solver that has it among its own words."""


@dataclass(frozen=True)
class About:
    """Words of a board: the title of its page, what it measures, remarks, and scripts of findings."""

    title: str = "The engine board"
    what: str = ""
    remarks: tuple[str, ...] = ()
    findings: tuple[str, ...] = ()


@dataclass(frozen=True)
class BoardScene:
    """A scene of the board; ``least`` is the smallest step that is run on it.

    ``job`` is what the scene stands for, in the advice "For JOB take ..."; a scene without it is not
    advised on. ``sweep`` marks a scene on which older versions are run, ``shipped`` one of the table
    "as shipped", and ``switches`` one whose loads switch at times that a step can miss.
    """

    name: str
    least: float = 0.0
    job: str = ""
    sweep: bool = False
    shipped: bool = False
    switches: bool = False


@dataclass(frozen=True)
class Entry:
    """A row of the list; the module's docstring explains its fields."""

    name: str
    title: str
    solver: str
    values: tuple[str, ...] = ()
    versions: tuple[str, ...] = ()
    settings: Mapping[str, tuple[str, ...]] | None = None
    knob: str = "step"
    rungs: tuple[str, ...] = ("f64",)
    only: tuple[str, ...] = ()
    without: tuple[str, ...] = ()
    shipped: Mapping[str, str] | None = None
    warning: str = ""
    load: str = ""
    edition: str = ""
    package: str = ""
    plain: bool = False

    def runs(self, scenes: tuple[BoardScene, ...]) -> Iterator[Asked]:
        """Yield the runs of this row: each version, setting, value and rung on each of its scenes."""
        newest = self.versions[-1] if self.versions else ""
        for version in reversed(self.versions or ("",)):
            for words, rung, scene in product(self._words(), self.rungs, scenes):
                if self._is_asked(scene) and (version == newest or scene.sweep):
                    yield from self._at_values(version, words, rung, scene)
        if self.shipped:
            for words, rung, scene in product(self._words(), self.rungs, scenes):
                if self._is_asked(scene) and scene.shipped:
                    defaults = {**words, **self.shipped}
                    every = self._at_values(newest, defaults, rung, scene, shipped=True)
                    # One value is enough to show the fault.
                    yield from (run for run in every if run.value in self.values[1:2])

    def _at_values(
        self,
        version: str,
        words: Mapping[str, str],
        rung: str,
        scene: BoardScene,
        shipped: bool = False,
    ) -> Iterator[Asked]:
        """Yield a run for each value, without steps that are too small for the scene."""
        for value in self.values or ("",):
            if not value or self.knob != "step" or float(value) >= scene.least:
                yield Asked(self, version, tuple(words.items()), value, rung, scene.name, shipped)

    def _words(self) -> list[dict[str, str]]:
        """Return every combination of the options' values."""
        settings = self.settings or {}
        return [dict(zip(settings, words, strict=True)) for words in product(*settings.values())]

    def _is_asked(self, scene: BoardScene) -> bool:
        return scene.name not in self.without and (not self.only or scene.name in self.only)


@dataclass(frozen=True)
class Asked:
    """A run that the list asks for: one setting of an engine on one scene."""

    entry: Entry
    version: str
    words: tuple[tuple[str, str], ...]
    value: str
    rung: str
    scene: str
    shipped: bool = False

    @property
    def solver(self) -> str:
        """The whole name of the solver, as `--solver` takes it."""
        if STEP in self.entry.solver:
            return self.entry.solver.replace(STEP, self.value)
        version = [("version", self.version)] if self.version else []
        accuracy = [(self.entry.knob, self.value)] if self.value else []
        settings = "&".join(f"{key}={word}" for key, word in (*version, *self.words, *accuracy))
        return "?".join(filter(None, (self.entry.solver, settings)))

    @property
    def variant(self) -> str:
        """The method and its settings, as tables name them."""
        if STEP in self.entry.solver:
            return self.entry.solver.replace(STEP, "h")
        family, _, method = self.entry.solver.partition(":")
        method = method.partition("-")[2] if family == "outside" else method
        # A number says nothing without the name of its option.
        words = [word if word[:1].isalpha() else f"{key}={word}" for key, word in self.words]
        return ", ".join(filter(None, [method, *words]))

    @property
    def seeks_cause(self) -> bool:
        """True at the coarsest value, where a fault of the equations shows as at every other.

        The search takes longer than everything else that is done for a row.
        """
        return self.shipped or self.value in ("", *self.entry.values[:1])

    @property
    def key(self) -> str:
        """The text that identifies the run."""
        return f"{self.solver} {self.rung} {self.scene}"

    def __str__(self) -> str:
        return f"{self.scene} by {self.solver} on {self.rung}"


@dataclass(frozen=True)
class EntryList:
    """All scenes and rows of the file, under its own names."""

    scene: tuple[BoardScene, ...]
    entry: tuple[Entry, ...]
    about: About = About()

    @property
    def engines(self) -> tuple[str, ...]:
        """The names of the engines in the order of the list, each once."""
        return tuple(dict.fromkeys(row.name for row in self.entry))

    @property
    def advised(self) -> list[str]:
        """The scenes that the advice rests on."""
        return [scene.name for scene in self.scene if scene.job]

    @property
    def jobs(self) -> dict[str, list[str]]:
        """The scenes of each job, in the order of the list."""
        jobs: dict[str, list[str]] = {}
        for scene in self.scene:
            if scene.job:
                jobs.setdefault(scene.job, []).append(scene.name)
        return jobs

    @property
    def titles(self) -> dict[str, str]:
        """The titles of the engines by their names."""
        return {row.name: row.title for row in self.entry}

    def runs(self) -> list[Asked]:
        """Return every run, each once."""
        every = (run for row in self.entry for run in row.runs(self.scene))
        return list({run.key: run for run in every}.values())


@cache
def entry_list(board: str = BOARDS[0]) -> EntryList:
    """Return the list of a board. Raises a ValueError that names the place of a fault."""
    return read_list(list_of(board))


def list_of(board: str) -> Path:
    """Return the file with the entry list of a board."""
    return Path(__file__).with_name(f"{board}.toml")


def read_list(file: Path) -> EntryList:
    """Return the list in a file. Raises a ValueError that names the place of a fault."""
    try:
        return converted(tomllib.loads(file.read_text(encoding="utf-8")), EntryList)
    except ValueError as error:
        raise ValueError(f"{error} @ {file.name}") from error
