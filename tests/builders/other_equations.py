"""Engines with other equations than Euler's or Kirchhoff's: no smaller step brings them nearer."""

from __future__ import annotations

# Without omega x I omega, whatever their settings or with this one.
WITHOUT_GYROSCOPIC_TERM = (
    *("ammo?flags=0", "ammo?flags=4", "ammo?flags=8"),
    *("brax-positional", "brax-spring", "cannon", "havok"),
    *("jolt?gyroscopic=off", "rapier?version=0.19.3"),
    *("bullet?gyroscopic=off", "ode?gyroscopic=off", "pybox3d"),
)
# Without what of the added mass goes with accelerations.
WITHOUT_ADDED_MASS = ("mujoco_fluid-ellipsoid",)


def has_other_equations(name: str) -> bool:
    """True for the name of an engine, with settings or without, that leaves out a term."""
    engine, _, settings = name.removeprefix("outside:").partition("?")
    asked = {engine, *(f"{engine}?{setting}" for setting in settings.split("&"))}
    return not asked.isdisjoint((*WITHOUT_GYROSCOPIC_TERM, *WITHOUT_ADDED_MASS))
