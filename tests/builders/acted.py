"""A scene under all that an engine may be given: loads, damping, wheels, and states of its own."""

from __future__ import annotations

from taylor_verify.scenes.reading.reader import read
from taylor_verify.scenes.scene import Scene

_TEXT = """
title = "A sampled controller and wheels of its own"
model = "euler"
track = ["attitude", "m", "h"]
[body]
inertia = [1.25, 1, 1.5]
damping = "1/50"
rotor = ["h", 0, "h^2/4"]
moment = ["m1 - w1*abs(w2)/9", "m2", "0.1 if t < 3 else -0.1*q1"]
[states]
h = { start = "1/8", rate = "q1 - w2/4" }
m = { every = "1/4", value = ["-sign(q1)/9", "clip(-w2, -0.1, 0.1)"] }
[initial]
omega = [0.25, -0.5, 0.375]
attitude = [0.5, 0.5, -0.5, 0.5]
[time]
start = 1
end = 5
samples = 9
"""


# What has a kink in the text, and what takes its place where the motion is to be smooth.
_SMOOTH = {"abs(w2)": "w2", "-sign(q1)/9": "-q1/9", "clip(-w2, -0.1, 0.1)": "-w2/5"}


def acted(is_smooth: bool = False) -> Scene:
    text = _TEXT
    for kink, smooth in _SMOOTH.items() if is_smooth else ():
        text = text.replace(kink, smooth)
    return read(text, "acted")
