"""Names beside their lines, in places without marks and without overlaps.

Lengths are in points from the figure's lower left corner. A figure has 72 pixels per inch during the
layout, so that pixels are points; names stay in place at other resolutions. Boxes have shape (n, 4), each
left, low, right, top; spots have shape (n, 2).

textalloc and adjustText place the name of a point, but not of a line that may be named at any of its
marks. Names at one end of the lines cover marks or leave a full panel.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from math import hypot, pi
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from taylor_verify.plotting.named import Named, Spot
from taylor_verify.plotting.palette import PAPER, for_text
from taylor_verify.plotting.style import SMALL

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.text import Text

Numbers = NDArray[np.float64]

# To the inch.
POINTS: Final = 72

# Distances of a name's box from its point, and its least distance from other names and the frame.
_RADII: Final = (6.0, 10.0, 16.0, 24.0, 34.0)
_DIRECTIONS: Final = 16
_GAP: Final = 1.5
# Beyond this a thin line leads from the name to its point.
_FAR: Final = 12.0
_SAMPLING: Final = 3.0
_DOTS: Final = 8
# Half the size of a mark, and the distance below which lines count as one.
_MARK: Final = 2.5
_SAME: Final = 2.0

# Costs of a place: a name on a mark hides a number, a name on a line only crosses it, and a name beside
# several lines is ambiguous.
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
    """A named line in points: its marks, and samples that are dense enough for every box to hit one."""

    name: str
    colour: str
    marks: Numbers
    samples: Numbers


@dataclass(frozen=True)
class _Places:
    """Possible places of a name: box, point, their distance, and cost."""

    boxes: Numbers
    anchors: Numbers
    away: Numbers
    cost: Numbers


def write_names(
    axes: Axes, lines: Sequence[Named], beside: Iterable[Sequence[Spot]] = ()
) -> list[Text]:
    """Write the name of every line that has a point; return the texts in the order of the lines.

    ``beside`` are other lines, in the axes' units, that names should not cross. The limits of the axes
    must be final.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.transforms import Affine2D

    figure = axes.get_figure(root=True)
    assert figure is not None
    renderer = FigureCanvasAgg(figure).get_renderer()  # type: ignore[no-untyped-call]
    in_points = Affine2D().scale(1 / POINTS) + figure.dpi_scale_trans
    visible = [_in_points(axes, line) for line in lines if any(line.pieces)]
    texts = []
    for line in visible:
        text = axes.text(0, 0, line.name, color=for_text(line.colour), size=SMALL)
        text.set(va="bottom", ha="left", transform=in_points, zorder=2.5, gid="name")
        # Below the lines, so that it hides no number, and above thin lines, so that it is legible.
        text.set_bbox({"facecolor": PAPER, "alpha": 0.75, "linewidth": 0, "pad": 0.4})
        texts.append(text)
    extents = [text.get_window_extent(renderer) for text in texts]
    frame = np.array(axes.get_window_extent(renderer).extents)
    obstacles = _sampled(axes, beside)
    places = [
        _priced(_candidates(line, extent.width, extent.height), line, visible, frame, obstacles)
        for line, extent in zip(visible, extents, strict=True)
    ]
    for text, line, its, i in zip(texts, visible, places, _chosen(places), strict=True):
        box, anchor = its.boxes[i], its.anchors[i]
        text.set_position((float(box[0]), float(box[1])))
        if its.away[i] > _FAR:
            axes.plot(
                *np.array([anchor, _nearest(box, anchor)]).T,
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
    """Return a place for each name, chosen one after the other, and once more with all others known."""
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
    """Return places round every mark of the line, in every direction and at every distance."""
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
    """Return the places with the costs of hidden marks and of ambiguity added."""
    boxes = _grown(places.boxes, _GAP)
    areas = (boxes[:, 2] - boxes[:, 0]) * (boxes[:, 3] - boxes[:, 1])
    # Rounding leaves a small area even for a box inside the frame.
    outside = np.maximum(areas - _overlap(boxes, frame) - 1e-6, 0)
    cost = places.cost + _FORBIDDEN * outside + _ON_ANOTHER * _covered_counts(boxes, obstacles)
    here = _around(places.anchors)
    own_distance = _distance(boxes, own.samples)
    for line in lines:
        cost += _ON_A_MARK * _covered_counts(_grown(boxes, _MARK), line.marks)
        cost += _ON_A_LINE * _covered_counts(boxes, line.samples)
        if line is not own:
            cost += _SHARED * (_covered_counts(here, line.samples) > 0)
            cost += _ON_ANOTHER * _crossed(places, line.samples)
            cost += _NEARER_TO_ANOTHER * (_distance(boxes, line.samples) < own_distance)
    return replace(places, cost=cost)


def _crossed(places: _Places, spots: Numbers) -> Numbers:
    """Return the number of spots that the thin line to each name touches; zero for a near name."""
    far = places.away > _FAR
    ends = _nearest(places.boxes, places.anchors)
    touched = np.zeros(len(far))
    for i in range(1, _DOTS):
        dots = places.anchors + (ends - places.anchors) * i / _DOTS
        touched[far] += _covered_counts(_around(dots)[far], spots)
    return touched


def _covered_counts(boxes: Numbers, spots: Numbers) -> Numbers:
    """Return the number of spots that each box covers."""
    (x, y), (left, low, right, top) = spots.T, boxes.T[:, :, None]
    inside = (left <= x) & (x <= right) & (low <= y) & (y <= top)
    return np.asarray(np.count_nonzero(inside, axis=1), dtype=np.float64)


def _distance(boxes: Numbers, spots: Numbers) -> Numbers:
    """Return the distance from each box to the nearest of the spots."""
    (x, y), (left, low, right, top) = spots.T, boxes.T[:, :, None]
    across = np.maximum(np.maximum(left - x, x - right), 0)
    along = np.maximum(np.maximum(low - y, y - top), 0)
    return np.asarray(np.hypot(across, along).min(axis=1))


def _overlap(boxes: Numbers, other: Numbers) -> Numbers:
    """Return the area that each box shares with the other."""
    sides = np.minimum(boxes[:, 2:], other[2:]) - np.maximum(boxes[:, :2], other[:2])
    return np.asarray(np.maximum(sides, 0).prod(axis=1))


def _nearest(boxes: Numbers, spots: Numbers) -> Numbers:
    """Return the point of each box that is nearest to its spot."""
    return np.asarray(np.clip(spots, boxes[..., :2], boxes[..., 2:]))


def _grown(boxes: Numbers, gap: float) -> Numbers:
    return np.asarray(boxes + np.array([-gap, -gap, gap, gap]))


def _around(spots: Numbers) -> Numbers:
    """Return a box around each spot, whose points count as the same place."""
    return _grown(np.concatenate([spots, spots], 1), _SAME)


def _in_points(axes: Axes, line: Named) -> _Line:
    pieces = [piece for piece in line.pieces if piece]
    marks = axes.transData.transform([spot for piece in pieces for spot in piece])
    return _Line(line.name, line.colour, marks, _sampled(axes, pieces))


def _sampled(axes: Axes, pieces: Iterable[Sequence[Spot]]) -> Numbers:
    """Return points along the pieces, including their corners."""
    samples = [np.empty((0, 2))]
    for piece in filter(None, pieces):
        corners = axes.transData.transform(list(piece))
        samples.append(corners)
        for corner, following in pairwise(corners):
            n = int(hypot(*(following - corner)) / _SAMPLING)
            samples.append(corner + np.arange(1, n)[:, None] / max(n, 1) * (following - corner))
    return np.concatenate(samples)
