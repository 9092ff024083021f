# /// script
# requires-python = ">=3.10"
# dependencies = ["mujoco==4.0.0", "numpy>=2"]
# ///
"""The integrator implicitfast means another method for a free body in each of three ranges of versions.

Versions: MuJoCo 2.3.7 to 3.3.7 (energy grows), 3.8.0 (it is conserved), 3.12.0 to 4.0.0 (it decays).

Expected: one name has one method; a tumbling body in vacuum keeps its energy to the order of the method.

Came: at one step of 0.01 the energy of ten seconds grows by 3e-2, is conserved to rounding, or decays by
3e-2, as the version is. Second order in 3.8.0 alone, first order before and after.

Evidence: the changelog, version 3.7.0 (0c337799, midpoint integration of free bodies), 3.8.1 (910b3336,
implicitfast alone) and 3.11.0 (f0fa3d82, replaced; "tumbling motion is now mildly damped; models requiring
long-horizon energy conservation should use RK4"): https://mujoco.readthedocs.io/en/3.11.0/changelog.html.
"""

import sys

import mujoco
import numpy as np

model = mujoco.MjModel.from_xml_string("""<mujoco>
  <option gravity="0 0 0" integrator="implicitfast" timestep="0.01"/><worldbody><body><freejoint/>
  <inertial pos="0 0 0" mass="1" diaginertia="4 3 2"/></body></worldbody></mujoco>""")
data, moments = mujoco.MjData(model), np.array([4, 3, 2])
data.qvel[3:] = 1.5, -0.8, 1.2
before = moments @ data.qvel[3:] ** 2
mujoco.mj_step(model, data, 1000)
change = moments @ data.qvel[3:] ** 2 / before - 1
print(f"expected  no change of the energy\ngot       {change:+.1e}, MuJoCo {mujoco.__version__}")
sys.exit(0 if abs(change) <= 1e-9 else 1)
