"""The changed scene of a cause: keys of [body] that make a scene move as the answer does."""

from __future__ import annotations

from collections.abc import Container, Iterable, Sequence
from fractions import Fraction
from typing import Final

import numpy as np

from taylor_verify.judge.causes.changed_equations import Changes, Equations
from taylor_verify.judge.causes.changed_texts import names_inertia, with_inertia
from taylor_verify.judge.causes.energies import keys_of
from taylor_verify.judge.causes.float_answer import Answer
from taylor_verify.judge.causes.many_flows import Floats
from taylor_verify.judge.causes.texts import places
from taylor_verify.numbers.tensors import ZERO_VECTOR
from taylor_verify.scenes.loads.loads import Loads
from taylor_verify.scenes.loads.vocabulary import VECTORS, Entry

# Changes that no scene has: of the clock, of the attitude's equation, of the time of texts.
_NO_SCENE: Final = frozenset({"clock", "turns", "ahead", "late", "loss"})
_NOTHING: Final = 1e-10
# A number that was fitted is a fraction of so small a denominator if it is as near to one.
_LARGEST_DENOMINATOR: Final = 1000
_KNOWN: Final = Fraction(1, 10**11)
# Names in the texts of loads whose values are those of another body if the mass changes.
_OF_MASS: Final = frozenset(f"{letter}{i}" for letter in "xy" for i in (1, 2, 3))


def changed_scene(right: Equations, changes: Changes) -> str:
    """Return the keys of [body] as TOML; empty where no scene is such a motion."""
    if not changes or _NO_SCENE & set(changes):
        return ""
    other, lines, n = right.changed(changes), dict[str, str](), right.size
    if "acting" in changes:
        lines |= _changed_entries(right.loads, other.loads)
    if not _is_written(other, changes):
        return ""
    if "mass" in changes:
        if right.loads is not None and names_inertia(right.loads):
            lines |= _changed_entries(right.loads, with_inertia(right.loads, right.mass))
        if right.energy is not None:
            lines |= keys_of(_symmetric(other.inverse), number)
        else:
            rows = [_list(map(number, row)) for row in _symmetric(other.mass)]
            lines["inertia" if n == 3 else "mass_matrix"] = _list(rows)
    if "rotor" in changes and np.any([right.rotor, other.rotor]):
        lines["rotor"] = _list(map(number, other.rotor))
    if "damping" in changes:
        lines["damping"] = number(float(other.damping))
    if "extra" in changes:
        # These have the changed texts too.
        texts = [text if _is_number(text) else f'"{text}"' for text in load_texts(other)]
        for key, first in zip(("moment",) if n == 3 else ("force", "couple"), (0, 3), strict=False):
            lines[key] = _list(texts[first : first + 3])
    return "; ".join(f"{key} = {words}" for key, words in lines.items())


def changed_start(answer: Answer, mass: Floats) -> str:
    """Return the keys of [initial] where another body starts otherwise than the scene writes; else none."""
    if answer.keeps_momenta == answer.writes_momenta:
        return ""
    names: tuple[str, ...] = ("omega",)
    if answer.n == 3:
        start = answer.first(mass)
    elif answer.keeps_momenta:
        names, start = ("linear_impulse", "angular_impulse"), answer.momenta(mass)
    else:
        names, start = ("linear_velocity", "angular_velocity"), answer.start.v[0]
    parts = zip(names, start.reshape(-1, 3), strict=True)
    return "; ".join(f"{name} = {_list(map(number, part))}" for name, part in parts)


def _changed_entries(loads: Loads | None, other: Loads | None) -> dict[str, str]:
    """Return the keys whose entries are others in other loads, with these entries."""
    own = set() if loads is None else {(place.key, place.entry) for place in places(loads)}
    before, after = _entries_by_key(loads, own), _entries_by_key(other, own)
    changed = {key: words for key, words in after.items() if before.get(key) != words}
    written_out = [key for key in before if key.endswith(".force") and key not in after]
    return changed | dict.fromkeys(written_out, "[0.0, 0.0, 0.0]")


def _entries_by_key(loads: Loads | None, own: Container[tuple[str, Entry]]) -> dict[str, str]:
    """Return the keys of the numbers and texts of a scene's loads, each with all of its entries.

    A number that is not one of the scene's ``own`` was fitted.
    """
    entries: dict[str, list[str]] = {}
    for place in () if loads is None else places(loads):
        if isinstance(place.entry, str):
            text = f'"{place.entry}"'
        else:
            text = _exact(place.entry, is_fitted=(place.key, place.entry) not in own)
        key, bracket, _ = place.key.partition("[")
        entries.setdefault(key + bracket, []).append(text)
    for state in () if loads is None else loads.held_states:
        entries[f"states.{state.name}.every"] = [_exact(state.every)]
        entries[f"states.{state.name}.offset"] = [_exact(state.offset)]
    return {
        key.removesuffix("["): _list(texts) if key.endswith("[") else texts[0]
        for key, texts in entries.items()
    }


def _symmetric(matrix: Floats) -> Floats:
    """Return a symmetric matrix without what rounding left in it."""
    size = float(np.max(np.abs(matrix)))
    return np.where(np.abs(matrix) > 1e-13 * size, (matrix + matrix.T) / 2, 0.0)


def number(value: float) -> str:
    """Return a number with twelve digits, and a point, so that it is a float of TOML."""
    text = f"{value + 0.0:.12g}"
    return text if set(text) & set(".en") else f"{text}.0"


def _exact(value: Fraction, is_fitted: bool = False) -> str:
    """Return a number as a decimal or a fraction; of one that ``is_fitted`` twelve digits are known."""
    text = number(float(value))
    if Fraction(text) == value:
        return text
    if is_fitted:
        near = value.limit_denominator(_LARGEST_DENOMINATOR)
        return f'"{near}"' if abs(near - value) <= _KNOWN * abs(value) else text
    # The scene's numbers are rounded to doubles here, its times are not.
    return repr(float(value)) if Fraction(float(value)) == value else f'"{value}"'


def _list(parts: Iterable[str]) -> str:
    return f"[{', '.join(parts)}]"


def _is_written(other: Equations, changes: Changes) -> bool:
    """Return True if texts can say what has changed: they name no other mass, and no weight is changed."""
    loads = other.loads
    if loads is None:
        return True
    changes_loads = np.any(other.extra[:, other.basis.groups["loads"].start :])
    names_mass = not loads.inputs.isdisjoint(_OF_MASS)
    return not (("mass" in changes and names_mass) or (loads.hung and changes_loads))


def load_texts(other: Equations) -> list[str]:
    """Return each component of the loads as a number or the text of an expression."""
    factors, words = _of_numbers(other) if other.loads is None else _of_texts(other, other.loads)
    largest = float(np.max(np.abs(factors)))
    return [_text(row, words, largest) for row in factors]


def _of_numbers(other: Equations) -> tuple[Floats, tuple[str, ...]]:
    """Return the factors of each expression where the loads of the scene are numbers."""
    basis, groups, extra, load = other.basis, other.basis.groups, other.extra.copy(), other.load
    extra[:, 0] += load + extra[:, groups["loads"]] @ load
    vectors = np.repeat(load.reshape(-1, 3), 3, axis=0)
    axes = np.tile(np.eye(3), (other.size // 3, 1))
    in_space = np.einsum("jk,ji->jki", vectors, axes).reshape(-1, 9)
    extra[:, groups["frame"]] += extra[:, groups["turned loads"]] @ in_space
    return extra[:, : len(basis.texts)], basis.texts


def _of_texts(other: Equations, loads: Loads) -> tuple[Floats, tuple[str, ...]]:
    """Return the factors of each expression where the loads of the scene are texts."""
    n, groups, extra, vectors = (
        other.size,
        other.basis.groups,
        other.extra.copy(),
        dict(loads.vectors),
    )
    entries = (each for name in VECTORS[loads.model] for each in vectors.get(name, ZERO_VECTOR))
    texts = [str(entry) for entry in entries]
    extra[:, groups["loads"]] += np.eye(n)
    turned = []
    for j in range(n):
        first = j - j % 3
        terms = [(f"r{k + 1}{j % 3 + 1}", texts[first + k]) for k in range(3)]
        turned.append(" + ".join(f"{r}*({text})" for r, text in terms if text != "0"))
    words = (*other.basis.texts, *(f"({text})" for text in texts), *(f"({t})" for t in turned))
    extra[:, [k for k, word in enumerate(words) if word in ("(0)", "()")]] = 0.0
    return extra, words


def _text(row: Floats, words: Sequence[str], largest: float) -> str:
    large = [
        (float(value), word)
        for value, word in zip(row, words, strict=True)
        if abs(value) > _NOTHING * largest
    ]
    if not any(word for _, word in large):
        return number(large[0][0]) if large else "0.0"
    written = " + ".join(map(_term, large))
    return written.replace("+ -", "- ")


def _is_number(text: str) -> bool:
    return not set(text) - set("0123456789.+-e")


def _term(of: tuple[float, str]) -> str:
    value, word = of
    return word if word and value == 1 else f"{number(value)}{'*' if word else ''}{word}"
