"""The error of U = A x + B y or Omega = B^T x + C y, which are no states."""

from __future__ import annotations

from typing import Any

from taylor_verify.judge.errors.state import (
    Distances,
    Errors,
    Floats,
    Series,
    States,
    largest,
    norms,
    or_one,
)
from taylor_verify.judge.velocities import velocity
from taylor_verify.records.quantities import GROUPS, QUANTITIES
from taylor_verify.scenes.bodies import Body
from taylor_verify.scenes.motion import Motion


class VelocityErrors:
    """Errors of a velocity whose rows come in blocks; ``group`` is the name of its columns."""

    def __init__(self, group: str) -> None:
        self.group = group
        self._states, self._sizes = States(), Series()

    def add(self, body: Body, truth: Motion, answer: Any) -> None:
        """Add the next rows of the exact motion and of the ``answer`` (n, 3)."""
        rows = velocity(self.group, body, truth.quantities)
        about, sizes = QUANTITIES[GROUPS[self.group].quantity], norms(rows)
        most = largest(sizes)
        distances = {self.group: norms(answer - rows)}
        widths = {self.group: truth.radius * or_one(most)}
        block = Distances(about.name, about.unit, distances, widths, {self.group: most})
        self._sizes.add(sizes, self._states.add(block)[self.group])

    def joined(self) -> tuple[Errors, Floats]:
        """Return the errors of all rows, and the size of the velocity there over its largest."""
        (errors,) = self._states.errors()
        return errors, self._sizes.joined()[0]
