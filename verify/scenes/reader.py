"""A scene file becomes a Scene in exact rationals, or is refused with all its faults at once.

The format is that of cases/README.md. Legend: ``linear_impulse`` x, ``angular_impulse`` y;
``attitude`` is the quaternion of R, v_space = R v_body; ``centre`` is the body's origin in space.
"""

from __future__ import annotations

import hashlib
import tomllib
from collections.abc import Callable
from decimal import Decimal, InvalidOperation
from pathlib import Path
from typing import Final, NamedTuple, TypeVar

from verify.scenes import library
from verify.scenes.bodies import Body
from verify.scenes.body_reader import immersed_body, rigid_body, warnings
from verify.scenes.clock_reader import clock
from verify.scenes.faults import NOT_BUILT, Faults, Refused, near, shown
from verify.scenes.motion import IDENTITY, Impulse, Quaternion, Spin, State
from verify.scenes.scene import Scene
from verify.scenes.table import Table
from verify.scenes.tensors import ZERO_VECTOR

T = TypeVar("T")


class Model(NamedTuple):
    """How the parts of a scene that differ from model to model are read.

    ``always`` is what every motion holds, tracked or not; ``extras`` may be tracked besides.
    """

    name: str
    body: Callable[[Table], Body | None]
    initial: Callable[[Table], State | None]
    always: str
    extras: frozenset[str]


def load(scene: str | Path) -> Scene:
    """The scene at a path, or the shipped scene of that name (``euler/generic``).

    Raises Refused with every fault of the file.
    """
    file = library.find(str(scene))
    try:
        text = file.read_bytes().decode()
    except (OSError, UnicodeDecodeError) as error:
        reason = getattr(error, "strerror", None) or "bytes that are not UTF-8"
        raise Refused([f"expected a readable scene file, got {reason!r} @ {file}"]) from None
    return read(text, str(scene))


def read(text: str, name: str) -> Scene:
    """The scene that this text describes; raises Refused with every fault of it."""
    faults = Faults()
    top = Table(_parsed(text, name), "", faults)
    title, source = top.text("title"), top.text("source", default="")
    model = _model(top)
    track = _track(top, model)
    body = _part(top, "body", model.body if model else _unread)
    initial = _part(top, "initial", model.initial if model else _unread)
    time = _part(top, "time", clock)
    _refuse_manufactured(top)
    top.close()
    if title is None or source is None or model is None or track is None:
        raise Refused(faults.lines)
    if faults.lines or body is None or initial is None or time is None:
        raise Refused(faults.lines)
    return Scene(
        name=name,
        title=title,
        model=model.name,
        track=track,
        body=body,
        initial=initial,
        clock=time,
        source=source,
        digest=hashlib.sha256(text.encode()).hexdigest(),
        warnings=warnings(body),
    )


def _parsed(text: str, name: str) -> dict[str, object]:
    try:
        return tomllib.loads(text, parse_float=_decimal)
    except RecursionError:
        reason = "brackets nested too deeply"
    except ValueError as error:  # TOMLDecodeError is one; it says line and column
        reason = str(error)
    raise Refused([f"expected a TOML document, got a fault in it: {reason} @ {name}"])


def _decimal(literal: str) -> Decimal | str:
    """The literal exactly; one beyond even Decimal's exponents stays text and is refused later."""
    try:
        return Decimal(literal)
    except InvalidOperation:
        return literal


def _part(top: Table, key: str, reader: Callable[[Table], T]) -> T | None:
    """A table of the scene, read and closed."""
    table = top.table(key)
    if table is None:
        return None
    part = reader(table)
    table.close()
    return part


def _unread(table: Table) -> None:
    """Without a model it is not known what the table should hold."""
    table.drain()


def _model(top: Table) -> Model | None:
    expected = f"one of {', '.join(MODELS)}"
    value = top.take("model", expected)
    if isinstance(value, str) and value in MODELS:
        return MODELS[value]
    if value is not None:
        top.fault(expected, shown(value), "model", near(str(value), MODELS))
    return None


def _track(top: Table, model: Model | None) -> frozenset[str] | None:
    """What the scene requires besides omega or impulse; the centre needs the attitude."""
    known = model.extras | {model.always} if model else EVERYTHING_TRACKED
    words = top.words("track", known)
    if words is None or model is None:
        return None
    return (words | {"attitude"} if "centre" in words else words) & model.extras


def _refuse_manufactured(top: Table) -> None:
    if top.has("manufactured"):
        top.take("manufactured", "a table")
        top.fault("a free or loaded body", f"a manufactured motion, {NOT_BUILT}", "manufactured")


def _spin(table: Table) -> Spin | None:
    omega = table.vector("omega")
    attitude = _attitude(table)
    return Spin(omega, attitude) if omega and attitude else None


def _impulse(table: Table) -> Impulse | None:
    linear, angular = table.vector("linear_impulse"), table.vector("angular_impulse")
    attitude = _attitude(table)
    centre = table.vector("centre", default=ZERO_VECTOR)
    if linear and angular and attitude and centre:
        return Impulse(linear, angular, attitude, centre)
    return None


def _attitude(table: Table) -> Quaternion | None:
    """A quaternion of any norm but zero, scalar first."""
    entries = table.vector("attitude", default=IDENTITY, length=4)
    if entries is None:
        return None
    if not any(entries):
        table.fault("a quaternion that is not zero", shown(list(entries)), "attitude")
        return None
    q0, q1, q2, q3 = entries
    return (q0, q1, q2, q3)


MODELS: Final = {
    model.name: model
    for model in (
        Model("euler", rigid_body, _spin, "omega", frozenset({"attitude"})),
        Model("kirchhoff", immersed_body, _impulse, "impulse", frozenset({"attitude", "centre"})),
    )
}

EVERYTHING_TRACKED: Final = frozenset().union(*({m.always, *m.extras} for m in MODELS.values()))
