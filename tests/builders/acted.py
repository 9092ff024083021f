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


def acted() -> Scene:
    return read(_TEXT, "acted")
