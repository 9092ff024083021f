"""Plugins of a URDF or SDF file that act on one link: its water, its thrusters, what floats it.

A plugin acts on a link of its own model. One that acts and is not read is named in ``left_out``.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction
from typing import Final, NamedTuple

from taylor_verify.numbers.precision import float_text
from taylor_verify.scenes.imported import volumes
from taylor_verify.scenes.imported.document import Node
from taylor_verify.scenes.imported.link import Link
from taylor_verify.scenes.imported.reading import Reading
from taylor_verify.scenes.imported.thrusters import with_thruster
from taylor_verify.scenes.imported.water import (
    Water,
    balance,
    coefficients,
    is_hydrodynamics,
    of_gazebo,
    of_uuv,
)

_TWICE: Final = (
    "the file has an added mass in <fluid_added_mass> and another in a plugin: the scene has that of the "
    "tag, and a simulator that takes both counts it twice"
)


class Scoped(NamedTuple):
    """A node of a model, with the names of the models that it is in."""

    scope: str
    node: Node


def scoped(part: Node, scope: str = "") -> Iterator[Scoped]:
    """Yield every link, joint and plugin with the models around it, and the gravity of a world."""
    for node in part.children:
        if node.name in ("model", "world", "gazebo"):
            inner = f"{scope}{node.attributes.get('name', '')}::" if node.name == "model" else scope
            yield from scoped(node, inner)
        elif node.name in ("link", "joint", "plugin", "gravity"):
            yield Scoped(scope, node)


def surrounded(link: Link, root: Node, reading: Reading) -> Link:
    """Return the link with what the plugins of its file do to it."""
    everything = [*scoped(root)]
    plugins = [item for item in everything if item.node.name == "plugin"]
    watery = [item for item in plugins if _is_water(item.node)]
    waters = [_water(link, item, reading) for item in watery]
    mine = [water for water in waters if water is not None]
    if len(mine) > 1:
        reading.fault("one plugin of water about a link", f"{len(mine)}", watery[-1].node)
    water = mine[0] if mine else Water()
    elsewhere = (
        f"the water of the plugin of line {item.node.line} is about another link than {link.name}"
        for item, about in zip(watery, waters, strict=True)
        if about is None
    )
    water = replace(water, left_out=(*water.left_out, *elsewhere))
    if link.added_mass is not None and water.added_mass is not None:
        left_out = (*water.left_out, _TWICE)
        water = replace(water, added_mass=None, left_out=left_out)
    for item in plugins:
        water = _with_plugin(water, link, item, everything, reading)
    added = water.added_mass if link.added_mass is None else link.added_mass
    if added is not None and any(map(any, added)):
        link = replace(link, added_mass=added)
    remarks = (*link.remarks, *water.remarks)
    left_out = (*link.water.left_out, *water.left_out)
    return replace(link, water=replace(water, left_out=left_out), remarks=remarks)


def _is_water(plugin: Node) -> bool:
    return is_hydrodynamics(plugin) or any(
        node.child("hydrodynamic_model") for node in plugin.named("link")
    )


def _water(link: Link, item: Scoped, reading: Reading) -> Water | None:
    """Return the water that a plugin puts about this link; None for any other plugin."""
    if is_hydrodynamics(item.node):
        name = item.node.child("link_name")
        is_meant = name is not None and _is_called(link, item.scope, name.text.strip())
        return of_gazebo(item.node, reading) if is_meant else None
    for node in item.node.named("link"):
        is_meant = _is_called(link, item.scope, node.attributes.get("name", ""))
        if is_meant and node.child("hydrodynamic_model"):
            return of_uuv(node, link.mass, link.centre, item.node, reading)
    return None


def _is_called(link: Link, scope: str, name: str) -> bool:
    """Return True for the name of this link in a scope, with or without the namespace of a robot."""
    return link.name in (f"{scope}{name}", f"{scope}{name.rpartition('/')[2]}")


def _with_plugin(
    water: Water, link: Link, item: Scoped, everything: list[Scoped], reading: Reading
) -> Water:
    """Return the water with a thruster or a buoyancy, or with the name of what is left out."""
    plugin = item.node
    words = " ".join(plugin.attributes.get(key, "").lower() for key in ("name", "filename"))
    if "thruster" in words and "manager" not in words:
        return with_thruster(water, link, item, everything, reading)
    if words.partition(" ")[0].endswith("::buoyancy"):
        return _with_buoyancy(water, link, plugin, everything, reading)
    names = [] if is_hydrodynamics(plugin) else coefficients(plugin)
    if names or any(word in words for word in ("wind", "liftdrag", "buoyancyengine", "magnet")):
        name = plugin.attributes.get("name") or plugin.attributes.get("filename", "")
        sentence = f"the plugin {name} of line {plugin.line} acts on bodies and is left out"
        listed = f" (it has {', '.join(names[:6])})" if names else ""
        return replace(water, left_out=(*water.left_out, sentence + listed))
    return water


def _with_buoyancy(
    water: Water, link: Link, plugin: Node, everything: list[Scoped], reading: Reading
) -> Water:
    """Return the water with weight and buoyancy from the collision shapes of the link."""
    density = plugin.child("uniform_fluid_density")
    links = [i for i in everything if i.node.name == "link"]
    node = next(
        i.node for i in links if _is_called(link, i.scope, i.node.attributes.get("name", ""))
    )
    shape = None if plugin.child("graded_buoyancy") else volumes.displaced(node, reading)
    if shape is None:
        sentence = (
            "weight and buoyancy are left out: the plugin Buoyancy needs the volume of shapes that are not "
            "read (box, sphere, ellipsoid, cylinder and capsule are)"
        )
        return replace(water, left_out=(*water.left_out, sentence))
    heavy = reading.number(density, density.text, density.name) if density else Fraction(1000)
    mass = shape.volume * (heavy or 0)
    written = next((i.node for i in everything if i.node.name == "gravity"), None)
    own = None if written is None else reading.vector(written, written.text, "gravity")
    gravity = own or volumes.GRAVITY
    hanging = balance(link.mass, link.centre, mass, shape.centre, gravity)
    text = ", ".join(map(float_text, gravity))
    remark = f"Weight and buoyancy: {shape.sentence}, and gravity is ({text})."
    return replace(water, hanging=hanging, remarks=(*water.remarks, remark))
