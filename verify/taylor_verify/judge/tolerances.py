"""Tolerances of a caller, which replace the bounds that follow from the arithmetic.

A tolerance is a relative error, or radians for an attitude. It is below 1: the answer zero has an error of
1, so a larger tolerance would forbid nothing.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

from taylor_verify.records.faults import brief
from taylor_verify.records.quantities import SOUND_ATTITUDE, states_among
from taylor_verify.scenes.reading.positive import positive

if TYPE_CHECKING:
    from taylor_verify.scenes.scene import Scene

Tolerance = float | Mapping[str, float] | None
"""A caller's tolerance: one number for all quantities, or a number for each named quantity."""

_EXPECTED: Final = "a positive number below 1 (the error of the answer zero)"


@dataclass(frozen=True)
class Tolerances:
    """Tolerances: one for ``every`` quantity, or one for ``each`` named quantity.

    Quantities without a tolerance keep the bounds from the arithmetic.
    """

    every: float | None = None
    each: tuple[tuple[str, float], ...] = ()

    def of(self, quantity: str) -> float | None:
        """Return the tolerance of a quantity; None if the bound from the arithmetic applies.

        The length of a quaternion, and a matrix that is no rotation, have the tolerance of the attitude.
        """
        name = "attitude" if quantity in SOUND_ATTITUDE else quantity
        return dict(self.each).get(name, self.every)

    @property
    def text(self) -> str | None:
        """The tolerances as `--tolerance` takes them; None without a tolerance."""
        if self.every is not None:
            return repr(self.every)
        return ",".join(f"{name}={value!r}" for name, value in self.each) or None


NO_TOLERANCES: Final = Tolerances()


def tolerances(
    asked: Tolerances | Tolerance, scenes: Iterable[Scene] | None, place: str = "tolerance"
) -> Tolerances:
    """Return the tolerances that a caller ``asked`` for, checked against some scenes.

    Tolerances are returned unchanged. Raises ValueError, with every fault and its ``place``, for a name
    that is not a quantity of these scenes and for a tolerance that is not a positive number below 1. Of
    scenes that are not known, None, any name is a quantity.
    """
    if isinstance(asked, Tolerances):
        return asked
    if asked is None:
        return NO_TOLERANCES
    if not isinstance(asked, Mapping):
        return Tolerances(every=_tolerance(asked, place))
    known, faults = [*asked] if scenes is None else _quantities(scenes), []
    unknown = [str(name) for name in asked if name not in known]
    if unknown or not asked:
        received = ", ".join(unknown) or "nothing"
        faults.append(f"expected some of {', '.join(known)}, got {received} @ {place}")
    each: dict[str, float] = {}
    for name, value in asked.items():
        try:
            each[str(name)] = _tolerance(value, f"{place} {name}")
        except ValueError as error:
            faults.append(str(error))
    if faults:
        raise ValueError("\n".join(faults))
    return Tolerances(each=tuple(sorted(each.items())))


def _tolerance(value: Any, place: str) -> float:
    number = positive(value, place, _EXPECTED)
    if not number < 1:
        raise ValueError(f"expected {_EXPECTED}, got {brief(value)} @ {place}")
    return number


def _quantities(scenes: Iterable[Scene]) -> list[str]:
    """Return the quantities that are compared in at least one of these scenes, states first."""
    from taylor_verify.exact.invariants import invariants
    from taylor_verify.judge.errors.laws import laws_of

    asked = list(scenes)
    states = {quantity.name for scene in asked for quantity in scene.tracked}
    if "impulse" in states:
        # A file about a solid in a fluid may have its velocities.
        states |= {"velocity", "omega"}
    laws = {name for scene in asked for name in laws_of(scene)}
    conserved = dict.fromkeys(invariant.name for scene in asked for invariant in invariants(scene))
    return [*states_among([*sorted(states), *sorted(laws)]), *conserved]
