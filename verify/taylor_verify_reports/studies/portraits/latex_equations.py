"""Equations of motion in general form, in LaTeX, by the class of a body.

H, x, y and their rates are in body axes, as are the loads; the attitude R takes body components to space
components, and c is the body's origin in space.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Final

from taylor_verify.scenes.bodies import Body, ImmersedBody, RigidBody
from taylor_verify.scenes.scene import Scene

_EULER: Final = r"\dot{\mathbf H} = \mathbf H \times \boldsymbol\omega"
_MOMENTUM: Final = r"\mathbf H = \mathsf I \boldsymbol\omega"
_LINEAR: Final = r"\dot{\mathbf x} = \mathbf x \times \boldsymbol\Omega"
_ANGULAR: Final = (
    r"\dot{\mathbf y} = \mathbf y \times \boldsymbol\Omega + \mathbf x \times \mathbf U"
)
_VELOCITIES: Final = (
    r"\mathbf U = \frac{\partial T}{\partial \mathbf x}, \quad "
    r"\boldsymbol\Omega = \frac{\partial T}{\partial \mathbf y}"
)
_ENERGY: Final = (
    r"T = \frac{1}{2} \mathbf x \cdot \mathsf A \mathbf x + \mathbf x \cdot \mathsf B \mathbf y "
    r"+ \frac{1}{2} \mathbf y \cdot \mathsf C \mathbf y"
)
_CENTRE: Final = r"\dot{\mathbf c} = \mathsf R \mathbf U"


def equations(scene: Scene) -> list[str]:
    """Return the equations of the scene in LaTeX, with its loads and its tracked quantities."""
    body_equations, omega = _EQUATIONS[type(scene.body)]
    loads = scene.body.loads
    current = r" + \mathbf v" if loads and any(loads.current) else ""
    tracked = {
        "attitude": rf"\dot{{\mathsf R}} = \mathsf R [{omega}]_\times",
        "centre": f"{_CENTRE}{current}",
    }
    return [
        *body_equations(scene.body),
        *(line for name, line in tracked.items() if name in scene.track),
    ]


def _euler_equations(body: RigidBody) -> list[str]:
    loaded = "" if body.is_free or not _has_loads(body) else r" + \mathbf M" + _written(body)
    slowed = r"\mathsf I \boldsymbol\omega" if any(body.rotor) else r"\mathbf H"
    damped = f" - c {slowed}" if body.damping else ""
    written = r" + \mathbf h(t, \mathbf z)" if body.loads and body.loads.rotor else ""
    wheels = r" + \mathbf h" if any(body.rotor) else written
    return [f"{_EULER}{damped}{loaded}", f"{_MOMENTUM}{wheels}"]


def _kirchhoff_equations(body: ImmersedBody) -> list[str]:
    force = r" - c \mathbf x" if body.damping else ""
    couple = r" - c \mathbf y" if body.damping else ""
    force += rf" + \mathbf X{_written(body)}" if body.loads or any(body.force) else ""
    couple += rf" + \mathbf L{_written(body)}" if body.loads or any(body.couple) else ""
    return [f"{_LINEAR}{force}", f"{_ANGULAR}{couple}", _VELOCITIES, _ENERGY]


def _has_loads(body: Body) -> bool:
    """Return False where a scene writes down the momentum of its wheels, and no moment."""
    loads = body.loads
    return loads is None or bool(loads.hung) or any(any(each) for _, each in loads.vectors)


def _written(body: Body) -> str:
    """Return the arguments of a load that the scene writes down: the time, and the state z."""
    return r"(t, \mathbf z)" if body.loads else ""


# For each kind of body its equations, and the name of its angular velocity in them.
_EQUATIONS: Final[Mapping[type[Body], tuple[Callable[[Any], list[str]], str]]] = {
    RigidBody: (_euler_equations, r"\boldsymbol\omega"),
    ImmersedBody: (_kirchhoff_equations, r"\boldsymbol\Omega"),
}
