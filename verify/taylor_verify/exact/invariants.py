"""Conserved quantities of a motion, each with its value, its scale and its sensitivity."""

from __future__ import annotations

from dataclasses import replace

from taylor_verify.exact.conserved.integrals import under_loads
from taylor_verify.exact.invariant import Invariant
from taylor_verify.exact.registry import kind_of
from taylor_verify.scenes.motion import Motion
from taylor_verify.scenes.scene import Scene

__all__ = ["Invariant", "decisive", "invariants"]


def invariants(scene: Scene) -> tuple[Invariant, ...]:
    """The conserved quantities that the tracked quantities of a scene determine.

    Euler: ``T``, ``H2``, and ``H_space`` with attitude. Kirchhoff: ``T``, ``F2``, ``FG``, ``y3``
    for a body of Clebsch's form (``y1`` or ``y2`` where that is its axis, ``y_axis`` about any other
    direction) or the fourth integral of another family, by its word (without loads alone), ``x_space``
    with attitude, ``y_space`` with centre. Under loads they change, by the work and impulse of the
    loads; their values are defined all the same. Written loads may leave some of them unchanged, and
    others, such as T + V: what is found of these is marked and added.
    """
    free = kind_of(scene.body).invariants(scene)
    if scene.body.loads is not None:
        return under_loads(scene, free)
    return tuple(replace(each, is_conserved=scene.body.is_conservative) for each in free)


def decisive(scene: Scene, motion: Motion) -> list[int]:
    """Return the rows of a motion that determine the scales of all its invariants.

    Each scale is made of the largest T, |H|, |x|, |y| and |y| + |c| |x|. Rows that are not finite are
    passed over, if there are others.
    """
    sizes = kind_of(scene.body).sizes(scene, motion)
    # A NaN is equal to nothing, and comes last.
    largest = (max(range(len(rows)), key=lambda k: (rows[k] == rows[k], rows[k])) for rows in sizes)
    return sorted(set(largest))
