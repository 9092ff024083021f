"""The changed scene of a cause: keys of [body] that make a scene move as the answer does."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Final

import numpy as np

from taylor_verify.judge.causes.equations import Changes, Equations
from taylor_verify.judge.causes.flow import Floats

# Changes that no scene has: of the clock, of the attitude's equation, of the time of texts.
_NO_SCENE: Final = frozenset({"clock", "turns", "ahead", "late"})
_NOTHING: Final = 1e-10


def changed_scene(right: Equations, changes: Changes) -> str:
    """Return the keys of [body] as TOML; empty where no scene is such a motion."""
    if not changes or _NO_SCENE & set(changes):
        return ""
    other, lines, n = right.changed(changes), list[str](), right.size
    if "mass" in changes:
        key = "inertia" if n == 3 else "mass_matrix"
        lines.append(f"{key} = {_list([_list(map(number, row)) for row in other.mass])}")
    if "rotor" in changes and np.any(right.rotor):
        lines.append(f"rotor = {_list(map(number, other.rotor))}")
    if "damping" in changes:
        lines.append(f"damping = {number(float(other.damping))}")
    if "extra" in changes:
        if right.acting is not None:
            return ""
        texts = _loads(other)
        for key, first in zip(("moment",) if n == 3 else ("force", "couple"), (0, 3), strict=False):
            lines.append(f"{key} = {_list(texts[first : first + 3])}")
    return "; ".join(lines)


def number(value: float) -> str:
    """Return a number with twelve digits, and a point, so that it is a float of TOML."""
    text = f"{value + 0.0:.12g}"
    return text if set(text) & set(".en") else f"{text}.0"


def _list(parts: Iterable[str]) -> str:
    return f"[{', '.join(parts)}]"


def _loads(other: Equations) -> list[str]:
    """Return each component of the loads: a number, or the text of an expression in quotes."""
    basis, groups, extra, load = other.basis, other.basis.groups, other.extra.copy(), other.load
    extra[:, 0] += load + extra[:, groups["loads"]] @ load
    vectors = np.repeat(load.reshape(-1, 3), 3, axis=0)
    axes = np.tile(np.eye(3), (other.size // 3, 1))
    in_space = np.einsum("jk,ji->jki", vectors, axes).reshape(-1, 9)
    extra[:, groups["frame"]] += extra[:, groups["turned loads"]] @ in_space
    largest = float(np.max(np.abs(extra[:, : len(basis.texts)])))
    return [_text(row, basis.texts, largest) for row in extra]


def _text(row: Floats, words: Sequence[str], largest: float) -> str:
    large = [
        (value, word)
        for value, word in zip(row, words, strict=False)
        if abs(value) > _NOTHING * largest
    ]
    if not any(word for _, word in large):
        return number(float(large[0][0])) if large else "0.0"
    written = " + ".join(f"{number(value)}{'*' if word else ''}{word}" for value, word in large)
    return '"' + written.replace("+ -", "- ") + '"'
