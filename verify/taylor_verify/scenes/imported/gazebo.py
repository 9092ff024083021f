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
from taylor_verify.scenes.imported.attributes import Reading, is_true
from taylor_verify.scenes.imported.link import Link
from taylor_verify.scenes.imported.thrusters import with_thruster
from taylor_verify.scenes.imported.tree import Node
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


# Words in the names of plugins that act on bodies.
_ACTING: Final = (
    *(
        "wind",
        "liftdrag",
        "buoyancy",
        "magnet",
        "hydro",
        "drag",
        "wave",
        "surface",
        "aero",
        "motormodel",
    ),
    *("propeller", "usv"),
)
# The density of water in Gazebo's BuoyancyPlugin.
_FRESH: Final = Fraction("999.1026")


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
    left_out = (*link.water.left_out, *water.left_out, *_slowed(link, everything, root))
    return replace(link, water=replace(water, left_out=left_out), remarks=remarks)


def _slowed(link: Link, everything: list[Scoped], root: Node) -> Iterator[str]:
    """Yield sentences about what slows a link or blows at it without a plugin."""
    node = _node_of(link, everything)
    for decay in node.named("velocity_decay") if node else ():
        if any(child.text.strip() not in ("", "0") for child in decay.children):
            yield f"<velocity_decay> of line {decay.line} slows the link and is left out: write `damping`"
    has_wind = any(each.name == "wind" for each in root.all())
    if node and has_wind and any(is_true(each.text) for each in node.named("enable_wind")):
        yield "<wind> acts on the link and is left out: write it as text in `force` and `couple`"


def _node_of(link: Link, everything: list[Scoped]) -> Node | None:
    links = (item for item in everything if item.node.name == "link")
    mine = (i.node for i in links if _is_called(link, i.scope, i.node.attributes.get("name", "")))
    return next(mine, None)


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
    if "buoyancyplugin" in words and (stated := _stated(link, item)):
        return _with_volume(water, link, stated, plugin, everything, reading)
    is_known = is_hydrodynamics(plugin) or _is_water(plugin)
    names = [] if is_known else coefficients(plugin)
    if names or (not is_known and any(word in words for word in _ACTING)):
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
    node = _node_of(link, everything)
    is_graded = plugin.child("graded_buoyancy") is not None
    shape = None if is_graded or node is None else volumes.displaced(node, reading)
    if shape is None:
        sentence = (
            "weight and buoyancy are left out: the plugin Buoyancy needs the volume of shapes that are not "
            "read (box, sphere, ellipsoid, cylinder and capsule are)"
        )
        return replace(water, left_out=(*water.left_out, sentence))
    heavy = reading.number(density, density.text, density.name) if density else Fraction(1000)
    displaced = shape._replace(volume=shape.volume * (heavy or 0))
    return _floating(water, link, displaced, everything, reading)


def _floating(
    water: Water,
    link: Link,
    displaced: volumes.Displaced,
    everything: list[Scoped],
    reading: Reading,
) -> Water:
    """Return the water with weight and buoyancy of a link; the volume is the mass that it displaces."""
    written = next((i.node for i in everything if i.node.name == "gravity"), None)
    own = None if written is None else reading.vector(written, written.text, "gravity")
    gravity = own or volumes.GRAVITY
    hanging = balance(link.mass, link.centre, displaced.volume, displaced.centre, gravity)
    text = ", ".join(map(float_text, gravity))
    remark = f"Weight and buoyancy: {displaced.sentence}, and gravity is ({text})."
    return replace(water, hanging=hanging, remarks=(*water.remarks, remark))


def _stated(link: Link, item: Scoped) -> Node | None:
    """Return what Gazebo's BuoyancyPlugin states of the link; None where it computes the volume itself."""
    links = item.node.named("link")
    mine = (n for n in links if _is_called(link, item.scope, n.attributes.get("name", "")))
    return next((node for node in mine if node.child("volume")), None)


def _with_volume(
    water: Water, link: Link, stated: Node, plugin: Node, everything: list[Scoped], reading: Reading
) -> Water:
    """Return the water with weight and buoyancy from the volume that the plugin states."""
    volume, place = stated.child("volume"), stated.child("center_of_volume")
    density = plugin.child("fluid_density")
    size = None if volume is None else reading.positive(volume, volume.text, "volume")
    at = None if place is None else reading.vector(place, place.text, place.name)
    heavy = reading.number(density, density.text, density.name) if density else _FRESH
    mass = Fraction(size or 0) * Fraction(heavy or 0)
    shape = volumes.Displaced(mass, at or link.centre, "the volume is the plugin's")
    return _floating(water, link, shape, everything, reading)
