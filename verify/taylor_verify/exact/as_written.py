"""A scene as its text says it, with irrational numbers that no rounding has met."""

from __future__ import annotations

from dataclasses import replace
from typing import TypeVar

from taylor_verify.scenes.named_numbers import Parted, entrywise, numbers
from taylor_verify.scenes.scene import Scene
from taylor_verify.scenes.stand_in import StandIn, stand_in, written

P = TypeVar("P", bound=Parted)


def as_written(scene: Scene) -> Scene:
    """Return the scene with irrational numbers in place of the rationals that stand for them.

    A scene without such numbers, as every rounded one is, is returned as it is.
    """
    if not any(map(_has_stand_in, (scene.body, scene.initial))):
        return scene
    return replace(scene, body=_written(scene.body), initial=_written(scene.initial))


def _written(parted: P) -> P:
    return parted.changed(lambda _, value: written(value))


def as_rationals(scene: Scene) -> Scene:
    """Return the scene with the rational that stands for it in place of every irrational number."""
    return replace(scene, body=_as_rationals(scene.body), initial=_as_rationals(scene.initial))


def _as_rationals(parted: P) -> P:
    return parted.changed(lambda _, value: entrywise(stand_in, value))


def _has_stand_in(parted: Parted) -> bool:
    return any(isinstance(n, StandIn) for value in parted.parts().values() for n in numbers(value))
