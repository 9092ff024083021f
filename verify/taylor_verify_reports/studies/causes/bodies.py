"""Random bodies and starts, as scenes and as plain numbers for the simulators of this study."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, Final

import numpy as np

from taylor_verify.scenes.reading.reader import read
from taylor_verify.scenes.scene import Scene

Floats = np.ndarray[Any, np.dtype[np.float64]]
SORTS: Final = ("free", "moment", "wheels", "fluid", "momenta")


def _no_load(t: float, v: Floats, q: Floats, own: Floats) -> Floats:
    return np.zeros_like(v)


@dataclass(frozen=True)
class Acting:
    """Loads of t, v, q and own states that act on a body; own states are not tracked.

    Own states have a ``rate``, or are ``taken`` every so often. The load jumps at ``switches`` alone.
    """

    load: Callable[[float, Floats, Floats, Floats], Floats] = _no_load
    start: Floats = field(default_factory=lambda: np.zeros(0))
    rate: Callable[[float, Floats, Floats, Floats], Floats] = lambda t, v, q, own: 0 * own
    taken: Callable[[float, Floats, Floats, Floats], Floats] = lambda t, v, q, own: own
    every: float = 0.0
    switches: tuple[float, ...] = ()


@dataclass(frozen=True)
class Sample:
    """A body with its start and sampling; v is omega, or U and Omega; ``digits`` are printed.

    ``lines`` belong to [body] of its scene and ``tables`` follow; ``acting`` says the same in numbers. A
    ``solid`` in a fluid may be stated by keys of [body] in place of its mass matrix, which is that of the
    ``dry`` solid and its added mass. A ``current`` changes the place alone: v is relative to the fluid.
    ``source`` has the numbers of its loads.
    """

    sort: str
    mass: Floats
    load: Floats
    rotor: Floats
    v0: Floats
    q0: Floats
    times: Floats
    digits: int
    lines: tuple[str, ...] = ()
    tables: tuple[str, ...] = ()
    acting: Acting = Acting()
    solid: Mapping[str, Any] = field(default_factory=dict)
    dry: Floats = field(default_factory=lambda: np.zeros((6, 6)))
    current: Floats = field(default_factory=lambda: np.zeros(3))
    source: Any = None

    @property
    def n(self) -> int:
        return len(self.mass)

    @property
    def scene(self) -> Scene:
        """The scene of this sample."""
        return read(self.text, "sample")

    @property
    def text(self) -> str:
        """The text of the scene."""
        n = self.n
        solid = self.solid or {"inertia" if n == 3 else "mass_matrix": self.mass}
        body = [f"{name} = {_texts(numbers)}" for name, numbers in solid.items()]
        if np.any(self.load):
            body.append(f"moment = {_texts(self.load)}")
        if np.any(self.rotor):
            body.append(f"rotor = {_texts(self.rotor)}")
        start = [f"omega = {_texts(self.v0)}"]
        if n == 6:
            start = [f"linear_velocity = {_texts(self.v0[:3])}"]
            start.append(f"angular_velocity = {_texts(self.v0[3:])}")
        lines = [
            'title = "Sample"',
            f'model = "{"euler" if n == 3 else "kirchhoff"}"',
            'track = ["attitude"]',
            *("[body]", *body, *self.lines),
            *("[initial]", *start, f"attitude = {_texts(self.q0)}"),
            *("[time]", f"end = {float(self.times[-1])!r}", f"samples = {len(self.times)}"),
            *self.tables,
        ]
        return "\n".join(lines) + "\n"


def _texts(numbers: Floats | Mapping[str, Floats]) -> str:
    """Return a number, a vector, a matrix or a table as a scene has it."""
    if isinstance(numbers, Mapping):
        return f"{{ {', '.join(f'{name} = {_texts(x)}' for name, x in numbers.items())} }}"
    if np.ndim(numbers) == 0:
        return f'"{float(numbers):.17g}"'
    return f"[{', '.join(map(_texts, numbers))}]"


def sample(sort: str, draw: np.random.Generator) -> Sample:
    """Draw a body of a sort, with a full tensor and coarse or fine rows."""
    n = 6 if sort in ("fluid", "momenta") else 3
    root = np.eye(n) + 0.15 * draw.standard_normal((n, n))
    moments = draw.uniform(0.8, 2.4, n)
    mass = np.round((root * moments) @ root.T, 6)
    q = draw.standard_normal(4)
    is_coarse, pace = bool(draw.integers(2)), draw.uniform(0.6, 1.2)
    v0 = np.round(draw.uniform(-1, 1, n) * pace, 6)
    rows = int(draw.integers(26, 45)) if is_coarse else int(draw.integers(90, 180))
    spacing = (0.5 if is_coarse else 0.08) / max(float(np.linalg.norm(v0[-3:])), 0.3)
    step = float(np.round(spacing, 3))
    load = np.round(0.1 * draw.uniform(-1, 1, 3), 6) if sort == "moment" else np.zeros(n)
    rotor = np.round(0.6 * draw.uniform(-1, 1, 3), 6) if sort == "wheels" else np.zeros(3)
    times = np.round(step * np.arange(rows), 9)
    return Sample(
        sort, mass, load, rotor, v0, np.round(q, 6), times, int(draw.choice([7, 9, 12, 16]))
    )
