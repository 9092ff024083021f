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

from typing import Any

from equations import rates
from question import Question, Settings, Solved, answer, twice

METHODS = {"tsit5": "Tsit5", "dopri8": "Dopri8"}
DOUBLE_BITS = 53


def solve(question: Question, settings: Settings) -> Solved:
    import jax

    jax.config.update("jax_enable_x64", question.bits == DOUBLE_BITS)
    import diffrax
    import jax.numpy as jnp

    f, sign = rates(question.columns), question.sign

    def field(t: Any, state: Any, parameters: Any) -> Any:
        return sign * jnp.stack(f(state, parameters))

    def propagated(start: Any, instants: Any, parameters: Any) -> Any:
        return diffrax.diffeqsolve(
            diffrax.ODETerm(field),
            getattr(diffrax, METHODS[settings.method])(),
            t0=0.0,
            t1=question.end,
            dt0=None,
            y0=start,
            args=parameters,
            saveat=diffrax.SaveAt(ts=instants),
            stepsize_controller=diffrax.PIDController(rtol=settings.rtol, atol=settings.atol),
            max_steps=None,
            throw=False,
        )

    compiled = jax.jit(propagated)
    given = [jnp.array(v) for v in (question.state, question.instants, question.parameters)]
    found, seconds, compiling = twice(lambda: jax.block_until_ready(compiled(*given)))
    if found.result != diffrax.RESULTS.successful:
        raise SystemExit(f"diffrax: {found.result}")
    return Solved(found.ys.tolist(), int(found.stats["num_steps"]), 0, seconds, compiling)


if __name__ == "__main__":
    answer(solve)
