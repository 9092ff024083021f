# /// script
# requires-python = ">=3.10"
# dependencies = ["mujoco==4.0.0", "numpy>=2"]
# ///
"""An ellipsoid in an ideal fluid moves without the part of its added mass that goes with acceleration.

Versions: MuJoCo 2.3.7 to 4.0.0.

Expected: with `fluidshape="ellipsoid"` and no drag or lift, Kirchhoff's equations, (M + A) v' = ...

Came: M v' = ..., with the same right-hand side: the two agree to rounding, and Kirchhoff's motion is
another one. No step brings it nearer, and energy and momentum of body and fluid are not conserved.

Evidence: `mj_addedMassForces` takes the accelerations, and is called without them ("disabled due to
dependency on qacc but included for completeness"):
https://github.com/google-deepmind/mujoco/blob/3.8.0/src/engine/engine_passive.c#L880 and #L919.
"""

import sys

import mujoco
import numpy as np

model = mujoco.MjModel.from_xml_string("""<mujoco>
  <option gravity="0 0 0" integrator="RK4" timestep="0.001" density="1" viscosity="0"/><worldbody><body>
  <freejoint/><geom type="ellipsoid" size="1 0.8 0.5" density="1.5" fluidshape="ellipsoid"
  fluidcoef="0 0 0 0 0"/></body></worldbody></mujoco>""")
data = mujoco.MjData(model)
data.qvel[:] = start = np.array([0.1, -0.06, 0.08, 0.3, 0.5, -0.2])
mujoco.mj_step(model, data, 5000)
turn = np.zeros(9)
mujoco.mju_quat2Mat(turn, data.qpos[3:])
got = np.r_[turn.reshape(3, 3).T @ data.qvel[:3], data.qvel[3:]]

volume = 4 / 3 * np.pi * 0.4
body = 1.5 * volume * np.array([1, 1, 1, 0.89 / 5, 1.25 / 5, 1.64 / 5])
added = model.geom_fluid[0, 6:12]


def moved(mass):
    """The velocities in body axes after the same time, by RK4, with this mass before v'."""

    def rates(v):
        p, q = np.split((body + added) * v, 2)
        return np.r_[np.cross(p, v[3:]), np.cross(q, v[3:]) + np.cross(p, v[:3])] / mass

    v, h = start, 0.001
    for _ in range(5000):
        a = rates(v)
        b = rates(v + h / 2 * a)
        c = rates(v + h / 2 * b)
        v = v + h / 6 * (a + 2 * b + 2 * c + rates(v + h * c))
    return v


print("expected  Kirchhoff's equations:", *moved(body + added).round(6))
print("got       MuJoCo", mujoco.__version__, *got.round(6))
print("          body mass alone before v':", *moved(body).round(6))
sys.exit(0 if abs(got - moved(body + added)).max() < 1e-3 else 1)
