"""A problem: one scene's equations and data on one rung, as a solver receives them.

The data are rounded once, in such a way that the rounded problem is still an exact body. The rounded data
that a solver receives are stored as the scene `given`, in exact numbers. The truth starts from `given`, so
that an error comes from the solver and never from the data.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from itertools import chain
from typing import Any, NoReturn

import numpy as np

from taylor_verify.models import own, written
from taylor_verify.models.acting import Acting
from taylor_verify.models.evaluated import wheels
from taylor_verify.models.fewest_operations import Choice, constant_states_sentence
from taylor_verify.models.form import Equations, Form
from taylor_verify.models.frame import unit_quaternion
from taylor_verify.models.letters import counted, each, named, numbers_of
from taylor_verify.models.registry import mechanics, natural_units
from taylor_verify.models.rounding import NotRepresentable as NotRepresentable
from taylor_verify.models.rounding import Rounding, distinct_times
from taylor_verify.models.units import Units
from taylor_verify.models.written import Written
from taylor_verify.numbers import tensors
from taylor_verify.numbers.precision import Rung
from taylor_verify.numbers.tensors import ZERO_VECTOR, Vector
from taylor_verify.scenes.bodies import Body
from taylor_verify.scenes.doubles import within_doubles
from taylor_verify.scenes.instants import Instants
from taylor_verify.scenes.loads.loads import Loads, Piece
from taylor_verify.scenes.loads.states import Instant
from taylor_verify.scenes.loads.steps import NoStep
from taylor_verify.scenes.motion import Clock, State
from taylor_verify.scenes.scene import Scene


@dataclass(frozen=True, eq=False)
class Problem:
    """Question to a solver: equations, parameters, initial state and times, all on one rung.

    Problems are compared by identity, so that results can be cached by problem.

    Most solvers need only ``given``: the body, the start (``given.initial.omega``) and the instants, in
    the scene's own units. ``parameters``, ``initial_momenta`` and ``times`` (elapsed since the initial
    state) are the same data as exact numbers of the rung, in ``units`` and in the order of ``form``. The
    states of the form are momenta: I omega (not omega), or both impulses; then the attitude and the
    centre if they are tracked. ``replaced`` are coefficients of the body that the equations replace by
    others. ``because`` says which equations were chosen, and why. Under loads that a scene writes down the
    form is that of one piece of time, the first unless ``pieces`` made the problem; ``begin`` is where it
    starts, elapsed and in ``units``. ``held`` are the held values of the scene's own states before the
    first instant, in the scene's units.
    """

    scene: Scene
    rung: Rung
    form: Form
    units: Units
    parameters: tuple[Fraction, ...]
    initial_momenta: tuple[Fraction, ...]
    times: Sequence[Fraction]
    given: Scene
    replaced: tuple[tuple[str, Fraction], ...] = ()
    because: tuple[str, ...] = ()
    begin: Fraction = Fraction(0)
    held: Vector = ()

    @property
    def initial(self) -> NoReturn:
        """Raise AttributeError with the names of the two attributes that hold a start."""
        raise AttributeError(
            "expected problem.given.initial (omega or the impulses, in the scene's units) or "
            "problem.initial_momenta (I omega or the impulses, in problem.units), got problem.initial"
        )

    @property
    def parameter(self) -> Mapping[str, Fraction]:
        """Coefficients and loads by name, including those that the equations do not use."""
        return {
            **dict(self.replaced),
            **dict(zip(self.form.parameters, self.parameters, strict=True)),
        }

    @property
    def state(self) -> Mapping[str, Fraction]:
        """The initial state by name, in the units of the problem."""
        return dict(zip(self.form.states, self.initial_momenta, strict=True))

    @property
    def switches(self) -> Sequence[Fraction]:
        """The elapsed times at which the loads that the scene writes down become others, sorted.

        They are those between the start and the last sample.
        """
        loads, last = self.given.body.loads, self.given.clock.elapsed[-1]
        switches = () if loads is None else loads.switches
        begin, end = sorted([last, Fraction(0)])
        return [time for time in switches if begin <= time <= end]

    @property
    def instants(self) -> Sequence[Fraction]:
        """The elapsed times at which held states take their values, sorted, both ends included."""
        return [instant.time for instant in self.takings]

    @property
    def held_names(self) -> tuple[str, ...]:
        """The names in the form of all held values."""
        loads = self.given.body.loads
        return () if loads is None else tuple(own.HELD + name for name in loads.held_values)

    @cached_property
    def takings(self) -> Sequence[Instant]:
        """The instants, each with what is taken there."""
        loads, clock = self.given.body.loads, self.given.clock
        return () if loads is None else loads.instants(clock.elapsed[-1])

    def loads(self, t: Any, state: Any, held: Any = None, piece: int | None = None) -> Any:
        """Return the loads that the scene writes down, body axes: the moment (3), or force and couple (6).

        ``t`` is the scene's time; ``state`` is omega, or x and y; then q0..q3 (body to space) and the
        centre where they are tracked or a load reads them; then the scene's own continuous states. ``held``
        are all held values. Both are in the scene's order and units. More axes may stand in front, which
        stay. At a switch the loads are those after it, unless a ``piece`` is named: number k is between the
        switches k - 1 and k of ``switches``. A step that ends at a switch asks for the piece it began in:
        else its last stage reads the loads after the switch, and its order is lost. Raises ValueError where
        the scene writes no loads, for a piece that there is not, and for a state or held values too short.
        """
        return self._acting.loads(t, state, held, self._inside(piece))

    def rotor(self, t: Any, state: Any, piece: int | None = None) -> Any:
        """Return the momentum of the wheels (3), body axes; arguments as in `loads`."""
        body = self.given.body
        if body.loads is not None and not body.loads.rotor:
            constant = np.array(body.parts().get("rotor", (0, 0, 0)), dtype=float)
            return np.broadcast_to(constant, (*np.shape(state)[:-1], 3)).copy()
        return self._acting.rotor(t, state, self._inside(piece))

    def rates(self, t: Any, state: Any, held: Any = None, piece: int | None = None) -> Any:
        """Return the rates of the scene's own continuous states; arguments as in `loads`."""
        return self._acting.rates(t, state, held, self._inside(piece))

    def _inside(self, piece: int | None) -> Fraction | None:
        """Return an elapsed time inside a piece, or at its begin where it has no length."""
        if piece is None:
            return None
        begin, end = sorted([self.given.clock.elapsed[-1], Fraction(0)])
        edges = [begin, *self.switches, end]
        if not 0 <= piece < len(edges) - 1:
            raise ValueError(f"expected a piece from 0 to {len(edges) - 2}, got {piece}")
        return (edges[piece] + edges[piece + 1]) / 2

    def taken(self, k: int, state: Any, held: Any) -> Any:
        """Return all held values after instant k, of a state and the held values before it.

        All that are taken at one instant read what was before it. Raises ValueError for an instant that
        there is not, and for a state or held values too short.
        """
        if not 0 <= k < len(self.takings):
            raise ValueError(f"expected an instant from 0 to {len(self.takings) - 1}, got {k}")
        return self._acting.taken(self.takings[k], state, held)

    @cached_property
    def _acting(self) -> Acting:
        loads = self.given.body.loads
        if loads is None:
            raise ValueError("expected a scene that writes loads down, got constant ones or none")
        return Acting(self.given, loads)

    def with_equations(self, equations: Equations) -> Problem:
        """Return the same data with other equations in the same states, for the negative controls."""
        own = self.form.equations
        equations = replace(own, free=equations) if isinstance(own, Written) else equations
        form = replace(self.form, equations=equations, parameters=tuple(self.parameter))
        entering = form.entering()
        values = tuple(self.parameter[name] for name in entering)
        return replace(self, form=replace(form, parameters=entering), parameters=values)


def pose(scene: Scene, rung: Rung) -> Problem:
    """Round the scene onto a rung and build the equations it requires.

    Raises NotRepresentable if the rounded data are no valid body or sample times coincide.
    """
    with within_doubles(scene, NotRepresentable):
        return _posed(scene, rung)


def _posed(scene: Scene, rung: Rung) -> Problem:
    units = natural_units(scene)
    times = distinct_times(scene.clock, units, rung)
    start, unit = scene.clock.start, units.time
    clock = Clock(start, Instants(len(times), lambda k: start + times[k] * unit))
    data = _rounded_data(scene, units, Rounding(rung))
    loads = _rounded_loads(scene, rung)
    data = _with_frame(data, own.framed(scene.track, loads), units, rung)
    choice = data.choice
    form = choice.form(data.states)
    posed = Problem(
        scene=scene,
        rung=rung,
        form=form,
        units=units,
        parameters=tuple(choice.numbers[name] for name in form.parameters),
        initial_momenta=tuple(choice.numbers[name] for name in form.states),
        times=times,
        given=replace(scene, body=data.body.with_loads(loads), initial=data.initial, clock=clock),
        replaced=tuple((n, v) for n, v in choice.replaced.items() if n not in form.parameters),
        because=choice.because + constant_states_sentence(data.states, form),
    )
    if loads is None:
        return posed
    try:
        return _with_loads(posed, data, loads)
    except NoStep as fault:
        raise NotRepresentable(str(fault)) from None


def _rounded_loads(scene: Scene, rung: Rung) -> Loads | None:
    """Return the loads that a scene writes down, every number of them rounded once to the rung."""
    if scene.body.loads is None:
        return None
    try:
        loads = scene.body.loads.on_rung(rung)
        return replace(loads, current=Rounding(rung).each(loads.current))
    except (OverflowError, ValueError) as error:
        raise NotRepresentable(str(error)) from error


def _with_loads(problem: Problem, data: _Data, loads: Loads) -> Problem:
    """Return the problem under the loads of the first piece of time; all components are states."""
    data = _with_own(data, loads, problem.units, problem.rung)
    # The loads need the general coefficients, even if the shorter equations do not.
    numbers = {**numbers_of(data.body, problem.units), **data.choice.numbers}
    names = tuple(name for name, value in numbers.items() if value and name not in data.states)
    return in_piece(
        replace(
            problem,
            given=replace(problem.given, initial=data.initial),
            held=own.held_starts(loads),
            form=Form(data.choice.equations, data.states, names),
            parameters=tuple(numbers[name] for name in names),
            initial_momenta=tuple(numbers[name] for name in data.states),
            replaced=tuple(data.choice.replaced.items()),
            because=data.choice.because + written.sentences(loads),
        ),
        loads.piece(Fraction(0), is_later=problem.times[-1] > 0),
    )


def _with_own(data: _Data, loads: Loads, units: Units, rung: Rung) -> _Data:
    """Return the same with the scene's own continuous states, and their wheels in the momentum H.

    H is rounded with the wheels in it, and the motion begins with the omega that it leaves to the body.
    """
    names = tuple(own.in_form(name, loads) for name in loads.continuous)
    starts = [start / unit for start, unit in zip(own.starts(loads), units.own, strict=True)]
    numbers = {**data.choice.numbers, **dict(zip(names, starts, strict=True))}
    initial = data.initial
    if loads.rotor:
        turning = wheels(loads, Fraction(0), own.starts(loads), rung.bits)
        moving = []
        for i, h in enumerate(turning, start=1):
            H = Rounding(rung)(numbers[f"H{i}"] + h / units.momentum)
            numbers[f"H{i}"] = H
            moving.append(H * units.momentum - h)
        change = mechanics(data.body).change(data.body)
        initial = initial.with_moving(change.moving(tuple(moving)))
    return replace(
        data,
        states=(*data.states, *names),
        choice=replace(data.choice, numbers=numbers),
        initial=initial,
    )


def in_piece(problem: Problem, piece: Piece) -> Problem:
    """Return the problem with the equations of a piece of time of its loads."""
    loads = problem.given.body.loads
    assert loads is not None
    equations = problem.form.equations
    body = equations.free if isinstance(equations, Written) else equations
    centre = problem.given.initial.parts().get("centre", ZERO_VECTOR)
    acting, steps = written.counted(body, loads, piece, problem.units, centre)
    numbers = {n: v for n, v in problem.parameter.items() if n[0] != "g"} | dict(steps)
    numbers |= written.drift(loads.current, problem.units) | own.numbers(loads, problem.held)
    form = Form(acting, problem.form.states, tuple(numbers))
    form = replace(form, parameters=form.entering())
    return replace(
        problem,
        form=form,
        parameters=tuple(numbers[name] for name in form.parameters),
        replaced=tuple((n, v) for n, v in numbers.items() if n not in form.parameters),
    )


def pose_as_stored(scene: Scene, rung: Rung) -> Problem:
    """Return the problem of a solver that stores I and omega0, as physics engines do.

    I and omega0 are rounded to the rung, and so are the 21 coefficients and x, y of a solid in a fluid.
    I^-1 is exact, because its computation belongs to the solver. Everything else is as in `pose`. Raises
    NotRepresentable if the rounded data are no valid body.
    """
    posed = pose(scene, rung)
    body, initial = _stored(scene, Rounding(rung), posed.given.body.loads)
    return replace(posed, given=replace(posed.given, body=body, initial=initial))


def adopt(scene: Scene, rung: Rung, instants: Sequence[Fraction]) -> Problem:
    """Return the problem that an answer from another program solves, at the times of its rows.

    The data are rounded as in `pose_as_stored`, and the instants are exact. Raises NotRepresentable if the
    rounded data are no valid body.
    """
    clock = Clock(scene.clock.start, instants)
    if scene.body.loads is not None:
        loads = scene.body.loads.reaching(clock.elapsed[-1])
        scene = replace(scene, body=scene.body.with_loads(loads))
    posed = pose_as_stored(scene, rung)
    return replace(
        posed,
        scene=replace(scene, clock=clock),
        times=Instants(len(instants), lambda k: clock.elapsed[k] / posed.units.time),
        given=replace(posed.given, clock=clock),
    )


def _stored(scene: Scene, rounded: Rounding, loads: Loads | None) -> tuple[Body, State]:
    """Return body and initial state, with each number rounded once; those of the loads are already."""
    start = scene.initial.changed(rounded.part)
    body = scene.body.changed(rounded.part).with_loads(loads)
    if not tensors.is_positive_definite(body.energy_matrix):
        raise NotRepresentable(
            f"rounded to {rounded.rung.name}, {body.ENERGY} is not positive definite"
        )
    return body, start


@dataclass(frozen=True)
class _Data:
    """Equations with rounded numbers, the names of the states, and the exact body and start."""

    choice: Choice
    states: tuple[str, ...]
    body: Body
    initial: State


def _rounded_data(scene: Scene, units: Units, rounded: Rounding) -> _Data:
    """Form coefficients, loads and momenta exactly and round each once; all else follows exactly."""
    body, start = scene.body, scene.initial
    kind = mechanics(body)
    exact = kind.change(body).momentum(start.moving)
    vectors = {
        momentum_part.name: exact[3 * k : 3 * k + 3] for k, momentum_part in enumerate(kind.momenta)
    }
    values = counted(kind.body_letters, kind.values(body), units, rounded)
    momenta = counted(kind.momenta, vectors, units, rounded)
    try:
        given = kind.body(each(kind.body_letters, values, units.physical))
    except ValueError as error:
        raise NotRepresentable(f"rounded to {rounded.rung.name}, {error}") from error
    momentum = tuple(chain(*each(kind.momenta, momenta, units.physical).values()))
    place = {
        part.name: units.physical(part, rounded.counted(part, start.part(part), units))
        for part in start.PARTS
        if part.name not in start.MOVING
    }
    initial = start.with_parts(place).with_moving(kind.change(given).moving(momentum))
    numbers = named(kind.momenta, momenta) | named(kind.body_letters, values)
    return _Data(kind.choice(numbers, rounded.rung), kind.states, given, initial)


def _with_frame(data: _Data, track: Collection[str], units: Units, rung: Rung) -> _Data:
    """Return the same with attitude and centre among the states, as far as they are tracked."""
    frame: dict[str, Fraction] = {}
    if "attitude" in track:
        quaternion = unit_quaternion(data.initial.attitude, rung)
        frame |= {f"e{i}": entry for i, entry in enumerate(quaternion)}
    if "centre" in track:
        # The centre is integrated from the origin and its start added exactly afterwards.
        frame |= dict.fromkeys(("c1", "c2", "c3"), Fraction(0))
    states = (*data.states, *frame)
    if "centre" in track:
        frame["s"] = 1 / units.path
    choice = replace(data.choice, numbers={**data.choice.numbers, **frame})
    return replace(data, states=states, choice=choice)
