"""The text of a scene made from a link, which a user reads and edits."""

from __future__ import annotations

import json
import textwrap
from itertools import chain
from typing import Final

from taylor_verify.numbers.precision import float_text
from taylor_verify.numbers.tensors import Matrix, Vector
from taylor_verify.records.escapes import escaped
from taylor_verify.records.quantities import MAIN, TRACKED
from taylor_verify.scenes.imported.attributes import decimal
from taylor_verify.scenes.imported.link import Link
from taylor_verify.scenes.imported.water import Water

_WIDTH: Final = 100
_LONGEST_NAME: Final = 200

# The start is along no axis, and the attitude is not the identity: a fault shows in the first rows. The
# quaternion has unit length exactly.
_ATTITUDE: Final = "attitude = [0.68, 0.32, -0.64, 0.16]  # quaternion, scalar first, body to space"
_RIGID_START: Final = """\
omega = [0.3, 1, 0.2]                       # body axes, radians per second"""
_VEHICLE_START: Final = """\
linear_velocity = [1, 0.1, -0.2]         # of the origin of the link, in its axes
angular_velocity = [0.1, 0.2, 0.3]       # radians per second"""


def scene_text(link: Link, form: str, file: str) -> str:
    """Return the TOML of a scene: of a rigid body, or of a vehicle where the link has an added mass."""
    name, file = _one_line(link.name), _one_line(file)
    opening = (
        f"Written by `taylor-verify scene from` out of {file} ({form}), link {name}. To be read and "
        "edited: the body is that of the file, in exact numbers; the start and the times are placeholders. "
        "Units are those of the file (SI by its specification)."
    )
    if link.added_mass is None and not link.water.acts:
        model, body, start, end, samples = "euler", _rigid(link), _RIGID_START, 20, 101
    else:
        model, body, start, end, samples = "kirchhoff", _vehicle(link), _VEHICLE_START, 5, 26
    return f"""\
{_comment(opening, *(f"Warning: {sentence}." for sentence in link.water.left_out))}
title = {json.dumps(f"{name} of {file}", ensure_ascii=False)}
model = "{model}"
track = {json.dumps([MAIN[model], *TRACKED[model]])}

[body]
{body}

[initial]
{_comment("A placeholder, and nothing of the file: put your own start here.")}
{start}
{_ATTITUDE}

[time]
{_comment("A placeholder as well.")}
end = {end}
samples = {samples}
"""


def _rigid(link: Link) -> str:
    comment = (
        "The tensor of inertia about the centre of mass, in the axes of the link; products are tensor "
        "components, -int xy dm. "
        f"The mass, {decimal(link.mass)}, and the place of the centre of mass, "
        f"({_listed(link.centre)}), do not enter: the rotation is about the centre of mass."
    )
    return f"{_comment(comment, *link.remarks)}\n{_matrix('inertia', link.inertia)}"


def _vehicle(link: Link) -> str:
    comment = (
        "The inertia of link and fluid together, about the origin of the link and in its axes: "
        "M = [[m 1, -m [c]x], [m [c]x, I - m [c]x [c]x]] + the added mass, with the mass "
        f"m = {decimal(link.mass)}, the centre of mass c = ({_listed(link.centre)}) and the tensor I "
        "about it, whose rows are below.",
        *(f"I: {_listed(row)}" for row in link.inertia),
        f"Left out: {', '.join([*_absent(link.water), 'every other link'])}.",
    )
    body = f"{_comment(*comment, *link.remarks)}\n{_matrix('mass_matrix', link.mass_matrix)}"
    return "\n".join([body, *_loads(link.water)])


def _absent(water: Water) -> list[str]:
    """Return what acts on vehicles and on this one does not."""
    is_there = {
        "drag": any(water.terms),
        "weight and buoyancy": bool(water.hanging),
        "thrusters": bool(water.thrusts),
    }
    return [name for name, is_written in is_there.items() if not is_written]


def _loads(water: Water) -> list[str]:
    """Return the lines of [body] for what acts, with [define] for thrusts."""
    lines = []
    for key, terms in (("force", water.terms[:3]), ("couple", water.terms[3:])):
        if any(terms):
            texts = (" + ".join(each).replace("+ -", "- ") or "0" for each in terms)
            lines.append(f"{key} = {json.dumps([*texts])}")
    for key, hung in water.hanging:
        lines.append(f"{key} = {{ force = [{_exact(hung.force)}], at = [{_exact(hung.at)}] }}")
    if any(water.current):
        lines.append(f"current = [{_exact(water.current)}]")
    if water.thrusts:
        comment = (
            "Thrusts of the thrusters, by their joints: zero until you write a number or a text."
        )
        lines += ["", "[define]", _comment(comment)]
        lines += [f"{thrust} = 0  # {_one_line(joint)}" for thrust, joint in water.thrusts]
    return lines


def _exact(vector: Vector) -> str:
    """Return each entry as a decimal where it ends, else as a fraction."""
    return ", ".join(decimal(entry) or f'"{entry}"' for entry in vector)


def _matrix(key: str, matrix: Matrix) -> str:
    """Return the entries exactly; if some are long fractions, all entries come before as short decimals."""
    is_long = any(decimal(entry) is None for row in matrix for entry in row)
    short = [f"#   {', '.join(map(float_text, row))}" for row in matrix]
    rows = [f"  [{_exact(row)}]," for row in matrix]
    return "\n".join([*["# In short decimals:", *short] * is_long, f"{key} = [", *rows, "]"])


def _listed(vector: Vector) -> str:
    return ", ".join(decimal(entry) or float_text(entry) for entry in vector)


def _one_line(text: str) -> str:
    """Return a name on one line, for a comment: after a line break TOML would begin."""
    line = escaped(" ".join(text.split()))
    return line if len(line) <= _LONGEST_NAME else f"{line[:_LONGEST_NAME]}..."


def _comment(*sentences: str) -> str:
    lines = (textwrap.wrap(s, _WIDTH - 2, break_on_hyphens=False) for s in sentences)
    return "\n".join(f"# {line}" for line in chain(*lines))
