"""A scene file becomes a Scene in exact rationals, or is refused with all its faults at once.

The format is that of cases/README.md.
"""

from __future__ import annotations

import hashlib
import os
import re
import tomllib
from collections.abc import Callable
from decimal import Decimal, InvalidOperation
from typing import Final, NamedTuple, TypeVar

from taylor_verify.records.quantities import MAIN, MOMENTA, TRACKED, with_needs
from taylor_verify.scenes import library
from taylor_verify.scenes.bodies import Body
from taylor_verify.scenes.motion import State
from taylor_verify.scenes.names import escaped
from taylor_verify.scenes.reading.body import immersed_body, rigid_body, warnings
from taylor_verify.scenes.reading.clock import clock
from taylor_verify.scenes.reading.faults import Faults, Refused, cut, near, shown
from taylor_verify.scenes.reading.hints import hints
from taylor_verify.scenes.reading.initial import VELOCITIES, impulse, placed, spin, turned
from taylor_verify.scenes.reading.limit import Limit
from taylor_verify.scenes.reading.manufactured import manufactured
from taylor_verify.scenes.reading.regular_file import read_bytes
from taylor_verify.scenes.reading.table import Table
from taylor_verify.scenes.scene import Scene

T = TypeVar("T")

MOST_BYTES: Final = Limit(2**25, "bytes", "a million instants of thirty characters")
# No key of a scene has more than three parts, and tomllib takes the square of their number in time.
_MOST_KEY_PARTS: Final = 16
_DEEP_KEY: Final = re.compile(
    r"""(?:^|[\[{,])[ \t]*+(?:(?:[\w-]++|"[^"\n]*+"|'[^'\n]*+')[ \t]*+\.[ \t]*+)"""
    rf"{{{_MOST_KEY_PARTS}}}",
    re.MULTILINE,
)


class Model(NamedTuple):
    """How the parts of a scene that differ from model to model are read.

    ``moving`` are the vectors of a manufactured motion, ``velocities`` other keys for its start, ``loads``
    the vectors that it determines, and ``placed`` reads what of the initial state it leaves open.
    """

    name: str
    body: Callable[[Table], Body | None]
    initial: Callable[[Table, Body | None], State | None]
    moving: tuple[str, ...]
    velocities: tuple[str, ...]
    loads: tuple[str, ...]
    placed: Callable[[Table], State | None]


def load(scene: str | os.PathLike[str]) -> Scene:
    """The scene at a path, or the shipped scene of that name (``euler/generic``).

    Every number becomes the rational that its text writes. Raises Refused with every fault of the file
    at once, each as ``expected ..., got ... @ body.inertia[1]``.
    """
    file = library.find(scene)
    content = read_bytes(file, "a readable scene file", MOST_BYTES)
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError:
        reason = "bytes that are not UTF-8"
        raise Refused([f"expected a readable scene file, got {reason!r} @ {file}"]) from None
    return read(text, str(scene))


def as_scene(scene: Scene | str | os.PathLike[str]) -> Scene:
    """Return a Scene as it is; load one that is given by its path or name."""
    return scene if isinstance(scene, Scene) else load(scene)


def read(text: str, name: str) -> Scene:
    """The scene that this text describes; raises Refused with every fault of it."""
    faults = Faults()
    top = Table(_parsed(text, name), "", faults)
    title, source = top.text("title"), top.text("source", default="")
    model = _model(top)
    track = _track(top, model)
    body = _part(top, "body", model.body if model else _unread, model)
    if top.has("manufactured"):
        body, initial = _manufactured(top, model, body)
    else:
        initial = _part(top, "initial", _initial(model, body) if model else _unread, model)
    time = _part(top, "time", clock)
    top.close(hints(""))
    if title is None or source is None or model is None or track is None:
        raise Refused(faults.lines)
    if faults.lines or body is None or initial is None or time is None:
        raise Refused(faults.lines)
    return Scene(
        name=escaped(name),
        title=title,
        model=model.name,
        track=track,
        body=body,
        initial=initial,
        clock=time,
        source=source,
        digest=hashlib.sha256(text.encode()).hexdigest(),
        warnings=warnings(body),
        notes=tuple(faults.notes),
    )


def _parsed(text: str, name: str) -> dict[str, object]:
    if deep := _DEEP_KEY.search(text):
        line = text.count("\n", 0, deep.start()) + 1
        expected = f"a key of at most {_MOST_KEY_PARTS} parts"
        raise Refused([f"expected {expected}, got more @ {name}, line {line}"])
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


def _part(
    top: Table, key: str, reader: Callable[[Table], T], model: Model | None = None
) -> T | None:
    """A table of the scene, read and closed."""
    table = top.table(key)
    if table is None:
        return None
    part = reader(table)
    table.close(hints(key, model.name if model else ""))
    return part


def _initial(model: Model, body: Body | None) -> Callable[[Table], State | None]:
    """The reader of the initial state of this body."""
    return lambda table: model.initial(table, body)


def _unread(table: Table) -> None:
    """Without a model it is not known what the table should hold."""
    table.drain()


def _model(top: Table) -> Model | None:
    expected = f"one of {', '.join(MODELS)}"
    value = top.take("model", expected)
    if isinstance(value, str) and value in MODELS:
        return MODELS[value]
    if value is not None:
        top.fault(expected, shown(value), "model", near(cut(str(value)), MODELS))
    return None


def _track(top: Table, model: Model | None) -> frozenset[str] | None:
    """Return what the scene requires besides omega or impulse, and what that needs."""
    models = [model.name] if model else list(MODELS)
    known = frozenset(name for each in models for name in (MAIN[each], *TRACKED[each]))
    words = top.words("track", known)
    if words is None or model is None:
        return None
    return with_needs(words) & frozenset(TRACKED[model.name])


def _manufactured(
    top: Table, model: Model | None, body: Body | None
) -> tuple[Body | None, State | None]:
    """The body with its manufactured motion, and the state in which that motion begins."""
    if model is None:
        for part in ("manufactured", "initial"):
            if top.has(part):
                _part(top, part, _unread)
        return None, None
    table = top.table("manufactured")
    motion = None if table is None else manufactured(table, model.moving)
    if table is not None:
        table.close()
    start = (top.table("initial") if top.has("initial") else None) or top.empty("initial")
    for name in model.moving + model.velocities:
        if start.has(name):
            start.take(name, "nothing")
            got = "another one beside a manufactured motion"
            start.fault("the start that the motion has", got, name, f"remove `{name}`")
    initial = model.placed(start)
    start.close(hints("initial", model.name))
    for load in model.loads:
        given = getattr(body, load, ())
        if any(given):
            expected = "no load beside a manufactured motion, which determines its own"
            top.fault(expected, shown(list(given)), f"body.{load}", f"remove `{load}`")
    if body is None or motion is None or initial is None:
        return None, None
    return body.with_motion(motion), initial.with_moving(motion.start)


MODELS: Final = {
    model.name: model
    for model in (
        Model(
            name="euler",
            body=rigid_body,
            initial=spin,
            moving=MOMENTA["euler"],
            velocities=(),
            loads=("moment",),
            placed=turned,
        ),
        Model(
            name="kirchhoff",
            body=immersed_body,
            initial=impulse,
            moving=MOMENTA["kirchhoff"],
            velocities=VELOCITIES,
            loads=("force", "couple"),
            placed=placed,
        ),
    )
}
