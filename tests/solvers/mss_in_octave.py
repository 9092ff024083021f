"""Compare MSS's equations, run by Octave, with the entrant `outside:vehicle-mss`.

    python tests/solvers/mss_in_octave.py FOLDER

FOLDER is a clone of https://github.com/cybergalactic/MSS. remus100.m runs without damping, propeller and
fins, which the scene does not have, and is stepped as SIMremus100.m steps quaternions. It runs twice: with
its own numbers, which the scene rounds to six digits, and with those of the scene.
"""

import re
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

import taylor_verify as tv

STEPS = """
addpath('MSS/LIBRARY/modeling', 'MSS/LIBRARY/kinematics', 'MSS/GNC', 'MSS/INS/functions', pwd);
q = [1 .2 .1 0]' / norm([1 .2 .1 0]); x = [1.5 -.1 0 .1 .05 .2 0 0 0 q']'; h = 0.0025;
for k = 1:100
  xdot = remus100(x, [0; 0; 0]); q = x(10:13); x(1:6) = x(1:6) + h * xdot(1:6);
  x(7:9) = x(7:9) + h * Rquat(q) * x(1:3);
  q = expm(Tquat(x(4:6)) * h) * q; x(10:13) = q / norm(q);
end
printf('%.17g\\n', x);
"""
UNLOADED = {"tau_liftdrag": "0", "tau_crossflow": "0", "D": "zeros(6)"}
ROUNDED = {
    "remus100.m": {**UNLOADED, "m": "MRB(1, 1); W = 313.263; B = W"},
    "spheroid.m": {"m": "31.9005", "Ix": "0.117383", "Iy": "4.22073"},
    "imlay61.m": {"MA": "diag([0.863302 30.2936 30.2936 0.0352491 3.59386 3.59386])"},
}


def end_by_octave(source, edits):
    """Return velocities, place and quaternion at the end, by a copy of MSS with the edits."""
    with tempfile.TemporaryDirectory() as copy:
        for name, assignments in edits.items():
            text = next(source.glob(f"*/**/{name}")).read_text()
            for left, right in assignments.items():
                text, changed = re.subn(f"(?m)^{left} = .*", f"{left} = {right};", text)
                assert changed, f"expected an assignment of {left} in {name}"
            (Path(copy) / name).write_text(text)
        command = ["octave-cli", "--no-init-file", "--eval", STEPS.replace("MSS", str(source))]
        return np.array(subprocess.check_output(command, text=True, cwd=copy).split(), dtype=float)


entrant = (
    tv.solve("loads/vehicle-weight-low", "outside:vehicle-mss?step=0.0025").to_dataframe().iloc[-1]
)
for numbers, edits in {"MSS's": {"remus100.m": UNLOADED}, "the scene's": ROUNDED}.items():
    end = end_by_octave(Path(sys.argv[1]).resolve(), edits)
    centre = abs(entrant[["c1", "c2", "c3"]] - end[6:9]).max()
    attitude = abs(entrant[["q0", "q1", "q2", "q3"]] - end[9:]).max()
    print(
        f"{numbers} numbers: the centre differs by {centre:.1e}, the quaternion by {attitude:.1e}"
    )
