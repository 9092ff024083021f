# /// script
# requires-python = ">=3.9"
# dependencies = ["codac==2.1.2"]
# ///
"""Enclose motions by codac's Lohner contractor: examples as JSON on stdin, boxes as JSON on stdout."""

import json
import sys
import time

import codac


def enclosed(names, rates, start, end, step):
    """Return the lower and upper ends at the last time, and the processor time."""
    state = codac.VectorVar(len(names))
    known = {name: state[k] for k, name in enumerate(names)}
    known |= {"sqr": codac.sqr, "sqrt": codac.sqrt, "sin": codac.sin}
    rule = codac.AnalyticFunction([state], codac.vec(*(eval(rate, known) for rate in rates)))
    began = time.process_time()
    times = codac.create_tdomain([0, end], step, True)
    tube = codac.SlicedTube(times, codac.IntervalVector(len(names)))
    tube.set(codac.IntervalVector([[number, number] for number in start]), 0.0)
    codac.CtcLohner(rule).contract(tube)
    box = tube(end)
    seconds = time.process_time() - began
    return [[float(side.lb()), float(side.ub())] for side in box], seconds


json.dump([enclosed(**example) for example in json.load(sys.stdin)], sys.stdout)
