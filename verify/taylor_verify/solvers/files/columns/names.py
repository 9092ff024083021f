"""Usual names of the columns of a trajectory, as a table of spellings.

A spelling has a name for every component of a group, in our order. Names are compared by their letters
and digits alone, small: ``omega_x``, ``Omega.X`` and ``omega[x]`` are ``omegax``. To accept a name is to
add it here; the notes of a file, the help and the documentation speak of what was taken.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from typing import Final

from taylor_verify.records.quantities import COLUMNS

# Every group of columns, time among them, with the names that are ours.
GROUPS: Final[Mapping[str, tuple[str, ...]]] = {"time": ("t",), **COLUMNS}
KNOWN: Final = tuple(name for names in GROUPS.values() for name in names)
GROUP_OF: Final = {name: group for group, names in GROUPS.items() for name in names}

_LETTERS: Final = ("x", "y", "z")
_FROM_ONE: Final = ("1", "2", "3")
_FROM_ZERO: Final = ("0", "1", "2")
_TRIPLES: Final = (_LETTERS, _FROM_ONE, _FROM_ZERO)


@dataclass(frozen=True)
class Spelling:
    """Names of all components of a group; ``remark`` is said wherever it is taken.

    ``is_whole`` names have no path in front of them: the x of ``acceleration.x`` is no position. A spelling
    is taken only ``beside`` another group, and not where a name of ``unless`` is in the file. One with a
    ``doubt`` is never taken: the doubt says why.
    """

    group: str
    keys: tuple[str, ...]
    remark: str = ""
    is_whole: bool = False
    beside: str = ""
    unless: frozenset[str] = frozenset()
    doubt: str = ""


def _pairs(components: Sequence[str]) -> tuple[str, ...]:
    return tuple(i + k for i, k in product(components, repeat=2))


# The ways to count the components of a group, each in our order.
COMPONENTS: Final[Mapping[str, tuple[tuple[str, ...], ...]]] = {
    "time": (("",),),
    **dict.fromkeys(COLUMNS, _TRIPLES),
    "quaternion": (("w", *_LETTERS), ("0", *_FROM_ONE), (*_FROM_ONE, "4")),
    "attitude": tuple(_pairs(triple) for triple in (_FROM_ONE, _FROM_ZERO, _LETTERS)),
}

# Names that take x y z, 1 2 3 or 0 1 2 behind them.
_STEMS: Final = {
    "omega": (
        "w omega wb omegab wbody omegabody bodyomega angvel angularvelocity angularvelocitybody "
        "angularrate angularrates twistangular gyro gyr gyroscope rate rates bodyrate bodyrates"
    ),
    "linear_velocity": (
        "u linvel linearvelocity linearvelocitybody bodyvelocity velocitybody vbody twistlinear"
    ),
    "linear_impulse": "linearimpulse impulselinear",
    "angular_impulse": "angularimpulse impulseangular",
    "centre": "c centre center position pos translation location",
}
_ATTITUDES: Final = "q quat quaternion orientation attitude att rotation"
_MATRICES: Final = "r rot rotation rotationmatrix rotmat rmat orientation attitude attitudematrix"
# A direction cosine matrix takes space to body as often as body to space.
_COSINES: Final = "dcm directioncosinematrix c"
_TIMES: Final = (
    "time times timestamp timestamps stamp tout seconds sec simtime simulationtime elapsed "
    "elapsedtime"
)

_FIRST: Final = "scalar first"
_TO_SPACE: Final = "body axes to space axes"
_BODY: Final = {"omega": "body axes", "linear_velocity": "of the body's origin, in body axes"}


def _spellings() -> Iterator[Spelling]:
    for group, names in GROUPS.items():
        yield Spelling(group, names, _remark(group))
    for group, stems in _STEMS.items():
        for stem, triple in product(stems.split(), _TRIPLES):
            yield Spelling(group, tuple(stem + c for c in triple), _remark(group))
    yield Spelling("centre", ("px", "py", "pz"))
    yield Spelling("centre", ("xpos", "ypos", "zpos"))
    yield Spelling("centre", _LETTERS, is_whole=True)
    for words in ("rollrate pitchrate yawrate", "rollspeed pitchspeed yawspeed"):
        yield Spelling("omega", tuple(words.split()), _BODY["omega"])
    yield Spelling("omega", ("p", "q", "r"), _BODY["omega"], is_whole=True)
    yield Spelling(
        "linear_velocity", ("u", "v", "w"), _BODY["linear_velocity"], is_whole=True, beside="omega"
    )
    yield from _quaternions()
    for stem, pairs in product(_MATRICES.split(), COMPONENTS["attitude"]):
        yield Spelling("attitude", tuple(stem + c for c in pairs), _TO_SPACE)
    remark = f"{_TO_SPACE}; one that takes space to body shows as transposed"
    for stem, pairs in product(_COSINES.split(), COMPONENTS["attitude"]):
        yield Spelling("attitude", tuple(stem + c for c in pairs), remark)
    for name in _TIMES.split():
        yield Spelling("time", (name,))


def _remark(group: str) -> str:
    return {**_BODY, "quaternion": _FIRST, "attitude": _TO_SPACE}.get(group, "")


def _quaternions() -> Iterator[Spelling]:
    for stem in _ATTITUDES.split():
        yield Spelling("quaternion", tuple(stem + c for c in ("w", *_LETTERS)))
        yield Spelling("quaternion", tuple(stem + c for c in ("s", *_LETTERS)))
        for digits in (("1", "2", "3", "4"), ("0", "1", "2", "3")):
            if (stem, digits[0]) != ("q", "0"):
                doubt = (
                    "the scalar is the first of them or the last, and the names do not say which"
                )
                yield Spelling("quaternion", tuple(stem + c for c in digits), doubt=doubt)
    for words in (
        *("qc q1 q2 q3", "qs q1 q2 q3", "qw q1 q2 q3", "qr qi qj qk"),
        *("eta eps1 eps2 eps3", "eta epsilon1 epsilon2 epsilon3"),
    ):
        yield Spelling("quaternion", tuple(words.split()))
    yield Spelling(
        "quaternion", ("w", *_LETTERS), is_whole=True, unless=frozenset({"u", "v", "p", "r"})
    )


SPELLINGS: Final = tuple(dict.fromkeys(_spellings()))
# Where each name stands: its spelling by number, and its component.
PLACES: Final[Mapping[str, tuple[tuple[int, int], ...]]] = {
    key: tuple(
        (number, component)
        for number, spelling in enumerate(SPELLINGS)
        for component, name in enumerate(spelling.keys)
        if name == key
    )
    for key in {key for spelling in SPELLINGS for key in spelling.keys}
}
