# /// script
# requires-python = ">=3.10"
# dependencies = ["mujoco==3.17.0", "numpy>=2"]
# ///
"""RK4 turns the attitude of a free body with second order, and omega with fourth.

Versions: MuJoCo 2.3.7 to 3.17.0; in 4.0.0 both have fourth order.

Expected: with half the step, a sixteenth of the error of omega and of the attitude.

Came: a sixteenth of that of omega, a quarter of that of the attitude. The momentum in space, R I omega,
shows it without a reference: it drifts with second order.

Evidence: each stage turns the start by one mean omega (`mj_integratePos(m, X[i], dX, h)`), and so does the
step, which is second order on rotations:
https://github.com/google-deepmind/mujoco/blob/3.8.0/src/engine/engine_forward.c#L1314 and #L1347.
"""

import sys

import mujoco
import numpy as np

XML = """<mujoco><option gravity="0 0 0" integrator="RK4" timestep="{}"/><worldbody><body><freejoint/>
  <inertial pos="0 0 0" mass="1" diaginertia="4 3 2"/></body></worldbody></mujoco>"""


def momentum(h, steps):
    turn = np.zeros(9)
    data = mujoco.MjData(model := mujoco.MjModel.from_xml_string(XML.format(h)))
    data.qvel[3:] = 1.5, -0.8, 1.2
    mujoco.mj_step(model, data, steps)
    mujoco.mju_quat2Mat(turn, data.qpos[3:7])
    return turn.reshape(3, 3) @ (np.array([4, 3, 2]) * data.qvel[3:])


drifts = [np.linalg.norm(momentum(h, round(10 / h)) - momentum(h, 0)) for h in (0.02, 0.01)]
order = np.log2(drifts[0] / drifts[1])
print(f"expected  order 4\ngot       order {order:.1f}, MuJoCo {mujoco.__version__}")
sys.exit(0 if order > 3.5 else 1)
