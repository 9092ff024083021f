"""A gyrostat as the truth knows it: a rigid body whose wheels have a constant momentum."""

from __future__ import annotations

from typing import final

from taylor_verify.exact.euler.rigid import Rotating
from taylor_verify.numbers.tensors import Vector
from taylor_verify.scenes.gyrostat import Gyrostat


@final
class Wheeled(Rotating[Gyrostat]):
    """A body with wheels."""

    room = "taylor_verify.exact.gyrostat"

    def rotor(self, body: Gyrostat) -> Vector:
        return body.rotor
