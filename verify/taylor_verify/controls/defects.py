"""The defects in the order of the pages: equations, stepping, answers."""

from __future__ import annotations

from typing import Final

from taylor_verify.controls.answers import ANSWERS
from taylor_verify.controls.defect import Defect
from taylor_verify.controls.equations import EQUATIONS
from taylor_verify.controls.stepping import STEPPING

DEFECTS: Final[tuple[Defect, ...]] = (*EQUATIONS, *STEPPING, *ANSWERS)

__all__ = ["DEFECTS", "Defect"]
