"""The ``[body]`` table of a scene becomes a body, its positivity decided in rationals.

Legend: ``inertia`` I, ``moment`` M; ``clebsch`` has p, p', q, q', r, r' (``p_prime`` and so on);
``energy`` has A, B, C of T = x.A x/2 + x.B y + y.C y/2 as ``linear``, ``coupling``, ``angular``;
``ellipsoid`` has ``semi_axes`` along body axes 1, 2, 3, ``density`` and ``fluid_density``;
``mass_matrix`` is M of (x, y) = M (U, Omega), whose inverse is [[A, B], [B^T, C]].
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from typing import Final

from taylor_verify.numbers import tensors
from taylor_verify.numbers.precision import float_text
from taylor_verify.numbers.tensors import ZERO_VECTOR, Matrix, Vector
from taylor_verify.scenes.bodies import (
    DAMPING,
    Body,
    Clebsch,
    Ellipsoid,
    ImmersedBody,
    RigidBody,
    rigid_mass_matrix,
)
from taylor_verify.scenes.loads.loads import Entries, Loads
from taylor_verify.scenes.reading.table import Table, complete, right

_MOMENT: Final = right("a positive moment of inertia", lambda number: number > 0)
_SEMI_AXIS: Final = right("a positive semi-axis", lambda number: number > 0)
_DENSITY: Final = right("a density that is not negative", lambda number: number >= 0)
_CLEBSCH_KEYS = ("p", "p_prime", "q", "q_prime", "r", "r_prime")


def rigid_body(table: Table, loads: Loads) -> RigidBody | None:
    """Return the body of model euler; None after a fault."""
    inertia = _inertia(table)
    damping = table.number(DAMPING.name, default=Fraction(0))
    if inertia is None or damping is None:
        return None
    moment, rotor = dict(loads.vectors)["moment"], loads.rotor
    turns_by_text = any(isinstance(entry, str) for entry in rotor)
    loads = replace(loads, inertia=inertia, rotor=rotor if turns_by_text else ())
    constant = _numbers(ZERO_VECTOR if loads.is_written else moment)
    acting = loads if loads.is_written else None
    wheels = _numbers(ZERO_VECTOR if turns_by_text else rotor)
    return RigidBody(inertia, constant, wheels, damping, acting)


def _numbers(entries: Entries) -> Vector:
    return tuple(Fraction(entry) for entry in entries)


def _inertia(table: Table) -> Matrix | None:
    """Return I from three principal moments or from a symmetric tensor; positive definite."""
    if any(isinstance(row, list) for row in table.peek("inertia")):
        tensor = table.symmetric("inertia", diagonal=_MOMENT)
    else:
        moments = table.vector("inertia", reader=_MOMENT)
        tensor = None if moments is None else tensors.diagonal(moments)
    if tensor is None or not _is_positive(table, "a positive definite tensor", tensor, "inertia"):
        return None
    return tensor


def _is_positive(
    table: Table, expected: str, matrix: Matrix, key: str = "", mend: str = ""
) -> bool:
    """Return True if a symmetric matrix is positive definite.

    Sylvester: all its leading minors are positive.
    """
    for size, minor in enumerate(tensors.leading_minors(matrix), 1):
        if minor <= 0:
            got = f"one whose leading {size}x{size} minor is not positive"
            table.fault(expected, got, key, mend)
            return False
    return True


def immersed_body(table: Table, loads: Loads) -> ImmersedBody | None:
    """Return the body of model kirchhoff; None after a fault."""
    damping = table.number(DAMPING.name, default=Fraction(0))
    form = _form(table)
    body = form(table) if form else None
    if body is None or damping is None:
        return None
    if loads.is_written:
        return replace(body, damping=damping, loads=loads)
    constant = {name: _numbers(entries) for name, entries in loads.vectors}
    return replace(body.with_parts(constant), damping=damping)


def _form(table: Table) -> Callable[[Table], ImmersedBody | None] | None:
    """Return the reader of the one form of T that the table has; None after a fault."""
    written = [form for form in FORMS if table.has(form)]
    if len(written) == 1:
        return FORMS[written[0]]
    for form in written:
        if form == "mass":
            # It needs an inertia, which the other forms do not.
            table.take(form, "a number")
        else:
            FORMS[form](table)
    names = ", ".join(f"`{form}`" for form in FORMS)
    table.fault(f"exactly one of {names}", " and ".join(written) or "none of them")
    return None


def _clebsch(table: Table) -> ImmersedBody | None:
    """Return the body of Clebsch's T, Hydromechanics 49 (1)."""
    form = table.table("clebsch")
    if form is None:
        return None
    six = complete([form.number(key) for key in _CLEBSCH_KEYS])
    form.close()
    return None if six is None else _positive(form, Clebsch(*six).body())


def _energy(table: Table) -> ImmersedBody | None:
    """Return the body of 21 coefficients, as A, B and C."""
    form = table.table("energy")
    if form is None:
        return None
    a, b, c = form.symmetric("linear"), form.matrix("coupling"), form.symmetric("angular")
    form.close()
    return _positive(form, ImmersedBody(a, b, c)) if a and b and c else None


def _positive(form: Table, body: ImmersedBody) -> ImmersedBody | None:
    expected = "a positive definite energy [[A, B], [B^T, C]]"
    return body if _is_positive(form, expected, body.energy_matrix) else None


def _mass_matrix(table: Table) -> ImmersedBody | None:
    """Return the body of a mass matrix, which is inverted exactly."""
    matrix = table.symmetric("mass_matrix", size=6)
    expected = "a positive definite mass matrix"
    mend = "an added mass is minus a naval derivative: X_udot = -0.93 adds 0.93"
    if matrix is None or not _is_positive(table, expected, matrix, "mass_matrix", mend):
        return None
    return _of_mass_matrix(table, matrix)


def _of_mass_matrix(table: Table, matrix: Matrix) -> ImmersedBody:
    body = ImmersedBody.of_mass_matrix(matrix)
    table.note(
        "T is given by the mass matrix M of (x, y) = M (U, Omega). The equations hold its inverse "
        "[[A, B], [B^T, C]], which is formed exactly, in rationals."
    )
    for number, row in enumerate(body.energy_matrix, 1):
        table.note(f"Row {number} of the inverse: {', '.join(map(float_text, row))}.")
    return body


def _assembled(table: Table) -> ImmersedBody | None:
    """Return the body of a mass, an inertia about the centre of mass, and an added mass."""
    mass, inertia = table.number("mass"), _inertia(table)
    centre = table.vector("centre_of_mass", default=ZERO_VECTOR)
    added = _added_mass(table)
    if mass is None or inertia is None or centre is None or added is None:
        return None
    matrix = tuple(map(tensors.plus, rigid_mass_matrix(mass, centre, inertia), added))
    expected = "a mass and an added mass that make a positive definite mass matrix"
    mend = "an added mass is minus a naval derivative: X_udot = -0.93 adds 0.93"
    if not _is_positive(table, expected, matrix, "mass", mend):
        return None
    return replace(_of_mass_matrix(table, matrix), added=added)


def _added_mass(table: Table) -> Matrix | None:
    """Return the added mass: 6 x 6, six numbers of its diagonal, or none."""
    if not table.has("added_mass"):
        return tensors.diagonal((Fraction(0),) * 6)
    if any(isinstance(row, list) for row in table.peek("added_mass")):
        return table.symmetric("added_mass", size=6)
    diagonal = table.vector("added_mass", length=6)
    return None if diagonal is None else tensors.diagonal(diagonal)


def _ellipsoid(table: Table) -> ImmersedBody | None:
    """Return the body of a homogeneous ellipsoid, its inertia and added inertia by Lamb's integrals."""
    form = table.table("ellipsoid")
    if form is None:
        return None
    semi_axes = form.vector("semi_axes", reader=_SEMI_AXIS)
    density, fluid_density = (
        form.number(key, reader=_DENSITY) for key in ("density", "fluid_density")
    )
    form.close()
    if semi_axes is None or density is None or fluid_density is None:
        return None
    # Every motion has an impulse: without a mass of the body, it is that of the fluid alone.
    if density == fluid_density == 0:
        form.fault("a body or a fluid with mass", "two densities of 0", "density")
        return None
    if density == 0 and len(set(semi_axes)) < 3:
        expected = "a positive density where two semi-axes are equal"
        form.fault(expected, "0", "density", "a shell has little mass, but some")
        return None
    return Ellipsoid(semi_axes, density, fluid_density).body()


def warnings(body: Body) -> tuple[str, ...]:
    """Return sentences on properties that no real solid has, although the equations allow them."""
    tensor = body.parts().get("inertia")
    if tensor is None or obeys_triangle_inequality(tensor):
        return ()
    return (
        "one principal moment exceeds the sum of the other two: "
        "no distribution of mass has this tensor @ body.inertia",
    )


def obeys_triangle_inequality(inertia: Matrix) -> bool:
    """Return True if each principal moment is at most the sum of the other two, for I positive definite.

    The eigenvalues of S = (tr I / 2) 1 - I are (J2 + J3 - J1)/2 and so on. Any two of them add to a
    principal moment, so at most one is negative, and exactly then is det S negative.
    """
    if tensors.is_diagonal(inertia):
        moments = [row[i] for i, row in enumerate(inertia)]
        return 2 * max(moments) <= sum(moments)
    half_trace = sum((inertia[i][i] for i in range(3)), Fraction(0)) / 2
    s1, s2, s3 = (
        tuple((half_trace if i == j else Fraction(0)) - inertia[i][j] for j in range(3))
        for i in range(3)
    )
    return tensors.dot(s1, tensors.cross(s2, s3)) >= 0


FORMS: Final[dict[str, Callable[[Table], ImmersedBody | None]]] = {
    "clebsch": _clebsch,
    "energy": _energy,
    "ellipsoid": _ellipsoid,
    "mass_matrix": _mass_matrix,
    "mass": _assembled,
}
