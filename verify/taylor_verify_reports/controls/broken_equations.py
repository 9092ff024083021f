"""Defects of the equations: a wrong right-hand side, soundly integrated.

H, K    angular momentum (body axes), inverse tensor         x, y      impulses, body axes
A, B, C energy T = x.A x/2 + x.B y + y.C y/2                 U, Omega  velocities dT/dx and dT/dy
J       (x, y) = J (U, Omega), the inverse of [[A, B], [B^T, C]]

Any Omega and U in x' = x x Omega, y' = y x Omega + x x U, and in the motion of the frame, leave |x|^2,
x.y and the impulses in space constant. A body with other coefficients conserves these, and an energy of
its own.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction
from functools import partial
from typing import Any, Final

from taylor_verify.models.algebra import add, apply, cross, minus
from taylor_verify.models.damping import WithDamping
from taylor_verify.models.euler import angular_velocity, euler_equations
from taylor_verify.models.form import Named, in_unit_of_path, labelled
from taylor_verify.models.general import in_general_form
from taylor_verify.models.kirchhoff import impulse_rates, kirchhoff_equations, velocities
from taylor_verify.models.problem import Problem
from taylor_verify.numbers import tensors
from taylor_verify.scenes.bodies import ImmersedBody
from taylor_verify.solvers.solver import Solver
from taylor_verify.solvers.taylor.driver import Taylor
from taylor_verify.solvers.trajectory import Trajectory
from taylor_verify_reports.controls.defect import BRICK, SCREW, Defect

# Per unit of time. The default of several game engines is 0.05, which is 50000 times as much.
_DAMPING: Final = Fraction(1, 10**6)
# Relative error of a coefficient that is read from a drawing, or stored in single precision.
_UNEVENNESS: Final = 1e-6

# The mass and the moments of the body of SCREW without the fluid. They may be any numbers below the least
# eigenvalue of J, 0.593: the energy of the fluid is then positive.
_MASS_ALONE: Final = Fraction(1, 2)


# Euler.


def _gyroscopic_sign(n: Named) -> Mapping[str, Any]:
    """H' = K H x H + M."""
    H = n.vector("H")
    rate = add(cross(angular_velocity(H, n.symmetric("K")), H), n.vector("M"))
    return euler_equations(n) | labelled("H", rate)


def _no_gyroscopic_term(n: Named) -> Mapping[str, Any]:
    """H' = M."""
    return euler_equations(n) | labelled("H", n.vector("M"))


def _diagonal_tensor(n: Named) -> Mapping[str, Any]:
    """Return the rates of Euler's equations, with K cut to its diagonal."""
    absent = {f"K{i}{j}" for i in (1, 2, 3) for j in (1, 2, 3) if i != j}
    return euler_equations(Named({k: v for k, v in n.items() if k not in absent}))


def _damped(problem: Problem) -> Problem:
    """H' = H x K H + M - c H."""
    damping = float(_DAMPING * problem.units.time)

    def equations(n: Named) -> Mapping[str, Any]:
        rates = euler_equations(n)
        return rates | {k: minus(rates[k], damping * n[k]) for k in ("H1", "H2", "H3")}

    return problem.with_equations(equations)


def _without_damping(problem: Problem) -> Problem:
    """Return the problem of a damped body without its damping."""
    equations = problem.form.equations
    assert isinstance(equations, WithDamping)
    return problem.with_equations(equations.body)


def _with_damping_of_omega(problem: Problem) -> Problem:
    """H' = H x K H - c K H in place of H x K H - c H."""
    equations, units = problem.form.equations, problem.units
    assert isinstance(equations, WithDamping)
    free, damping = equations.body, float(problem.given.body.damping / units.momentum)

    def changed(n: Named) -> Mapping[str, Any]:
        rates = dict(free(n))
        omega = labelled("H", angular_velocity(n.vector("H"), n.symmetric("K")))
        return rates | {k: minus(rates[k], damping * omega[k]) for k in omega}

    return problem.with_equations(changed)


# Kirchhoff.


def _with_damping_of_x_alone(problem: Problem) -> Problem:
    """y' = y x Omega + x x U + L, without -c y."""
    equations = problem.form.equations
    assert isinstance(equations, WithDamping)
    return problem.with_equations(replace(equations, momenta=("x1", "x2", "x3")))


def in_21_coefficients(problem: Problem) -> Problem:
    """Return the problem with the general equations: there y3 is a state, in Clebsch's a constant."""
    if problem.form.equations is kirchhoff_equations:
        return problem
    return in_general_form(problem)


class InGeneralForm(Solver):
    """The sound twin: heyoka on all 21 coefficients."""

    name = "taylor"
    setting = "21 coefficients"

    def solve(self, problem: Problem) -> Trajectory:
        return Taylor().solve(in_21_coefficients(problem))


def _velocities(n: Named) -> tuple[list[Any], list[Any]]:
    return velocities(
        n.vector("x"), n.vector("y"), n.symmetric("A"), n.matrix("B"), n.symmetric("C")
    )


def _munk_moment_sign(n: Named) -> Mapping[str, Any]:
    """y' = y x Omega - x x U + L."""
    U, Omega = _velocities(n)
    turned, couple = cross(n.vector("y"), Omega), cross(n.vector("x"), U)
    rate = add([minus(a, b) for a, b in zip(turned, couple, strict=True)], n.vector("L"))
    return kirchhoff_equations(n) | labelled("y", rate)


def _uneven(n: Named) -> Mapping[str, Any]:
    """Kirchhoff's equations with C22 larger than C11 by a millionth."""
    return kirchhoff_equations(Named(n | {"C22": n["C22"] * (1 + _UNEVENNESS)}))


def _unturned_path(n: Named) -> Mapping[str, Any]:
    """c' = U in place of R U."""
    U, _ = _velocities(n)
    return kirchhoff_equations(n) | labelled("c", in_unit_of_path(n, U))


def _without_added_acceleration(problem: Problem) -> Problem:
    """m (U, Omega)' = the right sides of 48 (3), (4), with m of the body without the fluid.

    So (x, y)' = J/m times these right sides.
    """
    problem = in_21_coefficients(problem)
    body, units = problem.given.body, problem.units
    assert isinstance(body, ImmersedBody)
    J = tensors.inverse(body.energy_matrix)
    unit = (units.impulse,) * 3 + (units.momentum,) * 3
    ratio = [[J[i][k] / _MASS_ALONE * unit[k] / unit[i] for k in range(6)] for i in range(6)]
    # The int 0 leaves its term out of the equations.
    weights = [[float(entry) if entry else 0 for entry in row] for row in ratio]

    def equations(n: Named) -> Mapping[str, Any]:
        x, y = n.vector("x"), n.vector("y")
        U, Omega = _velocities(n)
        x_rate, y_rate = impulse_rates(x, y, U, Omega, n.vector("X"), n.vector("L"))
        rates = apply(weights, [*x_rate, *y_rate])
        return kirchhoff_equations(n) | labelled("x", rates[:3]) | labelled("y", rates[3:])

    return problem.with_equations(equations)


_in_water: Final = partial(Defect, scene=SCREW, twin=InGeneralForm())

EQUATIONS: Final = (
    Defect(
        name="gyroscopic-sign",
        scene=BRICK,
        gate="omega",
        passes=frozenset({"T", "H2"}),
        what="the gyroscopic term with its sign turned",
        why="H x omega is perpendicular to H and to omega, whatever its sign: |H| and T stay, while "
        "the body runs backwards on its own polhode",
        equations=_gyroscopic_sign,
        is_common=True,
    ),
    Defect(
        name="no-gyroscopic-term",
        scene=BRICK,
        gate="H_space",
        passes=frozenset({"T", "H2"}),
        what="no gyroscopic term: omega stays as it began",
        why="nothing changes in body axes, so that nothing can drift there; in space the momentum "
        "turns with the body",
        equations=_no_gyroscopic_term,
        is_common=True,
    ),
    Defect(
        name="diagonal-tensor",
        scene="euler/oblique-symmetry",
        gate="T",
        passes=frozenset({"H2", "H_space"}),
        what="the inertia tensor cut to its diagonal",
        why="the motion of another body: it keeps its momentum, and its own energy instead of this "
        "one's",
        equations=_diagonal_tensor,
        is_common=True,
    ),
    Defect(
        name="angular-damping",
        scene=BRICK,
        gate="H2",
        what="angular damping of 1e-6 per second",
        why="H shrinks by exp(-1e-6 t), and everything made of it shrinks likewise",
        recast=_damped,
        is_common=True,
    ),
    Defect(
        name="damping-left-out",
        scene="euler/damped",
        gate="T",
        what="the damping of the scene left out",
        why="T, H and everything made of them stay, where they are to shrink by e^{-2ct} and e^{-ct}",
        recast=_without_damping,
        is_common=True,
    ),
    Defect(
        name="damping-of-omega",
        scene="euler/damped",
        gate="H2",
        what="a moment -c omega, where it is -c I omega",
        why="each component of H shrinks at a rate of its own, and H turns in space",
        recast=_with_damping_of_omega,
        is_common=True,
    ),
    Defect(
        name="damping-of-one-impulse",
        scene="kirchhoff/damped",
        gate="FG",
        passes=frozenset({"F2", "x_space"}),
        what="damping of the linear impulse alone",
        why="x shrinks as it is to do, and R x with it, whatever the body turns like; y does not",
        recast=_with_damping_of_x_alone,
    ),
    _in_water(
        name="munk-moment-sign",
        gate="y_space",
        passes=frozenset({"F2", "FG", "x_space"}),
        what="the added-mass couple x x U with its sign turned",
        why="x x U is perpendicular to x: it enters neither |x|^2 nor x.y, and the motion of x does "
        "not know it; energy and moment do",
        recast=in_21_coefficients,
        equations=_munk_moment_sign,
        is_common=True,
    ),
    _in_water(
        name="no-added-mass-acceleration",
        gate="FG",
        what="added mass in the couples, none in the acceleration",
        why="(U, Omega) answers to the mass of the body alone and conserves an energy made with "
        "that; the impulse, which has the fluid in it, is no longer a momentum",
        recast=_without_added_acceleration,
        is_common=True,
    ),
    _in_water(
        name="uneven-coefficient",
        gate="y3",
        passes=frozenset({"F2", "FG", "x_space", "y_space"}),
        what="one of two equal coefficients larger by 1e-6",
        why="the motion of another body again: it keeps the impulses, has an energy of its own, and "
        "being no body of revolution it has no y3",
        recast=in_21_coefficients,
        equations=_uneven,
    ),
    _in_water(
        name="unturned-path",
        gate="centre",
        passes=frozenset({"impulse", "attitude", "T", "F2", "FG", "y3", "x_space"}),
        what="the path of the centre summed from velocities in body axes",
        why="the centre enters no equation but its own, and of the conserved quantities only the "
        "moment about a point of space",
        recast=in_21_coefficients,
        equations=_unturned_path,
        is_common=True,
    ),
)
