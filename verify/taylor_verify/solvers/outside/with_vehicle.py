# /// script
# requires-python = ">=3.11,<3.15"
# dependencies = ["numpy==2.4.6"]
# [tool.taylor-verify]
# title = "Equations of underwater vehicle simulators, written here from their published form"
# models = ["kirchhoff"]
# loads = "written"
# data = "tensor"
# [tool.taylor-verify.methods]
# mss = "Marine Systems Simulator, remus100.m: entries of C_A zeroed"
# pvs = "Python Vehicle Simulator, remus100.py: other entries zeroed, its own added mass"
# gz = "gz-sim, Hydrodynamics: added mass as a force of the last acceleration"
# gz_turned = "the same with the sign of the Coriolis force turned"
# [tool.taylor-verify.settings]
# step = 0.01
# ///
"""Equations of three simulators of underwater vehicles, made from what they publish.

None of their code runs here. Damping, weight and current act as the scene writes them.

`mss`: remus100.m sets eight entries of C_A to zero, on both sides of the diagonal. SIMremus100.m steps the
velocities by forward Euler, the place by the new velocities, and the attitude by an exponential.

`pvs`: remus100.py sets four entries to zero, on one side. Its added mass in sway and heave divides by
log((1+e)/(1-e)), where Lamb's formula multiplies by it. The attitude is stepped as in `mss`.

`gz`: the Hydrodynamics plugin of gz-sim 8 and later, on a rigid body by semi-implicit Euler. Its force of
added mass is that of the change of velocity in the step before. Its Coriolis force is + C_A v for the
negative coefficients that it asks for; `gz_turned` has the other sign.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from axes import product
from equations import to_space
from free_body import Engine, Settings, Solved, answer, pushed_once, repeated, stepped
from immersed_body import ImmersedBody, pushed_solid
from question import Unsuited, unit

# The bodies of these programs as rigid ones: mass, moments about the centre of mass, its place on axis 3.
RIGID = (
    (31.9005, (0.117383, 4.22073, 4.22073), 0.02),
    (1073.3774899765126, (107.33774899765126, 268.34437249412815, 268.34437249412815), 0.0),
)
# The places of C_A that are set to zero, from 0.
ZEROED = {
    "mss": ((4, 2), (2, 4), (4, 0), (0, 4), (5, 0), (0, 5), (5, 1), (1, 5)),
    "pvs": ((4, 0), (4, 3), (5, 0), (5, 1)),
}
SEMI_AXES = 0.8, 0.095
Acceleration = Callable[[Any, Any], Any]


def solve(body: ImmersedBody, settings: Settings) -> Solved:
    import numpy

    rigid, added = parts(body)

    def start() -> Engine:
        moving = numpy.array([*body.velocity, *body.omega])
        place, attitude = numpy.array(body.centre, dtype=float), list(body.attitude)
        acceleration = accelerations(body, settings, rigid, added)

        def step() -> None:
            nonlocal attitude
            wrench = numpy.zeros(6)
            if body.is_pushed:
                wrench += body.wrench(moving[:3], moving[3:], attitude, place)
            moving[:] += settings.step * acceleration(moving, wrench)
            place[:] += settings.step * numpy.array(to_space(*attitude, *moving[:3]))
            attitude = unit(product(attitude, turned(moving[3:], settings.step)))

        return repeated(step), lambda: body.row(moving[:3], moving[3:], attitude, place)

    return stepped(body, settings.step, start, pushed_once(body))


def parts(body: ImmersedBody) -> tuple[Any, Any]:
    """Return the mass matrices of the solid and of the fluid; raises Unsuited for another body."""
    import numpy

    whole = numpy.array(body.mass)
    for mass, moments, low in RIGID:
        rigid = rigid_mass(mass, moments, low)
        added = whole - rigid
        rest = added - numpy.diag(numpy.diag(added))
        if abs(rest).max() <= 1e-9 * mass and (numpy.diag(added) >= -1e-9 * mass).all():
            return rigid, numpy.diag(numpy.diag(added))
    raise Unsuited(
        "expected the REMUS 100 or the ellipsoid of gz-sim's test, got another solid @ body"
    )


def rigid_mass(mass: float, moments: Any, low: float) -> Any:
    """Return the mass matrix about the origin, linear before angular."""
    import numpy

    S = numpy.array([[0.0, -low, 0.0], [low, 0.0, 0.0], [0.0, 0.0, 0.0]])
    inertia = numpy.diag(moments) - mass * S @ S
    return numpy.block([[mass * numpy.eye(3), -mass * S], [mass * S, inertia]])


def accelerations(body: ImmersedBody, settings: Settings, rigid: Any, added: Any) -> Acceleration:
    """Return the acceleration of a method, as a function of velocities and what acts."""
    import numpy

    if settings.method == "pvs":
        added = with_published_sway(added)
    if settings.method in ZEROED:
        inverse, zeroed = numpy.linalg.inv(rigid + added), ZEROED[settings.method]

        def of_vehicle(moving: Any, wrench: Any) -> Any:
            C = coriolis(added, moving)
            for place in zeroed:
                C[place] = 0.0
            return inverse @ (wrench - (coriolis(rigid, moving) + C) @ moving)

        return of_vehicle
    if abs(rigid - numpy.diag(numpy.diag(rigid))).max() > 0:
        raise Unsuited("expected a body whose origin is its centre of mass, got another @ body")
    sign = 1.0 if settings.method == "gz" else -1.0
    inverse, before = numpy.linalg.inv(rigid), numpy.array([*body.velocity, *body.omega])

    def of_plugin(moving: Any, wrench: Any) -> Any:
        force = -added @ (moving - before) / settings.step + sign * coriolis(added, moving) @ moving
        before[:] = moving
        return inverse @ (wrench + force - coriolis(rigid, moving) @ moving)

    return of_plugin


def with_published_sway(added: Any) -> Any:
    """Return the added mass with remus100.py's factor in sway and heave, of the mass of the spheroid."""
    a, b = SEMI_AXES
    e = math.sqrt(1.0 - (b / a) ** 2)
    logarithm = math.log((1.0 + e) / (1.0 - e))
    right = 1.0 / e**2 - (1.0 - e**2) / (2.0 * e**3) * logarithm
    published = 1.0 / e**2 - (1.0 - e**2) / (2.0 * e**3 * logarithm)
    changed = added.copy()
    factor = published / (2.0 - published) / (right / (2.0 - right))
    changed[1, 1] *= factor
    changed[2, 2] *= factor
    return changed


def coriolis(mass: Any, moving: Any) -> Any:
    """Return C(v) of a mass matrix, by Fossen (2011), equation 6.43."""
    import numpy

    x, y = (mass @ moving).reshape(2, 3)
    return numpy.block([[numpy.zeros((3, 3)), -cross(x)], [-cross(x), -cross(y)]])


def cross(v: Any) -> Any:
    import numpy

    return numpy.array([[0.0, -v[2], v[1]], [v[2], 0.0, -v[0]], [-v[1], v[0], 0.0]])


def turned(omega: Any, step: float) -> list[float]:
    """Return the quaternion of a turn by omega for one step."""
    angle = math.hypot(*omega) * step
    half = 0.5 * step * (math.sin(0.5 * angle) / (0.5 * angle) if angle else 1.0)
    return [math.cos(0.5 * angle), *(half * w for w in omega)]


if __name__ == "__main__":
    answer(solve, pushed_solid)
