"""The defects in the order of the pages: equations, stepping, answers."""

from __future__ import annotations

from typing import Final

from taylor_verify_reports.controls.broken_answers import ANSWERS
from taylor_verify_reports.controls.broken_equations import EQUATIONS
from taylor_verify_reports.controls.broken_steps import STEPPING
from taylor_verify_reports.controls.defect import Defect

DEFECTS: Final[tuple[Defect, ...]] = (*EQUATIONS, *STEPPING, *ANSWERS)

__all__ = ["DEFECTS", "Defect"]
