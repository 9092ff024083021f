"""The loads of a manufactured motion: chosen first, as a trigonometric polynomial, and written as texts.

z*(t)  omega (a rigid body) or x and y as one vector of six (a solid in a fluid), body axes
t      time since the start
nu     angular frequency of a wave, 1/time

z* solves the equations of motion of any body whose loads are the remainder when z* is put into them:
M = I omega*' + omega* x I omega*, or X = x*' - x* x Omega* and
L = y*' - y* x Omega* - x* x U*. So a motion under loads that change with time has an exact answer, for
every tensor and every T.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import reduce

from taylor_verify.numbers import tensors
from taylor_verify.numbers.tensors import ZERO_VECTOR, Matrix, Vector, identity
from taylor_verify.scenes.bodies import Body
from taylor_verify.scenes.loads.loads import Loads
from taylor_verify.scenes.loads.vocabulary import Entry


@dataclass(frozen=True)
class Wave:
    """cosine cos(nu t) + sine sin(nu t), of the vector z*; ``frequency`` nu is positive."""

    frequency: Fraction
    cosine: Vector
    sine: Vector


@dataclass(frozen=True)
class Manufactured:
    """z*(t) = constant + the sum of the waves, all coefficients exact."""

    constant: Vector
    waves: tuple[Wave, ...]

    @property
    def start(self) -> Vector:
        """z*(0), where every cosine is 1 and every sine 0: rational as its coefficients are."""
        return reduce(tensors.plus, (wave.cosine for wave in self.waves), self.constant)

    def loads(self, body: Body, origin: Fraction) -> Loads:
        """Return the loads of a body under which z* is its motion from the time ``origin`` on."""
        texts, energy = _Texts(self, origin), body.energy_matrix
        if body.MODEL == "euler":
            rotor = body.parts().get("rotor", ZERO_VECTOR)
            vectors = {"moment": _moment(texts, energy, rotor)}
        else:
            vectors = _force_and_couple(texts, energy)
        named = tuple((name, tuple(entries)) for name, entries in vectors.items())
        return Loads(body.MODEL, named, definitions=tuple(texts.definitions.items()), origin=origin)


class _Texts:
    """Definitions of linear forms of a motion and of their rates; each number has a name of its own."""

    def __init__(self, motion: Manufactured, origin: Fraction) -> None:
        self.definitions: dict[str, Entry] = {"origin": origin}
        self._constant, self._waves = motion.constant, tuple(enumerate(motion.waves, 1))
        for k, wave in self._waves:
            self.definitions[f"frequency{k}"] = wave.frequency
            self.definitions[f"cosine{k}"] = f"cos(frequency{k}*(t - origin))"
            self.definitions[f"sine{k}"] = f"sin(frequency{k}*(t - origin))"

    def value(self, name: str, matrix: Matrix, more: Vector = ZERO_VECTOR) -> Sequence[str]:
        """Return the names of the three components of matrix z*, and a constant ``more``."""
        terms = {"": tensors.plus(tensors.apply(matrix, self._constant), more)}
        for k, wave in self._waves:
            terms[f"cosine{k}"] = tensors.apply(matrix, wave.cosine)
            terms[f"sine{k}"] = tensors.apply(matrix, wave.sine)
        return self._defined(name, terms)

    def rate(self, name: str, matrix: Matrix) -> Sequence[str]:
        """Return the names of the three components of matrix z*'."""
        terms: dict[str, Vector] = {}
        for k, wave in self._waves:
            terms[f"cosine{k}"] = tensors.scaled(wave.frequency, tensors.apply(matrix, wave.sine))
            terms[f"sine{k}"] = tensors.scaled(-wave.frequency, tensors.apply(matrix, wave.cosine))
        return self._defined(name, terms)

    def _defined(self, name: str, terms: Mapping[str, Vector]) -> Sequence[str]:
        names = [f"{name}{i}" for i in (1, 2, 3)]
        for i, each in enumerate(names):
            self.definitions[each] = self._sum(each, {f: z[i] for f, z in terms.items() if z[i]})
        return names

    def _sum(self, name: str, terms: Mapping[str, Fraction]) -> Entry:
        numbers = {f"{name}_{function or 'constant'}": number for function, number in terms.items()}
        self.definitions |= numbers
        products = (f"{a}*{f}" if f else a for a, f in zip(numbers, terms, strict=True))
        return " + ".join(products) or Fraction(0)


def _moment(texts: _Texts, inertia: Matrix, rotor: Vector) -> list[str]:
    """Return M = H*' - H* x omega*, with the wheels in H*."""
    H, rate = texts.value("momentum", inertia, rotor), texts.rate("momentum_rate", inertia)
    return _left(rate, (H, texts.value("omega", identity(3))))


def _force_and_couple(texts: _Texts, energy: Matrix) -> dict[str, list[str]]:
    linear, angular = identity(6)[:3], identity(6)[3:]
    x, y = texts.value("linear", linear), texts.value("angular", angular)
    velocity, omega = texts.value("velocity", energy[:3]), texts.value("omega", energy[3:])
    force = _left(texts.rate("linear_rate", linear), (x, omega))
    couple = _left(texts.rate("angular_rate", angular), (y, omega), (x, velocity))
    return {"force": force, "couple": couple}


def _left(rate: Sequence[str], *pairs: tuple[Sequence[str], Sequence[str]]) -> list[str]:
    """Return the texts of a rate less the cross products of some pairs of vectors."""
    return [
        " - ".join([rate[i], *(f"({a[j]}*{b[k]} - {a[k]}*{b[j]})" for a, b in pairs)])
        for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1))
    ]
