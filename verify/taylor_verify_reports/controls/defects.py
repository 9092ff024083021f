"""The defects in the order of the pages: equations, stepping, answers."""

from __future__ import annotations

from typing import Final

from taylor_verify_reports.controls.answers import ANSWERS
from taylor_verify_reports.controls.defect import Defect
from taylor_verify_reports.controls.equations import EQUATIONS
from taylor_verify_reports.controls.stepping import STEPPING

DEFECTS: Final[tuple[Defect, ...]] = (*EQUATIONS, *STEPPING, *ANSWERS)

__all__ = ["DEFECTS", "Defect"]
