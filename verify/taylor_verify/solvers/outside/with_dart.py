# /// script
# requires-python = ">=3.11,<3.15"
# dependencies = [
#   "dartpy==6.20.0",
#   "numpy==2.4.6",
# ]
# [tool.taylor-verify]
# title = "DART"
# loads = "written"
# data = "tensor"
# [tool.taylor-verify.settings]
# step = 0.001
# defaults = ["off", "shipped"]
# ///
"""DART: a body with a free joint, without gravity. Its world has one integrator, semi-implicit Euler.

The inertia of a body is any symmetric 6x6 matrix, which is Kirchhoff's equations as they stand: the
mass matrix of body and fluid together is handed over. DART has the angular part first. A body's
spatial velocity is in its own axes; its transform leads from body to space. `defaults=shipped` leaves what
puts slow bodies to sleep as it comes, which is on.
"""

from __future__ import annotations

from free_body import (
    Engine,
    FreeBody,
    Settings,
    Solved,
    answer,
    pushed_once,
    repeated,
    stepped,
)
from immersed_body import ORIGIN, ImmersedBody, any_body
from question import Row


def solve(body: FreeBody | ImmersedBody, settings: Settings) -> Solved:
    import dartpy
    import numpy

    is_immersed = isinstance(body, ImmersedBody)
    tensor = numpy.eye(6)
    if is_immersed:
        # The halves change places.
        tensor = numpy.roll(numpy.array(body.mass), 3, axis=(0, 1))
    else:
        tensor[:3, :3] = body.inertia
    velocity, centre = (body.velocity, body.centre) if is_immersed else (ORIGIN, ORIGIN)

    def start() -> Engine:
        world = dartpy.simulation.World()
        world.setGravity([0, 0, 0])
        world.setTimeStep(settings.step)
        if hasattr(world, "setDeactivationOptions"):
            options = world.getDeactivationOptions()
            options.mEnabled = settings.defaults == "shipped"
            world.setDeactivationOptions(options)
        skeleton = dartpy.dynamics.Skeleton()
        joint, node = skeleton.createFreeJointAndBodyNodePair()
        node.setInertia(dartpy.dynamics.Inertia(tensor))
        place = dartpy.math.Isometry3()
        place.set_quaternion(dartpy.math.Quaternion(*body.attitude))
        place.set_translation(centre)
        joint.setTransform(place)
        space = dartpy.dynamics.Frame.World()
        joint.setSpatialVelocity([*body.omega, *velocity], space, node)
        world.addSkeleton(skeleton)

        def row() -> Row:
            moving, place = node.getSpatialVelocity(), node.getWorldTransform()
            attitude = place.quaternion().wxyz()
            if is_immersed:
                return body.row(moving[3:], moving[:3], attitude, place.translation())
            return body.row(moving[:3], attitude)

        def step() -> None:
            if is_immersed and body.is_pushed:
                moving, place = node.getSpatialVelocity(), node.getWorldTransform()
                attitude = place.quaternion().wxyz()
                wrench = body.wrench(moving[3:], moving[:3], attitude, place.translation())
                node.addExtForce(numpy.array(wrench[:3]), numpy.zeros(3), isForceLocal=True)
                node.addExtTorque(numpy.array(wrench[3:]), isLocal=True)
            elif pushed is not None:
                moving, attitude = node.getSpatialVelocity(), node.getWorldTransform().quaternion()
                moment = pushed.moment(moving[:3], attitude.wxyz())
                node.addExtTorque(numpy.array(moment), isLocal=True)
            world.step()

        return repeated(step), row

    pushed = body if isinstance(body, FreeBody) and body.is_pushed else None
    return stepped(body, settings.step, start, pushed_once(body))


if __name__ == "__main__":
    answer(solve, any_body)
