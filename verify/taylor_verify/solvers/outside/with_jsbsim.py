# /// script
# requires-python = ">=3.11,<3.15"
# dependencies = ["jsbsim==1.3.3", "numpy==2.4.6"]
# [tool.taylor-verify]
# title = "JSBSim"
# models = ["euler"]
# loads = "written"
# data = "tensor"
# [tool.taylor-verify.settings]
# step = 0.01
# defaults = ["off", "shipped"]
# rates = ["AdamsBashforth2", "RectangularEuler", "Trapezoidal", "AdamsBashforth3", "AdamsBashforth4"]
# attitude = [
#   "Buss2", "RectangularEuler", "Trapezoidal", "AdamsBashforth2", "AdamsBashforth3", "AdamsBashforth4",
#   "Buss1", "LocalLinearization", "AdamsBashforth5",
# ]
# ///
"""JSBSim: an aircraft of mass and moments alone, high above a planet that does not turn.

``rates`` is the integrator of the angular velocity, ``attitude`` that of the quaternion; both are
properties of the simulation, and ``defaults=shipped`` leaves them as they come. The body begins at rest
above a point of the equator and falls straight down, so that the local axes do not turn. Moments are
given in slug ft2; the unit does not matter. JSBSim reports Euler angles of the local axes, omega in
body axes. There is no damping and no cap to switch off. What acts is a moment of its external reactions,
set before a step; JSBSim steps the rates before it sums the moments, so that the next step has it.
"""

from __future__ import annotations

import math
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from free_body import (
    Engine,
    FreeBody,
    Settings,
    Solved,
    answer,
    pushed_body,
    pushed_once,
    repeated,
    stepped,
)

# The numbers of JSBSim (FGPropagate.h) for its integrators.
NUMBERS = {
    "RectangularEuler": 1,
    "Trapezoidal": 2,
    "AdamsBashforth2": 3,
    "AdamsBashforth3": 4,
    "AdamsBashforth4": 5,
    "Buss1": 6,
    "Buss2": 7,
    "LocalLinearization": 8,
    "AdamsBashforth5": 9,
}
AIRCRAFT = """<?xml version="1.0"?>
<fdm_config name="body" version="2.0"><fileheader/><metrics/><mass_balance>
<ixx unit="SLUG*FT2">{!r}</ixx><iyy unit="SLUG*FT2">{!r}</iyy><izz unit="SLUG*FT2">{!r}</izz>
<emptywt unit="LBS">32.17</emptywt>
<location name="CG" unit="FT"><x>0</x><y>0</y><z>0</z></location></mass_balance>
<ground_reactions/><propulsion/><aerodynamics/><external_reactions>
<moment name="l" frame="BODY" unit="LBSFT"><direction><x>1</x><y>0</y><z>0</z></direction></moment>
<moment name="m" frame="BODY" unit="LBSFT"><direction><x>0</x><y>1</y><z>0</z></direction></moment>
<moment name="n" frame="BODY" unit="LBSFT"><direction><x>0</x><y>0</y><z>1</z></direction></moment>
</external_reactions></fdm_config>"""
PLANET = """<?xml version="1.0"?><planet name="still">
<rotation_rate unit="RAD/SEC">0</rotation_rate></planet>"""


def solve(body: FreeBody, settings: Settings) -> Solved:
    turned = body.in_principal_axes()

    def start() -> Engine:
        fdm = aircraft_of(turned, settings)

        def state() -> Any:
            angles = [fdm[f"attitude/{name}-rad"] for name in ("phi", "theta", "psi")]
            return [fdm[f"velocities/{name}-rad_sec"] for name in "pqr"], attitude_of(angles)

        def pushed_step() -> None:
            for name, entry in zip("lmn", turned.moment(*state()), strict=True):
                fdm[f"external_reactions/{name}/magnitude-lbsft"] = entry
            fdm.run()

        return repeated(pushed_step if turned.is_pushed else fdm.run), lambda: turned.row(*state())

    late = "; it reaches the body a step late" if turned.is_pushed else ""
    return stepped(turned, settings.step, start, f"{pushed_once(turned)}{late}")


def aircraft_of(body: FreeBody, settings: Settings) -> Any:
    """Return a simulation at its start."""
    import jsbsim

    with TemporaryDirectory() as folder:
        place = Path(folder)
        (place / "body").mkdir()
        (place / "body" / "body.xml").write_text(AIRCRAFT.format(*body.moments))
        (place / "planet.xml").write_text(PLANET)
        fdm = jsbsim.FGFDMExec(str(place))
        fdm.set_debug_level(0)
        fdm.set_dt(settings.step)
        fdm.load_planet(str(place / "planet.xml"), useAircraftPath=False)
        fdm.load_model_with_paths("body", str(place), str(place), str(place))
    if settings.defaults == "off":
        fdm["simulation/integrator/rate/rotational"] = NUMBERS[settings.rates]
        fdm["simulation/integrator/position/rotational"] = NUMBERS[settings.attitude]
    for name, value in zip(("phi", "theta", "psi-true"), angles_of(body.attitude), strict=True):
        fdm[f"ic/{name}-rad"] = value
    for name, value in zip("pqr", body.omega, strict=True):
        fdm[f"ic/{name}-rad_sec"] = value
    fdm["ic/h-sl-ft"] = 1e9
    fdm.run_ic()
    return fdm


def angles_of(q: Any) -> tuple[float, float, float]:
    """Return roll, pitch and yaw of an attitude, body to space."""
    q0, q1, q2, q3 = q
    roll = math.atan2(2 * (q0 * q1 + q2 * q3), 1 - 2 * (q1 * q1 + q2 * q2))
    pitch = math.asin(max(-1.0, min(1.0, 2 * (q0 * q2 - q3 * q1))))
    return roll, pitch, math.atan2(2 * (q0 * q3 + q1 * q2), 1 - 2 * (q2 * q2 + q3 * q3))


def attitude_of(angles: Any) -> list[float]:
    """Return the attitude of roll, pitch and yaw."""
    (a, b, c), (d, e, f) = (
        [function(0.5 * v) for v in angles] for function in (math.cos, math.sin)
    )
    return [
        a * b * c + d * e * f,
        d * b * c - a * e * f,
        a * e * c + d * b * f,
        a * b * f - d * e * c,
    ]


if __name__ == "__main__":
    answer(solve, pushed_body)
