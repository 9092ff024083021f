"""A plug-in of each kind."""

from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np

from taylor_verify.cli.answer import Answer

SCENES = Path(__file__).parent / "scenes"
ENGINE = Path(__file__).parent / "with_still.py"
suffixes = (".rows",)
help = "greet"


def solve(problem):
    """Answer a body of revolution about axis 3, whose omega precesses."""
    body, (p, q, r) = problem.given.body, map(float, problem.given.initial.omega)
    rate = float((body.inertia[2][2] - body.inertia[0][0]) / body.inertia[0][0]) * r
    t = np.array([float(t) for t in problem.given.clock.elapsed])
    c, s = np.cos(rate * t), np.sin(rate * t)
    return np.array([c * p - s * q, s * p + c * q, 0 * t + r]).T


def read(path):
    names, *rows = (line.split() for line in path.read_text().splitlines())
    return dict(zip(names, zip(*rows, strict=True), strict=True))


def candidates(scene, answer):
    jet = (Fraction(0), Fraction(0), Fraction(1, 64))
    yield replace(scene, title="the jet was on", body=replace(scene.body, moment=jet))


def add(parser):
    parser.add_argument("name")


def run(arguments):
    return Answer(0, {"hello": arguments.name}, lambda: f"hello {arguments.name}")
