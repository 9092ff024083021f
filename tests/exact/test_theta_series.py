"""Theta functions by polynomials: their balls contain FLINT's values, and what is left out is enclosed."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Any

import pytest
from flint import acb, arb, ctx

from taylor_verify.exact import theta_series
from taylor_verify.exact.balls import Enclosed, Enclosure, ball
from taylor_verify.exact.lattice import Lattice, Periods, lattice
from taylor_verify.exact.line import BySeries, OneByOne
from taylor_verify.exact.route import solution
from taylor_verify.exact.theta_series import MANY, Places, ThetaSeries
from taylor_verify.scenes.reading.reader import load

BITS = 150
SAMPLES = 2 * MANY
# Of the lattices in the range of short series: a nome of 0.8, one of 1e-4, and both kinds of tau.
TAUS = ("0.075", "0.3", "1", "3", "rhombic 0.15", "rhombic 0.6")
# One of each course by polynomials, with all that its scene tracks.
SCENES = (
    *("euler/generic", "euler/with-attitude", "euler/full-tensor", "euler/about-max-axis"),
    *("kirchhoff/four-real-roots", "kirchhoff/whole-motion", "kirchhoff/two-real-roots"),
    *("kirchhoff/cubic", "kirchhoff/through-the-pole", "euler/gyrostat", "kirchhoff/damped"),
)


@pytest.fixture(autouse=True)
def _precision() -> Iterator[None]:
    with ctx.workprec(BITS):
        yield


def tau_of(text: str) -> acb:
    kind, _, size = text.rpartition(" ")
    return acb(0.5 if kind else 0, arb(size))


def series_of(tau: acb) -> ThetaSeries:
    series = ThetaSeries.where_short(tau)
    assert series is not None
    return series


def arguments(count: int = 40) -> list[arb]:
    """Real numbers on both sides of 0, over some periods, exact multiples of 1/4 among them."""
    return [arb(k - count // 3) / 8 + (arb(k % 2) / 11) for k in range(count)]


def overlap(one: Sequence[Any], other: Sequence[Any]) -> bool:
    """Return True if all balls are finite and overlap, one by one."""
    pairs = zip(one, other, strict=True)
    return all(a.is_finite() and b.is_finite() and a.overlaps(b) for a, b in pairs)


def agrees(tau: acb, shift: acb, order: int) -> bool:
    """Return True if the series contain theta_1 as FLINT has it."""
    vs, series = arguments(), series_of(tau)
    values = series.shifted(shift, series.lead, order).at(Places([arb.pi() * v for v in vs]))
    return overlap(values, [acb.modular_theta(v + shift, tau, order)[0] for v in vs])


@pytest.mark.parametrize("tau", TAUS)
@pytest.mark.parametrize("order", [0, 1])
@pytest.mark.parametrize("shift", ["real", "zero", "imaginary", "both", "half a period"])
def test_theta_1_is_that_of_flint(tau: str, order: int, shift: str) -> None:
    """At real arguments and beside them, up to half of the imaginary period."""
    half = tau_of(tau).imag / 2
    shifts = {
        "zero": acb(0),
        "real": acb(arb(1) / 7),
        "imaginary": acb(0, half * arb("0.7")),
        "both": acb(arb(-1) / 3, -half * arb("0.9")),
        "half a period": acb(0.5, half),
    }
    assert agrees(tau_of(tau), shifts[shift], order)


def agree(at: acb) -> list[bool]:
    """Return which of theta_1 to theta_4 at real arguments the series contain; two for a tilted tau."""
    vs, series = arguments(), series_of(at)
    places = Places([arb.pi() * v for v in vs])
    right = list(zip(*(acb.modular_theta(acb(v), at) for v in vs), strict=True))
    sums = [
        [series.lead * factor * value for factor, value in zip(factors, places.at(p), strict=True)]
        for factors, p in (
            (places.sines, series.one(arb(1))),
            (places.cosines, series.two(arb(1))),
        )
    ]
    if at.real.is_zero():
        sums += [[acb(v) for v in places.at(p)] for p in series.three_and_four(arb(1))]
    return [overlap(values, right[k]) for k, values in enumerate(sums)]


@pytest.mark.parametrize("tau", TAUS)
def test_the_functions_of_real_arguments_are_those_of_flint(tau: str) -> None:
    """theta_1 and theta_2 on every lattice, theta_3 and theta_4 where tau is imaginary."""
    assert agree(tau_of(tau)) == [True] * (2 if tau.startswith("rhombic") else 4)


# The terms left out


def too_short(series: ThetaSeries, monkeypatch: pytest.MonkeyPatch) -> None:
    """The count of terms is two less: what is left out is no longer small."""
    right = ThetaSeries._count
    monkeypatch.setattr(
        ThetaSeries, "_count", lambda self, b, order: max(1, right(self, b, order) - 2)
    )


@pytest.mark.parametrize("tau", TAUS)
@pytest.mark.parametrize("order", [0, 1])
def test_a_short_series_still_contains_its_function(
    tau: str, order: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """However few terms are summed, from one on, the ball of the tail holds the rest."""
    at = tau_of(tau)
    shift, enclosed = acb(arb(1) / 9, at.imag / 3), 0
    for count in range(1, 9):
        monkeypatch.setattr(ThetaSeries, "_count", lambda self, b, order, n=count: n)
        try:
            assert agrees(at, shift, order)
        except theta_series.Undecidable:
            continue  # so few terms that those left out do not fall yet
        enclosed += 1
    assert enclosed >= 3


@pytest.mark.parametrize("tau", ["0.3", "1", "rhombic 0.6"])
@pytest.mark.parametrize("order", [0, 1])
def test_a_short_series_without_its_tail_is_caught(
    tau: str, order: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A series that is two terms too short and says nothing of what it leaves out contains nothing."""
    at = tau_of(tau)
    shift = acb(arb(1) / 9, at.imag / 3)
    too_short(series_of(at), monkeypatch)
    assert agrees(at, shift, order)
    monkeypatch.setattr(ThetaSeries, "_tail", lambda self, count, b, order: arb(0))
    assert not agrees(at, shift, order)


# Lattices


@pytest.mark.parametrize("invariants", [(12, 1), (12, -1), (3, 5), (Fraction(1, 2), -7)])
def test_a_line_is_what_its_points_are(invariants: tuple[Any, Any]) -> None:
    """p, p', s(u - w) and its derivative by polynomials overlap those one by one, on both kinds."""
    cell: Lattice = lattice(*map(Fraction, invariants))
    us = [arb(k + 1) / 7 for k in range(SAMPLES)]
    assert isinstance(cell, Periods)
    many, single = cell.along(us), OneByOne(cell, us)
    assert isinstance(many, BySeries)
    assert isinstance(cell.along(us[: MANY - 1]), OneByOne)
    for one, other in zip(many.p(), single.p(), strict=True):
        assert overlap(one, other)
    w, scale = acb(arb(2) / 9, cell._tau.imag * cell.period / 3), acb(2, -1)
    for one_jet, other_jet in zip(many.jets(w, scale, 1), single.jets(w, scale, 1), strict=True):
        assert overlap(one_jet, other_jet)


# Motions


def flat(row: Any) -> list[arb]:
    """The entries of a vector or a matrix."""
    return [entry for part in row for entry in flat(part)] if hasattr(row, "__len__") else [row]


def enclosures(name: str, bits: int) -> tuple[Enclosure, list[Enclosure]]:
    """The balls of a motion at many times at once, and at each alone."""
    scene = load(name)
    exact = solution(replace(scene, body=scene.body.undamped))
    assert isinstance(exact, Enclosed)
    end = scene.clock.elapsed[-1]
    times = [end * Fraction(k - 3, SAMPLES - 7) for k in range(SAMPLES)]
    with ctx.workprec(bits):
        times = [ball(t) if k % 3 == 0 else t for k, t in enumerate(times)]
        return exact.enclose(times, bits), [exact.enclose([t], bits) for t in times]


@pytest.mark.parametrize("name", SCENES)
@pytest.mark.parametrize("bits", [90, 180])
def test_many_times_at_once_are_each_alone(name: str, bits: int) -> None:
    """Balls overlap entry by entry, and the radius of a vector is at most four times as much.

    Before the start, at it and beyond the end; of the times some are rational and some are balls.
    """
    many, alone = enclosures(name, bits)
    for quantity, rows in many.items():
        for k, row in enumerate(rows):
            one, other = flat(row), flat(alone[k][quantity][0])
            assert overlap(one, other)
            widths = [max(b.rad() for b in balls) for balls in (one, other)]
            assert widths[0] <= 4 * widths[1]


@pytest.mark.parametrize(
    "name", ["euler/with-attitude", "kirchhoff/whole-motion", "euler/gyrostat"]
)
def test_a_motion_by_series_that_are_too_short_is_caught(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Without their tails, series two terms too short make a motion that is not the one at each time."""
    monkeypatch.setattr(ThetaSeries, "_tail", lambda self, count, b, order: arb(0))
    right = ThetaSeries._count
    monkeypatch.setattr(
        ThetaSeries, "_count", lambda self, b, order: max(1, right(self, b, order) - 2)
    )
    many, alone = enclosures(name, 90)
    rows = ((flat(row), flat(alone[k][q][0])) for q in many for k, row in enumerate(many[q]))
    assert not all(overlap(one, other) for one, other in rows)
