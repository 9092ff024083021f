"""File names made from the names of scenes and solvers, different for different names.

A shipped scene has a family and a name, and its files a hyphen between them: euler/generic is
euler-generic. What is not of that form is written with everything odd in percent signs, behind a mark
that no family begins with, so that neither a hyphen nor a folder can be mistaken for another.
"""

from __future__ import annotations

import re
from typing import Final
from urllib.parse import quote

_MARK: Final = "_"
# No hyphen and no mark in the family: the first hyphen of the file's name is then the stroke. One
# family has a folder, extremes/worst, whose name begins no other scene's that is written so.
_SHIPPED: Final = re.compile(
    r"(?P<family>[A-Za-z0-9][A-Za-z0-9.]*)/(?:(?P<folder>worst)/|(?!worst-))(?P<name>[A-Za-z0-9._-]+)"
)
_PLAIN: Final = re.compile(r"[A-Za-z0-9][A-Za-z0-9.]*")
_SAFE: Final = "-._~ :?=,+"


def of_scene(scene: str) -> str:
    """Return the stem of the files of a scene."""
    if shipped := _SHIPPED.fullmatch(scene):
        return "-".join(part for part in shipped.group("family", "folder", "name") if part)
    return scene if _PLAIN.fullmatch(scene) else _MARK + quote(scene, safe=_SAFE)


def of_solver(solver: str) -> str:
    """Return a solver's name for a file, its dots and all that no file name may have escaped."""
    return quote(solver, safe=_SAFE).replace(".", "%2E")
