"""The rates of a scene at the rows of an answer: the slopes of a Hermite interpolation."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction

from flint import arb, ctx

from taylor_verify.exact.balls import balls, midpoint
from taylor_verify.exact.enclosure.box import Box
from taylor_verify.exact.enclosure.image import Image
from taylor_verify.exact.event_times import system
from taylor_verify.numbers.irrational import ball
from taylor_verify.numbers.precision import exact_value
from taylor_verify.numbers.rotation import conjugate, product
from taylor_verify.records.faults import refusal
from taylor_verify.records.quantities import COLUMNS, MOMENTA
from taylor_verify.scenes.loads.states import Held
from taylor_verify.scenes.reading.event import loads_of
from taylor_verify.scenes.scene import Scene

_BITS = 106


def slopes_of(
    scene: Scene,
    names: Sequence[str],
    times: Sequence[Fraction],
    rows: Sequence[Sequence[Fraction]],
) -> list[list[Fraction]]:
    """Return the rate of each column at every row, by the equations of the scene."""
    loads = replace(loads_of(scene), functions=tuple(names))
    elapsed = [time - scene.clock.start for time in times]
    rates = system(scene, loads, max(elapsed, key=abs), orders=1)
    needed = _state_columns(scene, rates.size)
    if rates.begin is not None:
        mend = "slopes by its equations would need the rates of these texts"
        raise refusal("linear or cubic for a rotor of texts", "hermite", "interpolation", mend)
    if missing := [column for column in needed if column not in names]:
        expected = "a column for each state of the scene, as hermite takes slopes by its equations"
        raise refusal(expected, f"none for {' '.join(missing)}", "interpolation")
    slopes = []
    with ctx.workprec(_BITS):
        for time, row in zip(elapsed, rows, strict=True):
            by_name = dict(zip(names, row, strict=True))
            point = [ball(by_name[column]) for column in needed]
            turned = _since_start(scene, point)
            functions = rates.pieces(time, time >= 0).functions
            assert functions is not None
            values = Image(functions, Box.about(turned), time).outputs().values
            slopes.append([exact_value(midpoint(value)) for value in values[len(names) :]])
    return slopes


def _state_columns(scene: Scene, size: int) -> list[str]:
    """The columns of a state of this size: of the body, then the frame, then own states, held ones last."""
    columns = [column for group in MOMENTA[scene.model] for column in COLUMNS[group]]
    states = sorted(scene.own_states, key=lambda state: isinstance(state, Held))
    own = [column for state in states for column in state.components]
    frame = size - len(columns) - len(own)
    if frame:
        columns += COLUMNS["quaternion"]
    if frame > len(COLUMNS["quaternion"]):
        columns += COLUMNS["centre"]
    return [*columns, *own]


def _since_start(scene: Scene, point: list[arb]) -> list[arb]:
    """The point with the quaternion since the start in place of the quaternion."""
    body = len(scene.initial.moving)
    if len(point) < body + 4:
        return point
    start = balls(scene.initial.attitude)
    length = sum((entry * entry for entry in start), arb(0)).sqrt()
    turn = product(conjugate(start), point[body : body + 4])
    return [*point[:body], *(entry / length for entry in turn), *point[body + 4 :]]
