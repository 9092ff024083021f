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
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from itertools import product
from typing import Final, Literal

import msgspec

from taylor_verify.numbers.precision import rung
from taylor_verify.records.faults import refusal
from taylor_verify.records.json_text import converted
from taylor_verify.records.precisions import LADDER
from taylor_verify.scenes import library

FILE: Final = "EXPECTED.toml"
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
    """Return the expectations of the shipped file."""
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


class _LeftOut(msgspec.Struct, forbid_unknown_fields=True):
    scene: str | list[str]
    rung: str | list[str]
    why: str


class _Expected(_LeftOut):
    quantity: str | list[str]
    # `fail` is not among them: a failure has to be fixed.
    verdict: Literal["vacuous", "refused", "undecided", "unavailable"]


class _File(msgspec.Struct, forbid_unknown_fields=True):
    expected: list[_Expected] = []
    left_out: list[_LeftOut] = []


def read(text: str, scenes: Iterable[str]) -> Expectations:
    """Return the expectations of these scenes in a text.

    Raises ValueError for a text that is none, and Refused for an unknown scene and a row's second entry.
    """
    # Names as the file has them, with the shipped names.
    known = {name.removeprefix(f"{library.EXTREMES}/"): name for name in scenes}
    file = converted(tomllib.loads(text), _File)
    rows: dict[Row, Expectation] = {}
    for entry in file.expected:
        for run, quantity in product(_runs(entry, known), _words(entry.quantity)):
            row = (*run, quantity)
            if row in rows:
                raise refusal("one entry for each row", "a second one", " ".join(row))
            rows[row] = Expectation(entry.verdict, entry.why)
    left_out = {run: entry.why for entry in file.left_out for run in _runs(entry, known)}
    return Expectations(rows, left_out)


def _runs(entry: _LeftOut, known: Mapping[str, str]) -> list[tuple[str, str]]:
    """Return the scenes and rungs that an entry names, by their shipped names."""
    scenes, rungs = _words(entry.scene, known), _words(entry.rung, LADDER)
    if unknown := [name for name in scenes if name not in known]:
        raise refusal("scenes of the extremes", ", ".join(unknown), FILE)
    return [(known[name], rung(on).name) for name, on in product(scenes, rungs)]


def _words(given: str | list[str], everything: Iterable[str] = ()) -> list[str]:
    """Return the words of a key, which has one or several; ``"*"`` stands for ``everything``."""
    words = given if isinstance(given, list) else [given]
    return [*everything] if words == [_ALL] and everything else words
