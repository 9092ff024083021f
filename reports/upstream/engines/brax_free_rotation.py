# /// script
# requires-python = ">=3.11"
# dependencies = ["brax==0.14.2", "mujoco==3.17.0", "mujoco-mjx==3.17.0", "jax==0.10.2", "numpy>=2"]
# ///
"""The pipelines spring and positional turn a free body without omega x I omega.

Versions: Brax 0.14.2; the pipeline generalized has the term.

Expected: the momentum in space, R I R^T omega, of a free body is constant, and omega changes.

Came: omega in space is constant in `spring`, to rounding, and decays in `positional`; the momentum turns
through a large angle. An asymmetric body spins steadily about any axis.

Evidence: `pipeline.step` adds forces of joints, gravity and collisions to the velocity in space, and no
other term; users have asked: https://github.com/google/brax/issues/48 and
https://github.com/google/brax/issues/156. In `positional` omega is 2 sin(angle / 2) / dt of the turn of
a step (`project_xd`, brax/positional/integrator.py, line 100), which is less than angle / dt.
"""

import sys

import jax
import mujoco
import numpy as np
from brax.generalized import pipeline as generalized
from brax.io import mjcf
from brax.positional import pipeline as positional
from brax.spring import pipeline as spring

system = mjcf.load_model(
    mujoco.MjModel.from_xml_string("""<mujoco><option gravity="0 0 0" timestep="0.005"/><worldbody><body>
  <freejoint/><inertial pos="0 0 0" mass="1" diaginertia="4 3 2"/>
  <geom size="0.1" contype="0" conaffinity="0"/></body></worldbody></mujoco>""")
)
drift = {}
for pipeline in (generalized, spring, positional):
    state = pipeline.init(system, system.init_q, np.array([0.0, 0, 0, 1.5, -0.8, 1.2]))
    seen = []
    step = jax.jit(lambda state, pipeline=pipeline: pipeline.step(system, state, np.zeros(0)))
    for _ in range(400):
        s, (x, y, z) = float(state.x.rot[0][0]), map(float, state.x.rot[0][1:])
        cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
        R = np.eye(3) + 2 * s * cross + 2 * cross @ cross
        omega = np.array(state.xd.ang[0])
        seen.append([omega, R @ np.diag([4, 3, 2]) @ R.T @ omega])
        state = step(state)
    (w, H), name = np.swapaxes(seen, 0, 1), pipeline.__name__.split(".")[1]
    drift[name] = np.abs(H - H[0]).max() / np.linalg.norm(H[0])
    print(f"{name:12} the momentum in space drifts by {drift[name]:.1e} of its size,")
    print(f"{'':12} omega in space changes by {np.abs(w - w[0]).max():.1e}")
print("expected     a drift of the size of the step, and a change of the size of omega")
sys.exit(1 if max(drift["spring"], drift["positional"]) > 0.1 else 0)
