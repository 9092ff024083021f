"""Free gyrostats drawn to be hard: the name of a kind and a number remake each of them."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from random import Random
from typing import Final

from builders.free_spins import near_separatrix, rotation, spinning
from builders.gyrostats import MOTIONS, homoclinic, on_circle, turned
from taylor_verify.exact.gyrostat.azimuth import FRAMES
from taylor_verify.exact.gyrostat.pencil import FreeGyrostat
from taylor_verify.numbers import tensors
from taylor_verify.numbers.tensors import Matrix, Vector

Kind = Callable[[Random], FreeGyrostat]


def hostile(kind: str, number: int, seed: int = 1) -> FreeGyrostat:
    """Return a motion of this kind, in its own axes or in turned ones."""
    random = Random(f"{seed} {kind} {number}")
    free = KINDS[kind](random)
    if random.random() < 0.5:
        return free
    return turned(free, rotation(*_some([random.randint(-20, 20) for _ in range(4)])))


# Numbers


def _size(random: Random, lowest: int, highest: int) -> Fraction:
    """A power of ten."""
    return Fraction(10) ** random.randint(lowest, highest)


def _tiny(random: Random) -> Fraction:
    return _size(random, -60, -1)


def _perhaps_tiny(random: Random) -> Fraction:
    return random.choice((Fraction(0), _tiny(random)))


def _some(entries: list[int]) -> list[int]:
    """The entries, or a unit vector where all are zero."""
    return entries if any(entries) else [1, *entries[1:]]


def _vector(random: Random) -> Vector:
    """A vector that is not zero, some of whose components are."""
    x, y, z = _some([random.choice((0, random.randint(-20, 20))) for _ in range(3)])
    return Fraction(x), Fraction(y), Fraction(z)


def _full(random: Random) -> Vector:
    """A vector without a component that is zero."""
    x, y, z = (Fraction(random.choice((-1, 1)) * random.randint(1, 999), 100) for _ in range(3))
    return x, y, z


def _moments(random: Random) -> Matrix:
    """Three different moments of inertia."""
    a, b, c = random.sample(range(1, 40), 3)
    return tensors.diagonal((Fraction(a), Fraction(b), Fraction(c)))


def _axis(number: int) -> Vector:
    x, y, z = (Fraction(number == k) for k in range(3))
    return x, y, z


def _beside(free: FreeGyrostat, random: Random) -> FreeGyrostat:
    """The motion with its wheels, its start or one moment changed by 1e-1 to 1e-60 of their size."""
    tiny, change = _tiny(random), random.randrange(3)
    inertia, rotor, omega = free.inertia, free.rotor, free.omega
    if change == 0:
        rotor = tensors.plus(rotor, tensors.scaled(tiny, _vector(random)))
    elif change == 1:
        omega = tensors.plus(omega, tensors.scaled(tiny, _vector(random)))
    else:
        inertia = tensors.diagonal(
            tuple(inertia[k][k] * (1 + tiny * random.randint(0, 3)) for k in range(3))
        )
    return FreeGyrostat(inertia, rotor, omega)


# Kinds


def _any(random: Random) -> FreeGyrostat:
    rotor, omega = (random.choice((_full, _vector))(random) for _ in range(2))
    return FreeGyrostat(_moments(random), rotor, omega)


def _with_wheels(random: Random) -> FreeGyrostat:
    """Wheels of 10^-30 to 10^30 of the momentum of the body."""
    inertia, omega = _moments(random), _vector(random)
    own = max(map(abs, tensors.apply(inertia, omega)))
    rotor = tensors.scaled(own * _size(random, -30, 30) / 20, _vector(random))
    return FreeGyrostat(inertia, rotor, omega)


def _along_axis(random: Random) -> FreeGyrostat:
    size = Fraction(random.choice((-1, 1)) * random.randint(1, 999), 50)
    rotor = tensors.scaled(size * _size(random, -3, 3), _axis(random.randrange(3)))
    return FreeGyrostat(_moments(random), rotor, _full(random))


def _in_plane(random: Random) -> FreeGyrostat:
    """Wheels in a plane of symmetry, from a start in that plane, near it or anywhere."""
    across = random.randrange(3)
    rotor, omega = (tensors.minus(v, _part(v, across)) for v in (_full(random), _full(random)))
    away = random.choice((Fraction(0), Fraction(1), _tiny(random)))
    omega = tensors.plus(omega, tensors.scaled(away, _axis(across)))
    return FreeGyrostat(_moments(random), rotor, omega)


def _part(v: Vector, k: int) -> Vector:
    return tensors.scaled(v[k], _axis(k))


def _two_equal(random: Random) -> FreeGyrostat:
    """Two moments equal or nearly so, with wheels along the third's axis, nearly so, across or oblique."""
    a, c = (Fraction(n) for n in random.sample(range(1, 40), 2))
    axis = random.randrange(3)
    moments = [a, a, a]
    moments[axis], moments[axis - 1] = c, a * (1 + _perhaps_tiny(random))
    rotor = _full(random)
    along = _part(rotor, axis)
    across = tensors.minus(rotor, along)
    nearly = tensors.plus(along, tensors.scaled(_tiny(random), across))
    rotor = random.choice((rotor, along, nearly, across))
    return FreeGyrostat(tensors.diagonal(tuple(moments)), rotor, _vector(random))


def _three_equal(random: Random) -> FreeGyrostat:
    """Three moments equal, or all but so."""
    moments = tuple(1 + _perhaps_tiny(random) * random.randint(0, 9) for _ in range(3))
    return FreeGyrostat(tensors.diagonal(moments), _vector(random), _vector(random))


def _steady(random: Random) -> FreeGyrostat:
    inertia, omega = _moments(random), _vector(random)
    whole = tensors.scaled(Fraction(random.randint(-40, 40), 3), omega)
    return FreeGyrostat(inertia, tensors.minus(whole, tensors.apply(inertia, omega)), omega)


def _homoclinic(random: Random) -> FreeGyrostat:
    """A start whose curve has a double point: a separatrix, or a trigonometric motion."""
    return homoclinic(_moments(random), _vector(random), _vector(random))


def _circle(random: Random) -> FreeGyrostat:
    g1, g3 = (Fraction(random.choice((0, random.randint(-30, 30))), n) for n in (7, 5))
    return on_circle(g1, g3, Fraction(random.randint(1, 40), 4))


def _euler_separatrix(random: Random) -> FreeGyrostat:
    """Euler's separatrix, with wheels of 1e-1 to 1e-60 or none."""
    spin = near_separatrix(_perhaps_tiny(random))
    rotor = tensors.scaled(_perhaps_tiny(random), _vector(random))
    return FreeGyrostat(spin.inertia, rotor, spin.omega)


def _middle_axis(random: Random) -> FreeGyrostat:
    """Beside the spin about the middle axis, with wheels along it or all but along it."""
    spin = spinning(tuple(map(Fraction, (1, 2, 3))), tensors.scaled(_tiny(random), _vector(random)))
    wheel = tensors.scaled(Fraction(random.randint(-9, 9), 4), _axis(1))
    rotor = tensors.plus(wheel, tensors.scaled(_tiny(random), _vector(random)))
    return FreeGyrostat(spin.inertia, rotor, tensors.plus(spin.omega, _axis(1)))


def _nearly_at_rest(random: Random) -> FreeGyrostat:
    return FreeGyrostat(
        _moments(random), _vector(random), tensors.scaled(_tiny(random), _vector(random))
    )


def _hardly_any_momentum(random: Random) -> FreeGyrostat:
    """The wheels all but cancel the momentum of the body: |H| is 1e-1 to 1e-60 of it, or 0."""
    inertia, omega = _moments(random), _vector(random)
    left = tensors.scaled(_perhaps_tiny(random), _vector(random))
    return FreeGyrostat(inertia, tensors.minus(left, tensors.apply(inertia, omega)), omega)


def _needle(random: Random) -> FreeGyrostat:
    """Moments up to 1e20 apart."""
    moments = tuple(_size(random, -10, 10) * random.randint(1, 9) for _ in range(3))
    return FreeGyrostat(tensors.diagonal(moments), _full(random), _full(random))


def _units(random: Random) -> FreeGyrostat:
    """Any of the other kinds in units of mass and time of 1e-100 to 1e100."""
    free = KINDS[random.choice([kind for kind in KINDS if kind != "strange units"])](random)
    mass, pace = _size(random, -100, 100), _size(random, -100, 100)
    return FreeGyrostat(
        tuple(tensors.scaled(mass, row) for row in free.inertia),
        tensors.scaled(mass * pace, free.rotor),
        tensors.scaled(pace, free.omega),
    )


def _through_a_frame(random: Random) -> FreeGyrostat:
    """The whole momentum starts along an axis of a frame of the azimuth, or all but so."""
    inertia, omega = _moments(random), _full(random)
    axis = random.choice(random.choice(FRAMES)).c
    whole = tensors.scaled(Fraction(random.randint(1, 30)), axis)
    whole = tensors.plus(whole, tensors.scaled(_perhaps_tiny(random), _full(random)))
    return FreeGyrostat(inertia, tensors.minus(whole, tensors.apply(inertia, omega)), omega)


KINDS: Final[dict[str, Kind]] = {
    "any": _any,
    "wheels of any strength": _with_wheels,
    "wheels along an axis": _along_axis,
    "wheels in a plane": _in_plane,
    "two equal moments": _two_equal,
    "three equal moments": _three_equal,
    "steady": _steady,
    "nearly steady": lambda random: _beside(_steady(random), random),
    "double point": _homoclinic,
    "beside a double point": lambda random: _beside(_homoclinic(random), random),
    "cusp": lambda _: MOTIONS["cusp"],
    "beside a cusp": lambda random: _beside(MOTIONS["cusp"], random),
    "circle": _circle,
    "beside a circle": lambda random: _beside(_circle(random), random),
    "Euler's separatrix": _euler_separatrix,
    "beside the middle axis": _middle_axis,
    "nearly at rest": _nearly_at_rest,
    "hardly any momentum": _hardly_any_momentum,
    "moments far apart": _needle,
    "momentum through an axis of a frame": _through_a_frame,
    "strange units": _units,
}
