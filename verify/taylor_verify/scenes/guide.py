"""Which shipped scene tells what: the few to begin with."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Final

GUIDE: Final[Mapping[str, str]] = MappingProxyType(
    {
        "euler/oblique-start": "begin here: axes, signs of products, order and direction of quaternions",
        "euler/satellite-degrees": "rates in deg/s, a slow satellite",
        "euler/tennis-racket": "how soon small errors flip a body spun about its middle axis",
        "euler/constant-moment": "a torque that is constant in body axes",
        "euler/separatrix": "the hardest orbit of a free body: an infinite period",
        "manufactured/euler-full-tensor": "a torque that changes with time, and an exact answer still",
        "kirchhoff/auv-turn": "begin here with a vehicle: mass matrix with added mass, velocities, path",
        "kirchhoff/whole-motion": "a body of revolution in a fluid: impulses, attitude and path",
        "kirchhoff/screw": "the coupling of translation and rotation",
        "extremes": "what breaks integrators: tiny distances, huge spans, extreme scales",
    }
)
