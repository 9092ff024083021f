"""Comparison of the settings of the board: orders, best steps, and the largest error on several scenes.

A setting is an engine, a version, options and a precision; the rows of a setting differ in the step and the
scene.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import groupby
from math import inf, log10

from taylor_verify.records.answers import Order, OrderPoint
from taylor_verify.records.json_text import finite
from taylor_verify.records.order_of_points import read_order
from taylor_verify.words.cells import NOTHING
from taylor_verify_reports.studies.engines.document import EngineRow, EnginesStudy


@dataclass(frozen=True)
class EngineSetting:
    """The rows of one setting, in the order of the list: scene by scene, from coarse to fine."""

    engine: str
    version: str
    variant: str
    rung: str
    shipped: bool
    rows: tuple[EngineRow, ...]

    @property
    def knob(self) -> str:
        """The name of the option that becomes finer from row to row."""
        return self.rows[0].knob

    @property
    def load(self) -> str:
        """The way in which the loads of a scene reach the engine, in words; empty where none acts."""
        return next((row.load for row in self.rows if row.load), "")

    @property
    def words(self) -> str:
        """The words that distinguish the setting from others of its engine and version."""
        return ", ".join(filter(None, [self.variant, self.rung if self.rung != "f64" else ""]))

    def on(self, scene: str) -> tuple[EngineRow, ...]:
        """Return the judged rows of a scene."""
        return tuple(row for row in self.rows if row.scene == scene and row.is_judged)

    def best(self, scene: str) -> EngineRow | None:
        """Return the coarsest row with the smallest error on a scene; None without judged rows."""
        return min(self.on(scene), key=lambda row: row.worst, default=None)

    def cause(self, scene: str) -> str:
        """Return the likely cause of the errors on a scene, which is looked for at one value alone."""
        return next((row.cause for row in self.on(scene) if row.cause), "")

    def order(self, scene: str, quantity: str) -> Order | None:
        """Return the observed order of a quantity over the steps; None for a setting without steps."""
        points = [
            OrderPoint(
                f"the row of step {row.value}",
                float(row.value),
                finite(row.errors.get(quantity)),
                row.floors.get(quantity),
            )
            for row in self.on(scene)
            if row.value and row.knob == "step"
        ]
        points.sort(key=lambda point: -point.step)
        unit = "rad" if quantity == "attitude" else ""
        return read_order(quantity, unit, points) if points else None

    def orders(self, scene: str, quantities: Iterable[str]) -> str:
        """Return the observed orders of some quantities as a cell; a dash where the steps show none."""
        orders = [self.order(scene, name) for name in quantities]
        words = [f"{o.order:.1f}" if o and o.order is not None else NOTHING for o in orders]
        return ", ".join(words) or NOTHING

    def at(self, value: str, scenes: Iterable[str]) -> Score | None:
        """Return the worst row of several scenes at one step; None if one of them was not judged."""
        rows = {row.scene: row for row in self.rows if row.value == value and row.is_judged}
        asked = [*scenes]
        if not asked or any(scene not in rows for scene in asked):
            return None
        return Score(self, value, max((rows[scene] for scene in asked), key=lambda row: row.worst))

    def scores(self, scenes: Sequence[str]) -> list[Score]:
        """Return the score of every step at which all of the scenes were judged."""
        values = dict.fromkeys(row.value for row in self.rows)
        return [score for value in values if (score := self.at(value, scenes)) is not None]


@dataclass(frozen=True)
class Score:
    """A setting at one step, on several scenes; ``row`` is that of the scene with the largest error."""

    setting: EngineSetting
    value: str
    row: EngineRow

    @property
    def error(self) -> float:
        """The largest error of the states on the scene where it is largest."""
        return self.row.worst


def settings(study: EnginesStudy) -> list[EngineSetting]:
    """Return all settings of a study, in the order of the list."""
    rows: dict[tuple[str, str, str, str, bool], list[EngineRow]] = {}
    for row in study.rows:
        key = (row.engine, row.version, row.variant, row.rung, row.shipped)
        rows.setdefault(key, []).append(row)
    return [EngineSetting(*key, tuple(each)) for key, each in rows.items()]


def newest(every: Iterable[EngineSetting], shipped: bool = False) -> list[EngineSetting]:
    """Return those of ``every`` setting that belong to the newest version of their engine.

    The newest version is the first in the rows of an engine. With ``shipped`` the settings are those as
    shipped, with sleep and damping left on, instead of the board's own.
    """
    every = [*every]
    versions: dict[str, str] = {}
    for setting in every:
        versions.setdefault(setting.engine, setting.version)
    return [
        setting
        for setting in every
        if setting.version == versions[setting.engine] and setting.shipped == shipped
    ]


def best_of(scores: Iterable[Score]) -> Score | None:
    """Return the score with the smallest finite error; None if there is none."""
    finite = [score for score in scores if score.error < inf]
    return min(finite, key=lambda score: score.error, default=None)


def best_of_each(every: Iterable[EngineSetting], scene: str) -> list[Score]:
    """Return the best score of each engine in its newest version on a scene, in the order of the list."""
    best = []
    for _, group in groupby(newest(every), key=lambda setting: setting.engine):
        scores = [score for setting in group for score in setting.scores([scene])]
        if scores:
            best.append(min(scores, key=lambda score: score.error))
    return best


def digits(error: float) -> float:
    """Return the number of right decimal digits; 0 for a lost motion and for NaN, infinity for no error."""
    return max(0.0, -log10(error)) if 0 < error < inf else (0.0 if error else inf)
