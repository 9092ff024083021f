"""A problem: one scene's equations and data on one rung, as a solver receives them.

The data are rounded once, in such a way that the rounded problem is still an exact body. What a
solver received is kept as a scene of its own, `given`, in exact numbers: the truth starts from it,
so that an error is the solver's and never the data's.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import NoReturn

from mpmath import mp

from taylor_verify.models import manufactured
from taylor_verify.models.choice import Choice, constants_told, for_immersed_body, for_rigid_body
from taylor_verify.models.form import Equations, Form
from taylor_verify.models.times import are_distinct, rounded_times
from taylor_verify.models.units import Units, natural_units
from taylor_verify.records.quantities import IMPULSES
from taylor_verify.scenes import tensors
from taylor_verify.scenes.bodies import Body, ImmersedBody, RigidBody
from taylor_verify.scenes.instants import Instants
from taylor_verify.scenes.manufactured import Manufactured, Wave
from taylor_verify.scenes.motion import Clock, Impulse, Quaternion, Spin, State
from taylor_verify.scenes.precision import Rung, exact_value, floor_log2, power_of_two
from taylor_verify.scenes.scene import Scene
from taylor_verify.scenes.tensors import Matrix, Vector


class NotRepresentable(Exception):
    """The rung cannot hold this scene as a body with distinct sample times; the text says why."""


@dataclass(frozen=True)
class Problem:
    """What a solver is asked: equations, parameters, initial state and times, all on one rung.

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
        """Not an attribute, for it could be either of two: the error says where they are."""
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
        """The same data under other equations in the same states, as the negative controls need."""
        form = replace(self.form, equations=equations, parameters=tuple(self.parameter))
        kept = form.entering()
        values = tuple(self.parameter[name] for name in kept)
        return replace(self, form=replace(form, parameters=kept), parameters=values)


def pose(scene: Scene, rung: Rung) -> Problem:
    """Round the scene onto a rung and build the equations it requires.

    Raises NotRepresentable where the rounded data are no body or the sample times coincide.
    """
    units = natural_units(scene)
    rounding = _Rounding(rung)
    times = _rounded_times(scene.clock, units, rung)
    start, unit = scene.clock.start, units.time
    clock = Clock(start, Instants(len(times), lambda: (start + t * unit for t in times)))
    data = _rounded_data(scene, units, rounding)
    if scene.body.manufactured is not None:
        data = _with_clock(data, scene, units, rounding)
    data = _with_frame(data, scene, rung)
    form = data.choice.form(data.states)
    numbers = data.numbers
    return Problem(
        scene=scene,
        rung=rung,
        form=form,
        units=units,
        parameters=tuple(numbers[name] for name in form.parameters),
        initial_momenta=tuple(numbers[name] for name in form.states),
        times=times,
        given=replace(scene, body=data.body, initial=data.initial, clock=clock),
        replaced=_not_entering(data.choice.replaced, form),
        because=data.choice.because + constants_told(data.states, form),
    )


def _rounded_times(clock: Clock, units: Units, rung: Rung) -> Sequence[Fraction]:
    try:
        times = rounded_times(clock, units.time, rung)
    except OverflowError as error:
        raise NotRepresentable(str(error)) from error
    if not are_distinct(times):
        raise NotRepresentable(f"two sample times round to the same number of {rung.name}")
    return times


def adopt(scene: Scene, rung: Rung, instants: Sequence[Fraction]) -> Problem:
    """The problem that somebody else's answer solves, at the times it has rows for.

    Others store I and omega0, and whatever they make of I^-1 is theirs: so I and omega0 are rounded
    to the rung, the 21 coefficients and x, y likewise, and I^-1 is exact. Of a manufactured motion they
    store what the scene writes, the frequencies and coefficients of omega, or of x and y; it begins where
    the rounded ones say, and the loads are those of the rounded body. The instants are exact. The rest is
    as `pose` would have it. Raises NotRepresentable where the rounded data are no body.
    """
    posed, clock = pose(scene, rung), Clock(scene.clock.start, instants)
    body, initial = _stored(scene, _Rounding(rung))
    return replace(
        posed,
        scene=replace(scene, clock=clock),
        times=Instants(len(instants), lambda: (t / posed.units.time for t in clock.elapsed)),
        given=replace(scene, body=body, initial=initial, clock=clock),
    )


def _stored(scene: Scene, rounded: _Rounding) -> tuple[Body, State]:
    """Body and initial state, each number of the scene rounded once where it stands."""
    one, body, start = Fraction(1), scene.body, scene.initial
    motion = _stored_motion(scene, rounded)
    attitude = _rounded_quaternion(start.attitude, rounded)
    if isinstance(body, RigidBody):
        assert isinstance(start, Spin)
        inertia = rounded.matrix(body.inertia, one)
        if not tensors.is_positive_definite(inertia):
            raise NotRepresentable(
                f"rounded to {rounded.rung.name}, the inertia tensor is not positive definite"
            )
        solid = RigidBody(inertia, rounded.vector(body.moment, one), motion)
        omega = rounded.vector(start.omega, one) if motion is None else motion.start
        return solid, Spin(omega, attitude)
    assert isinstance(start, Impulse)
    immersed = ImmersedBody(
        rounded.matrix(body.linear, one),
        rounded.matrix(body.coupling, one),
        rounded.matrix(body.angular, one),
        rounded.vector(body.force, one),
        rounded.vector(body.couple, one),
        manufactured=motion,
    )
    if not tensors.is_positive_definite(immersed.energy_matrix):
        raise NotRepresentable(f"rounded to {rounded.rung.name}, T is not positive definite")
    linear, angular = rounded.vector(start.linear, one), rounded.vector(start.angular, one)
    if motion is not None:
        linear, angular = motion.start[:3], motion.start[3:]
    return immersed, Impulse(linear, angular, attitude, rounded.vector(start.centre, one))


def _stored_motion(scene: Scene, rounded: _Rounding) -> Manufactured | None:
    """The manufactured motion, each of its numbers rounded once where it stands."""
    motion, one = scene.body.manufactured, Fraction(1)
    if motion is None:
        return None
    return Manufactured(
        rounded.vector(motion.constant, one),
        tuple(
            Wave(rounded(w.frequency), rounded.vector(w.cosine, one), rounded.vector(w.sine, one))
            for w in motion.waves
        ),
    )


@dataclass(frozen=True)
class _Data:
    """Equations with rounded numbers, which of these are states, and the exact body and start."""

    choice: Choice
    states: tuple[str, ...]
    body: Body
    initial: State

    @property
    def numbers(self) -> Mapping[str, Fraction]:
        return self.choice.numbers


def _not_entering(numbers: Mapping[str, Fraction], form: Form) -> tuple[tuple[str, Fraction], ...]:
    return tuple((name, value) for name, value in numbers.items() if name not in form.parameters)


def _rounded_data(scene: Scene, units: Units, rounding: _Rounding) -> _Data:
    if isinstance(scene.body, RigidBody):
        assert isinstance(scene.initial, Spin)
        return _round_euler(scene.body, scene.initial, units, rounding)
    assert isinstance(scene.initial, Impulse)
    return _round_kirchhoff(scene.body, scene.initial, units, rounding)


def _with_clock(data: _Data, scene: Scene, units: Units, rounded: _Rounding) -> _Data:
    """The same under the loads of its manufactured motion, with the clock of these among the states.

    The coefficients of H*, or x* and y*, and the frequencies are formed exactly and rounded once. The
    constant part is what the rounded start leaves of it, so that the motion begins where the state does.
    """
    body = scene.body
    assert body.manufactured is not None
    motion = body.manufactured
    sizes: Vector = (units.impulse,) * 3 + (units.momentum,) * 3
    if isinstance(body, RigidBody):
        motion, sizes = motion.mapped(body.inertia), sizes[3:]
    scaled = motion.in_units(tuple(1 / size for size in sizes), 1 / units.time)
    one = Fraction(1)
    waves = [
        Wave(rounded(w.frequency), rounded.vector(w.cosine, one), rounded.vector(w.sine, one))
        for w in scaled.waves
    ]
    held = manufactured.begun(waves, tuple(data.numbers[name] for name in data.states))
    given = held.in_units(sizes, units.time)
    if isinstance(data.body, RigidBody):
        given = given.mapped(data.body.inverse_inertia)
    numbers = {**_coefficients(data.body, units), **data.numbers, **manufactured.numbers(held)}
    choice = replace(
        data.choice,
        equations=manufactured.Loaded(data.choice.equations, len(waves)),
        numbers=numbers,
        because=(*data.choice.because, *manufactured.told(held)),
    )
    states = data.states + manufactured.states(held)
    return _Data(choice, states, replace(data.body, manufactured=given), data.initial)


def _coefficients(body: Body, units: Units) -> dict[str, Fraction]:
    """Those of T that the loads are formed of, whatever shorter equations do without."""
    if isinstance(body, RigidBody):
        return {}
    return {
        **_upper_triangle("A", _rescaled(body.linear, 1 / units.inverse_mass)),
        **_entries("B", _rescaled(body.coupling, 1 / units.coupling)),
        **_upper_triangle("C", _rescaled(body.angular, 1 / units.inverse_inertia)),
    }


def _with_frame(data: _Data, scene: Scene, rung: Rung) -> _Data:
    """The same with attitude and centre among the states, as far as they are tracked."""
    states, numbers = data.states, dict(data.numbers)
    if "attitude" in scene.track:
        numbers |= _indexed("e", _unit_quaternion(data.initial.attitude, rung), start=0)
        states += ("e0", "e1", "e2", "e3")
    if "centre" in scene.track:
        # The centre is integrated from the origin and its start added exactly afterwards.
        numbers |= _indexed("c", (Fraction(0),) * 3)
        states += ("c1", "c2", "c3")
    return replace(data, states=states, choice=replace(data.choice, numbers=numbers))


@dataclass(frozen=True)
class _Rounding:
    """Rounds scalars, vectors and matrices onto one rung."""

    rung: Rung

    def __call__(self, value: Fraction) -> Fraction:
        try:
            return self.rung.round(value)
        except OverflowError as error:
            raise NotRepresentable(str(error)) from error

    def vector(self, vector: Vector, unit: Fraction) -> Vector:
        return tuple(self(entry / unit) for entry in vector)

    def matrix(self, matrix: Matrix, unit: Fraction) -> Matrix:
        return tuple(self.vector(row, unit) for row in matrix)


def _round_euler(body: RigidBody, initial: Spin, units: Units, rounded: _Rounding) -> _Data:
    """K and H0 are formed exactly and rounded once; the body is K^-1, and omega0 = K H0, exactly."""
    K = rounded.matrix(body.inverse_inertia, units.inverse_inertia)
    H = rounded.vector(tensors.apply(body.inertia, initial.omega), units.momentum)
    M = rounded.vector(body.moment, units.momentum / units.time)
    if not tensors.is_positive_definite(K):
        raise NotRepresentable(
            f"rounded to {rounded.rung.name}, the inverse inertia tensor is not positive definite"
        )
    physical_K = _rescaled(K, units.inverse_inertia)
    omega = tensors.apply(physical_K, tensors.scaled(units.momentum, H))
    given = RigidBody(tensors.inverse(physical_K), tensors.scaled(units.momentum / units.time, M))
    numbers = _indexed("H", H) | _upper_triangle("K", K) | _indexed("M", M)
    start = Spin(omega, _rounded_quaternion(initial.attitude, rounded))
    choice = for_rigid_body(numbers, rounded.rung)
    return _Data(choice, ("H1", "H2", "H3"), given, start)


def _round_kirchhoff(
    body: ImmersedBody, initial: Impulse, units: Units, rounded: _Rounding
) -> _Data:
    """The 21 coefficients are rounded once each; that T is the body."""
    A = rounded.matrix(body.linear, units.inverse_mass)
    B = rounded.matrix(body.coupling, units.coupling)
    C = rounded.matrix(body.angular, units.inverse_inertia)
    if not tensors.is_positive_definite(tensors.blocks(A, B, C)):
        raise NotRepresentable(f"rounded to {rounded.rung.name}, T is not positive definite")
    x = rounded.vector(initial.linear, units.impulse)
    y = rounded.vector(initial.angular, units.momentum)
    X = rounded.vector(body.force, units.impulse / units.time)
    L = rounded.vector(body.couple, units.momentum / units.time)
    given = ImmersedBody(
        _rescaled(A, units.inverse_mass),
        _rescaled(B, units.coupling),
        _rescaled(C, units.inverse_inertia),
        tensors.scaled(units.impulse / units.time, X),
        tensors.scaled(units.momentum / units.time, L),
    )
    start = Impulse(
        tensors.scaled(units.impulse, x),
        tensors.scaled(units.momentum, y),
        _rounded_quaternion(initial.attitude, rounded),
        tensors.scaled(units.length, rounded.vector(initial.centre, units.length)),
    )
    numbers = _indexed("x", x) | _indexed("y", y) | _indexed("X", X) | _indexed("L", L)
    numbers |= _upper_triangle("A", A) | _entries("B", B) | _upper_triangle("C", C)
    return _Data(for_immersed_body(numbers), IMPULSES, given, start)


def _rounded_quaternion(quaternion: Quaternion, rounded: _Rounding) -> Quaternion:
    """The components rounded after an exact scaling to order one; the norm does not matter."""
    unit = power_of_two(max(floor_log2(entry) for entry in quaternion if entry))
    e0, e1, e2, e3 = rounded.vector(quaternion, unit)
    return (e0, e1, e2, e3)


def _unit_quaternion(quaternion: Quaternion, rung: Rung) -> Quaternion:
    """The quaternion over its norm, each component rounded once."""
    # 64 guard bits: the square root's own error cannot show in the rounding but by a tie of
    # probability 2^-64, and then by one unit in the last place.
    with mp.workprec(rung.bits + 64):
        norm = mp.sqrt(mp.convert(tensors.dot(quaternion, quaternion)))
        quotients = [mp.convert(entry) / norm for entry in quaternion]
        e0, e1, e2, e3 = (rung.round(exact_value(v)) for v in quotients)
    return (e0, e1, e2, e3)


def _rescaled(matrix: Matrix, unit: Fraction) -> Matrix:
    return tuple(tensors.scaled(unit, row) for row in matrix)


def _indexed(letter: str, vector: Sequence[Fraction], start: int = 1) -> dict[str, Fraction]:
    return {f"{letter}{i}": entry for i, entry in enumerate(vector, start=start)}


def _entries(letter: str, matrix: Matrix) -> dict[str, Fraction]:
    return {f"{letter}{i + 1}{j + 1}": matrix[i][j] for i in range(3) for j in range(3)}


def _upper_triangle(letter: str, matrix: Matrix) -> dict[str, Fraction]:
    return {f"{letter}{i + 1}{j + 1}": matrix[i][j] for i in range(3) for j in range(i, 3)}
