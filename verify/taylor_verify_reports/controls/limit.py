"""Answers on the edge of a gate: their error is the bound, plus or minus one ulp.

The error is put along the orbit, omega' = K (H x omega), so that no conserved quantity changes to
first order: the gate of the state alone is on its edge.
"""

from __future__ import annotations

from dataclasses import replace
from math import inf, nextafter
from typing import final

import numpy as np
from mpmath import mp

from taylor_verify.exact.route import solution
from taylor_verify.judge.errors.state import state_errors
from taylor_verify.judge.floor.arithmetic import truth_digits, working_bits
from taylor_verify.judge.judgement import judgement
from taylor_verify.models.problem import Problem
from taylor_verify.scenes.bodies import RigidBody
from taylor_verify.solvers.solver import Solver
from taylor_verify.solvers.taylor.driver import Taylor
from taylor_verify.solvers.trajectory import Trajectory

# An error of this size makes its sample the worst, so that the verdict has the bound of that sample.
_CONSPICUOUS = 1e-6


def just_over(problem: Problem, sound: Trajectory) -> Trajectory:
    """Return the answer with an error in the middle omega of one ulp more than the bound."""
    return _moved(problem, sound, nextafter(_bound(problem, sound), inf))


@final
class JustWithin(Solver):
    """The sound twin: its error is one ulp less than the bound."""

    name = "taylor"
    setting = "an ulp within"

    def solve(self, problem: Problem) -> Trajectory:
        sound = Taylor().solve(problem)
        return _moved(problem, sound, nextafter(_bound(problem, sound), 0.0))


def _bound(problem: Problem, sound: Trajectory) -> float:
    """Return the bound at the middle sample, from the verdict on an answer that is plainly wrong there."""
    (_, omega, *_) = judgement(problem, Taylor(), _moved(problem, sound, _CONSPICUOUS)).verdicts
    assert omega.bound is not None
    return omega.bound


def _moved(problem: Problem, sound: Trajectory, error: float) -> Trajectory:
    """Return the answer with this error in omega at the middle sample, relative to max |omega|."""
    given, bits = problem.given, problem.rung.bits
    middle = len(problem.times) // 2
    truth = solution(given).motion(given.clock.elapsed, truth_digits(bits))
    assert isinstance(given.body, RigidBody)
    with mp.workprec(working_bits(bits)):
        (compared, *_) = state_errors(given, truth, sound.motion(working_bits(bits)))
        omega = truth["omega"][middle]
        I, K = (
            np.array([[mp.convert(entry) for entry in row] for row in matrix], dtype=object)
            for matrix in (given.body.inertia, given.body.inverse_inertia)
        )
        along = K @ np.cross(I @ omega, omega)
        rows = sound.quantities["omega"].copy()
        rows[middle] = omega + along * (error * compared.parts["omega"] / mp.norm(list(along)))
    return replace(sound, quantities={**sound.quantities, "omega": rows})
