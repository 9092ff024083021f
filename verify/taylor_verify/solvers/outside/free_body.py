"""Reader of a free rigid body for physics engines, and writer of its motion, shared by their scripts.

A script has a function ``solve(body, settings) -> Solved`` and ends with ``answer(solve)``. Each of its
states is made by ``body.row`` or ``body.row_from_space``: omega in body axes, then the attitude.
An engine with a fixed step leaves the loop over the samples to `stepped`:

    def solve(body, settings):
        def start():
            ...build the engine at the initial state...
            return advance, row

        return stepped(body, settings.step, start)

``advance(steps)`` goes on by that many steps, and ``row()`` reads the present state. The first row is
read before any step, so that it shows the state that the engine really begins with.

A script with ``loads = "written"`` in its metadata ends with ``answer(solve, pushed_body)``. Where
``body.is_pushed`` it hands ``body.moment`` or ``body.moment_in_space`` to its engine: the moment of all
that acts but the body's own inertia. A remark says how: an engine that holds it over a step has order 1 by
that.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any, ClassVar

from acting import Acting
from axes import (
    IDENTITY,
    Matrix,
    Quaternion,
    Vector,
    conjugate,
    principal,
    product,
    to_body,
    to_space,
)
from question import (
    Question,
    Row,
    Settings,
    Solved,
    Unsuited,
    document,
    floats,
    read,
    serve,
    timed,
    unit,
)

# How to go on by a number of steps, and how to read the state as a row.
Engine = tuple[Callable[[int], Any], Callable[[], Row]]

_NAMES = ("w1", "w2", "w3", "q0", "q1", "q2", "q3")


@dataclass(frozen=True, kw_only=True)
class Body:
    """The base of all bodies for engines: the question that asks for the motion.

    ``push`` is what acts on the body, if anything does: it can `begin` and `move_to` a time.
    """

    question: Question
    attitude: Quaternion
    push: Any = None
    # What acts has to know the state after each step.
    reads_rows: ClassVar[bool] = False

    @property
    def instants(self) -> Sequence[float]:
        instants: Sequence[float] = self.question.instants
        return instants

    @property
    def remark(self) -> str:
        """A sentence on what an engine is given in place of what the question has."""
        return ""

    @property
    def is_pushed(self) -> bool:
        """True if anything acts on the body besides its own inertia, and that of a fluid."""
        return self.push is not None

    def begin(self) -> None:
        """Go back to the start with what acts."""
        self.push.begin()

    def goes_on(self, steps: int, step: float) -> None:
        """Go on with what acts, after so many steps of the engine."""
        self.push.move_to(self.question.sign * steps * step)

    def accompanied(self, start: Callable[[], Engine], step: float) -> Engine:
        """Return the engine that ``start`` builds; where anything acts, that goes on after each step."""
        if not self.is_pushed:
            return start()
        self.begin()
        advance, row = start()
        done = 0

        def one_by_one(steps: int) -> None:
            nonlocal done
            for _ in range(steps):
                advance(1)
                if self.reads_rows:
                    row()
                done += 1
                self.goes_on(done, step)

        return one_by_one, row

    def steps(self, step: float) -> list[int]:
        """Return the number of steps to each instant; raises Unsuited if one is no multiple."""
        counts = [round(instant / step) for instant in self.instants]
        # The instants are rounded to the rung, and so is the step in the engine.
        roundoff = 4 * 0.5**self.question.bits
        for instant, count in zip(self.instants, counts, strict=True):
            if not abs(instant / step - count) <= roundoff * count:
                raise Unsuited(f"expected a step that divides t = {instant!r}, got {step!r} @ step")
        return counts


class Push:
    """All that acts on the body of a question, and its own states, beside an engine that moves the body.

    ``state`` is the last one that was read, in the axes and the time of the question.
    """

    def __init__(self, scene: Any, start: Row) -> None:
        self._scene, self._start = scene, start
        self.begin()

    def begin(self) -> None:
        """Go back to the start."""
        self.state = self._start
        self.acting = Acting(self._scene, lambda: self.state)

    def move_to(self, t: float) -> None:
        """Go on to a time; the state there was read."""
        self.acting.move_to(t)


@dataclass(frozen=True, kw_only=True)
class FreeBody(Body):
    """Inertia, omega in body axes and attitude (unit, scalar first, body to space), as doubles.

    A motion backwards in time is the motion forwards with omega reversed, and is given as that one.
    ``turn`` leads from the axes given here to those of the question: they differ in principal axes.
    """

    inertia: Matrix
    omega: Vector
    turn: Quaternion = IDENTITY
    reads_rows: ClassVar[bool] = True

    def moment(self, omega: Vector, attitude: Quaternion, time: float | None = None) -> Vector:
        """Return the moment on the body that is given here, at a state and a time of the engine.

        All are in body axes; without a time it is that of the last step.
        """
        acting, state = self.push.acting, self._state(omega, unit(attitude))
        moment = acting.moment(acting.t if time is None else self.question.sign * time, state)
        return moment if self.turn == IDENTITY else to_body(self.turn, moment)

    def moment_in_space(self, omega: Vector, attitude: Quaternion) -> Vector:
        """Return the same in space axes, of omega in space axes, at the time of the last step."""
        return to_space(attitude, self.moment(to_body(attitude, omega), attitude))

    @property
    def moments(self) -> Vector:
        """The principal moments; raises Unsuited where the axes are not principal ones."""
        if any(self.inertia[i][j] for i in range(3) for j in range(3) if i != j):
            raise Unsuited("expected principal axes, got products of inertia @ inertia")
        return [self.inertia[i][i] for i in range(3)]

    @property
    def excess(self) -> str:
        """A sentence on moments that no solid has: the largest is more than the other two together."""
        a, b, c = sorted(principal(self.inertia)[0])
        return f"principal moments of a solid, got {a!r}, {b!r}, {c!r}" if c > a + b else ""

    @property
    def remark(self) -> str:
        """A sentence on the axes, where the engine is given others than the question."""
        return "" if self.turn == IDENTITY else "solved in principal axes, and turned back"

    @property
    def omega_in_space(self) -> Vector:
        return to_space(self.attitude, self.omega)

    def in_principal_axes(self) -> FreeBody:
        """Return the same body in principal axes, for engines that take three moments alone.

        A diagonal tensor stays as it is. Rows come back in the axes of the question.
        """
        moments, turn = principal(self.inertia)
        if turn == IDENTITY:
            return self
        return replace(
            self,
            inertia=[[moments[i] if i == j else 0.0 for j in range(3)] for i in range(3)],
            omega=to_body(turn, self.omega),
            attitude=product(self.attitude, turn),
            turn=turn,
        )

    def row(self, omega: Vector, attitude: Quaternion) -> Row:
        """Return a row of the answer, of omega in body axes and the attitude that an engine has."""
        state, columns = self._state(omega, attitude), self.question.columns
        if self.push is None:
            return state[: len(columns)]
        self.push.state = state
        named = dict(zip(_NAMES, state, strict=True)) | self.push.acting.own
        return [named[name] for name in columns]

    def _state(self, omega: Vector, attitude: Quaternion) -> list[float]:
        """Return omega and the attitude in the axes and the time of the question."""
        sign, turn = self.question.sign, self.turn
        omega = [sign * float(w) for w in omega]
        attitude = [float(q) for q in attitude]
        if turn != IDENTITY:
            omega, attitude = to_space(turn, omega), product(attitude, conjugate(turn))
        return [*omega, *attitude]

    def row_from_space(self, omega: Vector, attitude: Quaternion) -> Row:
        """Return a row of the answer, of omega in space axes and the attitude."""
        return self.row(to_body(attitude, omega), attitude)


def answer(
    solve: Callable[[Any, Settings], Solved], read: Callable[[Any], Body] | None = None
) -> None:
    """Read the question on stdin, or many, solve it as the arguments say, write the answer on stdout.

    ``read`` makes a body of the question, a free rigid one unless another reader is given.
    """
    # Engines greet on standard output, in C too; it is for the answer alone.
    with os.fdopen(os.dup(sys.stdout.fileno()), "w") as out:
        os.dup2(sys.stderr.fileno(), sys.stdout.fileno())

        def answered(scene: Any, settings: Settings) -> dict[str, Any]:
            body = (read or free_body)(scene)
            return document(body.question, _solved(solve, body, settings))

        serve(answered, out)


def _solved(solve: Callable[[Any, Settings], Solved], body: Body, settings: Settings) -> Solved:
    """Return the motion; raises Unsuited where an engine ends on moments that no solid has."""
    try:
        return solve(body, settings)
    except Exception as error:
        if isinstance(body, FreeBody) and (excess := body.excess):
            words = " ".join(str(error).split())
            raise Unsuited(f"expected {excess} @ inertia ({words})") from error
        raise


def free_body(scene: Any) -> FreeBody:
    """Return the body of a question; raises Unsuited where it is not free."""
    body = pushed_body(scene)
    if body.is_pushed:
        raise Unsuited("expected a free rigid body, got a moment, wheels or damping @ body")
    return body


def pushed_body(scene: Any) -> FreeBody:
    """Return the body of a question, with what acts on it; raises Unsuited where it is in a fluid."""
    question = read(scene, takes_loads=True)
    if scene["model"] != "euler":
        raise Unsuited("expected a free rigid body, got one in a fluid @ body")
    attitude = unit(floats(scene["initial"]["attitude"]))
    acts = {"rotor", "damping"} & scene["body"].keys() or any(floats(scene["body"]["moment"]))
    start = [*floats(scene["initial"]["omega"]), *attitude]
    return FreeBody(
        inertia=floats(scene["body"]["inertia"]),
        omega=[question.sign * w for w in floats(scene["initial"]["omega"])],
        attitude=attitude,
        question=question,
        push=Push(scene, start) if acts or "loads" in scene else None,
    )


def stepped(body: Body, step: float, start: Callable[[], Engine], remark: str = "") -> Solved:
    """Return the motion by a fixed step; ``start`` builds the engine anew and is not timed.

    The propagation is done twice, and the second is timed, as by `question.twice`.
    """
    counts = body.steps(step)

    def rows_and_seconds() -> tuple[list[Row], float]:
        advance, row = body.accompanied(start, step)

        def propagate() -> list[Row]:
            rows = [row()]
            for before, count in pairwise(counts):
                advance(count - before)
                rows.append(row())
            return rows

        return timed(propagate)

    _, first = rows_and_seconds()
    rows, second = rows_and_seconds()
    compiling = max(0.0, first - second)
    return Solved(
        rows,
        counts[-1],
        evaluations=0,
        seconds=second,
        compile_seconds=compiling,
        remark=remark or body.remark,
    )


def pushed_once(body: Body) -> str:
    """Return the remark of an engine that is pushed once a step; the body's own where nothing acts."""
    return _pushed(body, "what acts is held over each step")


def pushed_in_stages(body: Body) -> str:
    """Return the remark of an engine that is pushed in each stage; the body's own where nothing acts."""
    return _pushed(body, "what acts is asked for in each stage of a step")


def _pushed(body: Body, how: str) -> str:
    return "; ".join(filter(None, (body.remark, how if body.is_pushed else "")))


def repeated(step: Callable[[], Any]) -> Callable[[int], None]:
    """Return how to go on by a number of steps, for an engine that makes one at a time."""

    def advance(steps: int) -> None:
        for _ in range(steps):
            step()

    return advance


def in_space(
    body: FreeBody,
    step: Callable[[], Any],
    state: Callable[[], tuple[Vector, Quaternion]],
    push: Callable[[Vector], Any],
) -> Engine:
    """Return an engine in space axes that makes one step at a time, under a torque that it holds.

    ``state()`` is omega in space axes and the attitude, and ``push(moment)`` sets the torque of one step.
    """

    def pushed_step() -> None:
        push(body.moment_in_space(*state()))
        step()

    return repeated(pushed_step if body.is_pushed else step), lambda: body.row_from_space(*state())
