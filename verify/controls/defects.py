"""The defects: what is wrong, and the quantity whose gate is named for it.

A defect of the equations is put into the form that heyoka compiles; a defect of the answer is put
into a sound trajectory. Conserved quantities alone see few of them: a wrong sign, a lost gyroscopic
term and a shift in time all conserve T and |H|^2 to the last bit.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any, final

import numpy as np
from mpmath import mp

from verify.models.algebra import add, cross, minus
from verify.models.euler import angular_velocity
from verify.models.form import Equations, Named
from verify.models.kirchhoff import velocities
from verify.models.problem import Problem
from verify.scenes.precision import rung
from verify.solvers.solver import Solver
from verify.solvers.taylor.driver import Taylor
from verify.solvers.trajectory import Trajectory


@final
@dataclass(frozen=True)
class Defect(Solver):
    """A sound solver with one thing broken.

    ``scene`` is a shipped scene on which it shows and ``gate`` the quantity that must fail there.
    """

    name: str
    scene: str
    gate: str
    equations: Equations | None = None
    spoil: Callable[[Trajectory], Trajectory] | None = None
    setting: str = "control"

    def solve(self, problem: Problem) -> Trajectory:
        if self.equations is not None:
            problem = problem.with_equations(self.equations)
        trajectory = Taylor().solve(problem)
        return self.spoil(trajectory) if self.spoil is not None else trajectory


# Defects of the equations.


def _gyroscopic_sign(n: Named) -> Mapping[str, Any]:
    """H' = K H x H + M: the orbit runs backwards on its own polhode."""
    H = n.vector("H")
    return _rates("H", add(cross(angular_velocity(H, n.symmetric("K")), H), n.vector("M")))


def _no_gyroscopic_term(n: Named) -> Mapping[str, Any]:
    """H' = M: what is left when omega x H is forgotten."""
    return _rates("H", n.vector("M"))


def _diagonal_tensor(n: Named) -> Mapping[str, Any]:
    """H' = H x K H with the products of inertia dropped: another body, soundly integrated."""
    H, K = n.vector("H"), n.symmetric("K")
    diagonal = [[K[i][j] if i == j else 0 for j in range(3)] for i in range(3)]
    return _rates("H", add(cross(H, angular_velocity(H, diagonal)), n.vector("M")))


def _munk_moment_sign(n: Named) -> Mapping[str, Any]:
    """y' = y x Omega - x x U: the destabilising couple of the added mass with its sign turned."""
    x, y = n.vector("x"), n.vector("y")
    U, Omega = velocities(x, y, n.symmetric("A"), n.matrix("B"), n.symmetric("C"))
    couple = cross(x, U)
    turned = [minus(a, b) for a, b in zip(cross(y, Omega), couple, strict=True)]
    return _rates("x", cross(x, Omega)) | _rates("y", turned)


def _rates(letter: str, vector: list[Any]) -> dict[str, Any]:
    return {f"{letter}{i}": component for i, component in enumerate(vector, start=1)}


# Defects of the answer.


def _stored_in_float32(sound: Trajectory) -> Trajectory:
    """Every number passes through a float32 on its way out."""
    single = rung("f32").bits
    with mp.workprec(single):
        return _mapped(
            sound, lambda rows: np.array([[+v for v in row] for row in rows], dtype=object)
        )


def _one_nan(sound: Trajectory) -> Trajectory:
    """One number of one sample is not a number."""

    def spoil(rows: Any) -> Any:
        spoiled = rows.copy()
        spoiled[len(rows) // 2, 0] = mp.nan
        return spoiled

    return _mapped(sound, spoil)


def _shifted_by_one_sample(sound: Trajectory) -> Trajectory:
    """Row k holds the state of row k - 1: an output buffer written one step late."""
    return _mapped(sound, lambda rows: np.concatenate([rows[:1], rows[:-1]]))


def _mapped(sound: Trajectory, change: Callable[[Any], Any]) -> Trajectory:
    return replace(sound, quantities={k: change(rows) for k, rows in sound.quantities.items()})


DEFECTS: tuple[Defect, ...] = (
    Defect("gyroscopic-sign", "euler/generic", "omega", equations=_gyroscopic_sign),
    Defect("no-gyroscopic-term", "euler/generic", "omega", equations=_no_gyroscopic_term),
    Defect("diagonal-tensor", "euler/full-tensor", "T", equations=_diagonal_tensor),
    Defect("munk-moment-sign", "kirchhoff/general-body", "T", equations=_munk_moment_sign),
    Defect("float32-storage", "euler/generic", "H2", spoil=_stored_in_float32),
    Defect("one-nan", "euler/generic", "omega", spoil=_one_nan),
    Defect("one-sample-late", "euler/generic", "omega", spoil=_shifted_by_one_sample),
    Defect("one-sample-late-impulse", "kirchhoff/screw", "impulse", spoil=_shifted_by_one_sample),
)
