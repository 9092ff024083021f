"""Expected answers of the extremes: all that are not `pass`, with reasons.

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
from itertools import product
from typing import Final

from taylor_verify.records.precisions import LADDER
from taylor_verify.scenes import library
from taylor_verify.scenes.precision import rung
from taylor_verify.scenes.reading.faults import Faults, Refused, near, shown
from taylor_verify.scenes.reading.table import Table

FILE: Final = "EXPECTED.toml"
# `fail` is not among them: a failure has to be fixed.
WORDS: Final = ("vacuous", "refused", "undecided", "unavailable")
_ALL: Final = "*"

Row = tuple[str, str, str]
"""Scene (by its shipped name), rung and quantity."""


@dataclass(frozen=True)
class Expectation:
    """Verdict of a row that is expected not to pass, and the reason."""

    verdict: str
    why: str


@dataclass(frozen=True)
class Expectations:
    """Expectations by row, and the reasons of the runs (scene and rung) that a folder leaves out."""

    rows: Mapping[Row, Expectation] = field(default_factory=dict)
    left_out: Mapping[tuple[str, str], str] = field(default_factory=dict)

    def of(self, scene: str, rung: str, quantity: str) -> Expectation | None:
        """Return the expectation of a row; None if a pass is expected."""
        return self.rows.get((scene, rung, quantity))

    def of_run(self, scene: str, rung: str) -> dict[str, Expectation]:
        """Return the expected answers of a scene on a rung other than `pass`, by quantity."""
        return {
            row[2]: expectation
            for row, expectation in self.rows.items()
            if row[:2] == (scene, rung)
        }


def is_extreme(scene: str) -> bool:
    """Return True if the answers of a scene, given by its shipped name, are compared with the file."""
    return scene.startswith(f"{library.EXTREMES}/")


@lru_cache(maxsize=1)
def shipped() -> Expectations:
    """Return the expectations of the shipped file. Raises Refused with every fault of it."""
    file = library.cases_directory() / library.EXTREMES / FILE
    return read(file.read_text(encoding="utf-8"), library.named(library.EXTREMES))


def left_out(words: Iterable[str], rungs: Iterable[str]) -> dict[tuple[str, str], str]:
    """Return the runs that the folders among these words leave out, with the reasons.

    A scene that is asked for by its own name is run.
    """
    chosen, chosen_rungs = [*words], [*rungs]
    scenes = {name for word in chosen for name in library.named(word)}.difference(chosen)
    if not any(is_extreme(scene) for scene in scenes):
        return {}
    reasons = shipped().left_out
    return {run: why for run, why in reasons.items() if run[0] in scenes and run[1] in chosen_rungs}


def read(text: str, scenes: Iterable[str]) -> Expectations:
    """Return the expectations of these scenes in a text. Raises Refused with every fault of it."""
    faults = Faults()
    # Names as the file has them, with the shipped names.
    known = {name.removeprefix(f"{library.EXTREMES}/"): name for name in scenes}
    top = Table(tomllib.loads(text), "", faults)
    rows: dict[Row, Expectation] = {}
    for table in _tables(top, "expected"):
        runs, quantities = _runs(table, known), _words(table, "quantity")
        verdict, why = table.text("verdict"), table.text("why")
        if verdict is not None and verdict not in WORDS:
            table.fault(f"one of {', '.join(WORDS)}", shown(verdict), "verdict")
        for run, quantity in product(runs, quantities) if verdict and why else ():
            row = (*run, quantity)
            if row in rows:
                faults.add("one entry for each row", f"a second one for {row}", table.path())
            rows[row] = Expectation(str(verdict), str(why))
    left_out: dict[tuple[str, str], str] = {}
    for table in _tables(top, "left_out"):
        runs, why = _runs(table, known), table.text("why")
        left_out |= dict.fromkeys(runs, why) if why else {}
    top.close()
    if faults.lines:
        raise Refused(faults.lines)
    return Expectations(rows, left_out)


def _tables(top: Table, key: str) -> Iterator[Table]:
    """Yield the tables of an array of tables, and close each after it was read."""
    for table in (top.tables(key) if top.has(key) else None) or ():
        yield table
        table.close()


def _runs(table: Table, known: Mapping[str, str]) -> list[tuple[str, str]]:
    """Return the scenes and rungs that an entry names, by their shipped names."""
    scenes, rungs = _words(table, "scene", known), _words(table, "rung", LADDER)
    for name in scenes:
        if name not in known:
            table.fault("a scene of the extremes", name, "scene", near(name, known))
    for name in rungs:
        try:
            rung(name)
        except ValueError:
            table.fault("a rung", name, "rung", near(name, LADDER))
    return [(known[name], on) for name, on in product(scenes, rungs) if name in known]


def _words(table: Table, key: str, everything: Iterable[str] = ()) -> list[str]:
    """Return the words of a key, which has one or several; ``"*"`` stands for ``everything``."""
    expected = "a word or an array of words"
    value = table.take(key, expected)
    words = value if isinstance(value, list) else [value]
    if value is None:
        return []
    if not words or not all(isinstance(word, str) and word for word in words):
        table.fault(expected, shown(value), key)
        return []
    return [*everything] if words == [_ALL] and everything else [*map(str, words)]
