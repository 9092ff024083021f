"""A scene file becomes a Scene in exact rationals, or is refused with all its faults at once.

The format is that of cases/README.md.
"""

from __future__ import annotations

import hashlib
import os
import re
import tomllib
from collections.abc import Callable
from dataclasses import replace
from decimal import Decimal, InvalidOperation
from functools import partial
from pathlib import Path
from typing import Final, NamedTuple, TypeVar

from taylor_verify.numbers.tensors import Vector
from taylor_verify.records.escapes import one_line
from taylor_verify.records.faults import Faults, Refused, cut, near, shown
from taylor_verify.records.limit import Limit
from taylor_verify.records.quantities import MAIN, TRACKED, with_needs
from taylor_verify.records.regular_file import read_bytes
from taylor_verify.scenes import library
from taylor_verify.scenes.bodies import DAMPING, Body, ImmersedBody, RigidBody
from taylor_verify.scenes.loads.loads import Loads
from taylor_verify.scenes.loads.manufactured import Manufactured
from taylor_verify.scenes.loads.states import State as Own
from taylor_verify.scenes.loads.vocabulary import FIELD, TAKEN, Doubts, names
from taylor_verify.scenes.motion import State
from taylor_verify.scenes.reading.body import immersed_body, rigid_body, warnings
from taylor_verify.scenes.reading.hints import advice
from taylor_verify.scenes.reading.initial import VELOCITIES, impulses, place, state, turning
from taylor_verify.scenes.reading.loads import immersed_loads, loaded, rigid_loads
from taylor_verify.scenes.reading.manufactured import manufactured
from taylor_verify.scenes.reading.states import own_states
from taylor_verify.scenes.reading.table import Table
from taylor_verify.scenes.reading.time_table import clock
from taylor_verify.scenes.scene import Scene

T = TypeVar("T")

MOST_BYTES: Final = Limit(2**25, "bytes", "a million instants of thirty characters")
# No key of a scene has more than three parts; the time of tomllib grows as the square of their number.
_MOST_KEY_PARTS: Final = 16
_DEEP_KEY: Final = re.compile(
    r"""(?:^|[\[{,])[ \t]*+(?:(?:[\w-]++|"[^"\n]*+"|'[^'\n]*+')[ \t]*+\.[ \t]*+)"""
    rf"{{{_MOST_KEY_PARTS}}}",
    re.MULTILINE,
)


class Model(NamedTuple):
    """The readers of the parts of a scene that differ from model to model.

    ``moving`` reads the part of the initial state that enters the equations. ``velocities`` are other keys
    for that part.
    """

    kind: type[Body]
    loads: Callable[[Table], Loads]
    body: Callable[[Table, Loads], Body | None]
    moving: Callable[[Table, Body | None], Vector | None]
    velocities: tuple[str, ...] = ()

    @property
    def name(self) -> str:
        return self.kind.MODEL


MODELS: Final = {
    model.name: model
    for model in (
        Model(RigidBody, rigid_loads, rigid_body, turning),
        Model(ImmersedBody, immersed_loads, immersed_body, impulses, VELOCITIES),
    )
}


def load(scene: str | os.PathLike[str]) -> Scene:
    """Return the scene at a path, or the shipped scene of that name (``euler/generic``).

    Every number becomes the rational that its text writes. Raises Refused with every fault of the file
    at once, each as ``expected ..., got ... @ body.inertia[1]``.
    """
    file = library.find(scene)
    return read(text_of(file), str(scene), file.parent)


def text_of(file: Path) -> str:
    """Return the text of a scene file. Raises Refused for one that cannot be read."""
    content = read_bytes(file, "a readable scene file", MOST_BYTES)
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError:
        reason = "bytes that are not UTF-8"
        raise Refused([f"expected a readable scene file, got {reason!r} @ {file}"]) from None


def as_scene(scene: Scene | str | os.PathLike[str]) -> Scene:
    """Return a Scene as it is; load one that is given by its path or name."""
    return scene if isinstance(scene, Scene) else load(scene)


def read(text: str, name: str, folder: Path | None = None) -> Scene:
    """Return the scene that this text describes; tables from files are looked for in the folder.

    Raises Refused with every fault of the text.
    """
    faults = Faults()
    top = Table(parsed(text, name), "", faults)
    title, source = top.text("title"), top.text("source", default="")
    model = _model(top)
    states = own_states(top)
    own, doubts = states.names, states.doubts
    track = _track(top, model, own)
    body, loads = _body_and_loads(top, model, states.states) if model else _unread(top)
    writes_velocities = not set(VELOCITIES).isdisjoint(top.peek_keys("initial"))
    motion, initial = _motion_and_start(top, model, body) if model else (None, None)
    time = _part(top, "time", clock, model)
    if model is None:
        doubts |= Doubts(TAKEN - names(FIELD))
    loads = replace(loads, states=states.states)
    body = loaded(body, loads, doubts, top, folder, time)
    if body is not None and motion is not None and time is not None:
        body = body.with_loads(motion.loads(body, time.start))
    top.close(advice("", model.name if model else ""))
    if title is None or source is None or model is None or track is None:
        raise Refused(faults.lines)
    if faults.lines or body is None or initial is None or time is None:
        raise Refused(faults.lines)
    return Scene(
        name=one_line(name),
        title=title,
        model=model.name,
        track=track - own,
        states=track & own,
        body=body,
        initial=initial,
        clock=time,
        source=source,
        digest=hashlib.sha256(text.encode()).hexdigest(),
        warnings=warnings(body),
        notes=tuple(faults.notes),
        writes_velocities=writes_velocities,
    )


def parsed(text: str, name: str) -> dict[str, object]:
    """Return a TOML document, its decimals as Decimal. Raises Refused for a text that is no TOML."""
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
    """Return the literal exactly, or as text if its exponent is too large: it is refused later."""
    try:
        return Decimal(literal)
    except InvalidOperation:
        return literal


def _part(
    top: Table, key: str, reader: Callable[[Table], T], model: Model | None = None
) -> T | None:
    """Read a table of the scene with ``reader``, and close it."""
    table = top.table(key)
    if table is None:
        return None
    part = reader(table)
    table.close(advice(key, model.name if model else ""))
    return part


def _unread(top: Table) -> tuple[None, Loads]:
    """Take the tables whose contents are not known without a model."""
    needed = {"body"} if top.has("manufactured") else {"body", "initial"}
    for key in ("body", "manufactured", "initial"):
        if key in needed or top.has(key):
            top.table(key)
    return None, Loads("euler", ())


def _motion_and_start(
    top: Table, model: Model, body: Body | None
) -> tuple[Manufactured | None, State | None]:
    """Return a manufactured motion, if there is one, and the initial state; None after a fault."""
    if top.has("manufactured"):
        motion = _motion(top, model, body)
        return motion, _start_of(top, model, motion)

    def start(table: Table) -> State | None:
        moving = model.moving(table, body)
        return state(model.kind.STATE, moving, place(table, model.kind.STATE))

    return None, _part(top, "initial", start, model)


def _body_and_loads(top: Table, model: Model, states: tuple[Own, ...]) -> tuple[Body | None, Loads]:
    """Return the body, None after a fault, and what acts on it, as far as it was read."""
    table = top.table("body")
    if table is None:
        return None, Loads(model.name, ())
    loads = model.loads(table)
    body = model.body(table, replace(loads, states=states))
    table.close(advice("body", model.name))
    return body, loads


def _model(top: Table) -> Model | None:
    expected = f"one of {', '.join(MODELS)}"
    value = top.take("model", expected)
    if isinstance(value, str) and value in MODELS:
        return MODELS[value]
    if value is not None:
        top.fault(expected, shown(value), "model", near(cut(str(value)), MODELS))
    return None


def _track(top: Table, model: Model | None, own: frozenset[str]) -> frozenset[str] | None:
    """Return what the scene requires besides omega or impulse, and what that needs; ``own`` are states."""
    models = [model.name] if model else list(MODELS)
    known = frozenset(name for each in models for name in (MAIN[each], *TRACKED[each]))
    words = top.words("track", known | own)
    if words is None or model is None:
        return None
    return with_needs(words) & (own | frozenset(TRACKED[model.name]))


def _motion(top: Table, model: Model, body: Body | None) -> Manufactured | None:
    """Return the manufactured motion of a scene; all else that acts on the body is a fault."""
    motion = _part(top, "manufactured", partial(manufactured, vectors=model.kind.STATE.MOVING))
    values = body.parts() if body else {}
    for name in model.kind.load_names():
        load = values.get(name, ())
        if any(load):
            expected = "no load beside a manufactured motion, which determines its own"
            top.fault(expected, shown(list(load)), f"body.{name}", f"remove `{name}`")
    if body is not None and body.loads is not None:
        expected = "no texts, hanging forces or states beside a manufactured motion"
        top.fault(expected, "some", "body")
    if body is not None and body.damping:
        expected, mend = "no damping beside a manufactured motion", f"remove `{DAMPING.name}`"
        top.fault(expected, shown(body.damping), f"body.{DAMPING.name}", mend)
    return motion


def _start_of(top: Table, model: Model, motion: Manufactured | None) -> State | None:
    """Return the state in which a manufactured motion begins; the scene gives only its place."""
    kind = model.kind.STATE
    start = (top.table("initial") if top.has("initial") else None) or top.empty("initial")
    for name in kind.MOVING + model.velocities:
        if start.has(name):
            start.take(name, "nothing")
            got = "another one beside a manufactured motion"
            start.fault("the start that the motion has", got, name, f"remove `{name}`")
    initial = state(kind, motion.start if motion else None, place(start, kind))
    start.close(advice("initial", model.name))
    return initial
