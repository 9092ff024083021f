"""Loads under which a body performs a chosen motion, with the cosines and sines carried as states.

h, k         z* at the start: H0, or x0 and y0         n1, n2, ..   the frequencies nu
a1i, b1i ..  what cosine and sine put into H* or x*     u1, v1, ..   cos nu t and sin nu t: states
f1i, g1i ..  the same of y*                             e_ijk        the permutation symbol

    H*_i = h_i + sum over waves of a_i (u - 1) + b_i v,      u' = -n v,  v' = n u

so that H* begins at h, a number of the rung, and not at a sum that would have to be rounded. All numbers
here are numbers of the rung, or formed from such by + - x. So H* solves the equations exactly with their
rounded coefficients. Time itself does not enter.

An error d of the clock by rounding at time s does no lasting harm. H* is a solution for any u and v. So the
error at t is the present error DH* d, less Phi(t, s) DH* d, which evolves like any other error of H. Since
|DH*| is the amplitude of the waves, both are of the order of a rounding of H.

The loads are written with indices and share no cross product with the equations: an error there is not
cancelled by the same error here.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import reduce
from itertools import product
from typing import Any, Final

from taylor_verify.models.algebra import ABSENT, Terms, add, dot, is_absent, minus, plus, times
from taylor_verify.models.form import Equations, Named, labelled
from taylor_verify.models.symbol import Symbol
from taylor_verify.numbers import tensors
from taylor_verify.numbers.tensors import Vector
from taylor_verify.scenes.manufactured import Manufactured, Wave

# The letters of the start, the cosines and the sines of each vector.
_LETTERS = (("h", "a", "b"), ("k", "f", "g"))
# A vector of the motion, and its rate.
Moved = tuple[Sequence[Any], Sequence[Any]]


@dataclass(frozen=True)
class Inverse:
    """The inverse equations of one kind of body: the loads, by name, for a given motion of its momenta.

    ``momenta`` has the letter of each momentum.
    """

    momenta: str
    loads: Callable[..., dict[str, Any]]


@dataclass(frozen=True)
class Loaded:
    """The equations ``free`` of a body under the loads of its manufactured motion.

    Two scenes with the same number of waves share one compiled integrator.
    """

    free: Equations
    waves: int
    inverse: Inverse

    def __call__(self, n: Named) -> dict[str, Any]:
        motion = [_motion(n, letters, self.waves) for _, letters in self._vectors()]
        loads = self.inverse.loads(n, *motion)
        return dict(self.free(Named({**n, **loads}))) | self._clock(n)

    def _vectors(self) -> Iterator[tuple[str, tuple[str, str, str]]]:
        """Return each momentum with the letters of its motion."""
        return zip(self.inverse.momenta, _LETTERS, strict=False)

    def lines(self, n: Named) -> dict[str, Any]:
        """Return the rates by M, or X and L, then these by H*, or x* and y*, and by the clock."""
        written: dict[str, Any] = {}
        motion: list[Moved] = []
        for name, letters in self._vectors():
            value, rate = _motion(n, letters, self.waves)
            parts = [labelled(name, value, "*"), labelled(name, rate, "*'")]
            written |= parts[0] | parts[1]
            motion.append((_symbols(parts[0]), _symbols(parts[1])))
        loads = self.inverse.loads(n, *motion)
        named = {name: Symbol(name) for name, load in loads.items() if not is_absent(load)}
        rates = dict(self.free(Named({**n, **named}))) | self._clock(n)
        return {f"{name}'": rates[name] for name in rates if name in n} | loads | written

    def _clock(self, n: Named) -> dict[str, Any]:
        rates: dict[str, Any] = {}
        for k in range(1, self.waves + 1):
            u, v, nu = n[f"u{k}"], n[f"v{k}"], n[f"n{k}"]
            rates |= {f"u{k}": minus(ABSENT, times(nu, v)), f"v{k}": times(nu, u)}
        return rates


def states(motion: Manufactured) -> tuple[str, ...]:
    """Return the names of the clock: a cosine and a sine for each wave."""
    return tuple(f"{letter}{k}" for k in range(1, len(motion.waves) + 1) for letter in "uv")


def numbers(motion: Manufactured) -> dict[str, Fraction]:
    """Return every parameter of a rounded motion, and the clock at its start.

    The constant part does not enter, because it follows from the start, H0 or x0 and y0.
    """
    parameters: dict[str, Fraction] = {}
    for place, (begin, cosine, sine) in enumerate(_LETTERS[: len(motion.constant) // 3]):
        own = slice(3 * place, 3 * place + 3)
        parameters |= labelled(begin, motion.start[own])
        for k, wave in enumerate(motion.waves, start=1):
            parameters |= labelled(f"{cosine}{k}", wave.cosine[own])
            parameters |= labelled(f"{sine}{k}", wave.sine[own])
    for k, wave in enumerate(motion.waves, start=1):
        parameters |= {f"n{k}": wave.frequency, f"u{k}": Fraction(1), f"v{k}": Fraction(0)}
    return parameters


def sentences(motion: Manufactured, inverse: Inverse) -> tuple[str, ...]:
    """Return sentences that explain the equations to a reader."""
    starred = " and ".join(f"{letter}*" for letter in inverse.momenta)
    verb = "is" if len(inverse.momenta) == 1 else "are"
    loads = f"the loads are those under which {starred} {verb} the motion"
    clock = f"{', '.join(states(motion))} are states, so that time does not enter"
    return (loads, clock) if motion.waves else (loads,)


def motion_from(waves: tuple[Wave, ...], start: Vector) -> Manufactured:
    """Return the motion of these waves that begins exactly at ``start``."""
    constant = reduce(tensors.minus, (wave.cosine for wave in waves), start)
    return Manufactured(constant, waves)


# The loads.


def _moment(n: Named, momentum: Moved) -> dict[str, Any]:
    """Return M_i = H*_i' - e_ijk H*_j K_kl H*_l."""
    (H, H_rate), K = momentum, n.symmetric("K")
    omega = [dot(K[k], H) for k in range(3)]
    return labelled("M", [minus(H_rate[i], _permuted(i, H, omega)) for i in range(3)])


def _force_and_couple(n: Named, linear: Moved, angular: Moved) -> dict[str, Any]:
    """Return X_i = x*_i' - e_ijk x*_j Omega*_k and L_i = y*_i' - e_ijk (y*_j Omega*_k + x*_j U*_k)."""
    (x, x_rate), (y, y_rate) = linear, angular
    A, B, C = n.symmetric("A"), n.matrix("B"), n.symmetric("C")
    U = [plus(dot(A[k], x), dot(B[k], y)) for k in range(3)]
    Omega = [plus(dot([B[j][k] for j in range(3)], x), dot(C[k], y)) for k in range(3)]
    X = [minus(x_rate[i], _permuted(i, x, Omega)) for i in range(3)]
    turned = [plus(_permuted(i, y, Omega), _permuted(i, x, U)) for i in range(3)]
    L = [minus(y_rate[i], turned[i]) for i in range(3)]
    return labelled("X", X) | labelled("L", L)


EULER_INVERSE: Final = Inverse("H", _moment)
KIRCHHOFF_INVERSE: Final = Inverse("xy", _force_and_couple)


def _symbols(named: Mapping[str, Any]) -> list[Any]:
    """Return names for the components; absent terms stay absent."""
    return [ABSENT if is_absent(value) else Symbol(name) for name, value in named.items()]


def _motion(n: Named, letters: tuple[str, str, str], waves: int) -> tuple[list[Any], list[Any]]:
    """Return one vector of the motion, and its rate."""
    begin, cosine, sine = letters
    value, rate = n.vector(begin), [ABSENT] * 3
    for k in range(1, waves + 1):
        u, v, nu = n[f"u{k}"], n[f"v{k}"], n[f"n{k}"]
        a, b = n.vector(f"{cosine}{k}"), n.vector(f"{sine}{k}")
        value = add(value, [plus(times(p, u - 1), times(q, v)) for p, q in zip(a, b, strict=True)])
        swing = [minus(times(q, u), times(p, v)) for p, q in zip(a, b, strict=True)]
        rate = add(rate, [times(nu, s) for s in swing])
    return value, rate


def _permuted(i: int, p: Terms, q: Terms) -> Any:
    """Return e_ijk p_j q_k, summed over j and k."""
    total: Any = ABSENT
    for j, k in product(range(3), repeat=2):
        sign = (i - j) * (j - k) * (k - i) // 2
        if sign:
            term = times(p[j], q[k])
            total = plus(total, term) if sign > 0 else minus(total, term)
    return total
