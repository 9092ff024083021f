"""The explanation of written loads: their terms, what they conserve, and the work that they do."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest
from builders.written_loads import ABOUT_AXES, euler, kirchhoff

from taylor_verify import explain
from taylor_verify.cli import main
from taylor_verify.exact.invariants import invariants
from taylor_verify.exact.route import solution
from taylor_verify.explain.loads import conserved, operations, summands, terms
from taylor_verify.judge.load_notes import NOTHING_CONSERVED
from taylor_verify.models.problem import pose
from taylor_verify.numbers.precision import rung
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
