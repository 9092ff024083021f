"""The route to the truth of a scene: a closed form where there is one, else Taylor."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from fractions import Fraction
from typing import Final, final

from taylor_verify.exact.as_written import as_written
from taylor_verify.exact.balls import Enclosed
from taylor_verify.exact.damping import NOT_QUADRATIC, Damped, is_solved
from taylor_verify.exact.registry import function_at, kind_of
from taylor_verify.exact.solution import NoClosedForm, Solution, Unsettled
from taylor_verify.exact.taylor import TaylorSolution
from taylor_verify.numbers.irrational import Undecided
from taylor_verify.records.faults import brief
from taylor_verify.scenes.motion import Motion
from taylor_verify.scenes.scene import Scene

# Some seconds of work.
_FEW_STEPS: Final = 5_000
# Enough to know whether a motion reaches a time.
_FEW_DIGITS: Final = 3
# The functions of a closed form by route, in ``closed`` of each kind's room.
_FUNCTIONS: Final[Mapping[str, str]] = {"arb": "enclosed", "mpmath": "closed_form"}
CLOSED_ROUTES: Final = tuple(_FUNCTIONS)


@final
class ElseSeries(Solution):
    """A closed form whose periods are integrals, or Taylor series where they are hard: both in balls.

    No integral is made to more than ten thousand bits. ``route`` is the one that answered last.
    """

    def __init__(self, closed: Enclosed, series: TaylorSolution) -> None:
        self._closed, self._series = closed, series
        self.regime, self.route = closed.regime, closed.route

    def motion(self, elapsed: Sequence[Fraction], digits: int) -> Motion:
        with suppress(Unsettled):
            motion = self._closed.motion(elapsed, digits)
            self.route = self._closed.route
            return motion
        self.route = self._series.route
        return self._series.motion(elapsed, digits)


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
    if isinstance(closed, Enclosed) and closed.by_periods:
        return ElseSeries(closed, TaylorSolution(scene, _FEW_STEPS))
    return closed


def end_of_motion(scene: Scene, elapsed: Sequence[Fraction]) -> Unsettled | None:
    """Return the error for a motion under written loads that ends before one of these times; else None."""
    if scene.body.loads is not None:
        try:
            solution(scene).motion(elapsed, _FEW_DIGITS)
        except Unsettled as doubt:
            return doubt if doubt.is_end else None
    return None


def _closed_form(scene: Scene, route: str) -> Solution:
    if scene.body.damping and scene.body.loads is None:
        return _damped(scene, route)
    module = f"{kind_of(scene.body).room}.closed"
    if scene.body.loads is not None:
        module = "taylor_verify.exact.euler.libration"
    try:
        closed: Solution | None = function_at(f"{module}:{_FUNCTIONS[route]}")(scene)
    except Undecided as doubt:
        raise NoClosedForm(f"the kind of motion is not decided: {doubt}") from doubt
    if closed is None:
        _closed_form(scene, "arb")
        raise NoClosedForm("in mpmath, where this motion has none: its routes are arb and taylor")
    return closed


def _damped(scene: Scene, route: str) -> Solution:
    """The closed form of a damped body, by that of the body without damping."""
    if not is_solved(scene):
        raise NoClosedForm(NOT_QUADRATIC)
    return Damped(scene, _closed_form(replace(scene, body=scene.body.undamped), route))
