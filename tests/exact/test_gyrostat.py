"""The free gyrostat: its closed form against the enclosure and the equations themselves."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

import pytest
from builders.free_spins import OBLIQUE, rotation
from builders.numbers import apart
from builders.scenes import TENSOR, one_instant, vector
from builders.turns import by_turns
from hypothesis import example, given, settings
from hypothesis import strategies as st
from mpmath import mp, mpf

from taylor_verify.exact.elements import elements
from taylor_verify.exact.euler.closed import enclosed
from taylor_verify.exact.gyrostat.pencil import FreeGyrostat, Regime
from taylor_verify.exact.gyrostat.spins import steady_spins
from taylor_verify.exact.taylor import TaylorSolution
from taylor_verify.numbers import tensors
from taylor_verify.numbers.tensors import Matrix, Vector
from taylor_verify.scenes.bodies import RigidBody
from taylor_verify.scenes.motion import Quaternion, Spin
from taylor_verify.scenes.scene import Scene

DIGITS = 30
TINY = Fraction(1, 10**30)
INSTANTS = (Fraction(0), Fraction(7, 10), Fraction(-1), Fraction(5))

# Neither of unit length nor with a rational norm.
TILTED: Quaternion = (Fraction(1), Fraction(2), Fraction(-1), Fraction(3))
ROTOR, OMEGA = vector("0.3", "-0.2", "0.5"), vector(1, "0.4", "0.3")
TRIAXIAL = tensors.diagonal(vector(1, 2, 3))


def turned(free: FreeGyrostat, matrix: Matrix = OBLIQUE) -> FreeGyrostat:
    """Return the motion in axes turned by an orthogonal matrix."""
    inertia = tensors.product(tensors.product(matrix, free.inertia), tensors.transpose(matrix))
    rotor, omega = (tensors.apply(matrix, v) for v in (free.rotor, free.omega))
    return FreeGyrostat(inertia, rotor, omega)


def homoclinic(inertia: Matrix, saddle: Vector, direction: Vector) -> FreeGyrostat:
    """A start whose curve has the double point ``saddle``, exactly: the reflection of it.

    With mu = d.K d/d.d and g = (K - mu) G*, G* is a steady spin, and the line from G* along d meets both
    quadrics once more at the start.
    """
    K = tensors.inverse(inertia)
    size = tensors.dot(direction, direction)
    mu = tensors.dot(direction, tensors.apply(K, direction)) / size
    g = tensors.minus(tensors.apply(K, saddle), tensors.scaled(mu, saddle))
    along = 2 * tensors.dot(saddle, direction) / size
    start = tensors.minus(saddle, tensors.scaled(along, direction))
    omega = tensors.minus(tensors.apply(K, start), g)
    return FreeGyrostat(inertia, tensors.apply(inertia, g), omega)


def on_circle(g1: Fraction, g3: Fraction, away: Fraction) -> FreeGyrostat:
    """A start on a pair of planes: I^-1 = (3, 2, 1) and no wheel along the middle axis."""
    K = vector(3, 2, 1)
    momentum, g = (g1 + away, Fraction(1), away - g3), (g1, Fraction(0), g3)
    inertia = tensors.diagonal(tuple(1 / k for k in K))
    omega = tuple(k * G - c for k, G, c in zip(K, momentum, g, strict=True))
    return FreeGyrostat(inertia, tensors.apply(inertia, g), omega)


_CUSPED = tensors.diagonal(vector("1/3", "1/2", 1))
MOTIONS = {
    "one real root": FreeGyrostat(TRIAXIAL, vector(30, 40, -10), OMEGA),
    "three real roots": FreeGyrostat(TRIAXIAL, ROTOR, OMEGA),
    "full tensor": FreeGyrostat(TENSOR, ROTOR, OMEGA),
    "oblique": turned(FreeGyrostat(TRIAXIAL, ROTOR, OMEGA)),
    "no wheels": FreeGyrostat(TRIAXIAL, vector(0, 0, 0), OMEGA),
    "wheels along axis 1": FreeGyrostat(TRIAXIAL, vector(1, 0, 0), OMEGA),
    "wheels along axis 2": FreeGyrostat(TRIAXIAL, vector(0, 1, 0), OMEGA),
    "start on a plane of symmetry": FreeGyrostat(TRIAXIAL, vector(0, 0, 1), vector(1, 0, "0.5")),
    "two equal moments, wheels across": FreeGyrostat(
        tensors.diagonal(vector(1, 1, 3)), ROTOR, OMEGA
    ),
    "two equal moments, wheels along": FreeGyrostat(
        tensors.diagonal(vector(1, 1, 3)), vector(0, 0, 2), OMEGA
    ),
    "the same, oblique": turned(
        FreeGyrostat(tensors.diagonal(vector(2, 5, 2)), vector(0, -1, 0), OMEGA)
    ),
    "three equal moments": FreeGyrostat(tensors.diagonal(vector(2, 2, 2)), ROTOR, OMEGA),
    "steady": FreeGyrostat(TRIAXIAL, vector(0, 0, 2), vector(0, 0, 1)),
    "rest": FreeGyrostat(TRIAXIAL, ROTOR, vector(0, 0, 0)),
    "separatrix": homoclinic(TRIAXIAL, vector(1, 2, 3), vector(1, 1, 1)),
    "separatrix, oblique": turned(homoclinic(TRIAXIAL, vector(1, 2, 3), vector(1, 2, -1))),
    "separatrix, wheels along axis 3": homoclinic(TRIAXIAL, vector(0, 0, 1), vector(1, 1, 1)),
    "trigonometric": homoclinic(TRIAXIAL, vector(2, 1, 0), vector(1, 1, 1)),
    "trigonometric, wheels along axis 1": homoclinic(TRIAXIAL, vector(1, 0, 0), vector(1, 0, 1)),
    "cusp": homoclinic(_CUSPED, vector(1, 0, 0), vector(1, 1, 1)),
    "circle": on_circle(Fraction(1, 2), Fraction(1, 3), Fraction(7)),
    "circle, wheels along axis 1": on_circle(Fraction(1, 2), Fraction(0), Fraction(2)),
    "circle, no wheels": FreeGyrostat(
        tensors.diagonal(vector(9, 8, 4)), vector(0, 0, 0), vector(4, 1, 3)
    ),
}


def scene_of(free: FreeGyrostat) -> Scene:
    """The scene of a motion, its attitude tracked."""
    body, start = RigidBody(free.inertia, rotor=free.rotor), Spin(free.omega, TILTED)
    return one_instant(body, start, "attitude")


def paced(free: FreeGyrostat, instants: Sequence[Fraction]) -> list[Fraction]:
    """Return the instants in units of the time in which the motion turns by a radian or so."""
    stiffness = max(abs(entry) for row in free.K for entry in row)
    fastest = stiffness * max(map(abs, free.momentum))
    pace = max(abs(rate) for rate in (fastest, *free.omega, *free.g))
    return [t / pace for t in instants] if pace else list(instants)


REGIMES = {
    "one real root": Regime.PERIODIC,
    "three real roots": Regime.PERIODIC,
    "wheels along axis 2": Regime.PERIODIC,
    "two equal moments, wheels across": Regime.PERIODIC,
    "two equal moments, wheels along": Regime.AXISYMMETRIC,
    "the same, oblique": Regime.AXISYMMETRIC,
    "three equal moments": Regime.SPHERICAL,
    "steady": Regime.STEADY,
    "rest": Regime.REST,
    "separatrix": Regime.SEPARATRIX,
    "separatrix, oblique": Regime.SEPARATRIX,
    "trigonometric": Regime.TRIGONOMETRIC,
    "cusp": Regime.CUSP,
    "circle": Regime.SEPARATRIX,
    "circle, no wheels": Regime.SEPARATRIX,
}
# Beside a border between two kinds of motion, and of sizes far apart.
EXTREMES = {
    "beside the separatrix": FreeGyrostat(
        *(lambda f: (f.inertia, f.rotor, (f.omega[0] + TINY, *f.omega[1:])))(MOTIONS["separatrix"])
    ),
    "beside the cusp": FreeGyrostat(
        *(lambda f: (f.inertia, f.rotor, (f.omega[0], f.omega[1] + TINY, f.omega[2])))(
            MOTIONS["cusp"]
        )
    ),
    "beside a steady spin": FreeGyrostat(TRIAXIAL, vector(0, 0, 2), (TINY, 2 * TINY, Fraction(1))),
    "beside a circle": FreeGyrostat(
        *(lambda f: (f.inertia, tensors.plus(f.rotor, (TINY, TINY, TINY)), f.omega))(
            MOTIONS["circle"]
        )
    ),
    "wheels all but along the axis": FreeGyrostat(
        tensors.diagonal(vector(10, 6, 10)), (TINY**2, Fraction(18), TINY**2), vector(6, 1, 4)
    ),
    "nearly equal moments": FreeGyrostat(
        tensors.diagonal((Fraction(1), 1 + TINY, Fraction(3))), ROTOR, OMEGA
    ),
    "weak wheels": FreeGyrostat(TRIAXIAL, tensors.scaled(TINY, ROTOR), OMEGA),
    "strong wheels": FreeGyrostat(TRIAXIAL, tensors.scaled(1 / TINY, ROTOR), OMEGA),
    "slow body": FreeGyrostat(TRIAXIAL, ROTOR, tensors.scaled(TINY, OMEGA)),
}

of_each_regime = pytest.mark.parametrize("name", by_turns(MOTIONS, 12, REGIMES.get))

small = st.integers(-20, 20)
vectors = st.tuples(small, small, small).filter(any).map(lambda v: vector(*v))
tiny = st.integers(1, 60).map(lambda e: Fraction(1, 10**e))
sizes = st.integers(-100, 100).map(lambda e: Fraction(10) ** e)
moments = st.integers(1, 40).map(Fraction)


@st.composite
def gyrostats(draw: st.DrawFn) -> FreeGyrostat:
    """A motion of any kind or a drawn one, in any axes: as it is, or made hard in one way."""
    free = draw(st.sampled_from(list(MOTIONS.values())))
    if draw(st.booleans()):
        inertia = tensors.diagonal(draw(st.tuples(moments, moments, moments)))
        free = FreeGyrostat(inertia, draw(vectors), draw(vectors))
    inertia, rotor, omega = free.inertia, free.rotor, free.omega
    match draw(st.sampled_from(["plain", "beside", "cancelling", "far apart", "units"])):
        case "beside":
            rotor = tensors.plus(rotor, tensors.scaled(draw(tiny), draw(vectors)))
            omega = tensors.plus(omega, tensors.scaled(draw(tiny), draw(vectors)))
        case "cancelling":  # the wheels all but cancel the momentum of the body
            left = tensors.scaled(draw(tiny), draw(vectors))
            rotor = tensors.minus(left, tensors.apply(inertia, omega))
        case "far apart":
            powers = draw(st.tuples(*[st.integers(-10, 10)] * 3))
            inertia = tensors.diagonal(tuple(Fraction(10) ** e for e in powers))
        case "units":
            mass, pace = draw(sizes), draw(sizes)
            inertia = tuple(tensors.scaled(mass, row) for row in inertia)
            rotor, omega = tensors.scaled(mass * pace, rotor), tensors.scaled(pace, omega)
    free = FreeGyrostat(inertia, rotor, omega)
    return turned(free, rotation(*draw(st.tuples(small, small, small, small).filter(any))))


def agrees_with_series(free: FreeGyrostat, instants: Sequence[Fraction]) -> None:
    scene = scene_of(free)
    balls, series = (make.motion(instants, 20) for make in (enclosed(scene), TaylorSolution(scene)))
    assert set(balls.quantities) == {"omega", "attitude"}
    with mp.workdps(40):
        assert apart(balls, series) <= 2 * mpf(10) ** -20


@pytest.mark.parametrize("name", REGIMES)
def test_the_kind_of_motion_is_decided_in_rationals(name: str) -> None:
    """Each start has the kind that it was made for, in its own axes and in turned ones."""
    assert MOTIONS[name].regime is REGIMES[name]
    assert turned(MOTIONS[name], rotation(2, 1, -3, 5)).regime is REGIMES[name]


# A pole at no finite place chooses no frame, nor is one beside three equal roots put on a root.
POLES = (
    FreeGyrostat(
        tensors.diagonal(vector(38, 26, 33)),
        (Fraction(0), Fraction(0), Fraction(273, 466)),
        (Fraction(0), Fraction(-24, 233), Fraction(-301, 5126)),
    ),
    FreeGyrostat(
        tensors.diagonal(vector(22, 17, 28)),
        (Fraction(0), Fraction(0), Fraction(51, 11)),
        (Fraction(0), Fraction(-13, 10**52), Fraction(-17, 22)),
    ),
)


@pytest.mark.parametrize("count", [5, pytest.param(200, marks=pytest.mark.slow)])
def test_taylor_series_agree_for_any_gyrostat(count: int) -> None:
    """Whatever the body, the wheels and the start, the closed form is the enclosed motion."""

    @given(gyrostats())
    @example(POLES[0])
    @example(POLES[1])
    @settings(max_examples=count, deadline=None)
    def agree(free: FreeGyrostat) -> None:
        agrees_with_series(free, paced(free, (Fraction(3, 2), Fraction(-2))))
        assert elements(scene_of(free), 20).regime == free.regime

    agree()


@pytest.mark.parametrize("name", EXTREMES)
def test_taylor_series_agree_at_the_borders(name: str) -> None:
    """Series know no pole of phi', which too few digits put on the double point at any precision."""
    agrees_with_series(EXTREMES[name], paced(EXTREMES[name], INSTANTS[:3]))


@pytest.mark.parametrize("name", ["circle", "circle, wheels along axis 1", "separatrix", "cusp"])
def test_an_endless_approach_is_followed(name: str) -> None:
    """No digit is lost where the orbit has all but come to its double point, and 1e5 units on."""
    agrees_with_series(MOTIONS[name], paced(MOTIONS[name], (Fraction(8), Fraction(-8))))
    far = enclosed(scene_of(MOTIONS[name])).motion([Fraction(10**5)], DIGITS)
    assert far.radius[0] <= mpf(10) ** -DIGITS


@of_each_regime
def test_taylor_series_agree(name: str) -> None:
    """Enclosed Taylor series, which know no elliptic function, find the same motion."""
    agrees_with_series(MOTIONS[name], INSTANTS[:3])


@given(gyrostats())
@settings(max_examples=15)
def test_spins_are_steady_and_their_growth_is_an_eigenvalue(free: FreeGyrostat) -> None:
    """|G| of (K - mu) G = g, by elimination, is as given, and d' = d x w + G x K d has s^2.

    The matrix J of that equation has no trace and no determinant: its eigenvalues are 0, s and -s, and
    s^2 is half the trace of J^2.
    """
    with mp.workdps(200):
        spins, N = steady_spins(free), mp.sqrt(mp.convert(free.n))
        K, g = mp.matrix([[mp.convert(c) for c in row] for row in free.K]), mp.matrix(free.g)
        for spin in spins if any(free.momentum) else []:
            mu = spin.rate / N
            moved = K - mu * mp.eye(3)
            if abs(mp.det(moved)) <= mpf(10) ** -60 * mp.norm(K) ** 3:
                continue  # G is free along an axis, or all but so
            G = mp.lu_solve(moved, g)
            assert abs(mp.norm(G) - N) <= mpf(10) ** -60 * N
            J = _hat(G) * K - _hat(mu * G)
            square = J * J
            assert abs(sum(square[i, i] for i in range(3)) / 2 - spin.square) <= (
                mpf(10) ** -60 * mp.norm(J) ** 2
            )


def _hat(v: Any) -> Any:
    """The matrix of d -> v x d."""
    return mp.matrix([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])


def test_the_signs_of_all_growths_are_proven() -> None:
    """Two spins that a wheel 1e-60 off the axis splits grow and wobble at a rate of 1e-30."""
    with mp.workdps(15):
        spins = steady_spins(EXTREMES["wheels all but along the axis"])
    wobbling, growing = ([s.square for s in spins if s.square * sign > 0] for sign in (-1, 1))
    assert (len(wobbling), len(growing)) == (3, 1)
    assert mpf("1e-61") < growing[0] < mpf("1e-55")
    assert mpf("1e-61") < -max(wobbling) < mpf("1e-55")


@given(gyrostats())
@settings(max_examples=40)
def test_stable_spins_are_two_more_than_unstable_ones(free: FreeGyrostat) -> None:
    """The energy on the sphere |H| = const has two more extrema than saddles (Poincare and Hopf)."""
    if not any(free.momentum):
        return
    with mp.workdps(DIGITS):
        spins = steady_spins(free)
    if free.spin.discriminant and all(spin.square for spin in spins):
        unstable = sum(spin.square > 0 for spin in spins)
        assert len(spins) - unstable == unstable + 2


@pytest.mark.parametrize(
    "free",
    [
        MOTIONS["three real roots"],
        MOTIONS["one real root"],
        MOTIONS["trigonometric"],
        EXTREMES["beside the separatrix"],
        EXTREMES["wheels all but along the axis"],
    ],
)
def test_the_precession_is_the_turn_of_a_period(free: FreeGyrostat) -> None:
    """After a period omega recurs, and R has turned about H by the precession of the elements."""
    scene = scene_of(free)
    numbers = elements(scene, 40)
    with mp.workdps(60):
        period = Fraction(mp.nstr(numbers["period"].value, 40))
        motion = enclosed(scene).motion([Fraction(0), period], 35)
        start, end = motion["attitude"]
        turn = end @ start.T
        cosine = (turn[0, 0] + turn[1, 1] + turn[2, 2] - 1) / 2
        assert abs(cosine - mp.cos(numbers["precession"].value)) < mpf(10) ** -30
        # The axis of the turn tells the sign, where there is one.
        momentum = start @ [mp.convert(c) for c in free.momentum]
        axis = [turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]]
        sine = mp.fdot(axis, momentum) / (2 * mp.norm(momentum))
        assert abs(sine - mp.sin(numbers["precession"].value)) < mpf(10) ** -30
        assert apart_rows(motion["omega"]) < mpf(10) ** -30


def apart_rows(rows: Any) -> mpf:
    """The distance of two vectors."""
    return mp.norm(list(rows[1] - rows[0]))
