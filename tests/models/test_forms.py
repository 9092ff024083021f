"""The equations chosen for a body: exactly its own, and with nothing in them that it does not need."""

import pickle
from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction
from itertools import product
from random import Random
from typing import Any

import numpy as np
import pytest
from builders.scenes import one_instant, tracking_all, vector
from builders.turns import by_turns
from hypothesis import given, settings
from hypothesis import strategies as st

from taylor_verify.models.euler import PrincipalEuler, TensorEuler
from taylor_verify.models.fastest_rate import Linearised
from taylor_verify.models.form import Form
from taylor_verify.models.general import in_general_form, whole_form
from taylor_verify.models.immersed import axis_of_symmetry
from taylor_verify.models.kirchhoff import (
    CLEBSCH_NAMES,
    ClebschAbout,
    clebsch_equations,
    kirchhoff_equations,
)
from taylor_verify.models.problem import Problem, pose
from taylor_verify.numbers import tensors
from taylor_verify.numbers.precision import rung
from taylor_verify.scenes.bodies import Clebsch, ImmersedBody, RigidBody
from taylor_verify.scenes.library import names
from taylor_verify.scenes.motion import Impulse, Spin
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene

SCENES = [name for name in names() if name.startswith(("euler/", "kirchhoff/"))]
LOAD = (Fraction(1, 3), Fraction(-1, 7), Fraction(2))


def spinning(inertia: tensors.Matrix, moment: tuple[Fraction, ...] = vector(0, 0, 0)) -> Scene:
    return one_instant(RigidBody(inertia, moment), Spin(vector("0.3", 1, "-0.7")))


def immersed(body: ImmersedBody) -> Scene:
    return one_instant(body, Impulse(vector(1, "0.3", "-0.6"), vector("0.2", 1, "0.9")))


def about(axis: int, clebsch: Clebsch) -> ImmersedBody:
    """Clebsch's body with its axis along another body axis."""
    body = clebsch.body()
    order = [(axis + k) % 3 for k in range(3)]

    def turned(matrix: tensors.Matrix) -> tensors.Matrix:
        place = [order.index(i) for i in range(3)]
        return tuple(tuple(matrix[i][j] for j in place) for i in place)

    return ImmersedBody(turned(body.linear), turned(body.coupling), turned(body.angular))


def rates_at(problem: Problem, state: Mapping[str, Fraction]) -> dict[str, Any]:
    """Rates by name in rationals; a name that is no state has its value from the problem."""
    form = problem.form
    parameters = [state.get(n, problem.parameter[n]) for n in form.parameters]
    rates = form.rates([state[n] for n in form.states], parameters)
    return dict(zip(form.states, rates, strict=True))


def assert_same_equations(problem: Problem, seed: int) -> None:
    """At random points the chosen rates are the general ones, and what is no state has rate 0."""
    random, general = Random(seed), in_general_form(problem)
    for _ in range(4):
        state = {n: Fraction(random.randint(-99, 99), 8) for n in general.form.states}
        constants = {n: problem.parameter.get(n, Fraction(0)) for n in state}
        state |= {n: constants[n] for n in state if n not in problem.form.states}
        chosen, full = rates_at(problem, state), rates_at(general, state)
        assert full == {n: chosen.get(n, 0) for n in full}


# Every body is posed on one rung, and some on a second one.
@pytest.mark.parametrize(
    ("name", "rung_name"),
    by_turns(product(SCENES, ["f64", "f32", "mp237"]), 24, lambda name, rung_name: name),
)
def test_chosen_equations_are_the_general_ones(name: str, rung_name: str) -> None:
    """In rationals, whatever was left out or put together, of every shipped body on three rungs."""
    for scene in (load(name), tracking_all(load(name))):
        assert_same_equations(pose(scene, rung(rung_name)), seed=len(name))


@settings(max_examples=30)
@given(
    k=st.lists(st.fractions("0.01", 100, max_denominator=1000), min_size=3, max_size=3),
    equal=st.booleans(),
    loaded=st.booleans(),
)
def test_principal_equations_of_any_body(k: list[Fraction], equal: bool, loaded: bool) -> None:
    """Three moments, two of them perhaps equal, under a moment or free: H x K H + M to the last bit."""
    inertia = tensors.diagonal((k[0], k[0] if equal else k[1], k[2]))
    scene = spinning(inertia, LOAD if loaded else vector(0, 0, 0))
    for name in ("f32", "f64"):
        assert_same_equations(pose(tracking_all(scene), rung(name)), seed=1)


@settings(max_examples=30)
@given(
    st.lists(st.fractions(-1, 1, max_denominator=50), min_size=3, max_size=3),
    st.lists(st.fractions(4, 9, max_denominator=50), min_size=3, max_size=3),
)
def test_tensor_equations_of_any_body(products: list[Fraction], moments: list[Fraction]) -> None:
    """A sphere that is taken away from the tensor takes no motion with it."""
    (a, b, c), (d, e, f) = products, moments
    scene = spinning(((d, a, b), (a, e, c), (b, c, f)))
    assert_same_equations(pose(tracking_all(scene), rung("f64")), seed=2)


@pytest.mark.parametrize(
    ("moments", "expected"),
    [
        # K = 1, 3/4, 5/8: all differences are short. K = 1, 1/2, 1/3: 1 - 1/3 has 54 bits.
        ((1, "4/3", "8/5"), PrincipalEuler()),
        ((1, 2, 3), PrincipalEuler(summed=2)),
        # K = 1, 1/3, 1/1000: of 53 bits each, and far apart: no difference but one has 53.
        ((1, 3, 1000), PrincipalEuler(formed=(1, 2, 3))),
    ],
)
def test_differences_are_coefficients_where_the_rung_holds_them(
    moments: tuple[object, ...], expected: PrincipalEuler
) -> None:
    """Decided on the rounded numbers themselves: held, minus the sum of two held, or formed."""
    problem = pose(spinning(tensors.diagonal(vector(*moments))), rung("f64"))
    if expected.formed:
        assert problem.form.equations.formed
    else:
        assert problem.form.equations == expected
    coefficients = [problem.parameter[n] for n in problem.form.parameters]
    assert all(problem.rung.holds(value) for value in coefficients)
    assert_same_equations(problem, seed=3)


def test_axisymmetric_and_spherical_bodies_lose_their_terms() -> None:
    """K11 = K22 leaves H3 without a term, and a sphere leaves nothing: H' = 0."""
    two = pose(spinning(tensors.diagonal(vector(3, 3, 5))), rung("f64")).form
    assert two.text()[2] == "H3' = 0"
    assert two.operations()["products"] == 4
    sphere = pose(spinning(tensors.diagonal(vector(3, 3, 3))), rung("f64")).form
    assert sphere.parameters == ()
    assert sphere.operations() == {"sums": 0, "products": 0, "quotients": 0}


@pytest.mark.parametrize("axis", [1, 2, 3])
@pytest.mark.parametrize("loaded", [False, True])
def test_clebschs_equations_about_any_axis(axis: int, loaded: bool) -> None:
    """A body of revolution about axis 1 or 2 has Clebsch's equations too, and its own constant y."""
    body = about(axis, Clebsch(*vector(2, 3, "1/2", "-1/3", 1, "5/4")))
    if loaded:
        body = replace(body, force=LOAD, couple=LOAD)
    problem = pose(tracking_all(immersed(body)), rung("f64"))
    expected = clebsch_equations if axis == 3 else ClebschAbout(axis)
    assert problem.form.equations == expected
    assert (f"y{axis}" in problem.form.states) == loaded
    assert_same_equations(problem, seed=axis)


@pytest.mark.parametrize("equal", ["p", "q", "r", "pq", "pqr"])
def test_equal_coefficients_cancel_before_they_are_computed(equal: str) -> None:
    """Where p' = p, q' = q or r' = r the difference is no term; where all are, y is constant."""
    six = dict(zip("pqr", vector(3, "1/5", 2), strict=True))
    primed = {n: six[n] * (1 if n in equal else Fraction(3, 4)) for n in six}
    clebsch = Clebsch(six["p"], primed["p"], six["q"], primed["q"], six["r"], primed["r"])
    problem = pose(tracking_all(immersed(clebsch.body())), rung("f64"))
    general = in_general_form(problem).form
    states = tuple(name for name in general.states if name != "y3")
    plain = Form(clebsch_equations, states, ("y3", *CLEBSCH_NAMES))
    assert problem.form.equations == ClebschAbout(3, tuple(equal))
    assert problem.form.operations()["products"] < plain.operations()["products"]
    assert ("y1" in problem.form.states) == (equal != "pqr")
    assert_same_equations(problem, seed=5)


@pytest.mark.parametrize(
    ("six", "expected"),
    [
        # Neighbours have a short difference. That of 0.3 and 1.1 would take 54 bits.
        ((1, "1.5", "0.25", "0.3", "0.9", "1.1"), {"D1", "D2", "D3"}),
        ((1, "1.5", "0.25", "0.3", "1.1", "0.3"), {"D1", "D2"}),
    ],
)
def test_differences_of_clebschs_coefficients_where_the_rung_holds_them(
    six: tuple[object, ...], expected: set[str]
) -> None:
    """p' - p, q' - q and r' - r are parameters if they are numbers of the rung, and else formed."""
    alone = immersed(Clebsch(*vector(*six)).body())
    for scene in (alone, tracking_all(alone)):
        problem = pose(scene, rung("f64"))
        assert {n for n in problem.form.parameters if n[0] == "D"} == expected
        assert_same_equations(problem, seed=4)
    # Without its frame p and q stand in differences alone.
    assert {"p", "p'", "q", "q'"}.isdisjoint(pose(alone, rung("f64")).form.parameters)


def test_almost_of_revolution_is_not_of_revolution() -> None:
    """One unit in the last place of one coefficient, and the body takes the general equations."""
    body = Clebsch(*vector(2, 3, "1/2", "-1/4", 1, "5/4")).body()
    linear = [list(row) for row in body.linear]
    linear[1][1] += Fraction(1, 2**50)
    off = replace(body, linear=tuple(map(tuple, linear)))
    assert pose(immersed(off), rung("f64")).form.equations is kirchhoff_equations
    # On a coarser rung the same two numbers are one.
    assert pose(immersed(off), rung("f32")).form.equations is clebsch_equations


def test_axis_of_symmetry_wants_every_matrix() -> None:
    """A, B and C must all be of revolution, and about the same axis."""
    problem = in_general_form(
        pose(immersed(about(1, Clebsch(*vector(2, 3, 0, 0, 1, 4)))), rung("f64"))
    )
    numbers = {f"{m}{i}{j}": Fraction(0) for m in "ABC" for i in (1, 2, 3) for j in (1, 2, 3)}
    numbers |= problem.parameter
    assert axis_of_symmetry(numbers) == 1
    assert axis_of_symmetry(numbers | {"C22": Fraction(5)}) is None
    assert axis_of_symmetry(numbers | {"B13": Fraction(1)}) is None


@pytest.mark.parametrize("name", SCENES)
def test_nothing_is_carried_along(name: str) -> None:
    """No parameter is zero, each one enters, no impulse that is a state is constant."""
    form = (problem := pose(load(name), rung("f64"))).form
    assert all(problem.parameters)
    assert form.entering() == form.parameters
    assert form.constants() == ()
    general = in_general_form(problem).form
    assert len(form.states) <= len(general.states) <= len(whole_form(problem.given.body).states)


def test_full_tensor_takes_a_sphere_away() -> None:
    """The tensor's form has five coefficients where K has six, and says so."""
    problem = pose(load("euler/full-tensor"), rung("f64"))
    assert problem.form.equations == TensorEuler()
    assert set(problem.form.parameters) == {"D11", "D22", "K12", "K13", "K23"}
    assert any("multiple of the unit matrix" in sentence for sentence in problem.because)


def fourth_root(J: np.ndarray) -> float:
    """A bound of the spectral radius by two squarings, |J^4|^(1/4); |A| is n times its largest entry."""
    size = len(J) * np.max(abs(np.linalg.matrix_power(J, 4)))
    return float(size**0.25)


@pytest.mark.parametrize("name", by_turns(SCENES))
def test_fastest_rate_is_a_close_bound_of_the_spectral_radius(name: str) -> None:
    """At random states it is at least that of the Jacobian by central differences, attitude and all.

    And at most a third more; that of all of them is the largest.
    """
    problem = pose(tracking_all(load(name)), rung("f64"))
    linearised, random = Linearised(problem), np.random.default_rng(len(name))
    moving = [i for i, n in enumerate(problem.form.states) if n[0] != "c"]
    parameters = [float(value) for value in problem.parameters]
    states = random.normal(size=(3, len(problem.form.states)))
    for state in states:

        def rates(at: np.ndarray) -> np.ndarray:
            derivatives = problem.form.rates(list(at), parameters)
            return np.array([float(derivatives[i]) for i in moving])

        ends = [(rates(state + e) - rates(state - e)) / 2 for e in np.eye(len(state))[moving]]
        radius = abs(np.linalg.eigvals(np.array(ends).T)).max()
        expected = max(radius, 2.0**-10)
        # Double eigenvalues are known to half the digits: 1e-8 of the largest.
        assert (1 - 1e-6) * expected <= linearised.fastest(state) <= 1.35 * expected
        assert linearised.fastest(state) <= (1 + 1e-6) * max(
            expected, fourth_root(np.array(ends).T)
        )
    each = [linearised.fastest(state) for state in states]
    assert max(each) <= linearised.fastest(states) * (1 + 1e-12)


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_rate_that_is_not_finite_is_infinite(bad: float) -> None:
    """A state that is no number has no step: the rate is infinite, whatever the equations."""
    for name in ("euler/generic", "euler/with-attitude", "kirchhoff/screw"):
        problem = pose(load(name), rung("f64"))
        state = [bad, *[1.0] * (len(problem.initial_momenta) - 1)]
        assert Linearised(problem).fastest(state) == np.inf


def test_equations_under_loads_take_no_hash_to_another_process() -> None:
    """Texts have other hashes there, so that a table would not find them."""
    form = pose(load("loads/heavy-top"), rung("f64")).form
    number = hash(form)
    again = pickle.loads(pickle.dumps(form))
    assert "_hash" not in vars(again.equations)
    assert again == form
    assert hash(again) == number
