"""What is told of a scene: the terms of its written loads and their work, and tops in disguise."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from builders.scenes import one_instant, vector
from builders.written_loads import ABOUT_AXES, euler, kirchhoff
from mpmath import mp

from taylor_verify import explain
from taylor_verify.cli import main
from taylor_verify.exact.elements import Elements, elements
from taylor_verify.exact.invariants import invariants
from taylor_verify.exact.kirchhoff.solid import solid, velocities
from taylor_verify.exact.route import solution
from taylor_verify.explain.loads import conserved, operations, summands, terms
from taylor_verify.judge.load_notes import NOTHING_CONSERVED
from taylor_verify.models.problem import pose
from taylor_verify.numbers import tensors
from taylor_verify.numbers.precision import rung
from taylor_verify.scenes.bodies import ImmersedBody, RigidBody
from taylor_verify.scenes.motion import Impulse, Spin
from taylor_verify.scenes.scene import Scene

HANGING = 'weight = { force = [1, 2, -2], at = [0, 0, "1/4"] }'
HEAVY = kirchhoff(["0", "0", "0"], ["-w1/5 - w2*r33/9", "0", "sin(t)/8"], "1/2", more=HANGING)
# The rule of the trapezium over some hundred times.
WORK_DIGITS = 1e-5


@pytest.fixture(scope="module")
def document() -> dict[str, Any]:
    return explain(HEAVY)


def energy(scene: Scene, elapsed: Fraction) -> float:
    """T of the exact motion."""
    (kinetic,) = (each for each in invariants(scene) if each.name == "T")
    return float(kinetic.value(solution(scene).motion([elapsed], 20))[0])


def test_the_work_of_all_terms_is_the_change_of_the_energy(document: dict[str, Any]) -> None:
    """T at the end is T at the start and the work of weight, drag and motor."""
    loads, given = document["loads"], pose(HEAVY, rung("f64")).given
    change = energy(given, given.clock.elapsed[-1]) - energy(given, Fraction(0))
    assert loads["work"] == pytest.approx(change, rel=WORK_DIGITS)
    assert sum(term["work"] for term in loads["terms"]) == pytest.approx(loads["work"], rel=1e-12)


def test_the_size_of_a_weight_is_its_force(document: dict[str, Any]) -> None:
    """A force that is constant in space has one size in every attitude."""
    weight, *_ = document["loads"]["terms"]
    assert weight["force"]["largest"] == pytest.approx(3.0, rel=1e-12)
    assert weight["force"]["mean"] == pytest.approx(3.0, rel=1e-12)
    assert 0 < weight["couple"]["largest"] <= 3 / 4


def test_each_summand_is_a_term_with_its_operations(document: dict[str, Any]) -> None:
    """Terms are the weight and the summands of the texts, priced by what they compute."""
    rows = [(term["place"], term["text"]) for term in document["loads"]["terms"]]
    assert rows[1:] == [
        ("couple[0]", "-w1/5"),
        ("couple[0]", "-w2*r33/9"),
        ("couple[2]", "sin(t)/8"),
    ]
    assert all(term["seconds"] > 0 for term in document["loads"]["terms"])
    *_, (_, _, motor) = terms(HEAVY.body.loads)
    assert operations(motor) == {"sums": 1, "products": 0, "quotients": 1, "functions": 1}


def test_what_is_conserved_is_said_with_its_potential() -> None:
    """T + V has its V; what the scene does not track is not gated, and nothing is said to be nothing."""
    top = euler(["r32/3", "-r31/3", "0"])
    heavy = "T + V = constant, V = 1/3 r33"
    along = "H_space . n = constant, n = (0, 0, 1)"
    assert explain(top)["loads"]["conserved"] == [heavy, along]
    level = "x_space . n = constant, n = (-2, 1, 0) and (2/5, 4/5, 1)"
    assert list(conserved(HEAVY)) == [level]
    assert list(conserved(euler(["-w1/3", "0", "sin(t)"]))) == [NOTHING_CONSERVED]


def test_the_verb_prints_the_terms(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The text has what is conserved, and each term with its size, its work and its operations."""
    file = tmp_path / "top.toml"
    moment = '["r32/3", "-r31/3", "sin(t)/8"]'
    file.write_text(ABOUT_AXES.format(moment=moment, omega="[0, 0.5, 1]", end="1"), "utf-8")
    assert main(["explain", str(file)]) == 0
    text = capsys.readouterr().out
    assert NOTHING_CONSERVED in " ".join(text.split())
    for words in ("moment[0]  r32/3", "at most (t =", "work until the end", "1 functions"):
        assert words in text


@pytest.mark.parametrize(
    ("text", "parts"),
    [
        ("a - b + c", ["a", "-b", "c"]),
        ("-(a - b)", ["-(a - b)"]),
        ("a - (b - c^2)", ["a", "-b", "c**2"]),
        ("1 if t < 2 else 3 - t", ["1 if t < 2 else 3 - t"]),
        ("a - (1 if t < 2 else 3)", ["a", "-(1 if t < 2 else 3)"]),
        ("a - -b*2", ["a", "--b*2"]),
    ],
)
def test_a_text_is_split_at_its_own_signs(text: str, parts: list[str]) -> None:
    """Signs within brackets are carried out, those within functions and conditions are not."""
    assert summands(text) == parts


# Tops in disguise

X, Y = vector("0.5", "0.2", "0.3"), vector("0.3", "0.5", 1)


def immersed(b: Fraction, x: tensors.Vector = X) -> Scene:
    """A free solid with A = 2 and B = b, of three different moments."""
    one = vector(1, 1, 1)
    A, B = (tensors.diagonal(tensors.scaled(Fraction(k), one)) for k in (2, b))
    body = ImmersedBody(A, B, tensors.diagonal(vector(1, 2, 3)))
    return one_instant(body, Impulse(x, Y))


def story_of(orbit: Elements) -> str:
    return " ".join(orbit.sentences)


@pytest.mark.parametrize("b", [Fraction(0), Fraction(1, 2)])
def test_what_recurs_in_a_top_of_a_solid_is_named(b: Fraction) -> None:
    """After the period y and C y are those of the start, and x is not; Omega is only where b is 0."""
    scene = immersed(b)
    body, _ = solid(scene)
    orbit = elements(scene, 30)
    period = Fraction(mp.nstr(orbit["period"].value, 30))
    rows = solution(scene).motion([Fraction(0), period], 25).quantities
    x, y = (rows[f"{name}_impulse"].astype(float) for name in ("linear", "angular"))
    Omega = x @ np.array(body.coupling, float) + y @ np.array(body.angular, float)
    recurs = {
        name: bool(np.abs(vectors[1] - vectors[0]).max() <= 1e-12)
        for name, vectors in (("x", x), ("y", y), ("Omega", Omega))
    }
    assert recurs == {"x": False, "y": True, "Omega": not b}
    assert orbit["period"].meaning == "of the top: omega recurs in body axes"
    if b:
        assert "C y as its omega" in story_of(orbit)
        assert "x and Omega = b x + C y need not recur" in story_of(orbit)
    else:
        assert "Omega = C y as its omega" in story_of(orbit)
        assert "does: x need not recur" in story_of(orbit)


def test_without_linear_impulse_omega_is_that_of_the_top() -> None:
    """Where x is 0 a multiple in B turns nothing, and no x is spoken of."""
    scene = immersed(Fraction(1, 2), vector(0, 0, 0))
    body, start = solid(scene)
    assert velocities(body, start)[1] == tensors.apply(body.angular, start.angular)
    orbit = elements(scene, 20)
    assert "Omega = C y as its omega" in story_of(orbit)
    assert "need not recur" not in story_of(orbit)


def test_a_body_whose_wheels_cancel_its_momentum_has_one_steady_spin() -> None:
    """H = I omega + h = 0 is a steady spin itself, and stable; no other spin has |H| = 0."""
    omega = vector("1/2", "1/4", "1/3")
    inertia = tensors.diagonal(vector(1, 2, 3))
    rotor = tensors.scaled(Fraction(-1), tensors.apply(inertia, omega))
    orbit = elements(one_instant(RigidBody(inertia, rotor=rotor), Spin(omega)), 20)
    assert orbit.regime == "steady"
    assert orbit["H2"].value == 0
    assert not [name for name in orbit if name.startswith("spin_")]
    assert "With H = 0 there is one steady spin, this motion. It is stable" in story_of(orbit)
    assert "0 steady spins" not in story_of(orbit)
    assert "H is along omega" not in story_of(orbit)
