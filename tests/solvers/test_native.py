"""The library of an engine in C++: compiled when it is asked for, and driven as a script is."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from taylor_verify.numbers.precision import rung
from taylor_verify.run import run
from taylor_verify.solvers.engines import native
from taylor_verify.solvers.engines.engine import SCRIPTS, named, prepare
from taylor_verify.solvers.engines.launcher import NotMade
from taylor_verify.solvers.engines.script import read_script
from taylor_verify.solvers.registry import solver_named

pytestmark = pytest.mark.skipif(
    bool(native.Native().unavailable()), reason="needs g++ and the packages of Debian"
)

# An engine that knows one motion: the turn of a ball, whose omega is constant in space.
BALL = """\
// /// script
// dependencies = []
// [tool.taylor-verify]
// title = "Ball"
// models = ["euler"]
// data = "tensor"
// [tool.taylor-verify.settings]
// step = 0.01
// ///
#include <cmath>
#include <cstring>
static double w[3], q[4], h;
extern "C" {
int takes_moments = 1;
void begin(const double *, const double *omega, const double *attitude, double step, const char *) {
  std::memcpy(w, omega, sizeof w);
  std::memcpy(q, attitude, sizeof q);
  h = step;
}
void push(const double *) {}
void advance() {
  const double rate = std::sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
  const double c = std::cos(rate * h / 2), s = std::sin(rate * h / 2) / rate;
  const double x = s * w[0], y = s * w[1], z = s * w[2], p[] = {q[0], q[1], q[2], q[3]};
  q[0] = c * p[0] - x * p[1] - y * p[2] - z * p[3];
  q[1] = c * p[1] + x * p[0] + y * p[3] - z * p[2];
  q[2] = c * p[2] + y * p[0] + z * p[1] - x * p[3];
  q[3] = c * p[3] + z * p[0] + x * p[2] - y * p[1];
}
void state(double *row) {
  std::memcpy(row, w, sizeof w);
  std::memcpy(row + 3, q, sizeof q);
}
}
"""


def test_an_engine_in_cpp_is_compiled_once_and_answers(
    only_script: Callable[[str, str], Path],
) -> None:
    """A ball turns rightly from an oblique start; a second call compiles nothing."""
    only_script("with_ball.cpp", BALL)
    judged = run("euler/spherical", "outside:ball?step=0.01", tolerance=1e-9, causes=False)
    assert judged.passed, judged.verdicts
    messages: list[str] = []
    prepare("ball", messages.append)
    assert messages == []


def test_a_library_that_cannot_be_made_is_told_in_one_line(
    only_script: Callable[[str, str], Path], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A compiler's error is the reason, and so is a missing compiler."""
    only_script("with_ball.cpp", BALL.replace("static double w[3]", "static nothing w[3]"))
    with pytest.raises(NotMade, match=r"g\+\+: .*nothing.* does not name a type"):
        prepare("ball")
    monkeypatch.setattr(shutil, "which", lambda program: None)
    assert "apt-get is not installed" in solver_named("outside:ball").unavailable(rung("f64"))


def test_a_package_of_debian_is_pinned() -> None:
    """A version replaces the pins of a library and its headers; a requirement without one is refused."""
    assert (
        '"libode-dev=2:0.17-1", "libode8=2:0.17-1"' in named("outside:ode?version=2:0.17-1").block
    )
    assert read_script(SCRIPTS / "with_bullet.cpp").version == "3.24+dfsg-2"
