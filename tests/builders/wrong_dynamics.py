"""Small simulators with one thing wrong in their dynamics, integrated finely, and sound coarse ones."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

from builders import integrators
from builders.numbers import cross
from builders.trajectories import QUATERNION, VECTORS, Columns, named
from taylor_verify.judge.causes.float_answer import Motion
from taylor_verify.judge.causes.likely import Explained, explained
from taylor_verify.judge.causes.material import ExactMotion, material
from taylor_verify.judge.causes.quaternion_rows import steady_signs
from taylor_verify.models.problem import adopt
from taylor_verify.numbers.precision import rung
from taylor_verify.records.reason import Cause, stated
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict
from taylor_verify.scenes.bodies import RigidBody
from taylor_verify.scenes.reading.reader import read
from taylor_verify.scenes.scene import Scene

Array = np.ndarray[Any, np.dtype[np.float64]]
# The derivative of the momenta (omega, or x and y) from themselves, the attitude q, and the numbers.
Rate = Callable[[Array, Array, "Numbers"], Array]
# The derivative of q from q and the angular velocity in body axes.
Turn = Callable[[Array, Array], Array]


class Numbers:
    """The numbers of a scene as doubles, to be changed by who gets them wrong."""

    def __init__(self, scene: Scene) -> None:
        body, start = scene.body, scene.initial
        self.start = float(scene.clock.start)
        self.times = np.array([float(t) for t in scene.clock.instants])
        q = np.array(start.attitude, dtype=float)
        self.q = q / np.linalg.norm(q)
        self.rotor = np.zeros(3)
        self.damping = float(body.damping)
        if isinstance(body, RigidBody):
            self.tensor = np.array(body.inertia, dtype=float)
            self.load = np.array(body.moment, dtype=float)
            self.state = np.array(start.omega, dtype=float)
            self.rotor = np.array(body.rotor, dtype=float)
        else:
            self.tensor = np.array(body.energy_matrix, dtype=float)
            self.load = np.array([*body.force, *body.couple], dtype=float)
            self.state = np.array([*start.linear, *start.angular], dtype=float)


def euler(w: Array, q: Array, n: Numbers) -> Array:
    return np.linalg.solve(n.tensor, cross(n.tensor @ w + n.rotor, w) + n.load) - n.damping * w


def kirchhoff(z: Array, q: Array, n: Numbers) -> Array:
    x, y, velocity = z[:3], z[3:], n.tensor @ z
    U, W = velocity[:3], velocity[3:]
    free = np.concatenate([cross(x, W), cross(y, W) + cross(x, U)])
    return free + n.load - n.damping * z


def turned(q: Array, w: Array) -> Array:
    """q w / 2, w in body axes."""
    return 0.5 * np.array([-q[1:] @ w, *(q[0] * w + cross(q[1:], w))])


def turned_by_space(q: Array, w: Array) -> Array:
    """w q / 2, which takes w for a vector of space."""
    return 0.5 * np.array([-q[1:] @ w, *(q[0] * w - cross(q[1:], w))])


def simulated(
    scene: Scene,
    rate: Rate | None = None,
    turn: Turn = turned,
    change: Callable[[Numbers], None] | None = None,
    times: Array | None = None,
    method: str = "DOP853",
    tolerance: float = 3e-14,
) -> Columns:
    """The columns of a simulator at the scene's times, or at others."""
    n = Numbers(scene)
    if change is not None:
        change(n)
    times = n.times if times is None else times
    solved = solve_ivp(
        derivative(n, rate, turn),
        (n.start, times[-1]),
        np.concatenate([n.state, n.q]),
        method=method,
        t_eval=times,
        rtol=tolerance,
        atol=tolerance * 1e-3,
    )
    return columns_of(times, solved.y.T)


def derivative(
    n: Numbers, rate: Rate | None = None, turn: Turn = turned
) -> Callable[[float, Array], Array]:
    """The rates of momenta and quaternion, one vector."""
    count = len(n.state)
    made = rate or (euler if count == 3 else kirchhoff)

    def rates(_: float, z: Array) -> Array:
        state, q = z[:count], z[count:]
        w = state if count == 3 else (n.tensor @ state)[3:]
        return np.concatenate([made(state, q, n), turn(q, w)])

    return rates


def columns_of(times: Array, rows: Array) -> Columns:
    """Columns of times, momenta and unit quaternions."""
    vectors = ("omega",) if rows.shape[1] == 7 else ("linear_impulse", "angular_impulse")
    columns = named(("t",), np.array(times)[:, None])
    for i, name in enumerate(vectors):
        columns |= named(VECTORS[name], rows[:, 3 * i : 3 * i + 3])
    q = rows[:, 3 * len(vectors) :]
    return columns | named(QUATERNION, q / np.linalg.norm(q, axis=1, keepdims=True))


def runge_kutta(
    scene: Scene,
    h: float,
    every: int,
    single: bool = False,
    factor: Callable[[float], float] | None = None,
    factor_first: bool = False,
) -> Columns:
    """The classical method at a fixed step; with ``single`` its state is kept in float32.

    With ``factor`` the damping is applied once in a step: to the momenta, after the motion or first.
    """
    n = Numbers(scene)
    count, once = len(n.state), 1.0
    if factor is not None:
        once, n.damping = factor(n.damping * h), 0.0
    z = np.concatenate([n.state, n.q])
    steps = round((n.times[-1] - n.start) / h)
    rows = [z]
    for step in range(1, steps + 1):
        if factor_first:
            z = np.concatenate([once * z[:count], z[count:]])
        z = integrators.step(derivative(n), 0.0, z, h)
        if not factor_first:
            z = np.concatenate([once * z[:count], z[count:]])
        if single:
            z = z.astype(np.float32).astype(float)
        if step % every == 0:
            rows.append(z)
    times = n.start + h * every * np.arange(len(rows))
    return columns_of(times, np.array(rows))


def causes(scene: Scene, columns: Columns) -> dict[str, str]:
    """The names and sentences of the causes of an answer whose states failed, whatever their errors."""
    vectors = VECTORS["omega"]
    if scene.model == "kirchhoff":
        vectors = VECTORS["linear_impulse"] + VECTORS["angular_impulse"]
    v, q = (np.array([columns[name] for name in names]).T for names in (vectors, QUATERNION))
    given = adopt(scene, rung("f64"), tuple(map(Fraction, columns["t"]))).given
    noise = (2.0**-53 * np.max(np.abs(v), axis=0), 2.0**-53, 0.0)
    answer = _explained(given, Motion(v, steady_signs(q)), noise, len(v[0]) == 6)
    return {} if answer is None else {cause.name: cause.sentence for cause in answer.causes}


def explained_motion(scene: Scene, file: Motion, noise: float = 0.5e-10) -> Explained:
    """What is found of rows at the times of a scene, all of which failed, with so much noise."""
    given = adopt(scene, rung("f64"), scene.clock.instants).given
    of_columns = np.full(file.v.shape[1], noise)
    answer = _explained(given, file, (of_columns, 0.0 if file.q is None else noise, 0.0))
    return answer


def named_motion(changed: str, text: str, clock: Fraction = Fraction(1)) -> list[str]:
    """The names of the causes of the exact motion of a changed scene, printed in ten digits."""
    return [cause.name for cause in explained_change(changed, text, clock).causes]


def explained_change(changed: str, text: str, clock: Fraction = Fraction(1)) -> Explained:
    """What is found of the exact motion of a changed scene, by another clock, printed in ten digits."""
    scene = read(text, "asked")
    elapsed = [clock * t for t in scene.clock.elapsed]
    moved = ExactMotion(read(changed, "changed"), has_centre=False).at(elapsed, has_momenta=False)
    return explained_motion(scene, Motion(np.round(moved.v, 10), np.round(moved.q, 10)))


def _explained(
    given: Scene, file: Motion, noise: Any, has_momenta: bool = False
) -> Explained | None:
    failures = [failure(given, name) for name in ("omega", "impulse", "attitude")]
    with np.errstate(all="ignore"):
        answer = material(given, file, has_momenta, noise, failures)
        return None if answer is None else explained(answer)


def failure(scene: Scene, quantity: str) -> Verdict:
    """A verdict that says no more than that a quantity failed."""
    reason = stated(Cause.NO_TRUTH, "made for a test")
    status = Status.FAIL
    return Verdict(
        scene.name, "test", "f64", "", quantity, status, outcome="", reason=reason, max=1.0
    )
