"""Exact motions of shipped scenes, as documents that pictures are drawn from."""

from __future__ import annotations

from functools import cache
from typing import Any

from taylor_verify.draw.drawn_course import motion
from taylor_verify.scenes.reading.reader import load


@cache
def document(scene: str) -> dict[str, Any]:
    """Return the motion of a scene in few rows: what tests ask of it holds of every row."""
    return motion(load(scene), 60)
