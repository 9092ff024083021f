"""All that acts on the rigid body of a question: moment, loads, damping, wheels, and states of one's own.

It needs the standard library alone, and may be copied beside a program of one's own. An engine that takes
a moment goes from one instant to the next so:

    acting = Acting(question, engine.state)
    while acting.t != elapsed:
        h = acting.step(elapsed, longest)
        engine.step(acting.t, h, acting.moment)
        acting.move(h)

``engine.state()`` is omega and the attitude (scalar first, body to space), all in the axes of the question;
``acting.moment(t, state)`` is the moment in body axes at such a state and an elapsed time, also within a
step. No step goes over an instant at which a load switches or a value is taken. What is named here as in
the question is explained in cases/README.md of taylor-verify.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from typing import Any

Vector = Sequence[float]

# The time over which a change of wheels is formed as a difference.
_MOMENTARY = 2.0**-13
_ALIKE = [
    *("sqrt", "exp", "log", "sin", "cos", "tan", "asin", "acos", "atan", "atan2"),
    *("sinh", "cosh", "tanh", "floor"),
]
_INFIX = ("+", "-", "*")
FUNCTIONS: dict[str, Callable[..., float]] = {
    **{name: getattr(math, name) for name in _ALIKE},
    "/": lambda a, b: a / b,
    "pi": lambda: math.pi,
    "abs": abs,
    "min": min,
    "max": max,
    "norm": math.hypot,
    "power": math.pow,
    "sign": lambda a: (a > 0) - (a < 0),
    "step": lambda a: float(a >= 0),
}


def floats(number: Any) -> Any:
    """Return a number, vector or matrix of the question as doubles."""
    if isinstance(number, dict):
        return floats(number["hex"])
    if isinstance(number, list):
        return [floats(entry) for entry in number]
    return float.fromhex(number)


class Piece:
    """The steps between two switches: what is between ``begin`` and ``end``, elapsed times."""

    def __init__(self, piece: Mapping[str, Any]) -> None:
        self.begin = -math.inf if piece["from"] is None else float(Fraction(piece["from"]))
        self.end = math.inf if piece["to"] is None else float(Fraction(piece["to"]))
        self._steps = [_prepared(step) for step in piece["steps"]]
        self._programs: dict[tuple[int, ...], Callable[[Mapping[str, float]], list[float]]] = {}
        self.moment: list[int] = piece.get("moment", [])
        self.wrench: list[int] = [*piece.get("force", []), *piece.get("couple", [])]
        self.rates: list[int] = piece.get("rates", [])
        self.taken: list[int] = piece.get("values", [])
        self.rotor: list[int] = piece.get("rotor", [])

    def values(self, places: Sequence[int], known: Mapping[str, float]) -> list[float]:
        """Return the values of the steps at some places; ``known`` has the inputs by name."""
        return self._program(tuple(places))(known)

    def _program(self, places: tuple[int, ...]) -> Callable[[Mapping[str, float]], list[float]]:
        """Return the steps as one function of Python, ten times as fast as one by one."""
        if places not in self._programs:
            lines = [f" v{k} = {_text(self._steps[k])}" for k in self._needed(places)]
            values = ", ".join(f"v{place}" for place in places)
            names: dict[str, Any] = {"nan": math.nan, "inf": math.inf, "at": _at}
            # The names in the text are those of the protocol, and quoted.
            exec("\n".join(["def program(known):", *lines, f" return [{values}]"]), names)
            self._programs[places] = names["program"]
        return self._programs[places]

    def _needed(self, places: Sequence[int]) -> list[int]:
        """Return the places of all steps that some places need."""
        needed, waiting = set[int](), [*places]
        while waiting:
            if (place := waiting.pop()) not in needed:
                needed.add(place)
                waiting += self._steps[place][2]
        return sorted(needed)


def _prepared(step: Sequence[Any]) -> tuple[str, list[float], list[int]]:
    """Return the word of a step (its name, where it is an input), its number and its operands."""
    word, *rest = step
    if word == "input":
        return rest[0], [], []
    if word not in ("number", "power"):
        return word, [], rest
    *operands, _, number = rest
    return word, [float.fromhex(number)], operands


def _text(step: tuple[str, list[float], list[int]]) -> str:
    """Return a step as an expression of Python."""
    word, numbers, operands = step
    of = [f"v{k}" for k in operands]
    if word == "number":
        return repr(numbers[0])
    if word in _INFIX:
        return f" {word} ".join(of)
    if word == "choose":
        return f"{of[1]} if {of[0]} >= 0 else {of[2]}"
    if word in FUNCTIONS:
        return f"at({', '.join([repr(word), *of, *map(repr, numbers)])})"
    return f"known.get({word!r}, nan)"


def _at(word: str, *values: float) -> float:
    """Return a function at a point; what has no value may be a branch that is not chosen."""
    try:
        return FUNCTIONS[word](*values)
    except (ArithmeticError, ValueError):
        return math.nan


class Acting:
    """All that acts, from the start of a question on; ``state()`` is the present one of the engine.

    ``t`` is the time since the start.
    """

    def __init__(self, question: Mapping[str, Any], state: Callable[[], Vector]) -> None:
        body, initial = question["body"], {s["name"]: s for s in question.get("states", [])}
        self.t, self._state = 0.0, state
        self._sign = -1.0 if floats(question["time"]["elapsed"])[-1] < 0 else 1.0
        self._inertia, self._constant = floats(body["inertia"]), floats(body["moment"])
        self._wheels = floats(body["rotor"]) if "rotor" in body else [0.0] * 3
        self._damping = floats(body["damping"]) if "damping" in body else 0.0
        self._inverse = floats(body["inverse_inertia"])
        self._pieces = list(map(Piece, question.get("loads", {}).get("pieces", [])))
        self._values = {name: floats(s["start"]) for name, s in initial.items() if s["start"]}
        # A quaternion and its negative are one attitude; loads read the one that goes on from the scene's.
        self._attitude: Vector = floats(question["initial"]["attitude"])
        self._moving = [name for name, s in initial.items() if "rate" in s]
        self._held = [name for name, s in initial.items() if "value" in s]
        self._pending = [(floats(at), names) for at, names in question.get("instants", [])]
        self._stops = [at for at, _ in self._pending] + [piece.end for piece in self._pieces[:-1]]
        self._arrive(self.t)

    @property
    def own(self) -> dict[str, float]:
        """The present states of one's own, by name."""
        return dict(self._values)

    def step(self, until: float, longest: float) -> float:
        """Return the length of the next step on the way to an instant, none longer than ``longest``."""
        ahead = [stop for stop in self._stops if (stop - self.t) * self._sign > 0]
        self._target = min([until, *ahead], key=lambda stop: abs(stop - self.t))
        self._left = max(1, math.ceil(abs(self._target - self.t) / longest - 1e-6))
        return (self._target - self.t) / self._left

    def move(self, step: float) -> None:
        """Note that the engine has made this step."""
        self.move_to(self._target if self._left == 1 else self.t + step)

    def move_to(self, t: float) -> None:
        """Note that the engine has gone on to this time; one's own states are there, too."""
        before, ahead = self.t, self._ahead(t)
        self._values |= ahead
        self.t = t
        self._arrive(before)

    def moment(self, t: float, state: Vector) -> list[float]:
        """Return the moment in body axes, of all that acts: I w' = I w x w + this."""
        return self._moment(t, state, self._known(t, state, self._ahead(t)))

    def _moment(self, t: float, state: Vector, known: Mapping[str, float]) -> list[float]:
        omega, momentum = state[:3], _times(self._inertia, state[:3])
        moment = [M - self._damping * H for M, H in zip(self._constant, momentum, strict=True)]
        if not self._pieces:
            return _plus(moment, _cross(self._wheels, omega))
        moment = _plus(moment, self._piece.values(self._piece.moment, known))
        if not self._piece.rotor:
            return _plus(moment, _cross(self._wheels, omega))
        wheels, reaction = self._turning(t, known)
        return _plus(_plus(moment, _cross(wheels, omega)), reaction)

    def _ahead(self, t: float) -> dict[str, float]:
        """Return one's own continuous states at a time within the step.

        They depend on the motion, which goes on from the state of the engine at the begin of the step by
        the classical method of Runge and Kutta: of the motion itself nothing reaches the engine.
        """
        if not self._moving or t == self.t:
            return {}
        if t not in self._foreseen:
            start = [*self._begin, *(self._values[name] for name in self._moving)]
            end = _runge_kutta(self._rates, self.t, start, t - self.t)
            self._foreseen[t] = dict(zip(self._moving, end[7:], strict=True))
        return self._foreseen[t]

    def _rates(self, t: float, y: Vector) -> list[float]:
        """Return the rates of omega, the attitude and one's own states, y in this order."""
        omega, (p, *v) = y[:3], y[3:7]
        known = self._known(t, y[:7], dict(zip(self._moving, y[7:], strict=True)))
        gyroscopic = _cross(_times(self._inertia, omega), omega)
        spin_up = _times(self._inverse, _plus(gyroscopic, self._moment(t, y[:7], known)))
        turn = _plus([p * w for w in omega], _cross(v, omega))
        attitude = [-sum(a * w for a, w in zip(v, omega, strict=True)), *turn]
        own = self._piece.values(self._piece.rates, known)
        return [*spin_up, *(entry / 2 for entry in attitude), *own]

    def _arrive(self, before: float) -> None:
        """Take the values that are due, all of them before any is set, and begin what begins here."""
        # A clock that counts steps may be a rounding beside an instant.
        near = 1e-9 * abs(self.t - before)
        here, state = self._sign * self.t + near, self._state()
        self._attitude = continued(state[3:], self._attitude)
        for piece in self._pieces:
            first, last = sorted((piece.begin * self._sign, piece.end * self._sign))
            if first <= here < last:
                self._piece = piece
        due = set[str]()
        while self._pending and self._pending[0][0] <= here:
            due.update(self._pending.pop(0)[1])
        if due:
            values = self._piece.values(self._piece.taken, self._known(self.t, state, {}))
            taken = dict(zip(self._held, values, strict=True))
            self._values |= {name: taken[name] for name in due}
        self._begin = [*map(float, state[:3]), *self._attitude]
        self._foreseen: dict[float, dict[str, float]] = {}

    def _known(self, t: float, state: Vector, own: Mapping[str, float]) -> dict[str, float]:
        attitude = continued(state[3:], self._attitude)
        return {"t": t, **inputs([*state[:3], *attitude]), **self._values, **own}

    def _turning(self, t: float, known: Mapping[str, float]) -> tuple[Vector, Vector]:
        """Return the momentum of wheels whose momentum changes, and what its change does to the body."""
        piece = self._piece
        rates = dict(zip(self._moving, piece.values(piece.rates, known), strict=True))

        def at(later: float) -> Vector:
            own = {name: known[name] + later * rate for name, rate in rates.items()}
            return piece.values(piece.rotor, {**known, **own, "t": t + later})

        ends = zip(at(_MOMENTARY), at(-_MOMENTARY), strict=True)
        return at(0.0), [(b - a) / (2 * _MOMENTARY) for a, b in ends]


def _runge_kutta(
    rates: Callable[[float, Vector], Vector], t: float, y: Vector, h: float
) -> list[float]:
    """Return y a step h later, by the classical method."""
    k1 = rates(t, y)
    k2 = rates(t + h / 2, _moved(y, h / 2, k1))
    k3 = rates(t + h / 2, _moved(y, h / 2, k2))
    k4 = rates(t + h, _moved(y, h, k3))
    slopes = zip(k1, k2, k3, k4, strict=True)
    return _moved(y, h / 6, [a + 2 * b + 2 * c + d for a, b, c, d in slopes])


def _moved(y: Vector, h: float, slopes: Vector) -> list[float]:
    return [a + h * b for a, b in zip(y, slopes, strict=True)]


def inputs(state: Vector) -> dict[str, float]:
    """Return what loads may read of omega and a unit quaternion, by name."""
    w1, w2, w3, *q = state
    q0, q1, q2, q3 = q
    return {
        "w1": w1, "w2": w2, "w3": w3, "q0": q0, "q1": q1, "q2": q2, "q3": q3,
        "r11": 1 - 2 * (q2 * q2 + q3 * q3), "r12": 2 * (q1 * q2 - q0 * q3), "r13": 2 * (q1 * q3 + q0 * q2),
        "r21": 2 * (q1 * q2 + q0 * q3), "r22": 1 - 2 * (q1 * q1 + q3 * q3), "r23": 2 * (q2 * q3 - q0 * q1),
        "r31": 2 * (q1 * q3 - q0 * q2), "r32": 2 * (q2 * q3 + q0 * q1), "r33": 1 - 2 * (q1 * q1 + q2 * q2),
    }  # fmt: skip


def continued(attitude: Vector, before: Vector) -> list[float]:
    """Return the quaternion or its negative, whichever is nearer to the one before."""
    is_near = sum(a * b for a, b in zip(attitude, before, strict=True)) >= 0
    return [entry if is_near else -entry for entry in attitude]


def _times(matrix: Sequence[Vector], v: Vector) -> list[float]:
    return [sum(a * b for a, b in zip(row, v, strict=True)) for row in matrix]


def _cross(a: Vector, b: Vector) -> list[float]:
    return [a[i] * b[j] - a[j] * b[i] for i, j in ((1, 2), (2, 0), (0, 1))]


def _plus(a: Vector, b: Vector) -> list[float]:
    return [x + y for x, y in zip(a, b, strict=True)]
