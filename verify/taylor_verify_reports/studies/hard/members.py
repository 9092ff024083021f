"""Members of the families that are followed for many periods, sampled at the quarters of some of them.

A family is a shipped one whose number d runs over a grid towards an unstable motion, or one shipped scene
of which only the number of periods varies. Near an unstable spin the motion is slow at two of the quarters
and fast at the other two, where errors of the phase show.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property, lru_cache
from typing import Final

from mpmath import mp

from taylor_verify.exact.elements import elements
from taylor_verify.scenes.families.distributions import Grid
from taylor_verify.scenes.families.shipped import family
from taylor_verify.scenes.motion import Clock
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene
from taylor_verify_reports.studies.hard.hard_scenes import ReachFamily

QUARTERS: Final = 4
# Two numbers in each decade, and one for long runs.
PERIODS: Final = (1, 3, 10, 30, 100, 300, 1000, 10_000, 100_000)
# The period only chooses the instants, which need not be exact quarters.
_PERIOD_DIGITS: Final = 12
_START: Final = Fraction(0)


@dataclass(frozen=True)
class Followed:
    """A family, called ``name``, with its ``title`` in words and the most periods of each rung.

    Without a ``scene`` it is the shipped family of that name. With one it is this scene, of which
    ``track`` is followed beside omega or the impulses.
    """

    name: str
    title: str
    most_periods: Mapping[str, int]
    scene: str = ""
    track: tuple[str, ...] = ()

    @cached_property
    def members(self) -> Mapping[str, Scene]:
        """The scene of each value by its text, the easiest first."""
        if self.scene:
            return {"1": replace(load(self.scene), track=frozenset(self.track))}
        shipped = family(self.name)
        (grid,) = (v.rule.values for v in shipped.variables if isinstance(v.rule, Grid))
        texts = (f"{value.normalize():e}".replace("+", "") for value in grid)
        return {text: shipped.scene((), node) for node, text in enumerate(texts)}

    def described(self) -> ReachFamily:
        """Return the family in its stored form."""
        symbol = "" if self.scene else "d"
        return ReachFamily(
            self.name, self.title, symbol, tuple(self.members), dict(self.most_periods)
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


# The most periods in a reasonable time: on f128 a period takes hundreds of times as long as on f64, and
# near an unstable motion of all six impulses the floor takes long to compute.
_REGULAR: Final = {"f32": 100_000, "f64": 100_000, "f80": 10_000, "f128": 100, "mp237": 10}
_WITH_ATTITUDE: Final = {"f64": 10_000, "f80": 1000, "f128": 30, "mp237": 3}
_BESIDE_AXIS: Final = {"f32": 1000, "f64": 1000, "f80": 1000, "f128": 100, "mp237": 3}
_BESIDE_SEPARATRIX: Final = {"f32": 1000, "f64": 1000, "f80": 100, "f128": 10}
_BESIDE_SPIN: Final = {"f32": 30, "f64": 30, "f80": 30, "f128": 10}
_TRIAXIAL: Final = "extremes/euler-start-1e16"

# In the order of the page: many periods; near an unstable motion.
FOLLOWED: Final = (
    Followed("euler-periods", "a triaxial body, omega alone", _REGULAR, _TRIAXIAL),
    Followed(
        "euler-attitude",
        "a triaxial body with its attitude",
        {**_REGULAR, **_WITH_ATTITUDE},
        _TRIAXIAL,
        track=("attitude",),
    ),
    Followed(
        "kirchhoff-periods",
        "Clebsch's body, impulses alone",
        {**_REGULAR, "f64": 10_000, "f80": 1000},
        "extremes/kirchhoff-many-swings",
    ),
    Followed("unstable-axis", "a triaxial body at d beside its unstable axis", _BESIDE_AXIS),
    Followed(
        "separatrix", "a triaxial body, 1 - k^2 = d, from the middle of a flip", _BESIDE_SEPARATRIX
    ),
    Followed("unstable-spin", "Clebsch's body at d beside its unstable spin", _BESIDE_SPIN),
    Followed("homoclinic", "Clebsch's body, y3 off the homoclinic orbit's by d", _BESIDE_SPIN),
)
