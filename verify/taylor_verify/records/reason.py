"""The reason of a verdict as values, and the only place where its sentences are made.

remarks   conclusions that the numbers of the verdict do not show, each with its cause
factor    what the gate allows, in units of the roundoff floor
tolerance the tolerance that was asked for, in place of the bound that the factor makes of the floor
floor     the roundoff floor at the sample of the largest error, and the terms it is made of
input     the part of the floor that the rounding of the input adds, for an answer from elsewhere
claim     the steps that a solver claims, where fewer are counted
conserved a formula that says what the loads of the scene conserve
shift     the shift of time behind the error of a state quantity that did not pass
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from enum import StrEnum
from typing import Final

# At most this many of the rows that do not share a shift are named.
_MOST_NAMED: Final = 3


class Cause(StrEnum):
    """The kind of a conclusion: the word that a program reads in place of the sentence."""

    NOT_FINITE = "not finite"
    NO_ATTITUDE = "no attitude"
    VACUOUS = "vacuous bound"
    WIDE_TRUTH = "wide truth"
    FINE_TOLERANCE = "fine tolerance"
    START = "start"
    UNFINISHED = "unfinished"
    NO_TRUTH = "no truth"
    NOT_POSED = "not posed"
    MISSING_PACKAGE = "missing package"
    TOO_FAR = "too far"
    INCOMPLETE = "incomplete"
    EVENTS = "events"


class Carried(StrEnum):
    """The way in which the roundings of the steps reach the compared quantity."""

    ORBIT = "transition matrix"
    GRADIENT = "gradient"
    WORK = "work"
    LAW = "law"
    VELOCITY = "velocity of x and y"
    LINEAR_VELOCITY = "linear velocity of x and y"
    LENGTH = "length of the quaternion"
    MATRIX = "length of the axes of the matrix"
    START = "start"
    ROW = "row"
    EVENT = "event"


_LENGTHS: Final = {
    Carried.LENGTH: ("q", "the length of q0 q1 q2 q3 is"),
    Carried.MATRIX: ("R", "r11 ... r33 are no rotation: (1 + R^T R)/2, which would be 1, is"),
}


class Kind(StrEnum):
    """The course of the shift of time that explains an error; NONE leaves more than a tenth of it."""

    CONSTANT = "constant"
    DRIFTING = "drifting"
    WANDERING = "wandering"
    NONE = "none"


@dataclass(frozen=True)
class Remark:
    """A conclusion: its cause, and the sentence without a full stop."""

    cause: Cause
    text: str


@dataclass(frozen=True)
class RoundoffFloor:
    """The error ``value`` that perfect rounding would leave; None stands for no finite number.

    It is u x (``steps`` x ``alike``)^1/2 x ``growth`` where an orbit or a gradient carries the roundings,
    and u x ``steps`` for the length of a quaternion, of which ``lengths`` says what was met; u =
    2^-``bits``. ``alike`` is the number of steps in a row that add nearly the same amount. With
    ``velocities`` a solid's U and Omega were rounded, of which its impulses were made.
    """

    carried: Carried
    value: float | None = None
    bits: int = 0
    steps: int = 0
    growth: float | None = None
    alike: int = 1
    velocities: bool = False
    lengths: str = ""

    def sentence(self) -> str:
        """Return the arithmetic, then behind a colon its meaning."""
        arithmetic, meaning = self.parts()
        return f"{arithmetic}: {meaning}" if arithmetic else meaning

    def parts(self) -> tuple[str, str]:
        """Return the arithmetic, empty where there is none, and its meaning."""
        value, u = _figure(self.value), _figure(2.0**-self.bits)
        if self.carried in _MEANINGS:
            return "", _MEANINGS[self.carried]
        if self.carried in (Carried.LENGTH, Carried.MATRIX):
            rounded, length = _LENGTHS[self.carried]
            return f"attainable = u N = {u} x {self.steps:.4g} = {value}", (
                f"in each step one rounding of {rounded}, all of them one way; {length} {self.lengths}"
            )
        matrix = (
            "the orbit's transition matrix" if self.carried is Carried.ORBIT else "the gradient"
        )
        root, count, repeated = "sqrt(N)", f"sqrt({self.steps})", ""
        if self.alike > 1:
            root, count = "sqrt(N m)", f"sqrt({self.steps} x {self.alike})"
            repeated = _REPEATED.format(self.alike)
        return (
            f"attainable = u {root} x growth = {u} x {count} x {_figure(self.growth, 3)} = {value}"
        ), (
            "in each step one rounding of every component x_i, u (|x_i| + h S_i) with S_i the terms "
            f"of its rate in magnitude, carried by {matrix}{_INERTIA * self.velocities}{repeated}"
        )


# Floors that are not made of steps, or are made of other floors.
_MEANINGS: Final = {
    Carried.START: "one rounding of each component of the start on the rung",
    Carried.ROW: "a rounding of the input and one of the row",
    Carried.EVENT: (
        "the time t of an event g = 0; attainable = ((u t)^2 + (|dg/dz| x the floor of the state z / "
        "|dg/dt|)^2)^(1/2), with as many steps as the scene has samples"
    ),
    Carried.WORK: (
        "this quantity Q of the exact motion, at the start and with the work or impulse of all loads "
        "since; attainable = |dQ/dz| x the floor of the state z"
    ),
    Carried.LAW: (
        "on the instants of this state, the value in the row against its law at the state of the same row; "
        "a rounding of each number and step of the law, and of the row"
    ),
    Carried.VELOCITY: (
        "Omega = B^T x + C y, so that attainable = (|B|^2 x-floor^2 + |C|^2 y-floor^2)^(1/2), "
        "and one rounding of Omega itself"
    ),
    Carried.LINEAR_VELOCITY: (
        "U = A x + B y, so that attainable = (|A|^2 x-floor^2 + |B|^2 y-floor^2)^(1/2), "
        "and one rounding of U itself"
    ),
}
_REPEATED: Final = (
    "; each step adds nearly the same amount here, so over m = {} steps in a row roundings add up in "
    "proportion to the number of steps"
)
_INERTIA: Final = (
    "; where one rounding of each component of U and Omega moves (x, y) = M (U, Omega) by more than "
    "u |x_i|, that takes its place, because the file has velocities"
)


@dataclass(frozen=True)
class InputShare:
    """The part of a floor that the rounding of the input adds.

    ``moved`` says which inputs were moved by ``roundoff`` of their size, ``error`` what this makes of the
    quantity, and ``total`` the root of the sum of squares of this and the roundoff floor.
    """

    moved: str
    roundoff: float
    error: float | None
    total: float | None

    def sentence(self) -> str:
        """Return the arithmetic of the whole floor, but for the roundoff floor itself."""
        return (
            f"attainable = (rounding^2 + input^2)^(1/2) = {_figure(self.total)}; "
            f"input: {self.moved}, moved by u = {self.roundoff:.2g} of its size, "
            f"moves this by {_figure(self.error)}"
        )


@dataclass(frozen=True)
class AskedTolerance:
    """The tolerance that was ``asked`` for, and what arithmetic alone would have ``allowed`` there.

    Both are in the unit of the error; None stands for no finite number.
    """

    asked: float
    allowed: float | None

    def sentence(self) -> str:
        """Return both numbers."""
        return (
            f"a tolerance of {f'{self.asked:g}'.replace('e-0', 'e-')} was asked for; arithmetic alone "
            f"would have allowed {_figure(self.allowed)}"
        )


@dataclass(frozen=True)
class ClaimedSteps:
    """The steps that a solver claims, and those counted: at most what the ``limit`` says in words."""

    claimed: int
    counted: int
    limit: str

    def sentence(self) -> str:
        """Return the claim and what is counted of it."""
        return f"it claims {self.claimed} steps; at most {self.counted} are counted, {self.limit}"


@dataclass(frozen=True)
class TimeShift:
    """The shift of time behind an error: c with answer(t) ~ exact(t - c), positive if it is late.

    ``late`` is the shift where it is largest, at time ``at`` (a constant one has no ``at``), ``remains``
    the largest error that it leaves, in the unit of the error. A drifting one grows by ``trend`` in a
    unit of time, and is ``begins`` at time ``begins_at`` unless it begins right. ``strays`` are the times
    of those of the ``rows`` rows that do not share the shift.
    """

    kind: Kind
    late: float = 0.0
    remains: float = 0.0
    at: float | None = None
    trend: float = 0.0
    begins: float | None = None
    begins_at: float = 0.0
    rows: int = 0
    strays: tuple[float, ...] = ()

    def sentence(self) -> str:
        """Return the shift in words that a person can act on."""
        if self.kind is Kind.NONE:
            return "no shift of time explains it"
        left = f"{self.remains:.2g} remains{self.rows_in_words()}"
        if self.at is None:
            return f"{late(self.late)}, {self.kind}; {left}"
        at_worst = f"{late(self.late)} at t = {self.at:g}"
        if self.kind is Kind.WANDERING:
            return f"{at_worst}, wandering; {left}"
        first = ""
        if self.begins is not None:
            first = f" and is {late(self.begins)} at t = {self.begins_at:g}"
        return f"{at_worst}, drifting: its clock runs {pace(self.trend)}{first}; {left}"

    def rows_in_words(self) -> str:
        """Return the number of rows that share the shift, and the times of those that do not."""
        if not self.strays:
            return ""
        count = len(self.strays)
        times = ", ".join(f"{t:g}" for t in self.strays[:_MOST_NAMED])
        more = f" and {count - _MOST_NAMED} more" if count > _MOST_NAMED else ""
        those = (
            f"the row at t = {times} does" if count == 1 else f"the rows at t = {times}{more} do"
        )
        return f" in {self.rows - count} of {self.rows} rows; {those} not share it"


@dataclass(frozen=True)
class Reason:
    """The reason of one verdict. A verdict that compares nothing has remarks alone."""

    remarks: tuple[Remark, ...] = ()
    factor: float | None = None
    tolerance: AskedTolerance | None = None
    floor: RoundoffFloor | None = None
    input: InputShare | None = None
    claim: ClaimedSteps | None = None
    conserved: str = ""
    shift: TimeShift | None = None

    @property
    def conclusion(self) -> str:
        """The remarks; empty where the numbers of the verdict say everything."""
        return "; ".join(remark.text for remark in self.remarks)

    @property
    def rule(self) -> str:
        """The gate in units of the roundoff floor; empty where nothing was compared.

        With a tolerance it is the sentence of both.
        """
        rule = "" if self.factor is None else f"{self.factor:g} x attainable"
        return f"{self.tolerance.sentence()} = {rule}" if self.tolerance else rule

    @property
    def allowance(self) -> str:
        """The arithmetic of the bound; empty where nothing was compared."""
        return "; ".join(self._terms())

    def parts(self) -> list[str]:
        """Return the sentences one by one: conclusions, the arithmetic of the bound, the shift."""
        remarks = (remark.text for remark in self.remarks)
        shift = [f"as a shift of time: {self.shift.sentence()}"] if self.shift else []
        return [*remarks, *self._terms(), *shift]

    def with_remark(self, cause: Cause, text: str) -> Reason:
        """Return this reason with a conclusion in front of those that it has."""
        return replace(self, remarks=(Remark(cause, text), *self.remarks))

    def __str__(self) -> str:
        """Return all sentences in one line."""
        return "; ".join(self.parts())

    def _terms(self) -> Iterator[str]:
        if self.rule:
            yield self.rule
        if self.conserved:
            yield f"{self.conserved}: its rate under the loads of the scene is the polynomial zero"
        if self.input:
            yield self.input.sentence()
        if self.floor:
            yield f"{'rounding: ' if self.input else ''}{self.floor.sentence()}"
        if self.claim:
            yield self.claim.sentence()


NO_REASON: Final = Reason()


def shown(number: float) -> float:
    """Return a term of a reason in four digits: more than any sentence shows, and fewer than a double."""
    return float(f"{number:.4g}")


def stated(cause: Cause, text: str) -> Reason:
    """Return the reason that is one remark: why nothing was compared."""
    return Reason((Remark(cause, text),))


def late(shift: float) -> str:
    """Return a shift of time in words."""
    return f"{'late' if shift >= 0 else 'early'} by {abs(shift):.3g}"


def pace(trend: float) -> str:
    """Return the pace of a clock in words, by the shift that it makes in a unit of time."""
    return f"{'slow' if trend > 0 else 'fast'} by {abs(trend):.3g} per unit of time"


def _figure(value: float | None, digits: int = 2) -> str:
    return "not finite" if value is None else f"{value:.{digits}g}"
