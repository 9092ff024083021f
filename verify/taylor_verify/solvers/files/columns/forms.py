"""Forms of an attitude besides a quaternion and a matrix: angles, vectors, an axis with an angle.

A form has columns of its own, and a quaternion, scalar first, of the numbers of a row. Euler angles are
turns about axes that move along, in the order of their sequence. Sines and roots are formed with 400 bits;
the quaternion of Rodrigues parameters, of either branch, is exact.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import partial, reduce
from itertools import product
from math import nan
from typing import Any, Final

import gmpy2

from taylor_verify.numbers import rotation
from taylor_verify.scenes.stand_in import STAND_IN_BITS
from taylor_verify.scenes.turns import AXES
from taylor_verify.solvers.values import Value

Numbers = Sequence[Fraction]
_SPARE_BITS: Final = 64


@dataclass(frozen=True)
class Form:
    """An attitude in these columns, some of them ``angles``; ``words`` say what it is."""

    name: str
    columns: tuple[str, ...]
    words: str
    quaternion: Callable[[Numbers], Sequence[Value]]
    angles: tuple[str, ...] = ()


def _mpfr(value: Fraction) -> Any:
    return gmpy2.mpq(value.numerator, value.denominator) + gmpy2.mpfr(0)


def _exact(parts: Sequence[Any]) -> list[Value]:
    """Return numbers of MPFR as rationals; NaN where the quaternion is none."""
    if not all(map(gmpy2.is_finite, parts)):
        return [nan] * len(parts)
    ratios = (part.as_integer_ratio() for part in parts)
    return [Fraction(int(above), int(below)) for above, below in ratios]


def _half_turn(axis: Sequence[Any], angle: Any) -> Sequence[Any]:
    sine, cosine = gmpy2.sin_cos(angle / 2)
    return (cosine, *(sine * part for part in axis))


def _of_euler(axes: Sequence[int], angles: Numbers) -> Sequence[Value]:
    with gmpy2.context(precision=STAND_IN_BITS + _SPARE_BITS):
        units = ([int(part) for part in AXES[axis]] for axis in axes)
        turns = (_half_turn(e, _mpfr(a)) for e, a in zip(units, angles, strict=True))
        return _exact(reduce(rotation.product, turns))


def _of_axis(numbers: Numbers) -> Sequence[Value]:
    """Return the turn about an axis of any length; its length is the angle where there is no other."""
    axis, *stated = numbers[:3], *numbers[3:]
    with gmpy2.context(precision=STAND_IN_BITS + _SPARE_BITS):
        length = gmpy2.sqrt(sum(_mpfr(part) ** 2 for part in axis))
        angle = _mpfr(stated[0]) if stated else length
        if not angle:
            return (Fraction(1), *[Fraction(0)] * 3)
        return _exact(_half_turn([_mpfr(part) / length for part in axis], angle))


def _of_rodrigues(vector: Numbers) -> Sequence[Value]:
    square = sum((part * part for part in vector), Fraction(0))
    return ((1 - square) / (1 + square), *(2 * part / (1 + square) for part in vector))


def _of_gibbs(vector: Numbers) -> Sequence[Value]:
    with gmpy2.context(precision=STAND_IN_BITS + _SPARE_BITS):
        numbers = [gmpy2.mpfr(1), *map(_mpfr, vector)]
        length = gmpy2.sqrt(sum(part * part for part in numbers))
        return _exact([part / length for part in numbers])


def _numbered(name: str) -> tuple[str, ...]:
    return tuple(f"{name}{k}" for k in (1, 2, 3))


def _euler(axes: Sequence[int]) -> Form:
    name = "".join("xyz"[axis] for axis in axes)
    words = f"Euler angles about {', '.join(name)} in turn, the axes moving along"
    columns = _numbered(f"euler{name}")
    return Form(name, columns, words, partial(_of_euler, axes), columns)


_TURNS: Final = [axes for axes in product(range(3), repeat=3) if axes[0] != axes[1] != axes[2]]
_VECTOR: Final = _numbered("rotvec")
_AXIS: Final = (*_numbered("axisangle"), "axisangle4")
FORMS: Final[Mapping[str, Form]] = {
    form.name: form
    for form in (
        *map(_euler, _TURNS),
        Form("rotvec", _VECTOR, "a rotation vector", _of_axis, _VECTOR),
        Form("mrp", _numbered("mrp"), "modified Rodrigues parameters", _of_rodrigues),
        Form("gibbs", _numbered("gibbs"), "a Gibbs vector", _of_gibbs),
        Form("axis_angle", _AXIS, "an axis and an angle", _of_axis, _AXIS[3:]),
    )
}
SEQUENCES: Final = tuple(name for name in FORMS if set(name) <= set("xyz"))
