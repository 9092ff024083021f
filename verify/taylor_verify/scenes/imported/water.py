"""Water about a link: added mass, drag, buoyancy and current, from plugins of Gazebo and uuv_simulator.

Sources. gz-sim `Hydrodynamics.hh`: ``xDotU`` is a naval derivative, so that minus it is an added mass;
``xU``, ``xUabsV`` and ``xUV`` are coefficients of a force along x, negative where they brake.
uuv_simulator `HydrodynamicModel.cc`: ``added_mass`` is positive, ``linear_damping`` and
``quadratic_damping`` are negative where they brake; all are in axes whose y and z point the other way.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Final

from taylor_verify.numbers import tensors
from taylor_verify.numbers.tensors import ZERO_VECTOR, Matrix, Vector
from taylor_verify.scenes.imported.attributes import Reading, decimal, is_true
from taylor_verify.scenes.imported.tree import Node
from taylor_verify.scenes.loads.loads import Hung

_FORCES: Final = "xyzkmn"
_SPEEDS: Final = dict(zip("UVWPQR", ("u1", "u2", "u3", "w1", "w2", "w3"), strict=True))
_DERIVATIVE: Final = re.compile("([xyzkmn])Dot([UVWPQR])")
_DRAG: Final = re.compile("([xyzkmn])([UVWPQR])(?:(abs)?([UVWPQR]))?")
_FLIPPED: Final = (1, -1, -1, 1, -1, -1)
_GRAVITY: Final = Fraction("9.81")
_SEA: Final = Fraction(1028)
_DAMPING: Final = {
    "linear_damping": "{v}",
    "linear_damping_forward_speed": "u1*{v}",
    "quadratic_damping": "abs({v})*{v}",
}


@dataclass(frozen=True)
class Water:
    """Effect of water on one link, about its origin and in its axes.

    ``terms`` are texts by component of force and couple; ``hanging`` are forces by the key of a scene;
    ``thrusts`` are the names of thrusts in them, each with its joint; ``left_out`` says what the
    file has and the scene has not.
    """

    added_mass: Matrix | None = None
    terms: tuple[tuple[str, ...], ...] = ((),) * 6
    hanging: tuple[tuple[str, Hung], ...] = ()
    current: Vector = ZERO_VECTOR
    thrusts: tuple[tuple[str, str], ...] = ()
    remarks: tuple[str, ...] = ()
    left_out: tuple[str, ...] = ()

    @property
    def acts(self) -> bool:
        """True if the water changes the body or its motion."""
        return bool(self.hanging or any(self.terms) or any(self.current))

    def without(self, *sentences: str) -> Water:
        """Return the same with sentences about what is left out."""
        return replace(self, left_out=(*self.left_out, *sentences))


def is_hydrodynamics(plugin: Node) -> bool:
    """Return True for the plugin Hydrodynamics of gz-sim."""
    name, file = (plugin.attributes.get(key, "") for key in ("name", "filename"))
    return name.endswith("::Hydrodynamics") or file.endswith("-hydrodynamics-system")


def coefficients(node: Node) -> list[str]:
    """Return the elements of a node that have the names of added mass or drag."""
    return [
        child.name
        for child in node.children
        if _DERIVATIVE.fullmatch(child.name) or _DRAG.fullmatch(child.name)
    ]


def of_gazebo(plugin: Node, reading: Reading) -> Water:
    """Return the water of the plugin Hydrodynamics; faults are recorded."""
    added = [[Fraction(0)] * 6 for _ in range(6)]
    terms: list[list[str]] = [[] for _ in range(6)]
    for child in plugin.children:
        if match := _DERIVATIVE.fullmatch(child.name):
            i, k = _FORCES.index(match[1]), [*_SPEEDS].index(match[2])
            added[i][k] = -(reading.number(child, child.text, child.name) or Fraction(0))
        elif match := _DRAG.fullmatch(child.name):
            number = reading.number(child, child.text, child.name)
            terms[_FORCES.index(match[1])] += term(number, _speeds(*match.groups()[1:]))
    return Water(
        _added_mass(added, plugin, reading, "disable_added_mass"),
        tuple(map(tuple, terms)),
        current=reading.inner(plugin, "default_current") or ZERO_VECTOR,
        remarks=(
            "The added mass is minus xDotU and its like of the plugin Hydrodynamics; its drag stands in "
            "force and couple.",
        ),
        left_out=tuple(_switched_off(plugin)),
    )


def _switched_off(plugin: Node) -> Iterator[str]:
    for name, lost in (
        ("disable_added_mass", "the added mass is not in the scene"),
        ("disable_coriolis", "the scene has the Coriolis terms of the added mass all the same"),
    ):
        if is_true(plugin.written(name)):
            yield f"the plugin says <{name}>: {lost}"
    if lookups := [c.name for c in plugin.children if c.name.startswith("lookup_current")]:
        yield f"the current of <{lookups[0]}> is left out: write `current`, a constant, in [body]"


def _speeds(first: str, form: str | None, second: str | None) -> str:
    if second is None:
        return _SPEEDS[first]
    other = f"abs({_SPEEDS[second]})" if form else _SPEEDS[second]
    return f"{other}*{_SPEEDS[first]}"


def term(number: Fraction | None, factors: str) -> list[str]:
    """Return the text of a product, or none for zero."""
    if not number:
        return []
    return [
        f"{'-' * (number < 0)}{factors}" if abs(number) == 1 else f"{decimal(number)}*{factors}"
    ]


def _added_mass(
    rows: Sequence[Sequence[Fraction]], node: Node, reading: Reading, switch: str = ""
) -> Matrix | None:
    """Return the matrix; None for zero, where a switch is on, and after a fault."""
    matrix = tuple(map(tuple, rows))
    if not tensors.is_symmetric(matrix):
        mend = "write both entries of each pair alike"
        reading.fault("a symmetric added mass", "one that is not", node, mend)
        return None
    is_zero = not any(map(any, matrix)) or is_true(node.written(switch))
    return None if is_zero else matrix


def of_uuv(link: Node, mass: Fraction, centre: Vector, plugin: Node, reading: Reading) -> Water:
    """Return the water of uuv_simulator's plugin for a link; faults are recorded."""
    model = link.child("hydrodynamic_model") or link
    kind = model.written("type")
    if kind and kind != "fossen":
        named = f"uuv_simulator computes added mass and drag of the type {kind} itself"
        return Water(left_out=(f"{named}: they are left out",))
    changed = [child.name for child in model.children if _changes(child)]
    node = model.child("added_mass")
    added = None if node is None else _added_mass(_square(node, reading), node, reading)
    terms: list[list[str]] = [[] for _ in range(6)]
    for name, factors in _DAMPING.items():
        damping = model.child(name)
        rows = [] if damping is None else _square(damping, reading)
        for i, row in enumerate(rows):
            for number, speed in zip(row, _SPEEDS.values(), strict=True):
                terms[i] += term(number, factors.format(v=speed))
    return Water(
        added,
        tuple(map(tuple, terms)),
        _buoyant(link, mass, centre, plugin, reading),
        left_out=tuple(f"<{name}> is left out: multiply or add it yourself" for name in changed),
        remarks=(
            "Added mass and damping are those of <hydrodynamic_model>, whose y and z point the other way: "
            "entries that couple y or z with x change their sign.",
        ),
    )


def _changes(child: Node) -> bool:
    """Return True for a factor or an offset of uuv_simulator that changes what it stands beside."""
    neutral = {"scaling": "1", "offset": "0"}.get(child.name.partition("_")[0])
    return neutral is not None and child.text.strip().removesuffix(".0") != neutral


def _square(node: Node, reading: Reading) -> list[list[Fraction]]:
    """Return a 6x6 matrix, or a diagonal one of six numbers, turned into the axes of the link."""
    length = 6 if len(node.text.split()) == 6 else 36
    numbers = reading.vector(node, node.text, node.name, length=length)
    if numbers is None:
        return []
    rows = [numbers[k : k + 6] for k in range(0, length, 6)]
    if length == 6:
        rows = [*tensors.diagonal(numbers)]
    return [
        [_FLIPPED[i] * _FLIPPED[k] * entry for k, entry in enumerate(row)]
        for i, row in enumerate(rows)
    ]


def _buoyant(
    link: Node, mass: Fraction, centre: Vector, plugin: Node, reading: Reading
) -> tuple[tuple[str, Hung], ...]:
    """Return weight and buoyancy; neither where the file has no volume."""
    at = reading.inner(link, "center_of_buoyancy") or ZERO_VECTOR
    is_neutral = is_true(link.written("neutrally_buoyant"))
    displaced = mass if is_neutral else displaced_mass(link, plugin, _SEA, reading)
    gravity = (Fraction(0), Fraction(0), -_GRAVITY)
    return balance(mass, centre, displaced, at, gravity) if displaced else ()


def displaced_mass(link: Node, plugin: Node, density: Fraction, reading: Reading) -> Fraction:
    """Return the mass of the stated volume, by the plugin's density or this one; 0 without a volume."""
    volume, heavy = link.child("volume"), plugin.child("fluid_density")
    size = None if volume is None else reading.positive(volume, volume.text, "volume")
    if heavy is not None:
        density = reading.number(heavy, heavy.text, heavy.name) or Fraction(0)
    return (size or Fraction(0)) * density


def balance(
    mass: Fraction, centre: Vector, displaced: Fraction, at: Vector, gravity: Vector
) -> tuple[tuple[str, Hung], ...]:
    """Return the weight of a link and the buoyancy of the mass that it displaces."""
    return (
        ("weight", Hung(tensors.scaled(mass, gravity), centre)),
        ("buoyancy", Hung(tensors.scaled(-displaced, gravity), at)),
    )
