"""Which equations a rounded body needs: the fewest operations that are exactly its own.

Every decision is one between rationals, the numbers of the rung themselves: a coefficient is left out
if it is zero, two are one if they are equal, and a difference is a coefficient if the rung holds it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from fractions import Fraction

from taylor_verify.models.euler import differences
from taylor_verify.models.form import (
    CLEBSCH_NAMES,
    Equations,
    Form,
    clebsch_equations,
    kirchhoff_equations,
)
from taylor_verify.models.special import ClebschAbout, PrincipalEuler, TensorEuler
from taylor_verify.scenes.precision import Rung

Numbers = Mapping[str, Fraction]

_PRODUCTS = ("K12", "K13", "K23")
_DIFFERENCES = {"D1": "K33 - K22", "D2": "K11 - K33", "D3": "K22 - K11"}


@dataclass(frozen=True)
class Choice:
    """Equations, all numbers that may enter them, those they replace, and why, in sentences."""

    equations: Equations
    numbers: Numbers
    replaced: Numbers
    because: tuple[str, ...]

    def form(self, states: tuple[str, ...]) -> Form:
        """The equations in these states, without what is zero or constant.

        Of the impulses those stay states that something changes; H stays whole.
        """
        present = tuple(n for n, value in self.numbers.items() if n not in states and value)
        form = Form(self.equations, states, present)
        still = form.constants()
        moving = tuple(n for n in states if n not in still)
        kept = tuple(n for n, value in self.numbers.items() if n not in moving and value)
        form = replace(form, states=moving, parameters=kept)
        return replace(form, parameters=form.entering())


def for_rigid_body(numbers: Numbers, rung: Rung) -> Choice:
    """From H1..H3, the upper triangle of K and M1..M3."""
    K = [[numbers[f"K{min(i, j)}{max(i, j)}"] for j in (1, 2, 3)] for i in (1, 2, 3)]
    replaced = {name: value for name, value in numbers.items() if name[0] == "K" and value}
    if any(numbers[name] for name in _PRODUCTS):
        found = {f"D{i}{i}": K[i - 1][i - 1] - K[2][2] for i in (1, 2)}
        formed = tuple(i for i in (1, 2) if not _holds(rung, found[f"D{i}{i}"]))
        extra = {n: v for n, v in found.items() if int(n[1]) not in formed}
        said = ["a sphere is taken away from K: " + _told({n: f"{_K(n)} - K33" for n in extra})]
        return Choice(
            TensorEuler(formed), {**numbers, **extra}, replaced, _sentences(said, extra, formed)
        )
    found = dict(zip(_DIFFERENCES, differences(K), strict=True))
    missing = tuple(int(n[1]) for n, value in found.items() if not _holds(rung, value))
    extra = {n: v for n, v in found.items() if int(n[1]) not in missing}
    said = ["principal axes: " + _told({n: _DIFFERENCES[n] for n in extra if extra[n]})]
    said += [
        f"{_DIFFERENCES[n]} = 0: H{n[1]} feels no gyroscopic term" for n in found if not found[n]
    ]
    if len(missing) == 1 and all(extra.values()):
        others = " + ".join(extra)
        said.append(f"D{missing[0]} is -({others}), as {rung.name} does not hold it")
        equations = PrincipalEuler(summed=missing[0])
        return Choice(equations, {**numbers, **extra}, replaced, _sentences(said, extra))
    return Choice(
        PrincipalEuler(missing),
        {**numbers, **extra},
        replaced,
        _sentences(said, extra, missing),
    )


def _K(name: str) -> str:
    return f"K{name[1:]}"


def _told(definitions: Mapping[str, str]) -> str:
    return ", ".join(f"{name} = {text}" for name, text in definitions.items())


def _sentences(said: list[str], extra: Numbers, formed: tuple[int, ...] = ()) -> tuple[str, ...]:
    """What was said, without a list that is empty, and what the rung could not hold."""
    kept = [sentence for sentence in said if not sentence.endswith(": ")]
    if formed:
        kept.append("differences of K's diagonal that the rung does not hold are formed as it goes")
    return tuple(kept)


def _holds(rung: Rung, value: Fraction) -> bool:
    try:
        return rung.holds(value)
    except OverflowError:
        return False


def for_immersed_body(numbers: Numbers) -> Choice:
    """From x, y, X, L and the 21 coefficients."""
    axis = axis_of_symmetry(numbers)
    if axis is None:
        zeros = sum(not value for name, value in numbers.items() if name[0] in "ABC")
        left_out = (f"{zeros} of 21 coefficients are zero",) if zeros else ()
        return Choice(kirchhoff_equations, numbers, {}, left_out)
    across = axis % 3 + 1
    six = {
        name: numbers[f"{matrix}{i}{i}"]
        for name, (matrix, i) in zip(
            CLEBSCH_NAMES, ((m, i) for m in "ABC" for i in (across, axis)), strict=True
        )
    }
    equal = tuple(n for n in "pqr" if six[n] and six[n] == six[f"{n}'"])
    replaced = {f"{n}'": six[f"{n}'"] for n in equal}
    loads_and_state = {n: v for n, v in numbers.items() if n[0] not in "ABC"}
    kept = {n: v for n, v in six.items() if n not in replaced}
    said = [f"Clebsch's T about axis {axis}: 6 coefficients of 21"]
    said += [f"{n}' = {n}" for n in equal]
    plain = axis == 3 and not equal
    equations = clebsch_equations if plain else ClebschAbout(axis, equal)
    return Choice(equations, {**loads_and_state, **kept}, replaced, tuple(said))


def axis_of_symmetry(numbers: Numbers) -> int | None:
    """The body axis about which T is exactly Clebsch's; 3 where there is a choice."""
    if any(value for name, value in numbers.items() if name[0] in "ABC" and name[1] != name[2]):
        return None
    for axis in (3, 1, 2):
        i, j = (k for k in (1, 2, 3) if k != axis)
        if all(numbers[f"{m}{i}{i}"] == numbers[f"{m}{j}{j}"] for m in "ABC"):
            return axis
    return None


def constants_told(asked: tuple[str, ...], form: Form) -> tuple[str, ...]:
    """Which components are no states, as nothing changes them."""
    still = [name for name in asked if name not in form.states]
    verb = "is a constant" if len(still) == 1 else "are constants"
    return (f"{', '.join(still)} {verb}, and no state",) if still else ()
