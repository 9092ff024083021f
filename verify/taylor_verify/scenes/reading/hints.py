"""Keys that people try and no scene has: what to write instead, or why it is not modelled.

There is one text for each model and table. A line of it has keys in small letters, a colon, and the
sentence that is printed in brackets after the fault of each of these keys.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Final

_TOP: Final = """\
gravity fluid environment drag forces current: loads stand in [body]: `weight`, `buoyancy`, `current`, and
  `moment`, or `force` and `couple`, whose entries may be text such as "-0.1*abs(w1)*w1"
constants parameters variables definitions: write [define], names for numbers and expressions
loads: write them in [body]: `moment`, or `force` and `couple`
state own_states controller controllers: write [states], such as `h = { start = 0, rate = "-h/5" }`, or
  `m = { every = "1/10", value = "-w1" }` for a value that is held
tolerance tol rtol atol: a scene holds no tolerance: the bound follows from precision, steps and
  conditioning
units unit: leave it out: units are any consistent set, and angles are in radians
solver integrator rung: whose answer is judged is said on the command line
"""
_TIME: Final = """\
dt step timestep time_step duration stop t_end tf n rate: write `end`, and `samples`, both ends included;
  the steps between are the solver's own
times instants t: write `at`, an array of instants
"""
_EULER_BODY: Final = """\
ixx iyy izz ixy ixz iyz i inertia_tensor moments principal_moments moments_of_inertia moment_of_inertia:
  write `inertia`: three principal moments, or the tensor [[Ixx, Ixy, Ixz], [Ixy, Iyy, Iyz], [Ixz, Iyz,
  Izz]] with Ixy = -int xy dm
mass m density volume: leave it out: the mass does not enter the rotation, and `inertia` holds what does;
  a force is written as `weight`
com cog centre_of_mass center_of_mass: leave it out: `inertia` is about the centre of mass, or about a
  point held fixed
gravity g: write `weight = { force = [0, 0, -9.81], at = [0, 0, 0.1] }`, a force in space axes at a point of
  the body, for a body whose origin is held; gravity has no moment about the centre of mass
gravity_gradient: write it as `moment`: with the direction of the centre in [space] as `o`, its first entry
  is "3*n^2*(I33 - I22)*o2*o3" for principal axes
torque torques couple moments_applied control thrusters: write `moment`, in body axes: numbers, or text in
  t and the state such as "0.1*sin(2*t) - k*w1"
force: a force does not turn a body; write its moment, in body axes, as `moment`, or a force that is
  constant in space as `weight`
current: a fluid is `model = "kirchhoff"`, there as `current`
mass_matrix added_mass fluid_added_mass fluid_density: a body in a fluid is `model = "kirchhoff"`, there
  as `mass_matrix`
wheels reaction_wheels: write `rotor`, the momentum of all wheels: numbers, or text in t and the scene's own
  states, such as "h1" with `h = { start = [0, 0, 0], rate = [..] }` in [states]
angular_damping linear_damping damping_coefficient: write `damping`, the rate at which the momentum decays
drag friction viscosity: write it in `moment`, as in "-0.1*w1" or "-0.1*abs(w1)*w1"
omega angular_velocity attitude quaternion: it stands in [initial]
"""
_KIRCHHOFF_BODY: Final = """\
m fluid_added_mass inertia_tensor inertia_matrix m_a m_rb ixx iyy izz ixy ixz iyz added_inertia
  center_of_mass com cog: write `mass`, `inertia`, `centre_of_mass` and `added_mass`, or `mass_matrix`, the
  6x6 matrix of (x, y) = M (U, Omega), which is the rigid body's inertia plus the added mass
inertia centre_of_mass added_mass: write `mass` beside it, or all of them as one `mass_matrix`
semi_axes density fluid_density rho: write `ellipsoid = { semi_axes = [..], density = .., fluid_density =
  .. }`, or `mass_matrix`
gravity g centre_of_buoyancy cob volume: write `weight = { force = [0, 0, 299], at = [0, 0, 0.02] }` and
  `buoyancy` likewise: forces in space axes at a point of the body
drag lift friction viscosity linear_drag quadratic_drag: write it in `force` and `couple`, as in
  "-20*u1 - 130*abs(u1)*u1"
flow current_velocity: write `current`, the velocity of the fluid, in space axes
circulation: not modelled as such: write its force and couple as text in `force` and `couple`
angular_damping linear_damping damping_coefficient: write `damping`, the rate at which both impulses decay
rotor wheels reaction_wheels: not modelled: wheels turn in a body of the model euler
torque torques moment: write `couple`, in body axes: numbers, or text in t and the state
thrust forces wrench propeller thrusters: write `force` and `couple`, in body axes: numbers, or text in t
  and the state such as "9*exp(-t/5)"
linear_velocity angular_velocity linear_impulse angular_impulse attitude: it stands in [initial]
"""
_INITIAL: Final = """\
quaternion orientation q quat pose: write `attitude = [q0, q1, q2, q3]`, scalar first, body to space
rpy euler_angles roll pitch yaw ypr attitude_deg: write `euler = { sequence = "zyx", degrees = [yaw, pitch,
  roll] }`: turns about axes that move along
rotation rotvec rotation_matrix: write `rotation_vector`, the axis times the angle in radians, or `attitude`
rodrigues: write `mrp`, the axis times the tangent of a quarter of the angle
t t0 time: the time of the initial state is `start` in [time]
"""
_EULER_INITIAL: Final = (
    _INITIAL
    + """\
p r w rates angular_velocity angular_rate spin: write `omega`, in body axes: radians per unit of time, or
  text such as "2 deg/s"
angular_momentum: write `omega`: the angular momentum is I omega
velocity linear_velocity position centre center linear_impulse linear_momentum: not modelled: euler is the
  rotation alone, about the centre of mass or about a fixed point
"""
)
_KIRCHHOFF_INITIAL: Final = (
    _INITIAL
    + """\
velocity u v w twist speed nu: write `linear_velocity`, of the origin in body axes, together with
  `angular_velocity`
omega rates p r angular_rate: write `angular_velocity`, in body axes, together with `linear_velocity`
position center x0 origin location: write `centre`, the body's origin in space
impulse momentum momenta linear_momentum angular_momentum: write `linear_impulse` and `angular_impulse`,
  or the two velocities
"""
)


_HELD: Final = """\
period dt sample_time ts sampling: write `every`, the time from one instant to the next
rate: a state has a `rate`, or a `value` that is taken `every` so often
frequency hz: write `every`, one over the frequency
delay latency: write `offset`, or hold the value once more: another state with the same `every` and `offset`
"""
_CONTINUOUS: Final = """\
initial x0: write `start`
derivative dot equation: write `rate`
offset period dt sample_time: a state that is taken at instants has `every` and `value`
"""


def _by_key(text: str) -> Mapping[str, str]:
    rows = (line.split(": ", 1) for line in text.replace("\n  ", " ").splitlines())
    return {key: sentence for keys, sentence in rows for key in keys.split()}


# The top level and [time] have the same keys in every model.
_HINTS: Final[Mapping[tuple[str, str], Mapping[str, str]]] = {
    ("", ""): _by_key(_TOP),
    ("", "time"): _by_key(_TIME),
    ("euler", "body"): _by_key(_EULER_BODY),
    ("kirchhoff", "body"): _by_key(_KIRCHHOFF_BODY),
    ("euler", "initial"): _by_key(_EULER_INITIAL),
    ("kirchhoff", "initial"): _by_key(_KIRCHHOFF_INITIAL),
    ("", "held"): _by_key(_HELD),
    ("", "continuous"): _by_key(_CONTINUOUS),
}


def hints(part: str, model: str = "") -> Mapping[str, str]:
    """Return the sentences for one table of a scene (``""`` is its top) by key in small letters."""
    return _HINTS.get((model, part)) or _HINTS.get(("", part)) or MappingProxyType({})
