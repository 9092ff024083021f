"""The verb `tradeoff`: speed against accuracy of every setting of every solver."""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import Any

from taylor_verify.cli.answer import PASS, UNDECIDED, Answer, WrongCall, wrong_calls
from taylor_verify.cli.folders import alone_in, writable
from taylor_verify.cli.inputs import known_rungs, read_number, read_scenes, require_matplotlib
from taylor_verify.cli.progress import working
from taylor_verify.cli.streams import say
from taylor_verify.cli.tradeoff_text import tradeoff_text
from taylor_verify.records.replacement import replace_files
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.engines.engine import engines, prepare
from taylor_verify.solvers.engines.environment import NotMade
from taylor_verify.studies.tradeoff.cold import cold
from taylor_verify.studies.tradeoff.front import sound_points
from taylor_verify.studies.tradeoff.recommendation import OutOfReach, check_target, recommended
from taylor_verify.studies.tradeoff.setting import RUNGS, Setting, chosen, outside, settings
from taylor_verify.studies.tradeoff.timing import cold_caches
from taylor_verify.studies.tradeoff.trade_off import TradeOff, trade_off


def answer(options: argparse.Namespace) -> Answer:
    """Measure each scene, and with a target find the cheapest setting that reaches it."""
    if not options.scenes:
        raise WrongCall("expected a scene, such as euler/generic, got none")
    if not options.repeats >= 1:
        raise WrongCall(f"expected --repeats of at least 1, got {options.repeats}")
    target = _target(options.target)
    place = None
    if options.out is not None:
        require_matplotlib("--out")
        place = writable(options.out)
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
                    document["recommendation"] = None
                    try:
                        document["recommendation"] = recommended(trade, target).document()
                    except OutOfReach as reason:
                        missed.append(str(reason))
                found.append(document)
        drawn = [] if place is None else [f"wrote {path}" for path in _draw(found, place)]
    status = UNDECIDED if missed else PASS
    text = partial(tradeoff_text, found)
    return Answer(status, {"scenes": found}, text, [*missed, *drawn])


def _draw(found: Sequence[Mapping[str, Any]], place: Path) -> list[Path]:
    """Write the pictures of each scene and the document itself, whole or not at all."""
    from taylor_verify.studies.tradeoff.pictures import trade

    sound = [one for one in found if any(row["standing"] == "sound" for row in one["points"])]
    drawn = [path for one in sound for path in trade.draw(one, place)]
    text = json.dumps({"scenes": found}, indent=1, allow_nan=False) + "\n"
    return [*replace_files(place, {"tradeoff.json": text}), *drawn]


def _asked(
    options: argparse.Namespace, rungs: Sequence[str]
) -> Callable[[Scene], Sequence[Setting]]:
    """Return the settings to measure by scene: all there are, or those of --solver and --outside."""
    with wrong_calls(" @ --solver"):
        named = chosen(options.solver, rungs) if options.solver else ()
        others = outside(rungs) if options.outside else ()
    return lambda scene: (*(named or settings(scene, rungs)), *others)


def _make_environments() -> None:
    """Make the environments of engines before anything is timed: a download is no part of a solve.

    The solve in one that cannot be made says so.
    """
    for name in engines():
        with suppress(NotMade):
            prepare(name, say)


def _add_cold(document: dict[str, Any], trade: TradeOff) -> None:
    """Put into each sound point the cost of its first solve in a process of its own."""
    asked = [p.timed.setting for p in sound_points(trade.points)]
    taken = {setting.label: one.row() for setting, one in cold(trade.scene, asked).items()}
    for row, p in zip(document["points"], trade.points, strict=True):
        row["cold"] = taken.get(p.label)


def _target(text: str | None) -> float | None:
    if text is None:
        return None
    try:
        target = float(read_number(text, "--target"))
        check_target(target)
    except (WrongCall, OverflowError, ValueError) as error:
        raise WrongCall(f"expected a positive error, got {text!r} @ --target") from error
    return target
