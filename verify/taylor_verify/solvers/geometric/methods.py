"""The geometric integrators by name: `geometric:METHOD?step=NUMBER`."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from fractions import Fraction
from functools import partial
from typing import Final

from taylor_verify.solvers.geometric.fixed_step import FixedStep
from taylor_verify.solvers.geometric.implicit import ImplicitMidpoint, MoserVeselov
from taylor_verify.solvers.geometric.munthe_kaas import MuntheKaas
from taylor_verify.solvers.geometric.splitting import Splitting
from taylor_verify.solvers.options import options

METHODS: Final[Mapping[str, Callable[[Fraction, str], FixedStep]]] = {
    "implicit-midpoint": ImplicitMidpoint,
    "splitting": Splitting,
    "moser-veselov": MoserVeselov,
    "preprocessed-moser-veselov": partial(MoserVeselov, preprocessed=True),
    "lie-rk4": MuntheKaas,
}


def named(name: str) -> FixedStep:
    """Return the integrator of that name, with its step in the scene's unit of time.

    Raises ValueError for a method that there is not, and for a step that is missing or not positive.
    """
    asked = options(name, METHODS, ["step"])
    return METHODS[asked.method](asked.positive("step", default=""), name)
