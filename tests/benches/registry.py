"""All ratios, in the order in which they are printed."""

from __future__ import annotations

from typing import Final

from benches import judging, memory, propagation, truth
from benches.ratio import Ratio

RATIOS: Final[tuple[Ratio, ...]] = tuple(
    ratio for room in (propagation, truth, judging, memory) for ratio in room.ratios()
)
