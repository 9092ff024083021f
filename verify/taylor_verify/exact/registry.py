"""The kinds of body that the truth knows, by the type of the body in a scene."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from importlib import import_module
from typing import Any, Final

from taylor_verify.exact.euler.rigid import Rigid
from taylor_verify.exact.kind import Kind
from taylor_verify.exact.kirchhoff.immersed import Immersed
from taylor_verify.scenes.bodies import Body, ImmersedBody, RigidBody

KINDS: Final[Mapping[type[Body], Kind[Any, Any]]] = {
    RigidBody: Rigid(),
    ImmersedBody: Immersed(),
}


def kind_of(body: Body) -> Kind[Any, Any]:
    """Return the kind of a body."""
    return KINDS[type(body)]


def function_at(place: str) -> Callable[..., Any]:
    """Return the function at ``module:name``, imported when asked for: rooms load different libraries."""
    module, name = place.split(":")
    function: Callable[..., Any] = getattr(import_module(module), name)
    return function
