"""The words that a true sentence about a fault has, and those that would be false, by family of faults."""

from __future__ import annotations

from typing import Final

FAMILIES: Final = {
    "times": (
        "one row off",
        "times rounded",
        "early clock",
        "row repeated",
        "linear interpolation",
    ),
    "frames": (
        "sign of an axis",
        "bias",
        "degrees",
        "space axes",
        "conjugate",
        "scalar last",
        "space frame turned",
        "frame that turns",
        "tensor in space axes",
        "velocity over ground",
    ),
    "starts": ("own start", "jump", "asleep", "load from some time on"),
    "methods": (
        "explicit Euler",
        "backward Euler",
        "Heun",
        "RK4",
        "held rate of the attitude",
        "attitude in place",
        "a fault and Euler steps",
    ),
    "sound": (
        "cubic drag",
        "growing load",
        "waving load",
        "noise",
        "RK45 at 1e-4",
        "RK23 at 1e-5",
        "LSODA at 1e-6",
        "Radau at 1e-6",
    ),
}
_ELSE: Final = "terms"
_TELLING: Final = {
    "times": ("row k", "interpolation"),
    "frames": ("degrees", "scalar last", "conjugate"),
    "starts": ("another start", "jump"),
    "methods": ("explicit Euler", "RK4"),
    _ELSE: ("gyroscopic term", "Munk", "drag", "wheel"),
}
# A motion of some bodies, or a fault of two parts, belongs to both families.
_ALSO: Final = {
    "early clock": "starts",
    "one row off": "starts",
    "a fault and Euler steps": _ELSE,
    "attitude backwards": "frames",
    "attitude on the wrong side": "frames",
    "tensor in space axes": _ELSE,
    "noise": "frames",
}


def family(fault: str) -> str:
    """Return the family of a fault: times, frames, starts, methods, terms, sound or files."""
    return next((name for name, faults in FAMILIES.items() if fault in faults), _ELSE)


def forbidden(fault: str, words: tuple[str, ...]) -> list[str]:
    """Return words of the other families, none of which stands in a true sentence about the fault."""
    own = {family(fault), _ALSO.get(fault)}
    others = [word for name, telling in _TELLING.items() if name not in own for word in telling]
    return [word for word in others if not any(word in mine or mine in word for mine in words)]
