"""Names written beside the lines that they belong to, where nothing lies and none overlap.

Lengths are in points from the figure's lower left corner. A figure has 72 pixels to the inch while
it is laid out, so that both are the same; what is written stays there at any other resolution. Boxes
have shape (n, 4), each left, low, right, top; spots have shape (n, 2).

textalloc and adjustText place the name of a point. They take no line that may be named at any of its
marks: at one end alone, names strike through marks or leave a full panel.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import hypot, pi
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from taylor_verify.publish.pictures.named import Named, Spot
from taylor_verify.publish.pictures.palette import PAPER, for_text
from taylor_verify.publish.pictures.style import SMALL

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.text import Text

Numbers = NDArray[np.float64]

# To the inch.
POINTS: Final = 72

# How far a name's box may be from its point, and how far it stays from other names and the frame.
_RADII: Final = (6.0, 10.0, 16.0, 24.0, 34.0)
_DIRECTIONS: Final = 16
_GAP: Final = 1.5
# Beyond this a thin line leads from the name to its point.
_FAR: Final = 12.0
_SAMPLING: Final = 3.0
_DOTS: Final = 8
# Half the size of a mark, and how near to each other lines count as one.
_MARK: Final = 2.5
_SAME: Final = 2.0

# What a place costs: a name on a mark hides a number, on a line it only crosses it, and where lines
# run together it could be the name of each.
_ON_A_MARK: Final = 5.0
_ON_A_LINE: Final = 1.0
_ON_ANOTHER: Final = 0.4
_NEARER_TO_ANOTHER: Final = 4.0
_SHARED: Final = 3.0
_AT_THE_COARSE_END: Final = 0.3
_NOT_AN_END: Final = 0.6
_PER_POINT_AWAY: Final = 0.06
_FORBIDDEN: Final = 1e4
_SWEEPS: Final = 4


@dataclass(frozen=True)
class _Line:
    """A named line in points: its marks, and samples so dense that no box misses it."""

    name: str
    colour: str
    marks: Numbers
    samples: Numbers


@dataclass(frozen=True)
class _Places:
    """Where a name may stand, place by place: its box, its point, their distance, and what it costs."""

    boxes: Numbers
    anchors: Numbers
    away: Numbers
    cost: Numbers


def write_names(
    axes: Axes, lines: Sequence[Named], beside: Iterable[Sequence[Spot]] = ()
) -> list[Text]:
    """Write the name of every line that has a point; return the texts, in the order of the lines.

    ``beside`` are other lines, in the axes' units, that a name had better not cross. The limits of
    the axes must be final.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.transforms import Affine2D

    figure = axes.get_figure(root=True)
    assert figure is not None
    renderer = FigureCanvasAgg(figure).get_renderer()  # type: ignore[no-untyped-call]
    in_points = Affine2D().scale(1 / POINTS) + figure.dpi_scale_trans
    seen = [_in_points(axes, line) for line in lines if any(line.pieces)]
    texts = []
    for line in seen:
        text = axes.text(0, 0, line.name, color=for_text(line.colour), size=SMALL)
        text.set(va="bottom", ha="left", transform=in_points, zorder=2.5, gid="name")
        # Below the lines, so that it hides no number; what is thin it covers, and stays legible.
        text.set_bbox({"facecolor": PAPER, "alpha": 0.75, "linewidth": 0, "pad": 0.4})
        texts.append(text)
    extents = [text.get_window_extent(renderer) for text in texts]
    frame = _corners(axes.get_window_extent(renderer))
    obstacles = _sampled(axes, beside)
    places = [
        _priced(_candidates(line, extent.width, extent.height), line, seen, frame, obstacles)
        for line, extent in zip(seen, extents, strict=True)
    ]
    for text, line, its, i in zip(texts, seen, places, _chosen(places), strict=True):
        box, anchor = its.boxes[i], its.anchors[i]
        text.set_position((float(box[0]), float(box[1])))
        if its.away[i] > _FAR:
            end = _nearest(box, anchor)
            axes.plot(
                [float(anchor[0]), float(end[0])],
                [float(anchor[1]), float(end[1])],
                color=line.colour,
                linewidth=0.5,
                transform=in_points,
                zorder=1.5,
                gid="leader",
                scalex=False,
                scaley=False,
            )
    return texts


def _chosen(places: Sequence[_Places]) -> list[int]:
    """One place for each name: chosen in turn, and again once the others are known."""
    chosen: dict[int, int] = {}
    # The names with the fewest free places choose first.
    order = sorted(range(len(places)), key=lambda i: -float(places[i].cost.min()))
    for _ in range(_SWEEPS):
        for i in order:
            cost = places[i].cost.copy()
            for j, place in chosen.items():
                if j != i:
                    taken = _grown(places[j].boxes[place], _GAP)
                    cost += _FORBIDDEN * _overlap(places[i].boxes, taken)
            chosen[i] = int(cost.argmin())
    return [chosen[i] for i in range(len(places))]


def _candidates(line: _Line, width: float, height: float) -> _Places:
    """Round every mark of the line, in every direction and at every distance."""
    angles = 2 * pi * np.arange(_DIRECTIONS) / _DIRECTIONS
    grid = np.meshgrid(np.arange(len(line.marks)), _RADII, angles, indexing="ij")
    index, away, angle = (values.ravel() for values in grid)
    anchors = line.marks[index.astype(int)]
    x, y = anchors[:, 0] + away * np.cos(angle), anchors[:, 1] + away * np.sin(angle)
    # The box hangs on the side that faces the point.
    left = x - width * (1 - np.cos(angle)) / 2
    low = y - height * (1 - np.sin(angle)) / 2
    unlike = np.full(len(line.marks), _NOT_AN_END)
    unlike[0], unlike[-1] = _AT_THE_COARSE_END, 0.0
    cost = _PER_POINT_AWAY * away + unlike[index.astype(int)]
    return _Places(np.stack([left, low, left + width, low + height], 1), anchors, away, cost)


def _priced(
    places: _Places, own: _Line, lines: Sequence[_Line], frame: Numbers, obstacles: Numbers
) -> _Places:
    """The same places, with what they hide and what they could be mistaken for in their cost."""
    boxes = _grown(places.boxes, _GAP)
    areas = (boxes[:, 2] - boxes[:, 0]) * (boxes[:, 3] - boxes[:, 1])
    # Rounding leaves a trace of an area that is wholly inside.
    outside = np.maximum(areas - _overlap(boxes, frame) - 1e-6, 0)
    cost = places.cost + _FORBIDDEN * outside + _ON_ANOTHER * _held(boxes, obstacles)
    here = _grown(np.concatenate([places.anchors, places.anchors], 1), _SAME)
    own_distance = _distance(boxes, own.samples)
    for line in lines:
        cost += _ON_A_MARK * _held(_grown(boxes, _MARK), line.marks)
        cost += _ON_A_LINE * _held(boxes, line.samples)
        if line is not own:
            cost += _SHARED * (_held(here, line.samples) > 0)
            cost += _ON_ANOTHER * _crossed(places, line.samples)
            cost += _NEARER_TO_ANOTHER * (_distance(boxes, line.samples) < own_distance)
    return _Places(places.boxes, places.anchors, places.away, cost)


def _crossed(places: _Places, spots: Numbers) -> Numbers:
    """How many spots the thin line to each name touches; none where the name is near."""
    far = places.away > _FAR
    ends = _nearest(places.boxes, places.anchors)
    found = np.zeros(len(far))
    for i in range(1, _DOTS):
        dots = places.anchors + (ends - places.anchors) * i / _DOTS
        found[far] += _held(_grown(np.concatenate([dots, dots], 1), _SAME)[far], spots)
    return found


def _held(boxes: Numbers, spots: Numbers) -> Numbers:
    """How many of the spots each box holds."""
    x, y = spots[:, 0], spots[:, 1]
    left, low, right, top = (boxes[:, i, None] for i in range(4))
    inside = (left <= x) & (x <= right) & (low <= y) & (y <= top)
    counts: Numbers = np.count_nonzero(inside, axis=1).astype(np.float64)
    return counts


def _distance(boxes: Numbers, spots: Numbers) -> Numbers:
    """From each box to the nearest of the spots."""
    x, y = spots[:, 0], spots[:, 1]
    left, low, right, top = (boxes[:, i, None] for i in range(4))
    across = np.maximum(np.maximum(left - x, x - right), 0)
    along = np.maximum(np.maximum(low - y, y - top), 0)
    nearest: Numbers = np.hypot(across, along).min(axis=1)
    return nearest


def _overlap(boxes: Numbers, other: Numbers) -> Numbers:
    """The area that each box shares with the other."""
    width = np.minimum(boxes[:, 2], other[2]) - np.maximum(boxes[:, 0], other[0])
    height = np.minimum(boxes[:, 3], other[3]) - np.maximum(boxes[:, 1], other[1])
    shared: Numbers = np.maximum(width, 0) * np.maximum(height, 0)
    return shared


def _nearest(boxes: Numbers, spots: Numbers) -> Numbers:
    """The point of each box that is nearest to its spot."""
    clipped: Numbers = np.clip(spots, boxes[..., :2], boxes[..., 2:])
    return clipped


def _grown(boxes: Numbers, gap: float) -> Numbers:
    grown: Numbers = boxes + np.array([-gap, -gap, gap, gap])
    return grown


def _corners(extent: Any) -> Numbers:
    return np.array([extent.x0, extent.y0, extent.x1, extent.y1])


def _in_points(axes: Axes, line: Named) -> _Line:
    pieces = [piece for piece in line.pieces if piece]
    marks = axes.transData.transform([spot for piece in pieces for spot in piece])
    return _Line(line.name, line.colour, marks, _sampled(axes, pieces))


def _sampled(axes: Axes, pieces: Iterable[Sequence[Spot]]) -> Numbers:
    """Points along the pieces, their corners among them."""
    found = [np.empty((0, 2))]
    for piece in pieces:
        if not piece:
            continue
        spots = axes.transData.transform(list(piece))
        found.append(spots)
        for (x, y), (x_next, y_next) in pairwise(spots):
            n = int(hypot(x_next - x, y_next - y) / _SAMPLING)
            shares = np.arange(1, n)[:, None] / max(n, 1)
            found.append(np.array([x, y]) + shares * np.array([x_next - x, y_next - y]))
    return np.concatenate(found)
