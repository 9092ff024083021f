"""Usual names of the columns of a trajectory, as a table of spellings.

A spelling has a name for every component of a group, in our order. Names are compared by their letters
and digits alone, small: ``omega_x``, ``Omega.X`` and ``omega[x]`` are ``omegax``. To accept a name is to
add it to `usual.txt`; the notes of a file, the help and the documentation speak of what was taken.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import product
from typing import Final

from taylor_verify.records.quantities import COLUMNS
from taylor_verify.solvers.files.columns.forms import FORMS
from taylor_verify.solvers.files.columns.programs import entries, spellings_of, usual
from taylor_verify.solvers.files.columns.spelling import Spelling

# Every group of columns, time and forms of the attitude among them, with the names that are ours.
GROUPS: Final[Mapping[str, tuple[str, ...]]] = {
    "time": ("t",),
    **COLUMNS,
    **{form.name: form.columns for form in FORMS.values()},
}
KNOWN: Final = tuple(name for names in GROUPS.values() for name in names)
GROUP_OF: Final = {name: group for group, names in GROUPS.items() for name in names}

_LETTERS: Final = ("x", "y", "z")
_FROM_ONE: Final = ("1", "2", "3")
_FROM_ZERO: Final = ("0", "1", "2")
_TRIPLES: Final = (_LETTERS, _FROM_ONE, _FROM_ZERO)


def _pairs(components: Sequence[str]) -> tuple[str, ...]:
    return tuple(i + k for i, k in product(components, repeat=2))


# The ways to count the components of a group, each in our order.
COMPONENTS: Final[Mapping[str, tuple[tuple[str, ...], ...]]] = {
    "time": (("",),),
    **dict.fromkeys((*COLUMNS, *FORMS), _TRIPLES),
    "quaternion": (("w", *_LETTERS), ("s", *_LETTERS), ("0", *_FROM_ONE), (*_FROM_ONE, "4")),
    "attitude": tuple(_pairs(triple) for triple in (_FROM_ONE, _FROM_ZERO, _LETTERS)),
    "axis_angle": ((*_LETTERS, "angle"), (*_FROM_ONE, "4"), (*_FROM_ZERO, "3")),
}

_ATTITUDES: Final = "q quat quaternion orientation orn attitude att rotation"
_MATRICES: Final = "r rot rotation rotationmatrix rotmat rmat orientation attitude attitudematrix"
# A direction cosine matrix takes space to body as often as body to space.
_COSINES: Final = "dcm directioncosinematrix c"
# p is a position, but beside the angular momentum L it is the linear one.
_P: Final = ("px", "py", "pz")
_L: Final = ("lx", "ly", "lz")
_DOUBT: Final = "the scalar is the first of them or the last, and the names do not say which"

TO_SPACE: Final = "body axes to space axes"
_TO_BODY_SHOWS: Final = f"{TO_SPACE}; one that takes space to body shows as transposed"
_AXES: Final = {"omega": "body axes", "linear_velocity": "of the body's origin, in body axes"}
_REMARKS: Final = {
    **_AXES,
    "quaternion": "scalar first",
    "attitude": TO_SPACE,
    **{form.name: f"{form.words}, {TO_SPACE}" for form in FORMS.values()},
}


def _spellings() -> Iterator[Spelling]:
    for entry in entries():
        yield from spellings_of(entry, _REMARKS.get(entry["group"], ""))
    for group, names in GROUPS.items():
        yield Spelling(group, names, _REMARKS.get(group, ""))
    for entry in usual():
        yield from spellings_of(entry, _REMARKS.get(entry["group"], ""))
    yield Spelling("centre", _LETTERS, is_whole=True)
    yield Spelling("centre", _P, apart_from=_L)
    yield Spelling("linear_impulse", _P, "linear momentum beside Lx Ly Lz", company=_L)
    yield Spelling("angular_impulse", _L, "angular momentum beside px py pz", company=_P)
    yield Spelling("omega", ("p", "q", "r"), _AXES["omega"], is_whole=True)
    velocity = "linear_velocity"
    yield Spelling(velocity, ("u", "v", "w"), _AXES[velocity], is_whole=True, beside="omega")
    for stem, scalar in product(_ATTITUDES.split(), "ws"):
        yield Spelling("quaternion", tuple(stem + c for c in (scalar, *_LETTERS)))
    for stem, first in product(_ATTITUDES.split(), (1, 0)):
        if (stem, first) not in (("q", 0), ("orn", 0)):
            keys = tuple(f"{stem}{first + k}" for k in range(4))
            yield Spelling("quaternion", keys, doubt=_DOUBT)
    yield Spelling(
        "quaternion", ("w", *_LETTERS), is_whole=True, unless=frozenset({"u", "v", "p", "r"})
    )
    for stems, remark in ((_MATRICES, TO_SPACE), (_COSINES, _TO_BODY_SHOWS)):
        for stem, pairs in product(stems.split(), COMPONENTS["attitude"]):
            yield Spelling("attitude", tuple(stem + c for c in pairs), remark)


SPELLINGS: Final = tuple(dict.fromkeys(_spellings()))


def _places() -> Mapping[str, Sequence[tuple[Spelling, int]]]:
    places: dict[str, list[tuple[Spelling, int]]] = {}
    for spelling in SPELLINGS:
        for component, key in enumerate(spelling.keys):
            places.setdefault(key, []).append((spelling, component))
    return places


# The spellings that have each name, and its component there.
PLACES: Final = _places()
