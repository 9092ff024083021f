"""The option --tolerance: one number for all quantities, or a number for each of some."""

from __future__ import annotations

import argparse
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, Final

from taylor_verify.cli.answer import WrongCall

if TYPE_CHECKING:
    from taylor_verify.judge.tolerances import Tolerances
    from taylor_verify.scenes.scene import Scene

_PLACE: Final = "--tolerance"


def add_option(verb: argparse.ArgumentParser) -> None:
    """Add the option to a verb whose answer is verdicts."""
    verb.add_argument(
        _PLACE,
        metavar="E",
        help="allow this error in place of what rounding leaves: relative, and radians for the attitude; "
        "1e-8 for all quantities, or omega=1e-8,T=1e-10 for some",
    )


def read_tolerances(text: str | None, scenes: Iterable[Scene]) -> Tolerances:
    """Return the tolerances that the option asks for. Raises WrongCall for what is none."""
    from taylor_verify.judge.tolerances import NO_TOLERANCES, tolerances

    if text is None:
        return NO_TOLERANCES
    try:
        asked: Any = _by_name(text) if "=" in text else _number(text)
        return tolerances(asked, scenes, _PLACE)
    except ValueError as error:
        raise WrongCall(str(error)) from error


def _by_name(text: str) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for part in text.split(","):
        name, equals, value = (word.strip() for word in part.partition("="))
        if not equals or name in found:
            got = f"{name} twice" if equals else repr(part)
            raise ValueError(f"expected NAME=E,NAME=E with each name once, got {got} @ {_PLACE}")
        found[name] = _number(value)
    return found


def _number(text: str) -> float | str:
    """Return the number in a text as a double; the text itself, to be refused as it is, for any other."""
    from taylor_verify.scenes.reading.table import exact_number

    try:
        return float(exact_number(text)) or text
    except (OverflowError, ValueError):
        return text
