"""Euler angles in a CCSDS AEM: EULER_ROT_SEQ turns the axes of REF_FRAME_A into those of REF_FRAME_B.

Its axes move along, and the angles are in degrees. The inverse has the opposite sequence and signs.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction
from math import nan
from pathlib import Path
from typing import Final

from taylor_verify.records.faults import cut, refusal
from taylor_verify.solvers.files.columns.forms import FORMS
from taylor_verify.solvers.files.columns.units import DEGREE
from taylor_verify.solvers.files.formats.aem_segment import ANGLES, Segment
from taylor_verify.solvers.files.formats.column import Column
from taylor_verify.solvers.values import Value

_AXES: Final = str.maketrans("123", "xyz")


def sequence(segment: Segment, path: Path) -> str:
    """Return the sequence of axes, as `zyx`."""
    stated = segment.metadata.get("EULER_ROT_SEQ", "none")
    axes = stated.lower().translate(_AXES)
    if axes not in FORMS or len(axes) != len(ANGLES):
        raise refusal("EULER_ROT_SEQ like ZYX", cut(stated), path)
    return axes


def angle_columns(segment: Segment, reverse: bool, path: Path) -> Iterator[Column]:
    """Yield the angles that turn the space axes into those of the body, in degrees, as text."""
    axes, texts = sequence(segment, path), [segment.columns[name] for name in ANGLES]
    if reverse:
        axes, texts = axes[::-1], [[negative(text) for text in each] for each in reversed(texts)]
    for k, each in enumerate(texts, start=1):
        yield Column(f"euler_{axes}_{k} [deg]", each)


def quaternion(axes: str, angles: Sequence[Value], reverse: bool) -> Sequence[Value]:
    """Return the quaternion of three angles in degrees, scalar first, body to space."""
    exact = [angle * DEGREE for angle in angles if isinstance(angle, Fraction)]
    turned = FORMS[axes].quaternion(exact) if len(exact) == len(angles) else [nan] * 4
    scalar, *vector = turned
    return (scalar, *(-entry for entry in vector)) if reverse else turned


def negative(text: str) -> str:
    return text.removeprefix("-") if text.startswith("-") else f"-{text.removeprefix('+')}"
