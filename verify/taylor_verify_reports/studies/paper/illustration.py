"""Pictures of the paper, taken from the studies."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from taylor_verify.plotting.picture import Picture
from taylor_verify.words.markdown import code
from taylor_verify_reports.studies.engines import page as engines_page
from taylor_verify_reports.studies.hard import picture as hard_picture
from taylor_verify_reports.studies.hard.hard_scenes import HARD
from taylor_verify_reports.studies.paper.sources import Sources
from taylor_verify_reports.studies.paper.table import ENGINES, TRADEOFF, Caption
from taylor_verify_reports.studies.tradeoff import tradeoff_page


@dataclass(frozen=True)
class Illustration:
    """A picture with its caption; ``width`` is in per cent of the width of the text."""

    name: str
    picture: Picture
    caption: Caption
    width: int = 100

    @property
    def markdown(self) -> str:
        """The picture as a block of Markdown."""
        return f"![{self.caption.markdown}]({self.picture.stem}.pdf){{width={self.width}%}}"


def pictures(sources: Sources) -> list[Illustration]:
    """Return all pictures, in the order of the paper. Raises ValueError for a study without a picture."""
    return [make(sources) for make in (_engines, _reach, _trade)]


def _engines(sources: Sources) -> Illustration:
    words = (
        f"Largest error of omega and attitude on {code(sources.engine_scene)} against the time for a "
        "second of the motion: each engine at the best of its settings, a point for every step."
    )
    machine = sources.board.timings.machine.processor
    picture = _first(engines_page.pictures(sources.board), "engines", "engines-time")
    return Illustration("engines", picture, Caption(words, ENGINES, machine))


def _reach(sources: Sources) -> Illustration:
    words = (
        "Digits that are left beside an unstable motion after one period, over the distance $d$ from it, "
        "in each number format: achieved, and dashed the floor."
    )
    picture = _first(hard_picture.pictures(sources.hard), "hard")
    return Illustration(
        "reach", picture, Caption(words, (HARD.name,), sources.hard.machine.processor)
    )


def _trade(sources: Sources) -> Illustration:
    picture = _first(tradeoff_page.pictures(sources.trades), "tradeoff")
    scene = code(sources.trades.short[0].scene)
    words = (
        f"Error against time of a solve on {scene}, every solver at every setting. A *rung* is a number "
        "format."
    )
    machine = sources.trades.times.machine.processor
    return Illustration("tradeoff", picture, Caption(words, TRADEOFF, machine), width=90)


def _first(pictures: Iterable[Picture], study: str, stem: str = "") -> Picture:
    """Return the first picture of a study, with this stem if any is given; ValueError if there is none."""
    for picture in pictures:
        if stem in ("", picture.stem):
            return picture
    raise ValueError(f"expected a picture of what `publish {study}` has stored, got none")
