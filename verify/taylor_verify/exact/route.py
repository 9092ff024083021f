"""The route to the truth of a scene: a closed form where there is one, else Taylor."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from fractions import Fraction
from typing import Final, final

from taylor_verify.exact.balls import Enclosed
from taylor_verify.exact.damping import NOT_QUADRATIC, Damped, is_solved
from taylor_verify.exact.registry import function_at, kind_of
from taylor_verify.exact.solution import NoClosedForm, Quantities, Solution, Unsettled
from taylor_verify.exact.taylor import TaylorSolution
from taylor_verify.exact.written import as_written
from taylor_verify.numbers.irrational import Undecided
from taylor_verify.records.faults import brief
from taylor_verify.scenes.motion import Motion
from taylor_verify.scenes.scene import Scene

# Two doublings of the precision: more are needed only where an integral is hard.
_FEW_PRECISIONS: Final = 3
# Some seconds of work.
_FEW_STEPS: Final = 5_000
# The functions of a closed form by route, in ``closed`` of each kind's room.
_FUNCTIONS: Final[Mapping[str, str]] = {"arb": "enclosed", "mpmath": "closed_form"}
CLOSED_ROUTES: Final = tuple(_FUNCTIONS)


@final
class QuickerSolution(Solution):
    """A closed form with integrals, or Taylor series where the integrals are hard: both in balls.

    The closed form is asked first, whatever the span. For up to 100 instants and 100 digits of the shipped
    scenes it takes at most 0.2 s more than Taylor series on a short span, and on a hundred spans the series
    take twenty times as long and more. But beside a crest of its potential a bead all but stops, and
    its integrals take hundreds of bits, while the motion itself is as easy as any other; and no integral
    is made to more than ten thousand bits. ``route`` is the one that answered last.
    """

    def __init__(self, closed: Enclosed, series: TaylorSolution) -> None:
        self._closed, self._series = closed, series
        self.regime, self.route = closed.regime, closed.route
        self.by_quadrature = closed.by_quadrature

    def motion(self, elapsed: Sequence[Fraction], digits: int) -> Motion:
        """The motion by the closed form at few precisions, else by few steps, else by the closed form."""
        with suppress(Unsettled):
            motion = self._closed.motion(elapsed, digits, _FEW_PRECISIONS)
            self.route = self._closed.route
            return motion
        self.route = self._series.route
        try:
            return self._series.motion(elapsed, digits)
        except Unsettled as doubt:
            partial = doubt
        with suppress(Unsettled):
            motion = self._closed.motion(elapsed, digits)
            self.route = self._closed.route
            return motion
        raise partial

    def evaluate(self, elapsed: Sequence[Fraction], digits: int) -> Quantities:
        """The midpoints of the motion; series lose no digits beside another orbit, where each costs one."""
        if not self.by_quadrature:
            return self.motion(elapsed, digits).quantities
        with suppress(Unsettled):
            return self._series.evaluate(elapsed, digits)
        return self._closed.evaluate(elapsed, digits)


def solution(scene: Scene, route: str | None = None) -> Solution:
    """The exact solution of a scene: balls where every tracked quantity has a closed form, else Taylor.

    With ``route="arb"`` or ``"mpmath"`` only a closed form is accepted, and NoClosedForm is raised
    where it is missing; ``route="taylor"`` takes Taylor series in any case. A closed form is missing too
    where its kind depends on an equality of irrational numbers that is neither proven nor refuted.
    """
    scene = as_written(scene)
    if route == "taylor":
        return TaylorSolution(scene)
    if route in CLOSED_ROUTES:
        return _closed_form(scene, route)
    if route is not None:
        routes = ", ".join((*CLOSED_ROUTES, "taylor"))
        raise ValueError(f"expected a route ({routes}), got {brief(route)}")
    try:
        closed = _closed_form(scene, "arb")
    except NoClosedForm:
        return TaylorSolution(scene)
    if isinstance(closed, Enclosed) and (closed.by_quadrature or closed.by_periods):
        return QuickerSolution(closed, TaylorSolution(scene, _FEW_STEPS))
    return closed


def _closed_form(scene: Scene, route: str) -> Solution:
    if scene.body.damping and scene.body.loads is None:
        return _damped(scene, route)
    module = f"{kind_of(scene.body).room}.closed"
    if scene.body.loads is not None:
        module = "taylor_verify.exact.euler.libration"
    try:
        closed: Solution = function_at(f"{module}:{_FUNCTIONS[route]}")(scene)
    except Undecided as doubt:
        raise NoClosedForm(f"the kind of motion is not decided: {doubt}") from doubt
    return closed


def _damped(scene: Scene, route: str) -> Solution:
    """The closed form of a damped body, by that of the body without damping."""
    if not is_solved(scene):
        raise NoClosedForm(NOT_QUADRATIC)
    return Damped(scene, _closed_form(replace(scene, body=scene.body.undamped), route))
