"""Records of all quantities: states, conserved quantities, and the columns of a trajectory file.

Readers, solvers and the judge take names, columns and units from here. A scene lists what it tracks, states
of its own among it (`Scene.tracked` and `Scene.groups`). To add a state quantity is to add
its ``Quantity`` and its ``Group`` of columns, and to say where a solver's state has it
(solvers/trajectory.py), what the exact motion makes of it, and how an error reaches it.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass
from enum import Enum
from typing import Final


class Measure(Enum):
    """The way in which two values of a state quantity are compared."""

    # The difference of vectors, over the largest of them; of several groups the larger counts.
    VECTORS = "vectors"
    # The angle between two frames.
    ANGLE = "angle"
    # The distance of two places, over the length of the path.
    PATH = "path"
    # The difference of vectors, over the largest of them up to their row.
    SO_FAR = "so far"


@dataclass(frozen=True)
class Group:
    """Columns of a trajectory file that belong together, and the state ``quantity`` that they represent.

    ``dimension`` determines the units they may be written in. ``moves_with`` names the axes that rename
    them: those of the ``body``, of ``space``, or both (``frame``). ``start`` is the field of the initial
    state.
    """

    name: str
    columns: tuple[str, ...]
    quantity: str
    noun: str
    dimension: str
    moves_with: str = "body"
    start: str = ""

    @property
    def is_frame(self) -> bool:
        """True for columns that are an attitude, and no vector."""
        return self.moves_with == "frame"


@dataclass(frozen=True)
class Quantity:
    """A quantity that says where the body is.

    Every run of the model ``main_of`` has it, and a scene of the models ``tracked_by`` may ask for it
    besides; one that is neither is in files alone. ``groups`` are the columns in which a solver's state
    has it. A scene that tracks it tracks what it ``needs`` too. ``unit`` is that of its error.
    """

    name: str
    unit: str
    groups: tuple[str, ...]
    main_of: str = ""
    tracked_by: tuple[str, ...] = ()
    measure: Measure = Measure.VECTORS
    needs: tuple[str, ...] = ()


@dataclass(frozen=True)
class Conserved:
    """A quantity that a free motion conserves, made of the momenta and the quantities that it ``needs``.

    For a quantity that ``is_positive``, a loss has a physical meaning.
    """

    name: str
    needs: tuple[str, ...] = ()
    is_positive: bool = False


# r12 is row 1, column 2; q0 is the scalar.
GROUPS: Final[Mapping[str, Group]] = {
    group.name: group
    for group in (
        Group("omega", ("w1", "w2", "w3"), "omega", "angular velocity", "rate", start="omega"),
        Group("linear_velocity", ("u1", "u2", "u3"), "velocity", "linear velocity", "velocity"),
        Group(
            name="linear_impulse",
            columns=("x1", "x2", "x3"),
            quantity="impulse",
            noun="linear impulse",
            dimension="impulse",
            start="linear",
        ),
        Group(
            name="angular_impulse",
            columns=("y1", "y2", "y3"),
            quantity="impulse",
            noun="angular impulse",
            dimension="moment of impulse",
            start="angular",
        ),
        Group(
            name="quaternion",
            columns=("q0", "q1", "q2", "q3"),
            quantity="attitude",
            noun="attitude",
            dimension="number",
            moves_with="frame",
            start="attitude",
        ),
        Group(
            name="attitude",
            columns=("r11", "r12", "r13", "r21", "r22", "r23", "r31", "r32", "r33"),
            quantity="attitude",
            noun="attitude",
            dimension="number",
            moves_with="frame",
        ),
        Group("centre", ("c1", "c2", "c3"), "centre", "centre", "length", "space", "centre"),
    )
}
# In reading order.
QUANTITIES: Final[Mapping[str, Quantity]] = {
    each.name: each
    for each in (
        Quantity("omega", "max|omega|", ("omega",), main_of="euler"),
        Quantity("impulse", "max|x|, max|y|", ("linear_impulse", "angular_impulse"), "kirchhoff"),
        Quantity("attitude", "rad", ("quaternion",), "", ("euler", "kirchhoff"), Measure.ANGLE),
        Quantity(
            "centre",
            "arc length",
            ("centre",),
            tracked_by=("kirchhoff",),
            measure=Measure.PATH,
            needs=("attitude",),
        ),
        Quantity("velocity", "max|U|", ("linear_velocity",)),
    )
}
# In reading order: energy, momenta in body axes, fourth integrals, momenta in space.
CONSERVED_QUANTITIES: Final[Mapping[str, Conserved]] = {
    each.name: each
    for each in (
        Conserved("T", is_positive=True),
        Conserved("T+V", ("attitude", "centre")),
        Conserved("H2", is_positive=True),
        Conserved("H_axis"),
        *(Conserved(name, ("attitude",)) for name in ("H_space", "H_along")),
        Conserved("F2", is_positive=True),
        *map(Conserved, ("FG", "y1", "y2", "y3", "y_axis")),
        *map(Conserved, ("clebsch2", "neumann", "steklov", "lyapunov", "chaplygin", "sokolov")),
        *(Conserved(name, ("attitude",)) for name in ("x_space", "x_along")),
        *(Conserved(name, ("attitude", "centre")) for name in ("y_space", "y_along")),
    )
}
# Keys of documents that stand beside quantities.
_KEYS: Final = ("t", "time", "radius", "absolute", "held", "loads")

# Rows that compare no quantity of their own: the start, the extent of an answer, and the soundness of an
# attitude, whose quaternions have unit length and whose matrices are rotations.
INITIAL: Final = "initial state"
COMPLETE: Final = "complete"
UNIT_QUATERNION: Final = "unit quaternion"
ROTATION_MATRIX: Final = "rotation matrix"
SOUND_ATTITUDE: Final = (UNIT_QUATERNION, ROTATION_MATRIX)

# The names that a state of a scene's own may not have, which stands beside these in files and verdicts.
RESERVED: Final = frozenset(
    (*QUANTITIES, *GROUPS, *CONSERVED_QUANTITIES, INITIAL, COMPLETE, *SOUND_ATTITUDE, *_KEYS)
)

# A gate allows this many times the roundoff floor, which is the root mean square of a random sum. Ten
# leaves room for a solver that rounds a few times per step and for the tail of the distribution, but none
# for one wrong step in a hundred.
GATE_FACTOR: Final = 10

# Tables derived from the records.
STATES: Final = tuple(QUANTITIES)
CONSERVED: Final = tuple(CONSERVED_QUANTITIES)
# The quantity of each model that every run has, the groups that it consists of, and what a scene may
# track besides.
MAIN: Final = {each.main_of: each.name for each in QUANTITIES.values() if each.main_of}
MOMENTA: Final = {model: QUANTITIES[name].groups for model, name in MAIN.items()}
TRACKED: Final = {
    model: tuple(name for name, each in QUANTITIES.items() if model in each.tracked_by)
    for model in MAIN
}
COLUMNS: Final = {name: group.columns for name, group in GROUPS.items()}
# The groups of velocities that stand for the impulses of a solid in a fluid.
VELOCITIES: Final = ("linear_velocity", "omega")
IMPULSES: Final = tuple(column for name in MOMENTA["kirchhoff"] for column in COLUMNS[name])


def is_conserved(quantity: str) -> bool:
    """Return True for the name of a conserved quantity."""
    return quantity in CONSERVED_QUANTITIES or quantity in SOUND_ATTITUDE


def is_state(quantity: str) -> bool:
    """Return True for the name of a state quantity, one of a scene's own among them."""
    return not is_conserved(quantity) and quantity not in (INITIAL, COMPLETE)


def states_among(quantities: Iterable[str]) -> list[str]:
    """Return the state quantities in reading order: those of the body, then those of a scene's own."""
    names = [name for name in dict.fromkeys(quantities) if is_state(name)]
    return [*(name for name in STATES if name in names), *(n for n in names if n not in STATES)]


def state_quantities(model: str, track: Collection[str]) -> tuple[Quantity, ...]:
    """Return the quantities of a scene's states, the one that every run has first."""
    names = (MAIN[model], *(name for name in TRACKED[model] if name in track))
    return tuple(QUANTITIES[name] for name in names)


def state_groups(model: str, track: Collection[str]) -> tuple[str, ...]:
    """Return the groups of columns that a solver's states have, in their order."""
    return tuple(name for quantity in state_quantities(model, track) for name in quantity.groups)


def answerable_groups(model: str) -> frozenset[str]:
    """Return the groups that a file for a model may have; for a solid in a fluid also its velocities."""
    quantities = {MAIN[model], *TRACKED[model]}
    every = {name for name, group in GROUPS.items() if group.quantity in quantities}
    return frozenset(every | set(VELOCITIES) if model == "kirchhoff" else every)


def own_state(name: str, columns: tuple[str, ...]) -> tuple[Quantity, Group]:
    """Return the records of a state of a scene's own, whose components are these columns of files."""
    quantity = Quantity(name, f"max|{name}|", (name,), measure=Measure.SO_FAR)
    return quantity, Group(name, columns, name, f"state {name}", "number", moves_with="")


def with_needs(track: Collection[str]) -> frozenset[str]:
    """Return the quantities and all that they need."""
    return frozenset(track).union(*(QUANTITIES[name].needs for name in track if name in QUANTITIES))


def changed_by(group: str) -> tuple[str, ...]:
    """Return the state quantity of a group of columns, and the conserved quantities that depend on it."""
    quantity = GROUPS[group].quantity
    is_momentum = not any(quantity in tracked for tracked in TRACKED.values())
    return (
        quantity,
        *(
            n
            for n, conserved in CONSERVED_QUANTITIES.items()
            if is_momentum or quantity in conserved.needs
        ),
    )
