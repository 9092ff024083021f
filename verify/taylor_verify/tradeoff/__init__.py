"""Speed against accuracy on one scene: all settings measured, or one recommended."""

from __future__ import annotations

from collections.abc import Sequence
from os import PathLike

from taylor_verify import types


def tradeoff(
    scene: types.Scene | str | PathLike[str],
    asked: Sequence[types.Setting] | None = None,
    repeats: int | None = None,
    seed: int | None = None,
) -> types.TradeOff:
    """Measure the time and the error of every setting on a scene, and find the front.

    Parameters
    ----------
    scene
        A Scene, a path, or the name of a shipped scene.
    asked
        The settings to measure, by default all of the scene. ``chosen`` in tradeoff.setting makes
        settings from names of solvers.
    repeats
        The number of repeated solves, whose best time counts; by default that of
        ``taylor-verify tradeoff``.
    seed
        The seed of the random order in which settings are timed.

    Returns
    -------
    tradeoff.trade_off.TradeOff
        A point for each setting, with errors in the judge's units and with seconds, and the front of those
        that no other beats in both. A setting that cannot run is a point with the reason. The call takes
        from seconds to minutes.

    Raises
    ------
    records.faults.Refused
        For a scene that cannot be read.
    ValueError
        If ``repeats`` is below 1.
    """
    from taylor_verify.scenes.reading.reader import as_scene
    from taylor_verify.tradeoff.solves import REPEATS, SEED
    from taylor_verify.tradeoff.trade_off import trade_off

    repeats, seed = REPEATS if repeats is None else repeats, SEED if seed is None else seed
    if not repeats >= 1:
        raise ValueError(f"expected repeats of at least 1, got {repeats}")
    return trade_off(as_scene(scene), asked, repeats, seed)


def recommend(
    scene: types.Scene | str | PathLike[str],
    error: float,
    asked: Sequence[types.Setting] | None = None,
    seed: int | None = None,
) -> types.Recommendation:
    """Measure the settings, and return the fastest whose error stays below a limit on several starts.

    Parameters
    ----------
    scene
        A Scene, a path, or the name of a shipped scene.
    error
        The largest error of all tracked quantities that is allowed, in the judge's units: relative to the
        largest omega or impulse, radians, arc length.
    asked
        The settings to choose from, by default all of the scene.
    seed
        The seed of the other starts, and of the random order in which settings are timed.

    Returns
    -------
    tradeoff.recommendation.Recommendation
        The setting with its time and its errors. Rungs on which rounding alone leaves far more are not
        measured. It takes from seconds to minutes.

    Raises
    ------
    tradeoff.recommendation.OutOfReach
        If no setting reaches the error.
    records.faults.Refused
        For a scene that cannot be read.
    ValueError
        For an error that is no positive number.
    """
    from taylor_verify.tradeoff import recommendation
    from taylor_verify.tradeoff.solves import SEED

    return recommendation.recommend(scene, error, asked, SEED if seed is None else seed)
