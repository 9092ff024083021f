"""Scenes from URDF, SDF and MJCF: the inertia is that of the same point masses, summed by hand."""

from __future__ import annotations

import json
import os
import time
from collections.abc import Iterable
from dataclasses import replace
from decimal import Decimal
from fractions import Fraction
from pathlib import Path

import pytest
from builders.scenes import vector
from mpmath import mp

from taylor_verify.cli import main
from taylor_verify.numbers import tensors
from taylor_verify.numbers.tensors import Matrix, Vector
from taylor_verify.records.faults import Refused
from taylor_verify.records.markup import DEEPEST
from taylor_verify.run import run
from taylor_verify.scenes.bodies import ImmersedBody, RigidBody
from taylor_verify.scenes.imported import import_scene
from taylor_verify.scenes.imported.tree import MOST_BYTES, MOST_ELEMENTS
from taylor_verify.scenes.motion import Clock
from taylor_verify.scenes.reading.reader import read
from taylor_verify.scenes.scene import Scene

# Seconds of the processor that a file of ten megabytes may take.
PATIENCE = 20.0

Captured = pytest.CaptureFixture[str]


# A rigid link of point masses: mass and place about the origin of the link, in its axes.
POINTS = [
    (Fraction(1), vector("0.5", "0.1", "-0.2")),
    (Fraction(2), vector("-0.3", "0.4", "0.1")),
    (Fraction(1), vector("0.2", "-0.6", "0.7")),
    (Fraction(4), vector("0.1", "0.2", "0.3")),
]
MASS = sum((m for m, _ in POINTS), Fraction(0))
CENTRE = tuple(sum((m * r[i] for m, r in POINTS), Fraction(0)) / MASS for i in range(3))


def tensor_of_points(axes: Matrix) -> Matrix:
    """Sum m (r.r 1 - r r) about the centre of mass, with r in the axes that are the rows given."""
    places = [
        (m, tensors.apply(axes, tensors.plus(r, tensors.scaled(Fraction(-1), CENTRE))))
        for m, r in POINTS
    ]
    return tuple(
        tuple(
            sum((m * ((i == k) * tensors.dot(r, r) - r[i] * r[k]) for m, r in places), Fraction(0))
            for k in range(3)
        )
        for i in range(3)
    )


def energy_of_points(velocity: Vector, turning: Vector) -> Fraction:
    """Sum m (U + Omega x r)^2 / 2."""
    speeds = [(m, tensors.plus(velocity, tensors.cross(turning, r))) for m, r in POINTS]
    return sum((m * tensors.dot(v, v) for m, v in speeds), Fraction(0)) / 2


LINK_AXES = tensors.diagonal(vector(1, 1, 1))
# The inertial frame of these files is turned by a quarter turn about x, then one about z (fixed axes).
QUARTERS: Matrix = (vector(0, 0, 1), vector(1, 0, 0), vector(0, 1, 0))
I = tensor_of_points(LINK_AXES)
TURNED = tensor_of_points(tensors.transpose(QUARTERS))


def text(numbers: Iterable[Fraction]) -> str:
    """Exact decimals: every number here has less than 28 digits."""
    return " ".join(format(Decimal(n.numerator) / Decimal(n.denominator), "f") for n in numbers)


def six(tensor: Matrix) -> dict[str, str]:
    names = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
    places = ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2))
    return {name: text([tensor[i][k]]) for name, (i, k) in zip(names, places, strict=True)}


def urdf(tensor: Matrix = I, rpy: str = "0 0 0", name: str = "base_link") -> str:
    attributes = " ".join(f'{key}="{value}"' for key, value in six(tensor).items())
    return f"""<?xml version="1.0" encoding="utf-8"?>
<!-- This URDF was automatically created by SolidWorks to URDF Exporter! -->
<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <material name="grey"><color rgba="0.5 0.5 0.5 1"/></material>
  <link name="base_footprint"/>
  <link
    name="{name}">
    <inertial>
      <origin
        xyz="{text(CENTRE)}"
        rpy="{rpy}" />
      <mass
        value="{text([MASS])}" />
      <inertia {attributes} />
    </inertial>
    <visual><geometry><mesh filename="package://arm/meshes/base.STL"/></geometry></visual>
  </link>
  <joint name="j" type="fixed"><parent link="base_footprint"/><child link="{name}"/></joint>
</robot>
"""


ADDED = {
    "xx": "4.876161",
    "yy": "126.324739",
    "zz": "126.324739",
    "qq": "33.46",
    "rr": "33.46",
    "pp": "0.0704",
    "yr": "1.93",
    "zq": "-1.93",
    "xp": "0.25",
}


def sdf(
    tensor: Matrix = I, pose: str = "0 0 0", added: dict[str, str] | None = None, more: str = ""
) -> str:
    parts = "".join(f"<{key}>{value}</{key}>" for key, value in six(tensor).items())
    fluid = "".join(f"\n          <{key}>{value}</{key}>" for key, value in (added or {}).items())
    fluid = f"<fluid_added_mass>{fluid}</fluid_added_mass>" if added is not None else ""
    return f"""<?xml version="1.0" ?>
<sdf version="1.10">
  <model name="auv">
    <link name="hull">
      <inertial>
        <mass>{text([MASS])}</mass>
        <pose{more}>{text(CENTRE)} {pose}</pose>
        <inertia>{parts}</inertia>
        {fluid}
      </inertial>
    </link>
    <plugin filename="gz-sim-hydrodynamics-system" name="gz::sim::systems::Hydrodynamics"/>
  </model>
</sdf>
"""


def mjcf(inertial: str, compiler: str = "") -> str:
    return f"""<mujoco model="hand">
  <compiler {compiler}/>
  <default><geom contype="0"/></default>
  <worldbody>
    <light pos="0 0 1"/>
    <body name="palm" pos="0 0 1" quat="1 0 0 1">
      <inertial mass="{text([MASS])}" pos="{text(CENTRE)}" {inertial}/>
      <geom type="mesh" mesh="palm"/>
      <body><geom size="0.1"/></body>
    </body>
  </worldbody>
</mujoco>
"""


def full(tensor: Matrix) -> str:
    places = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))
    return f'fullinertia="{text(tensor[i][k] for i, k in places)}"'


def imported(
    tmp_path: Path, content: str, name: str = "vehicle.xml", link: str | None = None
) -> Scene:
    file = tmp_path / name
    file.write_text(content, encoding="utf-8")
    return read(import_scene(file, link).text, "imported")


def refusal(tmp_path: Path, content: str | bytes, link: str | None = None) -> Refused:
    file = tmp_path / "robot.xml"
    file.write_bytes(content if isinstance(content, bytes) else content.encode())
    with pytest.raises(Refused) as refused:
        import_scene(file, link)
    return refused.value


def inertia(scene: Scene) -> Matrix:
    assert isinstance(scene.body, RigidBody)
    return scene.body.inertia


# The inertia


EXACT = {
    "urdf": urdf(),
    "sdf": sdf(),
    "sdf, turned by degrees": sdf(TURNED, "90 0 90", more=' degrees="true"'),
    "sdf, turned by a quaternion": sdf(
        TURNED, "0.5 0.5 0.5 0.5", more=' rotation_format="quat_xyzw"'
    ),
    "mjcf, full": mjcf(full(I)),
}


@pytest.mark.parametrize("content", EXACT.values(), ids=EXACT)
def test_the_tensor_is_that_of_the_points_exactly(content: str, tmp_path: Path) -> None:
    """About the centre of mass, in the axes of the link, products as -sum m x y."""
    assert inertia(imported(tmp_path, content)) == I


MJCF_TURNS = {
    "quat": ('quat="2 2 2 2"', ""),
    "euler about moving axes": ('euler="90 90 0"', ""),
    "euler in another order": ('euler="0 90 90"', 'eulerseq="xzx" angle="degree"'),
    "euler about fixed axes": ('euler="90 0 90"', 'eulerseq="XYZ"'),
    "axis and angle": ('axisangle="1 1 1 120"', ""),
}


@pytest.mark.parametrize(("turn", "compiler"), MJCF_TURNS.values(), ids=MJCF_TURNS)
def test_principal_moments_are_turned_into_the_axes_of_the_body(
    turn: str, compiler: str, tmp_path: Path
) -> None:
    """Each is the turn that leads axis 1 to 2, 2 to 3 and 3 to 1, in degrees where nothing is said."""
    content = mjcf(f'diaginertia="1 2 2.5" {turn}', compiler)
    assert inertia(imported(tmp_path, content)) == tensors.diagonal(vector("2.5", 1, 2))


def test_a_turn_by_angles_in_radians_is_exact_to_the_digits_stated(tmp_path: Path) -> None:
    """The tensor of a URDF with rpy is Rz Ry Rx I (Rz Ry Rx)^T to 19 digits, its invariants exactly."""
    scene = imported(tmp_path, urdf(I, "0.3 -1.1 2.5"))
    turned = inertia(scene)
    with mp.workdps(40):
        R = product_of_turns((("z", "2.5"), ("y", "-1.1"), ("x", "0.3")))
        tensor = mp.matrix([[mp.convert(entry) for entry in row] for row in I])
        expected = R * tensor * R.T
        largest = max(abs(entry) for entry in expected)
        for i in range(3):
            for k in range(3):
                assert abs(mp.convert(turned[i][k]) - expected[i, k]) <= mp.mpf("1e-19") * largest
    assert trace(turned) == trace(I)
    assert trace(tensors.product(turned, turned)) == trace(tensors.product(I, I))


def product_of_turns(turns: Iterable[tuple[str, str]]) -> mp.matrix:
    """Matrices of turns about body axes, written out, one behind the other."""
    total = mp.eye(3)
    for axis, angle in turns:
        c, s = mp.cos(mp.mpf(angle)), mp.sin(mp.mpf(angle))
        total *= mp.matrix(
            {
                "x": [[1, 0, 0], [0, c, -s], [0, s, c]],
                "y": [[c, 0, s], [0, 1, 0], [-s, 0, c]],
                "z": [[c, -s, 0], [s, c, 0], [0, 0, 1]],
            }[axis]
        )
    return total


def trace(matrix: Matrix) -> Fraction:
    return sum((matrix[i][i] for i in range(3)), Fraction(0))


@pytest.mark.parametrize("sequence", ["xyz", "zyx", "zxz", "XYZ", "ZXZ"])
def test_the_order_of_euler_angles_is_that_of_the_letters(sequence: str, tmp_path: Path) -> None:
    """Small letters multiply from the left to the right, capitals from the right to the left."""
    angles = ("0.3", "-1.1", "2.5")
    words = f'diaginertia="1 2 2.5" euler="{" ".join(angles)}"'
    tensor = inertia(imported(tmp_path, mjcf(words, f'angle="radian" eulerseq="{sequence}"')))
    turns = list(zip(sequence.lower(), angles, strict=True))
    with mp.workdps(40):
        R = product_of_turns(turns if sequence.islower() else turns[::-1])
        expected = R * mp.diag([1, 2, mp.mpf("2.5")]) * R.T
        for i in range(3):
            for k in range(3):
                assert abs(mp.convert(tensor[i][k]) - expected[i, k]) <= mp.mpf("1e-18")


# The vehicle


@pytest.mark.parametrize("turned", [False, True])
def test_a_vehicle_has_the_energy_of_its_points_and_of_its_fluid(
    turned: bool, tmp_path: Path
) -> None:
    """v.M v/2 is sum m (U + Omega x r)^2/2 of the points plus v.A v/2, about the origin of the link."""
    content = sdf(TURNED, "90 0 90", ADDED, ' degrees="true"') if turned else sdf(added=ADDED)
    scene = imported(tmp_path, content)
    assert isinstance(scene.body, ImmersedBody)
    matrix = scene.body.mass_matrix
    for velocity, turning in (
        (vector(1, 2, 3), vector(0, 0, 0)),
        (vector(0, 0, 0), vector("0.3", "-0.2", "0.7")),
        (vector(1, "-0.5", "0.25"), vector("0.3", "-0.2", "0.7")),
    ):
        v = dict(zip("xyzpqr", velocity + turning, strict=True))
        # The added mass a_ij counts twice off the diagonal, for both of its places.
        fluid = sum(
            Fraction(value) * v[key[0]] * v[key[1]] * (2 if key[0] != key[1] else 1)
            for key, value in ADDED.items()
        )
        both = velocity + turning
        twice = tensors.dot(both, tensors.apply(matrix, both))
        assert twice == 2 * energy_of_points(velocity, turning) + fluid


def test_a_vehicle_is_written_as_a_mass_matrix_and_velocities(tmp_path: Path) -> None:
    """The scene has the numbers a marine engineer knows, and what was left out stands in a comment."""
    (tmp_path / "auv.sdf").write_text(sdf(added=ADDED))
    written = import_scene(tmp_path / "auv.sdf")
    assert (written.link, written.form) == ("auv::hull", "SDF")
    assert "mass_matrix = [" in written.text
    assert "linear_velocity = " in written.text
    assert "Left out: drag" in written.text
    assert f"the mass m = {text([MASS])}" in " ".join(written.text.replace("#", "").split())


# The text


def test_what_is_written_says_what_is_a_placeholder(tmp_path: Path) -> None:
    """Start and times are said to be none of the file; the source of the body is named, not its folder."""
    (tmp_path / "arm.urdf").write_text(urdf())
    text = import_scene(tmp_path / "arm.urdf").text
    assert text.count("# A placeholder") == 2
    assert "out of arm.urdf (URDF), link base_link" in text
    assert str(tmp_path) not in text
    assert all(len(line) <= 100 for line in text.splitlines())


def test_angles_are_remarked_upon(tmp_path: Path) -> None:
    """The scene says that angles were rounded, to how many digits, and that 1.5708 is no quarter turn."""
    (tmp_path / "arm.urdf").write_text(urdf(I, "1.5708 0 0.3"))
    text = " ".join(import_scene(tmp_path / "arm.urdf").text.replace("#", "").split())
    assert "rpy = (1.5708, 0.0, 0.3) radians" in text
    assert "rounded to 20 decimals" in text
    assert "The angle 1.5708 is taken as written, and is near a quarter turn but none." in text
    assert "0.3 is taken" not in text


def test_a_name_cannot_write_into_the_scene(tmp_path: Path) -> None:
    """Line breaks, quotes and control characters of a link's name stay in its comment and title."""
    name = "a&#10;model = &quot;kirchhoff&quot;&#10;# \\u0041 \N{RIGHT-TO-LEFT OVERRIDE}"
    scene = imported(tmp_path, urdf(name=name))
    assert scene.model == "euler"
    assert inertia(scene) == I
    assert "\n" not in scene.title


@pytest.mark.parametrize("content", [urdf(I, "0.3 -1.1 2.5"), sdf(added=ADDED)])
def test_a_written_scene_runs_and_passes(content: str, tmp_path: Path) -> None:
    """The placeholder start is one that a good integrator passes."""
    scene = imported(tmp_path, content)
    clock = Clock(scene.clock.start, tuple(scene.clock.instants[:3]))
    assert run(replace(scene, clock=clock), "taylor", "f64").passed


# Refusals


UNIT = '<mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>'
SEVERAL = f"""<robot name="r">
  <link name="a"><inertial>{UNIT}</inertial></link>
  <link name="b"><inertial>{UNIT}</inertial></link>
  <link name="world"/>
</robot>"""


REFUSED = {
    "an external entity": (
        '<!DOCTYPE r [<!ENTITY e SYSTEM "file:///etc/passwd">]><robot>&e;</robot>',
        "document type",
    ),
    "an entity of nobody": ("<robot>&e;</robot>", "undefined entity"),
    "no XML": ("solid arm", "a fault in it: syntax error: line 1"),
    "nothing": ("", "no element found"),
    "half a file": (urdf()[:300], "a fault in it"),
    "an unknown encoding": ('<?xml version="1.0" encoding="nope"?><robot/>', "a fault in it"),
    "another root": ("<html/>", "got <html>"),
    "a part of MJCF": ("<mujocoinclude/>", "name the file that includes it"),
    "xacro": (
        '<robot xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:include filename="a"/></robot>',
        "xacro has yet to expand",
    ),
    "no link": ('<robot name="r"/>', "expected a link with <inertial>, got none"),
    "a parameter": (
        urdf().replace('rpy="0 0 0"', 'rpy="${pi/2} 0 0"'),
        "xacro has yet to expand it",
    ),
    "no mass": (urdf().replace("<mass", "<moss"), "expected <mass>, got nothing"),
    "a massless link": (
        urdf().replace(f'value="{text([MASS])}"', 'value="0"'),
        "a positive mass, got 0",
    ),
    "two numbers": (urdf().replace('rpy="0 0 0"', 'rpy="0 0"'), '3 numbers for rpy, got "0 0"'),
    "no number": (urdf().replace('rpy="0 0 0"', 'rpy="0 0 nan"'), 'for rpy, got "nan"'),
    "a huge number": (urdf().replace('rpy="0 0 0"', 'rpy="0 0 1e999"'), "of usual size"),
    "a long number": (urdf().replace('rpy="0 0 0"', f'rpy="0 0 1.{"0" * 99}"'), "of usual size"),
    "a tensor of no body": (urdf(tensors.diagonal(vector(-1, 1, 1))), "positive definite tensor"),
    "geometry instead": (
        sdf().replace("<inertial>", '<inertial auto="true">'),
        "geometry is not read",
    ),
    "a pose in a frame": (sdf(more=' relative_to="nose"'), "frames are not resolved"),
    "an unknown added mass": (sdf(added={"ww": "1"}), "<ww>"),
    "naval derivatives": (sdf(added={"xx": "-100"}), "minus a naval derivative"),
    "inertia of geoms": (mjcf(full(I), 'inertiafromgeom="true"'), "which changes it"),
    "scaled inertia": (mjcf(full(I), 'settotalmass="3"'), "which changes it"),
    "both inertias": (mjcf(full(I) + ' diaginertia="1 1 1"'), "got both"),
    "an orientation beside it": (mjcf(full(I) + ' quat="1 0 0 0"'), "no orientation beside"),
    "an axis": (mjcf('diaginertia="1 1 1" zaxis="0 0 1"'), "write the same orientation as quat"),
    "a quaternion of zero": (mjcf('diaginertia="1 1 1" quat="0 0 0 0"'), "not zero"),
    "an unknown order": (mjcf('diaginertia="1 1 1" euler="0 0 1"', 'eulerseq="xyw"'), "eulerseq"),
}


@pytest.mark.parametrize(("content", "fragment"), REFUSED.values(), ids=REFUSED)
def test_what_cannot_be_imported_is_refused(content: str, fragment: str, tmp_path: Path) -> None:
    """Each fault is a line with what was expected, what was there, and the file."""
    refused = refusal(tmp_path, content)
    assert fragment in str(refused)
    for line in refused.faults:
        assert line.startswith("expected ")
        assert ", got " in line
        assert "robot.xml" in line


def test_all_faults_of_a_link_are_told_at_once_with_their_lines(tmp_path: Path) -> None:
    """A bad mass, bad angles and a bad product are three lines, each with its line of the file."""
    content = urdf().replace(f'value="{text([MASS])}"', 'value="-1"')
    content = content.replace('rpy="0 0 0"', 'rpy="0 0"').replace('ixy="', 'ixy="x')
    places = [line.split(" @ ")[1].split()[0] for line in refusal(tmp_path, content).faults]
    assert len(places) == 3
    lines = content.splitlines()
    for place, element in zip(places, ("<mass", "<inertia ", "<origin"), strict=True):
        assert element in lines[int(place.split(":")[1]) - 1]


def test_a_deep_and_a_large_file_are_refused(tmp_path: Path) -> None:
    """Depth, size and the number of elements have limits, with their reasons."""
    many = "<robot>" + "<a/>" * MOST_ELEMENTS.most + "</robot>"
    assert "a robot of a thousand links" in str(refusal(tmp_path, many))
    deep = "<robot>" + "<a>" * DEEPEST.most + "</a>" * DEEPEST.most + "</robot>"
    assert "the longest chain of bodies" in str(refusal(tmp_path, deep))
    large = tmp_path / "large.urdf"
    large.touch()
    os.truncate(large, MOST_BYTES.most + 1)
    with pytest.raises(Refused, match="at most 16777216 bytes"):
        import_scene(large)


def test_text_between_many_elements_is_read_once(tmp_path: Path) -> None:
    """Ten megabytes of text with a hundred thousand elements in it take seconds, not hours."""
    content = f"<robot>{'x' * 10**7}{'<a/>y' * 10**5}</robot>"
    start = time.process_time()
    assert "expected a link" in str(refusal(tmp_path, content))
    assert time.process_time() - start < PATIENCE


# Plugins: what acts on a link beside its inertia


def plugged(link: str = "", model: str = "", world: str = "") -> str:
    """An SDF with a hull whose axes are turned and moved in the model, and a propeller behind it."""
    return f"""<sdf version="1.9"><world name="w">{world}<model name="auv">
  <link name="hull"><pose>0 0 1 0 0 0</pose><inertial><mass>4</mass><pose>0 0 -0.5 0 0 0</pose>
    <inertia><ixx>1</ixx><iyy>2</iyy><izz>2.5</izz></inertia>{link}</inertial>
    <collision name="c"><pose>0 0 0.25 0 0 0</pose>
      <geometry><box><size>1 0.5 0.25</size></box></geometry></collision></link>
  <link name="prop"><pose degrees="false">-1 0.5 1 0 0 0</pose></link>
  <joint name="shaft" type="revolute"><parent>hull</parent><child>prop</child>
    <axis><xyz>0 0 2</xyz></axis></joint>{model}</model></world></sdf>"""


def hydrodynamics(content: str) -> str:
    name = 'name="gz::sim::systems::Hydrodynamics" filename="gz-sim-hydrodynamics-system"'
    return f"<plugin {name}><link_name>hull</link_name>{content}</plugin>"


def underwater(content: str, end: str = "<volume>0.004</volume>") -> str:
    return f"""<robot name="r"><link name="r/base"><inertial>{UNIT}</inertial></link><gazebo><plugin
name="u" filename="libuuv_underwater_object_ros_plugin.so"><fluid_density>1000</fluid_density>
<link name="r/base">{end}<center_of_buoyancy>0 0 0.1</center_of_buoyancy>
<hydrodynamic_model><type>fossen</type>{content}</hydrodynamic_model></link></plugin></gazebo></robot>"""


UUV_MASS = (
    "<added_mass>1 0 0 0 .5 0 "
    "0 2 0 .25 0 0 0 0 3 0 0 0 0 .25 0 1 0 0 .5 0 0 0 1 0 0 0 0 0 0 1</added_mass>"
)
BUOYANCY = (
    '<plugin name="gz::sim::systems::Buoyancy">'
    "<uniform_fluid_density>1000</uniform_fluid_density></plugin>"
)
# Gazebo's own plugin before gz-sim, which states the volume.
FLOATING = (
    '<plugin name="b" filename="libBuoyancyPlugin.so"><fluid_density>1000</fluid_density>'
    '<link name="hull"><center_of_volume>0 0 0.1</center_of_volume><volume>0.005</volume></link></plugin>'
)
THRUSTER = '<plugin name="gz::sim::systems::Thruster"><joint_name>shaft</joint_name></plugin>'
# What a file has, and the line of the scene that says it.
ACTING = {
    "added mass is minus a derivative": (
        plugged(model=hydrodynamics("<xDotU>-5</xDotU>")),
        "  [9, 0, 0, 0, -2, 0],",
    ),
    "drag along": (
        plugged(model=hydrodynamics("<xUabsU>-6.5</xUabsU><xU>2</xU><xVW>-1</xVW>")),
        'force = ["-6.5*abs(u1)*u1 + 2*u1 - u3*u2", "0", "0"]',
    ),
    "drag about": (
        plugged(model=hydrodynamics("<nRabsQ>-3</nRabsQ>")),
        'couple = ["0", "0", "-3*abs(w2)*w3"]',
    ),
    "a current": (
        plugged(model=hydrodynamics("<default_current>1 0 -2</default_current>")),
        "current = [1, 0, -2]",
    ),
    "a weight": (plugged(world=BUOYANCY), "weight = { force = [0, 0, -39.2], at = [0, 0, -0.5] }"),
    "a gravity of the world": (
        plugged(world=f"<gravity>0 0 -2</gravity>{BUOYANCY}"),
        "weight = { force = [0, 0, -8], at = [0, 0, -0.5] }",
    ),
    "a volume": (plugged(world=BUOYANCY), "buoyancy = { force = [0, 0, 1225], at = [0, 0, 0.25] }"),
    "a volume that is stated": (
        plugged(model=hydrodynamics("<xDotU>-5</xDotU>") + FLOATING),
        "buoyancy = { force = [0, 0, 49], at = [0, 0, 0.1] }",
    ),
    "a thruster": (plugged(model=THRUSTER), 'force = ["0", "0", "thrust1"]'),
    "its arm": (plugged(model=THRUSTER), 'couple = ["0.5*thrust1", "thrust1", "0"]'),
    "uuv, x with pitch": (underwater(UUV_MASS), "  [2, 0, 0, 0, -0.5, 0],"),
    "uuv, y with roll": (underwater(UUV_MASS), "  [0, 3, 0, -0.25, 0, 0],"),
    "uuv, damping": (
        underwater(
            "<linear_damping>-1 -2 0 0 0 0</linear_damping>"
            "<quadratic_damping>-3 0 0 0 0 0</quadratic_damping>"
        ),
        'force = ["-u1 - 3*abs(u1)*u1", "-2*u2", "0"]',
    ),
    "uuv, buoyancy": (
        underwater(UUV_MASS),
        "buoyancy = { force = [0, 0, 39.24], at = [0, 0, 0.1] }",
    ),
    "uuv, neutral": (
        underwater(UUV_MASS, "<neutrally_buoyant>1</neutrally_buoyant>"),
        "buoyancy = { force = [0, 0, 9.81], at = [0, 0, 0.1] }",
    ),
}


@pytest.mark.parametrize(("content", "line"), ACTING.values(), ids=ACTING)
def test_what_acts_on_a_link_stands_in_its_scene(content: str, line: str, tmp_path: Path) -> None:
    """Each number of a plugin has its sign and its place in a scene that is read without a fault."""
    (tmp_path / "auv.sdf").write_text(content)
    link = "hull" if "hull" in content else None
    written = import_scene(tmp_path / "auv.sdf", link)
    assert line in written.text.splitlines()
    assert read(written.text, "imported").model == "kirchhoff"
    assert not written.warnings


DRY = {
    "two added masses": (
        plugged(
            "<fluid_added_mass><xx>5</xx></fluid_added_mass>", hydrodynamics("<xDotU>-5</xDotU>")
        ),
        "counts it twice",
    ),
    "one that is switched off": (
        plugged(model=hydrodynamics("<xDotU>-5</xDotU><disable_added_mass>1</disable_added_mass>")),
        "the added mass is not in the scene",
    ),
    "one of another link": (
        plugged(model=hydrodynamics("<xDotU>-5</xDotU>").replace("hull", "prop")),
        "about another link than auv::hull",
    ),
    "one of another plugin": (
        plugged(model='<plugin name="vrx::SimpleHydrodynamics"><xDotU>5</xDotU></plugin>'),
        "vrx::SimpleHydrodynamics of line 8 acts on bodies and is left out (it has xDotU)",
    ),
    "a link that is slowed": (
        plugged().replace(
            "<inertial>", "<velocity_decay><linear>.1</linear></velocity_decay><inertial>"
        ),
        "<velocity_decay> of line 2 slows the link",
    ),
    "wind of the world": (
        plugged(world="<wind/>").replace("<inertial>", "<enable_wind>1</enable_wind><inertial>"),
        "<wind> acts on the link and is left out",
    ),
    "a factor of uuv": (
        underwater(UUV_MASS + "<scaling_damping>1.5</scaling_damping>"),
        "<scaling_damping> is left out",
    ),
    "MuJoCo's actuators": (
        mjcf(full(I)).replace("</mujoco>", "<actuator><motor/></actuator></mujoco>"),
        "actuators are left out",
    ),
    "MuJoCo's damping": (
        mjcf(full(I)).replace("<inertial", '<joint damping="0.1"/><inertial'),
        "the damping of joints is left out",
    ),
    "a mesh that floats": (
        plugged(world=BUOYANCY).replace("<box><size>1 0.5 0.25</size></box>", "<mesh/>"),
        "weight and buoyancy are left out",
    ),
    "a thruster of no joint": (
        plugged(model=THRUSTER.replace("shaft", "rudder")),
        "write its thrust as text in `force`",
    ),
    "a type of its own": (
        underwater(UUV_MASS).replace("fossen", "sphere"),
        "the type sphere itself: they are left out",
    ),
    **{
        f"MuJoCo's {key}": (
            mjcf(full(I)).replace("<worldbody>", f'<option {key}="{value}"/><worldbody>'),
            f"MuJoCo's {key} = ",
        )
        for key, value in {"density": "1.2", "viscosity": "2e-5", "wind": "0 1 0"}.items()
    },
    "MuJoCo's shapes": (
        mjcf(full(I)).replace("<geom type", '<geom fluidshape="ellipsoid" type'),
        "MuJoCo's fluidshape",
    ),
}


@pytest.mark.parametrize(("content", "sentence"), DRY.values(), ids=DRY)
def test_what_is_left_out_is_warned_of(
    content: str, sentence: str, tmp_path: Path, capsys: Captured
) -> None:
    """The warning is printed with status 0, and stands in the scene and in `--json`."""
    (tmp_path / "auv.sdf").write_text(content)
    link = ["--link", "hull"] if "hull" in content else []
    assert main(["scene", "from", str(tmp_path / "auv.sdf"), *link]) == 0
    out, error = capsys.readouterr()
    assert "warning: " in error
    assert sentence in error
    assert sentence in " ".join(out.replace("\n# ", " ").split())


def test_an_added_mass_that_is_not_symmetric_is_refused(tmp_path: Path) -> None:
    """No energy of a fluid has such a matrix."""
    content = plugged(model=hydrodynamics("<xDotV>-1</xDotV>"))
    assert "a symmetric added mass" in str(refusal(tmp_path, content, "hull"))


# The verb


def test_the_verb_prints_a_scene_that_can_be_run(tmp_path: Path, capsys: Captured) -> None:
    """`scene from` prints TOML and nothing else on stdout; `--out` writes the same text."""
    file, out = tmp_path / "arm.urdf", tmp_path / "mine.toml"
    file.write_text(urdf())
    assert main(["scene", "from", str(file)]) == 0
    printed = capsys.readouterr().out
    assert inertia(read(printed, "printed")) == I
    assert main(["scene", "from", str(file), "--out", str(out)]) == 0
    assert capsys.readouterr().out.strip() == str(out)
    assert out.read_text() == printed
    assert main(["scene", "from", str(file), "--json"]) == 0
    document = json.loads(capsys.readouterr().out)
    assert document == {"text": printed, "link": "base_link", "format": "URDF", "warnings": []}


def test_the_verb_never_overwrites_what_was_edited(tmp_path: Path, capsys: Captured) -> None:
    """An --out that is there already is refused with status 2, and stays as it is."""
    file, out = tmp_path / "arm.urdf", tmp_path / "mine.toml"
    file.write_text(urdf())
    out.write_text("edited")
    assert main(["scene", "from", str(file), "--out", str(out)]) == 2
    assert "it is there already" in capsys.readouterr().err
    assert out.read_text() == "edited"
    assert main(["scene", "from", str(file), "--out", str(tmp_path / "no" / "a.toml")]) == 2
    assert "@ --out" in capsys.readouterr().err


def test_several_links_end_with_status_2(tmp_path: Path, capsys: Captured) -> None:
    """The names are listed on stderr, nothing is printed on stdout; with --link it is done."""
    file = tmp_path / "robot.urdf"
    file.write_text(SEVERAL)
    assert main(["scene", "from", str(file)]) == 2
    out, error = capsys.readouterr()
    assert out == ""
    assert "(a, b)" in error
    assert main(["scene", "from", str(file), "--link", "b"]) == 0
    assert 'title = "b of robot.urdf"' in capsys.readouterr().out


def test_a_body_that_no_mass_has_is_warned_of(tmp_path: Path, capsys: Captured) -> None:
    """A tensor that breaks the triangle inequality is written all the same, with a warning."""
    file = tmp_path / "arm.urdf"
    file.write_text(urdf(tensors.diagonal(vector(1, 1, 3))))
    assert main(["scene", "from", str(file)]) == 0
    assert "no distribution of mass has this tensor" in capsys.readouterr().err
