"""Loads whose texts are others: a part of them left out, turned round or in other axes, or other names.

A part is some terms of the sums of a vector, weight, or buoyancy.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from itertools import combinations, product
from typing import Final

from taylor_verify.judge.causes.many_flows import Floats
from taylor_verify.judge.causes.texts import (
    Place,
    decimal,
    each_named,
    places,
    rational,
    texts_of_vectors,
)
from taylor_verify.judge.causes.vectors_of_texts import (
    BY_R,
    BY_TRANSPOSED,
    plus,
    sum_of,
    turned,
)
from taylor_verify.numbers.tensors import ZERO_VECTOR
from taylor_verify.scenes.loads.loads import Loads
from taylor_verify.scenes.loads.vocabulary import (
    CENTRE,
    INERTIA,
    QUATERNION,
    ROTATION,
    VECTORS,
    Entry,
)

NAME: Final = re.compile(r"\b[A-Za-z_]\w*\b")
_COMPONENT: Final = re.compile(r"\babs\(([uw])[123]\)")
_LENGTH: Final = re.compile(r"norm\(\s*([uw])1\s*,\s*(?:\1)2\s*,\s*(?:\1)3\s*\)")
# Of more numbers than these, two that are exchanged are too many pairs.
_MOST_EXCHANGED: Final = 6
_AXES: Final = (1, 2, 3)
_PAIRS: Final = tuple(product(_AXES, repeat=2))
_TENSOR: Final = frozenset(INERTIA)
_Names = Mapping[str, str]


def _in_space(letter: str) -> _Names:
    """Return the texts of the components of a vector in space axes."""
    return {f"{letter}{i}": f"({' + '.join(f'r{i}{k}*{letter}{k}' for k in _AXES)})" for i in _AXES}


_ALWAYS: Final[dict[str, _Names]] = {
    "the loads have R for R^T": {f"r{i}{k}": f"r{k}{i}" for i, k in _PAIRS},
    "the loads read the quaternion with the scalar last, which comes first": {
        f"q{k}": f"q{(k - 1) % 4}" for k in range(4)
    },
    "the loads read the quaternion with the scalar first, which comes last": {
        f"q{k}": f"q{(k + 1) % 4}" for k in range(4)
    },
    "the loads have no products of inertia": {f"I{i}{k}": "0" for i, k in _PAIRS if i != k},
    "the loads read the velocity in space axes": _in_space("u"),
    "the loads read omega in space axes": _in_space("w"),
    "the loads take omega in degrees": {f"w{i}": f"(180/pi*w{i})" for i in _AXES},
    "the loads take omega in radians for degrees": {f"w{i}": f"(pi/180*w{i})" for i in _AXES},
}
_SPEEDS: Final[dict[str, Callable[[str], str]]] = {
    "the loads have the whole speed, |U| or |W|, where the scene has abs(u1) or abs(w1)": (
        lambda text: _COMPONENT.sub(_speed, text)
    ),
    "the loads have linear drag, 1 for abs(u1), abs(w1) or the whole speed": (
        lambda text: _COMPONENT.sub("1", _LENGTH.sub("1", text))
    ),
}
_Named = tuple[tuple[str, Callable[[str], str]], ...]
_SIGNS: Final[_Named] = (
    ("left out", "0*({})".format),
    ("with the other sign", "-({})".format),
)
VELOCITIES: Final = frozenset(f"{letter}{i}" for letter in "uw" for i in _AXES)
_WRONG_WAY: Final = "turned the wrong way, by R"
# What is done to three parts of texts, one for each axis, beside which three others stay.
_Change = Callable[[Sequence[str], int], str]
_CHANGES: Final[dict[str, _Change]] = {
    "left out": lambda parts, i: "0",
    "with the other sign": lambda parts, i: sum_of([("-1", parts[i])]),
    "in space axes": lambda parts, i: turned(parts, BY_TRANSPOSED)[i],
    _WRONG_WAY: lambda parts, i: turned(parts, BY_R)[i],
}


def changed_texts(loads: Loads) -> Iterator[tuple[str, Loads]]:
    """Yield loads with other texts, with what is other in words."""
    for words, names in (*_ALWAYS.items(), *_of_scene(loads)):
        other = rewritten(loads, partial(renamed, names=names))
        if other != loads:
            yield words, other
    yield from by_component(loads, "the loads have no abs", partial(renamed, names={"abs": ""}))
    yield from _other_speeds(loads)
    yield from _exchanged(loads)
    yield from _named_otherwise(loads)
    some = [name for name, entries in loads.vectors if has_text(entries)]
    for name in some:
        yield (
            f"{name} {_WRONG_WAY}",
            _with_part(loads, [name], lambda term: True, _CHANGES[_WRONG_WAY]),
        )
    yield from _drag_in_space(loads, some)
    for (noun, vectors, is_part), (words, change) in product(_parts(loads), _CHANGES.items()):
        yield f"{noun} {words}", _with_part(loads, vectors, is_part, change)


def renamed(text: str, names: Mapping[str, str]) -> str:
    """Return a text with other texts in the place of some names."""
    return NAME.sub(lambda match: names.get(match.group(), match.group()), text)


def has_text(entries: Iterable[Entry]) -> bool:
    """Return True if a vector of loads is not nothing."""
    return any(terms(str(entry)) != ["0"] for entry in entries)


def _other_speeds(loads: Loads) -> Iterator[tuple[str, Loads]]:
    """Yield drag by other speeds, in all texts and in those of one vector alone."""
    for words, change in _SPEEDS.items():
        by_vector = ((f"the {name}", rewritten(loads, change, name)) for name, _ in loads.vectors)
        yield from _together_and_alone(loads, words, rewritten(loads, change), by_vector)
    by_components = _by_components(loads)
    if by_components != loads:
        yield (
            "the loads have abs(u1) or abs(w1), where the scene has the whole speed",
            by_components,
        )


def by_component(
    loads: Loads, words: str, change: Callable[[str], str]
) -> Iterator[tuple[str, Loads]]:
    """Yield the loads with a change of all texts, and of one component of a vector alone."""
    alone = ((p.name, p.put(change(str(p.entry)))) for p in texts_of_vectors(loads))
    yield from _together_and_alone(loads, words, rewritten(loads, change), alone)


def _together_and_alone(
    loads: Loads, words: str, every: Loads, alone: Iterable[tuple[str, Loads]]
) -> Iterator[tuple[str, Loads]]:
    """Yield loads with a change of every text, and with that of some alone, where they are others."""
    if every != loads:
        yield words, every
    for where, other in alone:
        if other not in (loads, every):
            yield f"{words}, in {where} alone", other


def _speed(component: re.Match[str]) -> str:
    """Return the text of the length of the vector that has a component."""
    squares = " + ".join(f"{component.group(1)}{i}*{component.group(1)}{i}" for i in _AXES)
    return f"sqrt({squares})"


def _by_components(loads: Loads) -> Loads:
    """Return the loads with the size of one component for each length of a whole velocity."""
    lengths = {
        name: match.group(1)
        for name, text in loads.definitions
        if isinstance(text, str) and (match := _LENGTH.fullmatch(text.strip()))
    }
    for place in texts_of_vectors(loads):
        axis = int(place.path[-1]) + 1

        def size(match: re.Match[str], axis: int = axis) -> str:
            letter = lengths.get(match.group())
            return f"abs({letter}{axis})" if letter else match.group()

        text = _LENGTH.sub(rf"abs(\g<1>{axis})", str(place.entry))
        loads = replace(place, loads=loads).put(NAME.sub(size, text))
    return loads


def _named_otherwise(loads: Loads) -> Iterator[tuple[str, Loads]]:
    """Yield definitions by texts and vectors of [space] left out, reversed, or standing still."""
    begin = {"t": f"({decimal(loads.origin)})"}
    changes: _Named = (*_SIGNS, ("stands still, as at the start", partial(renamed, names=begin)))
    for words, change in changes:
        for name, other in each_named(loads, change):
            yield f"{name} {words}", other


def _exchanged(loads: Loads) -> Iterator[tuple[str, Loads]]:
    """Yield two numbers of [define] exchanged, of scenes with a few."""
    numbers = [k for k, (_, entry) in enumerate(loads.definitions) if rational(entry) is not None]
    for i, k in combinations(numbers, 2) if len(numbers) <= _MOST_EXCHANGED else ():
        (one, first), (other, second) = loads.definitions[i], loads.definitions[k]
        if first != second:
            definitions = [*loads.definitions]
            definitions[i], definitions[k] = (one, second), (other, first)
            yield f"{one} and {other} exchanged", replace(loads, definitions=tuple(definitions))


def rewritten(loads: Loads, change: Callable[[str], str], key: str = "") -> Loads:
    """Return the loads with every text changed, or every text of one key."""
    texts = [place for place in places(loads) if isinstance(place.entry, str)]
    for place in texts:
        if key in ("", key_of(place)):
            same = next(each for each in places(loads) if each.key == place.key)
            loads = same.put(change(str(place.entry)))
    return loads


def names_inertia(loads: Loads | None) -> bool:
    """Return True if a text reads the tensor of inertia."""
    texts = [] if loads is None else [str(place.entry) for place in places(loads)]
    return any(not _TENSOR.isdisjoint(NAME.findall(text)) for text in texts)


def with_inertia(loads: Loads, inertia: Floats) -> Loads:
    """Return the loads with the numbers of a tensor for its names."""
    values = {f"I{i}{k}": f"({float(inertia[i - 1, k - 1])!r})" for i, k in _PAIRS}
    return rewritten(loads, lambda text: NAME.sub(lambda m: values.get(m[0], m[0]), text))


def key_of(place: Place) -> str:
    return place.key.partition("[")[0]


# Other arguments.


def _of_scene(loads: Loads) -> Iterator[tuple[str, _Names]]:
    """Yield the exchanges by the vectors that are given in space axes."""
    for name, entries in loads.space:
        numbers = [decimal(entry) for entry in entries]
        back = enumerate(turned(numbers, BY_R), 1)
        words = f"{name} of [space] is turned the wrong way, by R for R^T"
        yield words, {f"{name}{i}": f"({entry})" for i, entry in back}
        plain = {f"{name}{i}": f"({entry})" for i, entry in zip(_AXES, entries, strict=True)}
        yield f"{name} of [space] is not turned into body axes", plain


# Parts of the loads.


def _drag_in_space(loads: Loads, some: list[str]) -> Iterator[tuple[str, Loads]]:
    """Yield the drag of each vector, and of all, by velocities in space axes and along these.

    The drag are all terms with velocities alone, or those of each velocity along or about its own axis.
    """
    known, kinds = [loads], (_is_drag(loads), is_drag_of_one(loads))
    for names, is_drag in product([*([name] for name in some), *[some] * (len(some) > 1)], kinds):
        other = _with_part(loads, names, is_drag, _along_space)
        if other not in known:
            known.append(other)
            yield f"drag of {' and '.join(names)} by coefficients along space axes", other


def _is_drag(loads: Loads) -> Callable[[str], bool]:
    """Return whether a term reads velocities alone."""
    is_moving, is_situated = _what_is_read(loads)
    return lambda term: is_moving(term) and not is_situated(term)


def is_drag_of_one(loads: Loads) -> Callable[[str], bool]:
    """Return whether a term reads a single velocity alone."""
    is_drag = _is_drag(loads)
    return lambda term: is_drag(term) and len(VELOCITIES.intersection(NAME.findall(term))) == 1


def _along_space(parts: Sequence[str], i: int) -> str:
    """Return an axis of the terms by velocities in space axes, whose sums are turned into body axes."""
    in_space = [renamed(part, {**_in_space("u"), **_in_space("w")}) for part in parts]
    return _CHANGES["in space axes"](in_space, i)


def _parts(loads: Loads) -> Iterator[tuple[str, tuple[str, ...], Callable[[str], bool]]]:
    """Yield parts of the vectors' texts: a noun, the vectors, and whether a term belongs to the part.

    What the equations say without texts is left to them: all of a vector, and of both.
    """
    is_moving, is_situated = _what_is_read(loads)
    kinds: dict[str, Callable[[str], bool]] = {
        "without velocities": lambda term: not is_moving(term),
        "that read more than velocities": is_situated,
    }
    split = {
        name: {term for text in map(str, own) for term in terms(text) if term != "0"}
        for name, own in loads.vectors
    }
    some = [name for name, own in split.items() if own]
    for names in [*((name,) for name in some), *[tuple(some)] * (len(some) > 1)]:
        noun = " and ".join(names)
        if loads.hung:
            yield f"{noun}, but for weight and buoyancy,", names, lambda term: True
        known = [{term for name in names for term in split[name]}]
        for words, is_part in kinds.items():
            part = {term for term in known[0] if is_part(term)}
            if (
                part not in known
                and not part.isdisjoint(split[names[0]])
                and not part.isdisjoint(split[names[-1]])
            ):
                known.append(part)
                yield f"terms of {noun} {words}", names, is_part


def _what_is_read(loads: Loads) -> tuple[Callable[[str], bool], Callable[[str], bool]]:
    """Return whether a term reads a velocity, and whether it reads what is none."""
    moving, situated = (readers(loads, names) for names in (VELOCITIES, _situated(loads)))
    return partial(_reads, moving), partial(_reads, situated)


def _reads(names: frozenset[str], text: str) -> bool:
    return not names.isdisjoint(NAME.findall(text))


def _with_part(
    loads: Loads, names: Sequence[str], is_part: Callable[[str], bool], change: _Change
) -> Loads:
    """Return the loads with a change of the terms of some vectors."""
    vectors = dict(loads.vectors)
    for name in names:
        split = [_split(str(entry), is_part) for entry in vectors[name]]
        parts = [part for _, part in split]
        vectors[name] = tuple(plus(stay, change(parts, i)) for i, (stay, _) in enumerate(split))
    return replace(loads, vectors=tuple(vectors.items()))


def _split(text: str, is_part: Callable[[str], bool]) -> tuple[str, str]:
    """Return the sum of the terms that are no part, and that of those that are."""
    sums = ["", ""]
    for term in terms(text):
        sums[is_part(term)] += term
    stay, part = (each.strip().removeprefix("+").strip() or "0" for each in sums)
    return stay, part


def terms(text: str) -> list[str]:
    """Return the terms of a sum with their signs; their texts one behind the other are the sum.

    A choice between two values is one term, in brackets.
    """
    outside = text
    while (shorter := re.sub(r"\([^()]*\)", "", outside)) != outside:
        outside = shorter
    if " if " in outside:
        return [f"({text})"]
    parts, depth, begin = list[str](), 0, 0
    for k, letter in enumerate(text):
        depth += (letter == "(") - (letter == ")")
        before = text[begin:k].strip()
        is_exponent = bool(re.search(r"\d[eE]$", before)) and letter in "+-"
        if (
            letter in "+-"
            and not depth
            and before
            and before[-1] not in "*/^(,"
            and not is_exponent
        ):
            parts.append(text[begin:k])
            begin = k
    return [*parts, text[begin:]]


def readers(loads: Loads, names: frozenset[str]) -> frozenset[str]:
    """Return some names, and those of all definitions that read one of them."""
    for _ in loads.definitions:
        more = (name for name, entry in loads.definitions if _reads(names, str(entry)))
        names = names.union(more)
    return names


def _situated(loads: Loads) -> frozenset[str]:
    """Return the names of what is no velocity: time, place and attitude, [space], tables and states."""
    space = (f"{name}{i}" for name, _ in loads.space for i in _AXES)
    states = (name for state in loads.states for name in state.components)
    tables = (name for name, _ in loads.tables)
    return frozenset(("t", *QUATERNION, *ROTATION, *CENTRE, *space, *states, *tables))


def added(loads: Loads, more: Mapping[str, Sequence[str]]) -> Loads:
    """Return the loads with more texts in each of the vectors."""
    own, none = dict(loads.vectors), tuple[Entry, ...](ZERO_VECTOR)
    vectors = {
        name: tuple(map(plus, own.get(name, none), more[name])) for name in VECTORS[loads.model]
    }
    return replace(loads, vectors=tuple(vectors.items()))
