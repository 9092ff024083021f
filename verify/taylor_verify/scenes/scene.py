"""A scene: the question asked of every solver, in exact numbers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction

from taylor_verify.records.quantities import (
    GROUPS,
    Group,
    Quantity,
    own_state,
    state_groups,
    state_quantities,
)
from taylor_verify.scenes.bodies import Body
from taylor_verify.scenes.loads.states import State as Own
from taylor_verify.scenes.motion import Clock, State


@dataclass(frozen=True, repr=False)
class Scene:
    """Content of a scene file: every number is an exact rational, in the scene's own consistent units.

    ``name`` is the name of a shipped scene (``euler/generic``) or the path given; ``model`` is
    ``euler`` (RigidBody, Spin) or ``kirchhoff`` (ImmersedBody, Impulse); ``track`` holds what the
    scene requires besides omega or impulse: ``attitude``, ``centre``, and ``states`` which of the states
    of its own; ``digest`` is the SHA-256 of the text; ``warnings`` are sentences about a body that no real
    solid could have; ``notes`` say how numbers were formed that the file does not write as they are (an
    inverse, a rate in degrees); the momenta of the start are so formed where it ``writes_velocities``.
    """

    name: str
    title: str
    model: str
    track: frozenset[str]
    body: Body
    initial: State
    clock: Clock
    source: str = ""
    digest: str = ""
    warnings: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()
    states: frozenset[str] = frozenset()
    writes_velocities: bool = False

    @property
    def times(self) -> Sequence[Fraction]:
        """The times asked for, on the clock of the scene."""
        return self.clock.instants

    def __repr__(self) -> str:
        tracked = ", ".join(quantity.name for quantity in self.tracked)
        span = f"{len(self.times)} times from {self.times[0]} to {self.times[-1]}"
        return f"<Scene {self.name}: {self.title}; {self.model}, {tracked} at {span}>"

    @property
    def tracked(self) -> tuple[Quantity, ...]:
        """The state quantities of every answer: omega or impulse, then the frame, then own states."""
        return (*state_quantities(self.model, self.track), *(quantity for quantity, _ in self._own))

    @property
    def groups(self) -> tuple[Group, ...]:
        """The columns of a solver's states, in their order."""
        names = state_groups(self.model, self.track)
        return (*(GROUPS[name] for name in names), *(group for _, group in self._own))

    @property
    def known_groups(self) -> Mapping[str, Group]:
        """All columns that a file may have, by their group; all states of the scene's own among them."""
        own = {s.name: own_state(s.name, s.components)[1] for s in self.own_states}
        return {**GROUPS, **own}

    @property
    def own_states(self) -> tuple[Own, ...]:
        """The states of the scene's own, tracked or not."""
        return () if self.body.loads is None else self.body.loads.states

    @property
    def _own(self) -> list[tuple[Quantity, Group]]:
        tracked = (state for state in self.own_states if state.name in self.states)
        return [own_state(state.name, state.components) for state in tracked]
