"""A stored trade-off: eleven points of a scene, with their times."""

from __future__ import annotations

import re
from math import log10
from typing import Any

from taylor_verify.records.provenance import Machine
from taylor_verify.records.standing import Standing
from taylor_verify.tradeoff.document import TradePoint
from taylor_verify_reports.studies.tradeoff.trades import (
    TimingMethod,
    TradeNumbers,
    TradeScene,
    TradeTiming,
    TradeTimings,
)


def point(solver: str, error: float | None, **changed: Any) -> TradePoint:
    """A point as it is stored, without times."""
    family = solver.partition("?")[0].replace(":", " ")
    rung = changed.get("rung", "f64")
    tolerance = re.search(r"tol=([^&]*)", solver)
    row = {
        "scene": "euler/generic",
        "solver": solver,
        "setting": "",
        "rung": rung,
        "family": f"taylor {rung}" if family == "taylor" else family,
        "asked": "tolerance" if tolerance else "",
        "requested": float(tolerance[1]) if tolerance else None,
        "requested_digits": None,
        "achieved_digits": None if not error else round(-log10(error), 6),
        "error": error,
        "max": {},
        "final": {},
        "drift": 1e-15,
        "drifting": "T",
        "steps": 7,
        "evaluations": 70,
        "outcome": "reached the last sample",
        "standing": Standing.SOUND,
        "because": "",
    }
    return TradePoint(**(row | changed))


POINTS = (
    point("taylor?tol=1e-6", 1e-7),
    point("taylor", 1e-14),
    point("taylor", 1e-32, rung="f128"),
    point("scipy:DOP853?rtol=1e-6&atol=1e-6", 1e-5),
    point("scipy:DOP853?rtol=1e-9&atol=1e-9", 1e-8),
    point("scipy:RK45?rtol=1e-9&atol=1e-9", 1e-7),
    point(
        "scipy:RK45?rtol=1e-3&atol=1e-3",
        1.5,
        standing=Standing.FALSE,
        because="it claims success with an error of 1.5, the size | of the motion",
    ),
    point("geometric:splitting?step=1/4", 1e-3, asked="step", requested=0.25),
    point("outside:cvode-bdf?rtol=1e-9&atol=1e-9", 1e-10),
    point("mpmath:odefun", None, standing=Standing.NOT_RUN, because="it would take minutes"),
)


# By solver and rung: ratio to the yardstick.
RATIOS = {
    ("taylor?tol=1e-6", "f64"): 0.8,
    ("taylor", "f64"): 1.0,
    ("taylor", "f128"): 40.0,
    ("scipy:DOP853?rtol=1e-6&atol=1e-6", "f64"): 6.0,
    ("scipy:DOP853?rtol=1e-9&atol=1e-9", "f64"): 12.0,
    ("scipy:RK45?rtol=1e-9&atol=1e-9", "f64"): 30.0,
    ("geometric:splitting?step=1/4", "f64"): 2.0,
    ("outside:cvode-bdf?rtol=1e-9&atol=1e-9", "f64"): 0.9,
}

SCENE = TradeScene("euler/generic", "A body", ("omega",), "0")

NUMBERS_MADE = TradeNumbers(
    versions={"heyoka": "7.13.0"},
    yardstick="taylor f64",
    scenes=(SCENE,),
    points=POINTS,
)

TIMES_MADE = TradeTimings(
    machine=Machine(python="3.11.7", processor="A chip", command="taylor-verify publish"),
    method=TimingMethod(
        processes=6,
        rounds=3,
        seed=1,
        least_seconds=2e-3,
        times_resolution=100,
        clock_resolution=5e-8,
        confidence=0.95,
        coverage=0.96875,
        formula="1 - 2 sum_{i<k} C(n, i)/2^n",
        of="the propagation",
    ),
    timings=tuple(
        TradeTiming(
            scene="euler/generic",
            solver=solver,
            rung=rung,
            seconds=ratio / 500,
            inner_seconds=0.001 if solver == "taylor" else None,
            ratio=ratio,
            low=ratio * 0.9,
            high=ratio * 1.2,
            processes=6,
        )
        for (solver, rung), ratio in RATIOS.items()
    ),
)
