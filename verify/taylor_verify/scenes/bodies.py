"""The bodies of both equation sets, in exact rationals and body axes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from fractions import Fraction
from functools import cached_property
from typing import Any, ClassVar, Final, Self, cast

from taylor_verify.numbers import tensors
from taylor_verify.numbers.tensors import ZERO_MATRIX, ZERO_VECTOR, Matrix, Vector
from taylor_verify.scenes.ellipsoid import Inertias, inertias
from taylor_verify.scenes.loads.loads import Loads
from taylor_verify.scenes.motion import Impulse, Spin, State
from taylor_verify.scenes.named_numbers import (
    FORCE,
    MOMENT,
    MOMENTUM,
    RATE,
    Dimension,
    Part,
    Parted,
    Shape,
    Value,
)
from taylor_verify.scenes.stand_in import stand_in

DAMPING: Final = Part("damping", Shape.NUMBER, RATE, is_optional=True)


class Body(Parted):
    """The base class of bodies, with their exact numbers and what every room needs of them.

    The numbers are the PARTS. ``MODEL`` is the word of a scene's key ``model``, ``STATE`` the kind of
    its initial state, and ``ENERGY`` what ``energy_matrix`` is called in messages. A new kind of body is
    a class like those below; each room that has its physics has one table by these classes.

    ``damping`` c, of either sign, subtracts c z from the rate of every momentum z.
    """

    MODEL: ClassVar[str]
    STATE: ClassVar[type[State]]
    ENERGY: ClassVar[str]

    loads: Loads | None
    damping: Fraction

    @property
    def undamped(self) -> Self:
        """Copy of the body without damping."""
        return self.with_damping(Fraction(0)) if self.damping else self

    def with_damping(self, damping: Fraction) -> Self:
        """Return the same body with this damping."""
        changed: Self = replace(cast("Any", self), damping=damping)
        return changed

    @property
    def energy_matrix(self) -> Matrix:
        """The positive definite matrix of 2T = z . energy_matrix z, z the moving part of the state."""
        raise NotImplementedError

    @classmethod
    def load_names(cls) -> tuple[str, ...]:
        """Return the names of the loads, in reading order."""
        return tuple(part.name for part in cls.PARTS if part.is_load)

    @property
    def is_free(self) -> bool:
        """True without loads: no constant ones, and no texts."""
        return self.loads is None and not any(
            any(self.part(part)) for part in self.PARTS if part.is_load
        )

    @property
    def others(self) -> frozenset[str]:
        """The names of the parts that are neither energy nor load nor damping, such as ``rotor``.

        Each adds terms of its own to the equations of motion.
        """
        own = (p.name for p in self.listed if not (p.is_energy or p.is_load))
        return frozenset(own) - {DAMPING.name}

    @property
    def acting(self) -> tuple[str, ...]:
        """The names of all that moves the body besides its energy.

        Parts of its own kind such as ``rotor``, ``damping``, ``loads`` for texts, and constant loads that
        are not zero.
        """
        own = (part.name for part in self.listed if not (part.is_energy or part.is_load))
        written = () if self.loads is None else ("loads",)
        loads = (part.name for part in self.PARTS if part.is_load and any(self.part(part)))
        return *own, *written, *loads

    @property
    def is_plain(self) -> bool:
        """True if the energy alone moves the body: no loads, no damping, nothing else that acts."""
        return not self.acting

    @property
    def description(self) -> Mapping[str, Value]:
        """The numbers that the body was given by, where its parts were computed from them."""
        return {}

    @property
    def added_mass(self) -> Matrix | None:
        """The part of the mass matrix that a scene calls added mass; None where it names none."""
        return None

    @property
    def has_velocities(self) -> bool:
        """True if the linear velocity belongs to the motion: U and Omega are linear in the momenta."""
        return False

    def with_loads(self, loads: Loads | None) -> Self:
        """Return the same body under these loads."""
        changed: Self = replace(cast("Any", self), loads=loads)
        return changed

    @property
    def is_conservative(self) -> bool:
        """True if energy and momenta are conserved.

        With damping c, "conserved" means: after multiplication by powers of e^{ct}.
        """
        return self.is_free

    @property
    def is_integrable(self) -> bool:
        """True if every motion has a closed form, by the symmetry of the body alone."""
        return False

    @property
    def is_revolved(self) -> bool:
        """True if entries 11 and 22 of every matrix are one number, and nothing is off the diagonal."""
        return False


@dataclass(frozen=True)
class RigidBody(Body):
    """A rigid body about a fixed point or its centre of mass: (I omega)' = (I omega + h) x omega + M.

    ``inertia`` is the symmetric positive definite tensor I (products of inertia enter as tensor
    components, I_12 = -int xy dm), with wheels locked; ``moment`` M is constant in body axes. ``rotor`` is
    the constant momentum h of wheels, relative to the body; with one the body is called a gyrostat.
    """

    inertia: Matrix
    moment: Vector = ZERO_VECTOR
    rotor: Vector = ZERO_VECTOR
    damping: Fraction = Fraction(0)
    loads: Loads | None = None

    MODEL = "euler"
    STATE = Spin
    ENERGY = "the inertia tensor"
    PARTS = (
        Part("inertia", Shape.SYMMETRIC, Dimension(1, 2, 0), is_energy=True),
        Part("rotor", Shape.VECTOR, MOMENTUM, is_optional=True),
        Part("moment", Shape.VECTOR, MOMENT, is_load=True),
        DAMPING,
    )

    @property
    def is_conservative(self) -> bool:
        """True without loads, and without damping of a body with wheels: the wheels do work then."""
        return self.is_free and not (self.damping and any(self.rotor))

    @property
    def energy_matrix(self) -> Matrix:
        """I: 2T = omega . I omega, without the energy of the wheels against the body."""
        return self.inertia

    @cached_property
    def inverse_inertia(self) -> Matrix:
        """K = I^-1, so that omega = K (H - h)."""
        return tensors.inverse(self.inertia)

    @property
    def is_integrable(self) -> bool:
        """True for a free body without wheels: Jacobi's motion."""
        return self.is_free and not any(self.rotor)


@dataclass(frozen=True)
class ImmersedBody(Body):
    """A solid in an ideal fluid: T = x.A x/2 + x.B y + y.C y/2, 21 coefficients.

    A (``linear``) and C (``angular``) are symmetric, the row of B (``coupling``) is the index of x,
    and [[A, B], [B^T, C]] is positive definite. ``force`` (X, Y, Z) and ``couple`` (L, M, N) are
    constant in body axes. ``ellipsoid`` is the shape of a body that was given by it; its coefficients are
    irrational. ``added`` is the part of the mass matrix that a scene calls added mass, where it does.
    """

    linear: Matrix
    coupling: Matrix
    angular: Matrix
    force: Vector = ZERO_VECTOR
    couple: Vector = ZERO_VECTOR
    ellipsoid: Ellipsoid | None = None
    added: Matrix | None = None
    damping: Fraction = Fraction(0)
    loads: Loads | None = None

    MODEL = "kirchhoff"
    STATE = Impulse
    ENERGY = "T"
    PARTS = (
        Part("linear", Shape.SYMMETRIC, Dimension(-1, 0, 0), is_energy=True),
        Part("coupling", Shape.MATRIX, Dimension(-1, -1, 0), is_energy=True),
        Part("angular", Shape.SYMMETRIC, Dimension(-1, -2, 0), is_energy=True),
        Part("force", Shape.VECTOR, FORCE, is_load=True),
        Part("couple", Shape.VECTOR, MOMENT, is_load=True),
        DAMPING,
    )

    @property
    def has_velocities(self) -> bool:
        """True: (U, Omega) = energy_matrix (x, y)."""
        return True

    def with_parts(self, values: Mapping[str, Value]) -> Self:
        """Return a copy with other values; with other coefficients it has no ellipsoid."""
        other = super().with_parts(values)
        keeps_shape = values.keys() <= {*self.load_names(), DAMPING.name}
        return other if keeps_shape else replace(other, ellipsoid=None)

    @property
    def is_integrable(self) -> bool:
        """True for a free body of revolution: Clebsch's motion."""
        return self.is_free and self.axis_of_symmetry is not None

    @property
    def is_revolved(self) -> bool:
        """True for T of Clebsch's form about axis 3."""
        return self.clebsch is not None

    @property
    def description(self) -> Mapping[str, Value]:
        """Semi-axes and densities of a body that was given as an ellipsoid."""
        return asdict(self.ellipsoid) if self.ellipsoid else {}

    @cached_property
    def energy_matrix(self) -> Matrix:
        """The 6x6 matrix [[A, B], [B^T, C]]: (U, Omega) = energy_matrix (x, y)."""
        return tensors.blocks(self.linear, self.coupling, self.angular)

    @property
    def added_mass(self) -> Matrix | None:
        """The part of the mass matrix that a scene calls added mass; None where it names none."""
        return self.added

    @cached_property
    def mass_matrix(self) -> Matrix:
        """The 6x6 matrix M of (x, y) = M (U, Omega): body and added mass together, exactly."""
        return tensors.inverse(self.energy_matrix)

    @classmethod
    def of_mass_matrix(cls, matrix: Matrix) -> ImmersedBody:
        """Return the free body of a symmetric positive definite M: [[A, B], [B^T, C]] is its inverse."""
        inverse = tensors.inverse(matrix)
        upper, lower = inverse[:3], inverse[3:]
        return cls(
            linear=tuple(row[:3] for row in upper),
            coupling=tuple(row[3:] for row in upper),
            angular=tuple(row[3:] for row in lower),
        )

    @cached_property
    def axis_of_symmetry(self) -> int | None:
        """The body axis about which every turn leaves T as it is; 3 where there is a choice.

        T is of Clebsch's form about some point of that axis, which need not be the origin.
        """
        return next((axis for axis in (3, 1, 2) if self._is_of_revolution(axis)), None)

    def _is_of_revolution(self, axis: int) -> bool:
        """Return True if A, B and C commute with the turns about the axis."""
        i, j, k = axis % 3, (axis + 1) % 3, axis - 1
        return all(
            block[i][i] == block[j][j]
            and block[i][j] == -block[j][i]
            and not any((block[i][k], block[k][i], block[j][k], block[k][j]))
            for block in (self.linear, self.coupling, self.angular)
        )

    @cached_property
    def clebsch(self) -> Clebsch | None:
        """The six coefficients of Clebsch's form about axis 3, or None if T is not of that form."""
        a, b, c = self.linear, self.coupling, self.angular
        six = Clebsch(
            p=a[0][0], p_prime=a[2][2], q=b[0][0], q_prime=b[2][2], r=c[0][0], r_prime=c[2][2]
        )
        form = six.body()
        is_clebsch = (a, b, c) == (form.linear, form.coupling, form.angular)
        return six if is_clebsch else None


def rigid_mass_matrix(mass: Fraction, centre: Vector, inertia: Matrix) -> Matrix:
    """Return M = [[m 1, -m [c]x], [m [c]x, I - m [c]x [c]x]] of (x, y) = M (U, Omega) without a fluid."""
    c = tensors.cross_matrix(centre)
    offset = tuple(tensors.scaled(-mass, row) for row in c)
    angular = tuple(map(tensors.plus, inertia, tensors.product(offset, c)))
    return tensors.blocks(tensors.diagonal((mass,) * 3), offset, angular)


@dataclass(frozen=True)
class Clebsch:
    """T = p/2 (x1^2 + x2^2) + p'/2 x3^2 + q (x1 y1 + x2 y2) + q' x3 y3 + r/2 (y1^2 + y2^2) + r'/2 y3^2.

    Hydromechanics 49 (1); the axis of symmetry is body axis 3.
    """

    p: Fraction
    p_prime: Fraction
    q: Fraction
    q_prime: Fraction
    r: Fraction
    r_prime: Fraction

    def body(self, force: Vector = ZERO_VECTOR, couple: Vector = ZERO_VECTOR) -> ImmersedBody:
        """Return the body of this energy, by its 21 coefficients, with the loads given."""
        return ImmersedBody(
            linear=tensors.diagonal((self.p, self.p, self.p_prime)),
            coupling=tensors.diagonal((self.q, self.q, self.q_prime)),
            angular=tensors.diagonal((self.r, self.r, self.r_prime)),
            force=force,
            couple=couple,
        )


@dataclass(frozen=True)
class Ellipsoid:
    """A homogeneous ellipsoid, its semi-axes along body axes 1, 2, 3, in a fluid; origin the centre.

    The semi-axes are positive. If the density is zero, the fluid has mass and the semi-axes are all
    different. Otherwise some motion would have no inertia, and T would be no function of the impulses.
    """

    semi_axes: Vector
    density: Fraction
    fluid_density: Fraction

    @property
    def inertias(self) -> Inertias:
        """Mass, inertia and what the fluid adds to them, exactly."""
        return inertias(self.semi_axes, self.density, self.fluid_density)

    def body(self) -> ImmersedBody:
        """Return the body of the coefficients 1/(M + m_i) and 1/(I_i + j_i), which are irrational."""
        linear, angular = (
            tuple(stand_in(1 / inertia) for inertia in three)
            for three in (self.inertias.masses, self.inertias.moments)
        )
        return ImmersedBody(
            linear=tensors.diagonal(linear),
            coupling=ZERO_MATRIX,
            angular=tensors.diagonal(angular),
            ellipsoid=self,
            added=tensors.diagonal(
                tuple(map(stand_in, (*self.inertias.added_mass, *self.inertias.added_inertia)))
            ),
        )


__all__ = [
    "DAMPING",
    "ZERO_MATRIX",
    "ZERO_VECTOR",
    "Body",
    "Clebsch",
    "Ellipsoid",
    "ImmersedBody",
    "RigidBody",
]
