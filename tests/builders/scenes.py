"""Bodies, states and short scenes that many tests ask about: none is special, and all numbers are exact."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

from taylor_verify.models.problem import Problem, pose
from taylor_verify.numbers import tensors
from taylor_verify.numbers.precision import rung
from taylor_verify.numbers.tensors import Matrix, Vector
from taylor_verify.records.faults import Refused
from taylor_verify.scenes.bodies import Body, Clebsch, ImmersedBody, RigidBody
from taylor_verify.scenes.families.toml_text import toml
from taylor_verify.scenes.instants import EquallySpaced
from taylor_verify.scenes.motion import Clock, Impulse, Quaternion, Spin, State
from taylor_verify.scenes.reading.reader import load, read
from taylor_verify.scenes.scene import Scene


def vector(*entries: float | str) -> Vector:
    """Exact numbers from their decimal text."""
    return tuple(Fraction(str(entry)) for entry in entries)


# A rigid body with all products of inertia, and the moment on it where there is one.
TENSOR: Matrix = (vector(1, "0.1", "0.2"), vector("0.1", 2, "0.3"), vector("0.2", "0.3", "2.5"))
MOMENT = vector("0.1", "-0.2", "0.05")
# A solid of 21 coefficients, the same under loads, and one of revolution.
FORCE, COUPLE = vector("0.1", "0.05", "-0.1"), vector("0.02", "-0.1", "0.05")
GENERAL = ImmersedBody(
    linear=(vector(2, "0.1", "0.2"), vector("0.1", "1.5", "0.3"), vector("0.2", "0.3", 1)),
    coupling=(vector("0.1", "0.2", 0), vector("0.05", "0.3", "0.1"), vector(0, "0.2", "0.1")),
    angular=(vector(1, "0.2", "0.1"), vector("0.2", "1.5", "0.1"), vector("0.1", "0.1", "0.8")),
)
LOADED = replace(GENERAL, force=FORCE, couple=COUPLE)
SIX = Clebsch(*vector(1, 2, "0.1", "0.3", 1, "0.5"))
CLEBSCH = SIX.body()
# States, in a frame that is turned and away from the origin.
QUATERNION: Quaternion = (Fraction(1), Fraction(2), Fraction(3), Fraction(4))
OMEGA = vector("0.3", 1, "0.2")
SPIN = Spin(OMEGA, QUATERNION)
IMPULSE = Impulse(vector("0.1", "0.2", 1), vector("0.3", 0, 1), QUATERNION, vector(1, 2, 3))


def one_instant(body: Body, start: State, *track: str) -> Scene:
    """A scene of these, at one instant."""
    model = "euler" if isinstance(body, RigidBody) else "kirchhoff"
    clock = Clock(Fraction(0), (Fraction(1),))
    return Scene("test", "test", model, frozenset(track), body, start, clock)


def sample_scene(body: Body, *track: str, start: State | None = None) -> Scene:
    """A scene of a body at one instant, from the state of its model above where none is given."""
    state = SPIN if isinstance(body, RigidBody) else IMPULSE
    return one_instant(body, start or state, *track)


def asked_at(name: str, *instants: Fraction | int) -> Scene:
    """A shipped scene that starts at 0, asked at instants of its own."""
    return replace(load(name), clock=Clock(Fraction(0), tuple(map(Fraction, instants))))


# An attitude that is no unit quaternion, and a centre.
FRAME: Quaternion = (Fraction(1), Fraction(-2), Fraction(1, 3), Fraction(2))
PLACE = vector(1, -2, "1/3")


def everything(scene: Scene) -> Scene:
    """A scene that tracks all that its model has, from another attitude and centre."""
    place = {} if isinstance(scene.initial, Spin) else {"centre": PLACE}
    return replace(tracking_all(scene), initial=replace(scene.initial, attitude=FRAME, **place))


def sampled(scene: Scene, rows: int) -> Scene:
    """The scene with so many samples, equally spaced over its own time."""
    start, end = scene.clock.start, scene.clock.instants[-1]
    instants = EquallySpaced(start, (end - start) / (rows - 1), rows)
    return replace(scene, clock=Clock(start, instants))


def tracking_all(scene: Scene) -> Scene:
    """A scene with its attitude and, in a fluid, its centre."""
    track = {"attitude"} if scene.model == "euler" else {"attitude", "centre"}
    return replace(scene, track=frozenset(track))


def spun(omega: Sequence[float], end: float, samples: int) -> Scene:
    """A free body of moments 1, 2, 3 from these doubles, at equally spaced times that are doubles."""
    elapsed = (Fraction(end * (k / (samples - 1))) for k in range(samples))
    body = RigidBody(tensors.diagonal(vector(1, 2, 3)))
    clock = Clock(Fraction(0), tuple(elapsed))
    spin = Spin(tuple(Fraction(value) for value in omega))
    return Scene("spun", "spun", "euler", frozenset(), body, spin, clock)


def text_of(
    body: Mapping[str, Any], initial: Mapping[str, Any], end: float, samples: int, *track: str
) -> str:
    """The text of a scene from its parts, their keys as a file has them."""
    model = "euler" if "omega" in initial else "kirchhoff"
    head = {"title": "Made", "model": model, "track": [*track]}
    time = {"end": end, "samples": samples}
    return toml({**head, "body": body, "initial": initial, "time": time}, repr)


def scene_text(
    body: str = "inertia = [1, 2, 3]",
    initial: str = "omega = [1, 2, 3]",
    tables: str = "",
    time: str = "end = 1\nsamples = 2",
    top: str = "",
) -> str:
    """The text of a scene from the lines of its tables; its start tells its model, unless the top does."""
    model = (
        "" if "model" in top else f'model = "{"euler" if "omega =" in initial else "kirchhoff"}"'
    )
    head = f'title = "Made"\n{top}\n{model}'
    return f"{head}\n[body]\n{body}\n{tables}\n[initial]\n{initial}\n[time]\n{time}\n"


def read_scene(*parts: str, **others: str) -> Scene:
    """The scene of that text."""
    return read(scene_text(*parts, **others), "made")


def faults_of(*parts: str, **others: str) -> tuple[str, ...]:
    """The faults for which that text is refused."""
    with pytest.raises(Refused) as refused:
        read_scene(*parts, **others)
    return refused.value.faults


# Scenes that are judged in a moment: three instants, the start among them, and three without it.
THREE_INSTANTS = scene_text(initial="omega = [1, 0.4, 0.3]", time="end = 2\nsamples = 3")


def three_instants(on: str = "f64", samples: int = 3) -> Problem:
    """The problem of three instants, or more, on a precision."""
    text = THREE_INSTANTS.replace("samples = 3", f"samples = {samples}")
    return pose(read(text, "short"), rung(on))


LISTED_INSTANTS = scene_text(initial='omega = [1, "0.4", "0.3"]', time='at = ["0.5", 1, 2]')


def remus_inertia() -> Matrix:
    """Momentum by velocity, rows X Y Z K M N and columns u v w p q r: inertia minus added terms."""
    mass, roll, pitch = Fraction("30.48"), Fraction("0.177"), Fraction("3.45")
    added = {
        **{(0, 0): "-0.930", (1, 1): "-35.5", (2, 2): "-35.5"},  # Xu', Yv', Zw'
        **{(3, 3): "-0.0704", (4, 4): "-4.88", (5, 5): "-4.88"},  # Kp', Mq', Nr'
        **{(1, 5): "1.93", (2, 4): "-1.93"},  # Yr', Zq'
        **{(4, 2): "-1.93", (5, 1): "1.93"},  # Mw', Nv'
    }
    solid = (mass, mass, mass, roll, pitch, pitch)
    return tuple(
        tuple((solid[i] if i == j else 0) - Fraction(added.get((i, j), "0")) for j in range(6))
        for i in range(6)
    )


def scene_file(folder: Path, text: str = THREE_INSTANTS) -> Path:
    """Write a scene that is judged in a moment, and return its file."""
    file = folder / "short.toml"
    file.write_text(text, encoding="utf-8")
    return file


# All that an engine may be given

_TEXT = scene_text(
    """inertia = [1.25, 1, 1.5]
damping = "1/50"
rotor = ["h", 0, "h^2/4"]
moment = ["m1 - w1*abs(w2)/9", "m2", "0.1 if t < 3 else -0.1*q1"]""",
    "omega = [0.25, -0.5, 0.375]\nattitude = [0.5, 0.5, -0.5, 0.5]",
    """[states]
h = { start = "1/8", rate = "q1 - w2/4" }
m = { every = "1/4", value = ["-sign(q1)/9", "clip(-w2, -0.1, 0.1)"] }""",
    "start = 1\nend = 5\nsamples = 9",
    'track = ["attitude", "m", "h"]',
)
# What has a kink in the text, and what takes its place where the motion is to be smooth.
_SMOOTH = {"abs(w2)": "w2", "-sign(q1)/9": "-q1/9", "clip(-w2, -0.1, 0.1)": "-w2/5"}


def acted(is_smooth: bool = False) -> Scene:
    text = _TEXT
    for kink, smooth in _SMOOTH.items() if is_smooth else ():
        text = text.replace(kink, smooth)
    return read(text, "acted")


# An oblique attitude

FULL = "[[1.2, 0.1, -0.2], [0.1, 2.1, 0.3], [-0.2, 0.3, 2.7]]"
FORWARDS, BACKWARDS = ("end = 4\nsamples = 5", "end = -4\nsamples = 5")


def oblique(inertia: str = FULL, time: str = FORWARDS) -> Scene:
    """Return the scene, its keys as a file has them."""
    start, top = "omega = [0.9, -0.3, 0.5]\nattitude = [1, 2, -1, 3]", 'track = ["attitude"]'
    return read_scene(f"inertia = {inertia}", start, time=time, top=top)
