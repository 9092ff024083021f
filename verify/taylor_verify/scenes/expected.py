"""What is expected of the extremes: every answer of theirs that is not `pass`, and why.

The file is cases/extremes/EXPECTED.toml:

    [[expected]]                      an answer that is not `pass`
    scene = "euler-separatrix-long"   one or several of cases/extremes; "*" is all of them
    rung = ["f32", "f64"]             one or several; "*" is all of them
    quantity = "omega"                one or several
    verdict = "vacuous"               vacuous, refused, undecided or unavailable: never `fail`
    why = "..."                       a sentence

    [[left_out]]                      a run that a whole folder leaves out; asked for by name, it runs
    scene, rung, why                  as above

A row of an extreme that is not named here is expected to pass.
"""

from __future__ import annotations

import tomllib
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from typing import Any, Final

from taylor_verify.records.precisions import LADDER
from taylor_verify.scenes import library
from taylor_verify.scenes.precision import rung
from taylor_verify.scenes.reading.faults import Faults, Refused, near, shown
from taylor_verify.scenes.reading.table import Table

FILE: Final = "EXPECTED.toml"
# `fail` is not among them: what fails is mended, and not expected.
WORDS: Final = ("vacuous", "refused", "undecided", "unavailable")
_ALL: Final = "*"

Row = tuple[str, str, str]
"""Scene (by its shipped name), rung and quantity."""


@dataclass(frozen=True)
class Expectation:
    """One row that is expected not to pass: with which verdict, and why."""

    verdict: str
    why: str


@dataclass(frozen=True)
class Expectations:
    """All of them by row, and the runs (scene and rung) that a folder leaves out with the reason."""

    rows: Mapping[Row, Expectation] = field(default_factory=dict)
    left_out: Mapping[tuple[str, str], str] = field(default_factory=dict)

    def of(self, scene: str, rung: str, quantity: str) -> Expectation | None:
        """None where a pass is expected."""
        return self.rows.get((scene, rung, quantity))

    def of_run(self, scene: str, rung: str) -> dict[str, Expectation]:
        """By quantity, what one scene is expected to answer on one rung besides `pass`."""
        return {row[2]: found for row, found in self.rows.items() if row[:2] == (scene, rung)}


def is_extreme(scene: str) -> bool:
    """Whether the answers of a scene, given by its shipped name, are held to the file."""
    return scene.startswith(f"{library.EXTREMES}/")


@lru_cache(maxsize=1)
def shipped() -> Expectations:
    """Those of the shipped file; raises Refused with every fault of it."""
    file = library.cases_directory() / library.EXTREMES / FILE
    return read(file.read_text(encoding="utf-8"), library.named(library.EXTREMES))


def left_out(words: Iterable[str], rungs: Iterable[str]) -> dict[tuple[str, str], str]:
    """The runs that the folders among these words leave out, and why.

    A scene that is asked for by its own name is run.
    """
    chosen, on = [*words], [*rungs]
    scenes = {name for word in chosen for name in library.named(word)}.difference(chosen)
    if not any(is_extreme(scene) for scene in scenes):
        return {}
    found = shipped().left_out
    return {run: why for run, why in found.items() if run[0] in scenes and run[1] in on}


def read(text: str, scenes: Iterable[str]) -> Expectations:
    """The expectations that a text holds of these scenes; raises Refused with every fault of it."""
    faults = Faults()
    known = {name.removeprefix(f"{library.EXTREMES}/"): name for name in scenes}
    reader = _Reader(faults, known)
    document = tomllib.loads(text)
    rows: dict[Row, Expectation] = {}
    for table in _tables(document, "expected", faults):
        for row, expectation in reader.expected(table):
            if row in rows:
                faults.add("one entry for each row", f"a second one for {row}", table.path())
            rows[row] = expectation
    left_out = {
        run: why
        for table in _tables(document, "left_out", faults)
        for run, why in reader.left_out(table)
    }
    for key in set(document).difference(("expected", "left_out")):
        faults.add("a known table", f"`{key}`", key, near(key, ("expected", "left_out")))
    if faults.lines:
        raise Refused(faults.lines)
    return Expectations(rows, left_out)


def _tables(document: Mapping[str, Any], key: str, faults: Faults) -> Iterator[Table]:
    """The tables of an array of tables, each closed after it was read."""
    entries = document.get(key, [])
    for i, entry in enumerate(entries if isinstance(entries, list) else [entries]):
        if not isinstance(entry, dict):
            faults.add("a table", shown(entry), f"{key}[{i}]")
            continue
        table = Table(entry, f"{key}[{i}]", faults)
        yield table
        table.close()


@dataclass(frozen=True)
class _Reader:
    """Reads one entry of the file; ``scenes`` maps names as the file has them to shipped names."""

    faults: Faults
    scenes: Mapping[str, str]

    def expected(self, table: Table) -> Iterator[tuple[Row, Expectation]]:
        runs, quantities = list(self._runs(table)), self._words(table, "quantity")
        verdict, why = table.text("verdict"), table.text("why")
        if verdict is not None and verdict not in WORDS:
            table.fault(f"one of {', '.join(WORDS)}", shown(verdict), "verdict")
        if verdict is not None and why is not None:
            for scene, rung_name in runs:
                for quantity in quantities:
                    yield (scene, rung_name, quantity), Expectation(verdict, why)

    def left_out(self, table: Table) -> Iterator[tuple[tuple[str, str], str]]:
        runs, why = list(self._runs(table)), table.text("why")
        for run in runs if why is not None else ():
            yield run, str(why)

    def _runs(self, table: Table) -> Iterator[tuple[str, str]]:
        scenes = self._words(table, "scene", self.scenes)
        rungs = self._words(table, "rung", LADDER)
        for name in scenes:
            if name not in self.scenes:
                table.fault("a scene of the extremes", name, "scene", near(name, self.scenes))
                continue
            for rung_name in rungs:
                if _is_rung(rung_name):
                    yield self.scenes[name], rung_name
                else:
                    table.fault("a rung", rung_name, "rung", near(rung_name, LADDER))

    def _words(self, table: Table, key: str, everything: Iterable[str] = ()) -> list[str]:
        """A word, several, or ``"*"`` for all of them."""
        expected = "a word or an array of words"
        value = table.take(key, expected)
        words = value if isinstance(value, list) else [value]
        if value is None:
            return []
        if not words or not all(isinstance(word, str) and word for word in words):
            table.fault(expected, shown(value), key)
            return []
        all_of_them = list(everything)
        return all_of_them if words == [_ALL] and all_of_them else [str(word) for word in words]


def _is_rung(name: str) -> bool:
    try:
        rung(name)
    except ValueError:
        return False
    return True
