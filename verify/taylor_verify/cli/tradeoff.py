"""The verb `tradeoff`: options in, an answer out."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any

from taylor_verify.cli.answer import PASS, UNDECIDED, Answer, WrongCall
from taylor_verify.cli.folders import alone_in, writable
from taylor_verify.cli.verbs import known_rungs, read_scenes, read_time

if TYPE_CHECKING:
    from pathlib import Path

    from taylor_verify.scenes.scene import Scene
    from taylor_verify.studies.tradeoff.setting import Setting
    from taylor_verify.studies.tradeoff.trade_off import TradeOff


def tradeoff(options: argparse.Namespace) -> Answer:
    """Speed against accuracy, and with a target the cheapest setting that reaches it."""
    from taylor_verify.cli.progress import working
    from taylor_verify.cli.tradeoff_text import tradeoff_text
    from taylor_verify.studies.tradeoff.setting import RUNGS
    from taylor_verify.studies.tradeoff.timing import cold_caches
    from taylor_verify.studies.tradeoff.trade_off import trade_off

    if not options.scenes:
        raise WrongCall("expected a scene, such as euler/generic, got none")
    if not options.repeats >= 1:
        raise WrongCall(f"expected --repeats of at least 1, got {options.repeats}")
    target = _target(options.target)
    place = _drawable(options.out) if options.out is not None else None
    rungs = known_rungs(options.rung or RUNGS)
    asked = _asked(options, rungs)
    if options.outside:
        _make_environments()
    found: list[dict[str, Any]] = []
    missed: list[str] = []
    with alone_in(place), cold_caches():
        for scene in read_scenes(list(dict.fromkeys(options.scenes))):
            with working(f"tradeoff {scene.name}"):
                trade = trade_off(scene, asked(scene), options.repeats, options.seed)
                document = trade.document()
                if options.cold:
                    _add_cold(document, trade)
                if target is not None:
                    document["recommendation"], because = _recommended(trade, target)
                    missed += because
                found.append(document)
        messages = list(missed)
        if place is not None:
            messages += [f"wrote {path}" for path in _draw(found, place)]
    status = UNDECIDED if missed else PASS
    return Answer(status, {"scenes": found}, partial(tradeoff_text, found), messages)


def _draw(found: Sequence[Mapping[str, Any]], place: Path) -> list[Path]:
    """The pictures of each scene and the document itself, whole or not at all."""
    import json

    from taylor_verify.records.replacement import replace_files
    from taylor_verify.studies.tradeoff.pictures import trade

    sound = [one for one in found if any(row["standing"] == "sound" for row in one["points"])]
    drawn = [path for one in sound for path in trade.draw(one, place)]
    text = json.dumps({"scenes": found}, indent=1, allow_nan=False) + "\n"
    return [*replace_files(place, {"tradeoff.json": text}), *drawn]


def _drawable(folder: str) -> Path:
    """The folder, known to be writable and matplotlib to be there before anything is measured."""
    from importlib.util import find_spec

    if find_spec("matplotlib") is None:
        raise WrongCall(
            "expected matplotlib (pip install 'taylor-verify[plots]'), got none @ --out"
        )
    return writable(folder)


def _asked(
    options: argparse.Namespace, rungs: Sequence[str]
) -> Callable[[Scene], Sequence[Setting]]:
    """Of a scene the settings to be measured: all there are, or those of --solver and --outside."""
    from taylor_verify.studies.tradeoff.setting import chosen, outside, settings

    try:
        named = chosen(options.solver, rungs) if options.solver else ()
        others = outside(rungs) if options.outside else ()
    except ValueError as error:
        raise WrongCall(f"{error} @ --solver") from error
    if named:
        return lambda scene: (*named, *others)
    return lambda scene: (*settings(scene, rungs), *others)


def _make_environments() -> None:
    """Before anything is timed: a download is no part of a solve. What cannot be made says so later."""
    from contextlib import suppress

    from taylor_verify.cli.streams import say
    from taylor_verify.solvers.engines.engine import engines, prepare
    from taylor_verify.solvers.engines.environment import NotMade

    for name in engines():
        with suppress(NotMade):
            prepare(name, say)


def _add_cold(document: dict[str, Any], trade: TradeOff) -> None:
    """Put into each point that is sound what its first solve takes in a process of its own."""
    from taylor_verify.studies.tradeoff.cold import cold
    from taylor_verify.studies.tradeoff.trade_off import sound_points

    asked = [p.timed.setting for p in sound_points(trade.points)]
    taken = {setting.label: parts for setting, parts in cold(trade.scene, asked).items()}
    for row, p in zip(document["points"], trade.points, strict=True):
        row["cold"] = taken.get(p.label)


def _target(text: str | None) -> float | None:
    from taylor_verify.studies.tradeoff.recommendation import check_target

    if text is None:
        return None
    try:
        target = float(read_time(text))
        check_target(target)
    except (WrongCall, OverflowError, ValueError) as error:
        raise WrongCall(f"expected a positive error, got {text!r} @ --target") from error
    return target


def _recommended(trade: TradeOff, target: float) -> tuple[dict[str, Any] | None, list[str]]:
    """The document of a recommendation, or none and the reason."""
    from taylor_verify.studies.tradeoff.recommendation import OutOfReach, recommended

    try:
        return recommended(trade, target).document(), []
    except OutOfReach as reason:
        return None, [str(reason)]
