"""Usual names of the columns of a trajectory, as a table of spellings.

A spelling has a name for every component of a group, in our order. Names are compared by their letters
and digits alone, small: ``omega_x``, ``Omega.X`` and ``omega[x]`` are ``omegax``. To accept a name is to
add it here; the notes of a file, the help and the documentation speak of what was taken.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import product
from typing import Final

from taylor_verify.records.quantities import COLUMNS
from taylor_verify.solvers.files.columns.forms import FORMS, SEQUENCES
from taylor_verify.solvers.files.columns.programs import entries, spellings_of
from taylor_verify.solvers.files.columns.spelling import Frame, Spelling, Turn

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

# Names that take x y z, 1 2 3 or 0 1 2 behind them.
_STEMS: Final = {
    "omega": (
        "w omega wb omegab wbody omegabody bodyomega angvel angularvelocity angularvelocitybody "
        "angularrate angularrates twistangular pqr gyro gyr gyroscope rate rates bodyrate bodyrates"
    ),
    "linear_velocity": (
        "u uvw linvel linearvelocity linearvelocitybody bodyvelocity velocitybody vbody twistlinear"
    ),
    "linear_impulse": "linearimpulse impulselinear",
    "angular_impulse": "angularimpulse impulseangular",
    "centre": "c centre center position pos pose translation location",
    "rotvec": "rotvec rotationvector",
    "mrp": "mrp mrps modifiedrodrigues",
    **{name: f"euler{name} euler{name}angle" for name in SEQUENCES},
}
_OF_ANGLES: Final = ("euler", "eulerangle", "eulerangles", "eul", "att", "attitude", "angle")
# Names that say that the components are along axes of space.
_IN_SPACE: Final = (
    "omegaworld omegaspace worldomega spaceomega angvelworld angularvelocityworld "
    "angularvelocityspace worldangularvelocity"
)
# Other names of all components, in our order.
_WORDS: Final = {
    "centre": ("xpos ypos zpos",),
    "omega": ("rollrate pitchrate yawrate", "rollspeed pitchspeed yawspeed"),
    "quaternion": (
        "qc q1 q2 q3",
        "qs q1 q2 q3",
        "qw q1 q2 q3",
        "qr qi qj qk",
        "eta eps1 eps2 eps3",
        "eta epsilon1 epsilon2 epsilon3",
        "beta0 beta1 beta2 beta3",
        "ep0 ep1 ep2 ep3",
    ),
    "mrp": ("sigma1 sigma2 sigma3", "sigma0 sigma1 sigma2"),
    "axis_angle": ("axisx axisy axisz angle", "axis1 axis2 axis3 angle", "axis0 axis1 axis2 angle"),
    # Of ships, aircraft and robots: yaw, then pitch, then roll, about axes that move along.
    "zyx": (
        *(f"{yaw} pitch roll" for yaw in ("yaw", "heading")),
        *("psi theta phi", "heading trim heel", "yawangle pitchangle rollangle"),
        *(f"{stem}yaw {stem}pitch {stem}roll" for stem in _OF_ANGLES),
        *(f"{stem}psi {stem}theta {stem}phi" for stem in _OF_ANGLES),
        *("rpy2 rpy1 rpy0", "rpy3 rpy2 rpy1", "rpyz rpyy rpyx", "ypr0 ypr1 ypr2", "ypr1 ypr2 ypr3"),
    ),
}
_TIMES: Final = (
    "time times timestamp timestamps stamp tout seconds sec simtime simulationtime elapsed "
    "elapsedtime"
)
_ATTITUDES: Final = "q quat quaternion orientation orn attitude att rotation"
_MATRICES: Final = "r rot rotation rotationmatrix rotmat rmat orientation attitude attitudematrix"
# A direction cosine matrix takes space to body as often as body to space.
_COSINES: Final = "dcm directioncosinematrix c"
# p is a position, but beside the angular momentum L it is the linear one.
_P: Final = ("px", "py", "pz")
_L: Final = ("lx", "ly", "lz")
_DOUBT: Final = "the scalar is the first of them or the last, and the names do not say which"

_TO_SPACE: Final = "body axes to space axes"
_TO_BODY_SHOWS: Final = f"{_TO_SPACE}; one that takes space to body shows as transposed"
_AXES: Final = {"omega": "body axes", "linear_velocity": "of the body's origin, in body axes"}
_REMARKS: Final = {
    **_AXES,
    "quaternion": "scalar first",
    "attitude": _TO_SPACE,
    **{form.name: f"{form.words}, {_TO_SPACE}" for form in FORMS.values()},
}


def _spellings() -> Iterator[Spelling]:
    for entry in entries():
        yield from spellings_of(entry, _REMARKS.get(entry["group"], ""))
    for group, names in GROUPS.items():
        yield Spelling(group, names, _REMARKS.get(group, ""))
    for group, stems in _STEMS.items():
        for stem, triple in product(stems.split(), _TRIPLES):
            yield Spelling(group, tuple(stem + c for c in triple), _REMARKS.get(group, ""))
    for stem, triple in product(_IN_SPACE.split(), _TRIPLES):
        yield Spelling("omega", tuple(stem + c for c in triple), turn=Turn.SPACE_AXES)
    for group, spelled in _WORDS.items():
        for words in spelled:
            frame = Frame.ANGLES if words.startswith("roll") else Frame.UNSAID
            yield Spelling(group, tuple(words.split()), _REMARKS.get(group, ""), frame=frame)
    for name in _TIMES.split():
        yield Spelling("time", (name,))
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
    for stems, remark in ((_MATRICES, _TO_SPACE), (_COSINES, _TO_BODY_SHOWS)):
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
