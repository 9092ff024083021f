"""The solver against itself: two runs whose exact answers are images of each other, and no truth.

A relation maps one scene onto another: other axes, other units, time reversed or split, the same
motion by other equations. All data are multiples of 225/1024 (tensors) or 15/1024 (vectors): fifths
and thirds divide them, so that every rung holds both scenes exactly, which `solve` asserts, and no
rounding of data enters a bound but that of a unit quaternion, one beside those of the steps. The
exact solution is asked for an orbit's condition alone, the growth in the floors, and never for a
value that is compared.

x, y   impulses    H  angular momentum     K = I^-1      omega = K H
A B C  as in T = x.A x/2 + x.B y + y.C y/2               R, c  attitude and centre, in space
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import combinations
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mpmath import mp

from taylor_verify.judge.errors.state import largest, state_errors
from taylor_verify.judge.floor.attainable import floor
from taylor_verify.models.euler import euler_equations
from taylor_verify.models.form import Form, Named
from taylor_verify.models.frame import rotation
from taylor_verify.models.kirchhoff import ClebschAbout, clebsch_equations, kirchhoff_equations
from taylor_verify.models.problem import Problem, pose
from taylor_verify.numbers import tensors
from taylor_verify.numbers.precision import rung
from taylor_verify.numbers.tensors import ZERO_VECTOR, Matrix, Vector
from taylor_verify.records.quantities import GATE_FACTOR
from taylor_verify.scenes.bodies import Clebsch, ImmersedBody, RigidBody
from taylor_verify.scenes.motion import IDENTITY, Clock, Impulse, Motion, Quaternion, Spin
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.solver import Solver
from taylor_verify.solvers.taylor.driver import Taylor
from taylor_verify.solvers.trajectory import Outcome, Trajectory
from taylor_verify_reports.controls.defects import DEFECTS, Defect

# Images are formed and compared at this many bits, three times those of the finest rung used.
BITS = 300
# A wrong relation or solver is off by more than any factor of a floor could hide.
BLATANT = 1000

Array = np.ndarray[Any, Any]
DEFECT = {defect.name: defect for defect in DEFECTS}


# Scenes that every rung holds.


def matrix(*rows: tuple[int, int, int]) -> Matrix:
    return tuple(tuple(Fraction(225 * entry, 1024) for entry in row) for row in rows)


def vector(*entries: int, over: int = 64) -> Vector:
    return tuple(Fraction(15 * entry, over) for entry in entries)


def scene(body: RigidBody | ImmersedBody, initial: Spin | Impulse, *track: str) -> Scene:
    """A scene sampled at 0, 1/2, ..., 8: a turn or more of the bodies below."""
    model = "euler" if isinstance(body, RigidBody) else "kirchhoff"
    clock = Clock(Fraction(0), tuple(Fraction(k, 2) for k in range(17)))
    return Scene("metamorphic", "", model, frozenset(track), body, initial, clock)


K = matrix((5, 1, -1), (1, 3, 1), (-1, 1, 2))
H = vector(4, 2, -1)
MOMENT = vector(1, -2, 1, over=1024)
RIGID = scene(RigidBody(tensors.inverse(K), MOMENT), Spin(tensors.apply(K, H)), "attitude")
IMMERSED = scene(
    ImmersedBody(
        linear=matrix((5, 1, -1), (1, 4, 1), (-1, 1, 6)),
        coupling=matrix((1, -1, 1), (2, -1, 1), (-1, 1, 1)),
        angular=matrix((6, 1, 1), (1, 4, -1), (1, -1, 5)),
        force=vector(1, 2, -1, over=1024),
        couple=vector(-1, 1, 2, over=1024),
    ),
    Impulse(vector(2, -1, 3), vector(3, 4, -2), centre=vector(1, -2, 3)),
    "attitude",
    "centre",
)
SCENES = {"euler": RIGID, "kirchhoff": IMMERSED}
RUNGS = ("f64", "f80")
EACH_SCENE = pytest.mark.parametrize("model", SCENES)
EACH_RUNG = pytest.mark.parametrize("name", RUNGS)


# Runs, and how far two of them are apart.


@dataclass(frozen=True)
class Run:
    """A finished run on a scene that its rung holds exactly."""

    problem: Problem
    trajectory: Trajectory

    @property
    def motion(self) -> Motion:
        return self.trajectory.motion(BITS)


def solve(asked: Scene, name: str, solver: Solver | None = None) -> Run:
    solver = solver or Taylor()
    if missing := solver.unavailable(rung(name)):
        pytest.skip(missing)
    problem = pose(asked, rung(name))
    assert_held(asked, problem.given)
    trajectory = solver.solve(problem)
    assert trajectory.outcome is Outcome.FINISHED
    return Run(problem, trajectory)


def assert_held(asked: Scene, given: Scene) -> None:
    """Rounding moved nothing: a quaternion may only have changed its norm."""
    unframed = replace(asked.initial, attitude=IDENTITY)
    assert (given.body, given.clock) == (asked.body, asked.clock)
    assert replace(given.initial, attitude=IDENTITY) == unframed
    pairs = list(zip(asked.initial.attitude, given.initial.attitude, strict=True))
    assert all(a * d == b * c for (a, b), (c, d) in combinations(pairs, 2))


def apart(run: Run, image: Motion, steps: int) -> float:
    """How far a run and another's image in its scene are apart, as a share of what is allowed.

    Allowed are GATE_FACTOR floors for each: both are answers to this scene, in ``steps`` steps and in its
    own, and an orbit's image has the orbit's own condition. NaN or infinite
    where either has a NaN.
    """
    asked, motion = run.problem.scene, run.motion
    u = run.problem.rung.unit_roundoff
    one, other = (floor(asked, asked, u, n) for n in (run.trajectory.steps, steps))
    shares = []
    with mp.workprec(BITS):
        for errors in state_errors(asked, motion, image):
            allowed = GATE_FACTOR * (one.of_state(errors) + other.of_state(errors))
            shares += [share(e, a) for e, a in zip(errors.values, allowed, strict=True)]
    return float(largest(shares))


def share(error: Any, allowed: float) -> Any:
    """0 for no error, infinite where none is allowed."""
    if error == 0:
        return mp.zero
    return error / allowed if allowed > 0 else mp.inf


def mapped(motion: Motion, **maps: Callable[[Array], Array]) -> Motion:
    """The motion with some quantities sent through maps of their rows, at BITS bits."""
    with mp.workprec(BITS):
        quantities = {
            k: maps[k](rows) if k in maps else rows for k, rows in motion.quantities.items()
        }
    return Motion(quantities, motion.radius)


def same_bits(one: Motion, other: Motion) -> bool:
    """Every number equal; a NaN equals nothing."""
    assert one.quantities.keys() == other.quantities.keys()
    return all(np.array_equal(one[name], other[name]) for name in one.quantities)


def untracked(asked: Scene) -> Scene:
    """The same without attitude and centre, which the equations of the shipped defects lack."""
    return replace(asked, track=frozenset())


def drag(n: Named) -> Mapping[str, Any]:
    """Euler's equations with H' smaller by H/1024: no units, no direction of time, are alike to it."""
    rates = dict(euler_equations(n))
    return rates | {name: rates[name] - n[name] / 1024 for name in ("H1", "H2", "H3")}


DRAG = Defect("drag", "", "omega", equations=drag)


@pytest.mark.parametrize("spoiled", ["image", "run", "both"])
def test_nan_is_no_agreement(spoiled: str) -> None:
    """A NaN in either motion is no agreement, neither to a bound nor bit by bit."""
    asked = untracked(RIGID)
    sound, broken = solve(asked, "f64"), solve(asked, "f64", DEFECT["one-nan"])
    run = sound if spoiled == "image" else broken
    image = (sound if spoiled == "run" else broken).motion
    assert not apart(run, image, sound.trajectory.steps) <= 1
    assert not same_bits(run.motion, image)


# Other axes.


@dataclass(frozen=True)
class Axes:
    """New body axes: polar vectors become Q v, axial ones det Q Q v, with Q = parity x turn(q).

    ``parity`` -1 is left-handed, and space is reflected in its origin along with the body, or R would
    be no rotation: R' = R turn^T and c' = parity c.
    """

    q: tuple[int, int, int, int]
    parity: int = 1

    @property
    def turn(self) -> Matrix:
        """The proper rotation of q, exactly; what axial vectors are turned by."""
        squared = sum(e * e for e in self.q)
        return tuple(tuple(Fraction(e, squared) for e in row) for row in rotation(self.q))

    def axial(self, v: Vector) -> Vector:
        return tensors.apply(self.turn, v)

    def polar(self, v: Vector) -> Vector:
        return tensors.scaled(Fraction(self.parity), self.axial(v))

    def tensor(self, t: Matrix, parity: int = 1) -> Matrix:
        turned = tensors.product(tensors.product(self.turn, t), tensors.transpose(self.turn))
        return tuple(tensors.scaled(Fraction(parity), row) for row in turned)

    def of_scene(self, asked: Scene) -> Scene:
        return replace(asked, body=self._body(asked.body), initial=self._initial(asked.initial))

    def _body(self, body: RigidBody | ImmersedBody) -> RigidBody | ImmersedBody:
        if isinstance(body, RigidBody):
            return RigidBody(self.tensor(body.inertia), self.axial(body.moment))
        return ImmersedBody(
            self.tensor(body.linear),
            self.tensor(body.coupling, self.parity),
            self.tensor(body.angular),
            self.polar(body.force),
            self.axial(body.couple),
        )

    def _initial(self, initial: Spin | Impulse) -> Spin | Impulse:
        """From an attitude that is the identity to that of turn^T."""
        assert initial.attitude == IDENTITY
        q0, q1, q2, q3 = (Fraction(e) for e in self.q)
        attitude: Quaternion = (q0, -q1, -q2, -q3)
        if isinstance(initial, Spin):
            return Spin(self.axial(initial.omega), attitude)
        linear, angular = self.polar(initial.linear), self.axial(initial.angular)
        centre = tensors.scaled(Fraction(self.parity), initial.centre)
        return Impulse(linear, angular, attitude, centre)

    def undone(self, motion: Motion) -> Motion:
        """The motion in the old axes; a row v' is v' turn there."""
        with mp.workprec(BITS):
            G = np.array([[mp.convert(e) for e in row] for row in self.turn], dtype=object)
        return mapped(
            motion,
            omega=lambda rows: rows @ G,
            angular_impulse=lambda rows: rows @ G,
            linear_impulse=lambda rows: self.parity * (rows @ G),
            attitude=lambda rows: rows @ G,
            centre=lambda rows: self.parity * rows,
        )


AXES = {
    "permuted": Axes((1, 1, 1, 1)),
    "two exchanged": Axes((0, 1, -1, 0), parity=-1),
    "one reversed": Axes((0, 0, 0, 1), parity=-1),
    "3-4-5": Axes((2, 0, 0, 1)),
    "oblique": Axes((1, 1, 1, 0)),
}


def in_other_axes(axes: Axes, asked: Scene, name: str, solver: Solver | None = None) -> float:
    here, there = (solve(s, name, solver) for s in (asked, axes.of_scene(asked)))
    return apart(here, axes.undone(there.motion), there.trajectory.steps)


@EACH_SCENE
@EACH_RUNG
@pytest.mark.parametrize("axes", AXES)
def test_axes_do_not_matter(axes: str, name: str, model: str) -> None:
    """Permuted, reflected and rotated axes give the same motion, to ten floors for each run.

    Not the same bits, permuted or not: a fused a b - c d rounds one product and not the other, and
    which one it is depends on the place.
    """
    assert in_other_axes(AXES[axes], SCENES[model], name) <= 1


@EACH_SCENE
def test_axes_do_not_matter_at_a_hundred_bits(model: str) -> None:
    """The relation tightens with the rung: 2^-100 is the unit of its bound there."""
    assert in_other_axes(AXES["oblique"], SCENES[model], "mp100") <= 1


@pytest.mark.parametrize("axes", ["two exchanged", "one reversed"])
@EACH_SCENE
def test_handedness_matters(axes: str, model: str) -> None:
    """An odd permutation or a mirror without its sign (omega as a polar vector) is no relation."""
    proper = AXES[axes]
    unsigned = replace(proper, parity=1)
    asked = SCENES[model]
    there = solve(proper.of_scene(asked), "f64")
    image = unsigned.undone(there.motion)
    if model == "euler":
        image = mapped(image, omega=lambda rows: -rows)
    assert apart(solve(asked, "f64"), image, there.trajectory.steps) >= BLATANT


@pytest.mark.parametrize("axes", ["two exchanged", "one reversed"])
def test_coupling_changes_its_sign_with_the_hand(axes: str) -> None:
    """B joins a polar and an axial vector: carried over as A and C are, it makes another body."""
    odd, body = AXES[axes], IMMERSED.body
    image = odd.of_scene(IMMERSED)
    assert isinstance(body, ImmersedBody)
    assert isinstance(image.body, ImmersedBody)
    unsigned = replace(image.body, coupling=odd.tensor(body.coupling))
    there = solve(replace(image, body=unsigned), "f64")
    back = odd.undone(there.motion)
    assert apart(solve(IMMERSED, "f64"), back, there.trajectory.steps) >= BLATANT


@pytest.mark.parametrize("axes", ["3-4-5", "oblique"])
def test_tensor_cut_to_its_diagonal_depends_on_the_axes(axes: str) -> None:
    """A solver that drops products of inertia answers differently in rotated axes."""
    asked = untracked(RIGID)
    assert in_other_axes(AXES[axes], asked, "f64", DEFECT["diagonal-tensor"]) >= BLATANT


# Other units.


@dataclass(frozen=True)
class Scales:
    """New units: t, H or y, and x are multiplied by these, and all else as its dimension asks."""

    time: Fraction
    momentum: Fraction
    impulse: Fraction

    @property
    def spin(self) -> Fraction:
        return 1 / self.time

    @property
    def length(self) -> Fraction:
        return self.momentum / self.impulse

    def of_scene(self, asked: Scene) -> Scene:
        clock = Clock(*self._times(asked.clock))
        return replace(asked, body=self._body(asked.body), initial=self._start(asked), clock=clock)

    def _times(self, clock: Clock) -> tuple[Fraction, tuple[Fraction, ...]]:
        return self.time * clock.start, tuple(self.time * t for t in clock.instants)

    def _body(self, body: RigidBody | ImmersedBody) -> RigidBody | ImmersedBody:
        couple = self.momentum / self.time
        if isinstance(body, RigidBody):
            inertia = times(self.momentum * self.time, body.inertia)
            return RigidBody(inertia, tensors.scaled(couple, body.moment))
        return ImmersedBody(
            times(couple / self.impulse**2, body.linear),
            times(1 / (self.time * self.impulse), body.coupling),
            times(1 / (self.time * self.momentum), body.angular),
            tensors.scaled(self.impulse / self.time, body.force),
            tensors.scaled(couple, body.couple),
        )

    def _start(self, asked: Scene) -> Spin | Impulse:
        initial = asked.initial
        if isinstance(initial, Spin):
            return replace(initial, omega=tensors.scaled(self.spin, initial.omega))
        return replace(
            initial,
            linear=tensors.scaled(self.impulse, initial.linear),
            angular=tensors.scaled(self.momentum, initial.angular),
            centre=tensors.scaled(self.length, initial.centre),
        )

    def undone(self, motion: Motion) -> Motion:
        """The motion in the old units."""
        units = {
            "omega": self.spin,
            "linear_impulse": self.impulse,
            "angular_impulse": self.momentum,
            "centre": self.length,
        }
        with mp.workprec(BITS):
            quantities = {
                name: rows * mp.convert(1 / units[name]) if name in units else rows
                for name, rows in motion.quantities.items()
            }
        return Motion(quantities, motion.radius)


def times(factor: Fraction, rows: Matrix) -> Matrix:
    return tuple(tensors.scaled(factor, row) for row in rows)


ODD = Scales(time=Fraction(3), momentum=Fraction(3), impulse=Fraction(5))
BINARY = Scales(time=Fraction(1, 2**40), momentum=Fraction(2**70), impulse=Fraction(2**9))


def in_other_units(asked: Scene, name: str, solver: Solver | None = None) -> float:
    here, there = (solve(s, name, solver) for s in (asked, ODD.of_scene(asked)))
    return apart(here, ODD.undone(there.motion), there.trajectory.steps)


@EACH_SCENE
@EACH_RUNG
def test_units_do_not_matter(name: str, model: str) -> None:
    """With time and momentum in thirds and x in fifths the motion is the same, to ten floors each.

    Every number the solver sees has other bits, and its steps are others.
    """
    assert in_other_units(SCENES[model], name) <= 1


@EACH_SCENE
@EACH_RUNG
def test_binary_units_change_no_bit(name: str, model: str) -> None:
    """Units that are powers of two leave every bit: scaling is exact, and so is scaling back.

    A problem is posed in units of its own, also powers of two: the solver sees the same numbers.
    """
    here, there = (solve(s, name) for s in (SCENES[model], BINARY.of_scene(SCENES[model])))
    assert here.problem.initial_momenta == there.problem.initial_momenta
    assert here.problem.parameters == there.problem.parameters
    assert same_bits(here.motion, BINARY.undone(there.motion))
    assert not same_bits(here.motion, ODD.undone(there.motion))


@pytest.mark.parametrize(
    ("model", "unit"),
    [
        ("euler", "time"),
        ("kirchhoff", "time"),
        ("kirchhoff", "momentum"),
        ("kirchhoff", "impulse"),
    ],
)
def test_every_unit_of_the_body_matters(model: str, unit: str) -> None:
    """With one unit left out of the body, the motion is another.

    All but momentum's in Euler's equations: omega does not know by what I and M are both multiplied.
    """
    asked, forgetful = SCENES[model], replace(ODD, **{unit: Fraction(1)})
    mixed = replace(ODD.of_scene(asked), body=forgetful.of_scene(asked).body)
    there = solve(mixed, "f64")
    image = ODD.undone(there.motion)
    assert apart(solve(asked, "f64"), image, there.trajectory.steps) >= BLATANT


def test_drag_has_units_of_its_own() -> None:
    """A solver with a drag of 1/1024 in its own unit of time answers differently in other units."""
    assert in_other_units(RIGID, "f64", DRAG) >= BLATANT


# Time reversed.


def reversed_start(initial: Spin | Impulse) -> Spin | Impulse:
    """omega, or x and y, turned about; attitude and centre stay."""
    if isinstance(initial, Spin):
        return replace(initial, omega=tensors.scaled(Fraction(-1), initial.omega))
    linear, angular = (tensors.scaled(Fraction(-1), v) for v in (initial.linear, initial.angular))
    return replace(initial, linear=linear, angular=angular)


def reversed_motion(motion: Motion) -> Motion:
    """The momenta turned about.

    Z(s) = -H(-s) obeys H's own equation, Z' = Z x K Z + M with the same M, since the free part is
    quadratic; so does (-x, -y)(-s). R and c, whose rates are linear in the momenta, are retraced.
    """
    names = ("omega", "linear_impulse", "angular_impulse")
    return mapped(motion, **dict.fromkeys(names, np.negative))


def end_of(run: Run) -> Spin | Impulse:
    """The state of the last sample, as the exact start of another run."""
    quantities = run.trajectory.quantities
    rows = {name: tuple(exact(v) for v in quantities[name][-1]) for name in quantities}
    e0, e1, e2, e3 = rows.get("quaternion", IDENTITY)
    attitude: Quaternion = (e0, e1, e2, e3)
    if "omega" in rows:
        return Spin(rows["omega"], attitude)
    linear, angular = rows["linear_impulse"], rows["angular_impulse"]
    return Impulse(linear, angular, attitude, rows.get("centre", ZERO_VECTOR))


def from_origin(asked: Scene) -> Scene:
    """The same path begun at the origin, where the centre's end is a number of the rung.

    From elsewhere it is not: a solver's centre is the start's plus the path, added exactly.
    """
    if isinstance(asked.initial, Spin):
        return asked
    return replace(asked, initial=replace(asked.initial, centre=ZERO_VECTOR))


def exact(value: Any) -> Fraction:
    numerator, denominator = value.as_integer_ratio()
    # gmpy2's integers inside a Fraction do not compare with Python's.
    return Fraction(int(numerator), int(denominator))


def there_and_back(asked: Scene, name: str, solver: Solver | None = None) -> float:
    """Both ways, seen from the turning point.

    Seen from there the way out, too, is an answer to the scene of the way back: at each of its steps
    it is one rounding off the orbit through its own end.
    """
    out = solve(asked, name, solver)
    clock = asked.clock
    instants = tuple(clock.instants[-1] - t for t in reversed(clock.instants))
    turned = replace(
        asked, initial=reversed_start(end_of(out)), clock=replace(clock, instants=instants)
    )
    back = solve(turned, name, solver)
    image = reversed_motion(out.motion)
    image = mapped(image, **{k: lambda rows: rows[::-1] for k in image.quantities})
    return apart(back, image, out.trajectory.steps)


@pytest.mark.parametrize(
    ("model", "name"), [("euler", "f64"), ("euler", "f80"), ("kirchhoff", "f64")]
)
def test_way_back_is_the_way_out(model: str, name: str) -> None:
    """Turned about at its end, a body passes all its samples again, to ten floors for each way."""
    assert there_and_back(from_origin(SCENES[model]), name) <= 1


def past_and_future(asked: Scene, name: str, solver: Solver | None = None) -> tuple[Motion, Motion]:
    """The motion at the negative times, and that of the body turned about at the positive ones."""
    past = replace(asked, clock=Clock(Fraction(0), tuple(-t for t in asked.clock.instants)))
    turned = replace(asked, initial=reversed_start(asked.initial))
    return solve(past, name, solver).motion, solve(turned, name, solver).motion


@EACH_SCENE
@EACH_RUNG
def test_past_is_the_reversed_future_bit_by_bit(name: str, model: str) -> None:
    """Run to negative times, a body does what the body turned about does at positive ones.

    Every term of every Taylor coefficient only changes its sign with that of time, and rounding to
    nearest is symmetric: no bit may differ.
    """
    past, future = past_and_future(SCENES[model], name)
    assert same_bits(past, reversed_motion(future))
    assert not same_bits(past, future)


def test_drag_knows_past_from_future() -> None:
    """A solver that loses momentum gains it at negative times."""
    past, future = past_and_future(RIGID, "f64", DRAG)
    assert not same_bits(past, reversed_motion(future))


def test_drag_and_lateness_do_not_return() -> None:
    """A solver that loses momentum, or whose samples are late, does not come back the same way."""
    asked = untracked(RIGID)
    for broken in (DRAG, DEFECT["one-sample-late"]):
        assert there_and_back(asked, "f64", broken) >= BLATANT


# Split intervals.


def followed_by(first: Motion, second: Motion) -> Motion:
    """Both halves as one motion, without the first one's last sample."""
    names = second.quantities
    quantities = {name: np.concatenate([first[name][:-1], second[name]]) for name in names}
    return Motion(quantities, np.concatenate([first.radius[:-1], second.radius]))


Handover = Callable[[Spin | Impulse], Spin | Impulse]


def in_two_halves(
    asked: Scene, name: str, solver: Solver | None = None, handover: Handover = lambda state: state
) -> float:
    """The whole against its halves, which are one answer in the steps of both."""
    clock, middle = asked.clock, len(asked.clock.instants) // 2
    early, late = clock.instants[:middle], clock.instants[middle:]
    # Between two samples, because the solver of the whole may end a step at each of them.
    cut = (early[-1] + late[0]) / 2
    whole = solve(asked, name, solver)
    first = solve(replace(asked, clock=replace(clock, instants=(*early, cut))), name, solver)
    rest = replace(asked, initial=handover(end_of(first)), clock=Clock(cut, late))
    second = solve(rest, name, solver)
    joined = followed_by(first.motion, second.motion)
    return apart(whole, joined, first.trajectory.steps + second.trajectory.steps)


@EACH_SCENE
@EACH_RUNG
def test_interval_may_be_split(name: str, model: str) -> None:
    """The end of the first half is a start for the second: joined, they are the whole to ten floors.

    The state passes exactly; the quaternion alone is brought back to norm one, a rounding among many.
    """
    assert in_two_halves(from_origin(SCENES[model]), name) <= 1


def test_late_samples_do_not_join() -> None:
    """A solver whose samples are late hands over the state of a moment before."""
    assert in_two_halves(untracked(RIGID), "f64", DEFECT["one-sample-late"]) >= BLATANT


def test_handover_in_single_precision_does_not_join() -> None:
    """A momentum that passes through a float32 on its way to the second half is seen there."""

    def coarsened(state: Spin | Impulse) -> Spin:
        assert isinstance(state, Spin)
        momentum = tensors.apply(tensors.inverse(K), state.omega)
        single = tuple(rung("f32").round(component) for component in momentum)
        return replace(state, omega=tensors.apply(K, single))

    assert in_two_halves(RIGID, "f64", handover=coarsened) >= BLATANT


# The same motion by other equations.


def without_impulse() -> Scene:
    """The rigid body as a solid in a fluid: x = 0, C = K, whatever A and B are."""
    immersed = IMMERSED.body
    assert isinstance(immersed, ImmersedBody)
    # A is large enough for T to be positive beside the small C.
    linear = times(Fraction(16), immersed.linear)
    body = ImmersedBody(linear, immersed.coupling, K, couple=MOMENT)
    return scene(body, Impulse(ZERO_VECTOR, H), "attitude")


def as_rigid(motion: Motion) -> Motion:
    """omega = Omega = C y, where x = 0."""
    with mp.workprec(BITS):
        C = np.array([[mp.convert(e) for e in row] for row in K], dtype=object)
        omega = motion["angular_impulse"] @ C
    quantities = {k: rows for k, rows in motion.quantities.items() if k == "attitude"}
    return Motion({"omega": omega} | quantities, motion.radius)


@EACH_RUNG
def test_solid_without_linear_impulse_is_a_rigid_body(name: str) -> None:
    """Kirchhoff's equations with x = 0 are Euler's with K = C, to ten floors each; x stays zero.

    x' = x x Omega makes exact zeros of exact zeros, and so A and B never enter y' or Omega.
    """
    rigid, solid = solve(RIGID, name), solve(without_impulse(), name)
    assert not np.any(solid.motion["linear_impulse"])
    assert apart(rigid, as_rigid(solid.motion), solid.trajectory.steps) <= 1


@pytest.mark.parametrize("broken", ["gyroscopic-sign", "no-gyroscopic-term"])
def test_wrong_rigid_body_is_no_solid_without_impulse(broken: str) -> None:
    """A sign or a term wrong in Euler's equations, the same in all axes and units, shows here."""
    rigid = solve(untracked(RIGID), "f64", DEFECT[broken])
    solid = solve(untracked(without_impulse()), "f64")
    assert apart(rigid, as_rigid(solid.motion), solid.trajectory.steps) >= BLATANT


def test_linear_impulse_matters() -> None:
    """With x = 2^-20 instead of 0 the solid is no rigid body: the relation sees the Munk moment."""
    solid = without_impulse()
    pushed = Impulse((Fraction(1, 2**20), Fraction(0), Fraction(0)), H)
    run = solve(replace(solid, initial=pushed), "f64")
    assert apart(solve(RIGID, "f64"), as_rigid(run.motion), run.trajectory.steps) >= BLATANT


def of_revolution(*, loaded: bool) -> Scene:
    """A body of revolution about axis 3: free, with y3 a constant, or loaded, with y3 a state."""
    body = Clebsch(*(Fraction(225 * c, 1024) for c in (6, 3, 1, -1, 4, 5))).body()
    if not loaded:
        return scene(body, IMMERSED.initial)
    pushed = replace(body, force=vector(1, 2, -1, over=1024), couple=vector(-1, 1, 2, over=1024))
    return scene(pushed, IMMERSED.initial, "attitude", "centre")


def in_21_coefficients(posed: Problem) -> Problem:
    """The same body about the same axis 3 by the general equations.

    y3 is a state, and all 21 coefficients are parameters, also those that are zero.
    """
    known = {**posed.parameter, **posed.state}
    body = {f"{m}{i}{j}": Fraction(0) for m in "ABC" for i in (1, 2, 3) for j in (1, 2, 3)}
    for block, letter in zip("ABC", "pqr", strict=True):
        body |= {f"{block}{i}{i}": known[letter] for i in (1, 2)}
        body[f"{block}33"] = known[f"{letter}'"]
    numbers = body | {name: value for name, value in known.items() if name[0] in "XLs"}
    impulses = ("x1", "x2", "x3", "y1", "y2", "y3")
    states = (*impulses, *(name for name in posed.form.states if name not in impulses))
    form = Form(kirchhoff_equations, states, tuple(numbers))
    # Of A and C the equations name the upper triangles alone.
    form = replace(form, parameters=form.entering())
    parameters = tuple(numbers[name] for name in form.parameters)
    initial = tuple(known[name] for name in states)
    return replace(posed, form=form, parameters=parameters, initial_momenta=initial)


def answered(posed: Problem) -> Run:
    trajectory = Taylor().solve(posed)
    assert trajectory.outcome is Outcome.FINISHED
    return Run(posed, trajectory)


LOADED = pytest.mark.parametrize("loaded", [False, True])
AXIS_3_CALLED = {1: AXES["permuted"], 2: Axes((1, -1, -1, -1))}


@LOADED
@pytest.mark.parametrize("name", [*RUNGS, "mp100"])
def test_clebsch_form_is_the_21_coefficient_form(name: str, loaded: bool) -> None:
    """Clebsch's equations answer as the general ones about the same axis 3, to ten floors each.

    Both start from the same numbers of the rung: only the roundings of the steps differ, in six
    products of the state on the one side, and on the other in 21 coefficients of which 15 are zero.
    """
    clebsch = solve(of_revolution(loaded=loaded), name)
    general = answered(in_21_coefficients(clebsch.problem))
    assert clebsch.problem.form.equations is clebsch_equations
    assert len([n for n in general.problem.form.parameters if n[0] in "ABC"]) == 21
    assert apart(clebsch, general.motion, general.trajectory.steps) <= 1
    # Or the two would be one set of equations, and this no test.
    assert not same_bits(clebsch.motion, general.motion)


@LOADED
@pytest.mark.parametrize("axis", AXIS_3_CALLED)
@EACH_RUNG
def test_axis_of_revolution_may_have_any_number(name: str, axis: int, loaded: bool) -> None:
    """With the axis of revolution called 1 or 2 the motion is the same, to ten floors each.

    Clebsch's equations are then those about that axis, whose component of y is the constant one.
    """
    axes, asked = AXIS_3_CALLED[axis], of_revolution(loaded=loaded)
    clebsch, general = solve(asked, name), solve(axes.of_scene(asked), name)
    assert axes.axial(vector(0, 0, 1)) == tuple(vector(1)[0] * (i == axis) for i in (1, 2, 3))
    assert clebsch.problem.form.equations is clebsch_equations
    assert general.problem.form.equations == ClebschAbout(axis)
    assert loaded == (f"y{axis}" in general.problem.form.states)
    assert apart(clebsch, axes.undone(general.motion), general.trajectory.steps) <= 1


@LOADED
@settings(max_examples=30)
@given(st.lists(st.fractions(-9, 9, max_denominator=99), min_size=13, max_size=13))
def test_clebsch_rates_are_the_general_rates_exactly(loaded: bool, entries: list[Fraction]) -> None:
    """In rationals both right-hand sides are equal at any x, y, q and c, and y3' is L3."""
    asked = replace(of_revolution(loaded=loaded), track=frozenset({"attitude", "centre"}))
    clebsch = pose(asked, rung("f64"))
    general = in_21_coefficients(clebsch)
    state = dict(zip(general.form.states, entries, strict=True))
    rates = rates_at(general, state)
    assert rates_at(clebsch, state).items() <= rates.items()
    assert rates["y3"] == clebsch.parameter.get("L3", 0)


@pytest.mark.parametrize("axis", AXIS_3_CALLED)
@settings(max_examples=30)
@given(st.lists(st.fractions(-9, 9, max_denominator=99), min_size=6, max_size=6))
def test_clebsch_rates_are_the_permuted_rates_exactly(axis: int, entries: list[Fraction]) -> None:
    """In rationals x' and y' of the body whose axis is called 1 or 2 are Clebsch's, permuted."""
    axes, asked = AXIS_3_CALLED[axis], of_revolution(loaded=False)
    clebsch, general = (pose(s, rung("f64")) for s in (asked, axes.of_scene(asked)))
    state = dict(zip(("x1", "x2", "x3", "y1", "y2", "y3"), entries, strict=True))
    here = rates_at(clebsch, state) | {"y3": Fraction(0)}
    there = rates_at(general, permuted(axes, state)) | {f"y{axis}": Fraction(0)}
    assert permuted(axes, here) == there


def rates_at(posed: Problem, state: Mapping[str, Fraction]) -> dict[str, Any]:
    """The rates by name, at a state of more names than the problem's own: y3 may be a parameter."""
    parameters = [{**posed.parameter, **state}[name] for name in posed.form.parameters]
    rates = posed.form.rates([state[name] for name in posed.form.states], parameters)
    return dict(zip(posed.form.states, rates, strict=True))


def permuted(axes: Axes, named: Mapping[str, Fraction]) -> dict[str, Fraction]:
    """x and y, or their rates, in the new axes."""
    vectors = {v: axes.axial(tuple(named[f"{v}{i}"] for i in (1, 2, 3))) for v in "xy"}
    return {f"{v}{i}": e for v, entries in vectors.items() for i, e in enumerate(entries, 1)}


def test_wrong_munk_moment_is_not_clebschs() -> None:
    """The general equations with the sign of x x U turned are not Clebsch's, about whichever axis."""
    axes, asked = AXES["permuted"], of_revolution(loaded=False)
    clebsch, wrong = solve(asked, "f64"), DEFECT["munk-moment-sign"]
    general = solve(axes.of_scene(asked), "f64", wrong)
    image = axes.undone(general.motion)
    assert apart(clebsch, image, general.trajectory.steps) >= BLATANT
    same_axis = wrong.solve(in_21_coefficients(clebsch.problem))
    assert apart(clebsch, same_axis.motion(BITS), same_axis.steps) >= BLATANT
