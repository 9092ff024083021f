"""The verb `tradeoff`: options in, an answer out."""

from __future__ import annotations

import argparse
from functools import partial
from typing import TYPE_CHECKING, Any

from verify.cli.answer import PASS, UNDECIDED, Answer, WrongCall
from verify.cli.verbs import known_rungs, read_scenes, read_time

if TYPE_CHECKING:
    from verify.trade.trade_off import TradeOff


def tradeoff(options: argparse.Namespace) -> Answer:
    """Speed against accuracy, and with a target the cheapest setting that reaches it."""
    from verify.cli.progress import working
    from verify.cli.tradeoff_text import tradeoff_text
    from verify.trade.setting import RUNGS, settings
    from verify.trade.timing import cold_caches
    from verify.trade.trade_off import trade_off

    if not options.scenes:
        raise WrongCall("expected a scene, such as euler/generic, got none")
    if not options.repeats >= 1:
        raise WrongCall(f"expected --repeats of at least 1, got {options.repeats}")
    target = _target(options.target)
    rungs = known_rungs(options.rung or RUNGS)
    found: list[dict[str, Any]] = []
    missed: list[str] = []
    with cold_caches():
        for scene in read_scenes(list(dict.fromkeys(options.scenes))):
            with working(f"tradeoff {scene.name}"):
                trade = trade_off(scene, settings(scene, rungs), options.repeats, options.seed)
                document = trade.document()
                if target is not None:
                    document["recommendation"], because = _recommended(trade, target)
                    missed += because
                found.append(document)
    status = UNDECIDED if missed else PASS
    return Answer(status, {"scenes": found}, partial(tradeoff_text, found), missed)


def _target(text: str | None) -> float | None:
    from verify.trade.recommend import check_target

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
    from verify.trade.recommend import OutOfReach, recommended

    try:
        return recommended(trade, target).document(), []
    except OutOfReach as reason:
        return None, [str(reason)]
