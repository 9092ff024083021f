"""Anybody's equations are enclosed as bodies are, or refused."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Any, Final

import pytest
from builders.text_functions import drawn, verdict
from mpmath import mp, mpf, odefun, sin, sqrt

from taylor_verify import enclose
from taylor_verify.exact.solution import Unsettled
from taylor_verify.records.faults import Refused

DIGITS: Final = 24
END: Final = "1/5"
Rule = Callable[[Any, Sequence[Any]], list[Any]]

# Rates as texts, the start, and the same equations in Python.
FIELDS: Final[dict[str, tuple[dict[str, str], dict[str, Any], Rule]]] = {
    "Lorenz": (
        {"x": "10*(y - x)", "y": "x*(28 - z) - y", "z": "x*y - 8/3*z"},
        {"x": 1, "y": 1, "z": 1},
        lambda t, s: [
            10 * (s[1] - s[0]),
            s[0] * (28 - s[2]) - s[1],
            s[0] * s[1] - mpf(8) / 3 * s[2],
        ],
    ),
    "Kepler (DETEST D)": (
        {"x": "u", "y": "v", "u": "-x/norm(x, y)^3", "v": "-y/(x^2 + y^2)^(3/2)"},
        {"x": "0.9", "y": 0, "u": 0, "v": "1.1"},
        lambda t, s: [
            s[2],
            s[3],
            -s[0] / sqrt(s[0] ** 2 + s[1] ** 2) ** 3,
            -s[1] / sqrt(s[0] ** 2 + s[1] ** 2) ** 3,
        ],
    ),
    "SciML's rigid body": (
        {"w1": "-2*w2*w3", "w2": "1.25*w1*w3", "w3": "-w1*w2/2 + sin(t)^2/4"},
        {"w1": 1, "w2": 0, "w3": "0.9"},
        lambda t, s: [
            -2 * s[1] * s[2],
            mpf(5) / 4 * s[0] * s[2],
            -s[0] * s[1] / 2 + sin(t) ** 2 / 4,
        ],
    ),
}


@pytest.mark.parametrize("name", FIELDS)
def test_the_true_motion_lies_within_the_errors(name: str) -> None:
    """An independent recursion at another precision is inside the proven bounds, which are narrow."""
    rates, start, rule = FIELDS[name]
    motion = enclose(rates, start, [END], DIGITS)
    with mp.workdps(DIGITS + 12):
        begin = [_number(start[key]) for key in rates]
        truth = odefun(rule, 0, begin, tol=mpf(10) ** -(DIGITS + 8))(_number(END))
        for key, value in zip(rates, truth, strict=True):
            assert abs(motion[key][0] - value) <= motion.errors[key][0] + mpf(10) ** -(DIGITS + 6)
            assert motion.radii[key][0] <= mpf(10) ** -DIGITS


def _number(text: Any) -> mpf:
    above, _, below = str(text).partition("/")
    return mpf(above) / mpf(below or 1)


@pytest.mark.parametrize("seed", range(6))
def test_random_fields_lie_within_the_errors(seed: int) -> None:
    """No end of another integrator is outside; from a start that is off by 1e-14 it is."""
    field = drawn(seed)
    word = verdict(field)
    assert word != "outside"
    off = {name: number + Fraction(1, 10**14) for name, number in field.start.items()}
    if word == "inside":
        assert verdict(field, replace(field, start=off)) in ("outside", "not judged")


def test_the_motion_lies_in_the_boxes_that_capd_prints() -> None:
    """A pendulum is in the boxes of another enclosure: those in CAPD's two ITimeMap examples, whole."""
    printed = {
        "x": (
            ("2.0719023157504193", "2.0719023157504308"),
            ("1.2048370333482143", "1.2048370333483036"),
        ),
        "v": (
            ("0.12013839737212174", "0.12013839737213276"),
            ("1.1704148266177143", "1.170414826617781"),
        ),
    }
    motion = enclose({"x": "v", "v": "sin(t) - sin(x)"}, {"x": 1, "v": 2}, [5, 10], DIGITS, begin=4)
    with mp.workdps(2 * DIGITS):
        for name, boxes in printed.items():
            for value, error, (low, high) in zip(
                motion[name], motion.errors[name], boxes, strict=True
            ):
                assert mpf(low) <= value - error <= value + error <= mpf(high)


def test_the_clock_may_begin_anywhere() -> None:
    """A time-dependent field reads the clock: y' = 2 t from t = 3 is t^2, forwards and backwards."""
    motion = enclose({"y": "2*t"}, {"y": 9}, [5, 1], DIGITS, begin=3)
    assert [int(y) for y in motion["y"]] == [25, 1]
    assert not any(motion.radius)


def test_a_switch_by_the_time_is_no_loss() -> None:
    """A rate that jumps at a time, and one with a kink, keep all digits."""
    motion = enclose({"y": "1 if t < 1/3 else abs(t - 2/3)"}, {"y": 0}, [1], DIGITS)
    with mp.workdps(DIGITS + 30):
        assert abs(motion["y"][0] - (mpf(1) / 3 + mpf(1) / 9)) <= motion.errors["y"][0]


@pytest.mark.parametrize("until", ["1", "2", "1000", "1e7"])
def test_a_motion_without_bound_says_so_and_how_far_it_came(until: str) -> None:
    """y' = y^2 has no bound at t = 1: the row before is proven; the reason has that time and a size."""
    sentence = (
        r"^y seems to grow without bound: .* proven to be above \S+e\+\d+ near t = (0\.9999|1\.0)"
    )
    with pytest.raises(Unsettled, match=sentence) as doubt:
        enclose({"y": "y^2", "z": "cos(t)"}, {"y": 1, "z": 0}, ["1/2", until], 6)
    assert doubt.value.is_end
    assert doubt.value.places == (0,)
    assert doubt.value.motion is not None
    assert abs(doubt.value.motion["y"][0] - 2) <= doubt.value.motion.errors["y"][0]


@pytest.mark.parametrize(
    ("rate", "function"),
    [("-sqrt(x) - 1", r"sqrt\(x\)"), ("1/(1/2 - t)", r"1 / \(1/2 - t\)")],
)
def test_a_function_without_a_value_ends_a_motion(rate: str, function: str) -> None:
    """The reason names the function, the rate that it stands in, and the time."""
    with pytest.raises(
        Unsettled, match=rf"{function} in the rate of x has no value .* near t = 0\."
    ):
        enclose({"x": rate}, {"x": 1}, [2], 6)


def test_a_fast_motion_is_no_end() -> None:
    """Steps that are short and stay so are too many; nothing is said of an end."""
    with pytest.raises(Unsettled, match="would take about") as doubt:
        enclose({"x": "v", "v": "-x*1e9"}, {"x": 1, "v": 0}, [100000], 6)
    assert not doubt.value.is_end


@pytest.mark.parametrize("rate", ["1/(x - x)", "(x - x)^(-1)", "(x - x)/(x - x)", "x/(pi - pi)"])
def test_a_divisor_that_is_nothing_throughout_is_a_reason(rate: str) -> None:
    """A divisor that cancels to zero ends the motion at its start, whatever it divides."""
    with pytest.raises(Unsettled, match=r"a divisor may be zero near t = 0"):
        enclose({"x": rate}, {"x": 1}, [1], DIGITS)


def test_all_faults_are_named_at_once() -> None:
    """Faults of names, texts, numbers, times and digits come together, each with its place."""
    with pytest.raises(Refused) as refused:
        enclose({"t": "1", "x": "y + ", "z": "1"}, {"t": 0, "x": "1 m", "y": "q"}, ["a"], 0, "b")
    places = [fault.rpartition(" @ ")[2].partition(" ")[0] for fault in refused.value.faults]
    assert sorted(places) == [
        "begin", "digits", "rates", "rates.t", "rates.x,", "start", "start.x", "start.y", "times[0]",
    ]  # fmt: skip
    with pytest.raises(Refused, match="a divisor that is not zero") as refused:
        enclose({"x": "1/(2 - 2) + x"}, 3, ["a"])  # type: ignore[arg-type]
    assert len(refused.value.faults) == 3
    with pytest.raises(Refused, match=r"rates\.x, column 3"):
        enclose({"x": "2*y", "z": "1"}, {"x": 1, "z": 1}, [1])
    with pytest.raises(Refused, match="the start of `x`"):
        enclose({"x": "1"}, {"y": 1}, [1])
