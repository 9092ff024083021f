# /// script
# requires-python = ">=3.10"
# dependencies = ["numpy>=2"]
# ///
"""Two vehicle simulators have a wrong bracket in the added mass of a spheroid across its axis.

Versions: uuv_simulator 0.6.13, HMSpheroid; Python Vehicle Simulator of 2025 (version 2.0), remus100.py.

Expected: beta = 1/e^2 - (1 - e^2) / (2 e^3) ln((1 + e) / (1 - e)), the added mass across m beta / (2 -
beta).

Came: HMSpheroid has (1 - e^2 / (2 e^3)) ln(..), which for the REMUS 100 makes beta -1.79 and the added
mass negative, -0.47 of the mass in place of 0.95. remus100.py divides by the logarithm, and has 1.03.

Evidence: Lamb, Hydrodynamics, article 114, here by quadrature; a long spheroid must come near 1 from
below, as a cylinder. https://github.com/uuvsimulator/uuv_simulator, HydrodynamicModel.cc, which calls
the class unfinished; https://github.com/cybergalactic/PythonVehicleSimulator, remus100.py, beta_0.
"""

import sys

import numpy as np

a, b = 0.8, 0.095
e = np.sqrt(1 - (b / a) ** 2)
logarithm = np.log((1 + e) / (1 - e))


def by_quadrature():
    """The integral a b^2 ds / ((b^2 + s)^2 sqrt(a^2 + s)) from 0, with s = (1 + t) / (1 - t)."""
    t, weights = np.polynomial.legendre.leggauss(400)
    s = (1 + t) / (1 - t)
    return np.sum(weights * a * b**2 / ((b**2 + s) ** 2 * np.sqrt(a**2 + s)) * 2 / (1 - t) ** 2)


betas = {
    "expected  Lamb's integral": by_quadrature(),
    "expected  the closed form": 1 / e**2 - (1 - e**2) / (2 * e**3) * logarithm,
    "got       HMSpheroid": 1 / e**2 - (1 - e**2 / (2 * e**3)) * logarithm,
    "got       remus100.py": 1 / e**2 - (1 - e**2) / (2 * e**3 * logarithm),
}
factors = [beta / (2 - beta) for beta in betas.values()]
for (name, beta), factor in zip(betas.items(), factors, strict=True):
    print(f"{name:26} beta {beta:8.4f}, added mass {factor:7.4f} of the displaced mass")
sys.exit(1 if abs(np.subtract(factors[2:], factors[0])).min() > 1e-3 else 0)
