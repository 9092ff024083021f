# /// script
# requires-python = ">=3.10"
# dependencies = ["mujoco==3.12.0", "numpy>=2"]
# ///
"""A tensor given as fullinertia is compiled turned, by up to a millionth of a radian.

Versions: MuJoCo 2.3.7 to 3.12.0; in 3.14.0 the compiled tensor is the given one to rounding.

Expected: R diag(body_inertia) R^T, with R of body_iquat, is the given tensor to some roundoffs.

Came: of two hundred tensors with moments 2, 3, 4 the worst is off by 6e-7 of its largest entry. A free
body then moves as that other body, at every step and with every integrator.

Evidence: the eigenvalues are found by Jacobi's turns, which end when the cosine of a turn is above
1 - 1e-12, and so the turn below 1.4e-6 radians (`if (c > 1.0-eigEPS)`):
https://github.com/google-deepmind/mujoco/blob/3.8.0/src/engine/engine_util_solve.c#L967.
"""

import sys

import mujoco
import numpy as np

random, worst, R = np.random.default_rng(0), 0.0, np.zeros(9)
for _ in range(200):
    axes = np.linalg.qr(random.normal(size=(3, 3)))[0]
    given = axes @ np.diag([2.0, 3.0, 4.0]) @ axes.T
    entries = " ".join(
        repr(float(given[i, j])) for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))
    )
    model = mujoco.MjModel.from_xml_string(f"""<mujoco><worldbody><body><freejoint/>
      <inertial pos="0 0 0" mass="1" fullinertia="{entries}"/></body></worldbody></mujoco>""")
    mujoco.mju_quat2Mat(R, model.body_iquat[1])
    compiled = R.reshape(3, 3) @ np.diag(model.body_inertia[1]) @ R.reshape(3, 3).T
    worst = max(worst, np.abs(compiled - given).max() / 4)

print(f"expected  a tensor within 1e-13\ngot       {worst:.1e}, MuJoCo {mujoco.__version__}")
sys.exit(0 if worst <= 1e-13 else 1)
