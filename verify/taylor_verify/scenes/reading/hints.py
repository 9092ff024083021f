"""Keys that people try and no scene has: what to write instead, or why it is not modelled.

There is one text for each model and table. A line of it has keys in small letters, a colon, and the
sentence that is printed in brackets after the fault of each of these keys.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from decimal import Decimal
from types import MappingProxyType
from typing import Any, Final

from taylor_verify.records.faults import shown

_TOP: Final = """\
gravity fluid environment forces water: loads stand in [body]: `weight`, `buoyancy`, `current`, and
  `moment`, or `force` and `couple`, whose entries may be text such as "-0.1*abs(w1)*w1"
drag damping_matrix aerodynamics: write it in [body], in `moment = ["-0.1*abs(w1)*w1", 0, 0]`, or in
  `force = ["-20*u1 - 130*abs(u1)*u1", 0, 0]` and `couple` of model kirchhoff
wind atmosphere air: write `current = [0.3, 0, 0]` in [body] of model kirchhoff, and the moment or
  force of the air on the body as text in `moment`, or in `force` and `couple`
gravity_gradient: write it in [body]: `moment = ["3*n^2*(I33 - I22)*o2*o3", "3*n^2*(I11 -
  I33)*o3*o1", "3*n^2*(I22 - I11)*o1*o2"]` for principal axes, with n in [define] and the direction
  to the centre in [space] as `o = ["cos(n*t)", "sin(n*t)", 0]`
magnetic magnetic_field magnetic_dipole magnetorquer: write it in [body]: `moment = ["m2*b3 -
  m3*b2", "m3*b1 - m1*b3", "m1*b2 - m2*b1"]`, with the dipole m1, m2, m3 in [define] and the field
  in [space] as `b = [0, 0, 2e-5]`
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
dt step timestep time_step duration stop t_end tf n rate: write `end`, and `samples`, both ends
  included; the steps between are the solver's own
times instants t: write `at`, an array of instants
"""
_EULER_BODY: Final = """\
ixx iyy izz ixy ixz iyz i inertia_tensor moments principal_moments moments_of_inertia moment_of_inertia:
  write `inertia`: three principal moments, or the tensor [[Ixx, Ixy, Ixz], [Ixy, Iyy, Iyz], [Ixz, Iyz,
  Izz]] with Ixy = -int xy dm
mass m density volume: leave it out: the mass does not enter the rotation, and `inertia` holds what
  does; a force is written as `weight`
com cog centre_of_mass center_of_mass: leave it out: `inertia` is about the centre of mass, or about a
  point held fixed
gravity g: write `weight = { force = [0, 0, -9.81], at = [0, 0, 0.1] }`, a force in space axes at a
  point of the body, for a body whose origin is held; gravity has no moment about the centre of mass
gravity_gradient: write `moment = ["3*n^2*(I33 - I22)*o2*o3", "3*n^2*(I11 - I33)*o3*o1", "3*n^2*(I22
  - I11)*o1*o2"]` for principal axes, with n in [define] and the direction to the centre in [space]
  as `o = ["cos(n*t)", "sin(n*t)", 0]`
magnetic magnetic_field magnetic_dipole dipole magnetorquer: write `moment = ["m2*b3 - m3*b2",
  "m3*b1 - m1*b3", "m1*b2 - m2*b1"]`, with the dipole m1, m2, m3 in [define] and the field in
  [space] as `b = [0, 0, 2e-5]`
wind: write its moment as text in `moment`; a body in a fluid is `model = "kirchhoff"`, there as
  `current`
w b cg cb: write `weight = { force = [0, 0, -9.81], at = [0, 0, 0.1] }` for a body whose origin is
  held, and `buoyancy` likewise; neither has a moment about the centre of mass and of buoyancy
torque torques couple moments_applied control thrusters: write `moment`, in body axes: numbers, or
  text in t and the state such as "0.1*sin(2*t) - k*w1"
force: a force does not turn a body; write its moment, in body axes, as `moment`, or a force that is
  constant in space as `weight`
current: a fluid is `model = "kirchhoff"`, there as `current`
mass_matrix added_mass fluid_added_mass fluid_density: a body in a fluid is `model = "kirchhoff"`, there
  as `mass_matrix`
wheels reaction_wheels rw wheel_momentum wheels_momentum momentum_wheel rw_momentum rw_h h_rw h_w
  h_wheel h_wheels hw h rw_speed rw_speeds wheel_speed wheel_speeds: write `rotor`, the momentum of
  all wheels: numbers, or text in t and the scene's own states, such as "h1" with `h = { start = [0,
  0, 0], rate = [..] }` in [states]
angular_damping linear_damping damping_coefficient: write `damping`, the rate at which the momentum
  decays
drag friction viscosity: write `moment = ["-0.1*abs(w1)*w1", 0, 0]`, with "-0.1*w1" where it is linear
omega angular_velocity attitude quaternion: it stands in [initial]
"""
_KIRCHHOFF_BODY: Final = """\
m fluid_added_mass inertia_tensor inertia_matrix m_a m_rb ixx iyy izz ixy ixz iyz added_inertia
  center_of_mass com cog: write `mass`, `inertia`, `centre_of_mass` and `added_mass`, or
  `mass_matrix`, the 6x6 matrix of (x, y) = M (U, Omega), which is the rigid body's inertia plus the
  added mass
inertia centre_of_mass added_mass: write `mass` beside it, or all of them as one `mass_matrix`
semi_axes density fluid_density rho: write `ellipsoid = { semi_axes = [..], density = ..,
  fluid_density = .. }`, or `mass_matrix`
gravity g w b cg cb r_g r_b rg rb xg yg zg xb yb zb center_of_gravity centre_of_gravity
  center_of_buoyancy centre_of_buoyancy cob volume: write `weight = { force = [0, 0, 299], at = [0,
  0, 0.02] }` and `buoyancy = { force = [0, 0, -306], at = [0, 0, 0] }`: W and B as forces in space
  axes (here z points down), at cg and at cb in body axes
gravity_gradient: it has no part in water; a force or a couple is text in `force` and `couple`
magnetic magnetic_field magnetic_dipole dipole: write `couple = ["m2*b3 - m3*b2", "m3*b1 - m1*b3",
  "m1*b2 - m2*b1"]`, with m1, m2, m3 in [define] and the field in [space] as `b = [0, 0, 2e-5]`
drag lift friction viscosity linear_drag quadratic_drag: write `force = ["-20*u1 - 130*abs(u1)*u1",
  0, 0]`, and `couple` likewise
flow wind current_velocity: write `current = [0.3, 0, 0]`, the velocity of the fluid, in space axes
circulation: not modelled as such: write its force and couple as text in `force` and `couple`
angular_damping linear_damping damping_coefficient: write `damping`, the rate at which both impulses
  decay
rotor wheels reaction_wheels: not modelled: wheels turn in a body of the model euler
torque torques moment: write `couple`, in body axes: numbers, or text in t and the state
thrust forces wrench propeller thrusters: write `force` and `couple`, in body axes: numbers, or text
  in t and the state such as "9*exp(-t/5)"
linear_velocity angular_velocity linear_impulse angular_impulse attitude: it stands in [initial]
omega: write `angular_velocity` in [initial], together with `linear_velocity`
"""
_INITIAL: Final = """\
quaternion orientation q quat pose quaternion_xyzw quat_xyzw xyzw: write `attitude = [q0, q1, q2,
  q3]`, scalar first, body to space
rpy euler_angles roll pitch yaw ypr attitude_deg: write `euler = { sequence = "zyx", degrees = [yaw,
  pitch, roll] }`: turns about axes that move along
rotation rotvec rotation_matrix: write `rotation_vector`, the axis times the angle in radians, or
  `attitude`
rodrigues: write `mrp`, the axis times the tangent of a quarter of the angle
t t0 time: the time of the initial state is `start` in [time]
"""
_EULER_INITIAL: Final = (
    _INITIAL
    + """\
rw rw_speed rw_speeds wheel_speed wheel_speeds wheel_momentum rw_momentum h_rw h_w hw: write `rotor` in
  [body], the momentum of all wheels in body axes: their inertia times their speed relative to the body
p r w rates angular_velocity angular_rate spin: write `omega`, in body axes: radians per unit of
  time, or text such as "2 deg/s"
angular_momentum: write `omega`: the angular momentum is I omega
velocity linear_velocity position centre center linear_impulse linear_momentum: not modelled: euler
  is the rotation alone, about the centre of mass or about a fixed point
"""
)
_KIRCHHOFF_INITIAL: Final = (
    _INITIAL
    + """\
velocity u v w twist speed nu: write `linear_velocity`, of the origin in body axes, together with
  `angular_velocity`
omega rates p r angular_rate: write `angular_velocity`, in body axes, together with `linear_velocity`
eta: write `centre = [x, y, z]` and `euler = { sequence = "zyx", radians = [psi, theta, phi] }`: eta is
  x y z phi theta psi
position center x0 origin location: write `centre`, the body's origin in space
impulse momentum momenta linear_momentum angular_momentum: write `linear_impulse` and `angular_impulse`,
  or the two velocities
"""
)


_HELD: Final = """\
period dt sample_time ts sampling: write `every`, the time from one instant to the next
rate: a state has a `rate`, or a `value` that is taken `every` so often
frequency hz: write `every`, one over the frequency
delay latency: write `offset`, or hold the value once more: another state with the same `every` and
  `offset`
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


def _words(text: str) -> frozenset[str]:
    return frozenset(text.split())


_PLACES: Final[Mapping[str, frozenset[str]]] = {
    "at the top": _words("title model source track define space tables states"),
    "[body]": _words(
        "inertia moment weight buoyancy rotor damping clebsch energy ellipsoid mass_matrix mass "
        "centre_of_mass added_mass force couple current"
    ),
    "[initial]": _words(
        "omega linear_impulse angular_impulse linear_velocity angular_velocity attitude euler mrp "
        "rotation_vector axis_angle centre"
    ),
    "[time]": _words("start end samples at"),
}


def advice(part: str, model: str = "") -> Callable[[str, object], str]:
    """Return the function that says for a key and its value what to write instead, or nothing."""
    sentences = hints(part, model)

    def advise(key: str, value: object) -> str:
        if sentence := sentences.get(key.lower()):
            return sentence + _lines(key.lower(), value, sentence) * (part == "initial")
        here = f"[{part}]" if part else "at the top"
        places = [place for place, keys in _PLACES.items() if key in keys and place != here]
        if places:
            return f"write `{key}` {'in ' * places[0].startswith('[')}{places[0]}"
        others = ((other, hints(other, model).get(key.lower())) for other in ("body", "initial"))
        written = (f"in [{other}] {words}" for other, words in others if words)
        return next((sentence for sentence in written if "] write" in sentence), "")

    return advise


def _lines(key: str, value: object, sentence: str) -> str:
    """Return the lines with the numbers of a start in other people's order; empty for any other."""
    numbers = value if isinstance(value, list) else []
    if not all(isinstance(n, int | Decimal) for n in numbers):
        return ""
    if len(numbers) == 6 and key == "eta":
        place, angles = _array(numbers[:3]), _array(numbers[:2:-1])
        return f': `centre = {place}`, `euler = {{ sequence = "zyx", radians = {angles} }}`'
    if len(numbers) == 6 and key == "nu":
        lines = _array(numbers[:3]), _array(numbers[3:])
        return ": `linear_velocity = {}`, `angular_velocity = {}`".format(*lines)
    # The largest of four numbers is the scalar as a rule.
    is_attitude = "attitude" in sentence and len(numbers) == 4
    if not is_attitude or abs(numbers[3]) <= max(map(abs, numbers[:3])):
        return ""
    last = _array([numbers[3], *numbers[:3]])
    return f"; where the scalar stands last in your file, it stands first here: `attitude = {last}`"


def _array(numbers: list[Any]) -> str:
    return f"[{', '.join(map(shown, numbers))}]"
