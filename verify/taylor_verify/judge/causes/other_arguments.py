"""Loads that read other arguments than the scene's: one exchange of names in all of its texts."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from itertools import product
from typing import Final

from taylor_verify.scenes.loads.loads import Loads

NAME: Final = re.compile(r"\b[A-Za-z_]\w*\b")
_AXES: Final = (1, 2, 3)
_PAIRS: Final = tuple(product(_AXES, repeat=2))
_Names = Mapping[str, str]
_ALWAYS: Final[dict[str, _Names]] = {
    "the loads have R for R^T": {f"r{i}{k}": f"r{k}{i}" for i, k in _PAIRS},
    "the loads read the quaternion with the scalar last, which comes first": {
        f"q{k}": f"q{(k - 1) % 4}" for k in range(4)
    },
    "the loads read the quaternion with the scalar first, which comes last": {
        f"q{k}": f"q{(k + 1) % 4}" for k in range(4)
    },
    "the loads have no products of inertia": {f"I{i}{k}": "0" for i, k in _PAIRS if i != k},
    "the loads take omega in degrees": {f"w{i}": f"(180/pi*w{i})" for i in _AXES},
    "the loads take omega in radians for degrees": {f"w{i}": f"(pi/180*w{i})" for i in _AXES},
}


def other_arguments(
    loads: Loads, rewritten: Callable[[Loads, Callable[[str], str]], Loads]
) -> Iterator[tuple[str, Loads]]:
    """Yield loads whose texts read something else, with what they read in words."""
    for words, names in (*_ALWAYS.items(), *_of_scene(loads)):

        def changed(text: str, names: _Names = names) -> str:
            return NAME.sub(lambda match: names.get(match.group(), match.group()), text)

        other = rewritten(loads, changed)
        if other != loads:
            yield words, other


def _of_scene(loads: Loads) -> Iterator[tuple[str, _Names]]:
    """Yield the exchanges by the vectors that are given in space axes, and by the current."""
    for name, entries in loads.space:
        turned = {f"{name}{i}": _turned(entries, "r{0}{1}", i) for i in _AXES}
        yield f"{name} of [space] is turned the wrong way, by R for R^T", turned
        plain = {f"{name}{i}": f"({entry})" for i, entry in zip(_AXES, entries, strict=True)}
        yield f"{name} of [space] is not turned into body axes", plain
    if any(loads.current):
        ground = {f"u{i}": f"(u{i} + {_turned(loads.current, 'r{1}{0}', i)})" for i in _AXES}
        yield "the loads take the velocity over ground, not that through the water", ground


def _turned(entries: tuple[object, ...], entry: str, i: int) -> str:
    terms = (f"{entry.format(i, k)}*({x})" for k, x in zip(_AXES, entries, strict=True))
    return f"({' + '.join(terms)})"
