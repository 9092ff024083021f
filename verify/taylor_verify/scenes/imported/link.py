"""The inertia of one link of a robot or vehicle, in exact rationals."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from fractions import Fraction
from typing import NamedTuple

from taylor_verify.numbers import tensors
from taylor_verify.numbers.tensors import Matrix, Vector
from taylor_verify.scenes.bodies import rigid_mass_matrix
from taylor_verify.scenes.imported.attributes import Reading
from taylor_verify.scenes.imported.tree import Node
from taylor_verify.scenes.imported.water import Water


class Candidate(NamedTuple):
    """A link of a file by its name, with its inertial element if it has one."""

    name: str
    inertial: Node | None

    def is_called(self, name: str) -> bool:
        """Return True for the whole name, and for the name without the models that the link is in."""
        return self.name == name or self.name.endswith(f"::{name}")


@dataclass(frozen=True)
class Link:
    """A rigid link, about its origin and in its axes.

    ``centre`` is the centre of mass; ``inertia`` the tensor about it, in the axes of the link, products
    as tensor components; ``added_mass`` the 6x6 matrix of the fluid about the origin of the link, linear
    rows first; ``remarks`` say how numbers were formed; ``water`` acts on the link.
    """

    name: str
    mass: Fraction
    centre: Vector
    inertia: Matrix
    added_mass: Matrix | None = None
    remarks: tuple[str, ...] = ()
    water: Water = field(default_factory=Water)

    @property
    def mass_matrix(self) -> Matrix:
        """The inertia of link and fluid together."""
        rigid = rigid_mass_matrix(self.mass, self.centre, self.inertia)
        return tuple(map(tensors.plus, rigid, self.added_mass)) if self.added_mass else rigid


class Format(NamedTuple):
    """A format of files: its name, its root element, its word for a link, and how to read it.

    ``link`` is given the root, the name and the inertial element; ``without_inertial`` says what to do
    about a link without such an element.
    """

    name: str
    root: str
    link_word: str
    without_inertial: str
    candidates: Callable[[Node], list[Candidate]]
    link: Callable[[Node, str, Node, Reading], Link | None]
