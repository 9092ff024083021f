# /// script
# requires-python = ">=3.11,<3.15"
# dependencies = [
#   "diffrax==0.7.2",
#   "equinox==0.13.8",
#   "jax==0.10.2",
#   "jaxlib==0.10.2",
#   "numpy==2.4.6",
#   "scipy==1.17.1",
# ]
# [tool.taylor-verify]
# title = "diffrax on JAX"
# serves = true
# rungs = ["f32", "f64"]
# [tool.taylor-verify.methods]
# tsit5 = "Tsitouras 5(4)"
# dopri8 = "Prince-Dormand 8(7)"
# [tool.taylor-verify.settings]
# rtol = 1e-9
# atol = "rtol"
# ///
"""diffrax: Runge-Kutta methods in JAX, the whole propagation compiled by XLA, in float64 or float32.

The states at the samples are diffrax's interpolants. Steps are counted with those rejected;
evaluations are not counted by diffrax.
"""

from __future__ import annotations

from functools import cache
from typing import Any

from question import (
    Question,
    Settings,
    Solved,
    answer,
    equations_of,
    once_for_equations,
    twice,
)

METHODS = {"tsit5": "Tsit5", "dopri8": "Dopri8"}
DOUBLE_BITS = 53


def solve(question: Question, settings: Settings) -> Solved:
    import jax

    jax.config.update("jax_enable_x64", question.bits == DOUBLE_BITS)
    import diffrax
    import jax.numpy as jnp

    compiled = _compiled(question)(settings.method)
    numbers = (question.state, question.instants, question.parameters)
    given = [jnp.array(v) for v in (*numbers, settings.rtol, settings.atol)]

    def propagate() -> Any:
        return jax.block_until_ready(compiled(*given))

    solution, seconds, compiling = twice(propagate)
    if solution.result != diffrax.RESULTS.successful:
        raise SystemExit(f"diffrax: {solution.result}")
    steps = int(solution.stats["num_steps"])
    return Solved(
        solution.ys.tolist(),
        steps,
        evaluations=0,
        seconds=seconds,
        compile_seconds=compiling,
        again=propagate,
    )


@once_for_equations
def _compiled(question: Question) -> Any:
    """Return the propagation by method; the tolerances are arguments, so that one code serves all."""
    import diffrax
    import jax
    import jax.numpy as jnp

    f, sign = equations_of(question), question.sign

    def field(t: Any, state: Any, parameters: Any) -> Any:
        return sign * jnp.stack([jnp.asarray(v, state.dtype) for v in f(state, parameters)])

    @cache
    def by(method: str) -> Any:
        def propagated(start: Any, instants: Any, parameters: Any, rtol: Any, atol: Any) -> Any:
            return diffrax.diffeqsolve(
                diffrax.ODETerm(field),
                getattr(diffrax, METHODS[method])(),
                t0=0.0,
                t1=instants[-1],
                dt0=None,
                y0=start,
                args=parameters,
                saveat=diffrax.SaveAt(ts=instants),
                stepsize_controller=diffrax.PIDController(rtol=rtol, atol=atol),
                max_steps=None,
                throw=False,
            )

        return jax.jit(propagated)

    return by


if __name__ == "__main__":
    answer(solve)
