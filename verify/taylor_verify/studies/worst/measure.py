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
# A number, or the text of one that six digits do not hold.
Numbers = Sequence[float | str]


@dataclass(frozen=True)
class Family:
    """Scenes with some numbers free: ``text`` writes the scene file of a place in the cube."""

    name: str
    what: str
    free: int
    text: Callable[[Place], str]

    def scene(self, place: Place) -> Scene:
        """Return the scene of a place. Raises Refused where there is no body."""
        return read(self.text(place), self.name)


@dataclass(frozen=True)
class Catch:
    """A scene of a family with the verdict on it that came nearest to failing."""

    place: tuple[float, ...]
    verdict: Verdict

    @property
    def ratio(self) -> float:
        """Error over attainable; infinite for a gate that failed without a number."""
        ratio = self.verdict.ratio
        return float("inf") if ratio is None or ratio != ratio else ratio


@dataclass(frozen=True)
class FamilyResult:
    """The result of a family: the number of scenes that were judged, and the worst of them."""

    family: Family
    judged: int
    worst: Catch

    @property
    def scene_text(self) -> str:
        """The worst as a scene file that says why it is there."""
        ratio = f"{self.worst.ratio:.3g}"
        return (
            f"# Why: of {self.family.what}, the largest error over attainable that a hunt has found,\n"
            f"# {ratio} in {self.worst.verdict.quantity} on {RUNG}; a gate stands at {GATE_FACTOR}.\n"
            f"{self.family.text(self.worst.place)}"
        )


def hunt(
    families: Sequence[Family], seconds: float, seed: int, finished: Callable[[str], None]
) -> list[FamilyResult]:
    """Return the worst of each family, in an even share of the ``seconds``.

    ``finished`` is called with the name of each as it ends.
    """
    found, share = [], seconds / len(families)
    for family in families:
        found.append(_hunt(family, share, random.Random(f"{seed} {family.name}")))
        finished(family.name)
    return found


def _hunt(family: Family, seconds: float, draw: random.Random) -> FamilyResult:
    began, judged, width = monotonic(), 0, _FIRST_STEP
    worst: Catch | None = None
    while worst is None or (monotonic() - began < seconds and width >= _LEAST_STEP):
        if worst is None or monotonic() - began < _CLOUD_SHARE * seconds:
            place, narrowing = [draw.random() for _ in range(family.free)], 1.0
        else:
            near = (draw.gauss(value, width) for value in worst.place)
            place, narrowing = [min(1.0, max(0.0, value)) for value in near], 0.9
        catch = caught(family, place)
        if catch is None:
            continue
        judged += 1
        if worst is None or catch.ratio > worst.ratio:
            worst = catch
        else:
            width *= narrowing
    return FamilyResult(family, judged, worst)


def caught(family: Family, place: Place) -> Catch | None:
    """Return the gate nearest to failing; None where there is no body, or every gate is vacuous."""
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


def study(found: Iterable[FamilyResult], seconds: float, seed: int) -> WorstStudy:
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


def _number(value: float | str) -> str:
    """Return a short decimal, exact in the scene for what it says: six digits. A text is left as it is."""
    return value if isinstance(value, str) else format(Decimal(f"{value:.5e}"), "f")


def _beside_one(distance: float) -> str:
    """Return 1 + distance, written out: six digits would not hold it."""
    return format(1 + Decimal(f"{distance:.5e}"), "f")


def _power(share: float, least: float, most: float) -> float:
    """Return a power of ten, from 10^least at 0 to 10^most at 1."""
    return float(10.0 ** (least + share * (most - least)))


def _row(values: Numbers) -> str:
    return f"[{', '.join(map(_number, values))}]"


def _scene(title: str, head: str, body: str, initial: str, end: float) -> str:
    return (
        f'title = "{title}"\n{head}\n\n[body]\n{body}\n\n[initial]\n{initial}\n\n'
        f"[time]\nend = {_number(end)}\nsamples = 31\n"
    )


def _rigid(title: str, inertia: Numbers, omega: Numbers, end: float) -> str:
    head = 'model = "euler"\nsource = "Heinbockel (2.2.72)"'
    return _scene(title, head, f"inertia = {_row(inertia)}", f"omega = {_row(omega)}", end)


def _distance(p: Place) -> str:
    d = _power(p[0], -12, -1)
    end = (0.3 + 1.9 * p[2]) * log(4 / d) / _RATE
    return _rigid("Beside the unstable axis", (1, 2, 3), (d, 1, d * (2 * p[1] - 1)), end)


def _gaps(p: Place) -> str:
    inertia = ("1", _beside_one(_power(p[0], -14, -1)), "2")
    return _rigid(
        "Two moments close together", inertia, (2 * p[1] - 1, 2 * p[2] - 1, 0.1 + p[3]), 50
    )


def _ratios(p: Place) -> str:
    inertia = (_power(p[0], -6, 0), 0.5 + 0.45 * p[1], 1)
    return _rigid("Moments far apart", inertia, (2 * p[2] - 1, 2 * p[3] - 1, 0.1 + p[4]), 20)


def _scales(p: Place) -> str:
    scale = _power(p[0], -140, 140)
    omega = [scale * (value - 0.5) for value in p[1:4]]
    return _rigid("A motion of another size", (1, 2, 3), omega, (5 + 40 * p[4]) / scale)


def _modulus(p: Place) -> str:
    # H^2 = 2 T I2 where omega3^2 I3 (I3 - I2) = omega1^2 I1 (I2 - I1): omega1 = sqrt(3) omega3.
    off, third = _power(p[0], -12, -1), 0.05 + p[1]
    omega = (3**0.5 * third * (1 + off), 2 * p[2] - 1, third)
    exact = [f"{value:.16e}" for value in omega]
    return _rigid("Near the separatrix", (1, 2, 3), exact, 30 + 90 * p[3])


def _immersed(title: str, four: Numbers, x: Numbers, y: Numbers, end: float) -> str:
    """Return the scene of a solid with p, p', q, q' as given, r = 1 and r' = 1/2."""
    names = ("p", "p_prime", "q", "q_prime", "r", "r_prime")
    six = zip(names, (*four, 1.0, 0.5), strict=True)
    body = ", ".join(f"{name} = {_number(value)}" for name, value in six)
    head = 'model = "kirchhoff"\nsource = "Hydromechanics 49 (1)"'
    initial = f"linear_impulse = {_row(x)}\nangular_impulse = {_row(y)}"
    return _scene(title, head, f"clebsch = {{ {body} }}", initial, end)


def _small_impulse(p: Place) -> str:
    size = _power(p[0], -10, 0)
    x, y = (size * (p[1] - 0.5), 0.1 * size, size * p[2]), (0.5, p[3] - 0.5, 1.0)
    return _immersed("A small impulse", (1, 2, 0, 0), x, y, 40)


def _critical_spin(p: Place) -> str:
    # x = (0, 0, 1), y = (0, 0, w): stable from w = 2 on, for the p and p' here and r = 1.
    d, w = _power(p[0], -8, -1), 2 + (2 * p[1] - 1) * _power(p[2], -6, 0)
    return _immersed("Near the critical spin", (2, 1, 0, 0), (d, 0, 1), (0, 0, w), 10 + 30 * p[3])


def _near_singular(p: Place) -> str:
    # q^2 = p r is the limit.
    four = (1, 2, _beside_one(-_power(p[0], -10, -1)), 0)
    x, y = (0.3, p[1] - 0.5, 0.5), (p[2] - 0.5, 0.2, 0.7)
    return _immersed("An energy nearly singular", four, x, y, 10)


def _added_mass(p: Place) -> str:
    across, along = _power(p[0], -5, 3), _power(p[1], -5, 3)
    x, y = (p[2] - 0.5, 0.1, p[3]), (0.5, p[4] - 0.5, 0.5)
    return _immersed("Added mass", (across, along, 0, 0), x, y, 20 / (1 + across + along))


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
