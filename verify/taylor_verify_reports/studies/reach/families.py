"""Families of scenes: one number is pushed to an extreme, everything else stays.

    d   distance of a start from an unstable spin, or of an orbit from the separatrix
    e   a gap: between two moments of inertia, or between the energy T and a singular one
    F   size of the linear impulse
    R   a ratio of moments of inertia or of masses
    S   a scale

Every scene is made of exact rationals. Its samples are at the quarters of some periods. Near an unstable
spin the motion is slow at two of the quarters and fast at the other two, where errors of the phase show.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import lru_cache
from math import isqrt
from typing import Final

from mpmath import mp

from taylor_verify.exact.elements import elements
from taylor_verify.scenes import tensors
from taylor_verify.scenes.bodies import Clebsch, RigidBody
from taylor_verify.scenes.motion import Clock, Impulse, Spin
from taylor_verify.scenes.scene import Scene
from taylor_verify_reports.studies.reach.document import ReachFamily

# Rationals, or one text of rationals with spaces between.
Numbers = tuple[Fraction | int, ...] | str

QUARTERS: Final = 4
# Two numbers in each decade, and one for long runs.
PERIODS: Final = (1, 3, 10, 30, 100, 300, 1000, 10_000, 100_000)
# The period only chooses the instants, which need not be exact quarters.
_PERIOD_DIGITS: Final = 12
_START: Final = Fraction(0)

# The most periods in a reasonable time: on f128 a period takes hundreds of times as long as on f64.
_MOST_PERIODS: Final = {"f32": 1000, "f64": 1000, "f80": 100, "f128": 10}
# Near an unstable motion of all six impulses the floor takes long to compute.
_MOST_BESIDE_UNSTABLE_SPIN: Final = {"f32": 30, "f64": 30, "f80": 30, "f128": 10}
# A period has 1/e turns, and the driver allows steps of some hundred turns at most.
_MOST_NEAR_SPHERE: Final = {"f32": 10, "f64": 10, "f80": 3, "f128": 1}
_MOST_BESIDE_UNSTABLE_AXIS: Final = {"f32": 1000, "f64": 1000, "f80": 1000, "f128": 100, "mp237": 3}
_MOST_OF_REGULAR_ORBITS: Final = {
    "f32": 100_000,
    "f64": 100_000,
    "f80": 10_000,
    "f128": 100,
    "mp237": 10,
}


@dataclass(frozen=True)
class Family:
    """Scenes that depend on one number, called ``symbol``; ``values`` are its texts, the easiest first.

    ``extreme`` names the limit of the family. Values are decimals with an exponent. In a family of one
    value only the number of periods varies. ``make`` returns the scene of a value. ``most_periods`` has the
    most periods by rung, for the rungs on which the family is run.
    """

    name: str
    title: str
    symbol: str
    extreme: str
    values: tuple[str, ...]
    make: Callable[[Fraction], Scene]
    most_periods: Mapping[str, int] = field(default_factory=lambda: _MOST_PERIODS)

    def scene(self, value: str) -> Scene:
        """Return the scene of this value; its only sample is the start."""
        return replace(self.make(Fraction(value)), name=self.label(value), title=self.title)

    def label(self, value: str) -> str:
        """Return the name of the scene of this value."""
        return f"{self.name} {self.symbol} = {value}" if self.symbol else self.name

    def described(self) -> ReachFamily:
        """Return the family in its stored form."""
        return ReachFamily(
            name=self.name,
            title=self.title,
            symbol=self.symbol,
            extreme=self.extreme,
            values=self.values,
            rungs=dict(self.most_periods),
        )

    def periods(self, rung: str) -> tuple[int, ...]:
        """Return the numbers of periods after which errors are measured on a rung."""
        return tuple(count for count in PERIODS if count <= self.most_periods[rung])


def at_quarters(scene: Scene, periods: Sequence[int]) -> Scene:
    """Return the scene with samples at the quarters of the n-th period, for every n of ``periods``.

    Raises ValueError for a scene without a period.
    """
    period = period_of(scene)
    instants = [
        (n - 1 + Fraction(quarter, QUARTERS)) * period
        for n in periods
        for quarter in range(1, QUARTERS + 1)
    ]
    return replace(scene, clock=Clock(_START, tuple(instants)))


@lru_cache(maxsize=64)
def period_of(scene: Scene) -> Fraction:
    """Return the period of omega or the impulses, to a dozen digits, in the scene's unit of time.

    Raises ValueError for a scene without a period.
    """
    values = elements(scene)
    if "period" not in values:
        raise ValueError(f"expected a periodic orbit, got a {values.regime} one @ {scene.name}")
    return Fraction(mp.nstr(values["period"].value, _PERIOD_DIGITS))


def family_named(name: str) -> Family:
    """Return the family of this name. Raises ValueError for an unknown name."""
    families = {family.name: family for family in FAMILIES}
    if name not in families:
        raise ValueError(f"expected one of the families {', '.join(families)}, got {name!r}")
    return families[name]


# The families. Their starts are those of the scenes of cases/extremes.


def _euler(moments: Numbers, omega: Numbers, *track: str) -> Scene:
    body = RigidBody(tensors.diagonal(_exact(moments)))
    spin, clock = Spin(_exact(omega)), Clock(_START, (_START,))
    return Scene("", "", "euler", frozenset(track), body, spin, clock)


def _kirchhoff(six: Numbers, linear: Numbers, angular: Numbers) -> Scene:
    body = Clebsch(*_exact(six)).body()
    start, clock = Impulse(_exact(linear), _exact(angular)), Clock(_START, (_START,))
    return Scene("", "", "kirchhoff", frozenset(), body, start, clock)


def _exact(numbers: Numbers) -> tuple[Fraction, ...]:
    parts = numbers.split() if isinstance(numbers, str) else numbers
    return tuple(map(Fraction, parts))


def _decades(first: int, last: int, step: int) -> tuple[str, ...]:
    """Return 1e-2, 1e-4, ... as texts, both ends included."""
    beyond = last + (1 if step > 0 else -1)
    return tuple(f"1e{exponent}" for exponent in range(first, beyond, step))


# Coefficients p p' q q' r r' of Clebsch's body.
_STABLE: Final = "1 2 0 1/10 1 1/2"
# Its unstable spin grows: A = 29/16 in Hydromechanics 49 (25).
_UNSTABLE: Final = "1 5/4 0 1/4 1 1/2"

# In the order of the page: many periods; near a separatrix; nearly equal, very unequal and large numbers.
FAMILIES: Final = (
    Family(
        "euler-periods",
        "a triaxial body, omega alone",
        symbol="",
        extreme="many periods",
        values=("1",),
        make=lambda _: _euler("1 2 3", "3/10 1 1/5"),
        most_periods=_MOST_OF_REGULAR_ORBITS,
    ),
    Family(
        "euler-attitude",
        "a triaxial body with its attitude",
        symbol="",
        extreme="many periods",
        values=("1",),
        make=lambda _: _euler("1 2 3", "3/10 1 1/5", "attitude"),
        most_periods={
            **_MOST_OF_REGULAR_ORBITS,
            "f64": 10_000,
            "f80": 1000,
            "f128": 30,
            "mp237": 3,
        },
    ),
    Family(
        "kirchhoff-periods",
        "Clebsch's body, impulses alone",
        symbol="",
        extreme="many periods",
        values=("1",),
        make=lambda _: _kirchhoff(_STABLE, "3/10 1/5 1", "2/5 -1/2 1"),
        most_periods={**_MOST_OF_REGULAR_ORBITS, "f64": 10_000, "f80": 1000},
    ),
    Family(
        "unstable-axis",
        "a triaxial body at d beside its unstable axis",
        symbol="d",
        extreme="the axis itself",
        values=_decades(-2, -40, -2),
        make=lambda d: _euler("1 2 3", (d, 1, 0)),
        most_periods=_MOST_BESIDE_UNSTABLE_AXIS,
    ),
    Family(
        # The start is half-way between two flips of the unstable spin, where omega2 is zero.
        "separatrix",
        "a triaxial body, 1 - k^2 = d, from the middle of a flip",
        symbol="d",
        extreme="the separatrix itself",
        values=_decades(-2, -14, -2),
        make=lambda d: _euler("1 4/3 2", (1, 0, Fraction(1, 2) + d / 4)),
    ),
    Family(
        "unstable-spin",
        "Clebsch's body at d beside its unstable spin",
        symbol="d",
        extreme="the spin itself",
        values=_decades(-2, -18, -4),
        make=lambda d: _kirchhoff(_UNSTABLE, (d, 0, Fraction(5, 4)), "0 0 1"),
        most_periods=_MOST_BESIDE_UNSTABLE_SPIN,
    ),
    Family(
        "homoclinic",
        "Clebsch's body, y3 off the homoclinic orbit's by d",
        symbol="d",
        extreme="the orbit itself",
        values=_decades(-2, -14, -4),
        make=lambda d: _kirchhoff(_UNSTABLE, "1 0 3/4", (Fraction(1, 2), Fraction(-1, 2), 1 + d)),
        most_periods=_MOST_BESIDE_UNSTABLE_SPIN,
    ),
    Family(
        "nearly-spherical",
        "moments 1, 1 + e, 1 - e",
        symbol="e",
        extreme="a sphere",
        values=_decades(-2, -6, -1),
        make=lambda e: _euler((1, 1 + e, 1 - e), "3/4 1/2 -5/8"),
        most_periods=_MOST_NEAR_SPHERE,
    ),
    Family(
        "nearly-axisymmetric",
        "moments 1, 1 + e, 2",
        symbol="e",
        extreme="an axis of symmetry",
        values=_decades(-2, -14, -3),
        make=lambda e: _euler((1, 1 + e, 2), "1/2 -1/4 1"),
    ),
    Family(
        "nearly-singular",
        "Clebsch's body with q = 1 - e beside p = r = 1",
        symbol="e",
        extreme="an energy that is none",
        values=_decades(-2, -14, -3),
        make=lambda e: _kirchhoff(
            (1, 2, 1 - e, Fraction(1, 2), 1, Fraction(3, 4)), "1/2 1/4 1", "-1/2 3/4 1/4"
        ),
    ),
    Family(
        "inertia-ratio",
        "moments 1, sqrt R, R, all spins alike",
        symbol="R",
        extreme="unlike moments",
        values=_decades(2, 14, 2),
        make=lambda r: _euler((1, isqrt(int(r)), r), "1 1 1"),
    ),
    Family(
        "thin-rod",
        "a rod, moments 1/R, 1, 1 + 1/R",
        symbol="R",
        extreme="a line",
        values=_decades(2, 14, 3),
        make=lambda r: _euler((1 / r, 1, 1 + 1 / r), "1 1/1000 2/1000"),
    ),
    Family(
        "added-mass",
        "Clebsch's body, p = 1, p' = 1/R",
        symbol="R",
        extreme="a disc without mass",
        values=_decades(2, 14, 3),
        make=lambda r: _kirchhoff((1, 1 / r, 0, 0, 1, 2), "1/2 1/4 1", "1/4 -1/2 1"),
    ),
    Family(
        "small-impulse",
        "Clebsch's body, |x| = F beside y of size 1",
        symbol="F",
        extreme="no linear impulse",
        values=_decades(-2, -32, -6),
        make=lambda f: _kirchhoff(_STABLE, (3 * f / 5, 0, 4 * f / 5), "2/5 -1/2 1"),
    ),
    Family(
        "large-impulse",
        "Clebsch's body, x of size S beside y of size 1",
        symbol="S",
        extreme="no angular impulse",
        values=_decades(2, 20, 3),
        make=lambda s: _kirchhoff(_STABLE, (3 * s / 10, s / 5, s), "2/5 -1/2 1"),
    ),
    Family(
        "mixed-scales",
        "moments of 1/S, omega of S",
        symbol="S",
        extreme="the ends of the range of numbers",
        values=_decades(10, 250, 80),
        make=lambda s: _euler((1 / s, 2 / s, 3 / s), (3 * s / 10, s, s / 5)),
    ),
)
