"""The changed scene of a cause: keys of [body] that make a scene move as the answer does."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from itertools import combinations_with_replacement
from typing import Final

import numpy as np

from taylor_verify.judge.causes.equations import Changes, Equations
from taylor_verify.judge.causes.flow import Floats

# Changes that no scene has: of the clock, of the attitude's equation, of texts that are not constant.
_NO_SCENE: Final = frozenset({"clock", "turns", "ahead", "late"})
_NOTHING: Final = 1e-10


def changed_scene(right: Equations, changes: Changes) -> str:
    """Return the keys of [body] as TOML; empty where no scene is such a motion."""
    if not changes or _NO_SCENE & set(changes) or right.acting is not None:
        return ""
    other, lines, n = right.changed(changes), list[str](), right.size
    if "mass" in changes:
        key = "inertia" if n == 3 else "mass_matrix"
        lines.append(f"{key} = {_list([_list(map(number, row)) for row in other.mass])}")
    if "rotor" in changes and np.any(right.rotor):
        lines.append(f"rotor = {_list(map(number, other.rotor))}")
    if "damping" in changes:
        lines.append(f"damping = {number(float(other.damping))}")
    texts = _loads(other)
    if texts != _loads(right):
        for key, part in zip(
            ("moment",) if n == 3 else ("force", "couple"), (texts[:3], texts[3:]), strict=False
        ):
            lines.append(f"{key} = {_list(part)}")
    return "; ".join(lines)


def number(value: float) -> str:
    """Return a number with twelve digits, and a point, so that it is a float of TOML."""
    text = f"{value + 0.0:.12g}"
    return text if set(text) & set(".en") else f"{text}.0"


def _list(parts: Iterable[str]) -> str:
    return f"[{', '.join(parts)}]"


def _loads(other: Equations) -> list[str]:
    """Return each component of the loads: a number, or the text of an expression in quotes."""
    constant = other.load if other.weights is None else other.load * other.weights
    in_space = float(other.in_space)
    texts, quadratic, names = list[list[tuple[float, str]]](), _quadratic(other), _names(other.size)
    for i in range(other.size):
        terms = [(float(constant[i]) * (1 - in_space), "")]
        terms += _of_space(i, in_space * constant if other.space is None else other.space)
        terms += _of_arm(i, other)
        if other.linear is not None:
            terms.append((-other.linear[i], names[i]))
        if other.quadratic is not None:
            terms.append((-other.quadratic[i], f"abs({names[i]})*{names[i]}"))
        terms += quadratic[i]
        texts.append(terms)
    largest = max(abs(value) for terms in texts for value, _ in terms)
    return [_text(terms, largest) for terms in texts]


def _names(n: int) -> list[str]:
    return [f"{letter}{i}" for letter in ("w" if n == 3 else "uw") for i in (1, 2, 3)]


def _of_space(i: int, space: Floats) -> Iterator[tuple[float, str]]:
    """Yield the terms of component i of R^T s."""
    first = 3 * (i // 3)
    for k in range(3):
        yield float(space[first + k]), f"r{k + 1}{i % 3 + 1}"


def _of_arm(i: int, other: Equations) -> list[tuple[float, str]]:
    """Return the terms of component i of the couple arm x R^T e3."""
    if other.arm is None or i < other.size - 3:
        return []
    j, k = (i + 1) % 3, (i + 2) % 3
    return [(float(other.arm[j]), f"r3{k + 1}"), (-float(other.arm[k]), f"r3{j + 1}")]


def _quadratic(other: Equations) -> list[list[tuple[float, str]]]:
    """Return the terms by which the Coriolis terms differ from those of the mass matrix."""
    plain = Equations.of_mass(other.mass, other.rotor)
    own = replace(plain, gyro=other.gyro, turn=other.turn, munk=other.munk)
    n, zero = other.size, np.zeros(1)

    def extra(nu: Floats) -> Floats:
        z = nu[None, :, None]
        return (own.mass @ (own.rates(zero, z) - plain.rates(zero, z)))[0, :, 0]

    unit, names, terms = np.eye(n), _names(n), [[] for _ in range(n)]  # type: ignore[var-annotated]
    for j, k in combinations_with_replacement(range(n), 2):
        of_pair = (
            extra(unit[j]) if j == k else extra(unit[j] + unit[k]) - extra(unit[j]) - extra(unit[k])
        )
        for i in range(n):
            terms[i].append((float(of_pair[i]), f"{names[j]}*{names[k]}"))
    return terms


def _text(terms: Sequence[tuple[float, str]], largest: float) -> str:
    large = [(value, word) for value, word in terms if abs(value) > _NOTHING * largest]
    if not any(word for _, word in large):
        return number(large[0][0]) if large else "0.0"
    written = " + ".join(f"{number(value)}{'*' if word else ''}{word}" for value, word in large)
    return '"' + written.replace("+ -", "- ") + '"'
