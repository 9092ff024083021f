"""The explanation of one run, as a document."""

from __future__ import annotations

from os import PathLike
from typing import Any

from taylor_verify import types
from taylor_verify.numbers.working_precision import in_turn


@in_turn
def explain(
    scene: types.Scene | str | PathLike[str], rung: types.Rung | str = "f64"
) -> dict[str, Any]:
    """Run a scene on one rung and explain the equations, the orbit and the terms of each bound.

    Parameters
    ----------
    scene
        A Scene, a path, or the name of a shipped scene.
    rung
        A Rung or ``f32 f64 f80 f128 mpN``.

    Returns
    -------
    dict
        The document of ``explain --json``: the equations built and their cost, the numbers of the orbit in
        the scene's units, its conditioning, and each gate with the terms of its bound. A number that
        the run did not reach is None.

    Raises
    ------
    records.faults.Refused
        For a scene that cannot be read.
    ValueError
        For a name that is no rung.
    """
    from taylor_verify.explain.explanation import explanation

    return explanation(scene, rung)
