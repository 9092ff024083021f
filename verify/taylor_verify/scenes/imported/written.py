"""The text of a scene made from a link: to be read and edited."""

from __future__ import annotations

import json
import textwrap
from collections.abc import Iterable
from decimal import MAX_EMAX, MIN_EMIN, Context, Decimal
from fractions import Fraction
from typing import Final

from taylor_verify.records.quantities import MAIN, TRACKED
from taylor_verify.scenes.imported.link import Link
from taylor_verify.scenes.names import escaped
from taylor_verify.scenes.precision import float_text
from taylor_verify.scenes.tensors import Matrix, Vector

_WIDTH: Final = 100
_USUAL: Final = 15
_LONGEST_NAME: Final = 200

# A start off every axis and off the identity attitude: what is wrong shows in the first rows. The
# quaternion has unit length exactly.
_TURNING: Final = "[0.3, 1, 0.2]"
_ATTITUDE: Final = "[0.68, 0.32, -0.64, 0.16]"
_PLACEHOLDER: Final = "A placeholder, and nothing of the file: put your own start here."
_PLACEHOLDER_TIME: Final = "A placeholder as well."


def scene_text(link: Link, form: str, file: str) -> str:
    """Return the TOML of a scene: of a rigid body, or of a vehicle where the link has an added mass."""
    name, file = _one_line(link.name), _one_line(file)
    title = json.dumps(f"{name} of {file}", ensure_ascii=False)
    model = "euler" if link.added_mass is None else "kirchhoff"
    opening = (
        f"Written by `taylor-verify scene from` out of {file} ({form}), link {name}. To be read and "
        "edited: the body is that of the file, in exact numbers; the start and the times are placeholders. "
        "Units are those of the file (SI by its specification)."
    )
    body = _rigid(link) if link.added_mass is None else _vehicle(link)
    start = _RIGID_START if link.added_mass is None else _VEHICLE_START
    track = json.dumps([MAIN[model], *TRACKED[model]])
    lines = [
        *_comment(opening),
        f"title = {title}",
        f'model = "{model}"',
        f"track = {track}",
        "",
        "[body]",
        *body,
        "",
        "[initial]",
        *_comment(_PLACEHOLDER),
        *start,
        "",
        "[time]",
        *_comment(_PLACEHOLDER_TIME),
        "end = 20" if model == "euler" else "end = 5",
        "samples = 101" if model == "euler" else "samples = 26",
    ]
    return "\n".join(lines) + "\n"


_RIGID_START: Final = (
    f"omega = {_TURNING}                       # body axes, radians per second",
    f"attitude = {_ATTITUDE}  # quaternion, scalar first, body to space",
)
_VEHICLE_START: Final = (
    "linear_velocity = [1, 0.1, -0.2]         # of the origin of the link, in its axes",
    "angular_velocity = [0.1, 0.2, 0.3]       # radians per second",
    f"attitude = {_ATTITUDE}  # quaternion, scalar first, body to space",
)


def _rigid(link: Link) -> list[str]:
    said = (
        "The tensor of inertia about the centre of mass, in the axes of the link; products are tensor "
        "components, -int xy dm. "
        f"The mass, {_decimal(link.mass)}, and the place of the centre of mass, "
        f"({_listed(link.centre)}), do not enter: the rotation is about the centre of mass."
    )
    return [*_comment(said, *link.remarks), *_matrix("inertia", link.inertia)]


def _vehicle(link: Link) -> list[str]:
    said = (
        "The inertia of link and fluid together, about the origin of the link and in its axes: "
        "M = [[m 1, -m [c]x], [m [c]x, I - m [c]x [c]x]] + fluid_added_mass, with the mass "
        f"m = {_decimal(link.mass)}, the centre of mass c = ({_listed(link.centre)}) and the tensor I "
        "about it, whose rows are below.",
        *(f"I: {_listed(row)}" for row in link.inertia),
        "Left out: drag, weight and buoyancy, thrusters, and every other link.",
    )
    return [*_comment(*said, *link.remarks), *_matrix("mass_matrix", link.mass_matrix)]


def _matrix(key: str, matrix: Matrix) -> list[str]:
    """The entries, and beside long fractions the same as short decimals."""
    rows = [f"  [{', '.join(map(_number, row))}]," for row in matrix]
    is_long = any(_decimal(entry) is None for row in matrix for entry in row)
    short = [f"  {', '.join(map(float_text, row))}" for row in matrix] if is_long else []
    said = ["In short decimals:", *short] if short else []
    return [*(f"# {line}" for line in said), f"{key} = [", *rows, "]"]


def _listed(vector: Vector) -> str:
    return ", ".join(_decimal(entry) or float_text(entry) for entry in vector)


def _number(value: Fraction) -> str:
    """The number exactly: a decimal where it ends, else a fraction."""
    return _decimal(value) or f'"{value}"'


def _decimal(value: Fraction) -> str | None:
    """The decimal that equals the number; None where it has no end."""
    rest = value.denominator
    for prime in (2, 5):
        while rest % prime == 0:
            rest //= prime
    if rest != 1:
        return None
    digits = len(str(value.numerator)) + value.denominator.bit_length()
    context = Context(prec=digits + 1, Emin=MIN_EMIN, Emax=MAX_EMAX)
    exact = context.divide(Decimal(value.numerator), Decimal(value.denominator))
    short = exact.normalize(context)
    is_usual = -_USUAL <= short.adjusted() <= _USUAL
    return format(short, "f") if is_usual else str(short).lower()


def _one_line(text: str) -> str:
    """A name as a comment may hold it: a line break in it would begin a line of TOML."""
    line = escaped(" ".join(text.split()))
    return line if len(line) <= _LONGEST_NAME else f"{line[:_LONGEST_NAME]}..."


def _comment(*sentences: str) -> Iterable[str]:
    for sentence in sentences:
        for line in textwrap.wrap(sentence, _WIDTH - 2, break_on_hyphens=False):
            yield f"# {line}"
