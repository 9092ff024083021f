"""Kinds of faults of a body: how it starts, what it prints, and numbers that a file of a simulator has."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Final

import numpy as np

from taylor_verify_reports.studies.causes.bodies import Floats, Sample
from taylor_verify_reports.studies.causes.kind import FLUID, Kind, of, right
from taylor_verify_reports.studies.causes.simulated import Law, Rows, integrated, law
from taylor_verify_reports.studies.causes.stepping import Draw, Make

_ENTRIES: Final = ("I_", "M_")
_PRINTED: Final = ("printed by the mass matrix of another body",)
_MOMENTA: Final = ("momenta",)


def become(own: Law, mass: Floats) -> None:
    """Let a simulator have another tensor or mass matrix in all terms."""
    own.mass, own.coriolis, own.munk = mass, mass.copy(), mass[:3].copy()


def _other(s: Sample, d: Draw, size: float, count: int = 1) -> Floats:
    """Return the tensor or mass matrix with other numbers in so many places of its diagonal."""
    mass, places = s.mass.copy(), d.permutation(s.n)[:count]
    mass[places, places] = np.round(mass[places, places] * (1 + size / 4), 5)
    return mass


def _from_momenta(s: Sample, d: Draw, size: float) -> Rows:
    own = law(s)
    become(own, _other(s, d, size))
    start = np.asarray(np.linalg.solve(own.mass, s.mass @ s.v0))
    return integrated(replace(s, v0=start), own)


def _two_entries(own: Law, s: Sample, d: Draw, size: float) -> None:
    become(own, _other(s, d, size, 2))


def _no_coupling(own: Law, s: Sample, d: Draw, size: float) -> None:
    own.mass = s.mass.copy()
    own.mass[:3, 3:] = own.mass[3:, :3] = 0


def _of_float32(own: Law, s: Sample, d: Draw, size: float) -> None:
    become(own, s.mass.astype(np.float32).astype(float))


def _momenta(matrix: Callable[[Sample, Draw, float], Floats]) -> Make:
    """Return the right motion with momenta by another matrix."""
    return lambda s, d, size: right(s)._replace(mass=matrix(s, d, size))


def _velocities(s: Sample, d: Draw, size: float) -> Rows:
    """Return the right motion with velocities that another mass matrix makes of its momenta."""
    rows = right(s)
    return rows._replace(v=rows.v @ s.mass.T @ np.linalg.inv(_other(s, d, size)).T)


def _about_a_point(s: Sample, d: Draw, size: float) -> Floats:
    moved = np.eye(6)
    moved[3:, :3] = np.cross(np.eye(3), np.round(size * d.uniform(0.3, 1, 3), 4))
    return np.asarray(moved @ s.mass)


def _exchanged(s: Sample, d: Draw, size: float) -> Floats:
    return np.roll(s.mass, 3, axis=0)


OF_BODIES: Final = (
    Kind("another body from the same momenta", _ENTRIES, _from_momenta, ("free", *FLUID)),
    Kind("two entries of the tensor", _ENTRIES, of(_two_entries)),
    Kind(
        "coupling left out in M alone",
        ("coupling", "centre of mass", "m r"),
        of(_no_coupling),
        ("solid",),
    ),
    Kind("numbers in float32", ("float32", *_ENTRIES), of(_of_float32)),
    Kind(
        "velocities by another body",
        (*_PRINTED, "has factors"),
        _velocities,
        ("fluid", "solid"),
        has_centre=True,
    ),
    Kind("momenta by another body", _PRINTED, _momenta(_other), _MOMENTA, has_centre=True),
    Kind(
        "couple about another point",
        ("about the point",),
        _momenta(_about_a_point),
        _MOMENTA,
        has_centre=True,
    ),
    Kind(
        "x and y exchanged",
        ("each other's place",),
        _momenta(_exchanged),
        _MOMENTA,
        has_centre=True,
    ),
)
