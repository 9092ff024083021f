"""The equations of a form as heyoka's expressions."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from taylor_verify.models.algebra import is_absent
from taylor_verify.models.form import Form


def equations(form: Form, coefficients: Sequence[Any]) -> list[tuple[Any, Any]]:
    """Return the states of a form as heyoka's variables, each with its rate."""
    import heyoka as hy

    states = hy.make_vars(*form.states)
    rates = form.rates(states, coefficients, hy.time)
    return [
        (state, hy.expression(0.0) if is_absent(rate) else rate)
        for state, rate in zip(states, rates, strict=True)
    ]
