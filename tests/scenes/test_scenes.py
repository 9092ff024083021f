"""What a scene file means: exact numbers, defaults, instants, and the scenes that are shipped."""

from __future__ import annotations

import math
from fractions import Fraction
from hashlib import sha256
from itertools import permutations

import pytest
from builders.free_spins import rotation
from builders.scenes import faults_of, read_scene, remus_inertia
from hypothesis import given
from hypothesis import strategies as st

from taylor_verify.exact.kirchhoff.quartic import Nutation
from taylor_verify.exact.kirchhoff.regime import regime
from taylor_verify.exact.route import solution
from taylor_verify.models.problem import pose
from taylor_verify.numbers import tensors
from taylor_verify.numbers.precision import rung
from taylor_verify.numbers.tensors import Matrix
from taylor_verify.records.faults import Refused
from taylor_verify.scenes import library
from taylor_verify.scenes.bodies import Clebsch, ImmersedBody, RigidBody
from taylor_verify.scenes.motion import IDENTITY, Impulse, Spin
from taylor_verify.scenes.reading.body import obeys_triangle_inequality
from taylor_verify.scenes.reading.reader import load, read
from taylor_verify.scenes.reading.table import LARGEST_EXPONENT, exact_number
from taylor_verify.scenes.scene import Scene

ORDERS = tuple(permutations(range(3)))
INTEGERS = st.integers(-(10**12), 10**12)


def euler(
    body: str = "inertia = [1, 2, 3]", time: str = "end = 10\nsamples = 11", **more: str
) -> Scene:
    """A free body of the model euler, with parts of its text replaced."""
    start = f"omega = [0.1, 1, 0.3]\n{more.get('initial', '')}"
    return read_scene(body, start, time=time, top=more.get("top", ""))


def kirchhoff(top: str = "") -> Scene:
    """Clebsch's body, with lines put at the top of its text."""
    body = "clebsch = { p = 1, p_prime = 2, q = 0.1, q_prime = 0.2, r = 1, r_prime = 0.5 }"
    start = "linear_impulse = [0.1, 0.2, 1]\nangular_impulse = [0.3, 0, 1]"
    return read_scene(body, start, top=top)


# Numbers


@given(INTEGERS, st.integers(-LARGEST_EXPONENT, LARGEST_EXPONENT - 13))
def test_an_exponent_shifts_the_decimal_point(digits: int, exponent: int) -> None:
    """``12e-3`` is 12/1000, in a string as well as bare, up to the largest exponent allowed."""
    expected = digits * Fraction(10) ** exponent
    scene = euler(body=f"inertia = [1, 2, 3]\nmoment = [{digits}e{exponent}, 0, 0]")
    assert isinstance(scene.body, RigidBody)
    assert scene.body.moment[0] == expected == exact_number(f"{digits}e{exponent}")


# Defaults


def test_omega_or_the_impulse_alone_is_tracked_by_default() -> None:
    """A scene that does not say ``track``, or names only what is always there, requires no more."""
    assert euler().track == euler(top='track = ["omega"]').track == frozenset()
    assert kirchhoff().track == kirchhoff('track = ["impulse"]').track == frozenset()


def test_the_centre_brings_the_attitude() -> None:
    """The centre moves by R U, so that tracking it tracks R."""
    assert kirchhoff('track = ["centre"]').track == {"attitude", "centre"}


def test_what_is_left_out_is_free_at_the_origin_and_not_turned() -> None:
    """No moment, force or couple; identity attitude; centre 0; start 0; no source."""
    rigid, immersed = euler(), kirchhoff()
    assert rigid.body.is_free
    assert immersed.body.is_free
    assert isinstance(immersed.initial, Impulse)
    assert rigid.initial.attitude == immersed.initial.attitude == IDENTITY
    assert immersed.initial.centre == (0, 0, 0)
    assert rigid.clock.start == 0
    assert rigid.source == ""


def test_a_quaternion_is_kept_as_written() -> None:
    """The reader does not normalise: a norm is seldom rational, and the quotient would round."""
    initial = euler(initial="attitude = [1, 2, -1, 3]").initial
    assert isinstance(initial, Spin)
    assert initial.attitude == (1, 2, -1, 3)


# Instants


@given(INTEGERS, INTEGERS.filter(bool), st.integers(2, 50))
def test_samples_are_equally_spaced_and_exact(start: int, span: int, samples: int) -> None:
    """Whatever the sign of the span, samples are exact parts of it, from the start to the end."""
    clock = euler(time=f"start = {start}\nend = {start + span}\nsamples = {samples}").clock
    assert clock.elapsed == tuple(Fraction(k * span, samples - 1) for k in range(samples))
    assert clock.instants == tuple(start + t for t in clock.elapsed)


def test_listed_instants_are_taken_as_they_are() -> None:
    """``at`` lists absolute instants, with or without the start, forward or backward."""
    assert euler(time='at = ["1/3", 0.5, 7]').clock.instants == (Fraction(1, 3), Fraction(1, 2), 7)
    assert euler(time="start = 1\nat = [1, 2]").clock.elapsed == (0, 1)
    assert euler(time="start = 1\nat = [0.5, 0, -1]").clock.elapsed == (Fraction(-1, 2), -1, -2)


# The triangle inequality


def has_real_moments(a: Fraction, b: Fraction, c: Fraction) -> bool:
    return a <= b + c and b <= c + a and c <= a + b


MOMENT = st.fractions(Fraction(1, 100), 100)
MOMENTS = st.tuples(MOMENT, MOMENT, MOMENT)
FLAT = st.builds(lambda a, b: (a, b, a + b), MOMENT, MOMENT)


@given(st.one_of(MOMENTS, FLAT), st.tuples(INTEGERS, INTEGERS, INTEGERS, INTEGERS).filter(any))
def test_the_triangle_inequality_is_decided_in_any_axes(
    moments: tuple[Fraction, Fraction, Fraction], q: tuple[int, int, int, int]
) -> None:
    """Turned by any rational rotation a tensor gives the answer of its principal moments, the flat
    plate, which just obeys, included."""
    R = rotation(*q)
    turned = tensors.product(tensors.product(R, tensors.diagonal(moments)), tensors.transpose(R))
    assert obeys_triangle_inequality(turned) is has_real_moments(*moments)


@pytest.mark.parametrize("order", ORDERS)
def test_an_impossible_solid_is_a_warning_in_any_order_of_its_axes(order: tuple[int, ...]) -> None:
    """Moments 1, 2, 4 are warned of, 1, 2, 3 (a flat plate) are not, and neither is refused."""
    for moments, count in (((1, 2, 4), 1), ((1, 2, 3), 0)):
        scene = euler(body=f"inertia = {[moments[i] for i in order]}")
        assert len(scene.warnings) == count


# Bodies


@pytest.mark.parametrize("order", ORDERS)
def test_principal_moments_are_the_diagonal_tensor(order: tuple[int, ...]) -> None:
    """Three moments and the diagonal matrix of the same three are one body, in every order."""
    moments = [(2, 3, 4)[i] for i in order]
    matrix = [[moments[i] if i == j else 0 for j in range(3)] for i in range(3)]
    assert euler(body=f"inertia = {moments}").body == euler(body=f"inertia = {matrix}").body


def test_clebschs_form_is_the_energy_it_abbreviates() -> None:
    """T of 49 (1), written out in six coefficients, is T by the 6x6 matrix, at any x and y."""
    body = kirchhoff().body
    assert isinstance(body, ImmersedBody)
    x, y = (Fraction(2), Fraction(-3), Fraction(5)), (Fraction(7), Fraction(1, 2), Fraction(-4))
    # p = 1, p' = 2, q = 1/10, q' = 1/5, r = 1, r' = 1/2, as in the text above.
    by_hand = (
        (x[0] ** 2 + x[1] ** 2) / 2
        + x[2] ** 2
        + (x[0] * y[0] + x[1] * y[1]) / 10
        + x[2] * y[2] / 5
        + (y[0] ** 2 + y[1] ** 2) / 2
        + y[2] ** 2 / 4
    )
    assert tensors.dot(x + y, tensors.apply(body.energy_matrix, x + y)) / 2 == by_hand


def swimmer_inertia() -> Matrix:
    """Momentum by velocity, rows X Y Z K M N and columns u v w p q r, about the centre of buoyancy."""
    length, mass, below = Fraction("5.3"), Fraction("5454.54"), Fraction("0.061")
    entries = {
        **{(i, i): mass for i in range(3)},
        **{(3, 3): Fraction(2038), (4, 4): Fraction(13587), (5, 5): Fraction(13587)},
        **{(i, j): Fraction("13.58") for i, j in ((3, 4), (4, 5), (3, 5))},
        **{(0, 4): mass * below, (1, 3): -mass * below},
    }
    derivatives = {
        **{(0, 0): "-7.6e-3", (1, 1): "-5.5e-2", (2, 2): "-2.4e-1"},  # Xu', Yv', Zw'
        **{(1, 3): "1.2e-4", (1, 5): "1.2e-3", (2, 4): "-6.8e-3"},  # Yp', Yr', Zq'
        **{(3, 3): "-1.0e-3", (4, 4): "-1.7e-2", (5, 5): "-3.4e-3"},  # Kp', Mq', Nr'
        (3, 5): "-3.4e-5",  # Kr'
    }
    for (i, j), derivative in derivatives.items():
        power = 3 + (i > 2) + (j > 2)
        entries[i, j] = (
            entries.get((i, j), Fraction(0)) - Fraction(derivative) * 500 * length**power
        )
    upper = [[entries.get((min(i, j), max(i, j)), Fraction(0)) for j in range(6)] for i in range(6)]
    return tuple(tuple(row) for row in upper)


@pytest.mark.parametrize(
    ("name", "inertia", "velocities"),
    [
        ("remus-100", remus_inertia(), "1.5 0.1 -0.2 0.5 0.3 0.2"),
        ("swimmer-vehicle", swimmer_inertia(), "1.8 0.1 -0.15 0.1 0.15 0.05"),
    ],
)
def test_the_energy_of_a_vehicle_is_the_inverse_of_its_inertia(
    name: str, inertia: Matrix, velocities: str
) -> None:
    """[[A, B], [B^T, C]] times the inertia in the tables or in the file is the identity, and the initial
    impulses are that inertia times the velocities that the file names."""
    scene = load(f"kirchhoff/{name}")
    energy = scene.body.energy_matrix
    assert tensors.product(energy, inertia) == tensors.diagonal((Fraction(1),) * 6)
    # All 21 coefficients of the swimmers' vehicle differ from zero.
    assert name == "remus-100" or all(entry != 0 for row in energy for entry in row)
    assert tensors.apply(inertia, tuple(map(Fraction, velocities.split()))) == scene.initial.moving


# The shipped scenes


@pytest.mark.parametrize("name", library.names())
def test_every_shipped_scene_loads_without_a_warning(name: str) -> None:
    """It is read under its own name, as its folder's model, with a digest of its text."""
    scene = load(name)
    assert scene.name == name
    folder, rest = name.split("/")
    assert folder == "loads" or scene.model == (
        rest.split("-")[0] if folder == "manufactured" else folder
    )
    assert scene.warnings == ()
    assert scene.digest == sha256(library.find(name).read_bytes()).hexdigest()


@pytest.mark.parametrize("name", library.names())
def test_every_shipped_scene_says_why_it_is_there(name: str) -> None:
    """The first line begins with ``# Why:``, and the reason is a sentence."""
    lines = library.find(name).read_text().splitlines()
    comment = " ".join(line.lstrip("# ") for line in lines if line.startswith("#"))
    assert lines[0].startswith("# Why: ")
    assert comment.endswith(".")


def test_every_shipped_scene_is_in_the_table_of_the_readme() -> None:
    """cases/README.md has a row for each scene of the standard set, and for nothing else."""
    readme = (library.cases_directory() / "README.md").read_text()
    rows = [
        line.split("`")[1]
        for line in readme.splitlines()
        if line.startswith(("| `e", "| `k", "| `l", "| `m"))
    ]
    assert sorted(row for row in rows if "/" in row) == sorted(library.names())


def test_every_regime_of_a_free_rigid_body_has_its_scene() -> None:
    """Rest, spherical, steady, axisymmetric, separatrix and both families of orbits occur."""
    scenes = [load(name) for name in library.names() if name.startswith("euler/")]
    regimes = {solution(scene).regime for scene in scenes if scene.body.is_free}
    assert regimes >= {
        *("rest", "spherical", "steady", "axisymmetric", "separatrix", "max-axis", "min-axis"),
    }


def test_the_brick_ends_where_the_simulations_of_nasa_did() -> None:
    """After 30 s the rates of check case 2 are those of the report, to the 0.004 deg/s within which
    its own simulations agree; a wrong inertia, rate or sign of the gyroscopic term is far off."""
    scene = load("euler/nesc-brick")
    assert scene.clock.instants[-1] == 30
    omega = solution(scene, "taylor").motion([Fraction(30)], 12)["omega"][0]
    reported = (12.618, -17.397, 31.120)
    for rate, degrees in zip(omega, reported, strict=True):
        assert abs(math.degrees(rate) - degrees) <= 0.004


# The words of exact/kirchhoff/regime.py, and the free bodies of Clebsch's form that move so.
MOTIONS = {
    "rest": ("rest",),
    "euler-top": ("zero-impulse", "euler-top"),
    "steady": ("steady-spin", "unstable-spin", "border-spin", "steady-precession"),
    "trigonometric": (
        *("trigonometric", "beside-a-stable-spin", "isotropic-helicoid"),
        "ellipsoid-sphere",
    ),
    "hyperbolic": ("onto-the-axis", "falling-away"),
    "algebraic": ("algebraic", "algebraic-path"),
    "heteroclinic": ("half-turn", "half-turn-path"),
    "cubic": ("cubic", "later-start"),
    "four-roots": (
        *("four-real-roots", "whole-motion", "planar-swing", "planar-turn"),
        *("backward", "orthogonal-impulses", "through-the-pole"),
        *("ellipsoid-prolate", "ellipsoid-disc"),
    ),
    "two-roots": (
        *("two-real-roots", "screw", "listed-times"),
        *("from-the-axis", "turning-point", "no-axial-impulse"),
    ),
}
MOTION = {f"kirchhoff/{name}": word for word, names in MOTIONS.items() for name in names}


def test_every_free_body_of_clebschs_form_has_its_motion_named() -> None:
    """The table above lists the shipped free bodies of Clebsch's form without damping, each once."""
    bodies = {name: load(name).body for name in library.names() if name.startswith("kirchhoff/")}
    assert set(MOTION) == {
        name
        for name, body in bodies.items()
        if isinstance(body, ImmersedBody) and body.is_integrable and not body.damping
        if body.clebsch is not None
    }
    assert len(MOTION) == sum(map(len, MOTIONS.values()))


@pytest.mark.parametrize("rung_name", [None, "f32", "f64", "f128"])
@pytest.mark.parametrize("name", MOTION)
def test_each_scene_moves_as_its_reason_says(name: str, rung_name: str | None) -> None:
    """The regime is the one named, of the numbers as written and as rounded to a rung."""
    scene = load(name)
    given_to_solver = scene if rung_name is None else pose(scene, rung(rung_name)).given
    assert isinstance(given_to_solver.initial, Impulse)
    nutation = Nutation.of(clebsch(given_to_solver), given_to_solver.initial)
    assert regime(nutation) == MOTION[name]


@pytest.mark.parametrize("word", MOTIONS)
def test_every_motion_is_shipped_with_its_path(word: str) -> None:
    """Some scene of each regime tracks attitude and centre."""
    tracks = [load(f"kirchhoff/{name}").track for name in MOTIONS[word]]
    assert {"attitude", "centre"} in tracks


def clebsch(scene: Scene) -> Clebsch:
    assert isinstance(scene.body, ImmersedBody)
    assert scene.body.clebsch is not None
    return scene.body.clebsch


def test_a_path_is_a_path_and_a_name_a_name() -> None:
    """A scene by path and by name is one question under two names."""
    path = str(library.find("euler/generic"))
    by_path, by_name = load(path), load("euler/generic")
    assert by_path.name == path
    assert (by_path.body, by_path.initial, by_path.clock) == (
        by_name.body,
        by_name.initial,
        by_name.clock,
    )
    assert by_path.digest == by_name.digest


def test_the_cases_must_exist(monkeypatch: pytest.MonkeyPatch) -> None:
    """Without a folder of cases there is an error, and not a green run of no scenes."""
    monkeypatch.setattr(library, "__file__", "/nowhere/verify/taylor_verify/scenes/library.py")
    with pytest.raises(FileNotFoundError, match="cases"):
        library.names()


def test_the_model_must_be_known_before_its_body_is_read() -> None:
    """The other parts of a scene without a model are read, and each of their faults is reported."""
    with pytest.raises(Refused, match="@ model") as caught:
        read("[body]\nanything = 1\n[initial]\nomega = 1\n[time]\nend = 0\nsamples = 1\n", "x")
    assert [line.split(" @ ")[1].split()[0] for line in caught.value.faults] == [
        "title",
        "model",
        "time.end",
        "time.samples",
    ]


@pytest.mark.parametrize(
    ("inertia", "places"),
    [
        ("[-1, nan, 0]", ["[0]", "[1]", "[2]"]),
        ("[[-1, nan, 2], [0, 1, 3], [4, 3, -2]]", ["[0][0]", "[0][1]", "[2][2]", ""]),
    ],
)
def test_a_number_that_is_none_hides_no_fault_beside_it(inertia: str, places: list[str]) -> None:
    """Entries that are not positive or symmetric, or no numbers, are reported at once, and the time too."""
    faults = faults_of(f"inertia = {inertia}", time="end = 0\nsamples = 1")
    at = [line.split(" @ ")[1].split()[0] for line in faults]
    assert at == [*(f"body.inertia{place}" for place in places), "time.end", "time.samples"]
