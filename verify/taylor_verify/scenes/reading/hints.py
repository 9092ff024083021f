"""Keys that people try and no scene has: what to write instead, or why it is not modelled.

One mapping for each model and table, of a sentence to the keys, in small letters, behind whose fault it
stands in brackets.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Final

_NOT_YET: Final = "not modelled yet"
_ATTITUDE: Final = "write `attitude = [q0, q1, q2, q3]`, a quaternion, scalar first, body to space"
_IN_INITIAL: Final = "it stands in [initial]"

_EULER_BODY: Final = {
    "write `inertia`: three principal moments, or the tensor [[Ixx, Ixy, Ixz], [Ixy, Iyy, Iyz], "
    "[Ixz, Iyz, Izz]] with Ixy = -int xy dm": "ixx iyy izz ixy ixz iyz i inertia_tensor moments "
    "principal_moments moments_of_inertia moment_of_inertia",
    "leave it out: the mass does not enter the rotation, and `inertia` holds what does": "mass m "
    "density volume",
    "leave it out: `inertia` is about the centre of mass, or about a point held fixed": "com cog "
    "centre_of_mass center_of_mass",
    "not modelled: gravity has no moment about the centre of mass; a moment that is constant in body "
    "axes is `moment`": "gravity g weight buoyancy",
    "write `moment`, constant in body axes": "torque torques couple moments_applied",
    "a force does not turn a body; write its moment, constant in body axes, as `moment`": "force",
    'a body in a fluid is `model = "kirchhoff"`, there as `mass_matrix`': "mass_matrix added_mass "
    "fluid_added_mass fluid_density",
    _NOT_YET: "damping",
    "write `rotor`, the momentum of all wheels": "wheels reaction_wheels",
    "not modelled: drag has no exact motion to compare with": "drag friction viscosity",
    _IN_INITIAL: "omega angular_velocity attitude quaternion",
}
_KIRCHHOFF_BODY: Final = {
    "write `mass_matrix`, the 6x6 matrix of (x, y) = M (U, Omega), which is the rigid body's inertia "
    "plus the added mass": "mass m added_mass fluid_added_mass inertia inertia_tensor inertia_matrix "
    "m_a m_rb ixx iyy izz ixy ixz iyz added_inertia centre_of_mass center_of_mass com cog",
    "write `ellipsoid = { semi_axes = [..], density = .., fluid_density = .. }`, or `mass_matrix`": (
        "semi_axes density fluid_density rho"
    ),
    "not modelled: weight and buoyancy balance at the origin; loads that are constant in body axes are "
    "`force` and `couple`": "gravity g weight buoyancy centre_of_buoyancy cob volume",
    "not modelled: the fluid is ideal, and an exact motion with viscous forces is not known": "drag "
    "lift friction viscosity linear_drag quadratic_drag current circulation",
    _NOT_YET: "damping",
    "not modelled: wheels turn in a body of the model euler": "rotor wheels reaction_wheels",
    "write `couple`, constant in body axes": "torque torques moment",
    "write `force` and `couple`, constant in body axes": "thrust forces wrench propeller",
    _IN_INITIAL: "linear_velocity angular_velocity linear_impulse angular_impulse attitude",
}
_INITIAL: Final = {
    _ATTITUDE: "quaternion orientation q quat pose rotation rpy euler euler_angles roll pitch yaw "
    "attitude_deg",
    "the time of the initial state is `start` in [time]": "t t0 time",
}
_EULER_INITIAL: Final = {
    **_INITIAL,
    'write `omega`, in body axes: radians per unit of time, or text such as "2 deg/s"': "p r w rates "
    "angular_velocity angular_rate spin",
    "write `omega`: the angular momentum is I omega": "angular_momentum",
    "not modelled: euler is the rotation alone, about the centre of mass or about a fixed point": (
        "velocity linear_velocity position centre center linear_impulse linear_momentum"
    ),
}
_KIRCHHOFF_INITIAL: Final = {
    **_INITIAL,
    "write `linear_velocity`, of the origin in body axes, together with `angular_velocity`": "velocity "
    "u v w twist speed nu",
    "write `angular_velocity`, in body axes, together with `linear_velocity`": "omega rates p r "
    "angular_rate",
    "write `centre`, the body's origin in space": "position center x0 origin location",
    "write `linear_impulse` and `angular_impulse`, or the two velocities": "impulse momentum momenta "
    "linear_momentum angular_momentum",
}
_TOP: Final = {
    "not modelled; loads that are constant in body axes stand in [body]": "gravity fluid environment "
    "drag forces",
    "a scene holds no tolerance: the bound follows from precision, steps and conditioning": "tolerance "
    "tol rtol atol",
    "leave it out: units are any consistent set, and angles are in radians": "units unit",
    "whose answer is judged is said on the command line": "solver integrator rung",
}
_TIME: Final = {
    "write `end`, and `samples`, both ends included; the steps between are the solver's own": "dt step "
    "timestep time_step duration stop t_end tf n rate",
    "write `at`, an array of instants": "times instants t",
}


def _by_key(sentences: Mapping[str, str]) -> Mapping[str, str]:
    return {key: sentence for sentence, keys in sentences.items() for key in keys.split()}


# The top of a scene and its times are those of every model.
_HINTS: Final[Mapping[tuple[str, str], Mapping[str, str]]] = {
    ("", ""): _by_key(_TOP),
    ("", "time"): _by_key(_TIME),
    ("euler", "body"): _by_key(_EULER_BODY),
    ("kirchhoff", "body"): _by_key(_KIRCHHOFF_BODY),
    ("euler", "initial"): _by_key(_EULER_INITIAL),
    ("kirchhoff", "initial"): _by_key(_KIRCHHOFF_INITIAL),
}


def hints(part: str, model: str = "") -> Mapping[str, str]:
    """Return the sentences for one table of a scene (``""`` is its top) by key in small letters."""
    return _HINTS.get((model, part)) or _HINTS.get(("", part)) or MappingProxyType({})
