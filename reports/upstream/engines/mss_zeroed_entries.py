# /// script
# requires-python = ">=3.10"
# dependencies = ["numpy>=2"]
# ///
"""remus100 of MSS and Python Vehicle Simulator sets entries of the Coriolis matrix of added mass to zero.

Versions: MSS of 2024 (remus100.m of 2024-02-13); Python Vehicle Simulator 2.0 of 2025 (remus100.py).

Expected: without damping and weight momentum in space, of body and fluid, and energy are kept.

Came: remus100.m leaves out the couple of Munk in yaw and terms in pitch, as it says, and with them the
forces (2, 6) and (6, 2): in ten seconds the momentum changes by 35 %, the energy by nothing. remus100.py
zeroes four entries, of couples alone: the momentum stays, and the energy changes by 77 %.

Evidence: C_A of Fossen (2011), equation 6.43, keeps both to 2e-12 in the same integration. remus100.m,
`CA(5,3) = 0; CA(3,5) = 0; ...`: https://github.com/cybergalactic/MSS; remus100.py, `CA[4][0] = 0`.
"""

import sys

import numpy as np

rigid = np.array([31.9005, 31.9005, 31.9005, 0.117383, 4.22073, 4.22073])
added = np.array([0.863302, 30.2936, 30.2936, 0.0352491, 3.59386, 3.59386])
MSS = [(5, 3), (3, 5), (5, 1), (1, 5), (6, 1), (1, 6), (6, 2), (2, 6)]
PYTHON = [(5, 1), (5, 4), (6, 1), (6, 2)]


def coriolis(mass, v, zeroed=()):
    x, y = (np.cross(np.eye(3), part) for part in np.split(mass * v, 2))
    matrix = np.block([[np.zeros((3, 3)), -x], [-x, -y]])
    for row, column in zeroed:
        matrix[row - 1, column - 1] = 0
    return matrix


def changes(zeroed):
    """The largest changes of momentum and energy in ten seconds, by RK4 with steps of a hundredth."""

    def rates(v):
        return -(coriolis(rigid, v) + coriolis(added, v, zeroed)) @ v / (rigid + added)

    v, h = np.array([1.5, 0.2, -0.1, 0.1, 0.05, 0.2]), 0.01
    momentum, energy = [], []
    for _ in range(1000):
        a = rates(v)
        b = rates(v + h / 2 * a)
        c = rates(v + h / 2 * b)
        v = v + h / 6 * (a + 2 * b + 2 * c + rates(v + h * c))
        momentum.append(np.linalg.norm(((rigid + added) * v)[:3]))
        energy.append((rigid + added) @ v**2)
    return max(momentum) / min(momentum) - 1, max(energy) / min(energy) - 1


names = {"expected: all of C_A": (), "got: MSS": MSS, "got: Python": PYTHON}
answers = {name: changes(zeroed) for name, zeroed in names.items()}
for name, (momentum, energy) in answers.items():
    print(f"{name:22} momentum {momentum:+.1e}, energy {energy:+.1e}")
sys.exit(1 if answers["got: MSS"][0] > 1e-3 else 0)
