"""A certificate bounds the error of a dense answer for all times, and names what is wrong with it."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from types import SimpleNamespace
from typing import Any, Final

import numpy as np
import pytest
from mpmath import mp, mpf
from scipy.integrate import solve_ivp
from scipy.interpolate import BPoly, CubicHermiteSpline, CubicSpline, PPoly, make_interp_spline

from taylor_verify.certify import bounds, certify
from taylor_verify.certify.dense_answer import pieces_of
from taylor_verify.certify.enclosed_error import errors_of
from taylor_verify.certify.pieces import Piece
from taylor_verify.certify.slopes import slopes_of
from taylor_verify.cli import main
from taylor_verify.exact import exact
from taylor_verify.exact.row_arithmetic import quaternions
from taylor_verify.models.problem import pose_as_stored
from taylor_verify.numbers.irrational import fraction, rational
from taylor_verify.numbers.precision import rung
from taylor_verify.records.certificate import Fault, GapKind
from taylor_verify.records.faults import Refused
from taylor_verify.scenes.motion import Clock
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene

END: Final = 4


def until(name: str, end: int = END) -> Scene:
    """A shipped scene, as a float64 program has it, over a short span."""
    scene = pose_as_stored(load(name), rung("f64")).given
    return replace(scene, clock=Clock(Fraction(0), (Fraction(0), Fraction(end))))


SCENE: Final = until("euler/generic")
INERTIA: Final = np.array([float(row[i]) for i, row in enumerate(SCENE.body.energy_matrix)])


def rates(_: float, omega: Any) -> Any:
    return np.cross(INERTIA * omega, omega) / INERTIA


# Times that no short binary number is.
NODES: Final = np.concatenate([[0], (np.arange(1, 32) + np.sin(np.arange(1, 32)) / 4) / 8, [END]])
VALUES: Final = exact(SCENE, [Fraction(t) for t in NODES], 18)["omega"].astype(float)
SLOPES: Final = np.array([rates(0, row) for row in VALUES])
SPLINE: Final = CubicHermiteSpline(NODES, VALUES, SLOPES)
DOCUMENT: Final = {
    "breaks": NODES.tolist(),
    "quantities": {"omega": np.moveaxis(SPLINE.c[::-1], 0, 2).tolist()},
}
TABLE: Final = {"t": NODES, **{f"w{i + 1}": VALUES[:, i] for i in range(3)}}


@pytest.mark.parametrize("method", ["RK23", "RK45", "DOP853", "Radau", "BDF", "LSODA"])
def test_the_bound_is_above_every_probe_and_near_the_largest(method: str) -> None:
    """No probe by 40 digits exceeds the bound of SciPy's dense output; one comes near to it."""
    dense = solve_ivp(rates, (0, END), VALUES[0], method, rtol=1e-7, atol=1e-9, dense_output=True)
    certificate = certify(SCENE, dense)
    pieces = pieces_of(dense, SCENE)
    near, spread = certificate.at["omega"], np.random.default_rng(1).uniform(0, END, 30)
    times = [Fraction(t) for t in (near, *spread)]
    with mp.workdps(50):
        truth = exact(SCENE, times, 40)["omega"]
        scale = max(mp.norm(list(row)) for row in truth)
        errors = []
        for time, row in zip(times, truth, strict=True):
            (piece,) = list(pieces.between(time, time))[:1]
            values = [value(piece, column, time) for column in ("w1", "w2", "w3")]
            off = [mpf(v.numerator) / v.denominator - w for v, w in zip(values, row, strict=True)]
            errors.append(mp.norm(off) / scale)
        assert max(errors) <= certificate.bound["omega"] <= mpf("1.1") * errors[0]
    assert np.allclose(dense.sol(float(spread[0])), _double(pieces, spread[0]), rtol=1e-13)


def test_a_state_that_begins_at_zero_counts_by_its_size_so_far() -> None:
    """The integral of an error grows from zero: a probe early in the first step is below the bound too."""
    scene = until("loads/pid")
    nodes, columns = np.linspace(0, END, 101), ("i1", "i2", "i3")
    rows = exact(scene, [Fraction(t) for t in nodes], 18)["i"].astype(float)
    answer = {"i": CubicSpline(nodes, rows)}
    bound, pieces = certify(scene, answer).bound["i"], pieces_of(answer, scene)
    times = [Fraction(t) for t in np.geomspace(1e-6, 3.99, 60)]
    with mp.workdps(40):
        size, errors = mpf(0), []
        for time, row in zip(times, exact(scene, times, 30)["i"], strict=True):
            size = max(size, mp.norm(list(row)))
            piece = next(iter(pieces.between(time, time)))
            values = [value(piece, column, time) for column in columns]
            off = [mpf(v.numerator) / v.denominator - i for v, i in zip(values, row, strict=True)]
            errors.append(mp.norm(off) / size)
        assert 0 < max(errors) <= bound <= mpf("1.1") * max(errors)


def value(piece: Piece, column: str, time: Fraction) -> Fraction:
    """The value of a column of a piece at a time."""
    return fraction(piece.polynomials[column](rational(time - piece.begin)))


def _double(pieces: Any, time: float) -> list[float]:
    piece = pieces.between(Fraction(time), Fraction(time))[0]
    return [float(value(piece, column, Fraction(time))) for column in ("w1", "w2", "w3")]


@pytest.mark.parametrize(
    ("answer", "more"),
    [
        ({"omega": SPLINE}, {}),
        (BPoly.from_power_basis(PPoly(SPLINE.c, NODES)), {}),
        (DOCUMENT, {}),
        (lambda t: SPLINE(t), {"degree": 3, "nodes": NODES}),
        (TABLE, {"interpolation": "hermite"}),
        # heyoka's continuous output: powers of the time since each step began.
        (SimpleNamespace(times=NODES, tcs=np.moveaxis(SPLINE.c[::-1], 0, 2)), {}),
    ],
    ids=["by name", "Bernstein", "pieces", "callable", "samples", "Taylor series"],
)
def test_one_interpolant_has_one_bound(answer: Any, more: dict[str, Any]) -> None:
    """However the same cubics are handed over, the bound is the same but for the rounding of doubles."""
    bound = certify(SCENE, SPLINE).bound["omega"]
    assert certify(SCENE, answer, **more).bound["omega"] == pytest.approx(bound, rel=1e-6)


def test_slopes_of_a_quaternion_are_half_its_product_with_omega() -> None:
    """Also where the attitude at the start is no unit quaternion as it is written."""
    scene = until("euler/with-attitude")
    times = [Fraction(k, 10) for k in range(41)]
    motion = exact(scene, times, 18)
    omega = motion.quantities["omega"].astype(float)
    q = quaternions(motion.quantities["attitude"].astype(float))
    rows = [[Fraction(x) for x in row] for row in np.hstack([omega, q]).tolist()]
    names = [f"w{i}" for i in (1, 2, 3)] + [f"q{i}" for i in range(4)]
    slopes = np.array(slopes_of(scene, names, times, rows), dtype=float)[:, 3:]
    s, v = q[:, :1], q[:, 1:]
    turned = np.hstack([-np.sum(v * omega, axis=1, keepdims=True), s * omega + np.cross(v, omega)])
    assert np.allclose(slopes, turned / 2, rtol=0, atol=1e-14)


def test_a_spline_is_taken_exactly() -> None:
    """De Boor's recursion in rationals is the spline that SciPy evaluates in doubles."""
    spline = make_interp_spline(NODES, VALUES, k=5)
    assert np.allclose(_double(pieces_of(spline, SCENE), 1.234), spline(1.234), rtol=1e-13)


def _quadratic() -> Any:
    h = np.diff(NODES)[:, None]
    c = np.stack([(VALUES[1:] - VALUES[:-1] - h * SLOPES[:-1]) / h**2, SLOPES[:-1], VALUES[:-1]])
    return PPoly(c, NODES)


def _wrong_node() -> Any:
    c = SPLINE.c.copy()
    pair = CubicHermiteSpline(NODES[9:11], VALUES[[9, 12]], SLOPES[9:11])
    c[:, 9] = pair.c[:, 0]
    return PPoly(c, NODES)


BUGS: Final[dict[str, tuple[Callable[[], Any], Fault]]] = {
    "a wrong order between steps": (_quadratic, Fault.BETWEEN),
    "a node shared wrongly": (_wrong_node, Fault.NODES),
    "slopes of the step before": (
        lambda: CubicHermiteSpline(NODES, VALUES, np.vstack([SLOPES[:1], SLOPES[:-1]])),
        Fault.SLOPES,
    ),
    "an abscissa in float32": (
        lambda: CubicHermiteSpline(NODES.astype(np.float32).astype(float), VALUES, SLOPES),
        Fault.ABSCISSA,
    ),
}


@pytest.mark.parametrize("bug", BUGS)
def test_a_seeded_bug_is_named(bug: str) -> None:
    """Each fault of an interpolant is beyond the bound of the right one, and has its name."""
    answer, fault = BUGS[bug]
    certificate = certify(SCENE, answer(), tolerance=2e-6)
    assert fault in {finding.fault for finding in certificate.findings}
    assert "the interpolant, not the steps" in str(certificate)


def test_steps_that_are_wrong_are_no_interpolant() -> None:
    """A dense output as good as its steps has no finding, however wrong both are."""
    dense = solve_ivp(rates, (0, END), VALUES[0], "BDF", rtol=1e-5, dense_output=True)
    certificate = certify(SCENE, dense)
    assert not certificate.findings
    assert certificate.passed


def test_a_body_at_rest_has_no_fault() -> None:
    """An answer that is exact has no finding, though its proven bound is no zero."""
    certificate = certify(until("euler/rest"), PPoly(np.zeros((4, 8, 3)), np.linspace(0, END, 9)))
    assert certificate.bound["omega"] < 1e-100
    assert not certificate.findings


def test_gaps_are_named_with_their_places() -> None:
    """A jump and a span without pieces are found where they are, and do not pass."""
    jump = certify(SCENE, _wrong_node()).gaps
    assert [(gap.kind, gap.at) for gap in jump] == [(GapKind.JUMP, NODES[10])]
    short = certify(SCENE, PPoly(SPLINE.c[:, :9], NODES[:10]), tolerance=1e-3)
    assert [(gap.kind, gap.at, gap.end) for gap in short.gaps] == [
        (GapKind.NOT_COVERED, NODES[9], END)
    ]
    assert short.bound["omega"] <= 1e-3
    assert not short.passed
    assert short.is_undecided
    outside = certify(SCENE, PPoly(SPLINE.c, NODES + 200))
    assert [(gap.kind, gap.at, gap.end) for gap in outside.gaps] == [(GapKind.NOT_COVERED, 0, END)]
    assert outside.is_undecided


@pytest.mark.parametrize("name", ["kirchhoff/displaced-origin", "loads/pd-wheels"])
def test_every_tracked_quantity_has_a_bound(name: str) -> None:
    """Attitude, centre and impulse of a spline through exact samples are as right as sampling says."""
    scene = until(name, 1)
    times = np.linspace(0, 1, 33)
    motion = exact(scene, [Fraction(t) for t in np.linspace(0, 1, 65)], 18)
    rows = {
        group.name: quaternions(motion["attitude"].astype(float))
        if group.name == "quaternion"
        else motion[group.name].astype(float).reshape(65, -1)
        for group in scene.groups
    }
    answer = {key: CubicSpline(times, values[::2]) for key, values in rows.items()}
    # The sign of a quaternion is free.
    if "quaternion" in answer:
        answer["quaternion"] = CubicSpline(times, -rows["quaternion"][::2])
    certificate = certify(scene, answer)
    assert set(certificate.bound) == {quantity.name for quantity in scene.tracked}
    for quantity in scene.tracked:
        reached, bound = certificate.largest[quantity.name], certificate.bound[quantity.name]
        assert 0 < reached <= bound <= 1.05 * reached
    if "attitude" in certificate.bound:
        halves = answer["quaternion"](np.linspace(0, 1, 65)[1::2]), rows["quaternion"][1::2]
        unit = halves[0] / np.linalg.norm(halves[0], axis=1)[:, None]
        angles = 2 * np.arccos(np.minimum(1, np.abs((unit * halves[1]).sum(axis=1))))
        assert angles.max() <= certificate.bound["attitude"] + 1e-7


@pytest.mark.parametrize(
    ("answer", "more", "why"),
    [
        (lambda t: SPLINE(t), {}, "degree and nodes with a callable"),
        (lambda t: SPLINE(t), {"degree": 2, "nodes": NODES}, "a polynomial of degree 2"),
        (lambda t: SPLINE(t), {"degree": 3, "nodes": [0]}, "two nodes at least"),
        (lambda t: SPLINE(t), {"degree": 3, "nodes": [0, "x"]}, "finite numbers, got 'x' @ nodes"),
        (lambda t: SPLINE(t), {"degree": 61, "nodes": NODES}, "a degree from 0 to 60"),
        ({**DOCUMENT, "breaks": NODES[::-1].tolist()}, {}, "breaks that rise"),
        (
            {"breaks": [0, 3, 2, 4], "quantities": {"omega": [[[1], [1], [1]]] * 3}},
            {},
            r"^expected breaks that rise, got 3 @ breaks\[\d\]$",
        ),
        ({**DOCUMENT, "quantities": {"omega": [[[1.0]]] * 32}}, {}, "3 components"),
        (PPoly(SPLINE.c * 180 / np.pi, NODES), {}, "in degrees per unit of time"),
        (PPoly(np.where(SPLINE.c == SPLINE.c[0, 5, 1], np.nan, SPLINE.c), NODES), {}, "got nan"),
        (TABLE, {"interpolation": "quintic"}, "linear, cubic, hermite"),
        (
            {**TABLE, "w2": np.where(NODES == END, np.inf, VALUES[:, 1])},
            {"interpolation": "linear"},
            r"expected finite numbers, got .*inf.* @ t = 4$",
        ),
        (
            {"breaks": [0, 4], "quantities": {"omega": [[[1e160], [1], [1]]]}},
            {},
            "terms below 1e100",
        ),
        ({**DOCUMENT, "breaks": 5}, {}, "expected a list of numbers, got 5 @ breaks$"),
        ({**DOCUMENT, "quantities": {"w1": [[[1.0]] * 3] * 32}}, {}, "1 component in each piece"),
        (
            {"breaks": [0, 4], "quantities": {"omega": [[[1], [], [1]]]}},
            {},
            r"a list of 0 @ .*\[1\]",
        ),
        ({**DOCUMENT, "breaks": [1]}, {}, "expected two breaks at least, got 1 @ breaks"),
        ({**DOCUMENT, "quantities": [1]}, {}, "for each quantity, got .1. @ quantities"),
        (
            {"breaks": [0, 4], "quantities": {"omeg": [[[1]]]}},
            {},
            "got omeg @ answer .did you mean `omega`",
        ),
        (
            {"breaks": [0, 4], "quantities": {"omega": [[[1, None], [1], 3]]}},
            {},
            r"got None @ quantities.omega\[0\]\[0\]\[1\]\n.* got 3 @ quantities.omega\[0\]\[2\]",
        ),
        (
            SimpleNamespace(times=[0, 4], tcs=np.full((1, 3, 1), mpf(1))),
            {},
            "or long double, got object",
        ),
        (TABLE, {}, "a dense answer"),
        (SPLINE, {"tolerance": -1.0}, "a positive number"),
    ],
)
def test_what_is_no_dense_answer_is_refused(answer: Any, more: dict[str, Any], why: str) -> None:
    """A refusal says in one sentence what was expected."""
    with pytest.raises((Refused, ValueError), match=why):
        certify(SCENE, answer, **more)


@pytest.mark.parametrize(("tolerance", "status"), [("1e-5", 3), ("1e-9", 1)])
def test_the_verb_says_what_is_proven(
    tolerance: str, status: int, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A file that covers a part is undecided, and wrong where it is beyond the tolerance."""
    file = tmp_path / "pieces.json"
    file.write_text(json.dumps(DOCUMENT))
    arguments = ["certify", str(file), "--scene", "euler/generic", "--json"]
    assert main([*arguments, "--tolerance", tolerance]) == status
    content = json.loads(capsys.readouterr().out)
    assert content["gaps"][0] | {"size": 0} == {
        "kind": "not covered", "quantity": "time", "at": 4.0, "end": 100.0, "size": 0,
    }  # fmt: skip
    assert content["passed"] is False


def turned() -> dict[str, Any]:
    """Samples of a body that turns, as columns of a table."""
    times = np.linspace(0, 1, 9)
    motion = exact(until("euler/with-attitude", 1), [Fraction(t) for t in times], 18)
    columns = np.hstack(
        [motion["omega"].astype(float), quaternions(motion["attitude"].astype(float))]
    )
    names = ("w1", "w2", "w3", "q0", "q1", "q2", "q3")
    return {"t": times, **dict(zip(names, columns.T, strict=True))}


def test_the_sign_of_a_quaternion_is_free_in_each_row() -> None:
    """Samples of which every second one has the other sign have the same interpolant."""
    table = turned()
    signs = np.where(np.arange(9) % 2, -1, 1)
    other = {name: v * signs if name[0] == "q" else v for name, v in table.items()}
    scene = until("euler/with-attitude", 1)
    first, second = (certify(scene, each, interpolation="cubic") for each in (table, other))
    assert first.bound == second.bound
    assert first.bound["attitude"] < 0.1


def test_bits_that_narrow_nothing_are_tried_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """A quaternion that goes through zero has no bound but half a turn, however exact the truth is."""
    asked: list[int] = []

    def counted(*given: Any) -> Any:
        asked.append(given[-1])
        return errors_of(*given)

    monkeypatch.setattr(bounds, "errors_of", counted)
    table = turned()
    signs = np.where(np.arange(9) % 2, -1, 1)
    rows = np.stack([table[name] * signs for name in ("q0", "q1", "q2", "q3")], axis=1)
    omega = np.stack([table[name] for name in ("w1", "w2", "w3")], axis=1)
    answer = {
        "omega": CubicSpline(table["t"], omega),
        "quaternion": CubicSpline(table["t"], rows),
    }
    certificate = certify(until("euler/with-attitude", 1), answer)
    assert certificate.bound["attitude"] == pytest.approx(np.pi)
    assert len(set(asked)) <= 2
