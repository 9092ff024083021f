"""Keys that people try and no scene has: what to write instead, or why it is not modelled.

One mapping for each model and table; keys are in small letters. A sentence stands in brackets behind
the fault of its key.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Final

_WHEELS_IN_FLUID: Final = "not modelled: wheels turn in a body of the model euler"
_NOT_YET: Final = "not modelled yet"
_ATTITUDE: Final = "write `attitude = [q0, q1, q2, q3]`, a quaternion, scalar first, body to space"
_NO_FLOW: Final = (
    "not modelled: the fluid is ideal, and an exact motion with viscous forces is not known"
)
_NEUTRAL: Final = (
    "not modelled: weight and buoyancy balance at the origin; loads that are constant in body axes are "
    "`force` and `couple`"
)
_INSIDE_M: Final = (
    "write `mass_matrix`, the 6x6 matrix of (x, y) = M (U, Omega), which is the rigid body's inertia "
    "plus the added mass"
)
_TENSOR: Final = (
    "write `inertia`: three principal moments, or the tensor [[Ixx, Ixy, Ixz], [Ixy, Iyy, Iyz], "
    "[Ixz, Iyz, Izz]] with Ixy = -int xy dm"
)
_FLUID_MODEL: Final = 'a body in a fluid is `model = "kirchhoff"`, there as `mass_matrix`'
_ROTATION_ALONE: Final = (
    "not modelled: euler is the rotation alone, about the centre of mass or about a fixed point"
)
_IMPULSES: Final = "write `linear_impulse` and `angular_impulse`, or the two velocities"


def _same(sentence: str, *keys: str) -> dict[str, str]:
    return dict.fromkeys(keys, sentence)


_EULER_BODY: Final = {
    **_same(_TENSOR, "ixx", "iyy", "izz", "ixy", "ixz", "iyz", "i", "inertia_tensor", "moments"),
    **_same(_TENSOR, "principal_moments", "moments_of_inertia", "moment_of_inertia"),
    **_same(
        "leave it out: the mass does not enter the rotation, and `inertia` holds what does",
        *("mass", "m", "density", "volume"),
    ),
    **_same(
        "leave it out: `inertia` is about the centre of mass, or about a point held fixed",
        *("centre_of_mass", "center_of_mass", "com", "cog"),
    ),
    **_same(
        "not modelled: gravity has no moment about the centre of mass; a moment that is constant in body "
        "axes is `moment`",
        *("gravity", "g", "weight", "buoyancy"),
    ),
    **_same(
        "write `moment`, constant in body axes", "torque", "torques", "couple", "moments_applied"
    ),
    "force": "a force does not turn a body; write its moment, constant in body axes, as `moment`",
    **_same(_FLUID_MODEL, "mass_matrix", "added_mass", "fluid_added_mass", "fluid_density"),
    **_same(_NOT_YET, "damping"),
    **_same("write `rotor`, the momentum of all wheels", "wheels", "reaction_wheels"),
    **_same(
        "not modelled: drag has no exact motion to compare with", "drag", "friction", "viscosity"
    ),
    **_same(
        "it stands in [initial]",
        *("omega", "angular_velocity", "attitude", "quaternion"),
    ),
}

_KIRCHHOFF_BODY: Final = {
    **_same(_INSIDE_M, "mass", "m", "added_mass", "fluid_added_mass", "inertia", "inertia_tensor"),
    **_same(_INSIDE_M, "m_a", "m_rb", "ixx", "iyy", "izz", "ixy", "ixz", "iyz", "added_inertia"),
    **_same(_INSIDE_M, "centre_of_mass", "center_of_mass", "com", "cog", "inertia_matrix"),
    **_same(
        "write `ellipsoid = { semi_axes = [..], density = .., fluid_density = .. }`, or `mass_matrix`",
        *("semi_axes", "density", "fluid_density", "volume", "rho"),
    ),
    **_same(_NEUTRAL, "gravity", "g", "weight", "buoyancy", "centre_of_buoyancy", "cob", "volume"),
    **_same(_NO_FLOW, "drag", "lift", "friction", "viscosity", "linear_drag", "quadratic_drag"),
    **_same(_NO_FLOW, "current", "circulation"),
    **_same(_NOT_YET, "damping"),
    **_same(_WHEELS_IN_FLUID, "rotor", "wheels", "reaction_wheels"),
    **_same("write `couple`, constant in body axes", "torque", "torques", "moment"),
    **_same(
        "write `force` and `couple`, constant in body axes",
        "thrust",
        "forces",
        "wrench",
        "propeller",
    ),
    **_same(
        "it stands in [initial]",
        *("linear_velocity", "angular_velocity", "linear_impulse", "angular_impulse", "attitude"),
    ),
}

_INITIAL: Final = {
    **_same(_ATTITUDE, "quaternion", "orientation", "q", "quat", "pose", "rotation"),
    **_same(_ATTITUDE, "rpy", "euler", "euler_angles", "roll", "pitch", "yaw", "attitude_deg"),
    **_same("the time of the initial state is `start` in [time]", "t", "t0", "time"),
}

_EULER_INITIAL: Final = {
    **_INITIAL,
    **_same(
        'write `omega`, in body axes: radians per unit of time, or text such as "2 deg/s"',
        *("angular_velocity", "angular_rate", "rates", "w", "p", "r", "spin"),
    ),
    "angular_momentum": "write `omega`: the angular momentum is I omega",
    **_same(_ROTATION_ALONE, "velocity", "linear_velocity", "position", "centre", "center"),
    **_same(_ROTATION_ALONE, "linear_impulse", "linear_momentum"),
}

_KIRCHHOFF_INITIAL: Final = {
    **_INITIAL,
    **_same(
        "write `linear_velocity`, of the origin in body axes, together with `angular_velocity`",
        *("velocity", "u", "v", "w", "twist", "speed", "nu"),
    ),
    **_same(
        "write `angular_velocity`, in body axes, together with `linear_velocity`",
        *("omega", "rates", "p", "r", "angular_rate"),
    ),
    **_same(
        "write `centre`, the body's origin in space",
        "position",
        "center",
        "x0",
        "origin",
        "location",
    ),
    **_same(_IMPULSES, "impulse", "momentum", "linear_momentum", "angular_momentum", "momenta"),
}

_TOP: Final = {
    **_same(
        "not modelled; loads that are constant in body axes stand in [body]",
        *("gravity", "fluid", "environment", "drag", "forces"),
    ),
    **_same(
        "a scene holds no tolerance: the bound follows from precision, steps and conditioning",
        *("tolerance", "tol", "rtol", "atol"),
    ),
    **_same(
        "leave it out: units are any consistent set, and angles are in radians", "units", "unit"
    ),
    **_same("whose answer is judged is said on the command line", "solver", "integrator", "rung"),
}

_TIME: Final = {
    **_same(
        "write `end`, and `samples`, both ends included; the steps between are the solver's own",
        *("dt", "step", "timestep", "time_step", "duration", "stop", "t_end", "tf", "n", "rate"),
    ),
    **_same("write `at`, an array of instants", "times", "instants", "t"),
}

_HINTS: Final[Mapping[tuple[str, str], Mapping[str, str]]] = {
    ("euler", "body"): _EULER_BODY,
    ("kirchhoff", "body"): _KIRCHHOFF_BODY,
    ("euler", "initial"): _EULER_INITIAL,
    ("kirchhoff", "initial"): _KIRCHHOFF_INITIAL,
}
_OF_EVERY_MODEL: Final = {"": _TOP, "time": _TIME}


def hints(part: str, model: str = "") -> Mapping[str, str]:
    """Return the sentences for one table of a scene (``""`` is its top) by key in small letters."""
    return _OF_EVERY_MODEL.get(part) or _HINTS.get((model, part), MappingProxyType({}))
