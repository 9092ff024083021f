"""Inputs of several verbs: scenes, rungs, numbers and tolerances, read before any work begins."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from fractions import Fraction
from importlib.util import find_spec
from typing import Any, Final

from taylor_verify.batch.chosen_scenes import read_all
from taylor_verify.cli.answer import CallParts, WrongCall, wrong_calls
from taylor_verify.cli.streams import say
from taylor_verify.judge.tolerances import Tolerances, tolerances
from taylor_verify.numbers.precision import rung
from taylor_verify.scenes.library import named
from taylor_verify.scenes.reading.table import exact_number, is_numeral
from taylor_verify.scenes.scene import Scene

# The most scenes that a message names.
_SHOWN: Final = 3


def known_rungs(rungs: Iterable[str]) -> list[str]:
    """Return each rung once. Raises WrongCall with every name that is none."""
    parts = CallParts()
    known = [parts.read(_known_rung, name) for name in dict.fromkeys(rungs)]
    parts.end()
    return known


def _known_rung(name: str) -> str:
    with wrong_calls(" @ --rung"):
        return rung(name).name


def read_scene(name: str, warn: bool = True) -> Scene:
    """Read the scene of a verb that takes one. Raises WrongCall for a folder or a pattern of several."""
    names = named(name)
    if len(names) > 1:
        others = "" if len(names) <= _SHOWN else f" and {len(names) - _SHOWN} more"
        raise WrongCall(f"expected one scene, got {', '.join(names[:_SHOWN])}{others} @ {name}")
    (scene,) = read_scenes(names, warn)
    return scene


def read_scenes(words: Sequence[str], warn: bool = True) -> list[Scene]:
    """Read every scene of some names, folders and patterns before any work begins.

    Raises Refused with the faults of all of them.
    """
    scenes = read_all(list(dict.fromkeys(name for word in words for name in named(word))))
    for scene in scenes if warn else ():
        for warning in scene.warnings:
            say(f"warning: {warning} @ {scene.name}")
    return [*scenes]


def read_number(text: str, option: str) -> Fraction:
    """Return the decimal or a/b of an option. Raises WrongCall for any other text."""
    if not is_numeral(text.strip()):
        raise WrongCall(f"expected a number such as 10, 1e9 or 1/3, got {text!r} @ {option}")
    try:
        return exact_number(text.strip())
    except ValueError as error:
        raise WrongCall(f"expected {error}, got {text!r} @ {option}") from error


def known_count(number: int | None, option: str) -> None:
    """Raise WrongCall for a number of things that is below 1."""
    if number is not None and not number >= 1:
        raise WrongCall(f"expected a number of at least 1, got {number} @ {option}")


def require_matplotlib(option: str) -> None:
    """Raise WrongCall without the package that draws."""
    if find_spec("matplotlib") is None:
        raise WrongCall(
            f"expected matplotlib (pip install 'taylor-verify[plots]'), got none @ {option}"
        )


def read_tolerances(text: str | None, scenes: Iterable[Scene] | None) -> Tolerances:
    """Return the tolerances that --tolerance asks for, checked against some scenes; None: not known.

    Raises WrongCall for what is none.
    """
    with wrong_calls():
        return tolerances(parse_tolerance(text), scenes, "--tolerance")


def parse_tolerance(text: str | None) -> Any:
    """Return the number for all quantities, or the numbers by name, in the text of --tolerance.

    A text that is no number is returned as it is, for `tolerances` to refuse. Raises ValueError for names
    that are not each given once.
    """
    if text is None:
        return None
    return _by_name(text) if "=" in text else _tolerance(text)


def _by_name(text: str) -> dict[str, Any]:
    by_name: dict[str, Any] = {}
    for part in text.split(","):
        name, equals, value = (word.strip() for word in part.partition("="))
        if not equals or name in by_name:
            got = f"{name} twice" if equals else repr(part)
            raise ValueError(f"expected NAME=E,NAME=E with each name once, got {got} @ --tolerance")
        by_name[name] = _tolerance(value)
    return by_name


def _tolerance(text: str) -> float | str:
    """Return the number in a text as a double; any other text as it is, for `tolerances` to refuse."""
    try:
        return float(exact_number(text)) or text
    except (OverflowError, ValueError):
        return text
