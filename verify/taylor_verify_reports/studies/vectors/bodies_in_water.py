"""Solids in a fluid as vehicles have them: added mass, drag, thrust, righting moment, current, motors."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np

from taylor_verify_reports.studies.causes.bodies import Acting, Floats, Sample
from taylor_verify_reports.studies.causes.simulated import rotation
from taylor_verify_reports.studies.vectors.bodies_under_loads import Draw, Loaded, numbers, texts

_NAMES: Final = ("u1", "u2", "u3", "w1", "w2", "w3")


def skew(a: Floats) -> Floats:
    """Return the matrix of a x."""
    return np.array([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]])


def _solid(body: Sample, draw: Draw) -> Sample:
    """A rigid body with an added mass; its origin is not its centre of mass."""
    mass, inertia = numbers(draw, 2, 4, 1), numbers(draw, 0.8, 2)
    centre, added = numbers(draw, -0.15, 0.15), numbers(draw, 0.3, 2, 6)
    lever = skew(centre)
    dry = np.zeros((6, 6))
    dry[:3, :3], dry[:3, 3:], dry[3:, :3] = mass * np.eye(3), -mass * lever, mass * lever
    dry[3:, 3:] = np.diag(inertia) - mass * lever @ lever
    solid = {
        "mass": mass[0],
        "inertia": inertia,
        "centre_of_mass": centre,
        "added_mass": added,
    }
    return replace(body, mass=dry + np.diag(added), dry=dry, solid=solid)


def _both(lines: list[str]) -> tuple[str, str]:
    return f"force = {texts(lines[:3])}", f"couple = {texts(lines[3:])}"


def _driven(body: Sample, draw: Draw, lines: tuple[str, ...] = ()) -> Sample:
    """A thrust along the first axis, and a drag that is linear and quadratic."""
    push = float(numbers(draw, 0.2, 0.6, 1)[0]) * np.eye(6)[0]
    linear, quadratic = numbers(draw, 0.1, 0.4, 6), numbers(draw, 0.1, 0.4, 6)
    drag = zip(linear, _NAMES, quadratic, _NAMES, _NAMES, strict=True)
    written = [f"-{a}*{u} - {b}*abs({v})*{w}" for a, u, b, v, w in drag]
    written[0] += f" + {push[0]}"
    acting = Acting(load=lambda t, v, q, own: push - linear * v - quadratic * np.abs(v) * v)
    return replace(body, lines=(*_both(written), *lines), acting=acting)


def vehicle(body: Sample, draw: Draw) -> Sample:
    """A neutral vehicle with thrust and drag, whose weight acts at its centre of mass."""
    driven = _driven(_solid(body, draw), draw)
    weight, at = float(numbers(draw, 1, 3, 1)[0]), driven.solid["centre_of_mass"]
    down = np.array([0, 0, -weight])
    load = driven.acting.load

    def acting(t: float, v: Floats, q: Floats, own: Floats) -> Floats:
        righting = np.cross(at, rotation(q).T @ down)
        return np.asarray(load(t, v, q, own) + np.array([0, 0, 0, *righting]))

    place = f"[{', '.join(map(str, at))}]"
    hydrostatic = (
        f"weight = {{ force = [0, 0, {-weight}], at = {place} }}",
        f"buoyancy = {{ force = [0, 0, {weight}] }}",
    )
    return replace(driven, lines=(*driven.lines, *hydrostatic), acting=Acting(load=acting))


def in_current(body: Sample, draw: Draw) -> Sample:
    """A vehicle in a current: its velocities are relative to the fluid."""
    current = numbers(draw, 0.2, 0.6)
    driven = _driven(_solid(body, draw), draw, (f"current = {current.tolist()}",))
    return replace(driven, current=current)


def clebsch(body: Sample, draw: Draw) -> Sample:
    """A solid of revolution of Kirchhoff and Clebsch, by the energy of its impulses."""
    p, p_prime, r, r_prime = numbers(draw, 0.5, 1.5, 4)
    q, q_prime = numbers(draw, -0.2, 0.2, 2)
    coupling = np.diag([q, q, q_prime])
    energy = np.block([[np.diag([p, p, p_prime]), coupling], [coupling, np.diag([r, r, r_prime])]])
    names = ("p", "p_prime", "q", "q_prime", "r", "r_prime")
    six = dict(zip(names, (p, p_prime, q, q_prime, r, r_prime), strict=True))
    return replace(body, mass=np.linalg.inv(energy), solid={"clebsch": six})


def steered(body: Sample, draw: Draw) -> Sample:
    """Own states: a propeller and a rudder follow their commands with a lag."""
    solid = _solid(body, draw)
    push, gain, pace = (float(x) for x in numbers(draw, 0.3, 0.9))
    drag = numbers(draw, 0.1, 0.4, 6)
    lines = [f"-{a}*{name}" for a, name in zip(drag, _NAMES, strict=True)]
    lines[0], lines[5] = f"{lines[0]} + m1", f"{lines[5]} + m2"
    rates = [f"{pace}*({push} - m1)", f"{pace}*(-{gain}*q3 - m2)"]
    tables = ("[states]", f"m = {{ start = [0, 0], rate = {texts(rates)} }}")
    acting = Acting(
        load=lambda t, v, q, own: np.array([own[0], 0, 0, 0, 0, own[1]]) - drag * v,
        start=np.zeros(2),
        rate=lambda t, v, q, own: pace * (np.array([push, -gain * q[3]]) - own),
    )
    return replace(solid, lines=_both(lines), tables=tables, acting=acting)


IN_WATER: Final[dict[str, Loaded]] = {
    "vehicle": vehicle,
    "current": in_current,
    "clebsch": clebsch,
    "steered": steered,
}
