"""An engine in plain Python: the classical Runge-Kutta method, which asks for the moment in its stages."""

from __future__ import annotations

ENGINE = """
def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]

def times(matrix, v):
    return [sum(m * entry for m, entry in zip(row, v)) for row in matrix]

class Engine:
    def __init__(self, inertia, omega, attitude):
        (a, b, c) = self.I = inertia
        minors = cross(b, c), cross(c, a), cross(a, b)
        volume = sum(x * y for x, y in zip(a, minors[0]))
        self.K = [[minors[j][i] / volume for j in range(3)] for i in range(3)]
        self.s = [*omega, *attitude]

    def rates(self, t, s, moment):
        w, (p, x, y, z) = s[:3], s[3:]
        turned = [a + b for a, b in zip(cross(times(self.I, w), w), moment(t, s))]
        a, b, c = (entry / 2 for entry in w)
        return [*times(self.K, turned), -x * a - y * b - z * c, p * a + y * c - z * b,
                p * b + z * a - x * c, p * c + x * b - y * a]

    def step(self, t, h, moment):
        moved = lambda part, k: [s + part * h * r for s, r in zip(self.s, k)]
        k1 = self.rates(t, self.s, moment)
        k2 = self.rates(t + h / 2, moved(0.5, k1), moment)
        k3 = self.rates(t + h / 2, moved(0.5, k2), moment)
        k4 = self.rates(t + h, moved(1.0, k3), moment)
        self.s = [s + h / 6 * (a + 2 * b + 2 * c + d) for s, a, b, c, d in zip(self.s, k1, k2, k3, k4)]

    def state(self):
        return self.s
"""
