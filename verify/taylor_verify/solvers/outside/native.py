"""Driver of an engine in C++ whose library stands as the first argument; settings follow, as for a script.

The library has four functions and a number: ``begin(inertia, omega, attitude, step, settings)`` makes the
body anew, ``push(torque)`` sets the torque of the next step, ``advance()`` makes a step, and
``state(row)`` reads omega and the attitude. Omega and torques are in space axes, a quaternion is unit and
scalar first, the tensor is nine doubles, and settings are text, NAME=VALUE between spaces.
``takes_moments`` is not 0 where the engine takes principal moments alone.
"""

from __future__ import annotations

import ctypes
import sys
from typing import Any

from free_body import (
    Engine,
    FreeBody,
    Settings,
    Solved,
    answer,
    in_space,
    pushed_body,
    pushed_once,
    stepped,
)


def doubles(*values: float) -> Any:
    return (ctypes.c_double * len(values))(*values)


def solve_by(library: Any) -> Any:
    """Return the solver of a library."""
    takes_moments = ctypes.c_int.in_dll(library, "takes_moments").value

    def solve(body: FreeBody, settings: Settings) -> Solved:
        turned = body.in_principal_axes() if takes_moments else body
        tensor = doubles(*(entry for row in turned.inertia for entry in row))
        words = " ".join(f"{name}={value}" for name, value in vars(settings).items()).encode()

        def state() -> Any:
            row = doubles(*[0.0] * 7)
            library.state(row)
            return row[:3], row[3:]

        def push(moment: Any) -> None:
            library.push(doubles(*moment))

        def start() -> Engine:
            motion = doubles(*turned.omega_in_space), doubles(*turned.attitude)
            library.begin(tensor, *motion, ctypes.c_double(settings.step), words)
            return in_space(turned, library.advance, state, push)

        return stepped(turned, settings.step, start, pushed_once(turned))

    return solve


if __name__ == "__main__":
    answer(solve_by(ctypes.CDLL(sys.argv.pop(1))), pushed_body)
