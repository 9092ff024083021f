"""A free top as an FMU, made by pythonfmu: one step of the classical Runge-Kutta method in each call."""

from __future__ import annotations

from typing import Any

from pythonfmu import Fmi2Causality, Fmi2Slave, Fmi2Variability, Real

Vector = list[float]
PARAMETERS = ["I11", "I22", "I33", *(f"w{i}_start" for i in (1, 2, 3))]


class Top(Fmi2Slave):
    """Euler's equations in principal axes."""

    author = "taylor-verify"

    def __init__(self, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        for name in PARAMETERS:
            setattr(self, name, 1.0)
            kind = {"causality": Fmi2Causality.parameter, "variability": Fmi2Variability.tunable}
            self.register_variable(Real(name, **kind))
        for name in ("w1", "w2", "w3"):
            setattr(self, name, 0.0)
            self.register_variable(Real(name, causality=Fmi2Causality.output))

    def exit_initialization_mode(self) -> None:
        self.w1, self.w2, self.w3 = self.w1_start, self.w2_start, self.w3_start
        print("an FMU may print what it likes")

    def rates(self, w: Vector) -> Vector:
        """I w' = (I w) x w."""
        a, b, c = self.I11, self.I22, self.I33
        return [(b - c) * w[1] * w[2] / a, (c - a) * w[2] * w[0] / b, (a - b) * w[0] * w[1] / c]

    def do_step(self, current_time: float, step_size: float) -> bool:
        w, h = [self.w1, self.w2, self.w3], step_size

        def moved(k: Vector, by: float) -> Vector:
            return [v + by * r for v, r in zip(w, k, strict=True)]

        k1 = self.rates(w)
        k2 = self.rates(moved(k1, h / 2))
        k3 = self.rates(moved(k2, h / 2))
        k4 = self.rates(moved(k3, h))
        slopes = zip(w, k1, k2, k3, k4, strict=True)
        self.w1, self.w2, self.w3 = (
            v + h / 6 * (a + 2 * b + 2 * c + d) for v, a, b, c, d in slopes
        )
        return True
