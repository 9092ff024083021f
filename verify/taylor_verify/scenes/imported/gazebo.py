"""Plugins of a URDF or SDF file that act on one link: its water, its thrusters, what floats it.

A plugin acts on a link of its own model. One that acts and is not read is named in ``left_out``.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Final

from taylor_verify.numbers.precision import float_text
from taylor_verify.scenes.imported import volumes
from taylor_verify.scenes.imported.attributes import Reading, is_true
from taylor_verify.scenes.imported.link import Link
from taylor_verify.scenes.imported.thrusters import with_thruster
from taylor_verify.scenes.imported.tree import Node, Scoped, scoped
from taylor_verify.scenes.imported.water import (
    Water,
    balance,
    coefficients,
    displaced_mass,
    is_hydrodynamics,
    of_gazebo,
    of_uuv,
)

_TWICE: Final = (
    "the file has an added mass in <fluid_added_mass> and another in a plugin: the scene has that of the "
    "tag, and a simulator that takes both counts it twice"
)

_NO_VOLUME: Final = (
    "weight and buoyancy are left out: the plugin Buoyancy needs the volume of shapes that are not "
    "read (box, sphere, ellipsoid, cylinder and capsule are)"
)
# Words in the names of plugins that act on bodies.
_ACTING: Final = (
    "wind liftdrag buoyancy magnet hydro drag wave surface aero motormodel propeller usv"
)
# The density of water in Gazebo's BuoyancyPlugin.
_FRESH: Final = Fraction("999.1026")


def surrounded(link: Link, root: Node, reading: Reading) -> Link:
    """Return the link with what the plugins of its file do to it."""
    around = _Surroundings(link, [*scoped(root)], reading)
    plugins = [item for item in around.everything if item.node.name == "plugin"]
    watery = [item for item in plugins if _is_water(item.node)]
    waters = [around.water(item) for item in watery]
    mine = [water for water in waters if water is not None]
    if len(mine) > 1:
        reading.fault("one plugin of water about a link", f"{len(mine)}", watery[-1].node)
    water = mine[0] if mine else Water()
    elsewhere = (
        f"the water of the plugin of line {item.node.line} is about another link than {link.name}"
        for item, about in zip(watery, waters, strict=True)
        if about is None
    )
    water = water.without(*elsewhere)
    if link.added_mass is not None and water.added_mass is not None:
        water = replace(water, added_mass=None).without(_TWICE)
    for item in plugins:
        water = around.with_plugin(water, item)
    added = water.added_mass if link.added_mass is None else link.added_mass
    if added is not None and any(map(any, added)):
        link = replace(link, added_mass=added)
    remarks = (*link.remarks, *water.remarks)
    left_out = (*link.water.left_out, *water.left_out, *around.slowing(root))
    return replace(link, water=replace(water, left_out=left_out), remarks=remarks)


def _is_water(plugin: Node) -> bool:
    return is_hydrodynamics(plugin) or any(
        node.child("hydrodynamic_model") for node in plugin.named("link")
    )


@dataclass(frozen=True)
class _Surroundings:
    """A link, and everything in its file that may act on it."""

    link: Link
    everything: Sequence[Scoped]
    reading: Reading

    @property
    def node(self) -> Node | None:
        """The element of the link."""
        links = (item for item in self.everything if item.node.name == "link")
        return next((item.node for item in links if self._is_called(item.scope, item.node)), None)

    def _is_called(self, scope: str, node: Node) -> bool:
        return self._is_link(scope, node.attributes.get("name", ""))

    def _is_link(self, scope: str, name: str) -> bool:
        """Return True for the name of the link in a scope, with or without the namespace of a robot."""
        return self.link.name in (f"{scope}{name}", f"{scope}{name.rpartition('/')[2]}")

    def slowing(self, root: Node) -> Iterator[str]:
        """Yield sentences about what slows the link or blows at it without a plugin."""
        node = self.node
        for decay in node.named("velocity_decay") if node else ():
            if any(child.text.strip() not in ("", "0") for child in decay.children):
                place = f"<velocity_decay> of line {decay.line}"
                yield f"{place} slows the link and is left out: write `damping`"
        has_wind = any(each.name == "wind" for each in root.all())
        if node and has_wind and any(is_true(each.text) for each in node.named("enable_wind")):
            yield "<wind> acts on the link and is left out: write it as text in `force` and `couple`"

    def water(self, item: Scoped) -> Water | None:
        """Return the water that a plugin puts about the link; None for any other plugin."""
        if is_hydrodynamics(item.node):
            is_meant = self._is_link(item.scope, item.node.written("link_name"))
            return of_gazebo(item.node, self.reading) if is_meant else None
        for node in item.node.named("link"):
            if self._is_called(item.scope, node) and node.child("hydrodynamic_model"):
                return of_uuv(node, self.link.mass, self.link.centre, item.node, self.reading)
        return None

    def with_plugin(self, water: Water, item: Scoped) -> Water:
        """Return the water with a thruster or a buoyancy, or with the name of what is left out."""
        plugin = item.node
        words = " ".join(plugin.attributes.get(key, "").lower() for key in ("name", "filename"))
        if "thruster" in words and "manager" not in words:
            return with_thruster(water, self.link, item, self.everything, self.reading)
        if words.partition(" ")[0].endswith("::buoyancy"):
            return self._with_buoyancy(water, plugin)
        if "buoyancyplugin" in words and (stated := self._stated(item)):
            return self._with_volume(water, stated, plugin)
        is_known = _is_water(plugin)
        names = [] if is_known else coefficients(plugin)
        if names or (not is_known and any(word in words for word in _ACTING.split())):
            name = plugin.attributes.get("name") or plugin.attributes.get("filename", "")
            sentence = f"the plugin {name} of line {plugin.line} acts on bodies and is left out"
            listed = f" (it has {', '.join(names[:6])})" if names else ""
            return water.without(sentence + listed)
        return water

    # Weight and buoyancy.

    def _with_buoyancy(self, water: Water, plugin: Node) -> Water:
        """Return the water with weight and buoyancy from the collision shapes of the link."""
        density, node = plugin.child("uniform_fluid_density"), self.node
        is_graded = plugin.child("graded_buoyancy") is not None
        shape = None if is_graded or node is None else volumes.displaced(node, self.reading)
        if shape is None:
            return water.without(_NO_VOLUME)
        heavy = Fraction(1000)
        if density:
            heavy = self.reading.number(density, density.text, density.name) or Fraction(0)
        return self._floating(water, shape._replace(volume=shape.volume * heavy))

    def _stated(self, item: Scoped) -> Node | None:
        """Return what Gazebo's BuoyancyPlugin states of the link; None if it computes the volume itself."""
        mine = (node for node in item.node.named("link") if self._is_called(item.scope, node))
        return next((node for node in mine if node.child("volume")), None)

    def _with_volume(self, water: Water, stated: Node, plugin: Node) -> Water:
        """Return the water with weight and buoyancy from the volume that the plugin states."""
        mass = displaced_mass(stated, plugin, _FRESH, self.reading)
        at = self.reading.inner(stated, "center_of_volume") or self.link.centre
        return self._floating(water, volumes.Displaced(mass, at, "the volume is the plugin's"))

    def _floating(self, water: Water, displaced: volumes.Displaced) -> Water:
        """Return the water with weight and buoyancy; the volume is the mass that the link displaces."""
        written = next((i.node for i in self.everything if i.node.name == "gravity"), None)
        own = None if written is None else self.reading.vector(written, written.text, "gravity")
        gravity = own or volumes.GRAVITY
        mass, centre = self.link.mass, self.link.centre
        hanging = balance(mass, centre, displaced.volume, displaced.centre, gravity)
        text = ", ".join(map(float_text, gravity))
        remark = f"Weight and buoyancy: {displaced.sentence}, and gravity is ({text})."
        return replace(water, hanging=hanging, remarks=(*water.remarks, remark))
