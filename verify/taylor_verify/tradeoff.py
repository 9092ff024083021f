"""Speed against accuracy on one scene: all settings measured, or one recommended."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence
    from os import PathLike

    from taylor_verify.scenes.scene import Scene
    from taylor_verify.trade.recommend import Recommendation
    from taylor_verify.trade.setting import Setting
    from taylor_verify.trade.trade_off import TradeOff


def tradeoff(
    scene: Scene | str | PathLike[str],
    asked: Sequence[Setting] | None = None,
    repeats: int | None = None,
    seed: int | None = None,
) -> TradeOff:
    """Measure the time and the error of every setting on a scene, and find the front.

    ``asked`` are the settings to measure (trade.setting.chosen makes them of names), all that there are
    unless given. The time is the best of ``repeats`` solves, by default those of ``taylor-verify
    tradeoff``; ``seed`` is that of the order of timing. It takes from seconds to minutes. A setting that
    cannot run is a point that says why. Raises scenes.faults.Refused for a scene that cannot be read, and
    ValueError for fewer than one of ``repeats``.
    """
    from taylor_verify.scenes.reader import as_scene
    from taylor_verify.trade.timing import REPEATS, SEED, cold_caches
    from taylor_verify.trade.trade_off import trade_off

    repeats, seed = REPEATS if repeats is None else repeats, SEED if seed is None else seed
    if not repeats >= 1:
        raise ValueError(f"expected repeats of at least 1, got {repeats}")
    scene = as_scene(scene)
    with cold_caches():
        return trade_off(scene, asked, repeats, seed)


def recommend(
    scene: Scene | str | PathLike[str],
    error: float,
    asked: Sequence[Setting] | None = None,
    seed: int | None = None,
) -> Recommendation:
    """Measure the settings and return the fastest whose error stays below ``error``, here and nearby.

    The error is the largest of all tracked quantities, in the judge's units (relative to the largest
    omega or impulse, radians, arc length). ``asked`` are the settings to choose from, all that there are
    unless given; ``seed`` is that of the starts nearby and of the order of timing. It takes from seconds
    to minutes, because it measures. Rungs on which rounding alone leaves far more are not measured.

    Raises trade.recommend.OutOfReach where no setting reaches the error, ValueError for an error that is
    no positive number, and scenes.faults.Refused for a scene that cannot be read.
    """
    from taylor_verify.trade import recommend as of
    from taylor_verify.trade.timing import SEED

    return of.recommend(scene, error, asked, SEED if seed is None else seed)
