# /// script
# requires-python = ">=3.11,<3.15"
# dependencies = [
#   "pin==4.1.0",
#   "numpy==2.4.6",
# ]
# [tool.taylor-verify]
# title = "Pinocchio's dynamics, under a thin integrator of ours"
# models = ["euler"]
# loads = "written"
# data = "tensor"
# [tool.taylor-verify.settings]
# integrator = ["RK4", "semi-implicit"]
# step = 0.01
# ///
"""Pinocchio, which has no integrator: its accelerations and its step on the group are judged.

These are `aba` and `integrate`. The integrators are ours, and as thin as they can be. ``semi-implicit``
turns by the new velocity, as simulators on Pinocchio do. ``RK4`` is Munthe-Kaas' form of the classical
method, by `dIntegrate`. A free flyer takes a full tensor, has omega in body axes and the quaternion
scalar last, in doubles.
"""

from __future__ import annotations

from typing import Any

from free_body import (
    Engine,
    FreeBody,
    Settings,
    Solved,
    answer,
    pushed_body,
    pushed_in_stages,
    stepped,
)


def solve(body: FreeBody, settings: Settings) -> Solved:
    step = {"RK4": runge_kutta, "semi-implicit": semi_implicit}[settings.integrator]
    model = model_of(body)
    x, y, z = body.attitude[1:]

    def start() -> Engine:
        import numpy

        data = model.createData()
        place = numpy.array([0.0, 0.0, 0.0, x, y, z, body.attitude[0]])
        velocity = numpy.array([0.0, 0.0, 0.0, *body.omega])
        done = 0

        def accelerations(place: Any, velocity: Any, later: float) -> Any:
            import pinocchio

            force = numpy.zeros(6)
            if body.is_pushed:
                attitude = place[6], *place[3:6]
                force[3:] = body.moment(velocity[3:], attitude, done * settings.step + later)
            return pinocchio.aba(model, data, place, velocity, force)

        def advance(steps: int) -> None:
            nonlocal done
            for _ in range(steps):
                place[:], velocity[:] = step(model, accelerations, place, velocity, settings.step)
                done += 1

        return advance, lambda: body.row(velocity[3:], (place[6], *place[3:6]))

    return stepped(body, settings.step, start, pushed_in_stages(body))


def model_of(body: FreeBody) -> Any:
    import numpy
    import pinocchio

    model, here = pinocchio.Model(), pinocchio.SE3.Identity()
    joint = model.addJoint(0, pinocchio.JointModelFreeFlyer(), here, "body")
    inertia = pinocchio.Inertia(1.0, numpy.zeros(3), numpy.array(body.inertia))
    model.appendBodyToJoint(joint, inertia, here)
    model.gravity.linear = numpy.zeros(3)
    return model


def semi_implicit(model: Any, a: Any, place: Any, velocity: Any, h: float) -> Any:
    import pinocchio

    velocity = velocity + h * a(place, velocity, 0.0)
    return pinocchio.integrate(model, place, h * velocity), velocity


def runge_kutta(model: Any, a: Any, place: Any, velocity: Any, h: float) -> Any:
    import numpy
    import pinocchio

    def rates(u: Any, v: Any, later: float) -> Any:
        """Return u', for the place that u leads to on the group, and v'."""
        along = pinocchio.dIntegrate(model, place, u, pinocchio.ARG1)
        return numpy.linalg.solve(along, v), a(pinocchio.integrate(model, place, u), v, later)

    k1, l1 = rates(numpy.zeros(6), velocity, 0.0)
    k2, l2 = rates(h / 2 * k1, velocity + h / 2 * l1, h / 2)
    k3, l3 = rates(h / 2 * k2, velocity + h / 2 * l2, h / 2)
    k4, l4 = rates(h * k3, velocity + h * l3, h)
    u = h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    return pinocchio.integrate(model, place, u), velocity + h / 6 * (l1 + 2 * l2 + 2 * l3 + l4)


if __name__ == "__main__":
    answer(solve, pushed_body)
