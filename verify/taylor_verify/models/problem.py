"""A problem: one scene's equations and data on one rung, as a solver receives them.

The data are rounded once, in such a way that the rounded problem is still an exact body. What a
solver received is kept as a scene of its own, `given`, in exact numbers: the truth starts from it,
so that an error is the solver's and never the data's.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import chain
from math import isqrt, lcm
from typing import NoReturn

from taylor_verify.models import manufactured
from taylor_verify.models.choice import Choice, constants_told
from taylor_verify.models.form import Equations, Form
from taylor_verify.models.mechanics import components
from taylor_verify.models.registry import mechanics, natural_units
from taylor_verify.models.times import are_distinct, rounded_times
from taylor_verify.models.units import Units
from taylor_verify.scenes import tensors
from taylor_verify.scenes.bodies import Body
from taylor_verify.scenes.instants import Instants
from taylor_verify.scenes.manufactured import Manufactured, Wave
from taylor_verify.scenes.motion import IDENTITY, Clock, Quaternion, State
from taylor_verify.scenes.parts import Part, Shape, Value, entrywise
from taylor_verify.scenes.precision import Rung, floor_log2
from taylor_verify.scenes.scene import Scene
from taylor_verify.scenes.tensors import Vector


class NotRepresentable(Exception):
    """The rung cannot hold this scene as a body with distinct sample times; the text says why."""


@dataclass(frozen=True, eq=False)
class Problem:
    """Question to a solver: equations, parameters, initial state and times, all on one rung.

    It is equal to itself alone, so that what follows from it can be looked up.

    ``given`` is what most solvers want: the body, the start (``given.initial.omega``) and the instants
    in the scene's own units. ``parameters``, ``initial_momenta`` and ``times`` (elapsed since the
    initial state) are the same as numbers of the rung, held exactly, in ``units`` and in the order of
    ``form``, whose states are momenta: I omega and not omega, or both impulses, then the attitude and
    the centre as far as they are tracked. ``replaced`` are coefficients of the body in whose place
    others stand in the equations, and ``because`` says which equations were chosen, and why.
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

    @property
    def initial(self) -> NoReturn:
        """Raise AttributeError, which says where each of the two starts is."""
        raise AttributeError(
            "expected problem.given.initial (omega or the impulses, in the scene's units) or "
            "problem.initial_momenta (I omega or the impulses, in problem.units), got problem.initial"
        )

    @property
    def parameter(self) -> Mapping[str, Fraction]:
        """Every coefficient and load by name, those that the equations do without included."""
        return {
            **dict(self.replaced),
            **dict(zip(self.form.parameters, self.parameters, strict=True)),
        }

    @property
    def state(self) -> Mapping[str, Fraction]:
        """The initial state by name, in the units of the problem."""
        return dict(zip(self.form.states, self.initial_momenta, strict=True))

    def with_equations(self, equations: Equations) -> Problem:
        """Return the same data under other equations in the same states, as the negative controls need."""
        form = replace(self.form, equations=equations, parameters=tuple(self.parameter))
        kept = form.entering()
        values = tuple(self.parameter[name] for name in kept)
        return replace(self, form=replace(form, parameters=kept), parameters=values)


def pose(scene: Scene, rung: Rung) -> Problem:
    """Round the scene onto a rung and build the equations it requires.

    Raises NotRepresentable where the rounded data are no body or the sample times coincide.
    """
    units = natural_units(scene)
    times = _rounded_times(scene.clock, units, rung)
    start, unit = scene.clock.start, units.time
    clock = Clock(start, Instants(len(times), lambda k: start + times[k] * unit))
    data = _rounded_data(scene, units, _Rounding(rung))
    if scene.body.manufactured is not None:
        data = _with_clock(data, scene.body, scene.body.manufactured, units, _Rounding(rung))
    data = _with_frame(data, scene.track, units, rung)
    choice = data.choice
    form = choice.form(data.states)
    return Problem(
        scene=scene,
        rung=rung,
        form=form,
        units=units,
        parameters=tuple(choice.numbers[name] for name in form.parameters),
        initial_momenta=tuple(choice.numbers[name] for name in form.states),
        times=times,
        given=replace(scene, body=data.body, initial=data.initial, clock=clock),
        replaced=tuple((n, v) for n, v in choice.replaced.items() if n not in form.parameters),
        because=choice.because + constants_told(data.states, form),
    )


def _rounded_times(clock: Clock, units: Units, rung: Rung) -> Sequence[Fraction]:
    try:
        times = rounded_times(clock, units.time, rung)
    except OverflowError as error:
        raise NotRepresentable(str(error)) from error
    if not are_distinct(times):
        raise NotRepresentable(f"two sample times round to the same number of {rung.name}")
    return times


def pose_as_stored(scene: Scene, rung: Rung) -> Problem:
    """Return the problem of a solver that stores I and omega0, as physics engines do.

    Whatever it makes of I^-1 is its own affair: so I and omega0 are rounded to the rung, the 21
    coefficients and x, y likewise, and I^-1 is exact. Of a manufactured motion it stores what the
    scene writes, the frequencies and coefficients of omega, or of x and y; it begins where the rounded
    ones say, and the loads are those of the rounded body. The rest is as `pose` would have it. Raises
    NotRepresentable where the rounded data are no body.
    """
    posed = pose(scene, rung)
    body, initial = _stored(scene, _Rounding(rung))
    return replace(posed, given=replace(posed.given, body=body, initial=initial))


def adopt(scene: Scene, rung: Rung, instants: Sequence[Fraction]) -> Problem:
    """Return the problem that somebody else's answer solves, at the times it has rows for.

    The data are as they are stored, and the instants are exact. Raises NotRepresentable where the
    rounded data are no body.
    """
    posed, clock = pose_as_stored(scene, rung), Clock(scene.clock.start, instants)
    return replace(
        posed,
        scene=replace(scene, clock=clock),
        times=Instants(len(instants), lambda k: clock.elapsed[k] / posed.units.time),
        given=replace(posed.given, clock=clock),
    )


def _stored(scene: Scene, rounded: _Rounding) -> tuple[Body, State]:
    """Return body and initial state, each number of the scene rounded once where it stands."""
    motion = scene.body.manufactured
    start = scene.initial.changed(rounded.part)
    if motion is not None:
        motion = Manufactured(rounded.each(motion.constant), rounded.waves(motion))
        start = start.with_moving(motion.start)
    body = scene.body.changed(rounded.part).with_motion(motion)
    if not tensors.is_positive_definite(body.energy_matrix):
        raise NotRepresentable(
            f"rounded to {rounded.rung.name}, {body.ENERGY} is not positive definite"
        )
    return body, start


@dataclass(frozen=True)
class _Data:
    """Equations with rounded numbers, which of these are states, and the exact body and start."""

    choice: Choice
    states: tuple[str, ...]
    body: Body
    initial: State


def _rounded_data(scene: Scene, units: Units, rounded: _Rounding) -> _Data:
    """Form coefficients, loads and momenta exactly and round each once; all else follows exactly."""
    body, start = scene.body, scene.initial
    kind = mechanics(body)
    exact = kind.change(body).momentum(start.moving)
    vectors = {one.name: exact[3 * k : 3 * k + 3] for k, one in enumerate(kind.momenta)}
    values = _counted(kind.body_letters, kind.values(body), units, rounded)
    momenta = _counted(kind.momenta, vectors, units, rounded)
    try:
        given = kind.body(_each(kind.body_letters, values, units.physical))
    except ValueError as error:
        raise NotRepresentable(f"rounded to {rounded.rung.name}, {error}") from error
    momentum = tuple(chain(*_each(kind.momenta, momenta, units.physical).values()))
    place = {
        part.name: units.physical(part, rounded.counted(part, start.part(part), units))
        for part in start.PARTS
        if part.name not in start.MOVING
    }
    begun = start.with_parts(place).with_moving(kind.change(given).moving(momentum))
    numbers = _named(kind.momenta, momenta) | _named(kind.body_letters, values)
    return _Data(kind.choice(numbers, rounded.rung), kind.states, given, begun)


def numbers_of(body: Body, units: Units) -> dict[str, Fraction]:
    """Return every coefficient and load of a body by name, in these units."""
    kind = mechanics(body)
    return _named(kind.body_letters, _each(kind.body_letters, kind.values(body), units.counted))


# Letters of the equations with their values: exact, in units, rounded.

_Letters = Sequence[Part]
_Values = Mapping[str, Value]


def _each(letters: _Letters, values: _Values, change: Callable[[Part, Value], Value]) -> _Values:
    """Return the value of each letter in other units."""
    return {one.name: change(one, values[one.name]) for one in letters}


def _counted(letters: _Letters, values: _Values, units: Units, rounded: _Rounding) -> _Values:
    """Return the value of each letter, counted in its unit and rounded once."""
    return {
        one.name: rounded.each(values[one.name], -units.exponent(one.dimension)) for one in letters
    }


def _named(letters: _Letters, values: _Values) -> dict[str, Fraction]:
    return {name: v for one in letters for name, v in components(one, values[one.name]).items()}


def _with_clock(
    data: _Data, body: Body, motion: Manufactured, units: Units, rounded: _Rounding
) -> _Data:
    """Return the same under the loads of a manufactured motion, with their clock among the states.

    The coefficients of H*, or x* and y*, and the frequencies are formed exactly and rounded once. The
    constant part is what the rounded start leaves of it, so that the motion begins where the state does.
    """
    kind = mechanics(body)
    sizes: Vector = tuple(units.of(one.dimension) for one in kind.momenta for _ in range(3))
    of_momenta = kind.change(body).motion_of_momenta(motion)
    scaled = of_momenta.in_units(tuple(1 / size for size in sizes), 1 / units.time)
    start = tuple(data.choice.numbers[name] for name in data.states)
    held = manufactured.begun(rounded.waves(scaled), start)
    given = kind.change(data.body).motion_of_state(held.in_units(sizes, units.time))
    # The loads are formed of the general coefficients, whatever shorter equations do without.
    known = numbers_of(data.body, units) | dict(data.choice.numbers)
    choice = replace(
        data.choice,
        equations=manufactured.Loaded(data.choice.equations, len(held.waves), kind.inverse),
        numbers=known | manufactured.numbers(held),
        because=(*data.choice.because, *manufactured.sentences(held, kind.inverse)),
    )
    states = data.states + manufactured.states(held)
    return _Data(choice, states, data.body.with_motion(given), data.initial)


def _with_frame(data: _Data, track: Collection[str], units: Units, rung: Rung) -> _Data:
    """Return the same with attitude and centre among the states, as far as they are tracked."""
    frame: dict[str, Fraction] = {}
    if "attitude" in track:
        quaternion = _unit_quaternion(data.initial.attitude, rung)
        frame |= {f"e{i}": entry for i, entry in enumerate(quaternion)}
    if "centre" in track:
        # The centre is integrated from the origin and its start added exactly afterwards.
        frame |= dict.fromkeys(("c1", "c2", "c3"), Fraction(0))
    states = (*data.states, *frame)
    if "centre" in track:
        frame["s"] = 1 / units.path
    choice = replace(data.choice, numbers={**data.choice.numbers, **frame})
    return replace(data, states=states, choice=choice)


@dataclass(frozen=True)
class _Rounding:
    """Rounds scalars, vectors and matrices onto one rung."""

    rung: Rung

    def __call__(self, value: Fraction, shift: int = 0) -> Fraction:
        try:
            return self.rung.round_scaled(value, shift)
        except OverflowError as error:
            raise NotRepresentable(str(error)) from error

    def each(self, value: Value, shift: int = 0) -> Value:
        """Round every number of a value times 2^shift, whatever its shape."""
        return entrywise(lambda entry: self(entry, shift) if entry else entry, value)

    def counted(self, part: Part, value: Value, units: Units) -> Value:
        """Round a part of a state, counted in its unit."""
        if part.shape is Shape.QUATERNION:
            return self.quaternion(value)
        return self.each(value, -units.exponent(part.dimension))

    def part(self, part: Part, value: Value) -> Value:
        """Round a part of a body or a state as it stands."""
        return self.quaternion(value) if part.shape is Shape.QUATERNION else self.each(value)

    def quaternion(self, quaternion: Quaternion) -> Quaternion:
        """Round the components after an exact scaling to order one; the norm does not matter."""
        if quaternion == IDENTITY:
            return quaternion
        shift = -max(floor_log2(entry) for entry in quaternion if entry)
        e0, e1, e2, e3 = (self(entry, shift) for entry in quaternion)
        return (e0, e1, e2, e3)

    def waves(self, motion: Manufactured) -> tuple[Wave, ...]:
        """Round frequencies and coefficients of a manufactured motion."""
        return tuple(
            Wave(self(w.frequency), self.each(w.cosine), self.each(w.sine)) for w in motion.waves
        )


def _unit_quaternion(quaternion: Quaternion, rung: Rung) -> Quaternion:
    """Return the quaternion over its norm, each component rounded once."""
    if quaternion == IDENTITY:
        return quaternion
    # 64 guard bits: the square root's own error cannot show in the rounding but by a tie of
    # probability 2^-64, and then by one unit in the last place.
    scale = lcm(*(entry.denominator for entry in quaternion))
    whole = [entry.numerator * (scale // entry.denominator) for entry in quaternion]
    squared = sum(n * n for n in whole)
    shift = max(0, rung.bits + 64 - squared.bit_length() // 2)
    norm = isqrt(squared << 2 * shift)
    e0, e1, e2, e3 = (rung.round(Fraction(n << shift, norm)) for n in whole)
    return (e0, e1, e2, e3)
