"""The equations of a body under loads that a scene writes down, as elementary steps.

v            the velocity of the fluid, space axes, over which the centre drifts
g1, g2, ..   the numbers of the steps, and the units of what they read: parameters, as all numbers are
own.h1, ..   the scene's own continuous states
held.m, ..   its held ones: parameters, between two instants
t            the time since the start: it is no state, but handed over with each state

Where a text writes the momentum h of wheels, H = I w + h is the state: H' = H x w + M with w = K (H - h),
so that what their motors do to the body follows by itself.

The steps count in the scene's own units. Each input and each load is multiplied by its unit, which is a
power of two.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from typing import Any, Final

from taylor_verify.models import own
from taylor_verify.models.algebra import add, apply, cross, is_absent, minus, plus, times
from taylor_verify.models.form import Equations, Named, labelled
from taylor_verify.models.frame import rotation
from taylor_verify.models.functions import Functions, functions_of
from taylor_verify.models.kirchhoff import velocities
from taylor_verify.models.symbol import Symbol
from taylor_verify.models.units import Units
from taylor_verify.numbers.tensors import Vector
from taylor_verify.scenes.loads.loads import CENTRE, Loads, Piece
from taylor_verify.scenes.loads.steps import Step, needed

# The letters of the loads and of the momenta, by the number of the loads.
_LETTERS: Final = {3: ("M",), 6: ("X", "L")}
_ARITHMETIC: Final = {"+": plus, "-": minus, "*": times}


@dataclass(frozen=True)
class Written:
    """The equations ``free`` of a body under the loads of some steps.

    A step "number" has the name of its parameter. Two scenes with the same steps share one compiled
    integrator, whatever their numbers are. ``outputs`` are the places of the loads, ``rates`` those of the
    rates of the states ``own``, and ``rotor`` those of the momentum of the wheels where a text writes it.
    """

    free: Equations
    steps: tuple[Step, ...]
    outputs: tuple[int, ...]
    own: tuple[str, ...] = ()
    rates: tuple[int, ...] = ()
    rotor: tuple[int, ...] = ()

    def __hash__(self) -> int:
        # Many tables are asked by equations; a hundred steps take longer than what the tables spare.
        return self._hash

    @cached_property
    def _hash(self) -> int:
        places = (self.outputs, self.own, self.rates, self.rotor)
        return hash((self.free, self.steps, places))

    def __getstate__(self) -> dict[str, Any]:
        # Another process has other hashes of the same texts.
        return {name: part for name, part in vars(self).items() if name != "_hash"}

    def __call__(self, n: Named) -> dict[str, Any]:
        return self._all_rates(n, self.values(n))

    def anew(self, made: Growing, turned: Callable[[Step], int]) -> Written:
        """Return the same equations by the steps in ``made``, where ``turned`` puts each present one."""
        for place, step in enumerate(self.steps):
            made.places[place] = turned(step)
        groups = (self.outputs, self.rates, self.rotor)
        outputs, rates, rotor = (tuple(made.places[k] for k in group) for group in groups)
        return replace(self, steps=tuple(made.steps), outputs=outputs, rates=rates, rotor=rotor)

    def _all_rates(self, n: Named, values: Any) -> dict[str, Any]:
        """Return the rates of all states, by the values of the steps at their places."""
        rates = self._rates(n, self._loads([values[k] for k in self.outputs]), values)
        return rates | {name: values[k] for name, k in zip(self.own, self.rates, strict=True)}

    def _rates(self, n: Named, loads: Mapping[str, Any], values: Any) -> dict[str, Any]:
        """Return the rates under these loads, and with the drift of the fluid in that of the centre."""
        wheels = [values[k] for k in self.rotor]
        body = Named({**n, **loads, **_alone(n, wheels)})
        rates = dict(self.free(body))
        if wheels:
            turned = cross(wheels, apply(n.symmetric("K"), body.vector("H")))
            rates |= labelled("H", add([rates[name] for name in ("H1", "H2", "H3")], turned))
        if "c1" in rates:
            rates |= labelled("c", add([rates[f"c{i}"] for i in (1, 2, 3)], n.vector("v")))
        return rates

    def lines(self, n: Named) -> dict[str, Any]:
        """Return the rates by the loads, the loads by the steps k0, k1, .., and each step."""
        names = [Symbol(f"k{place}") for place in range(len(self.steps))]
        loads = self._loads([names[place] for place in self.outputs])
        rates = self._rates(n, {name: Symbol(name) for name in loads}, names)
        rates |= {name: names[k] for name, k in zip(self.own, self.rates, strict=True)}
        functions, inputs = functions_of(names[0]), self.inputs(n)
        steps = {
            names[place].name: value(step, names, functions, inputs)
            for place, step in enumerate(self.steps)
        }
        return {f"{name}'": rate for name, rate in rates.items() if name in n} | loads | steps

    def _loads(self, values: Sequence[Any]) -> dict[str, Any]:
        loads: dict[str, Any] = {}
        for k, letter in enumerate(_LETTERS[len(values)]):
            loads |= labelled(letter, values[3 * k : 3 * k + 3])
        return loads

    def values(self, n: Named) -> list[Any]:
        """Return the value of each step."""
        inputs, functions = self.inputs(n), _functions(n)
        values = list[Any]()
        for step in self.steps:
            values.append(value(step, values, functions, inputs))
        return values

    def inputs(self, n: Named) -> Inputs:
        """Return what the steps read, by name; the momentum is that of the body without its wheels."""
        wheels = dict[int, Any]()
        for place in needed(self.steps, self.rotor):
            # The momentum of wheels reads none itself.
            wheels[place] = value(self.steps[place], wheels, _functions(n), Inputs(n))
        return Inputs(Named({**n, **_alone(n, [wheels[k] for k in self.rotor])}))


def _functions(n: Named) -> Functions:
    return functions_of(n["H1"] if "H1" in n else n["x1"])


def _alone(n: Named, wheels: Sequence[Any]) -> dict[str, Any]:
    """Return the momentum of the body without its wheels, where these have any by a text."""
    if not wheels:
        return {}
    return labelled("H", [minus(H, h) for H, h in zip(n.vector("H"), wheels, strict=True)])


class Growing:
    """Steps that grow in place of others; ``places`` are where those went."""

    def __init__(self) -> None:
        self.steps: list[Step] = []
        self.places: dict[int, int] = {}

    def add(self, step: Step) -> int:
        """Return the place of one step more."""
        self.steps.append(step)
        return len(self.steps) - 1

    def moved(self, step: Step) -> int:
        """Return the place of a step that stays as it is, on the new places of its operands."""
        return self.add(replace(step, operands=tuple(self.places[k] for k in step.operands)))


class Inputs:
    """Inputs that steps read, in the units of the problem, each formed where it is asked for."""

    def __init__(self, n: Named) -> None:
        self._n, self._formed = n, dict[str, Any]()

    def __getitem__(self, name: str) -> Any:
        if name[0] in "wur" and name not in self._formed:
            self._formed |= self._turned() if name[0] == "r" else self._moved()
        return self._n[f"e{name[1]}"] if name[0] == "q" else self._formed.get(name, self._n[name])

    def _moved(self) -> dict[str, Any]:
        n = self._n
        if "H1" in n:
            return labelled("w", apply(n.symmetric("K"), n.vector("H")))
        blocks = n.symmetric("A"), n.matrix("B"), n.symmetric("C")
        U, Omega = velocities(n.vector("x"), n.vector("y"), *blocks)
        return labelled("u", U) | labelled("w", Omega)

    def _turned(self) -> dict[str, Any]:
        R = rotation(self._n.quaternion())
        return {f"r{i + 1}{j + 1}": R[i][j] for i in range(3) for j in range(3)}


def value(step: Step, values: Any, functions: Functions, inputs: Any) -> Any:
    """Return the value of a step, from those before it."""
    operands = [values[place] for place in step.operands]
    match step.operation:
        case "number" | "input":
            return inputs[step.name]
        case "+" | "-" | "*":
            return _ARITHMETIC[step.operation](*operands)
        case "/":
            return operands[0] if is_absent(operands[0]) else operands[0] / operands[1]
        case "power":
            return _power(operands[0], step.number or Fraction(0), functions)
    return functions[step.operation](*operands)


def _power(base: Any, exponent: Fraction, functions: Functions) -> Any:
    """Return a rational power; a whole one by products, so that its base may be zero or negative."""
    if exponent.denominator != 1:
        return functions["power"](base, exponent)
    result: Any = None
    square, left = base, abs(int(exponent))
    while left:
        if left & 1:
            result = square if result is None else result * square
        left >>= 1
        square = square * square if left else square
    return 1 / result if exponent < 0 else result


# Steps in the units of a problem.


def counted(
    equations: Equations, loads: Loads, piece: Piece, units: Units, centre: Vector
) -> tuple[Written, Mapping[str, Fraction]]:
    """Return the equations under the loads of a piece of time in these units, and their numbers by name.

    ``centre`` is where the body starts: the states have the way from there.
    """
    made = _Counting()
    for k in needed(piece.steps, (*piece.outputs, *piece.rates, *piece.rotor)):
        step = piece.steps[k]
        if step.operation == "input":
            name = own.in_form(step.name, loads)
            place = made.scaled(
                made.add(Step("input", name=name)), unit_of(step.name, loads, units)
            )
            if step.name in CENTRE:
                start = centre[int(step.name[1]) - 1]
                place = made.add(Step("+", (place, made.number(start)))) if start else place
        elif step.operation == "number":
            place = made.number(step.number or Fraction(0))
        else:
            place = made.moved(step)
        made.places[k] = place

    def outputs(group: Sequence[int], factors: Sequence[Fraction]) -> tuple[int, ...]:
        pairs = zip(group, factors, strict=True)
        return tuple(made.scaled(made.places[place], factor) for place, factor in pairs)

    momenta = (units.impulse,) * (len(piece.outputs) - 3) + (units.momentum,) * 3
    written = Written(
        equations,
        (),
        outputs(piece.outputs, [units.time / unit for unit in momenta]),
        tuple(own.in_form(name, loads) for name in loads.continuous),
        outputs(piece.rates, [units.time / unit for unit in units.own]),
        outputs(piece.rotor, [1 / units.momentum] * len(piece.rotor)),
    )
    return replace(written, steps=tuple(made.steps)), made.numbers


class _Counting(Growing):
    """Steps of which every number becomes a parameter."""

    def __init__(self) -> None:
        super().__init__()
        self.numbers: dict[str, Fraction] = {}

    def number(self, value: Fraction) -> int:
        name = f"g{len(self.numbers) + 1}"
        self.numbers[name] = value
        return self.add(Step("number", name=name))

    def scaled(self, place: int, unit: Fraction) -> int:
        """The place of a step times a power of two."""
        return place if unit == 1 else self.add(Step("*", (self.number(unit), place)))


def unit_of(name: str, loads: Loads, units: Units) -> Fraction:
    """Return the unit of an input of the steps; held values have none."""
    if name in loads.held_values:
        return Fraction(1)
    if name in loads.continuous:
        return units.own[loads.continuous.index(name)]
    match name[0]:
        case "t":
            return units.time
        case "w":
            return 1 / units.time
        case "u":
            return units.length / units.time
        case "x":
            return units.impulse
        case "y":
            return units.momentum
        case "c":
            return units.centre
    return Fraction(1)


def drift(current: Vector, units: Units) -> dict[str, Fraction]:
    """Return the velocity of the fluid, as far as it is not zero, in the unit of the centre's rate."""
    unit = units.centre / units.time
    return {name: v / unit for name, v in labelled("v", current).items() if v}


def sentences(loads: Loads) -> tuple[str, ...]:
    """Return a sentence that explains the loads to a reader."""
    count = len(loads.switches)
    pieces = f", others in each of {count + 1} pieces of time" if count else ""
    return (f"the loads are elementary steps{pieces}; g1, g2, .. are their numbers and units",)
