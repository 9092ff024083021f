"""The numbers of a scene's texts, and the terms of its sums: each a number that may be another one."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import lru_cache, partial
from itertools import product
from math import pi
from typing import Final

import numpy as np

from taylor_verify.judge.causes.candidate import GRAVITY
from taylor_verify.judge.causes.changed_equations import Changes, Equations
from taylor_verify.judge.causes.changed_texts import (
    NAME,
    VELOCITIES,
    changed_texts,
    is_drag_of_one,
    key_of,
    readers,
    rewritten,
    terms,
)
from taylor_verify.judge.causes.dials import (
    LITERAL,
    Dials,
    Key,
    dials,
    entry,
    is_readable,
    literal,
    term,
)
from taylor_verify.judge.causes.fit import DIFFERENCE, Family, fault
from taylor_verify.judge.causes.hung_loads import hung_otherwise, with_hung
from taylor_verify.judge.causes.limits import other_limits
from taylor_verify.judge.causes.many_flows import Floats
from taylor_verify.judge.causes.over_ground import over_ground
from taylor_verify.judge.causes.texts import (
    HANGING,
    Place,
    places,
    rational,
    texts_of_vectors,
    with_entry,
)
from taylor_verify.judge.causes.wheels_of_text import half_wheels
from taylor_verify.models.acting import Acting
from taylor_verify.numbers.tensors import scaled
from taylor_verify.scenes.loads.loads import Hung, Loads
from taylor_verify.scenes.loads.tables import Kind

KIND: Final = "number"
_TURNS: Final = re.compile(r"\b(?:sin|cos|tan)\(")
# A number below a fraction line makes the one of the other.
_ANGLES: Final = {
    "degrees and radians exchanged": (pi / 180, 180 / pi),
    "cycles and radians exchanged": (2 * pi, 1 / (2 * pi)),
}
_DIGITS: Final = 15
_MOST: Final = 60
# Times the time of a switch: a time that no run reaches.
_NEVER: Final = 1e6
# The time of a switch is linear in a number to this part.
_SAME: Final = 1e-6


@dataclass(frozen=True)
class Number:
    """A number of the scene by its name and ``value``, and the loads with another ``put`` in its place.

    ``keys`` are those of the dials that are the number, if there are any.
    """

    name: str
    value: float
    put: Callable[[float], Loads]
    is_angle: bool = False
    keys: tuple[Key, ...] = ()

    def changes(self, right: Equations, values: Floats) -> Changes:
        """Return the change of the scene; raises ValueError where no scene has this number."""
        assert right.acting is not None
        return {"acting": right.acting.of(self.put(float(values[0])))}

    def with_value(self, value: float) -> Loads | None:
        """Return the loads with another value; None where it makes no text: an exponent often does not."""
        with suppress(ValueError):
            other = self.put(value)
            return other if next(other.faults(), None) is None else None
        return None

    def family(self, right: Equations) -> Family:
        """Return the fault of another value, or of another time of the one switch that it moves."""
        if (switch := self._switch(right)) is not None:
            return switch
        value, written = np.array([self.value]), partial(self.changes, right)
        return Family(
            self.name,
            KIND,
            value,
            np.abs(value),
            self._turned(right) or written,
            (self.name,),
            written,
        )

    def _switch(self, right: Equations) -> Family | None:
        """Return the time of a switch as a family; None where the number is another one."""
        loads = right.loads
        assert loads is not None
        if self.keys or not loads.switches:
            return None
        shift = self.value * DIFFERENCE
        times = [np.array(self.put(self.value + k * shift).switches, float) for k in range(3)]
        if len({len(each) for each in times}) > 1:
            return None
        steps = np.diff(times, axis=0)
        moved = np.flatnonzero(steps[0])
        if len(moved) != 1 or np.any(
            np.abs(np.diff(steps, axis=0)) > _SAME * np.max(np.abs(steps))
        ):
            return None
        (k,) = moved
        at, pace = float(times[0][k]) + right.start, float(f"{steps[0][k] / shift:.9g}")
        return Family(
            f"switch at t = {at:.6g}",
            KIND,
            np.array([at]),
            np.array([abs(self.value * pace)]),
            lambda times: self.changes(right, self.value + (times - at) / pace),
        )

    def _turned(self, right: Equations) -> Callable[[Floats], Changes] | None:
        """Return the change by dials; None where the number has none."""
        assert right.acting is not None
        turned = _dials(right.acting) if self.keys else None
        if turned is None or not turned.places.keys() >= {*self.keys}:
            return None
        return lambda values: turned.turned((key, float(values[0])) for key in self.keys)


@lru_cache(maxsize=8)
def _dials(acting: Acting) -> Dials:
    """Return the dials of the numbers of a scene that move no switch, and of the points of its weights."""
    loads = acting.written
    keys = [entry(place) for point in _points(loads).values() for place in point]
    return dials(acting, (*keys, *(key for each in numbers(loads) for key in each.keys)))


def points_of_weights(right: Equations) -> Iterator[Family]:
    """Yield other points of weight and of buoyancy."""
    loads, acting = right.loads, right.acting
    if loads is None or acting is None or not loads.hung:
        return
    scale = max(float(abs(x)) for hung in loads.hung for x in hung.at) or 1.0
    for name, point in _points(loads).items():

        def turned(values: Floats, point: Sequence[Place] = point) -> Changes:
            return _dials(acting).turned(zip(map(entry, point), values, strict=True))

        def written(values: Floats, point: Sequence[Place] = point) -> Changes:
            other = loads
            for place, value in zip(point, values, strict=True):
                other = _put_number(replace(place, loads=other), float(value))
            return {"acting": acting.of(other)}

        values = np.array([float(place.entry) for place in point])
        yield Family(name, KIND, values, np.full(3, scale), turned, written=written)


def _points(loads: Loads) -> dict[str, list[Place]]:
    """Return the places of the points at which weight and buoyancy act, by the name of the key."""
    forces = [
        f"{name}.at" for name, hung in zip(HANGING, loads.hung, strict=False) if any(hung.force)
    ]
    return {key: [p for p in places(loads) if key_of(p) == key] for key in forces}


@lru_cache(maxsize=8)
def numbers(loads: Loads) -> list[Number]:
    """Return the numbers of the loads that may be others, and the factors of the terms of sums."""
    sums = (*_of_terms(loads), *_of_drag(loads), *_of_gravity(loads))
    every = [*_of_places(loads), *_repeated(loads), *sums]
    near = ((number, number.with_value(number.value * (1 + DIFFERENCE))) for number in every)
    free = [_at_no_switch(loads, one, other) for one, other in near if other is not None][:_MOST]
    # Numbers that are dials go through one flow, one after the other.
    return sorted(free, key=lambda number: not number.keys)


def _at_no_switch(loads: Loads, number: Number, near: Loads) -> Number:
    """Return a number without its dials if ``near``, the loads with a value near to it, move a switch."""
    moved = near.switches if loads.switches else ()
    return number if moved == loads.switches or not moved else replace(number, keys=())


def faults_of_texts(right: Equations) -> Iterator[Family]:
    """Yield texts that read something else, hung forces otherwise, and tables of another kind."""
    loads, acting = right.loads, right.acting
    if loads is None or acting is None:
        return
    names = {name for name, _ in loads.definitions}
    for number in numbers(loads):
        for words, factors in _ANGLES.items() if number.is_angle else ():
            for factor in factors:
                if (other := number.with_value(factor * number.value)) is not None:
                    yield fault(f"{number.name} {words}", KIND, {"acting": acting.of(other)})
        if number.name in names and (other := number.with_value(-number.value)) is not None:
            yield fault(f"{number.name} with the other sign", KIND, {"acting": acting.of(other)})
        if (missed := _missed(loads, number)) is not None:
            time = right.start + float(missed[0])
            # A number that no run reaches is no text for a reader.
            changes = {"acting": acting.of(missed[1]), "late": 0.0}
            yield fault(f"switch at t = {time:.6g} missed", "switch", changes)
    hung, limited = hung_otherwise(loads), other_limits(loads)
    every = (*changed_texts(loads), *hung, *limited, *over_ground(right), *half_wheels(loads))
    for name, other in every:
        if next(other.faults(), None) is None:
            yield fault(name, KIND, {"acting": acting.of(other)})
    for k, (name, table) in enumerate(loads.tables):
        for kind in (kind for kind in Kind if kind is not table.kind):
            tables = with_entry(loads.tables, k, (name, replace(table, kind=kind)))
            changes = {"acting": acting.of(replace(loads, tables=tables))}
            yield fault(f"table {name} is {kind}, where the scene has {table.kind}", KIND, changes)


def _missed(loads: Loads, number: Number) -> tuple[Fraction, Loads] | None:
    """Return the switch whose time a number is, and the loads without it: it comes after all runs."""
    if not loads.switches or (other := number.with_value(_NEVER * number.value)) is None:
        return None
    missed = set(loads.switches).difference(other.switches)
    if len(missed) == 1 and len(other.switches) == len(loads.switches):
        return missed.pop(), other
    return None


def _of_places(loads: Loads) -> Iterator[Number]:
    for place in places(loads):
        text, value = str(place.entry), rational(place.entry)
        if value:
            yield _of_entry(place, float(value))
        for match in LITERAL.finditer(text) if value is None else ():
            if float(match.group()):
                put = partial(_put_literal, place, text, match.span())
                name = f"`{match.group()}` in {place.name}, {text},"
                keys = (literal(place, match.start()),)
                yield Number(name, float(match.group()), put, bool(_TURNS.search(text)), keys)


def _of_entry(place: Place, value: float) -> Number:
    keys = (entry(place),) if is_readable(place) else ()
    return Number(place.name, value, partial(_put_number, place), keys=keys)


def _put_number(place: Place, value: float) -> Loads:
    return place.put(Fraction(f"{value:.{_DIGITS}g}"))


def _put_literal(place: Place, text: str, span: tuple[int, int], value: float) -> Loads:
    return place.put(f"{text[: span[0]]}{_written(value)}{text[span[1] :]}")


def _written(value: float) -> str:
    text = f"{value:.{_DIGITS}g}"
    return f"({text})" if value < 0 else text


def _repeated(loads: Loads) -> Iterator[Number]:
    """Yield the numbers that several texts have, of one key or of all, to be changed in all of them."""
    by_key: dict[str, dict[str, list[Key]]] = {}
    for place in places(loads):
        if isinstance(place.entry, str):
            for key, match in product(("", key_of(place)), LITERAL.finditer(place.entry)):
                of_key = by_key.setdefault(key, {})
                is_entry = rational(place.entry) is not None
                own = entry(place) if is_entry else literal(place, match.start())
                of_key.setdefault(match.group(), []).append(own)
    for key, of_key in by_key.items():
        for text, keys in of_key.items():
            is_part = not key or len(keys) < len(by_key[""][text])
            if len(keys) > 1 and is_part and float(text):
                name = f"the number {text} in " + (f"all of {key}" if key else "all texts")
                put = partial(_put_all, loads, key, text)
                yield Number(name, float(text), put, keys=tuple(keys))


def _put_all(loads: Loads, key: str, text: str, value: float) -> Loads:
    def changed(match: re.Match[str]) -> str:
        return _written(value) if match.group() == text else match.group()

    return rewritten(loads, lambda text: LITERAL.sub(changed, text), key)


# Terms of sums.


def _of_terms(loads: Loads) -> Iterator[Number]:
    """Yield the factors of terms that have no number of their own."""
    for place in places(loads):
        if not isinstance(place.entry, str):
            continue
        parts = terms(place.entry)
        for k, part in enumerate(parts):
            if not LITERAL.match(part.strip().lstrip("+-").strip()) and len(parts) > 1:
                name = f"factor of the term {part.strip()} in {place.name}"
                put = partial(_put_factor, place, parts, {k})
                yield Number(name, 1.0, put, keys=(term(place, k),))


def _put_factor(place: Place, parts: list[str], which: set[int], value: float) -> Loads:
    return place.put(_weighted(parts, which, value))


def _weighted(parts: list[str], which: set[int], value: float) -> str:
    """Return the sum of terms, of which some have a factor."""
    words = []
    for k, part in enumerate(parts):
        sign, body = ("-", part.strip()[1:]) if part.strip()[0] == "-" else ("+", part.strip())
        body = body.removeprefix("+").strip()
        words.append(f"{sign} {_written(value)}*({body})" if k in which else f"{sign} {body}")
    return " ".join(words).removeprefix("+ ")


def _of_drag(loads: Loads) -> Iterator[Number]:
    """Yield the factor of all terms that read velocities, of linear or quadratic ones, of one vector."""
    names, own = readers(loads, VELOCITIES), texts_of_vectors(loads)
    vectors = (name for name, _ in loads.vectors)
    every = dict[tuple[frozenset[int], ...], tuple[str, Callable[[str], set[int]], str]]()
    kinds = {"drag by single velocities": is_drag_of_one(loads), **_DRAGS}
    for key, (words, is_drag) in product([*vectors, ""], kinds.items()):
        drag: Callable[[str], set[int]] = partial(_drag_of, names, is_drag)
        of_key = (drag(str(p.entry)) if key in ("", key_of(p)) else () for p in own)
        # Where all of the drag is in one vector, or is linear, or quadratic, the later words say it.
        every[tuple(map(frozenset, of_key))] = f"{words}{f' in the {key}' * bool(key)}", drag, key
    for parts, (words, drag, key) in every.items():
        if sum(map(bool, parts)) > 1:
            keys = tuple(term(p, k) for p, some in zip(own, parts, strict=True) for k in some)
            yield Number(
                f"factor of all {words}", 1.0, partial(_put_drag, loads, drag, key), keys=keys
            )


def _is_linear(part: str) -> bool:
    """Return True for a product of numbers and one component of a velocity."""
    velocities = [name for name in NAME.findall(part) if name[0] in "uw"]
    return len(velocities) == 1 and set(part).isdisjoint("(^/") and "**" not in part


_DRAGS: Final[dict[str, Callable[[str], bool]]] = {
    "terms with velocities (drag)": lambda part: True,
    "linear drag": _is_linear,
    "quadratic drag": lambda part: "abs(" in part,
}


def _drag_of(names: frozenset[str], is_drag: Callable[[str], bool], text: str) -> set[int]:
    """Return the places of the terms of a text that are a drag and read one of the names."""
    parts = enumerate(terms(text))
    return {k for k, part in parts if is_drag(part) and not names.isdisjoint(NAME.findall(part))}


def _put_drag(loads: Loads, drag: Callable[[str], set[int]], key: str, value: float) -> Loads:
    def changed(text: str) -> str:
        return _weighted(terms(text), drag(text), value) if drag(text) else text

    for name, _ in loads.vectors:
        loads = rewritten(loads, changed, name) if key in ("", name) else loads
    return loads


def _of_gravity(loads: Loads) -> Iterator[Number]:
    """Yield the factor of weight and buoyancy together, as another acceleration of gravity makes it."""
    if sum(any(hung.force) for hung in loads.hung) > 1:
        yield Number(GRAVITY, 1.0, partial(_put_gravity, loads))


def _put_gravity(loads: Loads, value: float) -> Loads:
    factor = Fraction(f"{value:.{_DIGITS}g}")
    every = range(len(loads.hung))
    return with_hung(loads, every, lambda hung: Hung(scaled(factor, hung.force), hung.at))
