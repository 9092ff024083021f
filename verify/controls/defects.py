"""All defects, in the order in which they are told: equations, stepping, answers."""

from __future__ import annotations

from typing import Final

from verify.controls.answers import ANSWERS
from verify.controls.defect import Defect
from verify.controls.equations import EQUATIONS
from verify.controls.stepping import STEPPING

DEFECTS: Final[tuple[Defect, ...]] = (*EQUATIONS, *STEPPING, *ANSWERS)

__all__ = ["DEFECTS", "Defect"]
