"""The hunt for the worst: in families of scenes, the largest error over what is attainable.

A family is a cube: numbers between 0 and 1 become a scene, in exact decimals. First comes a cloud of
random places, then steps around the worst of them, each half as wide as long as nothing worse is
found. The driver answers every scene, and what counts is the largest error over attainable of all its
gates that ask something.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from decimal import Decimal
from math import log
from time import monotonic
from typing import Final

from taylor_verify.judge.provenance import command, processor, versions
from taylor_verify.records.provenance import Provenance
from taylor_verify.records.quantities import GATE_FACTOR, INITIAL
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict
from taylor_verify.run import run
from taylor_verify.scenes.reading.faults import Refused
from taylor_verify.scenes.reading.reader import read
from taylor_verify.scenes.scene import Scene
from taylor_verify.studies.worst.document import WorstOfFamily, WorstStudy

RUNG: Final = "f64"
# Of the time of a family: the rest is for the neighbourhood of the worst.
_CLOUD_SHARE: Final = 0.6
_FIRST_STEP: Final = 0.2
_LEAST_STEP: Final = 1e-3
_RATE: Final = 3**-0.5  # of the moments 1, 2, 3 beside the middle axis, at omega = 1

Place = Sequence[float]


@dataclass(frozen=True)
class Family:
    """Scenes with some numbers free: ``text`` writes the scene file of a place in the cube."""

    name: str
    what: str
    free: int
    text: Callable[[Place], str]

    def scene(self, place: Place) -> Scene:
        """Raises Refused for a place where there is no body."""
        return read(self.text(place), self.name)


@dataclass(frozen=True)
class Catch:
    """One scene of a family and the verdict on it that came nearest to failing."""

    place: tuple[float, ...]
    verdict: Verdict

    @property
    def ratio(self) -> float:
        """Error over attainable; infinite for a gate that failed without a number."""
        ratio = self.verdict.ratio
        return float("inf") if ratio is None or ratio != ratio else ratio


@dataclass(frozen=True)
class Found:
    """What a family has given: how many scenes were judged, and the worst of them."""

    family: Family
    judged: int
    worst: Catch

    @property
    def scene_text(self) -> str:
        """The worst as a scene file that says why it is there."""
        ratio = f"{self.worst.ratio:.3g}"
        why = (
            f"# Why: of {self.family.what}, the largest error over attainable that a hunt has found,\n"
            f"# {ratio} in {self.worst.verdict.quantity} on {RUNG}; a gate stands at {GATE_FACTOR}.\n"
        )
        return why + self.family.text(self.worst.place)


def hunt(
    families: Iterable[Family], seconds: float, seed: int, told: Callable[[str], None]
) -> list[Found]:
    """The worst of each family; ``seconds`` are divided evenly, ``told`` hears of each as it ends."""
    asked = list(families)
    found = []
    for family in asked:
        found.append(_hunt(family, seconds / len(asked), random.Random(f"{seed} {family.name}")))
        told(family.name)
    return found


def _hunt(family: Family, seconds: float, draw: random.Random) -> Found:
    began, judged = monotonic(), 0
    worst: Catch | None = None
    width = _FIRST_STEP
    while worst is None or (monotonic() - began < seconds and width >= _LEAST_STEP):
        in_cloud = worst is None or monotonic() - began < _CLOUD_SHARE * seconds
        if in_cloud or worst is None:
            place = tuple(draw.random() for _ in range(family.free))
        else:
            place = tuple(_inside(draw.gauss(value, width)) for value in worst.place)
        catch = caught(family, place)
        if catch is None:
            continue
        judged += 1
        if worst is None or catch.ratio > worst.ratio:
            worst = catch
        elif not in_cloud:
            width *= 0.9
    return Found(family, judged, worst)


def _inside(value: float) -> float:
    return min(1.0, max(0.0, value))


def caught(family: Family, place: Place) -> Catch | None:
    """The gate nearest to failing; None where there is no body, or every gate is vacuous."""
    try:
        scene = family.scene(place)
    except Refused:
        return None
    asked = [v for v in run(scene, "taylor", RUNG).verdicts if _counts(v)]
    catches = [Catch(tuple(place), verdict) for verdict in asked]
    return max(catches, key=lambda catch: catch.ratio, default=None)


def _counts(verdict: Verdict) -> bool:
    is_asked = verdict.verdict in (Status.PASS, Status.FAIL)
    # The start is the first row of a state, which counts already.
    return is_asked and verdict.quantity != INITIAL


def study(found: Iterable[Found], seconds: float, seed: int) -> WorstStudy:
    """Return the rows that the published table is made from."""
    return WorstStudy(
        factor=GATE_FACTOR,
        rung=RUNG,
        seconds=seconds,
        seed=seed,
        provenance=Provenance(versions(), processor(), command()),
        families=tuple(
            WorstOfFamily(
                name=one.family.name,
                what=one.family.what,
                judged=one.judged,
                ratio=one.worst.ratio,
                quantity=one.worst.verdict.quantity,
                verdict=one.worst.verdict.verdict,
                max=one.worst.verdict.max,
                scene=f"extremes/worst/{one.family.name}",
            )
            for one in found
        ),
    )


# The families.


def _number(value: float) -> str:
    """A short decimal, exact in the scene for what it says: six digits."""
    return format(Decimal(f"{value:.5e}"), "f")


def _power(share: float, least: float, most: float) -> float:
    """From 10^least at 0 to 10^most at 1."""
    return float(10.0 ** (least + share * (most - least)))


def _row(values: Iterable[float]) -> str:
    return f"[{', '.join(_number(value) for value in values)}]"


def _rigid(title: str, inertia: Place, omega: Place, end: float) -> str:
    return (
        f'title = "{title}"\nmodel = "euler"\nsource = "Heinbockel (2.2.72)"\n\n'
        f"[body]\ninertia = {_row(inertia)}\n\n[initial]\nomega = {_row(omega)}\n\n"
        f"[time]\nend = {_number(end)}\nsamples = 31\n"
    )


def _distance(p: Place) -> str:
    d = _power(p[0], -12, -1)
    end = (0.3 + 1.9 * p[2]) * log(4 / d) / _RATE
    return _rigid("Beside the unstable axis", (1, 2, 3), (d, 1, d * (2 * p[1] - 1)), end)


def _gaps(p: Place) -> str:
    gap = _power(p[0], -14, -1)
    omega = (2 * p[1] - 1, 2 * p[2] - 1, 0.1 + p[3])
    # Six digits would not hold the gap: it is written out.
    text = _rigid("Two moments close together", (1, 1, 2), omega, 50)
    near = format(1 + Decimal(f"{gap:.5e}"), "f")
    return text.replace(_row((1, 1, 2)), f"[1, {near}, 2]")


def _ratios(p: Place) -> str:
    long, broad = _power(p[0], -6, 0), 0.5 + 0.45 * p[1]
    return _rigid(
        "Moments far apart", (long, broad, 1), (2 * p[2] - 1, 2 * p[3] - 1, 0.1 + p[4]), 20
    )


def _scales(p: Place) -> str:
    scale = _power(p[0], -140, 140)
    omega = [scale * (value - 0.5) for value in p[1:4]]
    return _rigid("A motion of another size", (1, 2, 3), omega, (5 + 40 * p[4]) / scale)


def _modulus(p: Place) -> str:
    # H^2 = 2 T I2 where omega3^2 I3 (I3 - I2) = omega1^2 I1 (I2 - I1): omega1 = sqrt(3) omega3.
    off, third = _power(p[0], -12, -1), 0.05 + p[1]
    omega = (3**0.5 * third * (1 + off), 2 * p[2] - 1, third)
    text = _rigid("Near the separatrix", (1, 2, 3), omega, 30 + 90 * p[3])
    exact = ", ".join(f"{value:.16e}" for value in omega)
    return text.replace(f"omega = {_row(omega)}", f"omega = [{exact}]")


def _immersed(title: str, clebsch: dict[str, float], x: Place, y: Place, end: float) -> str:
    six = ", ".join(f"{name} = {_number(value)}" for name, value in clebsch.items())
    return (
        f'title = "{title}"\nmodel = "kirchhoff"\nsource = "Hydromechanics 49 (1)"\n\n'
        f"[body]\nclebsch = {{ {six} }}\n\n"
        f"[initial]\nlinear_impulse = {_row(x)}\nangular_impulse = {_row(y)}\n\n"
        f"[time]\nend = {_number(end)}\nsamples = 31\n"
    )


def _six(p: float, p_axial: float, q: float, q_axial: float) -> dict[str, float]:
    names = ("p", "p_prime", "q", "q_prime", "r", "r_prime")
    return dict(zip(names, (p, p_axial, q, q_axial, 1.0, 0.5), strict=True))


def _small_impulse(p: Place) -> str:
    size = _power(p[0], -10, 0)
    x, y = (size * (p[1] - 0.5), 0.1 * size, size * p[2]), (0.5, p[3] - 0.5, 1.0)
    return _immersed("A small impulse", _six(1, 2, 0, 0), x, y, 40)


def _critical_spin(p: Place) -> str:
    # x = (0, 0, 1), y = (0, 0, w): stable from w = 2 on, for the p and p' here and r = 1.
    d, w = _power(p[0], -8, -1), 2 + (2 * p[1] - 1) * _power(p[2], -6, 0)
    return _immersed(
        "Near the critical spin", _six(2, 1, 0, 0), (d, 0, 1), (0, 0, w), 10 + 30 * p[3]
    )


def _near_singular(p: Place) -> str:
    short = _power(p[0], -10, -1)
    text = _immersed(
        "An energy nearly singular",
        _six(1, 2, 0.123456, 0),
        (0.3, p[1] - 0.5, 0.5),
        (p[2] - 0.5, 0.2, 0.7),
        10,
    )
    # q^2 = p r is the limit: q is written out.
    return text.replace("q = 0.123456", f"q = {format(1 - Decimal(f'{short:.5e}'), 'f')}")


def _added_mass(p: Place) -> str:
    across, along = _power(p[0], -5, 3), _power(p[1], -5, 3)
    x, y = (p[2] - 0.5, 0.1, p[3]), (0.5, p[4] - 0.5, 0.5)
    return _immersed("Added mass", _six(across, along, 0, 0), x, y, 20 / (1 + across + along))


FAMILIES: Final = (
    Family("euler-distance", "bodies that start beside their unstable axis", 3, _distance),
    Family("euler-gaps", "bodies with two moments close together", 4, _gaps),
    Family("euler-ratios", "bodies with moments far apart", 5, _ratios),
    Family("euler-scales", "motions of all sizes", 5, _scales),
    Family("euler-modulus", "motions near the separatrix", 4, _modulus),
    Family("kirchhoff-small-impulse", "solids with a small linear impulse", 4, _small_impulse),
    Family(
        "kirchhoff-critical-spin", "spins about the axis near the critical one", 4, _critical_spin
    ),
    Family("kirchhoff-near-singular", "energies that are nearly singular", 3, _near_singular),
    Family("kirchhoff-added-mass", "solids with any added mass across and along", 5, _added_mass),
)
