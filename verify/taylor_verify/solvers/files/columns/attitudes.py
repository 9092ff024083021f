"""The one attitude of a file, of all its descriptions: a quaternion, a matrix, angles or a vector.

Several descriptions have to agree. Four numbers that do not say where their scalar is are settled by
another description, or by the scene's start. Read with the scalar first or last, the row there has the
scene's attitude or another one. Where both readings have it, the turn to the next row tells which of them
moves as the angular velocity says. What a program's manual says of its names is applied.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from math import inf, nan
from typing import Any, Final, NamedTuple

import numpy as np

from taylor_verify.models.algebra import apply, transpose
from taylor_verify.models.frame import rotation
from taylor_verify.numbers.rotation import conjugate
from taylor_verify.records.faults import Faults
from taylor_verify.records.quantities import COLUMNS
from taylor_verify.scenes.instants import evenly
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.files.columns.choice import Choice
from taylor_verify.solvers.files.columns.forms import FORMS
from taylor_verify.solvers.files.columns.selection import ATTITUDES, Selection
from taylor_verify.solvers.files.columns.spelling import Turn
from taylor_verify.solvers.files.compact_rows import Floats, Rows
from taylor_verify.solvers.files.made import MadeRows

Groups = Mapping[str, Rows]
# Rationals, or NaN.
Numbers = Sequence[Any]

# Two descriptions of one attitude differ by no more, in radians: programs print angles with two decimals.
_AGREE: Final = 0.01
_COMPARED: Final = 24
# A reading whose turn is so much nearer to that of the angular velocity than the other one is taken.
_NEARER: Final = 4


class _Description(NamedTuple):
    """A description of the attitude as a quaternion or a matrix; ``order`` is settled by another one."""

    choice: Choice
    rows: Rows
    order: str = ""

    @property
    def group(self) -> str:
        return "attitude" if self.rows.width == 9 else "quaternion"

    @property
    def matrices(self) -> Floats:
        """The rotations of some rows of the file."""
        doubles = self.rows.doubles(evenly(len(self.rows), _COMPARED))
        if self.group == "attitude":
            return doubles.reshape(-1, 3, 3)
        return _rotations(doubles)


def one_attitude(
    groups: Groups,
    selection: Selection,
    scene: Scene | None,
    times: Sequence[Fraction],
    place: str,
    faults: Faults,
) -> tuple[Groups, str, list[str]]:
    """Return the groups with one description of the attitude, its form, and how it was settled."""
    choices = [choice for choice in selection.attitudes if choice.group in groups]
    every = [
        description
        for choice in choices
        for description in _descriptions(choice, groups[choice.group])
    ]
    left = {name: rows for name, rows in groups.items() if name not in ATTITUDES}
    if selection.is_doubtful and every:
        fitting = _fitting(every, scene, times, groups)
        first, notes = _settled_by_start(every, fitting, place, faults)
    else:
        first, notes = _settled(every, choices, place, faults)
    if first:
        left[first.group] = first.rows
    for group in selection.in_space:
        if group in groups and first:
            make = _in_body_by_matrix if first.group == "attitude" else _in_body
            left[group] = MadeRows([left[group], first.rows], make, 3)
        elif group in groups:
            ours = " ".join(COLUMNS[group])
            notes.append(f"{ours} are compared along space axes: the file has no attitude")
    form = first.choice.group if first and first.choice.group in FORMS else ""
    return left, form, notes


def _descriptions(choice: Choice, rows: Rows) -> Iterator[_Description]:
    """Yield a description in our convention; two where the place of the scalar is open."""
    if choice.group in FORMS:
        rows = MadeRows([rows], FORMS[choice.group].quaternion, 4)
    if choice.doubt:
        yield _Description(choice, rows, "first")
        yield _Description(choice, MadeRows([rows], _scalar_first, 4), "last")
    elif choice.spelling.turn is Turn.TO_BODY:
        make = _transposed if choice.group == "attitude" else conjugate
        yield _Description(choice, MadeRows([rows], make, rows.width))
    else:
        yield _Description(choice, rows)


def _fitting(
    every: Sequence[_Description],
    scene: Scene | None,
    times: Sequence[Fraction],
    groups: Groups,
) -> list[int] | None:
    """Return the numbers of the readings that begin as the scene does, the one that also moves so if any.

    None where no row is at the scene's start.
    """
    if scene is None or scene.clock.start not in times:
        return None
    row, turn = times.index(scene.clock.start), None
    omega = groups["omega"][row] if "omega" in groups else scene.initial.parts().get("omega")
    if omega is not None and row + 1 < len(times):
        turn = _turn([w * (times[row + 1] - times[row]) for w in omega])
    places = [row, row + 1] if turn is not None else [row]
    frames = [_rotations(each.rows.doubles(places)) for each in every]
    begins = _matrix(scene.initial.attitude)
    fit = [k for k, each in enumerate(frames) if _angles(each[0], begins) <= _AGREE]
    if len(fit) < len(every) or turn is None:
        return fit
    errors = [_angles(first.T @ second, turn) for first, second in frames]
    best = int(np.argmin(errors))
    is_clear = all(_NEARER * errors[best] <= errors[k] for k in fit if k != best)
    return [best] if is_clear else fit


def _settled_by_start(
    every: Sequence[_Description], fitting: Sequence[int] | None, place: str, faults: Faults
) -> tuple[_Description | None, list[str]]:
    """Return the only one of the two readings that is fitting, or a fault."""
    choice, ours = every[0].choice, " ".join(COLUMNS["quaternion"])
    if fitting is None or len(fitting) != 1:
        got = f"{choice.shown}: {choice.doubt}"
        got += ", and neither begins with the scene's attitude" if fitting == [] else ""
        faults.add(ours, got, place, f"say which: --columns {choice.scalar_requests}")
        return None, []
    first = every[fitting[0]]
    why = "only so has the row at the scene's start the scene's attitude"
    return first, [f"{choice.shown} taken as {ours}: the scalar is {first.order}, {why}"]


def _settled(
    every: Sequence[_Description], choices: Sequence[Choice], place: str, faults: Faults
) -> tuple[_Description | None, list[str]]:
    """Return the first of the descriptions, which all agree; it is a fault where two do not."""
    if len(choices) < 2:
        return (every[0] if every else None), []
    sure = [each for each in every if not each.choice.doubt]
    apart = [_apart(each.matrices, sure[0].matrices) if sure else inf for each in every]
    agree = [each for each, angle in zip(every, apart, strict=True) if angle <= _AGREE]
    if [each.choice for each in agree] != list(choices):
        got = " and ".join(choice.shown for choice in choices)
        got += ", which differ" if sure else f": {choices[0].doubt}"
        mend = "say which: --columns q0=NAME,... or r11=NAME,... or zyx=NAME:NAME"
        faults.add("the attitude once", got, place, mend)
        return None, []
    first, *others = agree
    scalar = f": the scalar is {first.order}" if first.order else ""
    beside = " and ".join(each.choice.shown for each in others)
    return first, [f"{first.choice.shown} taken, with which {beside} agree{scalar}"]


def _apart(left: Floats, right: Floats) -> float:
    """Return the largest angle between rotations, in radians; infinite where none can be compared."""
    sizes = _angles(left, right)
    finite = sizes[np.isfinite(sizes)]
    return float(np.max(finite)) if len(finite) else inf


def _turn(vector: Sequence[Any]) -> Floats | None:
    """Return the rotation by a vector; None for one that is no number."""
    if not all(isinstance(part, Fraction) for part in vector):
        return None
    return _matrix(FORMS["rotvec"].quaternion(vector))


def _rotations(quaternions: Floats) -> Floats:
    """Return the rotations (n, 3, 3) of quaternions (n, 4) of any length, scalar first; NaN for zero."""
    with np.errstate(divide="ignore", invalid="ignore"):
        squares = np.sum(quaternions**2, axis=1)
        return np.moveaxis(np.array(rotation(list(quaternions.T))) / squares, -1, 0)


def _matrix(q: Sequence[Any]) -> Floats:
    """Return the rotation of one quaternion, as `_rotations` does."""
    one: Floats = _rotations(np.array([[float(part) for part in q]]))[0]
    return one


def _angles(left: Floats, right: Floats) -> Floats:
    """Return the angle between each two rotations that are near to each other, in radians."""
    sizes: Floats = np.linalg.norm(left - right, axis=(-2, -1)) / np.sqrt(2)
    return sizes


# From a row to a row, in any arithmetic.


def _scalar_first(row: Numbers) -> Numbers:
    return (row[3], *row[:3])


def _transposed(row: Numbers) -> Numbers:
    return [row[3 * i + k] for k in range(3) for i in range(3)]


def _in_body(velocity: Numbers, q: Numbers) -> Numbers:
    """Return R^T v for a quaternion of any length."""
    square = sum(part * part for part in q)
    return [part / square if square else nan for part in apply(transpose(rotation(q)), velocity)]


def _in_body_by_matrix(velocity: Numbers, R: Numbers) -> Numbers:
    return apply([R[i::3] for i in range(3)], velocity)
